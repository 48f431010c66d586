//! Correct draws of difficult distributions, judged like draws of another program: does any of them fail?
//!
//! ```text
//! distributions  Bernoulli(1e-2 … 1e-6), log-normal (σ = 1, 2, 3), a spike of probability 1e-5 on a constant and
//!                on noise of width 1e-4, a constant with a spread of 1e-9, Pareto draws less 1 (index 2.2 and 4.5),
//!                a signed product ∏(1 − 3tᵢ) over a Poisson number of uniform tᵢ, exponential, uniform
//! claims         truth; truth and variance; truth, variance and kurtosis; truth and range
//! ```
//!
//! Truth, variance and kurtosis are exact. A claim is left out where the distribution has no finite kurtosis, or no
//! range. Every stream has 4e5 draws and its own address, and is judged at α = 1e-3 for each of the claims.

use gate::session::{CheckedClaim, Claim, Options, ROUNDING};
use gate::stats::binomial;
use gate::stats::verdict::Verdict;
use numeric::rng::{Address, Stream, exponential, unit};
use rand::RngExt;
use rand_distr::{Distribution, Poisson, StandardNormal};
use theory::parallel;

/// Number of draws of a stream.
const DRAWS: usize = 400_000;
/// Probability that a correct stream fails.
pub const ALPHA: f64 = 1e-3;
/// The confidence at which a promise counts as broken.
const CERTAIN: f64 = 1.0 - 1e-6;
/// The range of draws that are never negative.
const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];
/// Height of a spike.
const SPIKE: f64 = 1e5;
/// Probability of a spike.
const RARE: f64 = 1e-5;
/// Width of the noise below spikes.
const NOISE: f64 = 1e-4;
/// Width of the nearly constant distribution.
const NARROW: f64 = 1e-9;
/// Mean number of factors of the signed product, Λ.
const MEAN_FACTORS: f64 = 1.5;

/// Distribution of draws with known moments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DrawDistribution {
    /// 1 with this probability, else 0.
    Bernoulli(f64),
    /// `e^{σz}`, z normal.
    LogNormal(f64),
    /// 1, and 1e5 more with probability 1e-5.
    Spike,
    /// [`DrawDistribution::Spike`] with a uniform noise of width 1e-4.
    NoisySpike,
    /// Uniform on an interval of length 1e-9 about 1.
    Narrow,
    /// `u^{−1/a} − 1`.
    Pareto(f64),
    /// `∏(1 − 3tᵢ)`: r from 0 to 3.
    Signed,
    /// `e^{−x}`.
    Exponential,
    /// Uniform on [0, 1].
    Uniform,
}

/// Every distribution.
pub const LAWS: [DrawDistribution; 15] = [
    DrawDistribution::Bernoulli(1e-2),
    DrawDistribution::Bernoulli(1e-3),
    DrawDistribution::Bernoulli(1e-4),
    DrawDistribution::Bernoulli(1e-5),
    DrawDistribution::Bernoulli(1e-6),
    DrawDistribution::LogNormal(1.0),
    DrawDistribution::LogNormal(2.0),
    DrawDistribution::LogNormal(3.0),
    DrawDistribution::Spike,
    DrawDistribution::NoisySpike,
    DrawDistribution::Narrow,
    DrawDistribution::Pareto(2.2),
    DrawDistribution::Pareto(4.5),
    DrawDistribution::Signed,
    DrawDistribution::Exponential,
];

/// Quantities that are claimed of the draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Claims {
    /// The truth alone.
    Truth,
    /// The truth and the variance.
    Variance,
    /// The truth, the variance and the kurtosis.
    Kurtosis,
    /// The truth and a range.
    Range,
}

/// Every combination of claims.
pub const CLAIMS: [Claims; 4] = [Claims::Truth, Claims::Variance, Claims::Kurtosis, Claims::Range];

impl std::fmt::Display for Claims {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Truth => "truth",
            Self::Variance => "truth, variance",
            Self::Kurtosis => "truth, variance, kurtosis",
            Self::Range => "truth, range",
        })
    }
}

