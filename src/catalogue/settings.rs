//! Settings as written in a case file: a tree that knows where each value stands.
//!
//! A page reads its own settings from a [`Settings`] table. Every mistake is recorded with its
//! place and reading goes on, so that one run of the tool lists them all. A page therefore reads
//! every key first and gives up (`?`) afterwards; [`Settings::close`] then reports what was never
//! asked for.

use std::cell::RefCell;
use std::ops::{Range, RangeInclusive};
use std::path::Path;

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
    fn kind(&self) -> &'static str {
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
    fn contains(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Self::Finite => true,
                Self::NonNegative => x >= 0.0,
                Self::Positive => x > 0.0,
                Self::Unit => (0.0..=1.0).contains(&x),
            }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Finite => "a finite number",
            Self::NonNegative => "a finite number that is not negative",
            Self::Positive => "a finite number above 0",
            Self::Unit => "a number from 0 to 1",
        }
    }
}

/// A table that is being read.
#[derive(Debug)]
pub struct Settings<'a> {
    table: &'a [Entry],
    /// Where the table, or the key that names it, stands.
    pub span: Range<usize>,
    /// The path of the table, as in `problem.transmittance.ray`.
    pub path: String,
    /// The folder that relative file names start from.
    pub folder: &'a Path,
    faults: &'a RefCell<Vec<Fault>>,
    asked: RefCell<Vec<&'static str>>,
}

impl<'a> Settings<'a> {
    /// Reads the top-level table of a file in `folder`; mistakes go to `faults`.
    pub fn new(root: &'a [Entry], folder: &'a Path, faults: &'a RefCell<Vec<Fault>>) -> Self {
        let asked = RefCell::default();
        Self { table: root, span: 0..0, path: String::new(), folder, faults, asked }
    }

    /// The entry of a key, if the file has it.
    pub fn entry(&self, key: &'static str) -> Option<&'a Entry> {
        let mut asked = self.asked.borrow_mut();
        if !asked.contains(&key) {
            asked.push(key);
        }
        self.table.iter().find(|entry| entry.key == key)
    }

    /// Whether the file has the key.
    pub fn has(&self, key: &'static str) -> bool {
        self.entry(key).is_some()
    }

    /// Whether the table has no keys at all.
    #[must_use]
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

    fn path_of(&self, key: &str) -> String {
        match (self.path.as_str(), key) {
            ("", key) => key.to_owned(),
            (path, "") => path.to_owned(),
            (path, key) => format!("{path}.{key}"),
        }
    }

    fn wrong(&self, entry: &Entry, wanted: &str) {
        let message = match &entry.node.value {
            Value::Number(x) => format!("`{}` is {x}", entry.key),
            other => format!("`{}` is {}", entry.key, other.kind()),
        };
        let help = format!("it takes {wanted}");
        self.fault_at(entry.node.span.clone(), &entry.key, message, help);
    }

    fn required(&self, key: &'static str, wanted: &str) -> Option<&'a Entry> {
        let entry = self.entry(key);
        if entry.is_none() {
            let message = format!("`{key}` is missing");
            self.fault_at(self.span.clone(), "", message, format!("add `{key}`, {wanted}"));
        }
        entry
    }

    /// A number that must be there.
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

    /// A whole number in a range that must be there; `1e6` counts as whole.
    pub fn count(&self, key: &'static str, range: RangeInclusive<u64>) -> Option<u64> {
        let entry = self.required(key, &whole(&range))?;
        self.count_of(entry, &range)
    }

    /// A whole number in a range, or `default` where the key is absent.
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

    /// A list of numbers, at least `least` of them, that must be there.
    pub fn numbers(&self, key: &'static str, domain: Domain, least: usize) -> Option<Vec<f64>> {
        let wanted = format!("a list of at least {least}, each {}", domain.words());
        let entry = self.required(key, &wanted)?;
        self.list_of(entry, domain, &wanted).filter(|list| {
            let enough = list.len() >= least;
            if !enough {
                self.wrong(entry, &wanted);
            }
            enough
        })
    }

    /// A point or vector `[x, y, z]` that must be there.
    pub fn triple(&self, key: &'static str) -> Option<[f64; 3]> {
        let wanted = "a list of three finite numbers [x, y, z]";
        let entry = self.required(key, wanted)?;
        self.triple_of(entry, Domain::Finite, wanted)
    }

    /// A point or vector, or `default` where the key is absent.
    pub fn triple_or(&self, key: &'static str, default: [f64; 3]) -> Option<[f64; 3]> {
        let wanted = "a list of three finite numbers [x, y, z]";
        match self.entry(key) {
            Some(entry) => self.triple_of(entry, Domain::Finite, wanted),
            None => Some(default),
        }
    }

    /// Three whole numbers in a range that must be there.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just before
    pub fn counts(&self, key: &'static str, range: RangeInclusive<u64>) -> Option<[usize; 3]> {
        let wanted = format!("a list of three, each {}", whole(&range));
        let entry = self.required(key, &wanted)?;
        let triple = self.triple_of(entry, Domain::NonNegative, &wanted)?;
        if triple.iter().all(|x| x.fract() == 0.0 && range.contains(&(*x as u64))) {
            return Some(triple.map(|x| x as usize));
        }
        self.wrong(entry, &wanted);
        None
    }

    /// A list of points or vectors `[[x, y, z], …]` that must be there.
    pub fn triples(&self, key: &'static str) -> Option<Vec<[f64; 3]>> {
        let wanted = "a list of triples of finite numbers [[x, y, z], …]";
        let entry = self.required(key, wanted)?;
        let Value::Array(items) = &entry.node.value else {
            self.wrong(entry, wanted);
            return None;
        };
        let (key, key_span) = (&entry.key, &entry.key_span);
        let triples = items.iter().map(|node| {
            let item = Entry { key: key.clone(), key_span: key_span.clone(), node: node.clone() };
            self.triple_of(&item, Domain::Finite, "three finite numbers [x, y, z] each")
        });
        triples.collect::<Vec<_>>().into_iter().collect()
    }

    fn triple_of(&self, entry: &Entry, domain: Domain, wanted: &str) -> Option<[f64; 3]> {
        let list = self.list_of(entry, domain, wanted)?;
        let triple = <[f64; 3]>::try_from(list);
        if triple.is_err() {
            self.wrong(entry, wanted);
        }
        triple.ok()
    }

    fn list_of(&self, entry: &Entry, domain: Domain, wanted: &str) -> Option<Vec<f64>> {
        let Value::Array(items) = &entry.node.value else {
            self.wrong(entry, wanted);
            return None;
        };
        let mut list = Vec::with_capacity(items.len());
        for item in items {
            match item.value {
                Value::Number(x) if domain.contains(x) => list.push(x),
                _ => {
                    let what = match item.value {
                        Value::Number(x) => format!("{x} stands in `{}`", entry.key),
                        ref other => format!("{} stands in `{}`", other.kind(), entry.key),
                    };
                    let help = format!("each entry is {}", domain.words());
                    self.fault_at(item.span.clone(), &entry.key, what, help);
                }
            }
        }
        (list.len() == items.len()).then_some(list)
    }

    /// A text that must be there.
    pub fn text(&self, key: &'static str) -> Option<String> {
        let entry = self.required(key, "a text in quotes")?;
        let Value::Text(text) = &entry.node.value else {
            self.wrong(entry, "a text in quotes");
            return None;
        };
        Some(text.clone())
    }

    /// One of some words that must be there.
    pub fn word(&self, key: &'static str, words: &[&'static str]) -> Option<&'static str> {
        let wanted = format!("one of {}", quoted(words));
        let entry = self.required(key, &wanted)?;
        self.word_of(entry, words, &wanted)
    }

