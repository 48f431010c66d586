//! Predictions for rods with an emitter at the end in several channels, with draws that score all of them.
//!
//! ```text
//! independent       E[X_λ^k] = w_λ^{1−k} E[x_λ^k],  x_λ a draw of [`super`] in the channel λ; E[X_λ X_μ] = 0
//! one σ_t and σ̂     a chain of equations by the numbers of scatterings, see [`orders`]
//! forward only      hits are products along the ray, see [`forward`]
//! elsewhere         the means, and bounds on variances: hits never score more than 1/w_λ; with shadow rays see [`bound`]
//! ```
//!
//! The lookups of a draw are those of its hero's walk, mixed over heroes: they are known in every medium.
//!
//! Source: derived from the densities of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), sections 5.3 and 5.4.

pub mod bound;
pub mod forward;
pub mod orders;

use self::forward::Forward;
use self::orders::Orders;
use super::WalkMoments;
use crate::colours::{self, Chances};
use crate::light::{Combination, Densities, Heuristic, Shadow, Techniques};
use crate::prediction::Covariance;
use crate::prediction::raw::{RESOLVED, RawMoments};
use crate::problems::SpectralLitRod;
use crate::rod::lit;
use crate::{Channel, CountDistribution, Mesh, Prediction, Tails};
use media::Piecewise;
use numeric::Known;

/// Hits alone.
pub const HITS: Techniques = Techniques { shadow: None, combination: Combination::Unidirectional };
/// Hits and ratio-tracked shadow rays, by null-scattering paths and the balance heuristic.
pub const FULL: Techniques = Techniques {
    shadow: Some(Shadow::Ratio),
    combination: Combination::Mis(Densities::Full, Heuristic::Balance),
};

/// Scoring of the channels by one draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LitTracker {
    /// Scores one channel by its own walk, the others 0.
    Independent {
        /// True if it casts shadow rays.
        casts: bool,
    },
    /// Scores all channels by the walk of a hero, by the balance heuristic over all heroes.
    Mis {
        /// True if it casts shadow rays.
        casts: bool,
    },
    /// One σ̂ for all channels, and event probabilities that depend on all of them.
    Tracking(Chances),
}

impl LitTracker {
    fn techniques(self) -> Techniques {
        match self {
            Self::Independent { casts: true } | Self::Mis { casts: true } => FULL,
            _ => HITS,
        }
    }
}

/// A chromatic rod with everything that its moments depend on.
pub struct RodSpectrum<'a> {
    problem: &'a SpectralLitRod,
    media: Vec<(&'a Mesh, &'a Piecewise)>,
    heroes: Vec<f64>,
    tracker: LitTracker,
}

/// Moments of the draws of all channels beside their means.
pub struct Moments {
    /// Raw moments of each channel.
    raw: Vec<RawMoments>,
    /// [`PAIRS`] of each channel and the next.
    mixed: Vec<[f64; 4]>,
}

/// The powers of `E[X_λ X_μ]`, `E[X_λ² X_μ]`, `E[X_λ X_μ²]` and `E[X_λ² X_μ²]`.
const PAIRS: [[usize; 2]; 4] = [[1, 1], [2, 1], [1, 2], [2, 2]];

impl<'a> RodSpectrum<'a> {
    /// Joins the parts; mesh and σ̂, and `heroes`, have one entry for each channel.
    pub fn new(
        problem: &'a SpectralLitRod,
        media: Vec<(&'a Mesh, &'a Piecewise)>,
        heroes: Vec<f64>,
        tracker: LitTracker,
    ) -> Self {
        Self { problem, media, heroes, tracker }
    }

    fn channels(&self) -> usize {
        self.heroes.len()
    }

