//! Tables in code, for the unit tests of readers.

use std::cell::RefCell;
use std::path::Path;

use super::{Entry, Node, Settings, Value};

fn entries<const N: usize>(entries: [(&str, Value); N]) -> Vec<Entry> {
    let entry = |(key, value): (&str, Value)| Entry {
        key: key.into(),
        key_span: 0..3,
        node: Node { value, span: 5..6 },
    };
    entries.map(entry).into()
}

/// `{ key = value, … }`.
pub fn table<const N: usize>(settings: [(&str, Value); N]) -> Value {
    Value::Table(entries(settings))
}

/// `[x, …]`.
pub fn list(numbers: &[f64]) -> Value {
    let node = |&x: &f64| Node { value: Value::Number(x), span: 5..6 };
    Value::Array(numbers.iter().map(node).collect())
}

/// The value that is read from settings, and the messages of all mistakes.
pub fn read<T, const N: usize>(
    settings: [(&str, Value); N],
    read: impl FnOnce(&Settings) -> T,
) -> (T, Vec<String>) {
    let (table, faults) = (entries(settings), RefCell::default());
    let result = read(&Settings::new(&table, Path::new("."), &faults));
    (result, faults.into_inner().into_iter().map(|fault| fault.message).collect())
}
