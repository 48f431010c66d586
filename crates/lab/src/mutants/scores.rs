//! Draws that are put together wrongly, or are another estimator's; mistakes of decomposition and of local majorants.
//!
//! ```text
//! next flight         X = Σᵢ wᵢ v(tᵢ), t₀ = 0,  v(t) = e^{−σ̂(S−t)}
//! unidirectional MIS  X = Σᵢ wᵢ u(tᵢ) + w_N u(t_N),  u = v/(1 + v)
//! decomposition       X = 1 if the control's flight passes S and no residual collision comes before it
//! local majorant      beyond a segment's end, go back to the boundary and start again
//! ```
//!
//! The flight straight to the end counts once from the beginning, and once from each collision. A mean of two walks has
//! the right mean and half the variance; ray marching has next to no variance, and a bias.

use super::line::{self, RIGHT, Slip};
use super::product::known;
use super::{Mutant, MutantRow, On, family, one_by_one};
use estimators::transmittance::decomposition::Residual;
use estimators::transmittance::local_majorant::Segments;
use estimators::transmittance::next_flight::NextFlight;
use estimators::transmittance::product::Product;
use estimators::transmittance::scoring::{Scoring, Share};
use estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use estimators::{Draw, Setup, walks};
use gate::CheckId;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::{Stream, unit};
use theory::collisions::rules::Weight;
use theory::problems::Transmittance;

/// Function that makes a draw, with or without a bug.
type ScoreFunction = fn(&Setup<Transmittance>, &Lookups, &mut Stream) -> Draw;

/// `σ̂ = 0.6`, below σ_t.
const BELOW: On<ScoreFunction> = known(1, ratio);
/// `σ̂ = 30`: 90 lookups a draw.
const DENSE: On<ScoreFunction> = known(2, ratio);
/// `σ_c = 0.3`, `σ̂ = 0.9`.
const DECOMPOSITION: On<ScoreFunction> =
    known(11, |s, m, r| decomposition(Residual::new(s), s, m, r));
/// Three segments.
const LOCAL_MAJORANT: On<ScoreFunction> = known(12, |s, m, r| in_segments(&RIGHT, s, m, r));
/// `σ̂ = 1`.
const NEXT_FLIGHT: On<ScoreFunction> = known(13, |s, m, r| scored(NextFlight, &RIGHT, s, m, r));
/// `σ̂ = 1`.
const MIS: On<ScoreFunction> = known(14, |s, m, r| scored(UnidirectionalMis, &RIGHT, s, m, r));

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<ScoreFunction, Option<ScoreFunction>>] = &[
    ("next-flight-without-first", "the chance to fly from the beginning straight to the end is left out", NEXT_FLIGHT, CheckId::Mean, Some(|s, m, r| scored(NextFlight, &Slip { score: Some(|walk, x| x - walk.first), ..RIGHT }, s, m, r))),
    ("next-flight-counted-twice", "a walk that reaches the end adds its weight to what it has already scored", NEXT_FLIGHT, CheckId::Mean, Some(|s, m, r| scored(NextFlight, &Slip { score: Some(|walk, x| x + walk.weight), ..RIGHT }, s, m, r))),
    ("mis-without-flight", "a flight that reaches the end does not score its own share", MIS, CheckId::Mean, Some(|s, m, r| scored(WithoutFlight, &RIGHT, s, m, r))),
    ("mis-unweighted", "next flight and flight count in full, unweighted", MIS, CheckId::Mean, Some(|s, m, r| scored(Unweighted, &RIGHT, s, m, r))),
    ("ray-marching", "three steps of ray marching with a random offset, passed off as fair", DENSE, CheckId::Mean, Some(ray_marching)),
    ("two-walks-averaged", "the mean of two walks is one draw", BELOW, CheckId::Variance, Some(averaged)),
    ("decomposition-whole", "the chance of a real collision is σ_t/σ̂, not (σ_t − σ_c)/σ̂", DECOMPOSITION, CheckId::Mean, Some(|s, m, r| decomposition(Residual { subtracted: 0.0, ..Residual::new(s) }, s, m, r))),
    ("decomposition-passes", "a draw without a residual collision is 1, wherever the control's flight ended", DECOMPOSITION, CheckId::Atoms, Some(|s, m, r| decomposition(Residual { end: f64::NEG_INFINITY, ..Residual::new(s) }, s, m, r))),
    ("local-majorant-overshoot", "a flight beyond a segment's end goes on from where it came to, not from the boundary", LOCAL_MAJORANT, CheckId::Mean, Some(|s, m, r| in_segments(&OVERSHOOTS, s, m, r))),
];

/// The family.
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    family(LINES, &None, |&right, bug| one_by_one(bug.unwrap_or(right)))
}

fn ratio(setup: &Setup<Transmittance>, medium: &Lookups, random: &mut Stream) -> Draw {
    line::draw(Product::new(&Weight, setup), &RIGHT, setup, medium, random)
}

fn scored(
    share: impl Share,
    slip: &Slip,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw {
    line::draw(Scoring::new(share, setup), slip, setup, medium, random)
}

fn decomposition(
    walk: Residual,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw {
    walks::draw(&walk, &setup.fields.sampling, medium, random)
}

fn in_segments(
    slip: &Slip,
    setup: &Setup<Transmittance>,
    medium: &Lookups,
    random: &mut Stream,
) -> Draw {
    let segments = Segments::of(setup).expect("a σ̂ above 0");
    line::draw(segments, slip, setup, medium, random)
}

/// Flights that leave a segment are continued from where they came to.
const OVERSHOOTS: Slip = Slip {
    depth: Some(|walk, depth| {
        let begin = walk.t;
        let came_to = walk.kept.pop().unwrap_or(walk.support.from);
        let mut ends = walk.sampling.stretches().iter().map(|row| row.0[1]);
        let end = ends.find(|&end| begin < end).unwrap_or(begin);
        if came_to >= end {
            walk.kept.push(came_to);
            return f64::INFINITY;
        }
        let ahead = (came_to - begin).max(0.0) / walk.mean_free_path;
        walk.kept.push(Lane::times_plus(depth + ahead, walk.mean_free_path, begin));
        depth + ahead
    }),
    ..RIGHT
};

/// The mean of two draws, with the lookups of the first.
fn averaged(setup: &Setup<Transmittance>, medium: &Lookups, random: &mut Stream) -> Draw {
    let [first, second] = [ratio(setup, medium, random), ratio(setup, medium, random)];
    Draw { value: [0.5 * (first.value[0] + second.value[0])], ..first }
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

    fn of<L: Lane>(&self, left: L) -> L {
        UnidirectionalMis.of(left)
    }
}

/// Shares of next flights that a flight scores, too.
#[derive(Clone, Copy)]
struct Unweighted;

impl Share for Unweighted {
    const FLIGHT_SCORES: bool = true;

    fn of<L: Lane>(&self, left: L) -> L {
        NextFlight.of(left)
    }
}
