//! Every moment of a walk through a rod, from its two-stream equations.
//!
//! Let `Q_k` and `S_k` be those of a rule (see `particle`), and `c = r(1 − a)` for the absorbed energy and
//! `c = 1/(σ̂ width)` for the flux. The k-th moment of the particle's score solves the equations of `grid` with
//!
//! ```text
//! A_k = σ̂(1 − Q_k − S_k p_f),  B_k = σ̂ S_k p_b
//! reflectance^k, transmittance^k:  no source; leaving is worth 1 at that end
//! of scattering order n:           A = σ̂(1 − Q_k), B = 0, source σ̂ S_k(p_f, p_b) of order n − 1
//! Y^j X^k, Y = Σ c w a score:      source σ̂ Σ_{i<j} (j over i) c^{j−i} (Q, S)_{i+k} of Y^i X^k
//! M(M − 1)…(M − n + 1), M lookups: A₀, B₀, source n σ̂ (Q, S)₀ of the one before, and n σ̂ for n = 1
//! ```
//!
//! Each is the expectation over the events at the next collision. Terms with different powers of the weight never
//! mix: therefore the equations close.

use super::grid::{Grid, Importance, Step, Walk};
use crate::problems::Problem;
use crate::problems::rod::Quantity;

/// Ratio of the coarsest grid's steps to those of the grid on which divergence is searched.
const FINER: usize = 16;
/// Relative distance to a critical length within which a grid does not resolve on which side of it a rod ends.
const NEAR: f64 = 1e-3;
/// Maximum number of steps that are solved.
const MOST_STEPS: usize = 200_000;
/// Relative rounding error of the energy that leaves a step: six operations make the layer, eight join it.
const OF_PASSAGE: f64 = 8.0 * f64::EPSILON;
/// Rounding error per collision: `1 − Q − S p_f` cancels, and powers of weights are rounded.
const OF_COLLISION: f64 = 16.0 * f64::EPSILON;
/// Rounding error of every path: scores on the way, up to eight times.
const OF_PATH: f64 = 128.0 * f64::EPSILON;
/// The sum of the absolute weights of Romberg's scheme is below this.
const OF_SCHEME: f64 = 2.0;
/// Share by which steps are raised to count the passages through them.
const SHARE: f64 = 1e-8;

/// `E[Y^j X^k]` for j, k = 1, 2, of the absorbed energy and what leaves at one end.
pub type Joint = [[f64; 2]; 2];

/// Limits of a sequence of grids.
#[derive(Debug, Clone, Copy)]
pub struct Precision {
    /// Relative difference of two estimates at which no finer grid is solved.
    pub agreement: f64,
    /// The finest grid has steps `2^levels` times shorter than the coarsest.
    pub levels: usize,
}

impl Precision {
    /// Precision of expected values, and of predictions that draws are compared with.
    pub const FULL: Self = Self { agreement: 1e-12, levels: 6 };
    /// Precision of lines in plots and of the search of optima.
    pub const PLOTS: Self = Self { agreement: 1e-5, levels: 3 };
}

/// A list of numbers that a grid yields: the same numbers on every grid.
pub type Numbers<'f> = dyn Fn(&Grid) -> Option<Vec<f64>> + 'f;

/// Limits of numbers on finer and finer grids, each with a bound on its absolute error; `None` where a grid has no
/// answer.
pub fn romberg(
    walk: &Walk<'_>,
    precision: Precision,
    numbers: &Numbers<'_>,
) -> Option<Vec<[f64; 2]>> {
    let Limit { numbers: found, first, last } = limit(walk, precision, numbers)?;
    let rounding = rounding(&walk.grid(first), last / first, numbers);
    let rounding = rounding.unwrap_or_else(|| vec![f64::INFINITY; found.len()]);
    let pairs = found.iter().zip(rounding);
    Some(pairs.map(|([value, error], rounding)| [*value, error + rounding]).collect())
}

/// Limits of positive numbers that are next to their divergence, like 1/y next to y = 0. There they are no series
/// in the steps' lengths, but `1/(1 + x)` is.
pub fn next_to_divergence(walk: &Walk<'_>, numbers: &Numbers<'_>) -> Option<Vec<[f64; 2]>> {
    let inverse = |grid: &Grid| Some(numbers(grid)?.iter().map(|x| 1.0 / (1.0 + x)).collect());
    let Limit { numbers: found, last, .. } = limit(walk, Precision::FULL, &inverse)?;
    let rounding = rounding(&walk.grid(last), 1, numbers)?;
    let known = |([inverse, error], rounding): (&[f64; 2], f64)| {
        let rest = inverse - error;
        let off = if rest > 0.0 { error / (inverse * rest) } else { f64::INFINITY };
        [1.0 / inverse - 1.0, off + rounding]
    };
    Some(found.iter().zip(rounding).map(known).collect())
}

