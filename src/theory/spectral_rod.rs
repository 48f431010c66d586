//! Rods of coloured scatterers: moments of walks whose weights depend on the number of scatterings alone.
//!
//! With `R(a)` and `T(a)` of a rod of one albedo a, continued to a > 1, an optical length τ, and `K = Σ k_λ`:
//!
//! ```text
//! E[Π X_λ^{k_λ}; transmitted]
//! independent        w_h^{1−K} T(a_h), all of k on the channel h, else 0
//! spectral tracking  T(Π a_λ^{k_λ} / P_s^{K−1}),  P_s the chance to be scattered
//! spectral MIS       Σ_r T_r D_r Π (a_λ^r/D_r)^{k_λ},  D_r = Σ_h w_h a_h^r
//!
//! α = 1 − a p_f,  β = a(1 − p_f),  κ² = α² − β²
//! T = 1/(cosh κτ + (α/κ) sinh κτ),  R = (β/κ) sinh κτ · T
//! ```
//!
//! and likewise for R. For a > 1 there is a critical length from which on the moment is infinite: the first τ at
//! which the denominator of T is 0. `T_r`, the probability to leave after r scatterings that never absorb, are the
//! coefficients of T(a), found on the circle |a| = 1.
//!
//! Source: derived from the two-stream equations of R. Bellman, R. Kalaba, G. M. Wing, *Invariant Imbedding and
//! Mathematical Physics*, Journal of Mathematical Physics 1 (1960): each scattering multiplies the k-th moment of
//! a weight by one number.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::particle::ParticleRule;
use super::prediction::Covariance;
use super::{Channel, CountLaw, Mesh, Moments, Prediction, Tails, rod};
use crate::media::Piecewise;
use crate::numeric::Known;
use crate::problems::rod::channels;
use crate::problems::spectral_rod::{End, SpectralRod};
use crate::problems::{Problem, Rod};

/// What rounding leaves of a moment, relative to it.
const ROUNDING: f64 = 1e-13;
/// Orders of scattering that are rarer than this do not count.
const RARE: f64 = 1e-17;
/// The most orders of scattering.
const MOST_ORDERS: usize = 8192;

/// How all channels are scored by one walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tracker {
    /// One channel by its own walk, the others 0.
    Independent,
    /// One chance to be scattered for all channels.
    Tracking {
        /// `P_s`.
        scatter: f64,
    },
    /// The walk of a hero, divided by the mean density of all heroes.
    Mis,
}

/// Reflectance and transmittance of a rod; `None` from its critical length on.
pub fn leaving(depth: f64, albedo: f64, forward: f64) -> Option<[f64; 2]> {
    if depth >= critical(albedo, forward) {
        return None;
    }
    Some(continued(depth, Complex64::from(albedo), forward).map(|x| x.re))
}

/// The optical length from which on a rod of an albedo has no finite answer; infinite where there is none.
///
/// ```text
/// ω² = β² − α²:  atan2(ω, −α)/ω;  for κ² = −ω² > 0 and α < −κ:  artanh(−κ/α)/κ
/// ```
pub fn critical(albedo: f64, forward: f64) -> f64 {
    let (alpha, beta) = (1.0 - albedo * forward, albedo * (1.0 - forward));
    let square = beta * beta - alpha * alpha;
    if albedo <= 1.0 {
        f64::INFINITY
    } else if square > 0.0 {
        let omega = square.sqrt();
        omega.atan2(-alpha) / omega
    } else if alpha < 0.0 {
        let kappa = (-square).sqrt();
        if kappa == 0.0 { -1.0 / alpha } else { (-kappa / alpha).atanh() / kappa }
    } else {
        f64::INFINITY
    }
}

/// R and T of a complex albedo.
fn continued(depth: f64, albedo: Complex64, forward: f64) -> [Complex64; 2] {
    let (alpha, beta) = (-albedo * forward + 1.0, albedo * (1.0 - forward));
    // (1 − a)(1 − a(2p_f − 1)), which cancels less than α² − β².
    let one = Complex64::from(1.0);
    let kappa = ((one - albedo) * (one - albedo * (2.0 * forward - 1.0))).sqrt();
    // e^{−κτ}, and sinh κτ e^{−κτ}/κ with its limit τ; Re κ ≥ 0.
    let decay = (-kappa * depth).exp();
    let flat = kappa.norm() * depth < 1e-8;
    let sine = if flat { Complex64::from(depth) } else { (1.0 - decay * decay) * 0.5 / kappa };
    let below = (1.0 + decay * decay) * 0.5 + alpha * sine;
    [beta * sine / below, decay / below]
}

/// A rod with everything that its moments depend on.
pub struct Spectrum<'a> {
    rod: &'a SpectralRod,
    depth: Known,
    hero: Vec<f64>,
    tracker: Tracker,
    /// The probability to leave after r scatterings, reflected and transmitted.
    orders: Option<Vec<[f64; 2]>>,
}

