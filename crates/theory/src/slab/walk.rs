//! A walk in a slab: mean, variance and cost of its estimates of reflectance and transmittance.
//!
//! Let `Q_k`, `S_k` be the k-th moments of the weights after a tentative collision. Then `E[X^k]` is reflectance or
//! transmittance of the slab that is `∫σ̂(1 − Q_k)` thick and has the albedo `S_k/(1 − Q_k)`, layer by layer where
//! `r = σ_t/σ̂` changes from layer to layer. For rules that keep the weight at a null collision, `r ≤ 1`, these are
//! τ and `S_k` at r = 1, whatever σ_t and σ̂. Elsewhere, where r varies continuously, layers have the mean `Q_k`
//! and `S_k`. The error is of second order in their thickness. It is extrapolated from two cuts, and bounded by
//! their difference and by the error of the directions.
//!
//! A walk leaves on one side only: `X_R X_T = 0`, which makes the covariance.
//!
//! ```text
//! Cov[X_R, X_T] = −RT,   E[(X_R − R)²(X_T − T)²] = E[X_R²]T² + E[X_T²]R² − 3R²T²
//! ```
//!
//! The number M of collisions has the factorial moments that are the scores of a slab of `zQ_0` and `zS_0` over power
//! series in y, with `z = 1 + y`, see [`super::layer`]. Where r varies they are extrapolated like other moments.
//!
//! Source: Szirmay-Kalos et al. 2017, sections 3.1–3.3; that moments are slabs again, the covariance and
//! the cost are derived here.

use super::pieces::{Piece, Pieces};
use super::{
    Energy, EnergyBounds, IncidentLight, Resolution, counts, energies, factorial_moments, solve,
};
use crate::collisions::particle::EventProbabilities;
use crate::prediction::raw::{POWERS, RawMoments};
use crate::prediction::{Covariance, UNRESOLVED};
use crate::problems::slab::Incidence;
use crate::{Channel, CountDistribution, Kernel, ParticleRule, Prediction, Tails, colours};
use numeric::{Jet, Known, Scalar};

/// The channels of a draw, in their order.
pub const CHANNELS: [&str; 2] = ["reflectance", "transmittance"];

/// Relative distance to a critical depth within which theory does not resolve on which side of it a slab is.
const NEAR: f64 = 1e-3;

/// Maximum number of directions of lookups where r varies: series in a hundred layers of more take many seconds.
const MAX_DIRECTIONS: usize = 24;

/// Rounding of `1 − r`, and of a factor of the weight.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Existence of moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existence {
    /// They exist.
    Finite,
    /// They are infinite.
    Diverges,
    /// The slab is next to the critical depth.
    Unknown,
}

/// A walk in a slab.
#[derive(Debug, Clone)]
pub struct SlabWalk {
    /// Light and phase function.
    pub incidence: Incidence,
    /// a.
    pub albedo: f64,
    /// Rule at a collision.
    pub rule: ParticleRule,
    /// The layers.
    pub pieces: Pieces,
    /// The largest r.
    pub largest_ratio: f64,
    /// τ of the slab.
    pub depth: f64,
    /// True if tails and the distribution of the cost are computed, too.
    pub with_distributions: bool,
}

impl SlabWalk {
    /// Walk that collides by the analog rule, through σ̂ ≥ σ_t.
    pub fn analog(
        incidence: Incidence,
        albedo: f64,
        pieces: Pieces,
        depth: f64,
        with_distributions: bool,
    ) -> Self {
        let rule = ParticleRule::Analog;
        Self { incidence, albedo, rule, pieces, largest_ratio: 1.0, depth, with_distributions }
    }

    /// Distribution of the lookups of a draw by one of several walks, given the probability of each.
    pub fn mixed_lookups(walks: impl Iterator<Item = (f64, Self)>) -> Option<CountDistribution> {
        let of =
            |(weight, walk): (f64, Self)| Some((weight, walk.lookups(&[walk.incidence.light])?[0]));
        let each = walks.map(of).collect::<Option<Vec<_>>>()?;
        colours::mixed(each).map(CountDistribution::of_factorial)
    }

