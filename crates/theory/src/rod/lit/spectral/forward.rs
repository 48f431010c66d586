//! Rods in which light goes on forward: every mixed moment of hits that score all channels at once.
//!
//! With one direction a draw is a product along the ray. Let `μ_e`, e = n, s, a, be the rates of null, scattering
//! and absorbing collisions, `μ̄ = μ_n + μ_s + μ_a`, `P_e` the probability of an event and `K = Σ k_λ`:
//!
//! ```text
//! spectral tracking, fixed P_e        E[Π X_λ^{k_λ}] = exp ∫ μ̄ [Σ_{e = n, s} Π (μ_e,λ/μ̄)^{k_λ}/P_e^{K−1} − 1]
//! spectral MIS                        a sum over the numbers of null and of scattering collisions in each cell of a
//!                                     rod that is constant in each, see [`crate::ray::spectral`]
//! history-aware spectral tracking     the same as spectral MIS with one μ̄ for all channels
//! ```
//!
//! Source: P. Kutz, R. Habel, Y. K. Li, J. Novák, *Spectral and Decomposition Tracking for Rendering Heterogeneous
//! Volumes*, ACM Transactions on Graphics 36 (2017), section 5.1; B. Miller, I. Georgiev, W. Jarosz, *A null-scattering
//! path integral formulation of light transport*, ACM Transactions on Graphics 38 (2019), Figure 8. The moments follow
//! from Campbell's theorem.

use super::{Moments, PAIRS};
use crate::colours::Chances;
use crate::prediction::raw::{POWERS, RawMoments, of_factorial};
use crate::problems::SpectralLitRod;
use crate::ray::spectral::cells::{balanced, join};
use crate::ray::spectral::lookups::survived;
use crate::{CountDistribution, Mesh};
use media::Piecewise;
use numeric::Known;

/// Relative rounding error of a moment.
const ROUNDING: f64 = 1e-13;
/// Maximum difference of rates, relative to the largest σ̂, that count as one constant.
const CONSTANT: f64 = 1e-13;

/// A rod in which light goes on forward, on a mesh for all its channels.
pub struct Forward {
    mesh: Mesh,
    /// `μ_n`, `μ_s` and `μ_a` of each channel at each node.
    rates: Vec<Vec<[f64; 3]>>,
    majorants: Vec<f64>,
    heroes: Vec<f64>,
}

