//! Draws that are put together wrongly, or are another estimator's.
//!
//! ```text
//! next flight         X = Σᵢ wᵢ v(tᵢ), t₀ = 0,  v(t) = e^{−σ̂(S−t)}
//! unidirectional MIS  X = Σᵢ wᵢ u(tᵢ) + w_N u(t_N),  u = v/(1 + v)
//! ```
//!
//! Each chance to fly straight to the end counts once. A mean of two walks has the right mean and
//! half the variance; ray marching has next to no variance, and a bias.

use super::fault::{Fault, RIGHT};
use super::target::{BELOW, DENSE, MIS, NEXT_FLIGHT};
use super::walk::draw_product;
use super::{About, Mutant, with};
use estimators::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::{Stream, unit};
use theory::problems::Transmittance;
use theory::rules::Weight;

const RATIO: (Weight, Fault) = (Weight, RIGHT);

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let next_flight = Scores { share: |v| v, first: true, end: |_, _| 0.0 };
    let mis = Scores { share: |v| v / (1.0 + v), first: true, end: |_, last| last };
    let of = |name, bug, target, right: Scores, wrong: Scores| {
        Mutant::new(About { name, bug, target, check: "mean" }, with(wrong, scored), with(right, scored))
    };
    let right = || with(RATIO, draw_product);
    let marching = About { name: "ray-marching", bug: "three steps of ray marching with a random offset, passed off as fair", target: DENSE, check: "mean" };
    let mean = About { name: "two-walks-averaged", bug: "the mean of two walks is one draw", target: BELOW, check: "variance" };
    vec![
        of("next-flight-without-first", "the chance to fly from the beginning straight to the end is left out", NEXT_FLIGHT, next_flight, Scores { first: false, ..next_flight }),
        of("next-flight-counted-twice", "a walk that reaches the end adds its weight to what it has already scored", NEXT_FLIGHT, next_flight, Scores { end: |weight, _| weight, ..next_flight }),
        of("mis-without-flight", "a flight that reaches the end does not score its own share", MIS, mis, Scores { end: |_, _| 0.0, ..mis }),
        of("mis-unweighted", "next flight and flight count in full, unweighted", MIS, mis, Scores { share: |v| v, ..mis }),
        Mutant::new(marching, with((), |(), setup, medium, random| ray_marching(setup, medium, random)), right()),
        Mutant::new(mean, with((), |(), setup, medium, random| averaged(setup, medium, random)), right()),
    ]
}

/// What walks score on their way, see `estimators/transmittance/next_flight.rs` and `unidirectional_mis.rs`.
#[derive(Clone, Copy)]
struct Scores {
    /// The share of v that counts where a flight begins.
    share: fn(f64) -> f64,
    /// Whether the first flight counts.
    first: bool,
    /// What a walk that reaches the end adds, from its weight and its last score.
    end: fn(f64, f64) -> f64,
}

fn scored(
    scores: &Scores,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw {
    let end = setup.mesh.support().to;
    let mut cursor = setup.sampling.begin();
    let (mut weight, mut lookups) = (1.0, 0);
    let share = |sampling: f64, t: f64| (scores.share)(Lane::exp(-sampling * (end - t)));
    let mut last = share(setup.sampling.value(cursor.t), cursor.t);
    let mut score = if scores.first { last } else { 0.0 };
    while let Some(sampling) = setup.sampling.fly(&mut cursor, -rng.ln_uniform()) {
        weight *= 1.0 - medium.extinction(cursor.t) * (1.0 / sampling);
        lookups += 1;
        last = weight * share(sampling, cursor.t);
        score += last;
    }
    Draw::free([score + (scores.end)(weight, last)], lookups)
}

/// `X = exp(−h Σⱼ σ_t((j + u) h))`.
fn ray_marching(setup: &Setup<Transmittance>, medium: &Lookups, rng: &mut Stream) -> Draw {
    let support = setup.mesh.support();
    let step = support.length() / 3.0;
    let offset = unit(rng);
    let at = |j: u32| support.from + (f64::from(j) + offset) * step;
    let depth = step * (0..3).map(|j| medium.extinction(at(j))).sum::<f64>();
    Draw::free([Lane::exp(-depth)], 3)
}

/// `X = (X₁ + X₂)/2`, with the lookups of one.
fn averaged(setup: &Setup<Transmittance>, medium: &Lookups, rng: &mut Stream) -> Draw {
    let one = draw_product(&RATIO, setup, medium, rng);
    let two = draw_product(&RATIO, setup, medium, rng);
    Draw { value: [0.5 * (one.value[0] + two.value[0])], ..one }
}
