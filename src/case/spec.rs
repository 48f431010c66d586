//! Case or picture as written: parsed once into a tree of settings with the place of each value.
//!
//! ```text
//! text → Spec → typed problem, medium and estimators        (cases, pictures, exports)
//!        Spec → Spec at a value of a sweep → the same        (sweeps of the medium)
//!        Spec → text                                         (programs that write cases)
//! ```
//!
//! Short forms are expanded: `sampling = 2` and `sampling.constant.value = 2` are the same tree. It serialises to the
//! document that it was parsed from, without places.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use serde::{Serialize, Serializer};
use toml::de::{DeTable, DeValue};

use crate::case::channels::read_single_channels;
use crate::case::shorthand::spell_out;
use media::catalogue::{Entry, Fault, Node, OwnPages, Settings, Value};
use numeric::digits::counted;

/// Parsed case or picture.
#[derive(Debug, Clone)]
pub struct Spec {
    source: CaseText,
    root: Vec<Entry>,
    /// Mistakes in short forms.
    faults: Vec<Fault>,
    own_pages: OwnPages,
}

impl Serialize for Spec {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.root.iter().map(|entry| (&entry.key, &entry.node.value)))
    }
}

impl Spec {
    /// Parses a text for a catalogue with the pages that a program adds.
    ///
    /// # Errors
    ///
    /// The text is not TOML.
    pub fn parse(source: &CaseText, own_pages: &OwnPages) -> Result<Self, CaseError> {
        let faults = RefCell::default();
        let mut root = source.parse(&faults);
        if !faults.borrow().is_empty() {
            // A part of a file lacks keys that the rest may hold: nothing but the syntax error is reported.
            return Err(source.faulty(faults.into_inner()));
        }
        spell_out(&mut root, &faults);
        read_single_channels(&mut root, own_pages);
        let (source, own_pages) = (source.clone(), own_pages.clone());
        Ok(Self { source, root, faults: faults.into_inner(), own_pages })
    }

    /// Returns the text that it was parsed from.
    pub fn source(&self) -> &CaseText {
        &self.source
    }

    /// Returns the pages that the program adds.
    pub fn own_pages(&self) -> &OwnPages {
        &self.own_pages
    }

    /// Reads the spec; `read` records mistakes and returns `None` after one.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read<T>(&self, read: impl FnOnce(&Settings) -> Option<T>) -> Result<T, CaseError> {
        let (actual, further) = self.attempt(read);
        let faults: Vec<Fault> = self.faults.iter().cloned().chain(further).collect();
        match actual {
            Some(actual) if faults.is_empty() => Ok(actual),
            _ => Err(self.source.faulty(faults)),
        }
    }

    /// Reads the spec, and returns the mistakes found as well.
    pub(super) fn attempt<T>(
        &self,
        read: impl FnOnce(&Settings) -> Option<T>,
    ) -> (Option<T>, Vec<Fault>) {
        let faults = RefCell::default();
        let folder = self.source.path.parent().unwrap_or(Path::new(""));
        let settings = Settings::new(&self.root, folder, &faults).with(&self.own_pages);
        let actual = read(&settings);
        drop(settings);
        (actual, faults.into_inner())
    }

    /// Returns the name of a case's problem, and its settings; `None` without one.
    pub fn problem(&self) -> Option<(&str, &[Entry])> {
        let Value::Table(problems) = &entry(&self.root, "problem")?.node.value else { return None };
        let Entry { key, node, .. } = problems.first()?;
        let Value::Table(settings) = &node.value else { return None };
        Some((key, settings))
    }

    /// Returns the settings of a case's problem, to be changed; `None` without one.
    pub(super) fn problem_mut(&mut self) -> Option<&mut Vec<Entry>> {
        let problem = self.root.iter_mut().find(|entry| entry.key == "problem")?;
        let Value::Table(problems) = &mut problem.node.value else { return None };
        let Value::Table(settings) = &mut problems.first_mut()?.node.value else { return None };
        Some(settings)
    }

    /// Returns the spec with changed settings of its problem.
    #[must_use]
    pub fn with_problem(&self, change: impl FnOnce(&mut Vec<Entry>)) -> Self {
        let mut changed = self.clone();
        if let Some(settings) = changed.problem_mut() {
            change(settings);
        }
        changed
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
        let values = Value::keyed("values", Value::numbers(values.iter().copied()));
        let sweep = Entry::new("sweep", Value::keyed(what, values));
        let changed = self.with_problem(|settings| {
            settings.retain(|entry| entry.key != "sweep");
            settings.push(sweep);
        });
        let text = toml::to_string(&changed).map_err(|cause| CaseError::Unwritable {
            name: self.source.name.clone(),
            cause: Box::new(cause),
        })?;
        Self::parse(&CaseText { text, ..self.source.clone() }, &self.own_pages)
    }
}

/// Returns the entry of a key in a table.
pub(super) fn entry<'a>(table: &'a [Entry], key: &str) -> Option<&'a Entry> {
    table.iter().find(|entry| entry.key == key)
}

/// Largest number of mistakes that are shown in place; more are counted.
const TOLD: usize = 50;

/// Help text of a syntax error.
const NOT_TOML: &str = "this is not TOML";

