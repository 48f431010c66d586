//! Wrong product estimators of the transmittance.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  W = 1 − r where nothing is decided,  r = (σ_t(tᵢ) − σ_c(tᵢ))/σ̂(tᵢ),  T_c = exp(−∫₀^S σ_c)
//! tᵢ a Poisson process of rate σ̂, by ∫ σ̂ from tᵢ₋₁ to tᵢ = −ln(1 − uᵢ);  the walk ends where tᵢ ≥ S, without a lookup
//! decision i by vᵢ;  all uᵢ and vᵢ independent
//! ```
//!
//! **Controls.** `T_c` belongs to the whole ray, beyond the last collision too, and holds the integral of the σ_c of the
//! lookups: the bias is the mismatch of the two integrals in the exponent.
//!
//! **Lookups.** At another place of the flight the residual is no longer weighted by its own length of the ray. A reversed
//! medium has the same optical depth, and so the same transmittance; walks that end early end at other places.
//!
//! **Flights.** Lookups are Poisson with mean ∫σ̂, and the mean of a draw is right only if the σ̂ that was flown with is the σ̂
//! that is divided by.
//!
//! **Decisions.** Every number by itself is right, and so is every flight and every decision; together they are not.
//!
//! **Precision.** Lost bits are far below any standard error, but break the invariant of a walk.
//!
//! | known bugs | reported or printed in |
//! |---|---|
//! | `lookup-of-another-channel` | Mitsuba 3, issue 1387: two thirds of the correct brightness |
//! | `majorant-too-low` | pbrt-v4, issue 33; Mitsuba 3, pull request 1959 |
//! | `weight-albedo`, `albedo-in-weight` | VisRTX, pull request 298: the albedo multiplies transmittance |
//! | `adaptive-literal` | Szirmay-Kalos et al. 2017, the pseudo-code of `SimulateParticle` |
//! | `control-underflow`, `weight-f32` | single precision, as most renderers compute transmittance |
//! | `cap-4`, `cap-16`, `cap-100` | caps of steps against endless walks |

use super::line::{self, End, Notes, RIGHT, Slip, single};
use super::rule::{ALBEDO, Mistake, Wrong, literal, surviving, weighing};
use super::{DrawFunction, Mutant, MutantRow, On, family, on, one_by_one};
use estimators::setup::ControlledLine;
use estimators::transmittance::product::Product;
use estimators::{Estimated, Request, Setup};
use gate::CheckId;
use media::{Control, Piecewise};
use numeric::{Lane, Span};
use theory::collisions::rules::{Collision, Null, Single, Weight};
use theory::problems::Transmittance;

/// `σ̂ = 1.2`, a majorant.
const WOODCOCK: On<MutantRule> = known(0, MutantRule::Null);
/// `σ̂ = 0.6`, `0.67 ≤ r ≤ 1.83`.
const BELOW: On<MutantRule> = known(1, MutantRule::Weight);
/// `σ̂ = 30`: 90 lookups a draw, a relative standard deviation of a quarter.
const DENSE: On<MutantRule> = known(2, MutantRule::Weight);
/// A linear σ̂.
pub const LINEAR: On<MutantRule> = known(3, MutantRule::Weight);
/// A piecewise-constant σ̂.
const STEPS: On<MutantRule> = known(4, MutantRule::Weight);
/// A control through five points, `σ̂ = 0.5`.
const EXPLORERS: On<MutantRule> = known(5, MutantRule::Weight);
/// `σ_c = 0.9`, `σ̂ = 1`, `−0.5 ≤ r ≤ 0.2`.
const NEGATIVE: On<MutantRule> = known(6, MutantRule::Weight);
/// `σ̂ = 0.6`, `0.67 ≤ r ≤ 1.83`.
const TERMINATING: On<MutantRule> = known(7, MutantRule::Single(Single::Terminating));
/// `σ_c = 0.55`, `σ̂ = 0.22`, `−0.7 ≤ r ≤ 2.5`.
const CLAMPED: On<MutantRule> = known(8, MutantRule::Single(Single::Clamped));
/// `σ̂ = 0.6`, `0.67 ≤ r ≤ 1.83`.
const NON_TERMINATING: On<MutantRule> =
    known(9, MutantRule::Single(Single::NonTerminating { albedo: ALBEDO }));
