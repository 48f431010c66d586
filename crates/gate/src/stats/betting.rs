//! Bets against the mean of draws of a known range: evidence that needs no variance.
//!
//! ```text
//! y has mean 0 and lies in [a, b], a < 0 < b, either may be infinite
//! fail:  L = Σ ln(1 + λ(y − sδ)),    s = sign λ,  λ ≤ ¾/(δ − a) above 0, −λ ≤ ¾/(b + δ) below
//! pass:  P₊ = Σ ln(1 − λ(y − ε + δ)),  λ ≤ ¾/(b − ε + δ)     against a mean of +ε or more
//!        P₋ = Σ ln(1 + λ(y + ε − δ)),  λ ≤ ¾/(−a − ε + δ)    against a mean of −ε or less
//! |λ|    1, 4 and 16 times ε/V (pass: 0.6 times), and 1, 1/16, … 1/65536 of the largest
//! E = Σ v e^L;  each side of the pass likewise
//! ```
//!
//! A bet of a share of the capital on each draw gains the factor `1 + λ(y − m)`, which is never negative and 1 on
//! average where the mean is m. So each `e^L` is a test martingale. By Ville's inequality a correct y ever brings E
//! to K/α with probability α/K at most, for any distribution within the range and any number of looks. V only
//! guides the stakes: it may be estimated from earlier draws and be wrong. A mixture over a grid of λ comes within
//! a constant of the best λ in hindsight. An infinite end allows no stake towards it: draws that are never negative
//! may show a mean that is too large, never one that is too small (R. R. Bahadur, L. J. Savage, *The nonexistence
//! of certain statistical procedures in nonparametric problems*, Annals of Mathematical Statistics 27 (1956)).
//!
//! Source: I. Waudby-Smith, A. Ramdas, *Estimating means of bounded random variables by betting*,
//! JRSS B 86 (2024), sections 4 and 5 (the grid of stakes is their Grid-Kelly).

use super::capital::Gains;
use numeric::Lane;
use numeric::fused::{self, Loop};

/// Planned stakes against a correct mean in units of ε/V, each with its share of the capital of a side.
const PLANNED: [(f64, f64); 3] = [(1.0, 0.4), (4.0, 0.2), (16.0, 0.12)];
/// The planned stake of a pass.
const CALM: [(f64, f64); 1] = [(0.6, 0.8)];
/// Number of large stakes that share the rest of the capital.
const BOLD: i32 = 5;
/// Ratio of a large stake to the one before.
const STEP: f64 = 0.0625;
/// Maximum share of the capital that a draw may take.
const BOLDEST: f64 = 0.75;
/// Number of products side by side, which need not wait for each other.
const LANES: usize = 8;
/// Number of rows of draws with factors that are multiplied before a logarithm is taken.
const ROWS: usize = 16;
/// Products beyond this, and below its inverse, are split into logarithms.
const LARGE: f64 = 1e250;

/// Bets on draws of a known range, fixed before the draws are seen.
#[derive(Debug, Clone, PartialEq)]
pub struct Bets {
    /// The factors `offset + slope · y`: those against a correct mean, then both sides of the pass.
    factors: Vec<Factor>,
    /// Indices where the sides of the pass begin.
    pass: [usize; 2],
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Factor {
    slope: f64,
    offset: f64,
    /// Share of the capital of its side.
    share: f64,
}

/// Tolerance of a pass, and the estimate of V before a block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// ε.
    pub tolerance: f64,
    /// V, or its present estimate.
    pub variance: f64,
    /// True if ε may still change: then it guides the bets against a correct mean, and there are no bets on a pass.
    pub is_provisional: bool,
}

/// The stakes of one side, on a mean `m` with the far end of the range at a distance of `room`; 0 for
/// planned ones without an aim.
fn side(
    sign: f64,
    room: f64,
    m: f64,
    planned: &[(f64, f64)],
    aim: Option<Aim>,
) -> impl Iterator<Item = Factor> {
    let largest = BOLDEST / room;
    let slope = aim.map_or(0.0, |aim| aim.tolerance / aim.variance);
    let planned = planned.iter().map(move |&(times, share)| ((times * slope).min(largest), share));
    let left = 1.0 - planned.clone().map(|(_, share)| share).sum::<f64>();
    let bold = (0..BOLD).map(move |j| (largest * STEP.powi(j), left / f64::from(BOLD)));
    let is_bounded = room.is_finite() && room > 0.0;
    planned.chain(bold).filter(move |_| is_bounded).map(move |(size, share)| {
        let slope = sign * size;
        Factor { slope, offset: 1.0 - slope * m, share }
    })
}