/// Files that are built into the binary.
#[derive(Debug, Clone, Copy)]
pub struct BuiltIn {
    /// Prefix of their names in their paths.
    pub folder: &'static str,
    /// Their names with their text.
    pub files: &'static [(&'static str, &'static str)],
}

impl BuiltIn {
    /// Returns all files, in order.
    pub fn all(self) -> Vec<CaseText> {
        self.files.iter().map(|file| self.source(file)).collect()
    }

    /// Returns the file of a name.
    pub fn find(self, name: &str) -> Option<CaseText> {
        self.files.iter().find(|file| file.0 == name).map(|file| self.source(file))
    }

    fn source(self, (name, text): &(&str, &str)) -> CaseText {
        let path = PathBuf::from(format!("{}{name}.toml", self.folder));
        CaseText { name: (*name).to_owned(), path, text: (*text).to_owned() }
    }
}

/// The text of a case file and where it came from.
#[derive(Debug, Clone)]
pub struct CaseText {
    /// The case's name, as in `transmittance/eq21-sweep`.
    pub name: String,
    /// The file, or the name of a case built into the binary.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
}

/// Error of a case file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// The file could not be read.
    #[error("{path}: {cause}; give a case file, a folder of them, or the name of a built-in case")]
    Unreadable {
        /// The path as given.
        path: String,
        /// Error of the system.
        cause: std::io::Error,
    },
    /// No file and no built-in case has the name.
    #[error("{name}: there is no such file, folder or built-in case; {hint}")]
    Unknown {
        /// The name.
        name: String,
        /// Name that may have been meant.
        hint: String,
    },
    /// Name that no report could show.
    #[error("{name:?}: a case's name has no control characters; rename the file")]
    Name {
        /// The name.
        name: String,
    },
    /// A folder holds no case files.
    #[error("{path}: no case file (*.toml) in this folder")]
    Empty {
        /// The folder.
        path: String,
    },
    /// A case that was changed cannot be written as text.
    #[error("{name}: the case cannot be written as TOML: {cause}; write the file yourself")]
    Unwritable {
        /// The case's name.
        name: String,
        /// Error of the writer.
        cause: Box<toml::ser::Error>,
    },
    /// The file's contents are wrong.
    #[error("{} in {}", counted(faults.len() as u64, "mistake"), source_text.path.display())]
    Faulty {
        /// The file.
        source_text: CaseText,
        /// Every mistake found, in the order of the file.
        faults: Vec<Fault>,
    },
}

impl CaseError {
    /// Returns the number of mistakes.
    pub fn mistakes(&self) -> usize {
        if let Self::Faulty { faults, .. } = self { faults.len() } else { 1 }
    }

    /// Returns the error, and below it the lines of the file it is about, where there are any; without colours.
    pub fn in_full(&self) -> String {
        match self {
            Self::Faulty { .. } => format!("{self}\n\n{}", self.render(false)),
            other => other.to_string(),
        }
    }

    /// Returns the error with the lines of the file it is about, a caret under each mistake.
    pub fn render(&self, colour: bool) -> String {
        let Self::Faulty { source_text, faults } = self else {
            return format!("error: {self}");
        };
        let (told, rest) = faults.split_at(faults.len().min(TOLD));
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let path = source_text.path.display().to_string();
        let shown = told.iter().map(|fault| {
            let title = if fault.path.is_empty() {
                fault.message.clone()
            } else {
                format!("{} (in {})", fault.message, fault.path)
            };
            let end = source_text.text.len();
            let span = fault.span.start.min(end)..fault.span.end.min(end);
            let annotation = AnnotationKind::Primary.span(span).label(fault.help.as_str());
            let snippet = Snippet::source(source_text.text.as_str())
                .path(path.as_str())
                .annotation(annotation);
            renderer.render(&[Level::ERROR.primary_title(title).element(snippet)])
        });
        let mut shown: Vec<String> = shown.collect();
        if !rest.is_empty() {
            shown.push(format!("error: {} more mistakes in {path}", rest.len()));
        }
        shown.join("\n\n")
    }
}

impl CaseText {
    /// Reads a file; its name is its path below a folder called `cases`, or its file name, wherever it
    /// is read from.
    ///
    /// # Errors
    ///
    /// The file cannot be read as text.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let text = std::fs::read_to_string(path)
            .map_err(|cause| CaseError::Unreadable { path: path.display().to_string(), cause })?;
        let whole = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let parts: Vec<String> = whole
            .with_extension("")
            .components()
            .map(|part| part.as_os_str().to_string_lossy().into_owned())
            .collect();
        let below = parts.iter().rposition(|part| part == "cases").map(|at| at + 1);
        let name = match below {
            Some(at) if at < parts.len() => parts[at..].join("/"),
            _ => parts.last().cloned().unwrap_or_default(),
        };
        if name.chars().any(char::is_control) {
            return Err(CaseError::Name { name });
        }
        Ok(Self { name, path: path.to_owned(), text })
    }

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

    /// Returns the error that lists these mistakes, in the order of the file.
    fn faulty(&self, mut faults: Vec<Fault>) -> CaseError {
        faults.sort_by_key(|fault| fault.span.start);
        CaseError::Faulty { source_text: self.clone(), faults }
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
