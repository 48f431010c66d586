//! Bodies of coloured scatterers: moments of walks with weights that depend on the number of scatterings alone.
//!
//! With `R(a)` and `T(a)` of a rod or slab of one albedo a, continued to a > 1, and `K = Σ k_λ`:
//!
//! ```text
//! E[Π X_λ^{k_λ}; transmitted]
//! independent        w_h^{1−K} T(a_h), all of k on the channel h, else 0
//! hero               Σ_h w_h T(Π a_λ^{k_λ} / a_h^{K−1})
//! spectral tracking  T(Π a_λ^{k_λ} / P_s^{K−1}),  P_s the scattering probability
//! spectral MIS       Σ_r T_r D_r Π (a_λ^r/D_r)^{k_λ},  D_r = Σ_h w_h a_h^r
//! ```
//!
//! and likewise for R. Where `T(a)` is infinite, so is the moment. `T_r` is the probability to leave after r scatterings
//! that never absorb.
//!
//! Source: derived: each scattering multiplies the k-th moment of a weight by one number.

use crate::prediction::raw::RawMoments;
use crate::prediction::{Covariance, UNRESOLVED};
use crate::problems::channels::{Colours, End};
use crate::{Channel, CountDistribution, Moments, Prediction, colours};
use numeric::Known;

/// Probabilities to leave after r scatterings that never absorb.
pub struct Orders {
    /// Reflected and transmitted.
    pub result: Vec<[f64; 2]>,
    /// A bound on their relative error.
    pub error: f64,
    /// A bound on the absolute error of each, in addition: rare ones have fewer digits, and large weights.
    pub each: f64,
    /// Absolute error of their sum.
    pub blur: f64,
}

/// Reason why a moment is infinite, or may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Divergence {
    /// The optical length is not below the critical one.
    BeyondLength {
        /// Critical optical length.
        critical: f64,
    },
    /// The moment exceeds the largest double.
    Overflow,
    /// The moment is that of an albedo above the critical one.
    BeyondAlbedo {
        /// Critical albedo.
        critical: f64,
        /// Albedo of the moment.
        albedo: f64,
    },
    /// The moment is that of an albedo too near to the critical one: it may be finite or infinite.
    NearAlbedo {
        /// Critical albedo.
        critical: f64,
        /// Albedo of the moment.
        albedo: f64,
    },
}

/// Energies of a body of one albedo.
pub trait BodyEnergies: Send + Sync {
    /// Reflectance and transmittance, of albedos above 1, too; `None` where they are infinite.
    fn leaving(&self, albedo: f64) -> Option<[Known; 2]>;

    /// Reflectance and transmittance for higher moments, which may have larger errors.
    fn power(&self, albedo: f64) -> Option<[Known; 2]> {
        self.leaving(albedo)
    }

    /// Reason why they are infinite, or may be; `None` where they are finite.
    fn divergence(&self, albedo: f64) -> Option<Divergence>;

    /// Energies by orders of scattering; `None` where they are not known.
    fn orders(&self) -> Option<Orders>;

    /// The lookups of analog walks, mixed over weights and albedos; `None` where they are not known.
    fn lookups(&self, heroes: &[(f64, f64)]) -> Option<CountDistribution>;
}

/// Scoring of all channels by one walk.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BodyTracker {
    /// Scores one channel by its own walk, the others 0.
    Independent,
    /// The walk of a hero, divided by its density.
    Hero,
    /// One scattering probability for all channels.
    Tracking {
        /// `P_s`.
        scatter: f64,
    },
    /// The walk of a hero, divided by the mean density of all heroes.
    Mis,
}

/// A body with everything that its moments depend on.
pub struct BodySpectrum<'a> {
    body: Box<dyn BodyEnergies + 'a>,
    colours: &'a Colours,
    hero: Vec<f64>,
    tracker: BodyTracker,
    orders: Option<Orders>,
}

impl<'a> BodySpectrum<'a> {
    /// Joins the parts; `hero` has one probability for each channel.
    pub fn new(
        body: Box<dyn BodyEnergies + 'a>,
        colours: &'a Colours,
        hero: Vec<f64>,
        tracker: BodyTracker,
    ) -> Self {
        let orders = if tracker == BodyTracker::Mis { body.orders() } else { None };
        Self { body, colours, hero, tracker, orders }
    }

    /// Mean factor of the k-th power of a channel's weight at a scattering, given the scattering probability.
    fn albedo_of_power(&self, k: &[i32], scatter: f64) -> f64 {
        let total: i32 = k.iter().sum();
        let product: f64 = self.colours.albedos.iter().zip(k).map(|(a, &k)| a.powi(k)).product();
        if product == 0.0 { 0.0 } else { product / scatter.powi(total - 1) }
    }

    /// First channel with a second moment that is infinite, or may be, and the reason.
    pub fn divergence(&self) -> Option<(usize, Divergence)> {
        let walkers = self.walkers();
        (0..self.colours.albedos.len()).find_map(|channel| {
            let square = self.only(channel, 2);
            let mut albedos =
                walkers.iter().map(|&(_, scatter)| self.albedo_of_power(&square, scatter));
            albedos.find_map(|albedo| self.body.divergence(albedo)).map(|why| (channel, why))
        })
    }

