//! Wrong walks in a furnace: weights that do not add up.

use super::Mutant;
use crate::problems::Furnace;

/// The family.
#[must_use]
pub fn mutants() -> Vec<Mutant<Furnace>> {
    Vec::new()
}