    /// Prediction for a draw. Without `with_distributions`, as for lines in plots, only variances and mean lookups are valid.
    pub fn predict(&self, with_distributions: bool) -> Prediction {
        let techniques = self.tracker.techniques();
        let result: Option<Vec<WalkMoments>> = self
            .media
            .iter()
            .zip(&self.problem.rods)
            .map(|((mesh, sampling), rod)| {
                WalkMoments::of(mesh, rod, sampling, techniques, with_distributions)
            })
            .collect();
        let forward = Forward::new(self.problem, &self.media, &self.heroes);
        let lookups = match (self.tracker, &forward) {
            (LitTracker::Tracking(chances), Some(forward)) => forward.lookups(chances),
            _ => None,
        };
        let of_heroes = |result: &Vec<WalkMoments>| {
            let factorial = result.iter().map(|result| result.lookups);
            let mixed = colours::mixed(self.heroes.iter().copied().zip(factorial));
            mixed.map(CountDistribution::of_factorial)
        };
        let lookups = lookups.or_else(|| result.as_ref().and_then(of_heroes));
        let shadow_lookups = result.as_ref().and_then(|result| {
            let each = self.heroes.iter().zip(result);
            each.map(|(weight, result)| Some(weight * result.shadow_lookups?)).sum()
        });
        let moments = match (self.tracker, &forward) {
            (LitTracker::Tracking(chances), forward) => {
                forward.as_ref().and_then(|forward| forward.tracking(chances))
            }
            (LitTracker::Mis { .. }, _) if self.channels() > 1 => {
                self.by_orders(with_distributions).or_else(|| {
                    let is_hits = self.tracker.techniques() == HITS;
                    forward.filter(|_| is_hits)?.balanced()
                })
            }
            _ => result.map(|result| self.independent(&result)),
        };
        let answers = self.media.iter().zip(&self.problem.rods);
        let answers: Vec<Known> = answers.map(|((mesh, _), rod)| lit::answer(mesh, rod)).collect();
        let channel = |(index, &answer): (usize, &Known)| match &moments {
            Some(moments) => moments.raw[index].channel(answer, RESOLVED),
            None => match self.most_square(index, answer).filter(|_| with_distributions) {
                Some(square) => Channel::bounded(answer, square),
                None => Channel::unbiased(answer, None, Tails::LIGHT),
            },
        };
        let channels = colours::named(answers.iter().enumerate().map(channel).collect());
        let mut covariances = Vec::new();
        if let Some(moments) = moments.filter(|_| with_distributions) {
            for (index, mixed) in moments.mixed.iter().enumerate() {
                let means = [answers[index].value, answers[index + 1].value];
                let squares = [index, index + 1].map(|channel| moments.raw[channel].second().value);
                covariances.push(Covariance::of_raw([index, index + 1], means, squares, *mixed));
            }
        }
        Prediction { channels, lookups, shadow_lookups, covariances, ..Prediction::default() }
    }

    /// A bound on `E[X²]` of a channel by MIS over heroes.
    fn most_square(&self, channel: usize, answer: Known) -> Option<f64> {
        let weighted = match self.tracker {
            LitTracker::Mis { casts: true } => {
                let (mesh, sampling) = self.media[channel];
                bound::weighted_square(mesh, &self.problem.rods[channel], sampling, FULL)?
            }
            // A hit is f_λ/Σ w_h p_h ≤ 1/w_λ, also with history-aware tracking.
            LitTracker::Mis { casts: false } | LitTracker::Tracking(Chances::History) => {
                answer.value + answer.error
            }
            LitTracker::Independent { .. } | LitTracker::Tracking(_) => return None,
        };
        Some(weighted / self.heroes[channel])
    }

    /// Moments of one channel a draw; for a single channel, those of every tracker.
    fn independent(&self, result: &[WalkMoments]) -> Moments {
        let raw = self.heroes.iter().zip(result);
        let raw = raw.map(|(&weight, result)| colours::independent(&result.raw, weight));
        Moments { raw: raw.collect(), mixed: vec![[0.0; 4]; self.channels() - 1] }
    }

    /// Moments where all channels have the same σ_t and σ̂.
    fn by_orders(&self, with_distributions: bool) -> Option<Moments> {
        let &[(mesh, sampling), ref others @ ..] = &self.media[..] else { return None };
        let nodes: Vec<f64> = mesh.panels().flat_map(|panel| panel.t.iter().copied()).collect();
        let here = mesh.medium().extinctions(&nodes);
        let is_same = |(other, majorant): &(&Mesh, &Piecewise)| {
            majorant.single_value() == sampling.single_value()
                && other.medium().extinctions(&nodes) == here
                && other.optical_depth().value == mesh.optical_depth().value
        };
        if !others.iter().all(is_same) {
            return None;
        }
        let orders = Orders::new(self.problem, mesh, &self.heroes, self.tracker.techniques())?;
        orders.moments(sampling, with_distributions)
    }
}
