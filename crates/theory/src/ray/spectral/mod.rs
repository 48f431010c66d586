//! Transmittance of a chromatic medium: all mixed moments of trackers that score every channel at once.
//!
//! With constant majorants `μ̄_λ`, null extinctions `n_λ = μ̄_λ − σ_λ`, a hero h of probability `w_h`, length ℓ, and
//! `K = Σ k_λ`:
//!
//! ```text
//! E[Π X_λ^{k_λ}]
//! independent, delta   w_h^{1−K} T_h where all of k is on one channel h, else 0
//! independent, ratio   w_h^{1−K} exp(∫ (n_h^K/μ̄_h^{K−1} − μ̄_h)), likewise
//! hero, ratio          Σ_h w_h exp((K − 1) μ̄_h ℓ − Σ k_λ μ̄_λ ℓ + ∫ Π n_λ^{k_λ} / μ̄_h^{K−1})
//! hero, delta          Σ_h w_h exp((K − 1) μ̄_h ℓ − Σ k_λ μ̄_λ ℓ + ∫ Π n_λ^{k_λ} / n_h^{K−1})
//! MIS, ratio           Σ_n (∫ Π n_λ^{k_λ})ⁿ/n! e^{−Σ k_λ μ̄_λ ℓ} / [Σ_h w_h e^{−μ̄_h ℓ} μ̄_hⁿ]^{K−1}
//! MIS, delta           Σ over the numbers of null collisions in each cell of a piecewise constant medium
//! spectral tracking    exp ∫ μ̄ [Π (n_λ/μ̄)^{k_λ} / P_n^{K−1} − 1]
//! ```
//!
//! They hold for any fields. A walk of delta tracking with the hero h survives with the probability `T_h`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light
//! Transport*, ACM Transactions on Graphics 38 (2019), section 5.1; P. Kutz, R. Habel, Y. K. Li,
//! J. Novák, *Spectral and Decomposition Tracking for Rendering Heterogeneous Volumes*, ACM Transactions on
//! Graphics 36 (2017), section 5. The moments follow from Campbell's theorem.

pub mod cells;
pub mod lookups;
mod predict;

use crate::Mesh;
use crate::colours::Chance;
use numeric::sum::Sum;
use numeric::{Known, Scalar};

/// Maximum probability of numbers of null collisions that are left out.
const RARE: f64 = 1e-19;

/// Scoring of all channels by one draw.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tracker {
    /// Scores one channel by its own walk, the others 0.
    Independent {
        /// True if real collisions end the walk.
        delta: bool,
    },
    /// Scores all channels, each by its own walk.
    InTurn {
        /// True if real collisions end the walk.
        delta: bool,
    },
    /// Scores all channels by the hero's walk, divided by its density.
    Hero {
        /// True if real collisions end the walk.
        delta: bool,
    },
    /// Scores all channels by the hero's walk, divided by the mean density of all heroes.
    Mis {
        /// True if real collisions end the walk.
        delta: bool,
    },
    /// One majorant for all channels, and an event probability that depends on all of them.
    Tracking(Chance),
}

impl Tracker {
    /// Returns whether real collisions end a walk.
    #[inline(always)]
    pub fn is_delta(self) -> bool {
        match self {
            Self::Independent { delta }
            | Self::InTurn { delta }
            | Self::Hero { delta }
            | Self::Mis { delta } => delta,
            Self::Tracking(_) => true,
        }
    }
}

/// A chromatic medium with its majorants on one mesh.
pub struct Spectrum {
    mesh: Mesh,
    /// τ of each channel.
    depths: Vec<Known>,
    /// `n_λ` at the nodes of the mesh, channel by channel.
    nulls: Vec<Vec<f64>>,
    majorants: Vec<f64>,
    hero: Vec<f64>,
    tracker: Tracker,
    atoms: Option<Vec<(f64, Vec<f64>)>>,
}

