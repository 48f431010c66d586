//! Predictions for one experiment.

pub mod count;
pub mod moments;
pub mod optimum;
pub mod raw;
pub mod search;

use super::{CountDistribution, Moments};
use numeric::{Grade, Known};

/// Prediction for an experiment, made before a draw.
#[derive(Debug, Clone, Default)]
pub struct Prediction {
    /// Channels of the value.
    pub channels: Vec<Channel>,
    /// The number of lookups of one draw; `None` where no closed form is known.
    pub lookups: Option<CountDistribution>,
    /// The mean number of lookups of one draw's shadow rays, part of those of [`Prediction::lookups`]; `None` where there
    /// are no shadow rays, or it is not known.
    pub shadow_lookups: Option<f64>,
    /// Lookups of σ_t that recipes for σ̂ and σ_c make for a ray before its first draw, as at explorer points and by pilot rays.
    pub setup_lookups: u64,
    /// The distribution of the draw, where it is known.
    pub distribution: Option<Distribution>,
    /// The covariances of the channels, where there are several.
    pub covariances: Vec<Covariance>,
    /// The steps of one walk from each distance of a curve to the next.
    pub increments: Vec<Increment>,
    /// The share of the ray on which the variance stays bounded, `σ̂ E[(1 − W)²] ≤ 2σ_t`; `None` where the
    /// estimator has no variance introduction density.
    pub stable_share: Option<f64>,
}

/// Prediction for one channel.
#[derive(Debug, Clone)]
pub struct Channel {
    /// The name, empty where there is one channel only.
    pub name: String,
    /// Expected value that the estimator should have.
    pub truth: Known,
    /// Mean of the draws; equal to `truth` if the estimator is unbiased.
    pub mean: Known,
    /// Central moments; `None` where no closed form is known.
    pub moments: Option<Moments>,
    /// Bound on the variance, where no more is known. Without moments, a bound or pilot draws the mean is not tested.
    pub variance_bound: Option<f64>,
    /// True if twice the variance of pilot draws may stand in for a variance that theory neither knows nor bounds.
    /// This requires light tails, as of lengths and counts of walks with weights that never grow.
    pub pilot_variance_allowed: bool,
    /// Heaviness of the tails.
    pub tails: Tails,
    /// Unit of relative tolerances: the expected value, or, for a transmittance of optical depth `0 < τ < 0.1`, the
    /// opacity `1 − T = −expm1(−τ)`.
    pub unit: f64,
    /// All values are in units of `exp(−log_unit)`: 0, or τ where T itself would underflow.
    pub log_unit: f64,
    /// `J_k = ∫ σ̂ E[(1 − W)^k] dt`, k = 1 … 4, for product estimators.
    pub losses: Option<[f64; 4]>,
}

/// Relative error of moments from which on theory does not resolve them: no digit is known.
pub const UNRESOLVED: f64 = 0.5;
/// Relative rounding error of a sum.
const ROUNDING: f64 = 1e-14;
/// Maximum relative variance that is rounding.
pub const CERTAIN: f64 = 1e-20;
/// Optical depth below which the opacity is the unit of tolerances.
const THIN: f64 = 0.1;

/// Sample sizes that sample statistics need to be reliable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tails {
    /// `n(2) = exp(D)`, D the relative entropy of the walks that carry `E[X²]` against those that occur: in fewer
    /// draws the events that make the variance are not seen.
    pub rare_event_size: f64,
    /// `E[X⁸]/E[X⁴]²`: the kurtosis of the terms of the sample variance, where tails are heavy.
    pub eighth_moment_ratio: f64,
}

impl Tails {
    /// A bounded draw that is not rare.
    pub const LIGHT: Self = Self { rare_event_size: 1.0, eighth_moment_ratio: 1.0 };
}