/// `σ_c = 0.55`, `σ̂ = 0.4`, `−0.4 ≤ r ≤ 1.4`.
const ADAPTIVE: On<MutantRule> = known(10, MutantRule::Single(Single::Adaptive { albedo: ALBEDO }));
/// An optical depth of 110, nearly all of it in the control.
const DEEP: On<MutantRule> = on("transmittance/deep", 0, MutantRule::Weight);
/// `r = 1` and `r = 0` exactly.
const RATIO_ONE: On<MutantRule> = on(
    "transmittance/ratio-exactly-one",
    0,
    MutantRule::Single(Single::NonTerminating { albedo: 0.0 }),
)
.swept(0.0);

/// An experiment of the case that was made for known bugs: an asymmetric medium, dense at both ends, and estimators for every
/// regime of r.
pub const fn known<E: Copy>(index: usize, estimator: E) -> On<E> {
    on("transmittance/known-bugs", index, estimator)
}

/// The correct rule at a collision.
#[derive(Clone, Copy)]
pub enum MutantRule {
    Weight,
    Null,
    Single(Single),
}

/// A bug in a walk, in its rule, in its setup or in its random numbers.
pub enum Bug<P: Estimated> {
    Step(Slip),
    Rule(Mistake),
    Setup(fn(&mut Setup<P>)),
    /// Every 1024 draws of a block begin with the same random numbers.
    Replays,
}

impl<P: Estimated> Bug<P> {
    /// The wrong step, if the bug is one.
    pub fn slip(&self) -> Slip {
        if let Self::Step(slip) = self { *slip } else { RIGHT }
    }
}

