//! Shadow rays along a line to a light behind it, and the weights of hits and shadow rays.

use crate::walks::{Route, TentativeCollision};
use media::sampling::BothWays;
use media::{Medium, OpticalDepth, Piecewise};
use numeric::{Lane, Mask, Span, kept};
use theory::light::{Shadow, Techniques};

/// Events of a walk, each of which a known bug may replace.
pub trait WalkEvents: Copy {
    /// True if [`WalkEvents::arrived`] needs the last segment.
    const KEEPS_LAST: bool = false;

    /// The techniques that find the light.
    fn techniques(&self) -> Techniques;

    /// The weight of a hit that was never scattered.
    #[inline(always)]
    fn unscattered<L: Lane>(&self, one: L) -> L {
        one
    }

    /// The weight of a hit with `ρ = p_uni/p_nee`.
    #[inline(always)]
    fn hit<L: Lane>(&self, ratio: L) -> L {
        self.techniques().of_hit(ratio)
    }

    /// The score of a shadow ray, from the density of its direction and its transmittance.
    #[inline(always)]
    fn connected<L: Lane>(&self, density: L, transmittance: L) -> L {
        self.techniques().of_shadow_ray(density, transmittance)
    }

    /// ρ after a null collision of probability 1 − r, where null collisions are part of ρ.
    #[inline(always)]
    fn after_null<L: Lane>(&self, ratio: L, null: L) -> L {
        ratio * null
    }

    /// ρ after a scattering, given the one before it and the right one.
    #[inline(always)]
    fn after_scattering<L: Lane>(&self, before: L, right: L) -> L {
        let _ = before;
        right
    }

    /// p(ω) towards the emitter, given the albedo and whether the light comes forward.
    #[inline(always)]
    fn phase<L: Lane>(&self, forward: L, is_forward: L::Mask, albedo: L) -> L {
        let _ = albedo;
        L::select(is_forward, forward, forward.one_minus())
    }

    /// The probability that a delta-tracked shadow ray ends at a collision.
    #[inline(always)]
    fn stops<L: Lane>(&self, ratio: L, albedo: L) -> L {
        let _ = albedo;
        ratio
    }

    /// The transmittance of a shadow ray that arrives. `last` is the optical depth of its last segment through σ̂.
    #[inline(always)]
    fn arrived<L: Lane>(&self, transmittance: L, last: impl Fn() -> L) -> L {
        let _ = last;
        transmittance
    }

    /// True if the walk goes on from where its shadow ray was cast.
    #[inline(always)]
    fn returns(&self) -> bool {
        true
    }
}

impl WalkEvents for Techniques {
    #[inline(always)]
    fn techniques(&self) -> Techniques {
        *self
    }
}

/// The medium between walks and the light.
#[derive(Clone, Copy)]
pub struct MediumToLight<'a> {
    /// σ_t.
    pub medium: &'a Medium,
    /// σ̂.
    pub sampling: &'a Piecewise,
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
        density: L,
        /// t̂, its transmittance so far.
        found: L,
        /// The beginning of its last segment, if [`WalkEvents::KEEPS_LAST`].
        last: L,
    }
}

impl<L: Lane> ShadowRays<L> {
    /// No shadow ray.
    #[inline(always)]
    pub fn none(one: L) -> Self {
        Self { casts: one.below(one), density: one, found: one, last: one }
    }

    /// Casts shadow rays of the lanes in `which` from the positions of their walks.
    #[inline(always)]
    pub fn cast_where<S: WalkEvents>(
        &mut self,
        which: L::Mask,
        route: &mut Route<impl BothWays<L>>,
        (t, density): (L, L),
    ) {
        if S::KEEPS_LAST {
            self.last.set_where(which, t);
        }
        route.mark_where(which);
        self.casts |= which;
        self.density.set_where(which, density);
        self.found.set_where(which, t.each(1.0));
    }

    /// Handles shadow rays at a collision or behind the medium, along directions of these cosines; returns the
    /// lanes with rays that end.
    #[inline(always)]
    pub fn track<S: WalkEvents>(
        &mut self,
        steps: &S,
        before: &MediumToLight,
        (route, met): (&mut Route<impl BothWays<L>>, &TentativeCollision<L>),
        (cosine, albedo): (L, L),
        score: &mut L,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, number, .. }, ratio, casts) =
            (*met, met.ratio(), self.casts);
        let shadow = steps.techniques().shadow;
        if !matches!(shadow, Some(Shadow::Delta | Shadow::Ratio)) {
            return casts;
        }
        let mut ends = casts & !inside;
        if ends.any() {
            let last = || {
                let rest = |t| before.sampling.optical_depth(Span::new(t, before.end)).value;
                self.last.map(rest) / cosine
            };
            score.add_where(ends, steps.connected(self.density, steps.arrived(self.found, last)));
        }
        if shadow == Some(Shadow::Delta) {
            ends |= casts & inside & number.below(steps.stops(ratio, albedo));
        } else {
            self.found.scale_where(casts & inside, ratio.one_minus());
        }
        if S::KEEPS_LAST {
            self.last.set_where(casts & inside, t);
        }
        if steps.returns() {
            route.return_where(ends);
        }
        self.casts &= !ends;
        ends
    }
}
