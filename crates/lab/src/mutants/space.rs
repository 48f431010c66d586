//! Wrong walks in space: weights that do not add up, directions, endings, flights and starts.
//!
//! ```text
//! furnace            Σ w r (1 − a) + w where it leaves = 1 on average, and in every draw where a rule never
//!                    ends a walk
//! infinite medium    E[x²] at absorption = 2/(σ_t² (1 − a)(1 − a g)) knows how a particle turns, the
//!                    collisions how it ends
//! lambertian         light from all sides: every law of a start but Lambert's changes lengths and counts
//! ```

use super::scattering::{Steps, albedo_twice, backward, number_twice, of, roulette};
use super::target::{
    FURNACE_ANALOG, FURNACE_BELOW, FURNACE_NON_TERMINATING, FURNACE_ROULETTE, INFINITE_ANALOG,
    INFINITE_WEIGHTED, LAMBERTIAN, LAMBERTIAN_CELLS, Target,
};
use super::{About, Mutant, with};
use estimators::space::{By, Walked};
use media::Majorants;
use media::majorants::Flight;
use numeric::geometry::{Point, frame};
use theory::ParticleRule::{Analog, NonTerminating, Terminating, Weighted};
use theory::problems::{Furnace, InfiniteMedium, Lambertian};

/// A bug that the mean shows, on a target: its steps beside the right ones.
fn mutant<P: Walked>(
    name: &'static str,
    bug: &'static str,
    target: Target,
    honest: Steps,
    wrong: Steps,
) -> Mutant<P> {
    let walk = |steps: Steps| {
        with(steps, |steps, setup, _, rng| P::draw(By::Steps(steps), &steps.particle, setup, rng))
    };
    Mutant::new(About { name, bug, target, check: "mean" }, walk(wrong), walk(honest))
}

/// In a furnace.
#[rustfmt::skip] // one mutant, one entry
pub fn in_furnace() -> Vec<Mutant<Furnace>> {
    let (non_terminating, analog, played) = (of(NonTerminating), of(Analog), roulette(NonTerminating, 0.8));
    vec![
        mutant("furnace-albedo-twice", "the albedo is a chance and a weight", FURNACE_NON_TERMINATING, non_terminating, Steps { odds: albedo_twice, ..non_terminating }),
        mutant("furnace-roulette-uncompensated", "who survives roulette keeps the old weight", FURNACE_ROULETTE, played, Steps { kept: |before, _| before, ..played }),
        mutant("furnace-terminating-beyond", "the terminating rule where r > 2/(a + 1)", FURNACE_BELOW, non_terminating, of(Terminating)),
        mutant("furnace-number-twice", "one random number for the flight and for what follows it", FURNACE_ANALOG, analog, Steps { depth: number_twice, ..analog }),
    ]
}

/// In the infinite medium.
#[rustfmt::skip] // one mutant, one entry
pub fn in_infinite_medium() -> Vec<Mutant<InfiniteMedium>> {
    let (analog, weighted) = (of(Analog), roulette(Weighted, 0.5));
    vec![
        mutant("infinite-cosine-sign", "the cosine of Henyey and Greenstein has the wrong sign: forward is backward", INFINITE_ANALOG, analog, Steps { deflection: backward, ..analog }),
        mutant("infinite-turned-about-z", "a particle turns about the z axis, not about its direction", INFINITE_ANALOG, analog, Steps { turned: about_z, ..analog }),
        mutant("infinite-albedo-twice", "absorption by weight and by roulette at once", INFINITE_WEIGHTED, weighted, Steps { odds: albedo_twice, ..weighted }),
        mutant("infinite-roulette-uncompensated", "who survives roulette keeps the old weight", INFINITE_WEIGHTED, weighted, Steps { kept: |before, _| before, ..weighted }),
    ]
}

/// Under light from all sides.
#[rustfmt::skip] // one mutant, one entry
pub fn under_light() -> Vec<Mutant<Lambertian>> {
    let (white, cells) = (of(NonTerminating), of(Analog));
    vec![
        mutant("lambertian-even-light", "the cosine with the normal is even, without the law of Lambert", LAMBERTIAN, white, Steps { first_cosine: |u| 1.0 - u, ..white }),
        mutant("lambertian-stale-majorant", "a flight goes on with the majorant of the cell it began in", LAMBERTIAN_CELLS, cells, Steps { fly: stale, ..cells }),
    ]
}

/// About the z axis, whatever the direction of travel.
fn about_z(_: Point, cosine: f64, turns: f64) -> Point {
    frame::turned(Point([0.0, 0.0, 1.0]), cosine, turns)
}

/// The first cell's σ̂ for the depth, the last one's for the odds.
fn stale(majorants: &Majorants, flight: &mut Flight, depth: f64) -> Option<f64> {
    let begun = majorants.here(flight);
    majorants.fly_by(flight, depth, |_| begun)
}
