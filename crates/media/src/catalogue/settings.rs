//! Settings as written in a case file: a tree with the place of each value.
//!
//! A page reads its own settings from a [`Settings`] table. Every mistake is recorded with its place and reading
//! goes on, so that one run of the tool lists them all. A page therefore reads every key first and gives up (`?`)
//! afterwards; [`Settings::close`] then reports keys that were not read.

use std::cell::RefCell;
use std::ops::{Range, RangeInclusive};
use std::path::Path;

use super::choices::Form;
use super::own_pages::{self, OwnPages};
use super::words::{meant, quoted, whole};
use super::{Domain, Entry, Fault, Value};
use numeric::digits::number;

/// A mistake in a setting, which is recorded with its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mistake;

/// A table that is being read.
#[derive(Debug)]
pub struct Settings<'a> {
    pub(super) table: &'a [Entry],
    /// Place of the table, or of the key that names it.
    pub span: Range<usize>,
    /// The path of the table, such as `problem.transmittance.ray`.
    pub path: String,
    /// The folder that relative file names refer to.
    pub folder: &'a Path,
    pub(super) faults: &'a RefCell<Vec<Fault>>,
    own_pages: &'a OwnPages,
    requested: RefCell<Vec<&'static str>>,
    pub(super) form: Form<'a>,
}

impl<'a> Settings<'a> {
    /// Reads the top-level table of a file in `folder`; mistakes go to `faults`.
    pub fn new(root: &'a [Entry], folder: &'a Path, faults: &'a RefCell<Vec<Fault>>) -> Self {
        let (requested, form) = (RefCell::default(), Form::Table);
        let own_pages = &own_pages::NONE;
        let path = String::new();
        Self { table: root, span: 0..0, path, folder, faults, own_pages, requested, form }
    }

    /// Settings with pages of the program's own.
    #[must_use]
    pub fn with(self, own_pages: &'a OwnPages) -> Self {
        Self { own_pages, ..self }
    }

