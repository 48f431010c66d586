//! Pages of a catalogue, and the reader of their settings.
//!
//! A catalogue is a list of pages: media, sampling extinctions, controls, estimators, checks. A
//! page is one source file. Its name in case files is the file's name with hyphens, and its text
//! in `list` and `explain` is the file's own documentation, so that neither can go stale.

mod choices;
pub mod fixture;
mod lists;
pub mod own_pages;
pub mod page;
pub mod registry;
pub mod settings;
pub mod tree;
mod words;

pub use own_pages::{OwnPage, OwnPages};
pub use page::Page;
pub use registry::Registry;
pub use settings::{Mistake, Settings};
pub use tree::{Domain, Entry, Fault, Node, Value};
pub use words::suggestion;
