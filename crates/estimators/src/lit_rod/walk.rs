//! The walk from the camera to the emitter, by delta tracking, with a shadow ray from every scattering.
//!
//! ```text
//! fly forward or backward through σ̂;  at a tentative collision, r = σ_t/σ̂:
//!   null, 1 − r       ρ ← ρ (1 − r), where null collisions are part of ρ
//!   absorbed          the walk ends
//!   scattered, a r    p = p(ω) towards the emitter; the score of a shadow ray is added; ρ ← p
//! leaving forward     the weight of a hit is added, 1 if it was never scattered
//! ```
//!
//! ρ is `p_uni/p_nee` of the segment in flight, see [`theory::lit_rod::techniques`]; it begins anew at every
//! real scattering. A flight takes two random numbers, that of a shadow ray too, a scattering one.
//! Eight at a time: [`super::packet`].

use crate::{Draw, Setup};
use media::{Cursor, Extinction, Lookups, OpticalDepth, Piecewise};
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::ParticleRule;
use theory::lit_rod::{Shadow, Techniques};
use theory::particle::Event;
use theory::problems::{LitRod, Problem, Rod};

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// How the emitter is found.
    fn techniques(&self) -> Techniques;

    /// The weight of a hit that was never scattered.
    #[inline(always)]
    fn unscattered(&self) -> f64 {
        1.0
    }

    /// The weight of a hit with this ρ.
    #[inline(always)]
    fn hit(&self, ratio: f64) -> f64 {
        self.techniques().of_hit(ratio)
    }

    /// What a shadow ray scores; the albedo where it was cast is given.
    #[inline(always)]
    fn connected(&self, phase: f64, transmittance: f64, albedo: f64) -> f64 {
        let _ = albedo;
        self.techniques().of_shadow_ray(phase, transmittance)
    }

    /// ρ after a null collision of chance 1 − r.
    #[inline(always)]
    fn after_null(&self, ratio: f64, null: f64) -> f64 {
        if self.techniques().has_nulls() { ratio * null } else { ratio }
    }

    /// ρ after a scattering, from the one before it and what is right.
    #[inline(always)]
    fn after_scattering(&self, before: Option<f64>, right: f64) -> f64 {
        let _ = before;
        right
    }

    /// p(ω) towards the emitter of light that comes forward or backward.
    #[inline(always)]
    fn phase(&self, forward: f64, is_forward: bool) -> f64 {
        if is_forward { forward } else { 1.0 - forward }
    }

    /// Whether a delta-tracked shadow ray ends at a collision.
    #[inline(always)]
    fn stops(&self, number: f64, ratio: f64, albedo: f64) -> bool {
        let _ = albedo;
        number < ratio
    }

    /// The transmittance of a shadow ray that arrives; the optical depth of its last segment through σ̂ is given.
    #[inline(always)]
    fn arrived(&self, transmittance: f64, last: impl Fn() -> f64) -> f64 {
        let _ = last;
        transmittance
    }

    /// Where the walk goes on after a shadow ray, from where it was cast and where it ended.
    #[inline(always)]
    fn goes_on(&self, vertex: Cursor, ray: Cursor) -> Cursor {
        let _ = ray;
        vertex
    }
}

impl Steps for Techniques {
    #[inline(always)]
    fn techniques(&self) -> Techniques {
        *self
    }
}

/// Minus the optical depth from a distance to the end of a medium, along a direction of a cosine with its line: the
/// logarithm of the transmittance.
#[inline(always)]
pub fn log_transmittance<P: Problem>(setup: &Setup<P>, from: f64, cosine: f64) -> f64 {
    let rest = Span::new(from, setup.mesh.support().to);
    -(setup.problem.medium().optical_depth(rest).value / cosine)
}

/// The transmittance.
#[inline(always)]
pub fn transmittance<P: Problem>(setup: &Setup<P>, from: f64, cosine: f64) -> f64 {
    Lane::exp(log_transmittance(setup, from, cosine))
}

/// Where a walk takes place: a rod with its emitter, and σ̂.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    /// The rod.
    pub rod: &'a Rod,
    /// σ̂.
    pub sampling: &'a Piecewise,
    /// Where the emitter is.
    pub end: f64,
}