/// Draws between two beginnings of a generator that begins again.
const PERIOD: usize = 1024;

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<MutantRule, Bug<Transmittance>>] = &[
    ("control-forgotten", "T_c is left out of the draw", NEGATIVE, CheckId::Mean, Bug::Setup(|setup| setup.fields.control_curve = vec![1.0])),
    ("control-to-last-collision", "the control is integrated up to the last collision only", NEGATIVE, CheckId::Mean, Bug::Step(Slip { score: Some(|walk, x| x * Lane::exp(walk.control_depth(walk.from, walk.support.to))), ..RIGHT })),
    ("control-riemann", "∫σ_c is a sum of eight left values", EXPLORERS, CheckId::Mean, Bug::Setup(riemann)),
    ("control-wrong-sign", "the residual is σ_t + σ_c", NEGATIVE, CheckId::Mean, Bug::Setup(wrong_sign)),
    ("control-in-front-only", "T_c multiplies the draw, but the lookups do not subtract σ_c", NEGATIVE, CheckId::Mean, Bug::Setup(|setup| setup.fields.control = Control::None)),
    ("control-twice", "T_c is multiplied in twice", NEGATIVE, CheckId::Mean, Bug::Step(Slip { score: Some(|walk, x| x * Lane::exp(-walk.control_depth(walk.support.from, walk.support.to))), ..RIGHT })),
    ("control-nearest", "σ_c is that of the nearest knot in the lookups and linear in the integral", EXPLORERS, CheckId::Variance, Bug::Setup(nearest)),
    ("control-of-last-collision", "σ_c is looked up at the collision before", EXPLORERS, CheckId::Mean, Bug::Step(line::OF_LAST_COLLISION)),
    ("control-underflow", "T_c is computed in single precision and underflows", DEEP, CheckId::Mean, Bug::Setup(underflow)),
    ("lookup-at-previous", "σ_t is looked up where the flight began", BELOW, CheckId::Mean, Bug::Step(line::AT_PREVIOUS)),
    ("lookup-at-midpoint", "σ_t is looked up at the flight's midpoint", WOODCOCK, CheckId::Mean, Bug::Step(line::AT_MIDPOINT)),
    ("lookup-reversed", "σ_t(S − t) is looked up for σ_t(t)", TERMINATING, CheckId::Lookups, Bug::Step(line::REVERSED)),
    ("lookup-on-raster", "positions are rounded down to sixteenths of the ray before the lookup", DENSE, CheckId::Mean, Bug::Step(Slip { lookup: Some(on_raster), ..RIGHT })),
    ("lookup-of-another-channel", "the chance of a real collision is that of another colour channel, 0.8 σ_t", WOODCOCK, CheckId::Mean, Bug::Step(line::OF_ANOTHER_CHANNEL)),
    ("flight-log2", "log2 for ln in the flight", BELOW, CheckId::Lookups, Bug::Step(line::LOG2)),
    ("flight-sampling-off", "σ̂ is off by a thousandth in the flight", DENSE, CheckId::Lookups, Bug::Step(Slip { depth: Some(|_, depth| depth * (1.0 / 1.001)), ..RIGHT })),
    ("weight-sampling-off", "σ̂ is off by a thousandth in the weight", DENSE, CheckId::Mean, Bug::Rule(|_, r| Weight.at(r / 1.001))),
    ("flight-hole", "σ̂ is zero on a tenth of the ray", WOODCOCK, CheckId::Mean, Bug::Setup(hole)),
    ("flight-linear-as-constant", "a linear σ̂ is flown as if it stayed what it is at the flight's beginning", LINEAR, CheckId::Lookups, Bug::Step(line::AS_CONSTANT)),
    ("flight-over-boundary", "a flight crosses a boundary with the σ̂ before it", STEPS, CheckId::Mean, Bug::Step(line::AS_CONSTANT)),
    ("flight-replayed", "from half the ray on, the generator repeats the draw's first numbers", BELOW, CheckId::Mean, Bug::Step(Slip { depth: Some(replayed), ..RIGHT })),
    ("buffers-replayed", "every 1024 draws of a block begin with the same random numbers", LINEAR, CheckId::Dispersion, Bug::Replays),
    ("flight-short-ray", "the walk begins and ends a hundredth of the ray inside", DENSE, CheckId::Lookups, Bug::Setup(short_ray)),
    ("end-weighted", "a flight beyond the end is clamped to the end and weighted", BELOW, CheckId::Mean, Bug::Step(Slip { collides_at_end: true, place: Some(|walk, t| if walk.is_beyond { walk.support.to } else { t }), ..RIGHT })),
    ("first-skipped", "the first collision leaves the weight as it is", BELOW, CheckId::Mean, Bug::Step(line::FIRST_SKIPPED)),
    ("lookup-before-end-test", "σ_t is looked up before the end is tested: one lookup too many", BELOW, CheckId::Lookups, Bug::Step(line::LATE_END)),
    ("cap-16", "a walk stops after 16 lookups and returns its weight", DENSE, CheckId::Mean, Bug::Step(Slip { ends: Some(|walk, _| (walk.collisions >= 16).then_some(End::Passed)), ..RIGHT })),
    ("cap-100", "a walk stops after 100 lookups and returns its weight", DENSE, CheckId::Counts, Bug::Step(Slip { ends: Some(|walk, _| (walk.collisions >= 100).then_some(End::Passed)), ..RIGHT })),
    ("cap-4", "a walk stops after 4 lookups and counts as through", WOODCOCK, CheckId::Mean, Bug::Step(Slip { ends: Some(|walk, _| (walk.collisions >= 4).then_some(End::Passed)), ..RIGHT })),
    ("weight-absolute", "|1 − r| for 1 − r", BELOW, CheckId::Mean, Bug::Rule(|right, r| weighing(right, (1.0 - r).abs()))),
    ("weight-clamped", "max(0, 1 − r) for 1 − r", BELOW, CheckId::Mean, Bug::Rule(|right, r| weighing(right, (1.0 - r).max(0.0)))),
    ("weight-exponential", "exp(−r) for 1 − r", BELOW, CheckId::Mean, Bug::Rule(|right, r| weighing(right, Lane::exp(-r)))),
    ("weight-albedo", "the transmitted weight is multiplied by the albedo 0.9 at every collision", BELOW, CheckId::Mean, Bug::Rule(|right, r| weighing(right, 0.9 * (1.0 - r)))),
    ("weight-logarithm", "ln(1 − r) is summed up, which is not a number for r > 1", BELOW, CheckId::Numeric, Bug::Rule(|right, r| weighing(right, (1.0 - r).ln().exp()))),
    ("draw-clamped", "max(0, X) for X", BELOW, CheckId::Mean, Bug::Step(Slip { score: Some(|_, x| x.max(0.0)), ..RIGHT })),
    ("residual-clamped", "max(0, σ_t − σ_c) for σ_t − σ_c", NEGATIVE, CheckId::Mean, Bug::Rule(|_, r| Weight.at(r.max(0.0)))),
    ("residual-absolute", "|σ_t − σ_c| for σ_t − σ_c", NEGATIVE, CheckId::Mean, Bug::Rule(|_, r| Weight.at(r.abs()))),
    ("weight-global-majorant", "flown with the local σ̂, divided by the largest", STEPS, CheckId::Mean, Bug::Step(Slip { used: Some(|walk, computed| computed / (walk.mean_free_path * walk.sampling.corner_values().fold(0.0, f64::max))), ..RIGHT })),
    ("last-factor-missing", "the draw is the weight before the last collision", BELOW, CheckId::Mean, Bug::Step(Slip { score: Some(|walk, _| walk.before), ..RIGHT })),
    ("roulette-uncompensated", "below a weight of 0.1 Russian roulette ends half of the walks and leaves the others as they are", DENSE, CheckId::Lookups, Bug::Step(Slip { ends: Some(|walk, uniform| (walk.weight.abs() < 0.1 && uniform() < 0.5).then_some(End::Lost)), ..RIGHT })),
    ("cut-off", "below a weight of 0.1 the walk ends as 0", DENSE, CheckId::Lookups, Bug::Step(Slip { ends: Some(|walk, _| (walk.weight.abs() < 0.1).then_some(End::Lost)), ..RIGHT })),
    ("majorant-too-low", "a majorant of 0.6 times its size; what exceeds it is clamped", WOODCOCK, CheckId::Mean, Bug::Setup(too_low)),
    ("real-for-null", "real and null collisions are mixed up", WOODCOCK, CheckId::Mean, Bug::Rule(|right, _| surviving(right, 1.0 - right.survival))),
    ("terminating-beyond-two", "the terminating rule where |1 − r| > 1", CLAMPED, CheckId::Mean, Bug::Rule(|_, r| Single::Terminating.at(r))),
    ("chance-without-absolute", "1 − r for |1 − r| as a chance", TERMINATING, CheckId::Mean, Bug::Rule(|right, r| weighing(surviving(right, (1.0 - r).clamp(0.0, 1.0)), 1.0))),
    ("sign-lost", "the survivor of a collision with r > 1 keeps its sign", TERMINATING, CheckId::Mean, Bug::Rule(|right, _| weighing(right, right.weight.abs()))),
    ("sign-lost-non-terminating", "weight D for −D where r > 1", NON_TERMINATING, CheckId::Mean, Bug::Rule(|right, _| weighing(right, right.weight.abs()))),
    ("inverse-chance-missing", "the survivor's weight is not divided by q", NON_TERMINATING, CheckId::Mean, Bug::Rule(|right, r| weighing(right, 1.0 - r))),
    ("inverse-chance-twice", "the survivor's weight is divided by q twice", NON_TERMINATING, CheckId::Variance, Bug::Rule(|right, _| weighing(right, right.weight / right.survival))),
    ("albedo-in-weight", "the transmitted weight is multiplied by the albedo", NON_TERMINATING, CheckId::Mean, Bug::Rule(|right, _| weighing(right, ALBEDO * right.weight))),
    ("adaptive-literal", "D = a r + |1 − r| without the absolute value of r, as the pseudo-code has it", ADAPTIVE, CheckId::Mean, Bug::Rule(literal)),
    ("zero-over-zero", "q = 0/0 at r = 1 and albedo 0: no comparison ends the walk", RATIO_ONE, CheckId::Lookups, Bug::Rule(|right, r| surviving(right, (1.0 - r).abs() / (1.0 - r).abs()))),
    ("number-shared", "one random number for the distance and for the decision", WOODCOCK, CheckId::Mean, Bug::Step(line::SHARED)),
    ("number-shared-reversed", "the distance from u, the decision from 1 − u", WOODCOCK, CheckId::Mean, Bug::Step(Slip { number: Some(|walk, _| walk.uniform().one_minus()), ..RIGHT })),
    ("number-stale", "the decision takes the number of the flight before", WOODCOCK, CheckId::Mean, Bug::Step(line::STALE)),
    ("number-of-first-decision", "one number for all decisions of a walk", TERMINATING, CheckId::Variance, Bug::Step(line::ONE_FOR_ALL)),
    ("weight-f32", "the factors of a weight are kept in single precision", DENSE, CheckId::Invariant, Bug::Rule(|right, r| weighing(right, single(1.0 - r)))),
];

