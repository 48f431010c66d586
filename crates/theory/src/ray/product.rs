//! Product estimators: all moments and all costs.
//!
//! ```text
//! X = T_c ∏ W(tᵢ),  tᵢ a Poisson process of rate σ̂ on the support, W independent
//! E[X^k] = T_c^k exp(−∫ σ̂ (1 − E[W^k]) dt)
//! ```
//!
//! k = 2 is Eq. 16 of L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased
//! Light Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36
//! (2017), with the variance introduction densities of its Eqs. 17–20.

use super::mesh::Panel;
use super::survival::Survival;
use crate::collisions::{Outcome, Rule};
use crate::prediction::raw::of_factorial;
use crate::prediction::transmittance;
use crate::{Channel, CountDistribution, Mesh, Moments, Prediction, Tails};
use media::{Control, Piecewise};
use numeric::sum::Sum;
use numeric::{Grade, Known};

/// A product estimator on a ray: everything its moments depend on.
#[derive(Clone, Copy)]
pub struct Product<'a> {
    /// The medium, cut into panels.
    pub mesh: &'a Mesh,
    /// σ̂.
    pub sampling: &'a Piecewise,
    /// σ_c.
    pub control: &'a Control,
    /// Rule at a collision.
    pub rule: &'a dyn Rule,
    /// The rate at which the walk also ends without a lookup, 1/length: that of a control which
    /// is sampled instead of integrated.
    pub killing: f64,
    /// True if the distribution of the lookups and the stable share are computed; a search for optima does without.
    pub with_distributions: bool,
    /// Draws are in units of `exp(−log_unit)`.
    pub log_unit: f64,
}

/// Integrals from which moments and costs are computed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Integrals {
    /// `J_k = ∫ σ̂ E[(1 − W)^k]`, k = 1 … 4.
    pub losses: [f64; 4],
    /// `ln n(2) = ∫ σ̂ (ρ ln(ρ/q) − ρ + 1)`, `ρ = q W²`.
    pub rarity: f64,
    /// `ln E[(X/T)^k] = ∫ σ̂ (E[W^k] − 1 + k(1 − E[W]))`, k = 4 and 8.
    pub growth: [f64; 2],
    /// Factorial moments of the number of lookups, k = 1 … 4, see [`super::survival`].
    pub lookups: [f64; 4],
    /// `∫σ̂`.
    pub flown: f64,
    /// True if every loss is constant in each panel: then sums over panels are exact.
    pub is_stepwise: bool,
}

/// σ̂ and the outcome at the nodes of one panel.
pub(super) struct Nodes {
    pub(super) sampling: Vec<f64>,
    pub(super) outcome: Vec<Outcome>,
}

impl<'a> Product<'a> {
    /// A product estimator that ends at collisions only.
    pub fn new(
        mesh: &'a Mesh,
        sampling: &'a Piecewise,
        control: &'a Control,
        rule: &'a dyn Rule,
    ) -> Self {
        Self {
            mesh,
            sampling,
            control,
            rule,
            killing: 0.0,
            with_distributions: true,
            log_unit: 0.0,
        }
    }

    fn ratio(&self, t: f64, extinction: f64) -> f64 {
        let residual = extinction - self.control.extinction(t);
        // Where both vanish there are no collisions, and any finite ratio is valid.
        if residual == 0.0 { 0.0 } else { residual / self.sampling.value(t) }
    }

    pub(super) fn nodes(&self, panel: Panel<'_>) -> Nodes {
        let sampling = panel.t.iter().map(|&t| self.sampling.value(t)).collect();
        let at = panel.t.iter().zip(panel.extinction);
        let outcome = at.map(|(&t, &sigma)| self.rule.outcome(self.ratio(t, sigma))).collect();
        Nodes { sampling, outcome }
    }

