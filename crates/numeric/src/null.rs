//! Numbers of a JSON file that `null` may stand for: JSON can write neither an infinite number nor NaN.
//!
//! `#[serde(deserialize_with = "null::read")]` reads `null` as NaN, in lists, too, and
//! `#[serde(deserialize_with = "null::endless")]` as ∞.

use serde::{Deserialize, Deserializer};

/// A number or numbers, as they are read.
pub trait Numbers: Sized {
    /// With `None` where the file has `null`.
    type Read: for<'de> Deserialize<'de>;

    /// With NaN there.
    fn from_read(read: Self::Read) -> Self;
}

impl Numbers for f64 {
    type Read = Option<Self>;

    fn from_read(read: Self::Read) -> Self {
        read.unwrap_or(Self::NAN)
    }
}

impl<const N: usize> Numbers for [f64; N]
where
    [Option<f64>; N]: for<'de> Deserialize<'de>,
{
    type Read = [Option<f64>; N];

    fn from_read(read: Self::Read) -> Self {
        read.map(f64::from_read)
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    type Read = Vec<T::Read>;

    fn from_read(read: Self::Read) -> Self {
        read.into_iter().map(T::from_read).collect()
    }
}

impl Numbers for Option<[f64; 2]> {
    type Read = Option<[Option<f64>; 2]>;

    fn from_read(read: Self::Read) -> Self {
        read.map(<[f64; 2]>::from_read)
    }
}

impl Numbers for Option<[f64; 4]> {
    type Read = Option<[Option<f64>; 4]>;

    fn from_read(read: Self::Read) -> Self {
        read.map(<[f64; 4]>::from_read)
    }
}

/// Reads what may have `null` in the place of numbers that are not finite, as NaN.
///
/// # Errors
///
/// It has something else in their place.
pub fn read<'de, D: Deserializer<'de>, T: Numbers>(from: D) -> Result<T, D::Error> {
    T::Read::deserialize(from).map(T::from_read)
}

/// Reads a number, `null` as ∞.
///
/// # Errors
///
/// It is something else.
pub fn endless<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Option::deserialize(from).map(|read| read.unwrap_or(f64::INFINITY))
}
