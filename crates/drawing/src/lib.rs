//! Drawings: a [`Sheet`] is a list of shapes without a file format, [`paint`] makes its pixels.
//!
//! The crate is apart from the reports because pixels take time: it is optimised, and words are not.

pub mod font;
pub mod paint;
pub mod palette;
pub mod sheet;

pub use sheet::Sheet;