/// The family.
pub fn mutants() -> Vec<Mutant<Transmittance>> {
    let draws = |rule: &MutantRule, bug: &Bug<_>| match *rule {
        MutantRule::Weight => by_rule(Weight, bug),
        MutantRule::Null => by_rule(Null, bug),
        MutantRule::Single(rule) => by_rule(rule, bug),
    };
    on_setups(family(LINES, &Bug::Step(RIGHT), draws), LINES)
}

/// Mutants with bugs in their setups.
pub fn on_setups<P: Estimated, E>(
    mutants: Vec<Mutant<P>>,
    lines: &[MutantRow<E, Bug<P>>],
) -> Vec<Mutant<P>> {
    let each = mutants.into_iter().zip(lines).map(|(mutant, line)| match line.4 {
        Bug::Setup(prepare) => Mutant { prepare, ..mutant },
        _ => mutant,
    });
    each.collect()
}

fn by_rule<R: Collision>(rule: R, bug: &Bug<Transmittance>) -> Box<DrawFunction<Transmittance>> {
    let mistake = if let Bug::Rule(mistake) = *bug { Some(mistake) } else { None };
    let (rule, slip) = (Wrong { rule, mistake }, bug.slip());
    let draws = one_by_one(move |setup, medium, random| {
        line::draw(Product::new(&rule, setup), &slip, setup, medium, random)
    });
    if !matches!(bug, Bug::Replays) {
        return Box::new(draws);
    }
    Box::new(move |setup, Request { streams, count, buffer }| {
        draws(setup, Request { streams, count: count.min(PERIOD), buffer });
        buffer.repeat(count);
    })
}

