//! A case or a picture as written: parsed once, a tree of settings that says where each value stands.
//!
//! ```text
//! text → Spec → typed problem, medium and estimators        (cases, pictures, exports)
//!        Spec → Spec at a value of a sweep → the same        (sweeps of the medium)
//!        Spec → text                                         (programs that write cases)
//! ```
//!
//! Short forms are spelled out: `sampling = 2` and `sampling.constant.value = 2` are the same tree. It serialises to the
//! document that it was parsed from, without places.

use std::cell::RefCell;
use std::path::Path;

use serde::{Serialize, Serializer};
use toml::de::{DeTable, DeValue};

use crate::case::shorthand::spell_out;
use crate::case::source::{CaseError, NOT_TOML, Source};
use media::catalogue::{Additions, Entry, Fault, Node, Settings, Value};

/// A case or a picture, parsed.
#[derive(Debug, Clone)]
pub struct Spec {
    source: Source,
    root: Vec<Entry>,
    /// Mistakes in short forms.
    faults: Vec<Fault>,
    additions: Additions,
}

impl Serialize for Spec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.root.iter().map(|entry| (&entry.key, &entry.node.value)))
    }
}

impl Spec {
    /// Parses a text for a catalogue with a program's own pages.
    ///
    /// # Errors
    ///
    /// A text that is not TOML.
    pub fn parse(source: &Source, additions: &Additions) -> Result<Self, CaseError> {
        let faults = RefCell::default();
        let mut root = source.parse(&faults);
        if !faults.borrow().is_empty() {
            // Half a file is missing keys that the other half may hold: nothing else is reported.
            return Err(source.faulty(faults.into_inner()));
        }
        spell_out(&mut root, &faults);
        let (source, additions) = (source.clone(), additions.clone());
        Ok(Self { source, root, faults: faults.into_inner(), additions })
    }

    /// The text that it was parsed from.
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The pages of the program's own.
    pub fn additions(&self) -> &Additions {
        &self.additions
    }

    /// Reads what it says; `read` records mistakes and returns `None` after one.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read<T>(&self, read: impl FnOnce(&Settings) -> Option<T>) -> Result<T, CaseError> {
        let (found, further) = self.attempt(read);
        let faults: Vec<Fault> = self.faults.iter().cloned().chain(further).collect();
        match found {
            Some(found) if faults.is_empty() => Ok(found),
            _ => Err(self.source.faulty(faults)),
        }
    }

    /// Reads what it says, with the mistakes found.
    pub(super) fn attempt<T>(
        &self,
        read: impl FnOnce(&Settings) -> Option<T>,
    ) -> (Option<T>, Vec<Fault>) {
        let faults = RefCell::default();
        let folder = self.source.path.parent().unwrap_or(Path::new(""));
        let settings = Settings::new(&self.root, folder, &faults).with(&self.additions);
        let found = read(&settings);
        drop(settings);
        (found, faults.into_inner())
    }

    /// Entries of the file's top level.
    pub fn entries(&self) -> &[Entry] {
        &self.root
    }

    /// The name of a case's problem, and its settings; `None` without one.
    pub fn problem(&self) -> Option<(&str, &[Entry])> {
        let Value::Table(problems) = &entry(&self.root, "problem")?.node.value else { return None };
        let Entry { key, node, .. } = problems.first()?;
        let Value::Table(settings) = &node.value else { return None };
        Some((key, settings))
    }

    /// The settings of a case's problem, to be changed; `None` without one.
    pub(super) fn problem_mut(&mut self) -> Option<&mut Vec<Entry>> {
        let problem = self.root.iter_mut().find(|entry| entry.key == "problem")?;
        let Value::Table(problems) = &mut problem.node.value else { return None };
        let Value::Table(settings) = &mut problems.first_mut()?.node.value else { return None };
        Some(settings)
    }

    /// Writes the case again with a sweep in place of its own.
    ///
    /// # Errors
    ///
    /// Mistakes in short forms.
    pub fn with_sweep(&self, what: &str, values: &[f64]) -> Result<Self, CaseError> {
        if !self.faults.is_empty() {
            return Err(self.source.faulty(self.faults.clone()));
        }
        let node = |value| Node { value, span: 0..0 };
        let entry =
            |key: &str, value| Entry { key: key.to_owned(), key_span: 0..0, node: node(value) };
        let values = values.iter().map(|&value| node(Value::Number(value))).collect();
        let values = Value::Table(vec![entry("values", Value::Array(values))]);
        let sweep = entry("sweep", Value::Table(vec![entry(what, values)]));
        let mut changed = self.clone();
        if let Some(settings) = changed.problem_mut() {
            settings.retain(|entry| entry.key != "sweep");
            settings.push(sweep);
        }
        let text = toml::to_string(&changed).map_err(|cause| CaseError::Unwritable {
            name: self.source.name.clone(),
            cause: Box::new(cause),
        })?;
        Self::parse(&Source { text, ..self.source.clone() }, &self.additions)
    }
}

/// The entry of a key in a table.
pub(super) fn entry<'a>(table: &'a [Entry], key: &str) -> Option<&'a Entry> {
    table.iter().find(|entry| entry.key == key)
}

impl Source {
    /// Parses the text as it stands, short forms included; syntax errors are recorded, and what could be read is
    /// returned.
    pub fn parse(&self, faults: &RefCell<Vec<Fault>>) -> Vec<Entry> {
        let (table, errors) = DeTable::parse_recoverable(&self.text);
        for error in errors {
            faults.borrow_mut().push(Fault {
                span: error.span().unwrap_or_default(),
                path: String::new(),
                message: error.message().replace('\n', ", "),
                help: NOT_TOML.into(),
            });
        }
        entries(table.get_ref())
    }
}

fn entries(table: &DeTable<'_>) -> Vec<Entry> {
    let entry = |(key, value): (&toml::Spanned<_>, &toml::Spanned<DeValue<'_>>)| {
        let key: &toml::Spanned<std::borrow::Cow<'_, str>> = key;
        let node = Node { value: read(value.get_ref()), span: value.span() };
        Entry { key: key.get_ref().to_string(), key_span: key.span(), node }
    };
    let mut entries: Vec<Entry> = table.iter().map(entry).collect();
    entries.sort_by_key(|entry| entry.key_span.start);
    entries
}

fn read(value: &DeValue<'_>) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(number) => {
            let digits = i128::from_str_radix(number.as_str(), number.radix());
            digits.map_or(Value::Other("a number too large"), |n| Value::Number(n as f64))
        }
        DeValue::Float(number) => {
            number.as_str().parse().map_or(Value::Other("an unreadable number"), Value::Number)
        }
        DeValue::Boolean(flag) => Value::Boolean(*flag),
        DeValue::Datetime(_) => Value::Other("a date"),
        DeValue::Array(items) => Value::Array(
            items
                .iter()
                .map(|item| Node { value: read(item.get_ref()), span: item.span() })
                .collect(),
        ),
        DeValue::Table(table) => Value::Table(entries(table)),
    }
}