impl Bets {
    /// Bets on draws in `[low, high]` about 0; `floor` is δ. Without an aim there are no bets on a pass.
    pub fn new([low, high]: [f64; 2], aim: Option<Aim>, floor: f64) -> Self {
        let mut factors: Vec<Factor> = side(1.0, floor - low, floor, &PLANNED, aim).collect();
        factors.extend(side(-1.0, high + floor, -floor, &PLANNED, aim));
        let above = factors.len();
        let aim = aim.filter(|aim| !aim.is_provisional);
        let excess = aim.map_or(0.0, |aim| aim.tolerance - floor);
        let room = |room: f64| if aim.is_some() { room - excess } else { f64::INFINITY };
        factors.extend(side(-1.0, room(high), excess, &CALM, aim));
        let below = factors.len();
        factors.extend(side(1.0, room(-low), -excess, &CALM, aim));
        Self { factors, pass: [above, below] }
    }

    /// The share of the capital of each bet on draws in a range, with an aim.
    pub fn shares(range: [f64; 2]) -> Gains {
        let far = range.map(|end| if end.is_finite() { end.signum() * 2.0 } else { end });
        let bets =
            Self::new(far, Some(Aim { tolerance: 1.0, variance: 1.0, is_provisional: false }), 0.0);
        let list = |factors: &[Factor]| {
            let all: f64 = factors.iter().map(|factor| factor.share).sum();
            factors.iter().map(|factor| factor.share / all).collect::<Vec<f64>>()
        };
        let [above, below] = bets.pass;
        let pass = [list(&bets.factors[above..below]), list(&bets.factors[below..])];
        Gains { against: list(&bets.factors[..above]), pass }
    }

    /// Gains of the bets on some draws. Each draw must lie in the range.
    pub fn gains(&self, y: &[f64]) -> Gains {
        let mut sums = vec![0.0; self.factors.len()];
        fused::run(BettingSums { factors: &self.factors, y, totals: &mut sums });
        let below = sums.split_off(self.pass[1]);
        let above = sums.split_off(self.pass[0]);
        Gains { against: sums, pass: [above, below] }
    }
}

/// `Σ ln(offset + slope · y)` for all factors.
struct BettingSums<'a> {
    factors: &'a [Factor],
    y: &'a [f64],
    totals: &'a mut [f64],
}