/// Keeps the flights of the first half of the ray, at most 16, and repeats them in the second half.
fn replayed(walk: &mut Notes, depth: f64) -> f64 {
    if walk.from > walk.support.middle() {
        return if walk.kept.is_empty() { depth } else { walk.kept.remove(0) };
    }
    if walk.kept.len() < 16 {
        walk.kept.push(depth);
    }
    depth
}

/// The beginning of a sixteenth of the ray.
fn on_raster(walk: &mut Notes, t: f64) -> f64 {
    let cell = walk.support.length() / 16.0;
    walk.support.from + ((t - walk.support.from) / cell).floor() * cell
}

/// `T_c = exp(−h Σ σ_c(jh))`.
fn riemann(setup: &mut Setup<Transmittance>) {
    let support = setup.fields.mesh.support();
    let step = support.length() / 8.0;
    let left = |j: u32| setup.fields.control.extinction(support.from + f64::from(j) * step);
    let depth = step * (0..8).map(left).sum::<f64>();
    setup.fields.control_curve = vec![Lane::exp(-depth)];
}

/// `−σ_c` for σ_c in the lookups.
fn wrong_sign(setup: &mut Setup<Transmittance>) {
    if let Control::Pieces(control) = &mut setup.fields.control {
        *control = control.scaled(-1.0);
    }
}

/// Steps between the middles of the knots: by the trapezoidal rule their integral is that of the lines, so that the mean
/// stays and the variance does not.
fn nearest(setup: &mut Setup<Transmittance>) {
    let Control::Pieces(lines) = &setup.fields.control else { return };
    let knots = lines.knots();
    let middles = Span::between(knots).map(Span::middle);
    let breaks: Vec<f64> =
        knots[..1].iter().copied().chain(middles).chain(knots.last().copied()).collect();
    let values: Vec<f64> = knots.iter().map(|&knot| lines.value(knot)).collect();
    setup.fields.control = Control::Pieces(Piecewise::steps(&breaks, &values));
}

/// `T_c` through a number of 32 bits: 0 beyond an optical depth of 104, and already without its last bits beyond 87.
#[allow(clippy::cast_possible_truncation)] // the bug
fn underflow(setup: &mut Setup<Transmittance>) {
    setup.fields.control_curve = vec![f64::from(setup.fields.control_transmittance() as f32)];
}

/// `σ̂ = 0` from 0.4 to 0.5 of the ray.
pub fn hole<P: Estimated<Fields = ControlledLine>>(setup: &mut Setup<P>) {
    let support = setup.fields.mesh.support();
    let value = setup.fields.sampling.value(support.from);
    let at = |share: f64| support.from + share * support.length();
    let breaks = [support.from, at(0.4), at(0.5), support.to];
    setup.fields.sampling = Piecewise::steps(&breaks, &[value, 0.0, value]);
}

/// σ̂ on the inner 98 % of the support.
pub fn short_ray<P: Estimated<Fields = ControlledLine>>(setup: &mut Setup<P>) {
    let support = setup.fields.mesh.support();
    let inset = 0.01 * support.length();
    setup.fields.sampling =
        setup.fields.sampling.on(Span::new(support.from + inset, support.to - inset));
}

/// σ̂ times 0.6.
pub fn too_low<P: Estimated<Fields = ControlledLine>>(setup: &mut Setup<P>) {
    setup.fields.sampling = setup.fields.sampling.scaled(0.6);
}