impl<'a> Spectrum<'a> {
    /// Joins the parts; `hero` has one probability for each channel.
    pub fn new(rod: &'a SpectralRod, hero: Vec<f64>, tracker: Tracker) -> Self {
        let depth = rod.medium().optical_depth(rod.medium().support());
        let orders = if tracker == Tracker::Mis { orders(depth.value, rod.forward) } else { None };
        Self { rod, depth, hero, tracker, orders }
    }

    /// The chance that a scattering multiplies the k-th power of a channel's weight by, in spectral tracking.
    fn albedo_of_power(&self, k: &[i32], scatter: f64) -> f64 {
        let total: i32 = k.iter().sum();
        let product: f64 = self.rod.albedos.iter().zip(k).map(|(a, &k)| a.powi(k)).product();
        if product == 0.0 { 0.0 } else { product / scatter.powi(total - 1) }
    }

    /// The channel whose second moment is infinite, and the optical length from which on it is.
    pub fn diverges(&self) -> Option<(usize, f64)> {
        let Tracker::Tracking { scatter } = self.tracker else { return None };
        (0..self.rod.albedos.len()).find_map(|channel| {
            let albedo = self.albedo_of_power(&self.only(channel, 2), scatter);
            let critical = critical(albedo, self.rod.forward);
            (self.depth.value >= critical).then_some((channel, critical))
        })
    }

    fn only(&self, channel: usize, power: i32) -> Vec<i32> {
        let mut k = vec![0; self.rod.albedos.len()];
        k[channel] = power;
        k
    }

    /// `E[Π X_λ^{k_λ}]` of what leaves at an end; infinite where it diverges, `None` where it is not known.
    fn moment(&self, end: End, k: &[i32]) -> Option<f64> {
        let at = |values: [f64; 2]| values[usize::from(end == End::Transmitted)];
        let (tau, forward) = (self.depth.value, self.rod.forward);
        let total: i32 = k.iter().sum();
        match self.tracker {
            Tracker::Independent => {
                let channel = k.iter().position(|&k| k == total);
                Some(channel.map_or(0.0, |channel| {
                    let found = leaving(tau, self.rod.albedos[channel], forward).map_or(0.0, at);
                    self.hero[channel].powi(1 - total) * found
                }))
            }
            Tracker::Tracking { scatter } => {
                let albedo = self.albedo_of_power(k, scatter);
                Some(leaving(tau, albedo, forward).map_or(f64::INFINITY, at))
            }
            Tracker::Mis => {
                let mut powers = vec![1.0; k.len()];
                let mut sum = 0.0;
                for &order in self.orders.as_ref()? {
                    let density: f64 = self.hero.iter().zip(&powers).map(|(w, a)| w * a).sum();
                    if density > 0.0 {
                        let weights = powers.iter().zip(k).map(|(a, &k)| (a / density).powi(k));
                        sum += at(order) * density * weights.product::<f64>();
                    }
                    powers.iter_mut().zip(&self.rod.albedos).for_each(|(power, a)| *power *= a);
                }
                Some(sum)
            }
        }
    }

    /// What theory says of walks through σ̂.
    pub fn predict(&self, mesh: &Mesh, sampling: &Piecewise) -> Prediction {
        let channels: Vec<Channel> =
            self.rod.seen.iter().map(|&(end, channel)| self.channel(end, channel)).collect();
        let pairs = self.rod.seen.windows(2).enumerate();
        let covariances = pairs.filter_map(|(i, pair)| self.covariance(i, pair, &channels));
        let covariances = covariances.collect();
        let lookups = self.lookups(mesh, sampling);
        Prediction { channels, lookups, covariances, ..Prediction::default() }
    }

    fn channel(&self, end: End, channel: usize) -> Channel {
        let albedo = self.rod.albedos[channel];
        let values = leaving(self.depth.value, albedo, self.rod.forward).unwrap_or([f64::NAN; 2]);
        let value = values[usize::from(end == End::Transmitted)];
        // Neither changes faster than τ.
        let truth = Known::new(value, self.depth.error + ROUNDING * value);
        let raw = |k: i32| Some(self.moment(end, &self.only(channel, k))? / value.powi(k));
        let moments = (|| {
            let [second, third, fourth] = [raw(2)?, raw(3)?, raw(4)?];
            let m2 = (second - 1.0).max(0.0);
            let (m3, m4) = if fourth.is_finite() {
                let m4 = fourth - 4.0 * third + 6.0 * second - 3.0;
                (third - 3.0 * second + 2.0, m4.max(m2 * m2))
            } else {
                (f64::INFINITY, f64::INFINITY)
            };
            let relative = ROUNDING + self.depth.error / value;
            let of = |size: f64, moment: f64| if moment > 0.0 { size / moment } else { 0.0 };
            let of_fourth = if fourth.is_finite() { of(fourth + 6.0 * second, m4) } else { 0.0 };
            let error = of(second, m2).max(of_fourth) * relative;
            Some(Moments { scale: value, relative: [m2, m3, m4], error })
        })();
        let tails = match (raw(2), raw(4), raw(8)) {
            (Some(second), Some(fourth), Some(eighth)) => Tails {
                rare_event_size: fourth / (second * second),
                eighth_moment_ratio: if eighth.is_finite() {
                    eighth / (fourth * fourth)
                } else {
                    f64::INFINITY
                },
            },
            _ => Tails::LIGHT,
        };
        let side = if end == End::Reflected { "reflectance" } else { "transmittance" };
        let name = format!("{side}, channel {}", channel + 1);
        // No draw of MIS exceeds 1/w: pilots see all there is.
        let by_pilots = moments.is_none();
        Channel { name, by_pilots, ..Channel::unbiased(truth, moments, tails) }
    }

