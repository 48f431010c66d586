//! The inverse of an optical depth, prepared for many depths.
//!
//! ```text
//! τⱼ ≤ u < τⱼ₊₁:  s ← the cubic through (τⱼ, sⱼ) and (τⱼ₊₁, sⱼ₊₁) with the slopes 1/σ_t at u
//!                 s ← s − (τ(s) − u)/σ_t(s),  kept between sⱼ and sⱼ₊₁
//! ```
//!
//! A table of 2048 equal intervals gives the starting point; τ(s) is the field's own closed form, from the
//! beginning of the ray. After a step e the next would change the depth by ½|σ'|e². Where σ_t changes by at most
//! twice itself over an interval of length h, that is below σ_t e²/h, and steps end where this is below 1e-15 u.
//! One step is enough for smooth fields. Features that the table does not resolve take more, at most as many as
//! without a table. Fields with a closed inverse need no table.

use super::search::Search;
use crate::{Medium, Profile};
use numeric::{CacheRow, Lane, Span, roots};

/// Number of intervals of a table.
const STRETCHES: u32 = 2048;
/// Maximum relative error of a depth after the steps.
const GRAIN: f64 = 1e-15;

/// Distances at which given optical depths of a medium are reached.
pub struct Inverse {
    medium: Medium,
    table: Option<InverseTable>,
}

impl Inverse {
    pub(crate) fn new(medium: Medium, table: Option<InverseTable>) -> Self {
        Self { medium, table }
    }

    /// See [`Medium::free_flight`].
    pub fn free_flight(&self, depth: f64) -> Option<f64> {
        let Some(table) = &self.table else { return self.medium.free_flight(depth) };
        table.invert(self.medium.profile(), depth)
    }
}

/// Optical depths at equal distances.
pub(crate) struct InverseTable {
    span: Span,
    /// Optical depth at the end.
    whole: f64,
    /// Search for the interval of a depth.
    search: Search,
    /// For each interval: the depth at its beginning and one over its own depth; its beginning, its length, and the
    /// relative excess of the inverse's slope over its chord at both ends.
    stretches: Vec<CacheRow>,
}

impl InverseTable {
    /// The table of a field on a span that is not empty.
    pub(crate) fn of(field: &Profile, span: Span) -> Self {
        let share = |j: u32| f64::from(j) / f64::from(STRETCHES);
        let at: Vec<f64> = (0..=STRETCHES).map(|j| span.from + span.length() * share(j)).collect();
        let mut highest = 0.0;
        let rising = |&s: &f64| {
            // Rounding may make depths decrease where the field is nearly zero.
            highest = Lane::or_more(field.optical_depth(Span::new(span.from, s)).value, highest);
            highest
        };
        let depths: Vec<f64> = at.iter().map(rising).collect();
        let stretch = |(at, depths): (&[f64], &[f64])| {
            let (length, depth) = (at[1] - at[0], depths[1] - depths[0]);
            let steeper = |s: f64| depth / (length * field.at(s)) - 1.0;
            let (first, last) = (steeper(at[0]), steeper(at[1]));
            CacheRow([depths[0], 1.0 / depth, at[0], length, first, last, 0.0, 0.0])
        };
        let stretches = at.windows(2).zip(depths.windows(2)).map(stretch).collect();
        Self { span, whole: highest, search: Search::new(&depths), stretches }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the number of a stretch
    fn invert(&self, field: &Profile, depth: f64) -> Option<f64> {
        if self.whole <= depth {
            return None;
        }
        let stretch = (self.search.piece(depth) as usize).min(self.stretches.len() - 1);
        let [before, per_depth, from, length, first, last, ..] = self.stretches[stretch].0;
        let x = (depth - before) * per_depth;
        let bend = x * (1.0 - x) * (first * (1.0 - x) - last * x);
        let share = x + bend;
        let share = if (0.0..=1.0).contains(&share) { share } else { 0.5 };
        let ends = [from, Lane::or_less(from + length, self.span.to)];
        let is_last = |step: f64, sigma: f64| sigma * step * step <= GRAIN * depth * length;
        Some(roots::rising_from(from + length * share, ends, is_last, |s| {
            let reached = field.optical_depth(Span::new(self.span.from, s)).value;
            (reached - depth, field.at(s))
        }))
    }
}
