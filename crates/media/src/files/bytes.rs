//! The bytes of a file, one after the other.

use super::{Unreadable, damaged};

/// Bytes and a position among them.
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(all: &'a [u8]) -> Self {
        Self::at_byte(all, 0)
    }

    /// The bytes from a position on.
    pub(super) fn at_byte(all: &'a [u8], at: usize) -> Self {
        Self { all, at }
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

    /// The bytes that follow.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.all.get(self.at..).unwrap_or_default()
    }

    /// Reads `count` bytes.
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Unreadable> {
        match self.rest().get(..count) {
            Some(actual) => {
                self.at += count;
                Ok(actual)
            }
            None => damaged(format!("it ends within the {count} bytes from byte {} on", self.at)),
        }
    }

    pub(super) fn array<const N: usize>(&mut self) -> Result<[u8; N], Unreadable> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    pub(super) fn byte(&mut self) -> Result<u8, Unreadable> {
        Ok(self.take(1)?[0])
    }

    /// An unsigned number of two bytes.
    pub(super) fn short(&mut self) -> Result<u16, Unreadable> {
        Ok(u16::from_le_bytes(self.array()?))
    }

    /// An unsigned number of four bytes.
    pub(super) fn number(&mut self) -> Result<u32, Unreadable> {
        Ok(u32::from_le_bytes(self.array()?))
    }

    /// An unsigned number of eight bytes.
    pub(super) fn word(&mut self) -> Result<u64, Unreadable> {
        Ok(u64::from_le_bytes(self.array()?))
    }

    pub(super) fn float(&mut self) -> Result<f32, Unreadable> {
        self.number().map(f32::from_bits)
    }

    /// Reads `N` values.
    fn several<T: Copy + Default, const N: usize>(
        &mut self,
        read: impl Fn(&mut Self) -> Result<T, Unreadable>,
    ) -> Result<[T; N], Unreadable> {
        let mut values = [T::default(); N];
        for value in &mut values {
            *value = read(self)?;
        }
        Ok(values)
    }

    /// Reads `N` signed numbers of four bytes.
    pub(super) fn integers<const N: usize>(&mut self) -> Result<[i32; N], Unreadable> {
        self.several(|bytes| bytes.number().map(u32::cast_signed))
    }

    /// Reads `N` unsigned numbers of eight bytes.
    pub(super) fn words<const N: usize>(&mut self) -> Result<[u64; N], Unreadable> {
        self.several(Self::word)
    }

    /// Reads `N` floats of four bytes.
    pub(super) fn floats<const N: usize>(&mut self) -> Result<[f32; N], Unreadable> {
        self.several(Self::float)
    }

    /// Reads `N` floats of eight bytes.
    pub(super) fn doubles<const N: usize>(&mut self) -> Result<[f64; N], Unreadable> {
        Ok(self.words()?.map(f64::from_bits))
    }

    /// A text that ends with 0, of 255 bytes at most.
    pub(super) fn terminated(&mut self) -> Result<&'a [u8], Unreadable> {
        let Some(length) = self.rest().iter().take(256).position(|&byte| byte == 0) else {
            return damaged(format!("a text from byte {} on does not end", self.at));
        };
        let text = self.take(length)?;
        self.take(1)?;
        Ok(text)
    }

    /// A text with its length before it.
    pub(super) fn text(&mut self) -> Result<String, Unreadable> {
        let length = self.number()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}