    /// One of some words, or `default` where the key is absent.
    pub fn word_or(
        &self,
        key: &'static str,
        words: &[&'static str],
        default: &'static str,
    ) -> Option<&'static str> {
        let wanted = format!("one of {}", quoted(words));
        self.entry(key).map_or(Some(default), |entry| self.word_of(entry, words, &wanted))
    }

    fn word_of(&self, entry: &Entry, words: &[&'static str], wanted: &str) -> Option<&'static str> {
        let Value::Text(text) = &entry.node.value else {
            self.wrong(entry, wanted);
            return None;
        };
        let word = words.iter().find(|word| *word == text).copied();
        if word.is_none() {
            let message = format!("`{}` is \"{text}\"", entry.key);
            let help = suggestion(text, words, wanted);
            self.fault_at(entry.node.span.clone(), &entry.key, message, help);
        }
        word
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

    /// A table that must be there.
    pub fn table(&self, key: &'static str) -> Option<Settings<'a>> {
        let entry = self.required(key, "a table")?;
        self.open(entry)
    }

    /// A table, if the file has it.
    pub fn table_if(&self, key: &'static str) -> Option<Settings<'a>> {
        self.entry(key).and_then(|entry| self.open(entry))
    }

    /// The tables of a list that must be there.
    pub fn tables(&self, key: &'static str) -> Option<Vec<Settings<'a>>> {
        let entry = self.required(key, "a list of tables")?;
        let Value::Array(items) = &entry.node.value else {
            self.wrong(entry, "a list of tables");
            return None;
        };
        let mut tables = Vec::with_capacity(items.len());
        for (index, item) in items.iter().enumerate() {
            let path = self.path_of(&format!("{key}[{index}]"));
            if let Value::Table(table) = &item.value {
                tables.push(self.child(table, item.span.clone(), path));
            } else {
                let message = format!("{} stands in `{key}`", item.value.kind());
                let help = "each entry is a table, as in { ratio = {} }";
                self.fault_at(item.span.clone(), key, message, help);
            }
        }
        Some(tables)
    }

    /// A table with exactly one key, which names one of `names`: `{ gaussian = { … } }`. Answers
    /// the position of the name and the table behind it.
    pub fn choice(&self, names: &[String]) -> Option<(usize, Settings<'a>)> {
        let list = quoted(names);
        let [entry] = self.table else {
            let (span, message) = match self.table {
                [] => (self.span.clone(), "nothing is chosen here".to_owned()),
                [_, second, ..] => {
                    (second.key_span.clone(), format!("`{}` is one too many", second.key))
                }
                [_] => unreachable!("one entry is matched above"),
            };
            self.fault_at(span, "", message, format!("choose one of {list}"));
            return None;
        };
        let Some(index) = names.iter().position(|name| *name == entry.key) else {
            let message = format!("`{}` is not known here", entry.key);
            let words: Vec<&str> = names.iter().map(String::as_str).collect();
            let help = suggestion(&entry.key, &words, &format!("one of {list}"));
            self.fault_at(entry.key_span.clone(), "", message, help);
            return None;
        };
        self.open(entry).map(|settings| (index, settings))
    }

    fn open(&self, entry: &'a Entry) -> Option<Settings<'a>> {
        let Value::Table(table) = &entry.node.value else {
            self.wrong(entry, "a table, as in { … }");
            return None;
        };
        Some(self.child(table, entry.key_span.clone(), self.path_of(&entry.key)))
    }

    fn child(&self, table: &'a [Entry], span: Range<usize>, path: String) -> Settings<'a> {
        let asked = RefCell::default();
        Settings { table, span, path, folder: self.folder, faults: self.faults, asked }
    }

    /// Reports every key that was never asked for.
    pub fn close(&self) {
        let asked = self.asked.borrow();
        for entry in self.table.iter().filter(|entry| !asked.contains(&entry.key.as_str())) {
            let message = format!("`{}` is not known here", entry.key);
            let help = if asked.is_empty() {
                "this table takes no keys: write {}".to_owned()
            } else {
                suggestion(&entry.key, &asked, &format!("the keys are {}", quoted(&asked)))
            };
            self.fault_at(entry.key_span.clone(), "", message, help);
        }
    }
}

fn whole(range: &RangeInclusive<u64>) -> String {
    format!("a whole number from {} to {}", range.start(), range.end())
}

fn quoted<S: AsRef<str>>(words: &[S]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`{}`", word.as_ref())).collect();
    words.join(", ")
}

/// "did you mean" where a known word is near, the whole list where none is.
fn suggestion(written: &str, words: &[&str], otherwise: &str) -> String {
    let near = words.iter().map(|word| (distance(written, word), word)).min();
    match near {
        Some((edits, word)) if edits <= 1 + written.len() / 4 => {
            format!("did you mean `{word}`? ({otherwise})")
        }
        _ => otherwise.to_owned(),
    }
}

/// The number of letters to insert, delete or replace (V. Levenshtein, 1966).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replace = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replace.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(key: &str, x: f64) -> Entry {
        let node = Node { value: Value::Number(x), span: 5..6 };
        Entry { key: key.into(), key_span: 0..3, node }
    }

    #[test]
    fn every_mistake_is_recorded() {
        let table = [number("extinction", -1.0), number("lenght", 2.0)];
        let faults = RefCell::default();
        let settings = Settings::new(&table, Path::new("."), &faults);
        assert_eq!(settings.number("extinction", Domain::NonNegative), None);
        assert_eq!(settings.number("length", Domain::Positive), None);
        settings.close();
        let faults = faults.into_inner();
        assert_eq!(faults.len(), 3);
        assert_eq!(faults[0].message, "`extinction` is -1");
        assert_eq!(faults[1].message, "`length` is missing");
        assert!(faults[2].help.starts_with("did you mean `length`?"));
    }

    #[test]
    fn a_list_of_triples_refuses_a_pair() {
        let list = |items: Vec<Value>| {
            let nodes = items.into_iter().map(|value| Node { value, span: 7..8 }).collect();
            Value::Array(nodes)
        };
        let numbers = |n: usize| list(vec![Value::Number(1.0); n]);
        let node = Node { value: list(vec![numbers(3), numbers(2)]), span: 5..9 };
        let table = [Entry { key: "vectors".into(), key_span: 0..3, node }];
        let faults = RefCell::default();
        let settings = Settings::new(&table, Path::new("."), &faults);
        assert_eq!(settings.triples("vectors"), None);
        assert_eq!(faults.into_inner().len(), 1);
    }

    #[test]
    fn a_count_may_be_written_as_a_float() {
        let table = [number("draws", 1e6)];
        let faults = RefCell::default();
        let settings = Settings::new(&table, Path::new("."), &faults);
        assert_eq!(settings.count("draws", 1..=u64::MAX), Some(1_000_000));
    }
}
