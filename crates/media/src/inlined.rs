//! Fields with a formula that is inlined into the loops of some kernels.
//!
//! Kernels look a field up by one call for a batch of distances, see [`super::lookup`]. The call is significant
//! where a lookup is cheap, a pack fills one register, and each step depends on it. `cargo bench --bench kernels`
//! on Zen 5 (AVX-512), the time of a draw over that with [`Inlined::of`] returning `None`, both programs in turn,
//! medians of three:
//!
//! | kernel | field | time |
//! |---|---|--:|
//! | Woodcock | Eq. 21 | 0.89 |
//! | next-flight; unidirectional MIS has the same loop | Eq. 21 | 0.90 |
//! | ratio | 128³ grid | 0.89 |
//!
//! Each line is a loop that is compiled once more for each rule, so this list stays short. On AVX2, where a pack takes
//! two registers, none of them gains a tenth.

use std::any::Any;

use super::eq21::Eq21Ray;
use super::grid::GridRay;

/// A field by its type.
#[derive(Clone, Copy)]
pub enum Inlined<'a> {
    /// Eq. 21 of Szirmay-Kalos et al. 2017.
    Eq21(&'a Eq21Ray),
    /// A voxel grid.
    Grid(&'a GridRay),
}

impl<'a> Inlined<'a> {
    /// Returns a field with an inlined formula; `None` where each lookup is a call.
    pub fn of<F: 'static>(field: &'a F) -> Option<Self> {
        let field: &dyn Any = field;
        let eq21 = field.downcast_ref().map(Self::Eq21);
        eq21.or_else(|| field.downcast_ref().map(Self::Grid))
    }
}
