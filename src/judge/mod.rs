//! Verdicts on draws that another program made.
//!
//! The session of [`gate::session`] judges draws in memory, in `files` of several formats, and stacks of `images`.
//! [`OfCase`] takes the claims about a draw from a case.

pub mod files;
pub mod images;
mod of_case;
mod whole;

pub use files::{Column, Draws, ForeignError, Format, Layout, count};
pub use of_case::{Choice, ChoiceError, OfCase, estimators as estimators_of, theory as theory_of};

pub use gate::session::*;