/// Result of a sequence of grids.
struct Limit {
    /// The numbers, each with the difference of the last two estimates.
    numbers: Vec<[f64; 2]>,
    /// Ratio of the coarsest grid's steps to those of the first grid, and of the last grid.
    first: usize,
    last: usize,
}

/// Romberg's scheme.
fn limit(walk: &Walk<'_>, precision: Precision, numbers: &Numbers<'_>) -> Option<Limit> {
    let mut before: Vec<Vec<f64>> = Vec::new();
    let (mut first, mut finer) = (1, 1);
    for level in 0..=precision.levels {
        let Some(found) = numbers(&walk.grid(finer)) else {
            // Steps that are too long may find echoes that diverge, where finer ones do not.
            before.clear();
            finer *= 2;
            first = finer;
            continue;
        };
        let mut row = vec![found];
        let mut factor = 1.0;
        for coarse in &before {
            factor *= 4.0;
            let fine = &row[row.len() - 1];
            let better = fine.iter().zip(coarse).map(|(f, c)| f + (f - c) / (factor - 1.0));
            row.push(better.collect());
        }
        let best = &row[row.len() - 1];
        if let Some(last) = before.last() {
            let error = |(x, y): (&f64, &f64)| (x - y).abs();
            let near = |pair: (&f64, &f64)| error(pair) <= precision.agreement * pair.0.abs();
            let agree = best.iter().zip(last).all(near);
            let no_finer = level == precision.levels || 2 * finer * walk.coarsest() > MOST_STEPS;
            if agree || no_finer {
                let numbers = best.iter().zip(last).map(|pair| [*pair.0, error(pair)]).collect();
                return Some(Limit { numbers, first, last: finer });
            }
        }
        before = row;
        finer *= 2;
    }
    None
}

/// Existence of a moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Existence {
    /// It exists, far from its divergence.
    Finite,
    /// It exists, but next to its divergence: its error must be found from grids.
    Near,
    /// It diverges: the rod would have to end at about this distance.
    Diverges(f64),
    /// It is within the error of its critical length.
    Unknown,
}

impl Existence {
    /// Existence of some moments.
    pub fn of<const N: usize>(walk: &Walk<'_>, powers: [i32; N]) -> [Self; N] {
        let fine = walk.grid(FINER);
        powers.map(|k| Self::on(walk, &fine, k))
    }

    fn on(walk: &Walk<'_>, fine: &Grid, k: i32) -> Self {
        if fine.critical(k, NEAR).is_none() {
            return Self::Finite;
        }
        if let Some(at) = fine.critical(k, -NEAR) {
            return Self::Diverges(at);
        }
        let margin = |grid: &Grid| Some(vec![grid.margin(k)?]);
        let Some(limit) = limit(walk, Precision::FULL, &margin) else { return Self::Unknown };
        let [margin, difference] = limit.numbers[0];
        // All terms are positive: roundings of ρ add up, no more.
        let steps = (walk.coarsest() * limit.last) as f64;
        let error = difference + OF_SCHEME * steps * (OF_PASSAGE + OF_COLLISION);
        if margin > error {
            Self::Near
        } else if margin < -error {
            let end = walk.rod.medium().span().to;
            Self::Diverges(fine.critical(k, 0.0).unwrap_or(end))
        } else {
            Self::Unknown
        }
    }
}

/// Absolute rounding error of the numbers of Romberg's scheme, where the finest grid has steps `finer` times
/// shorter than a grid on which they exist.
///
/// A step loses a share of the energy that leaves it, which is equal for equal steps: their roundings do not
/// cancel. A number collects it as often as its paths pass steps; scattering makes them pass again.
///
/// ```text
/// |δx| ≤ 2 (8ε ⟨passages⟩ + 16ε ⟨collisions⟩ + 128ε ⟨1⟩),  ⟨n⟩ = Σ |weight of a path| n
/// ```
fn rounding(grid: &Grid, finer: usize, numbers: &Numbers<'_>) -> Option<Vec<f64>> {
    let of_passage = OF_PASSAGE * finer as f64;
    let plain = numbers(&grid.raised([0.0; 2]))?;
    let raised = numbers(&grid.raised([SHARE, SHARE * OF_COLLISION / of_passage]))?;
    let bound = |(plain, raised): (&f64, &f64)| {
        OF_SCHEME * ((raised - plain).max(0.0) / SHARE * of_passage + OF_PATH * plain)
    };
    Some(plain.iter().zip(&raised).map(bound).collect())
}

fn nothing(_: usize, _: &Step) -> [f64; 2] {
    [0.0; 2]
}

/// Expected score of leaving at one end, for the k-th power of the weight.
fn leaving(grid: &Grid, k: i32, ends: [f64; 2]) -> Option<Importance> {
    grid.solve(|step| step.rates(k), nothing, ends)
}