impl Channel {
    /// A single unbiased channel.
    pub fn unbiased(truth: Known, moments: impl Into<Option<Moments>>, tails: Tails) -> Self {
        Self {
            name: String::new(),
            truth,
            mean: truth,
            moments: moments.into(),
            variance_bound: None,
            pilot_variance_allowed: false,
            tails,
            unit: truth.value,
            log_unit: 0.0,
            losses: None,
        }
    }

    /// A channel of draws that are never negative, with a bound on `E[X²]` instead of moments.
    pub fn bounded(truth: Known, square: f64) -> Self {
        let minimum = (truth.value - truth.error).max(0.0);
        let variance_bound = Some((square - minimum * minimum).max(0.0));
        Self { variance_bound, ..Self::unbiased(truth, None, Tails::LIGHT) }
    }

    /// The moments, where theory resolves them: with a smaller relative error than [`UNRESOLVED`].
    pub fn resolved_moments(&self) -> Option<Moments> {
        self.moments.filter(|moments| moments.error < UNRESOLVED)
    }

    /// A bound on the relative error of the variance: that of the moments, and rounding.
    pub fn moments_error(&self) -> Option<f64> {
        let moments = self.moments?;
        if moments.relative[0] == 0.0 {
            return Some(0.0);
        }
        // Exponentials of the losses have the absolute errors of the exponents as relative errors.
        let exponents = self
            .losses
            .map_or(1.0, |[_, j2, j3, j4]| (6.0 * j2.abs() + 4.0 * j3.abs() + j4.abs()).max(1.0));
        Some(moments.error + ROUNDING * exponents)
    }

    /// Ground of the errors of the mean and, where they are known, of the moments; `None` for an unknown mean.
    pub fn error_grade(&self) -> Option<Grade> {
        let of_moments = self.moments.map_or(Grade::Proven, |moments| moments.grade);
        (!self.mean.value.is_nan()).then(|| self.mean.grade.min(of_moments))
    }

    /// An unbiased transmittance of the given optical depth, in units of `exp(−log_unit)`. The moments are without the
    /// error of the transmittance.
    pub fn transmittance(depth: Known, log_unit: f64, moments: Moments, tails: Tails) -> Self {
        let truth = transmittance(depth, log_unit);
        let thin = depth.value > 0.0 && depth.value < THIN;
        let unit = if thin { -(-depth.value).exp_m1() } else { truth.value };
        Self { unit, log_unit, ..Self::unbiased(truth, moments.in_units_of(truth), tails) }
    }
}

/// `T e^{log_unit} = exp(log_unit − τ)`.
pub fn transmittance(depth: Known, log_unit: f64) -> Known {
    Known { value: depth.value - log_unit, ..depth }.exp_neg()
}

/// One step of a walk along a curve, from one distance to the next.
///
/// With `A = X(s_{j−1})/T_{j−1}` and the independent factor `Y` of the step, both of mean 1, the
/// step is `Δ = A(Y − 1)`: a martingale difference, uncorrelated with all others. It runs on the
/// quadratic variation `g(s) = expm1(J₂(s))`:
///
/// ```text
/// Δ_j = X_j/T_j − X_{j−1}/T_{j−1},  X₀/T₀ = 1,  E[Δ_j] = 0
/// E[Δ_j²] = E[A²] E[(Y − 1)²] = e^{J₂(s_{j−1})} expm1(J₂(s_j) − J₂(s_{j−1})) = g(s_j) − g(s_{j−1})
/// E[Δ_j⁴] = E[A⁴] E[(Y − 1)⁴],  E[A⁴] = exp(6J₂ − 4J₃ + J₄) at s_{j−1}
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Increment {
    /// `E[Δ_j²]`, of one draw, relative to T².
    pub variance: f64,
    /// `E[Δ_j⁴]/E[Δ_j²]²`; 1 where the step has no variance, infinite where it overflows.
    pub kurtosis: f64,
    /// A relative error bound of the variance.
    pub error: f64,
}

