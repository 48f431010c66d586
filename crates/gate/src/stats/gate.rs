//! The gate: a sequential test of a scalar with a known variance, valid at any stopping time.
//!
//! A scalar y has mean 0 and variance V for correct draws. Two families of test supermartingales gather evidence:
//! `fail` against a correct y, and `pass` against a y with a mean that deviates by ε:
//!
//! ```text
//! λ = ε/V,  ε ≤ √V/4,  ψ Catoni's function
//! fail:  L_{s,m} = s Σψ(mλy) − nmλδ − n ln(1 + (mλ)² V/2),  s = ±1, m ∈ {1, 4, 16}
//!        E = mean of the six e^L;            failed when E ≥ K/α
//! pass:  P_s = Σψ(−sκλ(y − sε)) − n ln(1 + (κλ)² ρV/2),  κ = 0.6, ρ = 1.1
//!                                            passed when both P_s ≥ ln(1/β)
//! ```
//!
//! By Ville's inequality a correct y ever fails with probability α/K at most, for any tails and signs, and any
//! number of looks. A y with a mean that deviates by ε or more ever passes with probability β at most, provided
//! that its true variance is at most ρV. δ bounds the part of the mean from rounding and the prediction's own
//! error: it is charged to `fail`, and `pass` excludes ε − δ.
//!
//! Sources: O. Catoni, *Challenging the empirical mean and empirical variance*, AIHP B 48 (2012);
//! H. Wang, A. Ramdas, *Catoni-style confidence sequences for heavy-tailed mean estimation*,
//! Stochastic Processes and their Applications 163 (2023); J. Ville, *Étude critique de la notion
//! de collectif* (1939).

use super::capital::{Gains, ln_mean_exp};
use super::catoni::{Argument, PsiSums};

/// Number of sums of ψ of a scalar.
pub const SUMS: usize = 5;
/// The sums of one scalar.
pub type GateSums = PsiSums<SUMS>;

/// The multiples m of λ at which evidence against a correct y is gathered.
const SLOPES: [f64; 3] = [1.0, 4.0, 16.0];
/// κ, the share of λ at which evidence for a pass is gathered.
const CALM: f64 = 0.6;
/// ρ, the maximum ratio of the true variance to V for which the guarantee of a pass holds.
pub const VARIANCE_MARGIN: f64 = 1.1;
/// A pass is almost certain within `PLANNED · V/ε²` draws; planning uses it.
pub const PLANNED: f64 = 27.0;
/// A correct scalar passes after about `TYPICAL · V/ε²` draws.
pub const TYPICAL: f64 = 17.0;
/// Without a decision in `HORIZON · V/ε²` draws a scalar is inconclusive.
pub const HORIZON: f64 = 60.0;
/// The largest ε in units of √V: larger ones gather evidence too slowly.
const WIDEST: f64 = 0.25;

/// Parameters of the test of a scalar, fixed before the first draw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Design {
    /// V, an upper bound of the variance of a correct y.
    pub variance: f64,
    /// ε, the bias that a pass excludes.
    pub tolerance: f64,
    /// δ, the bias that a correct y may have.
    pub floor: f64,
    /// True if the caller gave ε, however large: λ is then at most that of √V/4.
    pub is_asked: bool,
}

/// The evidence at a look.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Evidence {
    /// ln E, against a correct y.
    pub ln_e: f64,
    /// ln of the evidence against a mean of +ε or more, and of −ε or less.
    pub ln_pass: [f64; 2],
}

/// Decision by the evidence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// Not enough evidence yet.
    Open,
    /// A correct y is refuted.
    Failed,
    /// A bias of ε or more is refuted.
    Passed,
}

/// The ε that `draws` draws are planned for: `√(27 V/n)`.
pub fn tolerance_of(variance: f64, draws: f64) -> f64 {
    (PLANNED * variance / draws).sqrt()
}

/// The draws that an ε is planned for: `27 V/ε²`.
pub fn draws_of(variance: f64, tolerance: f64) -> f64 {
    PLANNED * variance / (tolerance * tolerance)
}

/// Number of blocks at the look after the one at `blocks`: looks grow by 1.15.
pub fn next_look(blocks: u64) -> u64 {
    (blocks + 1).max(blocks * 115 / 100)
}

/// ln E at which one of `count` scalars fails that share `alpha`.
pub fn ln_fail(alpha: f64, count: usize) -> f64 {
    -(alpha / count.max(1) as f64).ln()
}

/// Returns whether a scalar also fails with its own variance `spread` in place of V: evidence that relies on a
/// variance that is refuted as too small does not count.
pub fn is_off_by_itself(mean: f64, spread: f64, draws: f64, ln_fail: f64) -> bool {
    0.5 * mean * mean * draws >= ln_fail * spread
}

impl Design {
    /// A test of a scalar with a variance of at most V: ε is narrowed to √V/4 where it is wider, and widened to 4δ
    /// where it is narrower.
    pub fn new(variance: f64, tolerance: f64, floor: f64) -> Self {
        let tolerance = tolerance.min(WIDEST * variance.sqrt()).max(4.0 * floor);
        Self { variance, tolerance, floor, is_asked: false }
    }

    /// A test with an ε that the caller gave. Beyond √V/4 evidence for a pass still grows with ε, but λ does not.
    pub fn asked(variance: f64, tolerance: f64, floor: f64) -> Self {
        Self { variance, tolerance: tolerance.max(4.0 * floor), floor, is_asked: true }
    }

    /// The test with another V.
    #[must_use]
    pub fn with_variance(&self, variance: f64) -> Self {
        let new = if self.is_asked { Self::asked } else { Self::new };
        new(variance, self.tolerance, self.floor)
    }