    /// The mesh on which this estimator's integrands are smooth: cut at the breaks of σ̂ and
    /// control and where the ratio crosses a kink of the rule.
    pub fn mesh(&self, further_cuts: &[f64]) -> Mesh {
        let mut cuts = further_cuts.to_vec();
        cuts.extend(self.sampling.knots());
        cuts.extend(self.control.breaks());
        let kinks = self.rule.kinks().into_iter().map(|level| {
            move |t: f64, sigma: f64| {
                sigma - self.control.extinction(t) - level * self.sampling.value(t)
            }
        });
        self.mesh.refined(&self.mesh.cuts(cuts, kinks), &|mesh, panel| {
            let nodes = self.nodes(panel);
            let pairs = || nodes.sampling.iter().zip(&nodes.outcome);
            let deaths: Vec<f64> = pairs().map(|(s, o)| self.killing + s * o.death).collect();
            let decay = mesh.running(panel, &deaths).iter().map(|k| (-k).exp()).collect();
            // A control that fits to the last digits leaves a residual of rounding noise, which no
            // halving makes smooth.
            let largest = |values: &mut dyn Iterator<Item = f64>| {
                values.fold(0.0f64, |maximum, x| maximum.max(x.abs()))
            };
            let loss = largest(&mut nodes.outcome.iter().map(|o| o.loss));
            let seen = largest(&mut panel.extinction.iter().copied());
            let flown = nodes.sampling.iter().fold(f64::INFINITY, |minimum, &s| minimum.min(s));
            let mut functions = vec![decay];
            if 4.0 * f64::EPSILON * seen / flown <= 1e-10 * loss {
                functions.push(pairs().map(|(s, o)| s * o.mean_loss(2)).collect());
                functions.push(pairs().map(|(s, o)| s * o.mean_loss(4)).collect());
            }
            functions
        })
    }

    /// All integrals from the beginning of the support to each of `ends` (ascending; the mesh must
    /// be cut there).
    pub fn integrals(&self, mesh: &Mesh, ends: &[f64]) -> Vec<Integrals> {
        let mut total = Totals::default();
        let mut result = Vec::with_capacity(ends.len());
        let mut ends = ends.iter().peekable();
        for panel in mesh.panels() {
            while ends.next_if(|&&end| end <= panel.span.from).is_some() {
                result.push(total.read());
            }
            total.add(mesh, panel, &self.nodes(panel), self.killing);
        }
        result.extend(ends.map(|_| total.read()));
        result
    }

    /// Share of the support on which `σ̂ E[(1 − W)²] ≤ 2σ_t`: between the places where the sides cross. `None` on an empty
    /// support.
    pub fn stable_share(&self, mesh: &Mesh) -> Option<f64> {
        let excess = |t: f64, extinction: f64| {
            let introduced = self.rule.outcome(self.ratio(t, extinction)).mean_loss(2);
            let rate = self.sampling.value(t) * introduced + self.killing;
            rate - 2.0 * extinction * (1.0 + 1e-12)
        };
        let length = mesh.support().length();
        let cut = mesh.cut(&mesh.roots(&excess));
        let stable = cut.panels().filter(|panel| {
            let middle = panel.t.len() / 2;
            excess(panel.t[middle], panel.extinction[middle]) <= 0.0
        });
        let stable: f64 = stable.map(|panel| panel.span.length()).sum();
        (length > 0.0).then(|| (stable / length).min(1.0))
    }

    /// Mean, moments, rarity, costs and stability of the estimate of `T` over the whole support.
    pub fn predict(&self) -> Prediction {
        let mesh = self.mesh(&[]);
        let all = self.integrals(&mesh, &[mesh.support().to])[0];
        let channel = all.channel(mesh.optical_depth(), self.log_unit, mesh.relative_error());
        let stable_share = if self.with_distributions { self.stable_share(&mesh) } else { None };
        let lookups = self.lookups(&mesh, &all);
        Prediction { stable_share, ..Prediction::single(channel, lookups) }
    }
}

