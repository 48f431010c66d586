//! Shadow rays of walks to scattering points: cast, tracked and collected side by side.
//!
//! Aiming a shadow ray costs more than a step. A lane that has come to a scattering point therefore stands still
//! until [`TOGETHER`] lanes of its pack have. Scores of lanes that have found light are delayed likewise. A lane
//! takes no random numbers in the meantime.

use super::ray_setup::RaySetup;
use crate::space::shadow::{Shadows, VisibleLight};
use crate::walks::TentativeCollision;
use crate::{Refusal, Setup};
use numeric::digits::{number, rounded};
use numeric::geometry::exit;
use numeric::rng::Random;
use numeric::{Kept, Lane, Mask, kept};
use theory::problems::SingleScattering;
use theory::single::Tracking;

/// The number of lanes of a pack that cast their shadow rays together.
pub const TOGETHER: u32 = 4;

kept! {
    /// The way of each lane from a scattering point to the light.
    pub struct ToLight<L> {
        /// Lanes that have yet to cast a shadow ray.
        aims: L::Mask,
        /// Lanes with a shadow ray in flight at the beginning of the step.
        casts: L::Mask,
        /// Lanes of these that came to a tentative collision.
        inside: L::Mask,
        place: [L; 3],
        origin: [L; 3],
        shadows: Shadows<L>,
        lit: L::Mask,
        /// The transmittance of lanes that have found light.
        pub light: L,
    }
}

impl<L: Lane> ToLight<L> {
    /// No shadow rays.
    #[inline(always)]
    pub fn none(zero: L) -> Self {
        let (none, nowhere) = (zero.below(zero), [zero; 3]);
        Self {
            aims: none,
            casts: none,
            inside: none,
            place: nowhere,
            origin: nowhere,
            shadows: Shadows::new(zero),
            lit: none,
            light: zero,
        }
    }

    /// Begins a step; returns the lanes on their way to the light.
    #[inline(always)]
    pub fn step(&mut self) -> L::Mask {
        self.casts = self.shadows.on;
        self.casts | self.aims | self.lit
    }

    /// Draws the optical depths of flights, of shadow rays and of the lanes in `flies` along the camera's ray.
    #[inline(always)]
    pub fn depth(&self, flies: L::Mask, random: &mut impl Random<L>) -> L {
        let moves = flies | self.casts;
        if moves.any() { -random.ln_uniform_where(moves) } else { self.light.each(0.0) }
    }

    /// Flies along the shadow rays.
    #[inline(always)]
    pub fn fly(&mut self, ground: &RaySetup, depth: L) {
        self.inside = self.casts;
        // Packs fly without a ray, too: a branch that no machine foresees costs more.
        if ground.rays.tracking != Tracking::Exact && self.casts.maybe() {
            (self.place, self.inside) = self.shadows.fly(ground.rays, self.origin, depth);
        }
    }

    /// Lanes at a tentative collision on their shadow rays, and the places of all lanes.
    #[inline(always)]
    pub fn collisions(&self) -> (L::Mask, [L; 3]) {
        (self.inside & self.casts, self.place)
    }

    /// Handles the collisions, and casts the shadow rays of the lanes in `aims` from distances s along the camera's
    /// ray. Returns the lanes that have found light and its transmittance, as soon as `enough` lanes of a pack
    /// have.
    #[inline(always)]
    pub fn collide(
        &mut self,
        ground: &RaySetup,
        extinctions: &TentativeCollision<L>,
        (aims, s): (L::Mask, L),
        enough: u32,
        random: &mut impl Random<L>,
    ) -> (L::Mask, L) {
        let (none, one) = (aims & !aims, s.each(1.0));
        let rays = ground.rays;
        let mut actual = (none, one);
        if rays.tracking != Tracking::Exact && self.casts.maybe() {
            let at = (self.place, self.inside & self.casts);
            actual = self.shadows.collide(rays, random, at, extinctions.in_space[0]);
        }
        self.aims |= aims;
        if self.aims.are_enough(TOGETHER) {
            let casts = self.aims;
            self.aims = none;
            let (origin, direction, distance) = ground.setup.problem.to_light(s);
            self.origin.set_where(casts, origin);
            let light = VisibleLight { direction, share: one, distance };
            let ends = exit::ends(&rays.bounds, [origin, direction], casts);
            let through = (rays, ground.fields.first());
            let ((which, light), _) =
                self.shadows.cast(through, casts, &light, (origin, one), ends);
            // Light of rays that were cast before, and light that is found at once.
            actual = (actual.0 | which, L::select(which, light, actual.1));
        }
        self.lit |= actual.0;
        self.light.set_where(actual.0, actual.1);
        if !self.lit.are_enough(enough) {
            return (none, self.light);
        }
        let lit = self.lit;
        self.lit = none;
        (lit, self.light)
    }
}

/// Methods of a [`Walk`](crate::walks::Walk) with a `ground`, and with `to_light` and `score` in its state: all its lookups in space are those of
/// its shadow rays. A walk has one implementation of its trait, so that these cannot be the defaults of another one.
macro_rules! scored_by_shadow_rays {
    () => {
        #[inline(always)]
        fn in_space<L: Lane>(&self, path: &Self::State<L>) -> (L::Mask, [L; 3]) {
            path.to_light.collisions()
        }

        #[inline(always)]
        fn fields(&self) -> &[media::Batches<'_>] {
            self.ground.fields
        }

        #[inline(always)]
        fn field(&self, _: usize, place: numeric::geometry::Point) -> f64 {
            self.ground.rays.volume.extinction_at(place)
        }

        #[inline(always)]
        fn value<L: Lane>(&self, path: &Self::State<L>, _: L::Mask, _: usize) -> L {
            path.score
        }
    };
}
pub(super) use scored_by_shadow_rays;

/// Checks delta tracking of shadow rays: it needs a majorant on every ray, and its walks must end.
///
/// # Errors
///
/// The bound on σ_t that the majorant does not reach, or the expected number of collisions.
pub fn require_shadow(setup: &Setup<SingleScattering>, shadow: Tracking) -> Result<(), Refusal> {
    if let Tracking::Ratio { sampling, .. } | Tracking::Delta { sampling } = shadow {
        let collisions = sampling * setup.fields.mesh.support().length();
        if collisions.is_nan() || collisions > 1e6 {
            let needs = "a shadow's σ̂ of at most 1e6 collisions on the ray's length";
            return Err(Refusal::mismatch(needs, format!("there would be {collisions:e}")));
        }
    }
    let Tracking::Delta { sampling } = shadow else { return Ok(()) };
    let bound = setup.problem.shadow_majorant();
    if sampling >= bound * (1.0 - 1e-12) {
        return Ok(());
    }
    let needs = "σ̄ ≥ σ_t on every shadow ray";
    Err(Refusal::mismatch(
        needs,
        format!("σ̄ = {} and σ_t is bounded by {} only", number(sampling), rounded(bound)),
    ))
}
