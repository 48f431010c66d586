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
use crate::colours::rates::power;
use numeric::Known;
use numeric::sum::Sum;

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
    /// Returns true if real collisions end a walk.
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
            Mesh::joint_cuts(meshes, Vec::new(), |channel, t| [media[channel].extinction(t)])
        } else {
            Mesh::joint_cuts(meshes, Vec::new(), |_, _| [])
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
                Tracker::Tracking(chance) => functions.push(
                    (0..panel.t.len())
                        .map(|i| {
                            let here: Vec<f64> = shares.iter().map(|share| share[i]).collect();
                            1.0 / chance.of_null(&here).max(1e-9)
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
    fn integrate(&self, f: impl Fn(&[f64]) -> f64) -> f64 {
        let (mut sum, mut node, mut here) = (Sum::default(), 0, vec![0.0; self.channels()]);
        for panel in self.mesh.panels() {
            let mut values = Vec::with_capacity(panel.t.len());
            for _ in panel.t {
                for (n, nulls) in here.iter_mut().zip(&self.nulls) {
                    *n = nulls[node];
                }
                values.push(f(&here));
                node += 1;
            }
            sum.add(self.mesh.integral(panel, &values));
        }
        sum.value()
    }

    /// `E[Π X_λ^{k_λ}]`; `None` where it is not known.
    fn moment(&self, k: &[f64]) -> Option<f64> {
        let total: f64 = k.iter().sum();
        let product = |n: &[f64]| -> f64 { n.iter().zip(k).map(|(&n, &k)| power(n, k)).product() };
        let depth: f64 =
            k.iter().zip(&self.majorants).map(|(k, majorant)| k * majorant).sum::<f64>()
                * self.length();
        let of_heroes = |exponent: &dyn Fn(usize) -> f64| -> f64 {
            (0..self.channels()).map(|hero| self.hero[hero] * exponent(hero).exp()).sum()
        };
        // A single channel by its own walk, without the factor of its choice.
        let own = |channel: usize, k: f64, delta: bool| -> f64 {
            if k == 0.0 {
                return 1.0;
            }
            if delta {
                return self.depths[channel].exp_neg().value;
            }
            let majorant = self.majorants[channel];
            let loss = |n: &[f64]| majorant * (power(n[channel] / majorant, k) - 1.0);
            self.integrate(loss).exp()
        };
        let found = match self.tracker {
            Tracker::Independent { delta } => {
                let mut asked = (0..self.channels()).filter(|&channel| k[channel] > 0.0);
                match (asked.next(), asked.next()) {
                    (Some(channel), None) => {
                        self.hero[channel].powf(1.0 - total) * own(channel, total, delta)
                    }
                    (None, _) => 1.0,
                    _ => 0.0,
                }
            }
            Tracker::InTurn { delta } => {
                k.iter().enumerate().map(|(channel, &k)| own(channel, k, delta)).product()
            }
            Tracker::Hero { delta } => of_heroes(&|hero| {
                let majorant = self.majorants[hero];
                let rate = |n: &[f64]| if delta { n[hero] } else { majorant };
                let density = |n: &[f64]| {
                    let found = product(n);
                    if found == 0.0 { 0.0 } else { found / power(rate(n), total - 1.0) }
                };
                (total - 1.0) * majorant * self.length() - depth + self.integrate(density)
            }),
            Tracker::Mis { delta: false } => self.by_count(self.integrate(product), depth, total),
            Tracker::Mis { delta: true } => {
                let atoms = self.atoms.as_ref()?.iter();
                atoms.map(|(probability, x)| probability * product(x)).sum()
            }
            Tracker::Tracking(chance) => {
                let majorant = self.majorants[0];
                let loss = |n: &[f64]| {
                    let shares: Vec<f64> = n.iter().map(|n| n / majorant).collect();
                    let found = product(&shares);
                    let per = if found == 0.0 {
                        0.0
                    } else {
                        found / power(chance.of_null(&shares), total - 1.0)
                    };
                    majorant * (per - 1.0)
                };
                self.integrate(loss).exp()
            }
        };
        Some(found)
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
            self.integrate(|n| {
                let [density, off] = density(n);
                let null = n[channel];
                if null <= 0.0 {
                    return 0.0;
                }
                power(null, k) / power(density, k - 1.0) * (1.0 + k * own / null + (k - 1.0) * off)
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
            Tracker::Tracking(chance) => {
                let majorant = self.majorants[0];
                let of_null = |n: &[f64]| {
                    let shares: Vec<f64> = n.iter().map(|n| n / majorant).collect();
                    let chance = chance.of_null(&shares);
                    [majorant * chance, 1.0 / chance]
                };
                majorant * self.length() + gathered(&of_null)
            }
            _ => 0.0,
        };
        f64::EPSILON * exponents
    }

    /// The sum over the number of collisions, for densities that depend only on that number.
    fn by_count(&self, nulls: f64, depth: f64, total: f64) -> f64 {
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
        let (mut sum, mut n, mut sign) = (Sum::default(), 0.0, 1.0);
        let (mut largest, mut log) = (0.0f64, 0.0);
        loop {
            let term = (log - depth - (total - 1.0) * log_density(n)).exp();
            sum.add(sign * term);
            if nulls == 0.0 || (term < RARE * largest && term < sum.value().abs() * RARE) {
                return sum.value();
            }
            largest = largest.max(term);
            n += 1.0;
            log += nulls.abs().ln() - n.ln();
            sign *= nulls.signum();
            if n > 1e6 {
                return f64::NAN;
            }
        }
    }
}
