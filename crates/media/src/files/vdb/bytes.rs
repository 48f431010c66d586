//! The bytes of a file, one after the other.

use super::{Fault, damaged};

/// Bytes and a position among them.
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(all: &'a [u8]) -> Self {
        Self { all, at: 0 }
    }

    /// Number of all bytes.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    /// The position of the next byte.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Sets the position.
    pub(super) fn seek(&mut self, at: usize) {
        self.at = at;
    }

    /// Reads `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        match self.all.get(self.at..).and_then(|rest| rest.get(..count)) {
            Some(found) => {
                self.at += count;
                Ok(found)
            }
            None => damaged(format!("it ends within the {count} bytes from byte {} on", self.at)),
        }
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub(super) fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.take(1)?[0])
    }

    /// An unsigned number of four bytes.
    pub(super) fn number(&mut self) -> Result<u32, Fault> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    /// An unsigned number of eight bytes.
    pub(super) fn word(&mut self) -> Result<u64, Fault> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    pub(super) fn float(&mut self) -> Result<f32, Fault> {
        Ok(f32::from_le_bytes(self.array()?))
    }

    /// Reads `N` doubles.
    pub(super) fn doubles<const N: usize>(&mut self) -> Result<[f64; N], Fault> {
        let mut doubles = [0.0; N];
        for double in &mut doubles {
            *double = f64::from_bits(self.word()?);
        }
        Ok(doubles)
    }

    /// Coordinates.
    pub(super) fn point(&mut self) -> Result<[i32; 3], Fault> {
        let mut point = [0; 3];
        for axis in &mut point {
            *axis = i32::from_le_bytes(self.array()?);
        }
        Ok(point)
    }

    /// A text with its length before it.
    pub(super) fn text(&mut self) -> Result<String, Fault> {
        let length = self.number()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}
