//! Verdicts on draws that another program made.
//!
//! [`gate::session`] judges draws in memory. [`files`] reads draws in several formats, [`whole`] tests their whole distribution, and
//! [`images`] judges stacks of images. The harness takes the claims about a draw from a case.

pub mod files;
pub mod images;
pub mod whole;

pub use files::{Column, DrawSource, ForeignError, Layout, NumberFormat, count};

pub use gate::session::*;
