//! A walk in a slab: mean, variance and cost of what it says of reflectance and transmittance.
//!
//! With `Q_k`, `S_k` the k-th moments of what a tentative collision leaves, `E[X^k]` is reflectance or
//! transmittance of the slab that is `∫σ̂(1 − Q_k)` thick and has the albedo `S_k/(1 − Q_k)`, layer by
//! layer where `r = σ_t/σ̂` changes from layer to layer. Of rules that leave no weight at a null
//! collision, `r ≤ 1`, these are τ and `S_k` at r = 1, whatever σ_t and σ̂: analog and weighted walks
//! are predicted in every medium. Elsewhere, where r varies continuously, only the mean is known.
//!
//! A walk leaves on one side only: `X_R X_T = 0`, which makes the covariance.
//!
//! ```text
//! Cov[X_R, X_T] = −RT,   E[(X_R − R)²(X_T − T)²] = E[X_R²]T² + E[X_T²]R² − 3R²T²
//! ```
//!
//! The number M of collisions has the generating function `G(z) = E[z^M]`, which is what a slab with
//! `zQ_0`, `zS_0` and the score `z(1 − Q_0 − S_0)` makes of one particle. Its cumulants are derivatives
//! of `ln G(e^θ)`, taken from θ = 0, ±h, ±2h:
//!
//! ```text
//! Var[M] = (16(f(h) + f(−h)) − f(2h) − f(−2h) − 30 f(0))/(12h²),   f(θ) = ln G(e^θ)
//! ```
//!
//! Source: Szirmay-Kalos et al. 2017, sections 3.1–3.3; that moments are slabs again, the covariance and
//! the cost are derived here.

use super::layer::Slice;
use super::{Answer, Incidence, Resolution, energy, solve};
use crate::numeric::Known;
use crate::theory::particle::{Odds, ParticleRule};
use crate::theory::prediction::Covariance;
use crate::theory::{Channel, CountLaw, Moments, Prediction, Tails};

/// The channels of a draw, in their order.
pub const CHANNELS: [&str; 2] = ["reflectance", "transmittance"];

/// A stretch of the slab on which r is one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// `∫σ̂` over the stretch.
    pub flown: f64,
    /// r.
    pub ratio: f64,
}

/// A walk in a slab.
#[derive(Debug, Clone)]
pub struct Walk {
    /// Light and phase function.
    pub incidence: Incidence,
    /// a.
    pub albedo: f64,
    /// What happens at a collision.
    pub rule: ParticleRule,
    /// The stretches from the top on; none where r varies continuously.
    pub pieces: Vec<Piece>,
    /// The largest r.
    pub largest_ratio: f64,
    /// τ of the slab.
    pub depth: f64,
    /// Whether tails and the law of the cost are asked for, too.
    pub laws: bool,
}

impl Walk {
    /// What theory says, given the exact answer.
    #[must_use]
    pub fn predict(&self, truth: &Answer) -> Prediction {
        let truths = [truth.reflected, truth.transmitted];
        let raw = [2, 3, 4, 8].map(|k| self.moments(k, truth));
        let channels: Vec<Channel> = (0..2)
            .map(|i| channel(CHANNELS[i], truths[i], raw.map(|both| both.map(|both| both[i]))))
            .collect();
        let [r, t] = truths.map(|known| known.value);
        let covariances = raw[0].map(|[second_r, second_t]| {
            let both = second_r.value * t * t + second_t.value * r * r - 3.0 * r * r * t * t;
            Covariance { pair: [0, 1], value: -r * t, variance: both - (r * t).powi(2) }
        });
        Prediction {
            channels,
            lookups: self.lookups(),
            layers: None,
            random_numbers: None,
            law: None,
            covariances: covariances.into_iter().filter(|c| c.variance.is_finite()).collect(),
            increments: Vec::new(),
            stable_share: None,
        }
    }

    /// The slab whose reflectance and transmittance are the k-th moments.
    fn slices(&self, k: i32) -> Option<Vec<Slice>> {
        let slice = |flown: f64, odds: &Odds| Slice {
            flown,
            straight: odds.transmitted(k),
            scattered: odds.scattered(k),
            score: 0.0,
        };
        if self.is_tracking() {
            return Some(vec![slice(self.depth, &self.rule.odds(1.0, self.albedo))]);
        }
        let pieces = self.pieces.iter();
        let slices: Vec<Slice> =
            pieces.map(|p| slice(p.flown, &self.rule.odds(p.ratio, self.albedo))).collect();
        (!slices.is_empty()).then_some(slices)
    }

    /// Whether null collisions leave the weight alone.
    fn is_tracking(&self) -> bool {
        use ParticleRule::{Analog, Terminating, Weighted};
        matches!(self.rule, Analog | Terminating | Weighted) && self.largest_ratio <= 1.0
    }

    /// `E[X_R^k]` and `E[X_T^k]`; infinite where they are, `None` where they are not known.
    fn moments(&self, k: i32, truth: &Answer) -> Option<[Known; 2]> {
        if k > 4 && !self.laws {
            return None;
        }
        let slices = self.slices(k)?;
        if let [slice] = slices[..]
            && slice
                == (Slice { flown: self.depth, straight: 0.0, scattered: self.albedo, score: 0.0 })
        {
            // Draws are 0 or 1.
            return Some([truth.reflected, truth.transmitted]);
        }
        let infinite = Known::new(f64::INFINITY, f64::INFINITY);
        let answer = solve(&self.incidence, &slices, Resolution::COARSE);
        Some(answer.map_or([infinite; 2], |answer| [answer.reflected, answer.transmitted]))
    }

