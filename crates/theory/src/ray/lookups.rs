//! The distribution of the number of lookups of a product estimator.
//!
//! Let `K(s) = ∫₀ˢ (σ̂(1 − q) + c)`, with c the rate at which a walk also ends without a lookup, and
//! `A(s) = ∫₀ˢ σ̂ q`. The collisions that a particle survives are a Poisson process of rate `σ̂q`, independent of
//! the one that ends it:
//!
//! ```text
//! P(M = m) = e^{−K(S)} Pois(m; A(S)) + ∫ e^{−K} [σ̂(1 − q) Pois(m − 1; A) + c Pois(m; A)] dt
//! ```
//!
//! Derived from the superposition of Poisson processes; its factorial moments are those of [`super::survival`].

use super::mesh::Panel;
use super::product::{Integrals, Product};
use crate::Mesh;
use crate::prediction::count::{CountDistribution, LARGEST_MEAN, PoissonWindow};
use numeric::sum::Sum;

/// A panel with more survived collisions than this, or than half a standard deviation of those before,
/// is halved: `Pois(m; A)` is then smooth on it.
const COLLISIONS: f64 = 2.0;
/// Maximum probability of walks that are left out.
const RARE: f64 = 1e-18;

impl Product<'_> {
    /// Distribution of the number of lookups; `all` are the integrals over the whole of this estimator's own mesh.
    pub fn lookups(&self, mesh: &Mesh, all: &Integrals) -> CountDistribution {
        let distribution = all.count(mesh.relative_error());
        if !(self.with_distributions
            && distribution.pmf.is_empty()
            && distribution.mean <= LARGEST_MEAN)
        {
            return distribution;
        }
        let mut walk = PanelSum::default();
        for panel in mesh.panels() {
            if walk.alive() < RARE {
                break;
            }
            walk.pass(self, mesh, panel);
        }
        CountDistribution { pmf: walk.end(), ..distribution }
    }
}

/// State of the sum over panels.
#[derive(Default)]
struct PanelSum {
    deaths: Sum,
    survivals: Sum,
    pmf: Vec<f64>,
    window: PoissonWindow,
}

impl PanelSum {
    fn alive(&self) -> f64 {
        (-self.deaths.value()).exp()
    }

    /// Adds the walks that end on a panel.
    fn pass(&mut self, product: &Product<'_>, mesh: &Mesh, panel: Panel<'_>) {
        let nodes = product.nodes(panel);
        let pairs = || nodes.sampling.iter().zip(&nodes.outcome);
        let survivals: Vec<f64> = pairs().map(|(s, o)| s * o.survival).collect();
        let survived = mesh.integral(panel, &survivals);
        let middle = panel.span.middle();
        let maximum = COLLISIONS.max(0.5 * self.survivals.value().max(0.0).sqrt());
        if survived > maximum && panel.span.contains_inside(middle) {
            for span in panel.span.halves() {
                if self.alive() < RARE {
                    return;
                }
                let t = mesh.nodes(span);
                let extinction = mesh.medium().extinctions(&t);
                self.pass(product, mesh, Panel { span, t: &t, extinction: &extinction });
            }
            return;
        }
        let absorbed: Vec<f64> = pairs().map(|(s, o)| s * o.death).collect();
        let deaths: Vec<f64> = absorbed.iter().map(|rate| rate + product.killing).collect();
        let lost = mesh.integral(panel, &deaths);
        let alive = mesh.running(panel, &deaths).into_iter().map(|k| (-k).exp());
        let ending: Vec<f64> = alive.zip(&deaths).map(|(alive, rate)| alive * rate).collect();
        let sum = mesh.integral(panel, &ending);
        if sum > 0.0 {
            // The share that ends here is known exactly; the nodes only distribute it.
            let share = -(-lost).exp_m1() * self.alive() / sum;
            let before = mesh.running(panel, &survivals);
            let unit = share * panel.span.length();
            for (i, weight) in
                mesh.rule().weights.iter().enumerate().filter(|&(i, _)| deaths[i] > 0.0)
            {
                let ended = unit * weight * ending[i] / deaths[i];
                let mean = (self.survivals.value() + before[i]).max(0.0);
                for (rate, shift) in [(absorbed[i], 1), (product.killing, 0)] {
                    if rate > 0.0 {
                        self.window.add(&mut self.pmf, ended * rate, mean, shift);
                    }
                }
            }
        }
        self.deaths.add(lost);
        self.survivals.add(survived);
    }

    /// Adds the walks that reach the end of the support.
    fn end(mut self) -> Vec<f64> {
        let alive = self.alive();
        if alive >= RARE {
            self.window.add(&mut self.pmf, alive, self.survivals.value(), 0);
        }
        let mut rest = 0.0;
        while let Some(last) = self.pmf.last().filter(|&last| rest + last < 1e-15) {
            rest += last;
            self.pmf.pop();
        }
        self.pmf
    }
}