impl Spectrum {
    /// Joins the channels, on meshes with one support; `majorants` and `hero` have one entry for each.
    pub fn new(meshes: &[&Mesh], majorants: Vec<f64>, hero: Vec<f64>, tracker: Tracker) -> Self {
        let media: Vec<_> = meshes.iter().map(|mesh| mesh.medium()).collect();
        let cuts = if tracker == Tracker::Tracking(Chance::Maximum) {
            Mesh::joint_cuts(meshes, Vec::new(), &|channel, t| [media[channel].extinction(t)])
        } else {
            Mesh::joint_cuts(meshes, Vec::new(), &|_, _| [])
        };
        let smooth = |mesh: &Mesh, panel: super::mesh::Panel<'_>| {
            let mut functions = Vec::new();
            let mut shares = Vec::new();
            for (medium, &majorant) in media.iter().zip(&majorants) {
                let sigma = medium.extinctions(panel.t);
                functions.push(mesh.running(panel, &sigma).iter().map(|k| (-k).exp()).collect());
                shares.push(sigma.iter().map(|s| 1.0 - s / majorant).collect::<Vec<f64>>());
                functions.push(sigma);
            }
            match tracker {
                Tracker::Hero { delta: true } => {
                    for share in &shares {
                        functions.push(share.iter().map(|n| 1.0 / n.max(1e-9)).collect());
                    }
                }
                Tracker::Tracking(choice) => functions.push(
                    (0..panel.t.len())
                        .map(|i| {
                            let here: Vec<f64> = shares.iter().map(|share| share[i]).collect();
                            1.0 / choice.of_null(&here).max(1e-9)
                        })
                        .collect(),
                ),
                _ => {}
            }
            functions
        };
        let mesh = meshes[0].refined(&cuts, &smooth);
        let nulls = media.iter().zip(&majorants).map(|(medium, majorant)| {
            let t: Vec<f64> = mesh.panels().flat_map(|panel| panel.t.iter().copied()).collect();
            medium.extinctions(&t).iter().map(|sigma| majorant - sigma).collect()
        });
        let nulls = nulls.collect();
        let depths = meshes.iter().map(|mesh| mesh.optical_depth()).collect();
        let spectrum = Self { mesh, depths, nulls, majorants, hero, tracker, atoms: None };
        let atoms = if tracker == (Tracker::Mis { delta: true }) { spectrum.cells() } else { None };
        Self { atoms, ..spectrum }
    }

    fn channels(&self) -> usize {
        self.majorants.len()
    }

    fn length(&self) -> f64 {
        self.mesh.support().length()
    }

    /// `∫ f(n)` over the support; `f` is given the null extinctions of all channels at a node.
    fn integrate<S: Scalar>(&self, f: &dyn Fn(&[f64]) -> S) -> S {
        let values: Vec<S> = (0..self.nulls[0].len())
            .map(|node| f(&self.nulls.iter().map(|nulls| nulls[node]).collect::<Vec<f64>>()))
            .collect();
        S::of_terms(|index| self.mesh.integrate_nodes(&|node| values[node].term(index)))
    }

    /// `E[Π X_λ^{k_λ}]`, for numbers k or series; `None` where it is not known.
    fn moment<S: Scalar>(&self, k: &[S]) -> Option<S> {
        let [one, none] = [1.0, 0.0].map(S::from);
        let total = k.iter().fold(none, |sum, &k| sum + k);
        let product = |n: &[f64]| n.iter().zip(k).fold(one, |of, (&n, k)| of * k.power_of(n));
        // Times the density of an event, to the power 1 − K; 0 where the event does not occur.
        let weighted = |result: S, density: f64| {
            if result.leading() == 0.0 { none } else { result / (total - one).power_of(density) }
        };
        let depth = k.iter().zip(&self.majorants).fold(none, |sum, (&k, own)| sum + k * *own);
        let depth = depth * self.length();
        let of_heroes = |exponent: &dyn Fn(usize) -> S| {
            let heroes = self.hero.iter().enumerate();
            heroes.fold(none, |sum, (hero, &probability)| sum + exponent(hero).exp() * probability)
        };
        // A single channel by its own walk, without the factor of its choice.
        let own = |channel: usize, k: S, delta: bool| {
            if k.leading() == 0.0 {
                return one;
            }
            if delta {
                return S::from(self.depths[channel].exp_neg().value);
            }
            let majorant = self.majorants[channel];
            let loss = |n: &[f64]| (k.power_of(n[channel] / majorant) - one) * majorant;
            self.integrate(&loss).exp()
        };
        let result = match self.tracker {
            Tracker::Independent { delta } => {
                let mut requested =
                    (0..self.channels()).filter(|&channel| k[channel].leading() > 0.0);
                match (requested.next(), requested.next()) {
                    (Some(channel), None) => {
                        (one - total).power_of(self.hero[channel]) * own(channel, total, delta)
                    }
                    (None, _) => one,
                    _ => none,
                }
            }
            Tracker::InTurn { delta } => {
                let each = k.iter().enumerate().map(|(channel, &k)| own(channel, k, delta));
                each.fold(one, |product, moment| product * moment)
            }
            Tracker::Hero { delta } => of_heroes(&|hero| {
                let majorant = self.majorants[hero];
                let rate = |n: &[f64]| if delta { n[hero] } else { majorant };
                let gained = self.integrate(&|n| weighted(product(n), rate(n)));
                (total - one) * majorant * self.length() - depth + gained
            }),
            Tracker::Mis { delta: false } => self.by_count(self.integrate(&product), depth, total),
            Tracker::Mis { delta: true } => {
                let atoms = self.atoms.as_ref()?.iter();
                atoms.fold(none, |sum, (probability, x)| sum + product(x) * *probability)
            }
            Tracker::Tracking(choice) => {
                let majorant = self.majorants[0];
                let loss = |n: &[f64]| {
                    let shares: Vec<f64> = n.iter().map(|n| n / majorant).collect();
                    (weighted(product(&shares), choice.of_null(&shares)) - one) * majorant
                };
                self.integrate(&loss).exp()
            }
        };
        Some(result)
    }

    /// Relative rounding error of `E[X_λ^k]`: walks that are weighted by other channels have exponents, which may
    /// be hundreds, and null extinctions, which are differences of σ̂ and σ_t.
    ///
    /// ```text
    /// ε [(k − 1) μ̄_h ℓ + k μ̄ ℓ + ∫ n^k/d^{k−1} (1 + k μ̄/n + (k − 1) b) dt],  b = μ̄_h/n_h, 1/P_n or 0
    /// ```
    fn rounding(&self, channel: usize, k: f64) -> f64 {
        let own = self.majorants[channel];
        // n^k/d^{k−1}, d the density of nulls, and b.
        let gathered = |density: &dyn Fn(&[f64]) -> [f64; 2]| {
            self.integrate(&|n| {
                let [density, off] = density(n);
                let null = n[channel];
                if null <= 0.0 {
                    return 0.0;
                }
                k.power_of(null) / (k - 1.0).power_of(density)
                    * (1.0 + k * own / null + (k - 1.0) * off)
            })
        };
        let exponents = match self.tracker {
            Tracker::Hero { delta } => {
                let heroes = (0..self.channels()).filter(|&hero| self.hero[hero] > 0.0);
                let of = |hero: usize| {
                    let majorant = self.majorants[hero];
                    let flights = ((k - 1.0) * majorant + k * own) * self.length();
                    flights
                        + gathered(&|n| {
                            if delta { [n[hero], majorant / n[hero]] } else { [majorant, 0.0] }
                        })
                };
                heroes.map(of).fold(0.0, f64::max)
            }
            Tracker::Tracking(choice) => {
                let majorant = self.majorants[0];
                let of_null = |n: &[f64]| {
                    let shares: Vec<f64> = n.iter().map(|n| n / majorant).collect();
                    let choice = choice.of_null(&shares);
                    [majorant * choice, 1.0 / choice]
                };
                majorant * self.length() + gathered(&of_null)
            }
            _ => 0.0,
        };
        f64::EPSILON * exponents
    }

    /// The sum over the number of collisions, for densities that depend only on that number.
    fn by_count<S: Scalar>(&self, nulls: S, depth: S, total: S) -> S {
        let length = self.length();
        let log_density = |n: f64| {
            let log = |hero: usize| {
                let majorant = self.majorants[hero];
                self.hero[hero].ln() - majorant * length + n * majorant.ln()
            };
            let largest = (0..self.channels()).map(log).fold(f64::NEG_INFINITY, f64::max);
            let sum: f64 = (0..self.channels()).map(|hero| (log(hero) - largest).exp()).sum();
            largest + sum.ln()
        };
        let (mut sums, mut n, mut sign) = (vec![Sum::default(); S::TERMS], 0.0, 1.0);
        let (mut largest, mut log) = (0.0f64, S::from(0.0));
        let negative = nulls.leading() < 0.0;
        let size = if negative { -nulls } else { nulls };
        loop {
            let term = (log - depth - (total - S::from(1.0)) * log_density(n)).exp();
            sums.iter_mut().enumerate().for_each(|(i, sum)| sum.add(sign * term.term(i)));
            let rare = RARE * largest.min(sums[0].value().abs());
            if size.leading() == 0.0 || term.leading() < rare {
                return S::of_terms(|i| sums[i].value());
            }
            largest = largest.max(term.leading());
            n += 1.0;
            log = log + (size.ln() - S::from(n.ln()));
            sign *= if negative { -1.0 } else { 1.0 };
            if n > 1e6 {
                return S::from(f64::NAN);
            }
        }
    }
}
