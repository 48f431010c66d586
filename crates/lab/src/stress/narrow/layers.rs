//! Walks through a rod of three waves, and through a slab that scatters forward, under light from the side.
//!
//! Where `σ̂ ≥ σ_t`, as here, `terminating` is `analog` and `adaptive` is `non-terminating`, to the bit.

use std::f64::consts::TAU;

use super::compare::{Estimator, Theory};
use super::precision::Precision;
use super::scene::{FREQUENCY, Scene};
use super::trail::Trail;
use super::{EVERY, Entry, stated};
use estimators::slab::walk::turned;
use media::Extinction;
use media::phase::PhaseFunction;
use media::phase::henyey_greenstein::HenyeyGreenstein;
use theory::ParticleRule;
use theory::particle::Event;

/// The albedo.
const ALBEDO: f64 = 0.8;
/// The chance to be scattered forward in a rod.
const FORWARD: f64 = 0.7;
/// The mean cosine of scattering in a slab.
const ASYMMETRY: f64 = 0.5;
/// That of the light on a slab.
const COSINE: f64 = 0.6;
/// The weight below which roulette is played.
const BELOW: f64 = 0.1;

/// A rule in a rod or a slab.
pub struct Layer {
    is_slab: bool,
    rule: ParticleRule,
    roulette: bool,
    /// Which end is looked at.
    transmitted: bool,
}

impl Estimator for Layer {
    fn theory(&self, scene: &Scene) -> Theory {
        let field = scene.sines(&format!("frequencies = [{FREQUENCY:e}]"));
        let (name, settings) = if self.roulette {
            ("roulette", format!("below = {BELOW}, "))
        } else {
            (self.rule.name(), String::new())
        };
        let (problem, scattering) = if self.is_slab {
            let light = format!("incidence.collimated = {{ cosine = {COSINE} }}");
            ("slab", format!("phase.henyey-greenstein = {{ g = {ASYMMETRY} }}\n{light}"))
        } else {
            ("rod", format!("forward = {FORWARD}"))
        };
        let text = format!(
            "title = \"t\"\n[problem.{problem}]\nmedium.sines = {field}\nspan = [0, 1]\n\
             albedo = {ALBEDO}\n{scattering}\n\
             estimators = [{{ {name} = {{ {settings}sampling.constant = {{ value = {:e} }} }} }}]",
            scene.collisions
        );
        stated(scene, &text, if self.transmitted { "transmittance" } else { "reflectance" })
    }

    fn cost(&self, _: &Scene) -> Option<f64> {
        None
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let Some(phase) = HenyeyGreenstein::new(ASYMMETRY) else { return f64::NAN };
        let (start, end) = (P::of(scene.from), P::of(scene.from + 1.0));
        let (path, sampling) = (P::of(1.0 / scene.collisions), P::of(scene.collisions));
        let (zero, albedo) = (P::of(0.0), P::of(ALBEDO));
        let (mut t, mut weight, mut score) = (start, P::of(1.0), 0.0);
        let mut cosine = P::of(if self.is_slab { COSINE } else { 1.0 });
        loop {
            let is_down = zero.below(cosine);
            let descent = cosine.size() * path;
            let reach = |away: P| if self.is_slab { away / descent } else { away * sampling };
            let flown = if is_down {
                trail.fly((weight, reach(end - t)), |depth| t + depth * descent, |t| t.below(end))
            } else {
                let land = |depth| t - depth * descent;
                trail.fly((weight, reach(t - start)), land, |t| start.below(t))
            };
            if is_down == self.transmitted {
                score += flown.gone * weight.double();
            }
            let Some(place) = flown.at else { return score };
            t = place;
            let odds = self.rule.odds(scene.extinction(t) * path, albedo);
            match trail.decide(&odds) {
                Event::Transmitted => weight = weight * odds.transmit_weight,
                Event::Scattered => {
                    weight = weight * odds.scatter_weight;
                    if self.is_slab {
                        let deflection = phase.cosine(trail.uniform::<P>());
                        let azimuth = (trail.uniform::<P>() * TAU).cos();
                        cosine = turned(cosine, deflection, azimuth);
                    } else if !trail.happens(P::of(FORWARD)) {
                        cosine = -cosine;
                    }
                }
                Event::Absorbed => return score,
            }
            if self.roulette {
                let Some(kept) = survivor(trail, weight) else { return score };
                weight = kept;
            }
        }
    }
}

/// Russian roulette: the weight of what goes on.
#[inline(always)]
fn survivor<P: Precision>(trail: &mut Trail, weight: P) -> Option<P> {
    let (below, one) = (P::of(BELOW), P::of(1.0));
    let is_large = below.at_most(weight.size());
    let chance = P::select(is_large, one, weight.size() / below);
    let negative = weight.below(P::of(0.0));
    let kept = P::select(is_large, weight, P::select(negative, -below, below));
    trail.happens(chance).then_some(kept)
}

const fn layer(is_slab: bool, rule: ParticleRule) -> Layer {
    Layer { is_slab, rule, roulette: false, transmitted: false }
}

/// A walk through a rod.
pub const fn rod(rule: ParticleRule) -> Layer {
    layer(false, rule)
}

const fn slab(rule: ParticleRule) -> Layer {
    layer(true, rule)
}

/// Those of rods.
pub const RODS: &[Entry] = &[
    ("rod, analog", &rod(ParticleRule::Analog), EVERY),
    ("rod, weighted", &rod(ParticleRule::Weighted), EVERY),
    ("rod, non-terminating", &rod(ParticleRule::NonTerminating), EVERY),
    ("rod, roulette", &Layer { roulette: true, ..rod(ParticleRule::NonTerminating) }, EVERY),
    ("rod, analog, transmitted", &Layer { transmitted: true, ..rod(ParticleRule::Analog) }, EVERY),
];

/// Those of slabs.
pub const SLABS: &[Entry] = &[
    ("slab, analog", &slab(ParticleRule::Analog), EVERY),
    ("slab, weighted", &slab(ParticleRule::Weighted), EVERY),
    ("slab, non-terminating", &slab(ParticleRule::NonTerminating), EVERY),
    (
        "slab, analog, transmitted",
        &Layer { transmitted: true, ..slab(ParticleRule::Analog) },
        EVERY,
    ),
];
