//! Wrong walks.

use super::Mutant;
use crate::problems::InfiniteMedium;

/// The family.
#[must_use]
pub fn mutants() -> Vec<Mutant<InfiniteMedium>> {
    Vec::new()
}
