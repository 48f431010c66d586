//! The walk from the camera to one scattering, and on to the light, by delta tracking; a shadow ray from there.
//!
//! ```text
//! begin    at the top, straight down
//! fly      an optical depth of u goes u μ deep
//! collide  r = σ_t/σ̂
//!   a walk        null, 1 − r;  absorbed: the end;  scattered, a r:
//!                   a direction μ to the light is chosen: a shadow ray along it, q = p(μ)/p_nee, and the walk waits
//!                   a direction μ is drawn from p;  unless it meets the light the walk ends;  ρ ← q
//!   a shadow ray  t̂ ← t̂ (1 − r), or ended with probability r;  behind the slab its score is added
//!   to a hit      null, 1 − r: ρ ← ρ (1 − r), where null collisions are part of ρ;  real: the end
//!                 behind the slab the weight of a hit is added
//! ```
//!
//! Every flight takes two random numbers; a scattering takes one for each direction that is chosen or drawn. A technique
//! without hits draws none.

use crate::lit_rod::shadow::{MediumToLight, ShadowRays};
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Kernel, Request, Setup};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{Lane, Mask, kept};
use theory::ParticleRule;
use theory::light::{Shadow, Techniques};
use theory::problems::{LitSlab, Problem};

kept! {
    /// A walk in flight, or paused for its shadow ray.
    pub struct Path<L> {
        /// Lanes that fly to a hit.
        pub seeks: L::Mask,
        /// Lanes with a drawn direction that hits the light.
        pub meets: L::Mask,
        /// The cosine of the flight.
        pub cosine: L,
        /// The cosine that was drawn.
        pub drawn: L,
        /// ρ of the hit.
        pub ratio: L,
        /// The score so far.
        pub score: L,
        /// The shadow ray.
        pub shadow: ShadowRays<L>,
    }
}

/// The walk to a light behind a slab.
#[derive(Clone, Copy)]
pub struct ToLight<'a> {
    /// The slab and the light.
    pub slab: &'a LitSlab,
    before: MediumToLight<'a>,
    techniques: Techniques,
}

impl<'a> ToLight<'a> {
    /// The walk on a setup.
    #[inline(always)]
    pub fn of(setup: &'a Setup<LitSlab>, techniques: Techniques) -> Self {
        let (slab, end) = (&*setup.problem, setup.fields.mesh.support().to);
        Self { slab, before: MediumToLight { medium: slab.medium(), end }, techniques }
    }
}

/// Makes the draws of a request.
pub fn fill(techniques: Techniques, kernel: Kernel, setup: &Setup<LitSlab>, request: Request) {
    walks::fill(&ToLight::of(setup, techniques), kernel, setup, request);
}

impl Walk for ToLight<'_> {
    type State<L: Lane> = Path<L>;

    const PAUSES: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Path<L> {
        let (none, score, shadow) = (one.below(one), one.each(0.0), ShadowRays::none(one));
        Path { seeks: none, meets: none, cosine: one, drawn: one, ratio: one, score, shadow }
    }

    #[inline(always)]
    fn restart<L: Lane>(&self, path: &mut Path<L>, which: L::Mask, one: L, _: &mut impl Random<L>) {
        // A scattering sets all other fields.
        path.cosine.set_where(which, one);
        path.score.set_where(which, one.each(0.0));
    }

    #[inline(always)]
    fn fly<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        depth: L,
    ) -> L::Mask {
        route.here.fly(depth * path.cosine)
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask {
        let (TentativeCollision { inside, t, number, .. }, real) =
            (*extinctions, extinctions.ratio());
        let (casts, seeks) = (path.shadow.casts, path.seeks);
        let albedo = t.each(self.slab.albedo);
        let probabilities = ParticleRule::Analog.probabilities(real, albedo);
        let (scattered, null) = probabilities.decide_each(inside & !casts & !seeks, number);
        let hits = seeks & !inside;
        if hits.any() {
            path.score.add_where(hits, self.techniques.of_hit(path.ratio));
        }
        path.seeks = seeks & inside & !number.below(real);
        if self.techniques.has_nulls() {
            path.ratio.scale_where(path.seeks, real.one_minus());
        }
        if casts.any() {
            let ends = path.shadow.track(self.techniques, route, extinctions, &mut path.score);
            path.seeks |= ends & path.meets;
            path.cosine.set_where(ends, path.drawn);
        }
        if scattered.any() {
            self.scatter(path, route, t, scattered, random);
        }
        null | path.shadow.casts | path.seeks
    }

    #[inline(always)]
    fn value<L: Lane>(&self, path: &Path<L>, _: L::Mask, _: usize) -> L {
        path.score
    }
}

impl ToLight<'_> {
    /// Chooses a direction to the light for the walks in `scattered`, and draws one.
    #[inline(always)]
    fn scatter<L: Lane>(
        &self,
        path: &mut Path<L>,
        route: &mut Route<impl BothWays<L>>,
        t: L,
        scattered: L::Mask,
        random: &mut impl Random<L>,
    ) {
        let (LitSlab { phase, light, .. }, techniques) = (self.slab, self.techniques);
        let before = t.each(self.slab.end()) - t;
        let is_exact = techniques.shadow == Some(Shadow::Exact);
        let (mut slant, mut density) = (t.each(1.0), t.each(0.0));
        if techniques.shadow.is_some() {
            let number =
                if light.can_be_hit() { random.uniform_where(scattered) } else { t.each(0.0) };
            let [cosine, spread] = light.chosen(number, before);
            density = phase.value(cosine) * spread;
            slant = cosine;
            if is_exact {
                let lit = self.before.transmittance(t, slant, scattered);
                path.score.add_where(scattered, techniques.of_shadow_ray(density, lit));
            }
        }
        if techniques.has_hits() {
            let drawn = phase.cosine(random.uniform_where(scattered));
            let meets = scattered & light.is_met(drawn, before);
            if techniques.shadow.is_some() && meets.any() {
                let spread = light.spread(drawn, before);
                let mut lit = t.each(0.0);
                if is_exact {
                    lit = self.before.transmittance(t, drawn, meets);
                }
                path.ratio.set_where(meets, techniques.ratio(phase.value(drawn) * spread, lit));
            }
            path.drawn.set_where(scattered, drawn);
            path.meets = (path.meets & !scattered) | meets;
        }
        if techniques.shadow.is_none() || is_exact {
            path.seeks |= scattered & path.meets;
            path.cosine.set_where(scattered, path.drawn);
        } else {
            path.shadow.cast_where(scattered, route, density);
            path.cosine.set_where(scattered, slant);
        }
    }
}