    fn covariance(
        &self,
        index: usize,
        pair: &[(End, usize)],
        channels: &[Channel],
    ) -> Option<Covariance> {
        let &[(end, first), (other, second)] = pair else { return None };
        let joint = |i: i32, j: i32| {
            if i > 0 && j > 0 && end != other {
                return Some(0.0);
            }
            let mut k = vec![0; self.rod.albedos.len()];
            k[first] += i;
            k[second] += j;
            self.moment(if j == 0 { end } else { other }, &k)
        };
        let [a, b] = [index, index + 1].map(|i| channels[i].truth.value);
        let [ab, aab, abb] = [joint(1, 1)?, joint(2, 1)?, joint(1, 2)?];
        let square = joint(2, 2)? - 2.0 * b * aab - 2.0 * a * abb
            + 4.0 * a * b * ab
            + b * b * joint(2, 0)?
            + a * a * joint(0, 2)?
            - 3.0 * a * a * b * b;
        let value = ab - a * b;
        let variance = if square.is_nan() { f64::INFINITY } else { square - value * value };
        Some(Covariance { pair: [index, index + 1], value, variance })
    }

    /// The lookups of analog walks, mixed over heroes.
    fn lookups(&self, mesh: &Mesh, sampling: &Piecewise) -> Option<CountLaw> {
        let of = |albedo: f64| {
            let [albedo, forward] =
                [albedo, self.rod.forward].map(|x| Piecewise::constant(x, mesh.support()));
            let medium = self.rod.medium().clone();
            let rod = Rod::new(medium, &albedo, &forward, channels(0, false, None));
            rod::factorial_lookups(mesh, &rod, sampling, ParticleRule::Analog)
        };
        let mut mixed = [[0.0; 2]; 4];
        let heroes: Vec<(f64, f64)> = match self.tracker {
            Tracker::Tracking { scatter } => vec![(1.0, scatter)],
            _ => self.hero.iter().copied().zip(self.rod.albedos.iter().copied()).collect(),
        };
        for (weight, albedo) in heroes {
            for (sum, [value, error]) in mixed.iter_mut().zip(of(albedo)?) {
                *sum = [sum[0] + weight * value, sum[1] + weight * error];
            }
        }
        let [mean, error] = mixed[0];
        let law = CountLaw::of_factorial_moments(mixed.map(|[value, _]| value));
        Some(CountLaw { error: if mean > 0.0 { error / mean } else { 0.0 }, ..law })
    }
}

/// The probabilities to leave a rod without absorption after r scatterings; `None` where there are too many.
fn orders(depth: f64, forward: f64) -> Option<Vec<[f64; 2]>> {
    // They fall as the −r-th power of the albedo that makes this length critical.
    let (mut low, mut high) = (1.0, 2.0);
    while critical(high, forward) > depth && high < 1e6 {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if critical(middle, forward) > depth { low = middle } else { high = middle }
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // compared before it is used
    let count = (-RARE.ln() / low.ln()).ceil() as usize + 8;
    if count > MOST_ORDERS {
        return None;
    }
    let angle = |j: usize| TAU * j as f64 / count as f64;
    // T(ā) is the conjugate of T(a): half the circle is enough.
    let half: Vec<[Complex64; 2]> = (0..=count / 2)
        .map(|j| continued(depth, Complex64::from_polar(1.0, angle(j)), forward))
        .collect();
    let turn: Vec<Complex64> = (0..count).map(|j| Complex64::from_polar(1.0, -angle(j))).collect();
    let order = |r: usize| {
        let mut sum = [0.0; 2];
        for (j, values) in half.iter().enumerate() {
            let weight = if j == 0 || 2 * j == count { 1.0 } else { 2.0 };
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += weight * (value * turn[j * r % count]).re;
            }
        }
        sum.map(|sum| (sum / count as f64).max(0.0))
    };
    Some((0..count).map(order).collect())
}
