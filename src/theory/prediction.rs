//! All that theory says of one experiment.

use super::{CountLaw, Moments};
use crate::numeric::Known;

/// What theory says of an experiment before a draw is made.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// One entry per channel of the value.
    pub channels: Vec<Channel>,
    /// The number of lookups of one draw; `None` where no closed form is known.
    pub lookups: Option<CountLaw>,
    /// The whole law of the draw, where it is known.
    pub law: Option<Law>,
    /// The covariances of the channels, where there are several.
    pub covariances: Vec<Covariance>,
    /// The increments along one walk, where the value is a curve.
    pub increments: Vec<Increment>,
    /// The share of the ray on which the variance stays bounded, `w ≤ 2σ_t`; `None` where the
    /// estimator has no variance introduction density.
    pub stable_share: Option<f64>,
}

/// What theory says of one channel.
#[derive(Debug, Clone)]
pub struct Channel {
    /// The name, empty where there is one channel only.
    pub name: String,
    /// What the estimator is meant to find.
    pub truth: Known,
    /// What its draws are on average; equal to `truth` if it is unbiased.
    pub mean: Known,
    /// What relative tolerances refer to: the truth, or the opacity where that is small.
    pub unit: f64,
    /// Its central moments; `None` where no closed form is known.
    pub moments: Option<Moments>,
    /// How heavy its tails are.
    pub tails: Tails,
}

/// How many draws it takes before sample statistics mean what they say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tails {
    /// `n(2) = exp(D)`, D the relative entropy of the walks that carry `E[X²]` against those that
    /// occur: with fewer draws the events that make the variance are not seen.
    pub rare_event_size: f64,
    /// `E[X⁸]/E[X⁴]²`: the kurtosis of what the sample variance sums, where tails are heavy.
    pub eighth_moment_ratio: f64,
}

impl Tails {
    /// A bounded draw that is not rare.
    pub const LIGHT: Self = Self { rare_event_size: 1.0, eighth_moment_ratio: 1.0 };
}

impl Channel {
    /// A single unbiased channel.
    #[must_use]
    pub fn unbiased(truth: Known, moments: Moments, tails: Tails) -> Self {
        let name = String::new();
        Self { name, truth, mean: truth, unit: truth.value, moments: Some(moments), tails }
    }
}

/// The covariance of two channels, and of what measures it.
#[derive(Debug, Clone, Copy)]
pub struct Covariance {
    /// The two channels.
    pub pair: [usize; 2],
    /// `E[(X₁ − T₁)(X₂ − T₂)]`.
    pub value: f64,
    /// `Var[(X₁ − T₁)(X₂ − T₂)]`.
    pub variance: f64,
}

/// An increment.
#[derive(Debug, Clone, Copy)]
pub struct Increment {
    /// variance
    pub variance: f64,
    /// kurtosis
    pub kurtosis: f64,
}

/// A law that is known as a whole.
#[derive(Debug, Clone)]
pub enum Law {
    /// The draw takes the given values with the given probabilities, which sum to 1 or to a little
    /// less (what is left is a tail without name).
    Atoms(Vec<(f64, f64)>),
    /// The draw is a distance with the given quantiles: `bins[i]` is where the CDF reaches
    /// `(i + 1)/n` of the probability `1 − escape`; beyond the last lies the atom of the rays that
    /// escape.
    Distances {
        /// Upper ends of the equally probable bins, except for the last, which ends at the ray's.
        bins: Vec<f64>,
        /// The end of the ray: the value of a draw that escapes.
        end: f64,
        /// The probability of escaping.
        escape: f64,
    },
}

impl Prediction {
    /// An experiment with one unbiased channel.
    #[must_use]
    pub fn single(channel: Channel, lookups: CountLaw) -> Self {
        Self {
            channels: vec![channel],
            lookups: Some(lookups),
            law: None,
            covariances: Vec::new(),
            increments: Vec::new(),
            stable_share: None,
        }
    }

    /// `1/(V · E[M])`, the efficiency per lookup, of the last channel; `None` where either is
    /// unknown or zero.
    #[must_use]
    pub fn figure_of_merit(&self) -> Option<f64> {
        let variance = self.channels.last()?.moments?.variance();
        let cost = self.lookups.as_ref()?.mean;
        (variance > 0.0 && cost > 0.0).then(|| 1.0 / (variance * cost))
    }
}