impl std::fmt::Display for DrawDistribution {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Bernoulli(p) => write!(f, "Bernoulli {p:e}"),
            Self::LogNormal(sigma) => write!(f, "log-normal, σ = {sigma}"),
            Self::Spike => write!(f, "spike of 1e-5 on a constant"),
            Self::NoisySpike => write!(f, "spike of 1e-5 on noise"),
            Self::Narrow => write!(f, "nearly constant"),
            Self::Pareto(index) => write!(f, "shifted Pareto, index {index}"),
            Self::Signed => write!(f, "signed product, r to 3"),
            Self::Exponential => write!(f, "exponential"),
            Self::Uniform => write!(f, "uniform"),
        }
    }
}

/// Central moments from raw ones: variance and kurtosis.
fn central([m1, m2, m3, m4]: [f64; 4]) -> (f64, f64) {
    let variance = m2 - m1 * m1;
    let fourth = m4 - 4.0 * m1 * m3 + 6.0 * m1 * m1 * m2 - 3.0 * m1.powi(4);
    (variance, fourth / (variance * variance))
}

impl DrawDistribution {
    /// Mean, variance, kurtosis where it is finite, and range where there is one.
    fn moments(self) -> (f64, f64, Option<f64>, Option<[f64; 2]>) {
        let two_point = |p: f64| (1.0 - 3.0 * p * (1.0 - p)) / (p * (1.0 - p));
        match self {
            Self::Bernoulli(p) => (p, p * (1.0 - p), Some(two_point(p)), Some([0.0, 1.0])),
            Self::LogNormal(sigma) => {
                let w = (sigma * sigma).exp();
                let kurtosis = w.powi(4) + 2.0 * w.powi(3) + 3.0 * w * w - 3.0;
                (w.sqrt(), (w - 1.0) * w, Some(kurtosis), Some(POSITIVE))
            }
            Self::Spike => {
                let variance = SPIKE * SPIKE * RARE * (1.0 - RARE);
                let range = [1.0, 1.0 + SPIKE];
                (1.0 + SPIKE * RARE, variance, Some(two_point(RARE)), Some([range[0], range[1]]))
            }
            Self::NoisySpike => {
                // Sums of independent parts: variances add, fourth moments with 6 times the product.
                let (spike, noise) = (SPIKE * SPIKE * RARE * (1.0 - RARE), NOISE * NOISE / 12.0);
                let fourth =
                    two_point(RARE) * spike * spike + 6.0 * spike * noise + 1.8 * noise * noise;
                let variance = spike + noise;
                let range = [1.0 - 0.5 * NOISE, 1.0 + SPIKE + 0.5 * NOISE];
                let kurtosis = fourth / (variance * variance);
                (1.0 + SPIKE * RARE, variance, Some(kurtosis), Some(range))
            }
            Self::Narrow => {
                let half = 0.5 * NARROW;
                (1.0, NARROW * NARROW / 12.0, Some(1.8), Some([1.0 - half, 1.0 + half]))
            }
            Self::Pareto(a) => {
                let variance = a / ((a - 1.0) * (a - 1.0) * (a - 2.0));
                let raw = |k: f64| a / (a - k);
                let all = [1.0, 2.0, 3.0, 4.0].map(raw);
                let kurtosis = (a > 4.0).then(|| central(all).1);
                (1.0 / (a - 1.0), variance, kurtosis, Some(POSITIVE))
            }
            Self::Signed => {
                // ∫(1 − 3t)^k dt over [0, 1].
                let integral = |k: i32| (1.0 - (-2f64).powi(k + 1)) / (3.0 * f64::from(k + 1));
                let raw = [1, 2, 3, 4].map(|k| (MEAN_FACTORS * (integral(k) - 1.0)).exp());
                let (variance, kurtosis) = central(raw);
                (raw[0], variance, Some(kurtosis), None)
            }
            Self::Exponential => (1.0, 1.0, Some(9.0), Some(POSITIVE)),
            Self::Uniform => (0.5, 1.0 / 12.0, Some(1.8), Some([0.0, 1.0])),
        }
    }

    /// Returns the values that are claimed; `None` where the distribution has no such value.
    pub fn claim(self, claims: Claims) -> Option<Claim> {
        let (truth, variance, kurtosis, range) = self.moments();
        let given = Claim { rounding: ROUNDING, ..Claim::of_truth(truth) };
        let given = match claims {
            Claims::Truth => given,
            Claims::Variance => Claim { variance: Some(variance), ..given },
            Claims::Kurtosis => {
                Claim { variance: Some(variance), kurtosis: Some(kurtosis?), ..given }
            }
            Claims::Range => Claim { range: Some(range?), ..given },
        };
        given.validated().ok()
    }

