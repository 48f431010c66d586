//! Catalogue of names: the built-in pages, and the pages that a program adds.
//!
//! A program adds its media and estimators before it reads a case. From then on case files name them, and plots,
//! verdicts, `bench` and `explain` treat them as built-in ones.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::case::spec::{CaseError, CaseText};
use crate::case::{Case, suite};
use estimators::{self, Estimated};
use media;
use media::catalogue::{OwnPage, OwnPages, Page, suggestion};
use theory::problems::{MultipleScattering, Named};

/// Built-in pages together with those that a program adds.
///
/// ```
/// use trueflight::catalogue::{OwnPage, Page};
/// use trueflight::case::CaseText;
/// use trueflight::{Catalogue, media::own::Formula};
///
/// let page = Page { module: "haze", source: "Haze that thins out with the height." };
/// let haze = OwnPage::line(page, &[], |_| Some(Formula::new(|t: f64| 1.0 / (1.0 + t * t))));
/// let catalogue = Catalogue::builtin().with(haze)?;
/// let case = catalogue.read(&CaseText {
///     name: "mine".into(),
///     path: "mine.toml".into(),
///     text: r#"
///         title = "Haze"
///         [problem.transmittance]
///         medium.haze = {}
///         span = [0, 1]
///         estimators = [{ ratio = { sampling.constant.value = 1.0 } }]
///     "#
///     .into(),
/// });
/// assert_eq!(case.expect("a case without mistakes").scenario.medium(), "haze");
/// # Ok::<(), trueflight::case::catalogue::NameTaken>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Catalogue {
    own_pages: OwnPages,
}

/// Error of a page that has the name of another one.
#[derive(Debug, thiserror::Error)]
#[error("`{name}` is the name of another page ({part}); choose another name")]
pub struct NameTaken {
    /// The name.
    pub name: String,
    /// Part of the catalogue in which it is taken.
    pub part: String,
}

impl Catalogue {
    /// Returns the built-in pages alone.
    pub fn builtin() -> Self {
        Self::default()
    }

    /// Adds a page.
    ///
    /// # Errors
    ///
    /// A page of the same part has its name.
    pub fn with(mut self, own_page: OwnPage) -> Result<Self, NameTaken> {
        let (name, part) = (own_page.page.name(), own_page.part.clone());
        let built_in = built_in().into_iter().filter(|(other, _)| *other == part);
        let mut taken = built_in.flat_map(|(_, pages)| pages).map(Page::name);
        let own = self.own_pages.all().iter().filter(|other| other.part == part);
        if taken.any(|other| other == name) || own.map(|o| o.page.name()).any(|o| o == name) {
            return Err(NameTaken { name, part });
        }
        self.own_pages.add(own_page);
        Ok(self)
    }

    /// Returns the pages that the program added.
    pub fn own_pages(&self) -> &OwnPages {
        &self.own_pages
    }

    /// Reads a case.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read(&self, source: &CaseText) -> Result<Case, CaseError> {
        Case::read_with(source, &self.own_pages)
    }

    /// Reads all cases that a user's argument stands for: a case file, a folder of them, or a built-in case.
    ///
    /// # Errors
    ///
    /// All files that cannot be read or contain mistakes.
    pub fn named(&self, name: &str) -> Result<Vec<Case>, Vec<CaseError>> {
        if Path::new(name).is_dir() {
            return self.read_all(&[name]);
        }
        let read = source(name).and_then(|source| self.read(&source));
        read.map(|case| vec![case]).map_err(|error| vec![error])
    }

    /// Reads every case of a file, or of a folder and those below it, in the order of the names.
    ///
    /// # Errors
    ///
    /// All files that cannot be read or contain mistakes.
    pub fn read_all(&self, paths: &[impl AsRef<Path>]) -> Result<Vec<Case>, Vec<CaseError>> {
        let mut cases = Vec::new();
        let mut errors = Vec::new();
        for path in paths {
            match files(path.as_ref()) {
                Ok(files) => {
                    for file in files {
                        match CaseText::read(&file).and_then(|source| self.read(&source)) {
                            Ok(case) => cases.push(case),
                            Err(error) => errors.push(error),
                        }
                    }
                }
                Err(error) => errors.push(error),
            }
        }
        if errors.is_empty() { Ok(cases) } else { Err(errors) }
    }
}

/// Returns the text that a user's argument stands for: a case file or a built-in case.
///
/// # Errors
///
/// No such file or case, or a file that cannot be read.
pub fn source(name: &str) -> Result<CaseText, CaseError> {
    let path = Path::new(name);
    match suite::find(name) {
        _ if path.exists() => CaseText::read(path),
        Some(source) => Ok(source),
        None => {
            let names: Vec<String> = suite::suite().into_iter().map(|source| source.name).collect();
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let otherwise = "`trueflight list cases` shows those that are built in";
            let hint = suggestion(name, &names, otherwise);
            Err(CaseError::Unknown { name: name.to_owned(), hint })
        }
    }
}

/// Returns the built-in lists that a program may add to, each with the name of its part of the catalogue.
pub fn built_in() -> Vec<(String, &'static [Page])> {
    let part = |title: &str| format!("estimators of {title}");
    let estimators =
        estimators::catalogues().into_iter().map(|form| (part(&form.title), form.pages));
    let of_pictures =
        (part(&MultipleScattering::title()), <MultipleScattering as Estimated>::CATALOGUE.pages);
    let media = ("media".to_owned(), media::CATALOGUE.pages);
    std::iter::once(media).chain(estimators).chain([of_pictures]).collect()
}

/// Returns the case files of a path, in the order of their names.
fn files(path: &Path) -> Result<Vec<PathBuf>, CaseError> {
    let unreadable = |cause| CaseError::Unreadable { path: path.display().to_string(), cause };
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut actual = Vec::new();
    let mut folders = vec![path.to_owned()];
    let mut seen = BTreeSet::new();
    while let Some(folder) = folders.pop() {
        // A link may lead back to a folder above it.
        if !seen.insert(folder.canonicalize().map_err(unreadable)?) {
            continue;
        }
        for entry in std::fs::read_dir(&folder).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?.path();
            if entry.is_dir() {
                folders.push(entry);
            } else if entry.extension().is_some_and(|extension| extension == "toml") {
                actual.push(entry);
            }
        }
    }
    actual.sort();
    if actual.is_empty() {
        return Err(CaseError::Empty { path: path.display().to_string() });
    }
    Ok(actual)
}
