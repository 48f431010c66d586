//! Numbers that may be infinite, in JSON, which holds finite numbers only.
//!
//! With `#[serde(with = "gate::extended")]` a number, or a list of numbers, is stored as it is, and as one of the words
//! `inf`, `-inf` and `nan` if it is not finite.

use serde::de::{DeserializeOwned, Error, Unexpected};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The words, each with its number.
const WORDS: [(&str, f64); 3] =
    [("inf", f64::INFINITY), ("-inf", f64::NEG_INFINITY), ("nan", f64::NAN)];

/// A number in its stored form.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
pub enum Stored {
    /// A finite number.
    Number(f64),
    /// One of the words.
    Word(String),
}

/// A number or numbers that may be infinite.
pub trait Numbers: Sized {
    /// The form that is stored.
    type Stored: Serialize + DeserializeOwned;

    /// Converts to the stored form.
    fn stored(&self) -> Self::Stored;

    /// Converts back; the error is an unknown word.
    ///
    /// # Errors
    ///
    /// A word is not one of the three.
    fn read(stored: Self::Stored) -> Result<Self, String>;
}

impl Numbers for f64 {
    type Stored = Stored;

    fn stored(&self) -> Stored {
        let is_it =
            |(_, number): &&(&str, f64)| self == number || (self.is_nan() && number.is_nan());
        match WORDS.iter().find(is_it) {
            Some((word, _)) => Stored::Word((*word).to_owned()),
            None => Stored::Number(*self),
        }
    }

    fn read(stored: Stored) -> Result<Self, String> {
        match stored {
            Stored::Number(number) => Ok(number),
            Stored::Word(word) => {
                let known = WORDS.iter().find(|(known, _)| *known == word);
                known.map(|(_, number)| *number).ok_or(word)
            }
        }
    }
}

impl<const N: usize> Numbers for [f64; N] {
    type Stored = Vec<Stored>;

    fn stored(&self) -> Vec<Stored> {
        self.iter().map(f64::stored).collect()
    }

    fn read(stored: Vec<Stored>) -> Result<Self, String> {
        let numbers = Vec::<f64>::read(stored)?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| format!("{count} numbers"))
    }
}

impl<T: Numbers> Numbers for Vec<T> {
    type Stored = Vec<T::Stored>;

    fn stored(&self) -> Self::Stored {
        self.iter().map(T::stored).collect()
    }

    fn read(stored: Self::Stored) -> Result<Self, String> {
        stored.into_iter().map(T::read).collect()
    }
}

impl<T: Numbers> Numbers for Option<T> {
    type Stored = Option<T::Stored>;

    fn stored(&self) -> Self::Stored {
        self.as_ref().map(T::stored)
    }

    fn read(stored: Self::Stored) -> Result<Self, String> {
        stored.map(T::read).transpose()
    }
}

/// Writes numbers that may be infinite.
///
/// # Errors
///
/// The encoder fails.
pub fn serialize<S: Serializer, T: Numbers>(numbers: &T, to: S) -> Result<S::Ok, S::Error> {
    numbers.stored().serialize(to)
}

/// Reads numbers that may be infinite.
///
/// # Errors
///
/// Data of another type.
pub fn deserialize<'de, D: Deserializer<'de>, T: Numbers>(from: D) -> Result<T, D::Error> {
    let wrong = |result: String| {
        D::Error::invalid_value(Unexpected::Str(&result), &"numbers, `inf`, `-inf` or `nan`")
    };
    T::read(T::Stored::deserialize(from)?).map_err(wrong)
}