impl Loop for BettingSums<'_> {
    #[inline(always)]
    fn run(self) {
        // Products of all factors side by side: a compiler vectorizes the loop over their logarithms.
        let mut products = vec![[0.0; LANES]; self.factors.len()];
        let mut logarithms = products.clone();
        for chunk in self.y.chunks(ROWS * LANES) {
            let (rows, rest) = chunk.as_chunks::<LANES>();
            for (product, factor) in products.iter_mut().zip(self.factors) {
                let mut lanes = [1.0; LANES];
                for row in rows {
                    for lane in 0..LANES {
                        lanes[lane] *= row[lane].times_plus(factor.slope, factor.offset);
                    }
                }
                *product = lanes;
            }
            let all = logarithms.as_flattened_mut().iter_mut();
            for (ln, &product) in all.zip(products.as_flattened()) {
                *ln = Lane::ln(product);
            }
            for (number, factor) in self.factors.iter().enumerate() {
                let ln = |y: &f64| (factor.offset + factor.slope * y).ln();
                let is_tame = products[number].iter().all(|&p| p < LARGE && p > 1.0 / LARGE);
                self.totals[number] += if is_tame {
                    logarithms[number].iter().sum::<f64>()
                } else {
                    rows.as_flattened().iter().map(ln).sum()
                };
                self.totals[number] += rest.iter().map(ln).sum::<f64>();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::capital::Capital;
    use numeric::rng::{Address, unit};

    fn aim(tolerance: f64) -> Aim {
        Aim { tolerance, variance: 0.0675, is_provisional: false }
    }

    fn uniforms(seed: u64, n: usize) -> Vec<f64> {
        let mut rng = Address { seed, experiment: 0, block: 0, lane: 0 }.stream();
        (0..n).map(|_| unit(&mut rng)).collect()
    }

    #[test]
    fn gains_are_sums_of_logarithms() {
        let bets = Bets::new([-1e-9, 1.0], Some(aim(1e-10)), 1e-12);
        // Every fourth draw is an event that multiplies the capital by a billion.
        let y: Vec<f64> =
            uniforms(1, 1003).iter().map(|u| u.mul_add(4.0, -3.0).max(-1e-9)).collect();
        let gains = bets.gains(&y);
        for (factor, result) in bets.factors.iter().zip(&gains.against) {
            let sum: f64 = y.iter().map(|y| (factor.offset + factor.slope * y).ln()).sum();
            assert!((result - sum).abs() <= 1e-12 * (1.0 + sum.abs()), "{result} {sum}");
        }
    }

    #[test]
    fn every_factor_is_positive_and_fair_at_its_mean() {
        for (range, floor) in [([-0.2, 0.8], 0.0), ([-1.0, 1e6], 1e-3), ([-2.0, 0.5], 0.1)] {
            let bets = Bets::new(range, Some(aim(0.15)), floor);
            assert_eq!(bets.factors.len(), 28);
            for factor in &bets.factors {
                for y in range {
                    assert!(factor.offset + factor.slope * y > 0.2, "{factor:?} at {y}");
                }
            }
            // Against a correct mean the gain is 1 at 0, and on a pass it is 1 at ε − δ.
            let at = |factor: &Factor, y: f64| factor.offset + factor.slope * y;
            assert!(bets.factors[..16].iter().all(|factor| at(factor, 0.0) <= 1.0));
            assert!(bets.factors[16..22].iter().all(|f| (at(f, 0.15 - floor) - 1.0).abs() < 1e-12));
            assert!(bets.factors[22..].iter().all(|f| (at(f, floor - 0.15) - 1.0).abs() < 1e-12));
        }
    }

    #[test]
    fn nothing_is_staked_towards_an_infinite_end() {
        let gains = Bets::new([-1.0, f64::INFINITY], Some(aim(0.1)), 0.0).gains(&[0.5; 100]);
        assert_eq!((gains.against.len(), gains.pass[0].len(), gains.pass[1].len()), (8, 0, 6));
    }

    #[test]
    fn a_correct_mean_passes_and_a_biased_one_fails() {
        for (bias, is_failed) in [(0.0, false), (0.03, true), (-0.03, true)] {
            let bets = Bets::new([-0.5, 0.5], Some(aim(0.02)), 0.0);
            let mut capital = Capital::shared(Bets::shares([-0.5, 0.5]));
            for seed in 0..8 {
                let y: Vec<f64> =
                    uniforms(seed, 1000).iter().map(|u| (u - 0.5) * 0.9 + bias).collect();
                capital.add(&bets.gains(&y));
            }
            assert_eq!(capital.ln_e() > 1000f64.ln(), is_failed, "{bias}");
            let passed = capital.ln_pass().iter().all(|&p| p > 100f64.ln());
            assert_eq!(passed, !is_failed, "{bias}: {:?}", capital.ln_pass());
        }
    }

    #[test]
    fn rare_events_that_come_too_often_are_refuted_and_due_ones_are_not() {
        // Bernoulli draws of probability 1e-4, in units of it.
        for (probability, is_failed) in [(1e-4, false), (4e-4, true)] {
            let bets = Bets::new([-1.0, 9999.0], None, 0.0);
            let mut capital = Capital::default();
            let y = uniforms(3, 200_000)
                .iter()
                .map(|&u| if u < probability { 9999.0 } else { -1.0 })
                .collect::<Vec<_>>();
            capital.add(&bets.gains(&y));
            assert_eq!(capital.ln_e() > 1000f64.ln(), is_failed, "{}", capital.ln_e());
        }
    }
}
