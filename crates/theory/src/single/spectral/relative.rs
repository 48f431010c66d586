//! All moments of single scattering in several channels, where draws are relative to the density of one walker.
//!
//! ```text
//! E[Π X_λ^{k_λ}] = Σ_h w_h ∫ S(s) exp(−A s + ∫₀ˢ N) Π (p_λ(cos θ) Φ/(4π r²))^{k_λ} E[Π T̂_λ^{k_λ}] ds
//! exact shadow rays    E[Π T̂_λ^{k_λ}] = Π T_λ^{k_λ}
//! tracked ones, ℓ long                  exp(−A ℓ + ∫ Π n_λ^{k_λ}/μ̄_h^{K−1})
//! ```
//!
//! with A, N and S of [`Rates`]: every walker is scattered once, and the powers of weights are Poisson products up
//! to there. The walk's collisions are Poisson, too: before a scattering of spectral tracking `∫μ̄ P_n` of them are
//! null.
//!
//! Source: derived by Campbell's theorem from B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral
//! Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019), section 5, and P. Kutz, R. Habel, Y. K. Li,
//! J. Novák, *Spectral and Decomposition Tracking for Rendering Heterogeneous Volumes*, ACM Transactions on Graphics 36
//! (2017), section 5.

use std::sync::Arc;

use super::joined;
use crate::colours::rates::{Proposal, Rates};
use crate::colours::{Chance, named};
use crate::prediction::Covariance;
use crate::prediction::raw::{Raw, RawMoments, added, poisson};
use crate::problems::SingleScattering;
use crate::single::predict::{LOOKUPS, MOMENT};
use crate::single::scene::StretchedPlace;
use crate::single::segment::along_all;
use crate::single::{Camera, CameraTracking, RayScene, TechniqueMoments, Tracking};
use crate::{Mesh, Prediction};
use media::{Control, Medium, Piecewise};
use numeric::quadrature::GaussLegendre;
use numeric::{Cumulative, Span};

/// Number of rows: the moments of eight channels, `4·8 + 4·7`, and those of lookups.
const ROWS: usize = 64;
/// First row of the moments of lookups.
const COUNTS: usize = 60;
/// Roundings of an exponent, in units of ε times the sum of its terms' absolute values.
const ROUNDINGS: f64 = 16.0;

/// Walkers through the media of all channels.
pub struct Relative<'a> {
    channels: &'a [Arc<SingleScattering>],
    meshes: Vec<&'a Mesh>,
    sampling: &'a Piecewise,
    rates: Rates,
    /// Walkers with their probabilities.
    walks: Vec<(f64, Proposal)>,
    /// True if shadow rays are tracked.
    tracks: bool,
    /// The exponents of all moments; the last are 0.
    powers: Vec<Vec<i32>>,
    rule: GaussLegendre,
    /// Distances at which integrands along the ray are not smooth.
    cuts: Vec<f64>,
    /// `∫ N`, power by power and walk by walk.
    gains: Cumulative,
}

