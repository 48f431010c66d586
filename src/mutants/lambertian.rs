//! Wrong walks under light from all sides: flights and starts.

use super::target::{LAMBERTIAN, LAMBERTIAN_CELLS, Target};
use super::{About, Mutant};
use crate::estimators::lambertian::{draw_with, lambertian};
use crate::estimators::space::{Particle, Steps};
use crate::estimators::{Draw, Setup};
use crate::media::Lookups;
use crate::media::Majorants;
use crate::media::majorants::Flight;
use crate::problems::Lambertian;
use crate::problems::lambertian::Values;
use crate::rng::Stream;
use crate::theory::{Odds, ParticleRule};

use ParticleRule::{Analog, NonTerminating};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Lambertian>> {
    let (white, cells) = (Particle::of(NonTerminating), Particle::of(Analog));
    vec![
        under("lambertian-even-light", "the cosine with the normal is even, without the law of Lambert", LAMBERTIAN, white, (white, |u| 1.0 - u)),
        under("lambertian-stale-majorant", "a flight goes on with the majorant of the cell it began in", LAMBERTIAN_CELLS, cells, (Stale, lambertian)),
    ]
}

fn under<S: Steps + Clone + Send + Sync + 'static>(
    name: &'static str,
    bug: &'static str,
    target: Target,
    honest: Particle,
    (steps, cosine): (S, fn(f64) -> f64),
) -> Mutant<Lambertian> {
    let about = About { name, bug, target, check: "mean" };
    Mutant::new(about, walk(steps, cosine, honest), walk(honest, lambertian, honest))
}

/// A walk by its steps and the law of its start, and the particle whose channels it has.
fn walk(
    steps: impl Steps + Send + Sync + 'static,
    cosine: fn(f64) -> f64,
    particle: Particle,
) -> impl Fn(&Setup<Lambertian>, &Lookups, &mut Stream) -> Draw<Values> + Send + Sync + 'static {
    move |setup, _, rng| draw_with((&steps, cosine), &particle, setup, rng)
}

/// The first cell's σ̂ for the depth, the last one's for the odds.
#[derive(Clone)]
struct Stale;

impl Steps for Stale {
    fn odds_at(&self, ratio: f64, albedo: f64) -> Odds {
        Analog.odds(ratio, albedo)
    }

    fn fly(&self, majorants: &Majorants, flight: &mut Flight, depth: f64) -> Option<f64> {
        let begun = majorants.here(flight);
        majorants.fly_by(flight, depth, |_| begun)
    }
}