    /// Prediction, given the exact answer.
    pub fn predict(&self, truth: &EnergyBounds) -> Prediction {
        let lights = [self.incidence.light];
        self.predict_all(&lights, std::slice::from_ref(truth)).swap_remove(0)
    }

    /// Predictions for several lights, with common computations.
    pub fn predict_all(
        &self,
        lights: &[IncidentLight],
        truths: &[EnergyBounds],
    ) -> Vec<Prediction> {
        let raw = POWERS.map(|k| self.moments(k, lights, truths));
        let lookups = self.lookups(lights);
        let of = |(i, truth): (usize, &EnergyBounds)| {
            let distribution =
                lookups.as_ref().map(|lookups| CountDistribution::of_factorial(lookups[i]));
            let of_side = |side: usize| RawMoments(raw.each_ref().map(|all| all[i][side]));
            self.predicted(truth, [0, 1].map(of_side), distribution)
        };
        truths.iter().enumerate().map(of).collect()
    }

    fn probabilities(&self, ratio: f64) -> EventProbabilities {
        self.rule.probabilities(ratio, self.albedo)
    }

    /// The layers; where r varies, those of the finer cut.
    fn finest(&self) -> &[Piece] {
        match &self.pieces {
            Pieces::Exact(pieces) | Pieces::Graded([_, pieces]) => pieces,
        }
    }

    /// All ratios of the layers.
    fn ratios(&self) -> impl Iterator<Item = f64> {
        self.finest().iter().flat_map(|piece| piece.ratios.iter().map(|&[_, ratio]| ratio))
    }

    /// Factor of the weight at every scattering, if null collisions keep the weight; `None` where they change it, or
    /// where the factor depends on r. An event that does not happen has no factor.
    fn scattering_factor(&self) -> Option<f64> {
        if self.largest_ratio > 1.0 + ROUNDING {
            return None;
        }
        let is_near = |x: f64, y: f64| (x - y).abs() <= ROUNDING;
        let mut factor = None;
        for ratio in self.ratios() {
            let event = self.probabilities(ratio);
            if event.transmit > ROUNDING && !is_near(event.transmit_weight, 1.0) {
                return None;
            }
            if event.scatter > 0.0
                && !is_near(*factor.get_or_insert(event.scatter_weight), event.scatter_weight)
            {
                return None;
            }
        }
        Some(factor.unwrap_or(1.0))
    }

    /// Returns whether null collisions keep the weight, and scatterings multiply it by one factor.
    fn is_tracking(&self) -> bool {
        self.scattering_factor().is_some()
    }

    /// Returns whether draws are 0 or 1, since every collision keeps the weight or ends the walk.
    fn is_bernoulli(&self) -> bool {
        self.scattering_factor().is_some_and(|factor| (factor - 1.0).abs() <= ROUNDING)
    }

    /// Existence of the second moments: where they are infinite, no number of draws converges.
    pub fn second_moment(&self) -> Existence {
        // A weight that never grows stays at 1 at most.
        let grows = |ratio: f64| {
            let probabilities = self.probabilities(ratio);
            probabilities.transmit_weight.abs() > 1.0 || probabilities.scatter_weight.abs() > 1.0
        };
        if !self.ratios().any(grows) || self.powers(2, &[self.incidence.light]).is_some() {
            return Existence::Finite;
        }
        let moments = self.of_collisions(2);
        let is_endless = |[_, ratio]: &[f64; 2]| moments(*ratio).is_endless();
        let (pieces, resolution) = match &self.pieces {
            Pieces::Exact(pieces) => (pieces, Resolution::COARSE),
            Pieces::Graded([_, pieces]) => (pieces, Resolution::LAYERED),
        };
        if pieces.iter().flat_map(|piece| &piece.ratios).any(is_endless) {
            return Existence::Diverges;
        }
        let thinner = |piece: &Piece| {
            let layer = piece.kernel(&moments);
            Kernel { rate: layer.rate * (1.0 - NEAR), ..layer }
        };
        let thinner: Vec<Kernel> = pieces.iter().map(thinner).collect();
        let lights = [self.incidence.light];
        match energies(&self.incidence.phase, &lights, &thinner, resolution) {
            // With the peak cut off, light along a layer may grow that the whole phase function turns away.
            None if !resolution.cuts(&self.incidence.phase) => Existence::Diverges,
            _ => Existence::Unknown,
        }
    }