    /// A draw.
    fn draw(self, rng: &mut Stream) -> f64 {
        match self {
            Self::Bernoulli(p) => f64::from(u8::from(unit(rng) < p)),
            Self::LogNormal(sigma) => {
                let z: f64 = StandardNormal.sample(rng);
                (sigma * z).exp()
            }
            Self::Spike => 1.0 + if unit(rng) < RARE { SPIKE } else { 0.0 },
            Self::NoisySpike => {
                let spike = if unit(rng) < RARE { SPIKE } else { 0.0 };
                1.0 + NOISE * (unit(rng) - 0.5) + spike
            }
            Self::Narrow => 1.0 + NARROW * (unit(rng) - 0.5),
            Self::Pareto(a) => (1.0 - unit(rng)).powf(-1.0 / a) - 1.0,
            Self::Signed => {
                let number =
                    Poisson::new(MEAN_FACTORS).map_or(0.0, |distribution| distribution.sample(rng));
                let mut product = 1.0;
                let mut left = number;
                while left >= 1.0 {
                    product *= 1.0 - 3.0 * rng.random::<f64>();
                    left -= 1.0;
                }
                product
            }
            Self::Exponential => exponential(rng),
            Self::Uniform => unit(rng),
        }
    }

    /// The draws of one stream.
    pub fn draws(self, stream: u64) -> Vec<f64> {
        let experiment = numeric::rng::name_hash(&self.to_string());
        let mut rng = Address { seed: 1, experiment, block: stream, lane: 0 }.stream();
        (0..DRAWS).map(|_| self.draw(&mut rng)).collect()
    }
}

impl StreamVerdicts {
    /// Returns whether the counts do not refute that a correct stream fails with probability at most α.
    pub fn is_kept(&self) -> bool {
        binomial::interval(self.failed, self.streams, CERTAIN).0 <= ALPHA
    }
}

/// Counts of verdicts on the streams of one distribution with one claim.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StreamVerdicts {
    /// The distribution.
    pub distribution: String,
    /// The claim.
    pub known: String,
    /// Number of streams that were judged.
    pub streams: u64,
    /// Number of streams that passed.
    pub passed: u64,
    /// Number of streams that failed.
    pub failed: u64,
    /// Number of streams with an inconclusive verdict.
    pub inconclusive: u64,
    /// Reason of the first failure; empty without one.
    pub reason: String,
}

/// Judges a number of streams of every distribution with every claim; `step` is called after each stream.
pub fn all(streams: u64, step: &(dyn Fn(u64) + Sync)) -> Vec<StreamVerdicts> {
    LAWS.iter().flat_map(|&distribution| of_law(distribution, streams, step)).collect()
}

fn of_law(
    distribution: DrawDistribution,
    streams: u64,
    step: &(dyn Fn(u64) + Sync),
) -> Vec<StreamVerdicts> {
    let expected = Options { alpha: ALPHA, ..Options::default() };
    let trials: Vec<(Claims, CheckedClaim)> = CLAIMS
        .into_iter()
        .filter_map(|known| {
            let trial =
                CheckedClaim::new(distribution.claim(known)?, expected, Some(DRAWS as u64)).ok()?;
            Some((known, trial))
        })
        .collect();
    let judged: Vec<Vec<(Verdict, String)>> = parallel::numbered(streams, |stream| {
        let draws = distribution.draws(stream);
        let computed = trials.iter().map(|(_, trial)| {
            let judgement = trial.judge_all(&draws);
            (judgement.verdict, judgement.reason)
        });
        let computed = computed.collect();
        step(1);
        computed
    });
    let verdicts = trials.iter().enumerate().map(|(k, (known, _))| {
        let count =
            |verdict| judged.iter().filter(|computed| computed[k].0 == verdict).count() as u64;
        let failure = judged.iter().find(|computed| computed[k].0 == Verdict::Fail);
        StreamVerdicts {
            distribution: distribution.to_string(),
            known: known.to_string(),
            streams,
            passed: count(Verdict::Pass),
            failed: count(Verdict::Fail),
            inconclusive: count(Verdict::Inconclusive),
            reason: failure.map_or(String::new(), |computed| computed[k].1.clone()),
        }
    });
    verdicts.collect()
}
