//! A case file as a tree with the place of each value, and its mistakes.

use std::ops::Range;

use serde::ser::{Serialize, SerializeMap, Serializer};

/// A value and its bytes in the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Place, in bytes from the beginning of the file.
    pub span: Range<usize>,
}

/// The kinds of values a case file has.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// `{ key = value, … }` or `[section]`.
    Table(Vec<Entry>),
    /// `[value, …]`.
    Array(Vec<Node>),
    /// A number, integral or not.
    Number(f64),
    /// `"text"`.
    Text(String),
    /// `true` or `false`.
    Boolean(bool),
    /// Any other TOML value, such as a date; no setting takes it.
    Other(&'static str),
}

impl Value {
    /// A table with one key.
    pub fn keyed(key: &str, value: Self) -> Self {
        Self::Table(vec![Entry::new(key, value)])
    }

    /// A list of numbers.
    pub fn numbers(list: impl IntoIterator<Item = f64>) -> Self {
        Self::Array(list.into_iter().map(|x| Self::Number(x).into()).collect())
    }

    /// The value without places.
    #[must_use]
    pub fn unplaced(&self) -> Self {
        match self {
            Self::Table(entries) => {
                let entries = entries.iter();
                Self::Table(
                    entries.map(|one| Entry::new(&*one.key, one.node.value.unplaced())).collect(),
                )
            }
            Self::Array(items) => {
                Self::Array(items.iter().map(|item| item.value.unplaced().into()).collect())
            }
            other => other.clone(),
        }
    }

    pub(super) fn kind(&self) -> &'static str {
        match self {
            Self::Table(_) => "a table",
            Self::Array(_) => "a list",
            Self::Number(_) => "a number",
            Self::Text(_) => "a text",
            Self::Boolean(_) => "true or false",
            Self::Other(kind) => kind,
        }
    }
}

/// Serializes the value without places.
impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Table(entries) => {
                let mut map = serializer.serialize_map(Some(entries.len()))?;
                for entry in entries {
                    map.serialize_entry(&entry.key, &entry.node.value)?;
                }
                map.end()
            }
            Self::Array(items) => serializer.collect_seq(items.iter().map(|item| &item.value)),
            Self::Number(x) => serializer.serialize_f64(*x),
            Self::Text(text) => serializer.serialize_str(text),
            Self::Boolean(flag) => serializer.serialize_bool(*flag),
            Self::Other(what) => serializer.serialize_str(what),
        }
    }
}

/// A `key = value`.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Place of the key.
    pub key_span: Range<usize>,
    /// Value of the key.
    pub node: Node,
}

/// A value that no file has: it has no place.
impl From<Value> for Node {
    fn from(value: Value) -> Self {
        Self { value, span: 0..0 }
    }
}

impl Entry {
    /// A `key = value` that no file has.
    pub fn new(key: impl Into<String>, value: Value) -> Self {
        Self { key: key.into(), key_span: 0..0, node: value.into() }
    }
}

/// A mistake: its place, the error and the correction.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The bytes of the file that are wrong.
    pub span: Range<usize>,
    /// The path of the key, such as `problem.transmittance.ray.length`.
    pub path: String,
    /// The error.
    pub message: String,
    /// The correction.
    pub help: String,
}

/// Domain of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Domain {
    /// Any finite number.
    Finite,
    /// A finite number ≥ 0.
    NonNegative,
    /// A finite number > 0.
    Positive,
    /// A number in `[0, 1]`.
    Unit,
}

impl Domain {
    /// Returns whether the number is in the domain.
    pub fn contains(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Self::Finite => true,
                Self::NonNegative => x >= 0.0,
                Self::Positive => x > 0.0,
                Self::Unit => (0.0..=1.0).contains(&x),
            }
    }

    /// The domain in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::NonNegative => "a finite number that is not negative",
            Self::Positive => "a finite number above 0",
            Self::Unit => "a number from 0 to 1",
        }
    }
}