const BEGINNING: [f64; 2] = [1.0, 0.0];
const END: [f64; 2] = [0.0, 1.0];

/// `E[X^k]` of a channel.
pub fn power(grid: &Grid, quantity: Quantity, k: i32) -> Option<f64> {
    let worth = match quantity {
        Quantity::Reflected => leaving(grid, k, BEGINNING)?,
        Quantity::Transmitted => leaving(grid, k, END)?,
        Quantity::ReflectedBy(order) => by_order(grid, k, BEGINNING, order)?,
        Quantity::TransmittedBy(order) => by_order(grid, k, END, order)?,
        Quantity::Absorbed => {
            score_times(grid, &absorbed, usize::try_from(k).ok()?, None)?.pop()?
        }
        Quantity::Flux(part) => {
            let flux = move |step: &Step, power: i32| {
                // σ̂ c = 1/width even where both c and a flight through σ̂ = 0 are infinite.
                if step.part == part { step.sampling.powi(1 - power) } else { 0.0 }
            };
            let path = score_times(grid, &flux, usize::try_from(k).ok()?, None)?.pop()?;
            return Some(path.entering() * grid.parts_per_length().powi(k));
        }
    };
    Some(worth.entering())
}

fn by_order(grid: &Grid, k: i32, ends: [f64; 2], order: usize) -> Option<Importance> {
    let rates = |step: &Step| [step.sampling * (1.0 - step.moments(k)[0]), 0.0];
    let mut worth = grid.solve(rates, nothing, ends)?;
    for _ in 0..order {
        let source = |i: usize, step: &Step| {
            let scattered = step.sampling * step.moments(k)[1];
            step.spread(worth.middle(i)).map(|spread| scattered * spread)
        };
        worth = grid.solve(rates, source, [0.0; 2])?;
    }
    Some(worth)
}

/// `σ̂ c^k` of a score.
type Score<'f> = dyn Fn(&Step, i32) -> f64 + 'f;

fn absorbed(step: &Step, power: i32) -> f64 {
    step.sampling * step.absorbed.powi(power)
}

/// `Y^i X^k` for i = 0 … j; `X^k` is the weight that leaves at one end to the power k, or 1.
fn score_times(
    grid: &Grid,
    score: &Score<'_>,
    j: usize,
    end: Option<([f64; 2], i32)>,
) -> Option<Vec<Importance>> {
    let k = end.map_or(0, |(_, k)| k);
    let mut found = Vec::new();
    if let Some((ends, k)) = end {
        found.push(leaving(grid, k, ends)?);
    }
    for power in found.len()..=j {
        if power == 0 {
            // Importance 1 for every event.
            found.push(grid.solve(|_| [0.0; 2], nothing, [1.0; 2])?);
            continue;
        }
        let source = |at: usize, step: &Step| {
            let mut sum = [0.0; 2];
            let mut ways = 1.0;
            for (i, worth) in (0_i32..).zip(&found) {
                let left = i32::try_from(power).unwrap_or(i32::MAX) - i;
                let share = ways * score(step, left);
                let order = i + k;
                // With the power 0 of the weight nothing is lost at any event.
                let middle = worth.middle(at);
                let after = if order == 0 { middle } else { step.after(order, middle) };
                sum = [sum[0] + share * after[0], sum[1] + share * after[1]];
                ways *= f64::from(left) / f64::from(i + 1);
            }
            sum
        };
        let order = i32::try_from(power).ok()? + k;
        let worth = grid.solve(|step| step.rates(order), source, [0.0; 2])?;
        found.push(worth);
    }
    Some(found)
}

/// See [`Joint`]; leaving at the beginning is reflectance.
pub fn joint(grid: &Grid, reflected: bool) -> Option<Joint> {
    let ends = if reflected { BEGINNING } else { END };
    let mut joint = [[0.0; 2]; 2];
    for k in 1..=2 {
        let found = score_times(grid, &absorbed, 2, Some((ends, k)))?;
        let place = usize::try_from(k - 1).ok()?;
        joint[0][place] = found[1].entering();
        joint[1][place] = found[2].entering();
    }
    Some(joint)
}

/// The factorial moments `E[M(M − 1)…(M − n + 1)]` of the number of lookups, n = 1 … 4.
pub fn lookups(grid: &Grid) -> Option<[f64; 4]> {
    let mut found = [0.0; 4];
    let mut worth: Option<Importance> = None;
    for (n, moment) in (1_i32..).zip(&mut found) {
        let source = |at: usize, step: &Step| {
            let rate = f64::from(n) * step.sampling;
            let after = worth.as_ref().map_or([1.0; 2], |worth| step.after(0, worth.middle(at)));
            [rate * after[0], rate * after[1]]
        };
        let next = grid.solve(|step| step.rates(0), source, [0.0; 2])?;
        *moment = next.entering();
        worth = Some(next);
    }
    Some(found)
}
