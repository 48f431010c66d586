//! A case file as text, and its mistakes shown in place.

use std::path::{Path, PathBuf};

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use media::catalogue::Fault;

/// Largest number of mistakes that are shown in place; more are counted.
const TOLD: usize = 50;

/// Help text of a syntax error.
pub(super) const NOT_TOML: &str = "this is not TOML";

/// Files that are built into the binary.
#[derive(Debug, Clone, Copy)]
pub struct BuiltIn {
    /// Prefix of their names in their paths.
    pub folder: &'static str,
    /// Their names with their text.
    pub files: &'static [(&'static str, &'static str)],
}

impl BuiltIn {
    /// All files, in order.
    pub fn all(self) -> Vec<Source> {
        self.files.iter().map(|file| self.source(file)).collect()
    }

    /// The file of a name.
    pub fn find(self, name: &str) -> Option<Source> {
        self.files.iter().find(|file| file.0 == name).map(|file| self.source(file))
    }

    fn source(self, (name, text): &(&str, &str)) -> Source {
        let path = PathBuf::from(format!("{}{name}.toml", self.folder));
        Source { name: (*name).to_owned(), path, text: (*text).to_owned() }
    }
}

/// The text of a case file and where it came from.
#[derive(Debug, Clone)]
pub struct Source {
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
    /// A name that no report could show.
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
    #[error("{} mistake(s) in {}", faults.len(), source_text.path.display())]
    Faulty {
        /// The file.
        source_text: Source,
        /// Every mistake found, in the order of the file.
        faults: Vec<Fault>,
    },
}

impl CaseError {
    /// Number of mistakes.
    pub fn mistakes(&self) -> usize {
        if let Self::Faulty { faults, .. } = self { faults.len() } else { 1 }
    }

    /// The error, and below it the lines of the file it is about, where there are any; without colours.
    pub fn in_full(&self) -> String {
        match self {
            Self::Faulty { .. } => format!("{self}\n\n{}", self.render(false)),
            other => other.to_string(),
        }
    }

    /// The error with the lines of the file it is about, a caret under each mistake.
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

impl Source {
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

    /// The error that lists these mistakes, in the order of the file.
    pub(super) fn faulty(&self, mut faults: Vec<Fault>) -> CaseError {
        faults.sort_by_key(|fault| fault.span.start);
        CaseError::Faulty { source_text: self.clone(), faults }
    }
}
