//! A case file as a tree that knows where each value stands, and its mistakes.

use std::ops::Range;

use serde::ser::{Serialize, SerializeMap, Serializer};

/// A value and the bytes of the file that it stands in.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What is written.
    pub value: Value,
    /// Where, in bytes from the beginning of the file.
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
    /// Anything else TOML knows, such as a date; nothing in a case file takes it.
    Other(&'static str),
}

impl Value {
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

/// Writes what stands in the file, without places.
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

/// One `key = value`.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub key_span: Range<usize>,
    /// Its value.
    pub node: Node,
}

/// One mistake: where, what, and what would be right.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The bytes of the file that are wrong.
    pub span: Range<usize>,
    /// The path of the key, as in `problem.transmittance.ray.length`.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// Which numbers a setting takes.
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
    /// Whether the number is in it.
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
