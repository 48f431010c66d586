//! Verdicts on draws that another program made.
//!
//! The session of [`gate::session`] judges draws in memory, in [`files`] of several formats, and stacks of [`images`].
//! The harness takes the claims about a draw from a case.

pub mod files;
pub mod images;
pub mod whole;

pub use files::{Column, Draws, ForeignError, Format, Layout, count};

pub use gate::session::*;