    /// The law of the number of collisions without its probabilities; `None` where it is not known, or
    /// has an infinite variance.
    fn lookups(&self) -> Option<CountLaw> {
        let collisions = self.pieces.iter().map(|piece| {
            let odds = self.rule.odds(piece.ratio, self.albedo);
            (piece.flown, odds)
        });
        let collisions: Vec<(f64, Odds)> = collisions.collect();
        // Along a layer of null collisions only there is no end to them.
        let endless = |(flown, odds): &(f64, Odds)| *flown > 0.0 && odds.transmit >= 1.0;
        if collisions.is_empty() || collisions.iter().any(endless) {
            return None;
        }
        let slices = |z: f64, score: fn(&Odds) -> f64| -> Vec<Slice> {
            let slice = |&(flown, odds): &(f64, Odds)| Slice {
                flown,
                straight: z * odds.transmit,
                scattered: z * odds.scatter,
                score: z * score(&odds),
            };
            collisions.iter().map(slice).collect()
        };
        let fine = if self.laws { Resolution::FINE } else { Resolution::COARSE };
        let mean = energy(&self.incidence, &slices(1.0, |_| 1.0), fine)?.score;
        let ends = |odds: &Odds| 1.0 - odds.transmit - odds.scatter;
        let f = |theta: f64| -> Option<f64> {
            let slices = slices(theta.exp(), ends);
            let found = energy(&self.incidence, &slices, Resolution::COARSE)?;
            Some((found.reflected + found.transmitted + found.score).ln())
        };
        let [variance, fourth] = if self.laws { cumulants(mean, f)? } else { [mean, 0.0] };
        let kurtosis = 3.0 + fourth / (variance * variance);
        Some(CountLaw { mean, variance, kurtosis, poisson: false, pmf: Vec::new() })
    }
}

/// The step of θ in units of the number of collisions over which the law decays.
const STEP: f64 = 0.02;

/// The second and the fourth cumulant from the cumulant-generating function; `None` where that is
/// infinite too near to 0.
fn cumulants(mean: f64, f: impl Fn(f64) -> Option<f64>) -> Option<[f64; 2]> {
    let at = |h: f64| -> Option<[f64; 2]> {
        let [far, near, here, before, back] = [2.0 * h, h, 0.0, -h, -2.0 * h].map(&f);
        let (outer, inner, here) = (far? + back?, near? + before?, here?);
        let second = (16.0 * inner - outer - 30.0 * here) / (12.0 * h * h);
        Some([second, (outer - 4.0 * inner + 6.0 * here) / (h * h * h * h)])
    };
    let mut scale = 1.0 + mean;
    let mut found = at(STEP / scale);
    for _ in 0..4 {
        // The decay of a long tail is variance over mean.
        let wanted = found.map_or(8.0 * scale, |[variance, _]| 1.0 + variance / mean);
        if found.is_some() && wanted <= 2.0 * scale {
            break;
        }
        scale = wanted;
        found = at(STEP / scale);
    }
    found.filter(|[variance, fourth]| *variance > 0.0 && fourth.is_finite())
}

/// A channel with its central moments from `E[X²]`, `E[X³]`, `E[X⁴]` and `E[X⁸]`.
fn channel(name: &str, truth: Known, raw: [Option<Known>; 4]) -> Channel {
    let t = truth.value;
    let unit = |k: i32, known: Known| Known::new(known.value / t.powi(k), known.error / t.powi(k));
    let [second, third, fourth, eighth] = raw;
    let moments = second.zip(third).zip(fourth).map(|((second, third), fourth)| {
        let (second, third, fourth) = (unit(2, second), unit(3, third), unit(4, fourth));
        let blur = truth.error / t;
        let [a, b, c] = [second, third, fourth].map(|known| known.value);
        let variance = (a - 1.0).max(0.0);
        if c.is_infinite() || b.is_infinite() {
            let error = (second.error + 2.0 * blur * a) / variance;
            let error = if error.is_nan() { 0.0 } else { error };
            let higher = f64::INFINITY;
            return Moments { scale: t, relative: [variance, higher, higher], error };
        }
        let skew = b - 3.0 * a + 2.0;
        let peak = (c - 4.0 * b + 6.0 * a - 3.0).max(variance * variance);
        let rounding = 8.0 * f64::EPSILON * (c + 4.0 * b.abs() + 6.0 * a + 3.0);
        let errors = [
            (second.error + 2.0 * blur * a + rounding) / variance,
            (fourth.error + 4.0 * third.error + 6.0 * second.error + 4.0 * blur * c + rounding)
                / peak,
        ];
        let error = errors[0].max(errors[1]);
        Moments { scale: t, relative: [variance, skew, peak], error }
    });
    let tails = match (moments, fourth, eighth) {
        (Some(moments), Some(fourth), Some(eighth)) => Tails {
            rare_event_size: moments.kurtosis().unwrap_or(1.0),
            eighth_moment_ratio: eighth.value / (fourth.value * fourth.value),
        },
        _ => Tails { rare_event_size: f64::INFINITY, eighth_moment_ratio: f64::INFINITY },
    };
    let tails = Tails {
        eighth_moment_ratio: if tails.eighth_moment_ratio.is_nan() {
            f64::INFINITY
        } else {
            tails.eighth_moment_ratio
        },
        ..tails
    };
    Channel {
        name: name.to_owned(),
        truth,
        mean: truth,
        moments,
        tails,
        unit: t,
        log_unit: 0.0,
        losses: None,
    }
}
