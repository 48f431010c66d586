//! Mitsuba's voxel grids.
//!
//! ```text
//! "VOL", version 3 (1 byte), then little-endian: encoding (i32), nx ny nz channels (i32), low and high corner of the box (6 f32),
//! samples: channels first, then x, then y, then z
//! encoding   1 float32   2 float16   3 uint8, where 255 is 1   4 directions in two bytes, which are refused
//! ```
//!
//! Mitsuba 3 writes the first encoding, Mitsuba 0.6 the first and the third.
//!
//! Sources: W. Jakob et al., *Mitsuba 3 renderer* (2022), plugin `gridvolume`; W. Jakob, *Mitsuba documentation*,
//! version 0.6 (2014), plugin `gridvolume`.

use super::bytes::Bytes;
use super::number::NumberType;
use super::{Unreadable, damaged, wrong};

/// Bytes before the samples.
const HEADER: usize = 48;

/// Number format of samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// float32.
    Single,
    /// float16.
    Half,
    /// uint8, where 255 is 1.
    Byte,
}

impl Encoding {
    /// Name of the encoding.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "float32",
            Self::Half => "float16",
            Self::Byte => "uint8, where 255 is 1",
        }
    }

    fn number(self) -> Option<NumberType> {
        NumberType::named(match self {
            Self::Single => "<f4",
            Self::Half => "<f2",
            Self::Byte => "|u1",
        })
    }
}

/// A grid with the bytes of its samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Vol<'a> {
    /// Number format of its samples.
    pub encoding: Encoding,
    /// Samples along x, y and z.
    pub size: [u64; 3],
    /// Values of a sample.
    pub channels: u64,
    /// The corners of the box; they may not form one.
    pub corners: [[f64; 3]; 2],
    samples: &'a [u8],
}

impl<'a> Vol<'a> {
    /// Reads the header, and checks that all samples exist.
    ///
    /// # Errors
    ///
    /// The header is not one of those above, or the length of the file does not fit its samples.
    pub fn read(bytes: &'a [u8]) -> Result<Self, Unreadable> {
        if bytes.len() < HEADER {
            return wrong("the file ends within its header of 48 bytes", "write the file anew");
        }
        let mut header = Bytes::new(bytes);
        let [magic @ .., version] = header.array::<4>()?;
        if magic != *b"VOL" {
            return wrong("the file does not begin with `VOL`", "write it by Mitsuba's VolumeGrid");
        }
        if version != 3 {
            let message = format!("the file has the version {version}");
            return wrong(message, "version 3 is read: write it by Mitsuba's VolumeGrid");
        }
        let [encoding, nx, ny, nz, channels] = header.integers()?;
        let encoding = match encoding {
            1 => Encoding::Single,
            2 => Encoding::Half,
            3 => Encoding::Byte,
            other => {
                let directions = if other == 4 { ", of directions" } else { "" };
                let message = format!("the samples have the encoding {other}{directions}");
                return wrong(message, "encodings 1 to 3 are read: float32, float16 and uint8");
            }
        };
        let [Ok(x), Ok(y), Ok(z), Ok(channels)] = [nx, ny, nz, channels].map(u64::try_from) else {
            let size = [nx, ny, nz];
            return damaged(format!("the file announces {size:?} samples of {channels} channels"));
        };
        let size = [x, y, z];
        let corners = [header.floats()?, header.floats()?].map(|corner| corner.map(f64::from));
        let samples = header.rest();
        let width = encoding.number().map_or(0, NumberType::width) as u64;
        let mut factors = size.into_iter().chain([channels]);
        let expected = factors.try_fold(width, u64::checked_mul);
        if expected.is_none_or(|expected| expected != samples.len() as u64) {
            let than = if expected.is_none_or(|expected| expected > samples.len() as u64) {
                "shorter"
            } else {
                "longer"
            };
            let [x, y, z] = size;
            return wrong(
                format!(
                    "the file is {than} than its {x} × {y} × {z} samples of {channels} {} in {}",
                    if channels == 1 { "channel" } else { "channels" },
                    encoding.name()
                ),
                "write the file anew, with nothing but the samples after the header",
            );
        }
        Ok(Self { encoding, size, channels, corners, samples })
    }

    /// The samples of a channel, x fastest.
    pub fn values(&self, channel: usize) -> Vec<f64> {
        let Some(number) = self.encoding.number() else { return Vec::new() };
        let pixel = number.width() * usize::try_from(self.channels).unwrap_or(usize::MAX);
        let unit = if self.encoding == Encoding::Byte { 255.0 } else { 1.0 };
        let first = channel * number.width();
        let words = self.samples.chunks_exact(pixel.max(1));
        let words = words.filter_map(|pixel| pixel.get(first..first + number.width()));
        words.flat_map(|word| number.all(word)).map(|x| x / unit).collect()
    }
}