impl<'a> Relative<'a> {
    /// Integrates along the ray.
    pub fn new(
        channels: &'a [Arc<SingleScattering>],
        media: Vec<(&'a Mesh, f64)>,
        sampling: &'a Piecewise,
        walks: Vec<(f64, Proposal)>,
        tracks: bool,
    ) -> Self {
        let (meshes, majorants): (Vec<&Mesh>, Vec<f64>) = media.into_iter().unzip();
        let albedos = channels.iter().map(|channel| channel.albedo()).collect();
        let mut relative = Self {
            channels,
            meshes,
            sampling,
            rates: Rates { majorants, albedos },
            walks,
            tracks,
            powers: powers(channels.len()),
            rule: GaussLegendre::new(16),
            cuts: Vec::new(),
            gains: Cumulative::new(0.0, 0),
        };
        let first = relative.meshes[0];
        relative.cuts = relative.kinks();
        let width = relative.powers.len() * relative.walks.len();
        let fine = first.refined(&relative.cuts, &|_, panel| {
            let rows = relative.gains_at(panel.t);
            (0..width).map(|i| rows.iter().map(|row| row[i]).collect()).collect()
        });
        let (from, panels) = (first.support().from, fine.panels().map(|panel| panel.span));
        relative.gains =
            Cumulative::over(from, width, panels, |span, row| relative.add_gains(span, row));
        relative
    }

    /// Distances at which fields have kinks and, for the probabilities `maximum`, at which another channel's event
    /// becomes the likeliest.
    fn kinks(&self) -> Vec<f64> {
        if self.walks.iter().all(|&(_, walk)| walk != Proposal::Together(Chance::Maximum)) {
            return Mesh::joint_cuts(&self.meshes, Vec::new(), &|_, _| []);
        }
        Mesh::joint_cuts(&self.meshes, Vec::new(), &|channel, t| {
            let (sigma, a) =
                (self.meshes[channel].medium().extinction(t), self.rates.albedos[channel]);
            [sigma, a * sigma, (1.0 - a) * sigma]
        })
    }

    /// σ_t of all channels at each distance.
    fn extinctions(&self, t: &[f64]) -> Vec<Vec<f64>> {
        let each: Vec<Vec<f64>> =
            self.meshes.iter().map(|mesh| mesh.medium().extinctions(t)).collect();
        (0..t.len()).map(|i| each.iter().map(|own| own[i]).collect()).collect()
    }

    /// N at each distance, power by power and walk by walk.
    fn gains_at(&self, t: &[f64]) -> Vec<Vec<f64>> {
        let of_walk = |here: &Vec<f64>, walk: Proposal| -> Vec<f64> {
            self.powers.iter().map(|k| self.rates.gains(walk, k, here)[0]).collect()
        };
        let row = |here: &Vec<f64>| self.walks.iter().flat_map(|w| of_walk(here, w.1)).collect();
        self.extinctions(t).iter().map(row).collect()
    }

    /// Adds `∫ N` over a span.
    fn add_gains(&self, span: Span, row: &mut [f64]) {
        let gains = self.gains_at(&self.rule.nodes_on(span));
        for ((_, weight), gains) in self.rule.on(span).zip(gains) {
            row.iter_mut().zip(gains).for_each(|(sum, x)| *sum += weight * x);
        }
    }

    /// `∫ N` from the beginning.
    fn up_to(&self, s: f64) -> Vec<f64> {
        let mut row = vec![0.0; self.powers.len() * self.walks.len()];
        self.gains.up_to(s, &mut row, |_, rest, row| self.add_gains(rest, row));
        row
    }

    /// `ln E[Π T̂_λ^{k_λ}]` of the shadow ray, power by power, for a walk, given the medium of each channel there.
    fn shadow(&self, walk: Proposal, media: &[Medium]) -> Vec<f64> {
        if !self.tracks {
            let depths: Vec<f64> =
                media.iter().map(|m| m.optical_depth(m.support()).value).collect();
            let lost =
                |k: &Vec<i32>| k.iter().zip(&depths).map(|(&k, tau)| -f64::from(k) * tau).sum();
            return self.powers.iter().map(lost).collect();
        }
        let length = media[0].support().length();
        let (gained, _) = along_all::<ROWS>(media, &self.rule, &|_, sigma| {
            let mut row = [0.0; ROWS];
            for (gain, k) in row.iter_mut().zip(&self.powers) {
                *gain = self.rates.gain_of_ratio(walk, k, sigma);
            }
            row
        });
        let powers = self.powers.iter().zip(gained);
        powers.map(|(k, gained)| gained - self.rates.loss(walk, k) * length).collect()
    }

    /// Contributions of a point of the ray to each moment and, where all channels walk together, to those of
    /// lookups.
    fn row(&self, StretchedPlace { s, along, .. }: StretchedPlace) -> [f64; ROWS] {
        let from = self.meshes[0].support().from;
        let here = &self.extinctions(&[s])[0];
        let up_to = self.up_to(s);
        let worth: Vec<f64> = self
            .channels
            .iter()
            .map(|channel| channel.source_beyond(along)[0] / channel.albedo())
            .collect();
        let cast: Option<Vec<Medium>> =
            self.channels.iter().map(|channel| channel.shadow_medium(s)).collect();
        let mut row = [0.0; ROWS];
        let (none, last) = (vec![0.0; self.powers.len()], self.powers.len() - 1);
        for (number, &(weight, walk)) in self.walks.iter().enumerate() {
            let shadow = cast.as_ref().map_or_else(|| none.clone(), |cast| self.shadow(walk, cast));
            let passed = &up_to[number * self.powers.len()..][..self.powers.len()];
            for (j, k) in self.powers[..last].iter().enumerate() {
                let [_, scattered] = self.rates.gains(walk, k, here);
                let lost = self.rates.loss(walk, k) * (s - from);
                let gained: f64 = worth.iter().zip(k).map(|(x, &k)| x.powi(k)).product();
                row[j] += weight * scattered * gained * (passed[j] - lost + shadow[j]).exp();
            }
            let Proposal::Together(_) = walk else { continue };
            let [null, scattered] = self.rates.gains(walk, &self.powers[last], here);
            let rate = self.rates.loss(walk, &self.powers[last]);
            let alive = (passed[last] - rate * (s - from)).exp();
            let walked = added([1.0; 5], poisson(passed[last]));
            let length = cast.as_ref().map_or(0.0, |cast| cast[0].support().length());
            let lit = if self.tracks { added(walked, poisson(rate * length)) } else { walked };
            for k in 1..5 {
                let ends = rate - null - scattered;
                row[COUNTS + k - 1] += alive * (scattered * lit[k] + ends * walked[k]);
            }
        }
        row
    }

    /// Prediction for the draws. `alone` has the means of the channels by themselves, `of_heroes` the lookups where
    /// heroes walk.
    pub fn predict(&self, alone: &[TechniqueMoments], of_heroes: Option<Raw>) -> Prediction {
        let none = Control::None;
        let camera = Camera::new(self.meshes[0], self.sampling, &none, CameraTracking::Exact);
        let scene = RayScene::new(&self.channels[0], camera, Tracking::Exact);
        let mut parts = [f64::INFINITY; ROWS];
        let last = self.powers.len() - 1;
        parts[..last].fill(MOMENT);
        parts[COUNTS..].fill(LOOKUPS);
        let result = scene.over(parts, self.cuts.clone(), &|place| self.row(place));
        let relative = |j: usize| result.error[j] / result.value[j].abs();
        let length = self.meshes[0].support().length();
        let largest = self.rates.majorants.iter().fold(0.0f64, |maximum, &own| maximum.max(own));
        let rounding = f64::EPSILON * (1.0 + ROUNDINGS * largest * length);
        let counted = [1, 2, 3, 4].map(|k| result.value[COUNTS + k - 1]);
        let lookups = of_heroes.or_else(|| self.escaped(counted));
        let channel = |(number, own): (usize, &TechniqueMoments)| {
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| result.value[4 * number + k]);
            // The mean is computed twice.
            let apart = (a / own.truth.value - 1.0).abs();
            let error = |k: usize| (rounding + apart).max(relative(4 * number + k));
            let errors = [error(0), error(1), error(2), error(3), f64::NAN];
            let raw = RawMoments::estimated([a, b, c, d, f64::NAN], errors);
            let counted = own.counted.max(rounding);
            TechniqueMoments { raw, lookups, counted, ..*own }
        };
        let points: Vec<TechniqueMoments> = alone.iter().enumerate().map(channel).collect();
        let covariance = |next: usize| {
            let of = |power: usize| [next - 1, next].map(|i| points[i].raw.0[power].value);
            let first = 4 * (alone.len() + next - 1);
            let mixed = [0, 1, 2, 3].map(|j| result.value[first + j]);
            Covariance::of_raw([next - 1, next], of(0), of(1), mixed)
        };
        let covariances = (1..alone.len()).map(covariance).collect();
        let (channels, lookups) = joined(points.iter().map(TechniqueMoments::prediction));
        Prediction { channels: named(channels), lookups, covariances, ..Prediction::default() }
    }

