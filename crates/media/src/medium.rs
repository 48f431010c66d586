//! A field along one ray: the medium of an experiment.

use std::sync::Arc;

use fearless_simd::Level;

use super::sampling::InverseTable;
use super::{Extinction, Inverse, Lookups, Profile};
use numeric::{Known, Lane, Span};

/// A field along one ray, zero outside its support.
///
/// The support is the part of the ray inside the field's bounds; estimators walk only there, so that empty space
/// costs nothing.
#[derive(Clone)]
pub struct Medium {
    profile: Arc<Profile>,
    span: Span,
    support: Span,
    /// Errors of an optical depth from the rounding of the support's ends.
    blurs: [f64; 2],
}

impl Medium {
    /// The field on `span`, zero outside `support`.
    pub fn new(profile: Arc<Profile>, span: Span, support: Span) -> Self {
        let support = support.intersect(span);
        Self { profile, span, support, blurs: [0.0; 2] }
    }

    /// The field with the errors of its support's ends.
    pub fn clipped(profile: Arc<Profile>, span: Span, ends: [Known; 2]) -> Self {
        let medium = Self::new(profile, span, Span::new(ends[0].value, ends[1].value));
        let is_moved = |end: &Known| end.error != 0.0;
        let blur = |end: Known| end.error * medium.extinction(end.value);
        let blurs = ends.map(|end| Some(end).filter(is_moved).map_or(0.0, blur));
        Self { blurs, ..medium }
    }

    /// The whole ray.
    pub fn span(&self) -> Span {
        self.span
    }

    /// The part of the ray where the field may be non-zero.
    pub fn support(&self) -> Span {
        self.support
    }

    /// The field on the whole line.
    pub fn profile(&self) -> &Profile {
        &*self.profile
    }

    /// `σ_t(t)`, zero outside the support. Not for loops: each call looks up the type.
    pub fn extinction(&self, t: f64) -> f64 {
        if t < self.support.from || t > self.support.to {
            return 0.0;
        }
        self.profile.at(t)
    }

    /// `σ_t` at many distances inside the support.
    pub fn extinctions(&self, at: &[f64]) -> Vec<f64> {
        let mut actual = at.to_vec();
        self.lookups(Level::new()).replace(&mut actual);
        actual
    }

    /// `σ_t` inside the support, for kernels on the hardware of a level.
    pub fn lookups(&self, level: Level) -> Lookups<'_> {
        self.profile.lookups(level)
    }

    /// `τ` over the part of `span` inside the support.
    pub fn optical_depth(&self, span: Span) -> Known {
        let inside = span.intersect(self.support);
        let [first, last] = self.blurs;
        let begins = if inside.from == self.support.from { first } else { 0.0 };
        let ends = if inside.to == self.support.to { last } else { 0.0 };
        if inside.is_empty() {
            return Known::new(0.0, 0.0);
        }
        self.profile.optical_depth(inside).blurred(begins + ends)
    }

    /// The distance where the optical depth from the beginning of the support reaches `depth`;
    /// `None` where the ray leaves first.
    pub fn free_flight(&self, depth: f64) -> Option<f64> {
        if self.support.is_empty() { None } else { self.profile.free_flight(self.support, depth) }
    }

    /// The inverse, prepared for many depths.
    pub fn inverse(&self) -> Inverse {
        let needs_table = !self.support.is_empty() && !self.profile.facts().has_inverse;
        let table = needs_table.then(|| InverseTable::of(self.profile(), self.support));
        Inverse::new(self.clone(), table)
    }

    /// The kinks of the field inside the support, in any order.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks = self.profile.breaks(self.support);
        breaks.retain(|&t| self.support.contains_inside(t));
        breaks
    }

    /// See [`super::Facts::panel_nodes`].
    pub fn panel_nodes(&self) -> Option<usize> {
        self.profile.facts().panel_nodes
    }
}

/// Lookups for loops that need not be fast.
impl Extinction for Medium {
    fn extinction<L: Lane>(&self, t: L) -> L {
        t.map(|t| self.profile.at(t))
    }
}
