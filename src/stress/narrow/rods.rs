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
        let (mut t, mut weight, mut is_forward, mut score) = (start, P::of(1.0), true, 0.0);
        loop {
            let flown = if is_forward {
                let reach = (end - t) * sampling;
                trail.fly((weight, reach), |depth| t + depth * path, |t| t.below(end))
            } else {
                let reach = (t - start) * sampling;
                trail.fly((weight, reach), |depth| t - depth * path, |t| start.below(t))
            };
            if is_forward == self.transmitted {
                score += flown.gone * weight.double();
            }
            let Some(place) = flown.at else { return score };
            t = place;
            let odds = self.rule.odds(scene.extinction(t) * path, albedo);
            match trail.decide(&odds) {
                Event::Transmitted => weight = weight * odds.transmit_weight,
                Event::Scattered => {
                    weight = weight * odds.scatter_weight;
                    is_forward ^= !trail.happens(forward);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Narrow as F32;
    use crate::stress::Dice;

    #[test]
    fn decisions_that_are_repeated_have_the_mean_of_walks_that_make_their_own() {
        // So far away that single precision is off by some per cent.
        let scene = Scene { depth: 2.0, collisions: 12.0, from: 3e6 };
        let walk = rod(ParticleRule::Weighted);
        let (mut own, mut repeated) = ([0.0; 2], [0.0; 2]);
        let walks = 20_000;
        for number in 0..walks {
            let dice = |name: &str| Dice::new(5, name, number);
            let mut trail = Trail::by_chance(dice("own"));
            let x = walk.draw::<F32>(&scene, &mut trail);
            let mut trail = Trail::new(dice("repeated"));
            walk.draw::<f64>(&scene, &mut trail);
            let y = walk.draw::<F32>(&scene, &mut trail.again(dice("repeated")));
            for (sums, x) in [(&mut own, x), (&mut repeated, y)] {
                sums[0] += x / walks as f64;
                sums[1] += x * x / walks as f64;
            }
        }
        let variance = |[mean, square]: [f64; 2]| (square - mean * mean) / walks as f64;
        let error = (variance(own) + variance(repeated)).sqrt();
        assert!((own[0] - repeated[0]).abs() < 4.0 * error, "{own:?} {repeated:?}");
        let truth = walk.stated(&scene).truth.expect("known");
        assert!((own[0] - truth).abs() > 4.0 * error, "{own:?} {truth}");
    }
}
