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
use crate::estimators::rules::Weight;
use crate::estimators::{Draw, Setup};
use crate::media::{Extinction, Lookups};
use crate::numeric::Lane;
use crate::problems::Transmittance;
use crate::rng::{Stream, unit};

const RATIO: (Weight, Fault) = (Weight, RIGHT);

/// The family.
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let of_next_flight = |name, bug, faulty| {
        let about = About { name, bug, target: NEXT_FLIGHT, check: "mean" };
        Mutant::new(about, with(faulty, next_flight), with(NextFlight::Right, next_flight))
    };
    let of_mis = |name, bug, faulty| {
        let about = About { name, bug, target: MIS, check: "mean" };
        Mutant::new(about, with(faulty, mis), with(Mis::Right, mis))
    };
    let ratio = |name, bug, target, check| About { name, bug, target, check };
    let marching = "three steps of ray marching with a random offset, passed off as fair";
    let mean = "the mean of two walks is one draw";
    vec![
        of_next_flight(
            "next-flight-without-first",
            "the chance to fly from the beginning straight to the end is left out",
            NextFlight::WithoutFirst,
        ),
        of_next_flight(
            "next-flight-counted-twice",
            "a walk that reaches the end adds its weight to what it has already scored",
            NextFlight::CountedTwice,
        ),
        of_mis(
            "mis-without-flight",
            "a flight that reaches the end does not score its own share",
            Mis::WithoutFlight,
        ),
        of_mis(
            "mis-unweighted",
            "next flight and flight count in full, unweighted",
            Mis::Unweighted,
        ),
        Mutant::new(
            ratio("ray-marching", marching, DENSE, "mean"),
            ray_marching,
            with(RATIO, draw_product),
        ),
        Mutant::new(
            ratio("two-walks-averaged", mean, BELOW, "variance"),
            averaged,
            with(RATIO, draw_product),
        ),
    ]
}

/// What goes wrong in the next-flight estimator.
#[derive(Clone, Copy, PartialEq)]
enum NextFlight {
    Right,
    WithoutFirst,
    CountedTwice,
}

/// See `estimators/transmittance/next_flight.rs`.
fn next_flight(
    bug: &NextFlight,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    let end = setup.mesh.support().to;
    let mut cursor = setup.sampling.begin();
    let mut weight = 1.0;
    let mut lookups = 0;
    let first = Lane::exp(-setup.sampling.value(cursor.t) * (end - cursor.t));
    let mut score = if *bug == NextFlight::WithoutFirst { 0.0 } else { first };
    while let Some(sampling) = setup.sampling.fly(&mut cursor, -rng.ln_uniform()) {
        weight *= 1.0 - medium.extinction(cursor.t) * (1.0 / sampling);
        lookups += 1;
        score += weight * Lane::exp(-sampling * (end - cursor.t));
    }
    if *bug == NextFlight::CountedTwice {
        score += weight;
    }
    Draw::free([score], lookups)
}

/// What goes wrong in unidirectional MIS.
#[derive(Clone, Copy, PartialEq)]
enum Mis {
    Right,
    WithoutFlight,
    Unweighted,
}

/// See `estimators/transmittance/unidirectional_mis.rs`.
fn mis(
    bug: &Mis,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    let end = setup.mesh.support().to;
    let mut cursor = setup.sampling.begin();
    let mut weight = 1.0;
    let mut lookups = 0;
    let share = |sampling: f64, t: f64| {
        let v = Lane::exp(-sampling * (end - t));
        if *bug == Mis::Unweighted { v } else { v / (1.0 + v) }
    };
    let mut last = share(setup.sampling.value(cursor.t), cursor.t);
    let mut score = last;
    while let Some(sampling) = setup.sampling.fly(&mut cursor, -rng.ln_uniform()) {
        weight *= 1.0 - medium.extinction(cursor.t) * (1.0 / sampling);
        lookups += 1;
        last = weight * share(sampling, cursor.t);
        score += last;
    }
    let flown = if *bug == Mis::WithoutFlight { 0.0 } else { last };
    Draw::free([score + flown], lookups)
}

/// `X = exp(−h Σⱼ σ_t((j + u) h))`.
fn ray_marching(
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<[f64; 1]> {
    let support = setup.mesh.support();
    let step = support.length() / 3.0;
    let offset = unit(rng);
    let at = |j: u32| support.from + (f64::from(j) + offset) * step;
    let depth = step * (0..3).map(|j| medium.extinction(at(j))).sum::<f64>();
    Draw::free([Lane::exp(-depth)], 3)
}

/// `X = (X₁ + X₂)/2`, with the lookups of one.
fn averaged(setup: &Setup<Transmittance>, medium: &Lookups, rng: &mut Stream) -> Draw<[f64; 1]> {
    let one = draw_product(&RATIO, setup, medium, rng);
    let two = draw_product(&RATIO, setup, medium, rng);
    Draw { value: [0.5 * (one.value[0] + two.value[0])], ..one }
}
