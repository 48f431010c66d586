//! Ties among the first flights of another program: too many mean that distances are rounded more than single precision.

use crate::checks::resolution::{self, Resolution};
use gate::stats::ties;
use gate::stats::verdict::BLOCK;
use theory::Prediction;

/// Spacing of numbers of single precision, relative.
const SINGLE: f64 = 2.4e-7;
/// Coarser rounding than this leaves the resolution untested.
pub(super) const COARSE: f64 = 1e-6;
/// Bits of random numbers that are fine enough.
const BITS: i32 = 22;

/// The first flights.
pub(super) struct Fineness {
    resolution: Resolution,
    first: Vec<f64>,
    /// Whether they are numbers of single precision.
    pub is_single: bool,
}

impl Fineness {
    /// Before the first flight; `None` for draws that are no distances.
    pub(super) fn of(prediction: &Prediction) -> Option<Self> {
        let resolution = Resolution::of(prediction)?;
        Some(Self { resolution, first: Vec::new(), is_single: true })
    }

    /// Adds flights, until there are enough.
    pub(super) fn absorb(&mut self, flights: &[f64]) {
        let room = usize::try_from(BLOCK).unwrap_or(usize::MAX).saturating_sub(self.first.len());
        self.first.extend(flights.iter().take(room));
    }

    /// The p-value of the number of ties, with details in words; `None` for too few collisions.
    pub(super) fn p_value(&self) -> Option<(f64, String)> {
        let mut collisions = self.first.clone();
        self.resolution.collisions(&mut collisions);
        if collisions.len() < resolution::FEWEST {
            return None;
        }
        let spacing = if self.is_single { SINGLE } else { f64::EPSILON };
        let all = collisions.len();
        let expected = self.resolution.expected(all as f64, BITS, spacing);
        let found = ties::ties(&mut collisions);
        let details = format!(
            "{found} of {all} flights have the length of an earlier one, {expected:.0} at most are expected of single \
             precision"
        );
        Some((ties::p_value(found, expected), details))
    }
}
