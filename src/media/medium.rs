//! A field along one ray: what an experiment is about.

use std::sync::Arc;

use fearless_simd::Level;

use super::inverse::Table;
use super::{Extinction, FreeFlight, Inverse, Profile, Visitor};
use crate::numeric::pack::in_fused_code;
use crate::numeric::{Known, Lane, Span};

/// A field along one ray, zero outside its support.
///
/// The support is where the ray is inside the field's bounds; estimators walk there and nowhere
/// else, so that empty space costs nothing.
#[derive(Clone)]
pub struct Medium {
    profile: Arc<Profile>,
    span: Span,
    support: Span,
    /// What the rounding of the support's ends adds to the error of an optical depth.
    blurs: [f64; 2],
}

impl Medium {
    /// The field on `span`, zero outside `support`.
    #[must_use]
    pub fn new(profile: Arc<Profile>, span: Span, support: Span) -> Self {
        let support = support.intersect(span);
        Self { profile, span, support, blurs: [0.0; 2] }
    }

    /// The same with a support whose ends are known to some error only.
    #[must_use]
    pub fn clipped(profile: Arc<Profile>, span: Span, ends: [Known; 2]) -> Self {
        let medium = Self::new(profile, span, Span::new(ends[0].value, ends[1].value));
        let blurs =
            ends.map(
                |end| {
                    if end.error == 0.0 { 0.0 } else { end.error * medium.extinction(end.value) }
                },
            );
        Self { blurs, ..medium }
    }

    /// The whole ray.
    #[must_use]
    pub fn span(&self) -> Span {
        self.span
    }

    /// The part of the ray where the field may be non-zero.
    #[must_use]
    pub fn support(&self) -> Span {
        self.support
    }

    /// The profile, for kernels that are compiled once per type.
    #[must_use]
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// `σ_t(t)`, zero outside the support. Not for loops: it finds the type anew each time.
    #[must_use]
    pub fn extinction(&self, t: f64) -> f64 {
        if t < self.support.from || t > self.support.to {
            return 0.0;
        }
        self.profile.visit(Lookup(t))
    }

    /// `σ_t` at many distances inside the support.
    #[must_use]
    pub fn extinctions(&self, at: &[f64]) -> Vec<f64> {
        self.profile.visit(Lookups(at))
    }

    /// `σ_t` at many distances inside the support, eight at a time on the hardware of a level; what
    /// is beyond the last eight is left out.
    pub fn look_up(&self, level: Level, at: &[f64], extinction: &mut [f64]) {
        self.profile.visit(LookUp { level, at, extinction });
    }

    /// `τ` over the part of `span` inside the support.
    #[must_use]
    pub fn optical_depth(&self, span: Span) -> Known {
        let inside = span.intersect(self.support);
        let [first, last] = self.blurs;
        let begins = if inside.from == self.support.from { first } else { 0.0 };
        let ends = if inside.to == self.support.to { last } else { 0.0 };
        if inside.is_empty() {
            return Known::new(0.0, 0.0);
        }
        let depth = self.profile.visit(Depth(inside));
        Known::new(depth.value, depth.error + (begins + ends))
    }

    /// The distance where the optical depth from the beginning of the support reaches `depth`;
    /// `None` where the ray leaves first.
    #[must_use]
    pub fn free_flight(&self, depth: f64) -> Option<f64> {
        self.profile.visit(Flight(self.support, depth))
    }

    /// The same for many depths.
    #[must_use]
    pub fn inverse(&self) -> Inverse {
        let table =
            if self.support.is_empty() { None } else { self.profile.visit(Tabulate(self.support)) };
        Inverse::new(self.clone(), table)
    }

    /// The kinks of the field inside the support, in any order.
    #[must_use]
    pub fn breaks(&self) -> Vec<f64> {
        self.profile.visit(Breaks(self.support))
    }

    /// See [`super::OpticalDepth::panel_nodes`].
    #[must_use]
    pub fn panel_nodes(&self) -> Option<usize> {
        self.profile.visit(PanelNodes)
    }
}

/// For loops that need not be fast: compiled once for all fields, it finds the type anew each time.
impl Extinction for Medium {
    fn extinction<L: Lane>(&self, t: L) -> L {
        t.map(|t| self.profile.visit(Lookup(t)))
    }
}

struct Lookup(f64);
impl Visitor for Lookup {
    type Output = f64;
    fn visit<F: FreeFlight>(self, field: &F) -> f64 {
        in_fused_code(
            #[inline(always)]
            || field.extinction(self.0),
        )
    }
}

struct Lookups<'a>(&'a [f64]);
impl Visitor for Lookups<'_> {
    type Output = Vec<f64>;
    fn visit<F: FreeFlight>(self, field: &F) -> Vec<f64> {
        let mut found = vec![0.0; self.0.len()];
        in_fused_code(
            #[inline(always)]
            || {
                for (sigma, &t) in found.iter_mut().zip(self.0) {
                    *sigma = field.extinction(t);
                }
            },
        );
        found
    }
}

struct LookUp<'a> {
    level: Level,
    at: &'a [f64],
    extinction: &'a mut [f64],
}
impl Visitor for LookUp<'_> {
    type Output = ();
    fn visit<F: FreeFlight>(self, field: &F) {
        super::look_up(self.level, field, self.at, self.extinction);
    }
}

struct Depth(Span);
impl Visitor for Depth {
    type Output = Known;
    fn visit<F: FreeFlight>(self, field: &F) -> Known {
        field.optical_depth(self.0)
    }
}

struct Flight(Span, f64);
impl Visitor for Flight {
    type Output = Option<f64>;
    fn visit<F: FreeFlight>(self, field: &F) -> Option<f64> {
        if self.0.is_empty() { None } else { field.free_flight(self.0, self.1) }
    }
}

struct Tabulate(Span);
impl Visitor for Tabulate {
    type Output = Option<Table>;
    fn visit<F: FreeFlight>(self, field: &F) -> Option<Table> {
        if F::IS_DIRECT { None } else { Some(Table::of(field, self.0)) }
    }
}

struct Breaks(Span);
impl Visitor for Breaks {
    type Output = Vec<f64>;
    fn visit<F: FreeFlight>(self, field: &F) -> Vec<f64> {
        field.breaks(self.0)
    }
}

struct PanelNodes;
impl Visitor for PanelNodes {
    type Output = Option<usize>;
    fn visit<F: FreeFlight>(self, field: &F) -> Option<usize> {
        field.panel_nodes()
    }
}