    /// The pages of the program's own.
    pub fn own_pages(&self) -> &'a OwnPages {
        self.own_pages
    }

    /// The entry of a key, if the file has it.
    pub fn entry(&self, key: &'static str) -> Option<&'a Entry> {
        let mut requested = self.requested.borrow_mut();
        if !requested.contains(&key) {
            requested.push(key);
        }
        self.table.iter().find(|entry| entry.key == key)
    }

    /// Entries of the table.
    pub fn entries(&self) -> &'a [Entry] {
        self.table
    }

    /// Returns whether the file has the key.
    pub fn has(&self, key: &'static str) -> bool {
        self.entry(key).is_some()
    }

    /// Returns the value that `read` returns if the file has the key; `None` if it does not.
    ///
    /// # Errors
    ///
    /// `read` has recorded a mistake.
    pub fn optional<T>(
        &self,
        key: &'static str,
        read: impl FnOnce(&'static str) -> Option<T>,
    ) -> Result<Option<T>, Mistake> {
        if self.has(key) { read(key).map(Some).ok_or(Mistake) } else { Ok(None) }
    }

    /// Returns whether the table has no keys.
    pub fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// Records a mistake at a place of the file.
    pub fn fault_at(
        &self,
        span: Range<usize>,
        key: &str,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let path = self.path_of(key);
        let fault = Fault { span, path, message: message.into(), help: help.into() };
        self.faults.borrow_mut().push(fault);
    }

    /// Records a mistake in the value of a key, or in the table where the key is absent.
    pub fn fault(&self, key: &'static str, message: impl Into<String>, help: impl Into<String>) {
        let span = self.entry(key).map_or(self.span.clone(), |entry| entry.node.span.clone());
        self.fault_at(span, key, message, help);
    }

    pub(super) fn path_of(&self, key: &str) -> String {
        match (self.path.as_str(), key) {
            ("", key) => key.to_owned(),
            (path, "") => path.to_owned(),
            (path, key) => format!("{path}.{key}"),
        }
    }

    pub(super) fn wrong(&self, entry: &Entry, expected: &str) {
        let message = match &entry.node.value {
            Value::Number(x) => format!("`{}` is {}", entry.key, number(*x)),
            other => format!("`{}` is {}", entry.key, other.kind()),
        };
        let help = format!("it takes {expected}");
        self.fault_at(entry.node.span.clone(), &entry.key, message, help);
    }

    pub(super) fn required(&self, key: &'static str, expected: &str) -> Option<&'a Entry> {
        let entry = self.entry(key);
        if entry.is_none() {
            self.missing(key, expected);
        }
        entry
    }

    /// A required number.
    pub fn number(&self, key: &'static str, domain: Domain) -> Option<f64> {
        let entry = self.required(key, domain.words())?;
        self.number_of(entry, domain)
    }

    /// A number, or `default` where the key is absent.
    pub fn number_or(&self, key: &'static str, domain: Domain, default: f64) -> Option<f64> {
        self.entry(key).map_or(Some(default), |entry| self.number_of(entry, domain))
    }

    fn number_of(&self, entry: &Entry, domain: Domain) -> Option<f64> {
        match entry.node.value {
            Value::Number(x) if domain.contains(x) => Some(x),
            _ => {
                self.wrong(entry, domain.words());
                None
            }
        }
    }

    /// A required integer in a range; `1e6` is an integer.
    pub fn count(&self, key: &'static str, range: RangeInclusive<u64>) -> Option<u64> {
        let entry = self.required(key, &whole(&range))?;
        self.count_of(entry, &range)
    }

    /// An integer in a range, or `default` where the key is absent.
    pub fn count_or(
        &self,
        key: &'static str,
        range: RangeInclusive<u64>,
        default: u64,
    ) -> Option<u64> {
        self.entry(key).map_or(Some(default), |entry| self.count_of(entry, &range))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just before
    fn count_of(&self, entry: &Entry, range: &RangeInclusive<u64>) -> Option<u64> {
        if let Value::Number(x) = entry.node.value
            && x.fract() == 0.0
            && (0.0..=9e15).contains(&x)
            && range.contains(&(x as u64))
        {
            return Some(x as u64);
        }
        self.wrong(entry, &whole(range));
        None
    }

    /// A required text.
    pub fn text(&self, key: &'static str) -> Option<String> {
        let entry = self.required(key, "a text in quotes")?;
        let Value::Text(text) = &entry.node.value else {
            self.wrong(entry, "a text in quotes");
            return None;
        };
        Some(text.clone())
    }

    /// `true` or `false`, or `default` where the key is absent.
    pub fn flag_or(&self, key: &'static str, default: bool) -> Option<bool> {
        let Some(entry) = self.entry(key) else { return Some(default) };
        let Value::Boolean(flag) = entry.node.value else {
            self.wrong(entry, "true or false");
            return None;
        };
        Some(flag)
    }

    /// A required table.
    pub fn table(&self, key: &'static str) -> Option<Settings<'a>> {
        let entry = self.required(key, "a table")?;
        self.open(entry)
    }

    /// A table, if the file has it.
    pub fn table_if(&self, key: &'static str) -> Option<Settings<'a>> {
        self.entry(key).and_then(|entry| self.open(entry))
    }

    pub(super) fn open(&self, entry: &'a Entry) -> Option<Settings<'a>> {
        let Value::Table(table) = &entry.node.value else {
            self.wrong(entry, "a table, as in { … }");
            return None;
        };
        Some(self.child(table, entry.key_span.clone(), self.path_of(&entry.key)))
    }

    pub(super) fn child(
        &self,
        table: &'a [Entry],
        span: Range<usize>,
        path: String,
    ) -> Settings<'a> {
        let (requested, form) = (RefCell::default(), Form::Table);
        Settings { table, span, path, requested, form, ..*self }
    }

    /// Reports every key that was not read.
    pub fn close(&self) {
        let requested = self.requested.borrow();
        for entry in self.table.iter().filter(|entry| !requested.contains(&entry.key.as_str())) {
            let message = format!("`{}` is not known here", entry.key);
            let help = if requested.is_empty() {
                "this table takes no keys: write {}".to_owned()
            } else {
                meant(&entry.key, &requested, &format!("the keys are {}", quoted(&requested)))
            };
            self.fault_at(entry.key_span.clone(), "", message, help);
        }
    }
}