    /// Kernel of the k-th moment by r, for a rate of 1.
    fn of_collisions(&self, k: i32) -> impl Fn(f64) -> Kernel + '_ {
        move |ratio| self.probabilities(ratio).kernel(1.0, [1.0 - ratio, self.albedo * ratio], k)
    }

    /// `E[X_R^k]` and `E[X_T^k]` in each light; `None` where they are infinite.
    fn powers(&self, k: i32, lights: &[IncidentLight]) -> Option<Vec<[Known; 2]>> {
        let phase = &self.incidence.phase;
        let moments = self.of_collisions(k);
        let layers = |pieces: &[Piece]| -> Vec<Kernel> {
            pieces.iter().map(|piece| piece.kernel(&moments)).collect()
        };
        let exact = |slices: &[Kernel]| {
            let answers = solve(phase, lights, slices, Resolution::COARSE)?;
            Some(answers.iter().map(|answer| [answer.reflected, answer.transmitted]).collect())
        };
        if self.is_tracking() {
            return exact(&[Piece::of(self.depth, 1.0).kernel(&moments)]);
        }
        match &self.pieces {
            Pieces::Exact(pieces) => exact(&layers(pieces)),
            Pieces::Graded(cuts) => {
                // A mean over a layer would hide an endless growth of the moment along it.
                let grows = |[_, ratio]: &[f64; 2]| moments(*ratio).is_endless();
                if cuts[1].iter().flat_map(|piece| &piece.ratios).any(grows) {
                    return None;
                }
                let [coarse, fine] = cuts.each_ref().map(|cut| layers(cut));
                let coarse = solve(phase, lights, &coarse, Resolution::LAYERED)?;
                let fine = energies(phase, lights, &fine, Resolution::LAYERED)?;
                let pairs = coarse.into_iter().zip(fine);
                let both = |(coarse, fine): (EnergyBounds, Energy)| {
                    [
                        extrapolated(coarse.reflected, fine.reflected),
                        extrapolated(coarse.transmitted, fine.transmitted),
                    ]
                };
                Some(pairs.map(both).collect())
            }
        }
    }

    /// Returns whether the eighth moments are computed.
    fn has_tails(&self) -> bool {
        self.with_distributions && (matches!(self.pieces, Pieces::Exact(_)) || self.is_tracking())
    }

    /// `E[X_R^k]` and `E[X_T^k]` in each light; infinite where they diverge, or are not needed.
    fn moments(
        &self,
        k: i32,
        lights: &[IncidentLight],
        truths: &[EnergyBounds],
    ) -> Vec<[Known; 2]> {
        let infinite = || vec![[Known::INFINITE; 2]; lights.len()];
        if k > 4 && !self.has_tails() {
            return infinite();
        }
        if k == 1 || self.is_bernoulli() {
            return truths.iter().map(|truth| [truth.reflected, truth.transmitted]).collect();
        }
        let result = self.powers(k, lights).unwrap_or_else(infinite);
        if !self.is_share() {
            return result;
        }
        let both = |(result, truth): ([Known; 2], &EnergyBounds)| {
            let [reflected, transmitted] = result;
            [of_share(reflected, truth.reflected, k), of_share(transmitted, truth.transmitted, k)]
        };
        result.into_iter().zip(truths).map(both).collect()
    }

    /// Returns whether draws lie in [0, 1], as all weights do.
    fn is_share(&self) -> bool {
        let is_share = |ratio| {
            let probabilities = self.probabilities(ratio);
            [probabilities.transmit_weight, probabilities.scatter_weight]
                .iter()
                .all(|w| (0.0..=1.0).contains(w))
        };
        self.ratios().all(is_share)
    }

    /// Prediction from the raw moments of both channels.
    fn predicted(
        &self,
        truth: &EnergyBounds,
        raw: [RawMoments; 2],
        lookups: Option<CountDistribution>,
    ) -> Prediction {
        let truths = [truth.reflected, truth.transmitted];
        let channels = [0, 1].map(|i| {
            let channel = raw[i].channel(truths[i], UNRESOLVED);
            let rare_event_size = match channel.moments {
                Some(moments) if self.has_tails() => moments.kurtosis().unwrap_or(1.0),
                _ => f64::INFINITY,
            };
            let tails = Tails { rare_event_size, ..channel.tails };
            Channel { name: CHANNELS[i].to_owned(), tails, ..channel }
        });
        let moments = [0, 1].map(|i| [truths[i].value, raw[i].second().value]);
        let mut covariances = colours::exclusive(&moments);
        covariances.retain(|covariance: &Covariance| covariance.variance.is_finite());
        Prediction { channels: channels.into(), lookups, covariances, ..Prediction::default() }
    }

    /// Factorial moments of the number of collisions in each light, see [`factorial_moments`], the first only without
    /// `with_distributions`; `None` where they are not known. Where r varies they are known with few directions only.
    pub fn lookups(&self, lights: &[IncidentLight]) -> Option<Vec<[Known; 4]>> {
        let is_quick = match self.pieces {
            Pieces::Exact(_) => true,
            Pieces::Graded(_) => Resolution::LAYERED.count(&self.incidence.phase) <= MAX_DIRECTIONS,
        };
        if !is_quick {
            return None;
        }
        if self.with_distributions {
            self.counts::<Jet<4>>(lights)
        } else {
            self.counts::<f64>(lights)
        }
    }

    /// Factorial moments as the terms of series, as many as a scalar has.
    fn counts<S: Scalar>(&self, lights: &[IncidentLight]) -> Option<Vec<[Known; 4]>> {
        let phase = &self.incidence.phase;
        match &self.pieces {
            Pieces::Exact(pieces) => {
                factorial_moments(phase, lights, &self.marked::<S>(pieces)?, Resolution::COARSE)
            }
            Pieces::Graded(cuts) => {
                let [coarse, fine] = cuts.each_ref().map(|cut| self.marked::<S>(cut));
                let coarse = factorial_moments(phase, lights, &coarse?, Resolution::LAYERED)?;
                let fine = counts(phase, lights, &fine?, Resolution::LAYERED)?;
                let each = |(coarse, fine): ([Known; 4], [Known; 4])| {
                    std::array::from_fn(|k| {
                        let is_known = k < S::TERMS;
                        if is_known {
                            extrapolated(coarse[k], fine[k].value)
                        } else {
                            Known::INFINITE
                        }
                    })
                };
                Some(coarse.into_iter().zip(fine).map(each).collect())
            }
        }
    }

    /// Layers with a mark and a score of 1 at every collision; `None` where the distribution of their number is not known.
    fn marked<S: Scalar>(&self, pieces: &[Piece]) -> Option<Vec<Kernel<S>>> {
        // A layer of null collisions only has infinitely many of them along it.
        let probabilities = |ratio: f64| self.probabilities(ratio);
        let is_idle = pieces.is_empty() || pieces.iter().any(|piece| piece.is_idle(probabilities));
        let marked = |piece: &Piece| {
            let counts = self.of_collisions(0);
            piece.kernel(|ratio| Kernel { score: 1.0, ..counts(ratio) }).marked()
        };
        (!is_idle).then(|| pieces.iter().map(marked).collect())
    }
}

/// `E[X^k]` of a draw in [0, 1] with mean T, clamped to its bounds: `Tᵏ ≤ E[X^k] ≤ T`, by Jensen's inequality and
/// by `x^k ≤ x`. A value beyond them is an error of theory.
fn of_share(result: Known, truth: Known, k: i32) -> Known {
    let (minimum, maximum) =
        ((truth.value - truth.error).max(0.0).powi(k), truth.value + truth.error);
    if (minimum..=maximum).contains(&result.value) && result.error <= maximum {
        return result;
    }
    let value = result.value.max(minimum).min(maximum);
    Known { value, error: result.error.min((value - minimum).max(maximum - value)), ..result }
}

/// Extrapolation from two cuts: the error of the finer one is a quarter of the other's, and the error of the
/// directions is equal in both.
fn extrapolated(coarse: Known, fine: f64) -> Known {
    let step = fine - coarse.value;
    Known::estimated(fine + step / 3.0, step.abs() + coarse.error + 1e-4 * fine.abs())
}
