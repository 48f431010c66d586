//! Walks through a rod of three waves.
//!
//! Where `σ̂ ≥ σ_t`, as here, `terminating` is `analog` and `adaptive` is `non-terminating`, to the bit.

use super::compare::{Stated, Walk, compare_walks};
use super::precision::Precision;
use super::scene::{FREQUENCY, Scene};
use super::trail::Trail;
use super::{Entry, entry, stated};
use crate::media::Extinction;
use crate::theory::ParticleRule;
use crate::theory::particle::Event;

/// The albedo.
const ALBEDO: f64 = 0.8;
/// The chance to be scattered forward.
const FORWARD: f64 = 0.7;
/// The weight below which roulette is played.
const BELOW: f64 = 0.1;

/// A rule in a rod.
pub struct Rod {
    rule: ParticleRule,
    roulette: bool,
    /// Which end is looked at.
    transmitted: bool,
}

impl Walk for Rod {
    fn stated(&self, scene: &Scene) -> Stated {
        let field = scene.sines(&format!("frequencies = [{FREQUENCY:e}]"));
        let (name, settings) = if self.roulette {
            ("roulette", format!("below = {BELOW}, "))
        } else {
            (self.rule.name(), String::new())
        };
        let text = format!(
            "title = \"t\"\n[problem.rod]\nmedium.sines = {field}\nspan = [0, 1]\n\
             albedo = {ALBEDO}\nforward = {FORWARD}\n\
             estimators = [{{ {name} = {{ {settings}sampling.constant = {{ value = {:e} }} }} }}]",
            scene.collisions
        );
        stated(&text, if self.transmitted { "transmittance" } else { "reflectance" })
    }

    #[inline(always)]
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64 {
        let (start, end) = (P::of(scene.from), P::of(scene.from + 1.0));
        let (path, sampling) = (P::of(1.0 / scene.collisions), P::of(scene.collisions));
        let (albedo, forward) = (P::of(ALBEDO), P::of(FORWARD));
        let (mut t, mut weight, mut is_forward) = (start, P::of(1.0), true);
        loop {
            let flown = if is_forward {
                let reach = (end - t) * sampling;
                trail.fly(reach, |depth| t + depth * path, |t| t.below(end))
            } else {
                let reach = (t - start) * sampling;
                trail.fly(reach, |depth| t - depth * path, |t| start.below(t))
            };
            let Some(place) = flown else {
                return if is_forward == self.transmitted { weight.double() } else { 0.0 };
            };
            t = place;
            let odds = self.rule.odds(scene.extinction(t) * path, albedo);
            match trail.decide(&odds) {
                Event::Transmitted => weight = weight * odds.transmit_weight,
                Event::Scattered => {
                    weight = weight * odds.scatter_weight;
                    is_forward ^= !trail.happens(forward);
                }
                Event::Absorbed => return 0.0,
            }
            if self.roulette {
                let Some(kept) = survivor(trail, weight) else { return 0.0 };
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

const fn rod(rule: ParticleRule) -> Rod {
    Rod { rule, roulette: false, transmitted: false }
}

/// All of them.
pub const ALL: &[Entry] = &[
    entry!("rod, analog", |x| compare_walks(&rod(ParticleRule::Analog), x)),
    entry!("rod, weighted", |x| compare_walks(&rod(ParticleRule::Weighted), x)),
    entry!("rod, non-terminating", |x| compare_walks(&rod(ParticleRule::NonTerminating), x)),
    entry!("rod, roulette", |x| {
        compare_walks(&Rod { roulette: true, ..rod(ParticleRule::NonTerminating) }, x)
    }),
    entry!("rod, analog, transmitted", |x| {
        compare_walks(&Rod { transmitted: true, ..rod(ParticleRule::Analog) }, x)
    }),
];