    /// The moments of lookups with those of walks that leave the ray.
    fn escaped(&self, result: [f64; 4]) -> Option<[f64; 5]> {
        let &[(_, walk @ Proposal::Together(_))] = self.walks.as_slice() else { return None };
        let last = self.powers.len() - 1;
        let passed = self.up_to(self.meshes[0].support().to)[last];
        let rate = self.rates.loss(walk, &self.powers[last]);
        let alive = (passed - rate * self.meshes[0].support().length()).exp();
        let left = poisson(passed);
        let [a, b, c, d] = [1, 2, 3, 4].map(|k| result[k - 1] + alive * left[k]);
        Some([1.0, a, b, c, d])
    }
}

/// The exponents of `count` channels: powers 1 to 4 of each, products of adjacent channels, and zeros.
fn powers(count: usize) -> Vec<Vec<i32>> {
    let of = |given: &[(usize, i32)]| {
        let mut k = vec![0; count];
        for &(channel, power) in given {
            k[channel] = power;
        }
        k
    };
    let mut all: Vec<Vec<i32>> = (0..count)
        .flat_map(|channel| (1..5).map(move |k| (channel, k)))
        .map(|one| of(&[one]))
        .collect();
    for next in 1..count {
        let pair = |[i, j]: [i32; 2]| of(&[(next - 1, i), (next, j)]);
        all.extend([[1, 1], [2, 1], [1, 2], [2, 2]].map(pair));
    }
    all.push(of(&[]));
    all
}