impl Forward {
    /// Joins the channels; `None` where light turns or a σ̂ varies.
    pub fn new(
        problem: &SpectralLitRod,
        media: &[(&Mesh, &Piecewise)],
        heroes: &[f64],
    ) -> Option<Self> {
        if problem.forward.iter().any(|&forward| forward < 1.0) {
            return None;
        }
        let majorants: Vec<f64> =
            media.iter().map(|(_, majorant)| majorant.single_value()).collect::<Option<_>>()?;
        let count = media.len();
        let sigma = |channel: usize, t: f64| media[channel].0.medium().extinction(t);
        let rates = |channel: usize, t: f64| {
            let (sigma, albedo) = (sigma(channel, t), problem.albedo(channel, t));
            [majorants[channel] - sigma, sigma * albedo, sigma * (1.0 - albedo)]
        };
        let meshes: Vec<&Mesh> = media.iter().map(|(mesh, _)| *mesh).collect();
        let knots = problem.rods.iter().flat_map(|rod| rod.rod.albedo.knots().to_vec()).collect();
        // Where two channels cross, the larger of their rates has a kink.
        let cuts = Mesh::joint_cuts(&meshes, knots, &rates);
        let smooth = |mesh: &Mesh, panel: crate::ray::mesh::Panel<'_>| {
            let mut functions = Vec::new();
            for channel in 0..count {
                let here: Vec<[f64; 3]> = panel.t.iter().map(|&t| rates(channel, t)).collect();
                let real: Vec<f64> = here.iter().map(|rates| rates[1] + rates[2]).collect();
                let depths = mesh.running(panel, &real);
                functions.push(depths.iter().map(|depth| (-depth).exp()).collect());
                functions.extend(
                    [0, 1].map(|event| here.iter().map(|rates| rates[event]).collect::<Vec<f64>>()),
                );
            }
            functions
        };
        let mesh = meshes[0].refined(&cuts, &smooth);
        let nodes: Vec<f64> = mesh.panels().flat_map(|panel| panel.t.iter().copied()).collect();
        let of_channel = |channel: usize| nodes.iter().map(|&t| rates(channel, t)).collect();
        let rates = (0..count).map(of_channel).collect();
        Some(Self { mesh, rates, majorants: majorants.clone(), heroes: heroes.to_vec() })
    }

    /// `μ_e/μ̄` of all channels at a node.
    fn shares(&self, node: usize) -> Vec<[f64; 3]> {
        let channels = self.rates.iter().zip(&self.majorants);
        channels.map(|(rates, majorant)| rates[node].map(|rate| rate / majorant)).collect()
    }

    /// Moments of spectral tracking.
    pub fn tracking(&self, chances: Chances) -> Option<Moments> {
        if chances == Chances::History {
            return self.balanced();
        }
        let majorant = self.majorants[0];
        let weights = vec![1.0; self.heroes.len()];
        let nodes: Vec<_> = (0..self.rates[0].len())
            .map(|node| {
                let shares = self.shares(node);
                let choice = chances.of_events(shares.len(), |channel| shares[channel], &weights);
                (shares, choice)
            })
            .collect();
        Some(self.moments(&|powers| {
            let total: i32 = powers.iter().sum();
            let loss = |node: usize| {
                let (shares, choice) = &nodes[node];
                let brings = |event: usize| {
                    let channels = shares.iter().zip(powers);
                    let product: f64 = channels.map(|(s, &k)| s[event].powi(k)).product();
                    if product == 0.0 { 0.0 } else { product / choice[event].powi(total - 1) }
                };
                majorant * (brings(0) + brings(1) - 1.0)
            };
            self.mesh.integrate_nodes(&loss).exp()
        }))
    }

    /// Moments of multiple importance sampling over heroes; `None` where the rod is not constant in each cell.
    pub fn balanced(&self) -> Option<Moments> {
        let scale = self.majorants.iter().fold(0.0f64, |maximum, &x| maximum.max(x));
        let mut cells = Vec::new();
        for (panel, here) in self.mesh.numbered() {
            for event in [0, 1] {
                let of_channel = |rates: &Vec<[f64; 3]>| {
                    let first = rates[here.start][event];
                    let same = |i: usize| (rates[i][event] - first).abs() <= CONSTANT * scale;
                    here.clone().all(same).then_some(first)
                };
                let rates: Vec<f64> = self.rates.iter().map(of_channel).collect::<Option<_>>()?;
                join(&mut cells, CONSTANT * scale, panel.span.length(), &rates);
            }
        }
        let length = self.mesh.support().length();
        let begin = self.majorants.iter().map(|majorant| (-majorant * length).exp()).collect();
        let atoms = balanced(&cells, begin, &self.heroes)?;
        Some(self.moments(&|powers| {
            let of = |(probability, x): &(f64, Vec<f64>)| {
                let product: f64 = x.iter().zip(powers).map(|(x, &k)| x.powi(k)).product();
                probability * product
            };
            atoms.iter().map(of).sum()
        }))
    }

    /// Selects the required moments of `E[Π X_λ^{k_λ}]`.
    fn moments(&self, of: &dyn Fn(&[i32]) -> f64) -> Moments {
        let collisions = self.majorants.iter().fold(0.0f64, |maximum, &x| maximum.max(x))
            * self.mesh.support().length();
        let relative = ROUNDING + self.mesh.relative_error() * collisions.max(1.0);
        let none = vec![0; self.heroes.len()];
        let raw = (0..self.heroes.len()).map(|channel| {
            RawMoments(POWERS.map(|k| {
                let mut powers = none.clone();
                powers[channel] = k;
                let value = of(&powers);
                Known::estimated(value, f64::from(k) * relative * value)
            }))
        });
        let mixed = (1..self.heroes.len()).map(|channel| {
            PAIRS.map(|[first, second]| {
                let mut powers = none.clone();
                powers[channel - 1] = i32::from(first == 2) + 1;
                powers[channel] = i32::from(second == 2) + 1;
                of(&powers)
            })
        });
        Moments { raw: raw.collect(), mixed: mixed.collect() }
    }

    /// The lookups of spectral tracking; `None` where they are those of heroes.
    pub fn lookups(&self, chances: Chances) -> Option<CountDistribution> {
        let weights = vec![1.0; self.heroes.len()];
        let survival = |node: usize| {
            let shares = self.shares(node);
            let chances = chances.of_events(shares.len(), |channel| shares[channel], &weights);
            chances[0] + chances[1]
        };
        if chances == Chances::History {
            return None;
        }
        let factorial = survived(&self.mesh, self.majorants[0], &survival);
        Some(CountDistribution::of_raw(0.0, of_factorial(factorial), self.mesh.relative_error()))
    }
}
