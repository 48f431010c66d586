//! Fields along a line or a ray: `σ_t(t)` in 1/length at the distance `t`.

use fearless_simd::Level;

use super::{Facts, Lookups};
use numeric::fused::in_fused_code;
use numeric::{Known, Lane, Span, roots};

/// A field that can be looked up.
pub trait Extinction: Send + Sync {
    /// The extinction at `t`, as one formula for every lane type.
    fn extinction<L: Lane>(&self, t: L) -> L;

    /// Optional facts.
    fn facts(&self) -> Facts<'_> {
        Facts::default()
    }
}

/// A field that is looked up, with its type erased.
pub trait LookUp: Send + Sync {
    /// `σ_t(t)`. Not for loops of kernels, which take [`LookUp::lookups`].
    fn at(&self, t: f64) -> f64;

    /// `σ_t` for the kernels of a level of hardware.
    fn lookups(&self, level: Level) -> Lookups<'_>;

    /// See [`Extinction::facts`].
    fn facts(&self) -> Facts<'_>;
}

impl<F: Extinction + 'static> LookUp for F {
    fn at(&self, t: f64) -> f64 {
        in_fused_code(
            #[inline(always)]
            || self.extinction(t),
        )
    }

    fn lookups(&self, level: Level) -> Lookups<'_> {
        Lookups::new(self, level)
    }

    fn facts(&self) -> Facts<'_> {
        Extinction::facts(self)
    }
}

/// A field with a known integral, which can be inverted.
pub trait OpticalDepth: LookUp {
    /// `τ(a, b) = ∫ₐᵇ σ_t(t) dt` with a bound on its own error.
    fn optical_depth(&self, span: Span) -> Known;

    /// The distances where the field or one of its derivatives jumps, or that enclose a feature which quadrature would
    /// otherwise miss: all inside `span`, others are ignored. In any order.
    fn breaks(&self, span: Span) -> Vec<f64> {
        let _ = span;
        Vec::new()
    }

    /// The distance `s` with `τ(span.from, s) = depth`; `None` where the ray leaves the span first.
    ///
    /// The default brackets the root of the exact optical depth; pages with a closed form override it.
    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        free_flight_by_root(self, span, depth)
    }
}

/// The default of [`OpticalDepth::free_flight`].
pub fn free_flight_by_root<F: OpticalDepth + ?Sized>(
    field: &F,
    span: Span,
    depth: f64,
) -> Option<f64> {
    let depth_to = |s: f64| field.optical_depth(Span::new(span.from, s)).value;
    if depth_to(span.to) <= depth {
        return None;
    }
    Some(roots::rising(span.from, span.to, |s| (depth_to(s) - depth, field.at(s))))
}
