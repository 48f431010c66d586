//! Wrong walks.

use super::Mutant;
use crate::problems::Lambertian;

/// The family.
#[must_use]
pub fn mutants() -> Vec<Mutant<Lambertian>> {
    Vec::new()
}