    /// λV: ε, up to its limit for bets.
    fn stake(&self) -> f64 {
        if self.is_asked {
            self.tolerance.min(WIDEST * self.variance.sqrt()).max(4.0 * self.floor)
        } else {
            self.tolerance
        }
    }

    /// The number of draws that the test is planned for: `27 V/ε²`; `27 V/(λVε)` where ε is wider than the bets.
    pub fn draws(&self) -> f64 {
        PLANNED * self.variance / (self.stake() * self.tolerance)
    }

    fn slope(&self) -> f64 {
        self.stake() / self.variance
    }

    /// The arguments of the five sums: three of `fail`, two of `pass`.
    pub fn arguments(&self) -> [Argument; SUMS] {
        let fail = |m: f64| Argument { slope: m * self.slope(), shift: 0.0 };
        let calm = CALM * self.slope();
        let shift = calm * (self.tolerance - self.floor);
        let pass = |s: f64| Argument { slope: -s * calm, shift };
        [fail(SLOPES[0]), fail(SLOPES[1]), fail(SLOPES[2]), pass(1.0), pass(-1.0)]
    }

    /// The evidence in the sums over `draws` draws.
    pub fn evidence(&self, sums: [f64; SUMS], draws: f64) -> Evidence {
        let Gains { against, pass: [above, below] } = self.gains(sums, draws);
        Evidence { ln_e: ln_mean_exp(&against), ln_pass: [above[0], below[0]] }
    }

    /// Gains of each L and P by the sums over `draws` draws. Where V or ε is chosen again before a block, from
    /// earlier draws, the gains of the blocks add up.
    pub fn gains(&self, sums: [f64; SUMS], draws: f64) -> Gains {
        let price = |slope: f64, variance: f64| draws * (0.5 * slope * slope * variance).ln_1p();
        let variance = self.variance + self.floor * self.floor;
        let against = SLOPES.iter().zip(sums).flat_map(|(m, sum)| {
            let slope = m * self.slope();
            let paid = price(slope, variance) + draws * slope * self.floor;
            [sum - paid, -sum - paid]
        });
        let paid = price(CALM * self.slope(), VARIANCE_MARGIN * self.variance);
        Gains { against: against.collect(), pass: [vec![sums[3] - paid], vec![sums[4] - paid]] }
    }
}

impl Evidence {
    /// The evidence before the first draw.
    pub const NONE: Self = Self { ln_e: 0.0, ln_pass: [0.0; 2] };

    /// The decision at the levels `ln(K/α)` and `ln(1/β)`. A failure comes first; evidence that is NaN decides
    /// nothing.
    pub fn decision(&self, ln_fail: f64, ln_pass: f64) -> Decision {
        if self.ln_e >= ln_fail {
            Decision::Failed
        } else if self.ln_pass.iter().all(|&p| p >= ln_pass) {
            Decision::Passed
        } else {
            Decision::Open
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::rng::{Address, unit};

    /// Uniform y of variance 1 about a mean, to a decision.
    fn decide(seed: u64, mean: f64, design: &Design, maximum: u64) -> (Decision, u64) {
        let mut rng = Address { seed, experiment: 0, block: 0, lane: 0 }.stream();
        let mut sums = GateSums::default();
        let mut draws = 0;
        while draws < maximum {
            let y: Vec<f64> =
                (0..256).map(|_| 12f64.sqrt() * (unit(&mut rng) - 0.5) + mean).collect();
            sums.absorb(&y, &design.arguments());
            draws += 256;
            let evidence = design.evidence(sums.totals(), draws as f64);
            let decision = evidence.decision((200.0f64 / 1e-3).ln(), 100f64.ln());
            if decision != Decision::Open {
                return (decision, draws);
            }
        }
        (Decision::Open, draws)
    }

    #[test]
    fn a_correct_scalar_passes_in_about_seventeen_units_and_a_biased_one_fails() {
        let design = Design::new(1.0, 0.05, 0.0);
        let unit = design.variance / design.tolerance.powi(2);
        let mut taken = [0.0; 2];
        for seed in 0..40 {
            let (decision, draws) = decide(seed, 0.0, &design, 100_000);
            assert_eq!(decision, Decision::Passed, "seed {seed}");
            taken[0] += draws as f64 / unit / 40.0;
            let (decision, draws) = decide(seed, -0.25, &design, 100_000);
            assert_eq!(decision, Decision::Failed, "seed {seed}");
            taken[1] += draws as f64 / unit / 40.0;
        }
        // Planned are 17 and, at 5ε, 1.3; a look every 256 draws adds up to 0.64.
        assert!((12.0..20.0).contains(&taken[0]) && taken[1] < 2.2, "{taken:?}");
    }

    #[test]
    fn a_tolerance_wider_than_the_spread_is_narrowed_and_one_below_rounding_is_widened() {
        assert!((Design::new(4.0, 10.0, 0.0).tolerance - 0.5).abs() < 1e-15);
        assert!((Design::new(4.0, 1e-9, 1e-6).tolerance - 4e-6).abs() < 1e-20);
    }

    #[test]
    fn planning_is_its_own_inverse() {
        assert!((draws_of(2.0, tolerance_of(2.0, 1e6)) - 1e6).abs() < 1e-6);
    }

    #[test]
    fn evidence_that_is_not_a_number_decides_nothing() {
        let nan = Evidence { ln_e: f64::NAN, ln_pass: [f64::NAN; 2] };
        assert_eq!(nan.decision(1.0, 1.0), Decision::Open);
    }

    #[test]
    fn a_bias_within_the_floor_never_fails() {
        let design = Design::new(1.0, 0.05, 0.01);
        for seed in 0..20 {
            let (decision, _) = decide(seed, 0.009, &design, 200_000);
            assert_ne!(decision, Decision::Failed);
        }
    }
}
