//! Draws that are put together wrongly, or are another estimator's.
//!
//! ```text
//! next flight         X = Σᵢ wᵢ v(tᵢ), t₀ = 0,  v(t) = e^{−σ̂(S−t)}
//! unidirectional MIS  X = Σᵢ wᵢ u(tᵢ) + w_N u(t_N),  u = v/(1 + v)
//! ```
//!
//! The flight straight to the end counts once from the beginning, and once from each collision. A mean of two walks has
//! the right mean and half the variance; ray marching has next to no variance, and a bias.

use super::line::{Slip, Wrong};
use super::product::{BELOW, DENSE, known};
use super::{Line, Mutant, Target, family, with};
use estimators::transmittance::next_flight::NextFlight;
use estimators::transmittance::product::Product;
use estimators::transmittance::scoring::{Scoring, Share};
use estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use estimators::walks::{self, Walk};
use estimators::{Draw, Setup};
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::{Stream, unit};
use theory::problems::Transmittance;
use theory::rules::Weight;

/// `σ̂ = 1`.
const NEXT_FLIGHT: Target = known(13);
/// `σ̂ = 1`.
const MIS: Target = known(14);

#[derive(Clone, Copy)]
enum Bug {
    None,
    Step(Slip),
    WithoutFlight,
    Unweighted,
    Marching,
    Averaged,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[Line<Bug>] = &[
    ("next-flight-without-first", "the chance to fly from the beginning straight to the end is left out", NEXT_FLIGHT, "mean", Bug::Step(Slip::WithoutFirst)),
    ("next-flight-counted-twice", "a walk that reaches the end adds its weight to what it has already scored", NEXT_FLIGHT, "mean", Bug::Step(Slip::AddsWeight)),
    ("mis-without-flight", "a flight that reaches the end does not score its own share", MIS, "mean", Bug::WithoutFlight),
    ("mis-unweighted", "next flight and flight count in full, unweighted", MIS, "mean", Bug::Unweighted),
    ("ray-marching", "three steps of ray marching with a random offset, passed off as fair", DENSE, "mean", Bug::Marching),
    ("two-walks-averaged", "the mean of two walks is one draw", BELOW, "variance", Bug::Averaged),
];

/// The family.
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    family(LINES, &Bug::None, |target, &bug| with((target, bug), draw))
}

fn draw(
    &(target, bug): &(Target, Bug),
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw {
    match (target, bug) {
        (_, Bug::Marching) => ray_marching(setup, medium, random),
        (_, Bug::WithoutFlight) => {
            one(Scoring::new(WithoutFlight, setup), bug, setup, medium, random)
        }
        (_, Bug::Unweighted) => one(Scoring::new(Unweighted, setup), bug, setup, medium, random),
        (NEXT_FLIGHT, _) => one(Scoring::new(NextFlight, setup), bug, setup, medium, random),
        (MIS, _) => one(Scoring::new(UnidirectionalMis, setup), bug, setup, medium, random),
        _ => {
            let first = one(Product::new(&Weight, setup), bug, setup, medium, random);
            if !matches!(bug, Bug::Averaged) {
                return first;
            }
            let second = one(Product::new(&Weight, setup), bug, setup, medium, random);
            Draw { value: [0.5 * (first.value[0] + second.value[0])], ..first }
        }
    }
}

fn one(
    walk: impl Walk,
    bug: Bug,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw {
    let slip = if let Bug::Step(slip) = bug { slip } else { Slip::None };
    walks::draw(&Wrong::new(walk, slip, setup), &setup.fields.sampling, medium, random)
}

/// `X = exp(−h Σⱼ σ_t((j + u) h))`.
fn ray_marching(setup: &Setup<Transmittance>, medium: &Lookups, random: &mut Stream) -> Draw {
    let support = setup.fields.mesh.support();
    let step = support.length() / 3.0;
    let offset = unit(random);
    let at = |j: u32| support.from + (f64::from(j) + offset) * step;
    let depth = step * (0..3).map(|j| medium.extinction(at(j))).sum::<f64>();
    Draw::free([Lane::exp(-depth)], 3)
}

/// Shares of unidirectional MIS that a flight does not score.
#[derive(Clone, Copy)]
struct WithoutFlight;

impl Share for WithoutFlight {
    const FLIGHT_SCORES: bool = false;

    #[inline(always)]
    fn of<L: Lane>(&self, left: L) -> L {
        UnidirectionalMis.of(left)
    }
}

/// Shares of next flights that a flight scores, too.
#[derive(Clone, Copy)]
struct Unweighted;

impl Share for Unweighted {
    const FLIGHT_SCORES: bool = true;

    #[inline(always)]
    fn of<L: Lane>(&self, left: L) -> L {
        NextFlight.of(left)
    }
}