/// The covariance of two channels, and the variance of its estimate.
#[derive(Debug, Clone, Copy)]
pub struct Covariance {
    /// The two channels.
    pub pair: [usize; 2],
    /// `E[(X₁ − T₁)(X₂ − T₂)]`.
    pub value: f64,
    /// `Var[(X₁ − T₁)(X₂ − T₂)]`.
    pub variance: f64,
}

impl Covariance {
    /// Covariance of a channel and the next, from their means, their `E[X²]`, and `E[X Y]`, `E[X² Y]`, `E[X Y²]`
    /// and `E[X² Y²]`.
    pub fn of_raw(
        pair: [usize; 2],
        [a, b]: [f64; 2],
        squares: [f64; 2],
        [ab, aab, abb, aabb]: [f64; 4],
    ) -> Self {
        let value = ab - a * b;
        let square = aabb - 2.0 * b * aab - 2.0 * a * abb
            + 4.0 * a * b * ab
            + b * b * squares[0]
            + a * a * squares[1]
            - 3.0 * a * a * b * b;
        Self { pair, value, variance: square - value * value }
    }
}

/// The distribution of a draw.
#[derive(Debug, Clone)]
pub enum Distribution {
    /// The draw takes the given values with the given probabilities, which sum to 1 or to a little less (the rest
    /// is a tail of unknown values).
    Atoms(Vec<(f64, f64)>),
    /// The draw is a distance with the given quantiles: `bins[i]` is where the CDF reaches
    /// `(i + 1)/n` of the probability `1 − escape`; beyond the last lies the atom of the rays that
    /// escape.
    Distances {
        /// Upper ends of the equally probable bins, except for the last, which ends at the ray's.
        bins: Vec<f64>,
        /// The end of the ray: the value of a draw that escapes.
        end: f64,
        /// The position of the ray's beginning: it limits the resolution of positions.
        from: f64,
        /// The probability of escaping.
        escape: f64,
    },
}

impl Prediction {
    /// The expected value alone, as for an estimator outside its domain.
    #[must_use]
    pub fn only_the_truth(self) -> Self {
        let mut channels = self.channels;
        for channel in &mut channels {
            channel.moments = None;
            channel.variance_bound = None;
        }
        let Self { stable_share, setup_lookups, .. } = self;
        Self { channels, setup_lookups, stable_share, ..Self::default() }
    }

    /// An experiment with one unbiased channel.
    pub fn single(channel: Channel, lookups: CountDistribution) -> Self {
        Self { channels: vec![channel], lookups: Some(lookups), ..Self::default() }
    }

    /// An experiment with one channel and an unknown number of lookups.
    pub fn uncounted(channel: Channel) -> Self {
        Self { channels: vec![channel], ..Self::default() }
    }

    /// `S/n`: a draw's share of the setup lookups, of a ray with n draws.
    pub fn shared_setup(&self, draws_per_ray: u64) -> f64 {
        self.setup_lookups as f64 / draws_per_ray.max(1) as f64
    }

    /// `E[M] + S/n`: expected lookups of a draw with its share of the setup lookups; `None` where E\[M\] is unknown.
    pub fn cost(&self, draws_per_ray: u64) -> Option<f64> {
        Some(self.lookups.as_ref()?.mean + self.shared_setup(draws_per_ray))
    }

    /// `1/(V · (E[M] + S/n))`, the efficiency per lookup, of a channel; infinite where the variance is 0, `None` where
    /// either factor is unknown or the cost is 0.
    pub fn figure_of_merit(&self, channel: usize, draws_per_ray: u64) -> Option<f64> {
        let moments = self.channels.get(channel)?.moments?;
        let (variance, cost) = (moments.variance(), self.cost(draws_per_ray)?);
        if moments.relative[0] <= CERTAIN && cost > 0.0 {
            return Some(f64::INFINITY);
        }
        (variance > 0.0 && cost > 0.0).then(|| 1.0 / (variance * cost))
    }
}