impl<'a> Place<'a> {
    fn of(setup: &'a Setup<LitRod>) -> Self {
        let end = setup.mesh.support().to;
        Self { rod: &setup.problem.rod, sampling: &setup.sampling, end }
    }

    #[inline(always)]
    fn transmittance(self, from: f64) -> f64 {
        Lane::exp(-self.rod.medium().optical_depth(Span::new(from, self.end)).value)
    }
}

/// Makes one draw.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    setup: &Setup<LitRod>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    walk(steps, Place::of(setup), medium, rng)
}

/// Walks once.
#[inline(always)]
pub fn walk(
    steps: &impl Steps,
    place: Place<'_>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    let Place { rod, sampling: majorant, .. } = place;
    let techniques = steps.techniques();
    let mut cursor = majorant.begin();
    let (mut is_forward, mut ratio) = (true, None);
    let (mut score, mut lookups) = (0.0, 0);
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let flown = if is_forward {
            majorant.fly(&mut cursor, depth)
        } else {
            majorant.fly_back(&mut cursor, depth)
        };
        let Some(sampling) = flown else {
            if is_forward {
                score += ratio.map_or_else(|| steps.unscattered(), |ratio| steps.hit(ratio));
            }
            break;
        };
        lookups += 1;
        let real = medium.extinction(cursor.t) * (1.0 / sampling);
        let albedo = rod.albedo.value(cursor.t);
        match ParticleRule::Analog.odds(real, albedo).decide(number) {
            Event::Transmitted => ratio = ratio.map(|ratio| steps.after_null(ratio, 1.0 - real)),
            Event::Scattered => {
                let direction = rng.uniform();
                let forward = rod.forward.value(cursor.t);
                let phase = steps.phase(forward, is_forward);
                let found = match techniques.shadow {
                    None => 0.0,
                    Some(Shadow::Exact) => place.transmittance(cursor.t),
                    Some(shadow) => {
                        let mut ray = cursor;
                        let way = Way {
                            is_delta: shadow == Shadow::Delta,
                            cosine: 1.0,
                            albedo: |t| rod.albedo.value(t),
                            sampling: majorant,
                            end: place.end,
                        };
                        let (found, cast) = way.track(steps, medium, (&mut ray, rng));
                        lookups += cast;
                        cursor = steps.goes_on(cursor, ray);
                        found
                    }
                };
                score += steps.connected(phase, found, albedo);
                ratio = Some(steps.after_scattering(ratio, techniques.ratio(phase, found)));
                is_forward ^= direction >= forward;
            }
            Event::Absorbed => break,
        }
    }
    Draw::free([score], lookups)
}

/// How a shadow ray goes to the end of a medium.
pub struct Way<'a, A> {
    /// By delta tracking, or else by ratio tracking.
    pub is_delta: bool,
    /// The cosine of its direction with the line of the medium.
    pub cosine: f64,
    /// The albedo at a distance.
    pub albedo: A,
    /// σ̂.
    pub sampling: &'a Piecewise,
    /// The end.
    pub end: f64,
}

impl<A: Fn(f64) -> f64> Way<'_, A> {
    /// Tracks a shadow ray; answers its transmittance and its lookups.
    #[inline(always)]
    pub fn track(
        &self,
        steps: &impl Steps,
        medium: &Lookups,
        (ray, rng): (&mut Cursor, &mut Stream),
    ) -> (f64, u32) {
        let (mut found, mut lookups, mut from) = (1.0, 0, ray.t);
        loop {
            let (depth, number) = (-rng.ln_uniform(), rng.uniform());
            let Some(sampling) = self.sampling.fly(ray, depth * self.cosine) else {
                let last = || {
                    let last = Span::new(from, self.end);
                    self.sampling.optical_depth(last).value / self.cosine
                };
                return (steps.arrived(found, last), lookups);
            };
            lookups += 1;
            from = ray.t;
            let real = medium.extinction(ray.t) * (1.0 / sampling);
            if !self.is_delta {
                found *= 1.0 - real;
            } else if steps.stops(number, real, (self.albedo)(ray.t)) {
                return (0.0, lookups);
            }
        }
    }
}
