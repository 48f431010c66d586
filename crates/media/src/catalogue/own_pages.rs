//! Pages that a program adds to the built-in ones, before it reads case files.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

use super::Page;

/// A page of a program's own: its part of the catalogue, its text, and its reader.
#[derive(Clone)]
pub struct OwnPage {
    /// The part of the catalogue, as in `trueflight list`: `media`, `estimators of transmittance`.
    pub part: String,
    /// Name and text.
    pub page: Page,
    reader: Arc<dyn Any + Send + Sync>,
}

impl OwnPage {
    /// A page that is read by an `R`, the type under which its part finds it.
    pub fn new<R: Any + Send + Sync>(part: impl Into<String>, page: Page, reader: R) -> Self {
        Self { part: part.into(), page, reader: Arc::new(reader) }
    }
}

impl fmt::Debug for OwnPage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} ({})", self.page.name(), self.part)
    }
}

/// The pages of a program's own.
#[derive(Debug, Clone, Default)]
pub struct OwnPages(Vec<OwnPage>);

/// An empty list, for cases that need no pages of the program's own.
pub static NONE: OwnPages = OwnPages(Vec::new());

impl OwnPages {
    /// Adds a page.
    pub fn add(&mut self, addition: OwnPage) {
        self.0.push(addition);
    }

    /// All pages, in the order in which they were added.
    pub fn all(&self) -> &[OwnPage] {
        &self.0
    }

    /// Pages that are read by an `R`, each with its reader.
    pub fn of<R: Any>(&self) -> impl Iterator<Item = (&Page, &R)> {
        self.0.iter().filter_map(|own| Some((&own.page, own.reader.downcast_ref::<R>()?)))
    }
}