impl Integrals {
    /// Channel of a transmittance of an optical depth, in units of `exp(−log_unit)`, given the relative error of the
    /// integrals.
    pub fn channel(&self, depth: Known, log_unit: f64, relative_error: f64) -> Channel {
        let scale = transmittance(depth, log_unit).value;
        let moments = Moments::of_product(scale, self.losses, relative_error);
        let grade = if self.is_stepwise { Grade::Proven } else { Grade::Estimated };
        let [fourth, eighth] = self.growth;
        let tails = Tails {
            rare_event_size: self.rarity.exp(),
            eighth_moment_ratio: (eighth - 2.0 * fourth).exp(),
        };
        let channel = Channel::transmittance(depth, log_unit, moments.graded(grade), tails);
        Channel { losses: Some(self.losses), ..channel }
    }

    /// Mean, variance and kurtosis of the number of lookups; the probabilities only where the distribution is
    /// Poisson or certain, see [`Product::lookups`]. `relative_error` is that of the integrals.
    pub fn count(&self, relative_error: f64) -> CountDistribution {
        let mean = self.lookups[0];
        // A walk that nothing ends early makes a Poisson number of lookups.
        if (mean - self.flown).abs() <= 1e-13 * self.flown {
            return CountDistribution::poisson(self.flown);
        }
        // The error of K is one of e^{−K}, too.
        let error = relative_error * (1.0 + self.flown);
        CountDistribution::of_raw(0.0, of_factorial(self.lookups), error)
    }
}

/// Running sums over panels.
#[derive(Default)]
struct Totals {
    losses: [Sum; 4],
    rarity: Sum,
    growth: [Sum; 2],
    survival: Survival,
    flown: Sum,
    /// True if a loss is not constant in a panel.
    varies: bool,
}

impl Totals {
    fn add(&mut self, mesh: &Mesh, panel: Panel<'_>, nodes: &Nodes, killing: f64) {
        let over = |f: &dyn Fn(&Outcome) -> f64| -> Vec<f64> {
            nodes.sampling.iter().zip(&nodes.outcome).map(|(s, o)| s * f(o)).collect()
        };
        for (k, sum) in (1..).zip(&mut self.losses) {
            let rates = over(&|o| o.mean_loss(k));
            self.varies |= rates.iter().any(|rate| *rate != rates[0]);
            sum.add(mesh.integral(panel, &rates));
            sum.add(killing * panel.span.length());
        }
        self.rarity.add(mesh.integral(panel, &over(&rarity)));
        self.rarity.add(killing * panel.span.length());
        for (k, sum) in [4, 8].into_iter().zip(&mut self.growth) {
            sum.add(mesh.integral(panel, &over(&|o| growth(o, k))));
            sum.add(f64::from(k - 1) * killing * panel.span.length());
        }
        let deaths: Vec<f64> = over(&|o| o.death).iter().map(|rate| rate + killing).collect();
        let survivals = over(&|o| o.survival);
        let rates = [nodes.sampling.as_slice(), &deaths, &survivals];
        self.survival.add(mesh.rule(), panel.span.length(), rates);
        self.flown.add(mesh.integral(panel, &nodes.sampling));
    }

    fn read(&self) -> Integrals {
        Integrals {
            losses: self.losses.map(|sum| sum.value()),
            rarity: self.rarity.value(),
            growth: self.growth.map(|sum| sum.value()),
            lookups: self.survival.factorial(),
            flown: self.flown.value(),
            is_stepwise: !self.varies,
        }
    }
}

/// `ρ ln(ρ/q) − ρ + 1` with `ρ = qW²`: the relative entropy, per collision, of the walks that carry
/// `E[X²]` against the walks that occur.
fn rarity(outcome: &Outcome) -> f64 {
    let square = outcome.weight * outcome.weight;
    let rho = outcome.survival * square;
    let entropy = if rho > 0.0 { rho * square.ln() } else { 0.0 };
    entropy - rho + 1.0
}

/// `E[W^k] − 1 + k(1 − E[W])`.
fn growth(outcome: &Outcome, k: i32) -> f64 {
    let mean = outcome.survival * outcome.weight;
    outcome.survival * outcome.weight.powi(k) - 1.0 + f64::from(k) * (1.0 - mean)
}