    /// Walkers that score all channels without multiple importance sampling: their probabilities, and scattering
    /// probabilities.
    fn walkers(&self) -> Vec<(f64, f64)> {
        match self.tracker {
            BodyTracker::Hero => {
                let heroes = self.hero.iter().copied().zip(self.colours.albedos.iter().copied());
                heroes.filter(|&(weight, _)| weight > 0.0).collect()
            }
            BodyTracker::Tracking { scatter } => vec![(1.0, scatter)],
            _ => Vec::new(),
        }
    }

    fn only(&self, channel: usize, power: i32) -> Vec<i32> {
        let mut k = vec![0; self.colours.albedos.len()];
        k[channel] = power;
        k
    }

    /// `E[Π X_λ^{k_λ}]` of the energy that leaves at an end; infinite where it diverges, `None` where it is not
    /// known.
    fn moment(&self, end: End, k: &[i32]) -> Option<Known> {
        let side = usize::from(end == End::Transmitted);
        let total: i32 = k.iter().sum();
        match self.tracker {
            BodyTracker::Independent => {
                let channel = k.iter().position(|&k| k == total);
                Some(channel.map_or(Known::new(0.0, 0.0), |channel| {
                    let weight = self.hero[channel].powi(1 - total);
                    let result = self.body.leaving(self.colours.albedos[channel]);
                    result.map_or(Known::new(0.0, 0.0), |result| result[side] * weight)
                }))
            }
            BodyTracker::Hero | BodyTracker::Tracking { .. } => {
                let each = self.walkers().into_iter().map(|(weight, scatter)| {
                    let result = self.body.power(self.albedo_of_power(k, scatter));
                    result.map_or(Known::INFINITE, |result| result[side]) * weight
                });
                Some(each.sum())
            }
            BodyTracker::Mis => {
                let orders = self.orders.as_ref()?;
                let mut powers = vec![1.0; k.len()];
                let [mut sum, mut off] = [0.0, orders.blur];
                for order in &orders.result {
                    let density: f64 = self.hero.iter().zip(&powers).map(|(w, a)| w * a).sum();
                    if density > 0.0 {
                        let weights = powers.iter().zip(k).map(|(a, &k)| (a / density).powi(k));
                        let weight = density * weights.product::<f64>();
                        sum += order[side] * weight;
                        off += orders.each * weight;
                    }
                    powers.iter_mut().zip(&self.colours.albedos).for_each(|(power, a)| *power *= a);
                }
                Some(Known::estimated(sum, orders.error * sum + off))
            }
        }
    }

    /// Prediction for walks.
    pub fn predict(&self) -> Prediction {
        let channels: Vec<Channel> =
            self.colours.seen.iter().map(|&(end, channel)| self.channel(end, channel)).collect();
        let pairs = self.colours.seen.windows(2).enumerate();
        let covariances = pairs.filter_map(|(i, pair)| self.covariance(i, pair, &channels));
        let covariances = covariances.collect();
        let heroes: Vec<(f64, f64)> = match self.tracker {
            BodyTracker::Tracking { scatter } => vec![(1.0, scatter)],
            _ => self.hero.iter().copied().zip(self.colours.albedos.iter().copied()).collect(),
        };
        let lookups = self.body.lookups(&heroes);
        Prediction { channels, lookups, covariances, ..Prediction::default() }
    }

    fn channel(&self, end: End, channel: usize) -> Channel {
        let values = self.body.leaving(self.colours.albedos[channel]);
        let values = values.unwrap_or([Known::UNKNOWN; 2]);
        let truth = values[usize::from(end == End::Transmitted)];
        let raw = RawMoments::of(|k| match k {
            1 => Some(truth),
            _ => self.moment(end, &self.only(channel, k)),
        });
        let result = match raw {
            Some(raw) if raw.is_certain(truth.value) => {
                Channel::unbiased(truth, Moments::certain(truth.value), raw.tails(UNRESOLVED))
            }
            Some(raw) => raw.channel(truth, UNRESOLVED),
            // A draw of MIS is a^r/Σ w_h a_h^r ≤ 1/w or 0.
            None => colours::bounded(truth, self.hero[channel]),
        };
        Channel { name: end.name(channel), ..result }
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
            let mut k = vec![0; self.colours.albedos.len()];
            k[first] += i;
            k[second] += j;
            self.moment(if j == 0 { end } else { other }, &k).map(|known| known.value)
        };
        let [a, b] = [index, index + 1].map(|i| channels[i].truth.value);
        let [ab, aab, abb] = [joint(1, 1)?, joint(2, 1)?, joint(1, 2)?];
        let squares = [joint(2, 0)?, joint(0, 2)?];
        let mixed = [ab, aab, abb, joint(2, 2)?];
        let result = Covariance::of_raw([index, index + 1], [a, b], squares, mixed);
        let variance = if result.variance.is_nan() { f64::INFINITY } else { result.variance };
        Some(Covariance { variance, ..result })
    }
}
