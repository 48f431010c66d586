//! Shadow rays along a line to a light behind it.

use crate::walks::{Route, TentativeCollision};
use media::Medium;
use media::sampling::BothWays;
use numeric::{Lane, Mask, Span, kept};
use theory::light::{Shadow, Techniques};

/// The medium between walks and the light.
#[derive(Clone, Copy)]
pub struct MediumToLight<'a> {
    /// σ_t.
    pub medium: &'a Medium,
    /// The end of the medium.
    pub end: f64,
}

impl MediumToLight<'_> {
    /// The exact transmittance from distances to the end, along directions of these cosines. Lanes outside `which`
    /// have arbitrary numbers.
    #[inline(always)]
    pub fn transmittance<L: Lane>(&self, t: L, cosine: L, which: L::Mask) -> L {
        if !which.any() {
            return t;
        }
        let (Self { medium, end, .. }, bits) = (*self, which.bits());
        let depth = t.replaced(
            #[inline(always)]
            |elements| {
                for (lane, t) in elements.iter_mut().enumerate() {
                    let is_asked = bits >> lane & 1 == 1;
                    let rest = Span::new(*t, end);
                    *t = if is_asked { medium.optical_depth(rest).value } else { 0.0 };
                }
            },
        );
        (-(depth / cosine)).exp()
    }
}

kept! {
    /// Shadow rays on their way, each from the vertex of its route.
    pub struct ShadowRays<L> {
        /// Lanes with a shadow ray in flight.
        pub casts: L::Mask,
        /// The density of its direction, relative to that of the technique.
        pub density: L,
        /// t̂, its transmittance so far.
        pub lit: L,
    }
}

impl<L: Lane> ShadowRays<L> {
    /// No shadow ray.
    #[inline(always)]
    pub fn none(one: L) -> Self {
        Self { casts: one.below(one), density: one, lit: one }
    }

    /// Casts shadow rays of the lanes in `which` from the positions of their walks.
    #[inline(always)]
    pub fn cast_where(&mut self, which: L::Mask, route: &mut Route<impl BothWays<L>>, density: L) {
        route.mark_where(which);
        self.casts |= which;
        self.density.set_where(which, density);
        self.lit.set_where(which, density.each(1.0));
    }

    /// Handles shadow rays at a collision or behind the medium; returns the lanes with rays that end.
    #[inline(always)]
    pub fn track(
        &mut self,
        techniques: Techniques,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        score: &mut L,
    ) -> L::Mask {
        let (TentativeCollision { inside, number, .. }, ratio, casts) =
            (*extinctions, extinctions.ratio(), self.casts);
        if !matches!(techniques.shadow, Some(Shadow::Delta | Shadow::Ratio)) {
            return casts;
        }
        let mut ends = casts & !inside;
        if ends.any() {
            score.add_where(ends, techniques.of_shadow_ray(self.density, self.lit));
        }
        if techniques.shadow == Some(Shadow::Delta) {
            ends |= casts & inside & number.below(ratio);
        } else {
            self.lit.scale_where(casts & inside, ratio.one_minus());
        }
        route.return_where(ends);
        self.casts &= !ends;
        ends
    }
}
