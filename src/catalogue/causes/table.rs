//! The table.

use super::Pattern;

/// A kind of bug.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cause {
    /// Its name, which is an anchor of the manual page.
    pub name: &'static str,
    /// What it is.
    pub text: &'static str,
}

/// The likely causes of a pattern, the most frequent first.
pub fn causes(_pattern: &Pattern) -> Vec<Cause> {
    Vec::new()
}
