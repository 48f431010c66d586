//! Walks through a slab of three waves that scatters forward, under light from the side.
//!
//! As in rods, `terminating` is `analog` here and `adaptive` is `non-terminating`.

use std::f64::consts::TAU;

use super::compare::{Stated, Walk, compare_walks};
use super::precision::Precision;
use super::scene::{FREQUENCY, Scene};
use super::trail::Trail;
use super::{Entry, entry, stated};
use crate::estimators::slab::walk::turned;
use crate::media::Extinction;
use crate::phase::PhaseFunction;
use crate::phase::henyey_greenstein::HenyeyGreenstein;
use crate::theory::ParticleRule;
use crate::theory::particle::Event;

/// The albedo.
const ALBEDO: f64 = 0.8;
/// The mean cosine of scattering.
const FORWARD: f64 = 0.5;
/// That of the light.
const COSINE: f64 = 0.6;

/// A rule in a slab.
pub struct Slab {
    rule: ParticleRule,
    /// Which side is looked at.
    transmitted: bool,
}

impl Walk for Slab {
    fn stated(&self, scene: &Scene) -> Stated {
        let field = scene.sines(&format!("frequencies = [{FREQUENCY:e}]"));
        let text = format!(
            "title = \"t\"\n[problem.slab]\nmedium.sines = {field}\nspan = [0, 1]\n\
             albedo = {ALBEDO}\nphase.henyey-greenstein = {{ g = {FORWARD} }}\n\
             incidence.collimated = {{ cosine = {COSINE} }}\n\
             estimators = [{{ {} = {{ sampling.constant = {{ value = {:e} }} }} }}]",
            self.rule.name(),
            scene.collisions
        );
        stated(&text, if self.transmitted { "transmittance" } else { "reflectance" })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let Some(phase) = HenyeyGreenstein::new(FORWARD) else { return f64::NAN };
        let (start, end) = (P::of(scene.from), P::of(scene.from + 1.0));
        let (path, albedo) = (P::of(1.0 / scene.collisions), P::of(ALBEDO));
        let (mut z, mut weight, mut cosine) = (start, P::of(1.0), P::of(COSINE));
        let mut score = 0.0;
        loop {
            let is_down = P::of(0.0).below(cosine);
            let descent = cosine.size() * path;
            let flown = if is_down {
                let reach = (end - z) / descent;
                trail.fly((weight, reach), |depth| z + depth * descent, |z| z.below(end))
            } else {
                let reach = (z - start) / descent;
                trail.fly((weight, reach), |depth| z - depth * descent, |z| start.below(z))
            };
            if is_down == self.transmitted {
                score += flown.gone * weight.double();
            }
            let Some(place) = flown.at else { return score };
            z = place;
            let odds = self.rule.odds(scene.extinction(z) * path, albedo);
            match trail.decide(&odds) {
                Event::Transmitted => weight = weight * odds.transmit_weight,
                Event::Scattered => {
                    weight = weight * odds.scatter_weight;
                    let deflection = phase.cosine(trail.uniform::<P>());
                    let azimuth = (trail.uniform::<P>() * TAU).cos();
                    cosine = turned(cosine, deflection, azimuth);
                }
                Event::Absorbed => return score,
            }
        }
    }
}

const fn slab(rule: ParticleRule) -> Slab {
    Slab { rule, transmitted: false }
}

/// All of them.
pub const ALL: &[Entry] = &[
    entry!("slab, analog", |x| compare_walks(&slab(ParticleRule::Analog), x)),
    entry!("slab, weighted", |x| compare_walks(&slab(ParticleRule::Weighted), x)),
    entry!("slab, non-terminating", |x| compare_walks(&slab(ParticleRule::NonTerminating), x)),
    entry!("slab, analog, transmitted", |x| {
        compare_walks(&Slab { transmitted: true, ..slab(ParticleRule::Analog) }, x)
    }),
];
