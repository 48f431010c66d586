//! Distribution of the lookups of a draw, mixed over heroes.

use super::{Spectrum, Tracker};
use crate::prediction::raw;
use crate::ray::survival::Survival;
use crate::{CountDistribution, Mesh, colours};

impl Spectrum {
    /// Distribution of the lookups of a draw, mixed over heroes.
    pub(super) fn lookups(&self) -> CountDistribution {
        let flown = |channel: usize| self.majorants[channel] * self.length();
        let own = |channel: usize, delta: bool| {
            if delta {
                let majorant = self.majorants[channel];
                self.survived(majorant, &|n| n[channel] / majorant)
            } else {
                [1, 2, 3, 4].map(|k| flown(channel).powi(k))
            }
        };
        let factorial: [f64; 4] = match self.tracker {
            Tracker::Independent { delta } | Tracker::Hero { delta } | Tracker::Mis { delta } => {
                let is_same = (1..self.channels()).all(|c| self.majorants[c] == self.majorants[0]);
                if !delta && is_same {
                    return CountDistribution::poisson(flown(0));
                }
                let heroes = self.hero.iter().enumerate();
                let each = heroes.map(|(channel, &weight)| (weight, own(channel, delta)));
                colours::mixed(each).unwrap_or_default()
            }
            Tracker::InTurn { delta: false } => {
                return CountDistribution::poisson((0..self.channels()).map(flown).sum());
            }
            Tracker::InTurn { delta: true } => {
                (0..self.channels()).fold([0.0; 4], |sum, channel| added(sum, own(channel, true)))
            }
            Tracker::Tracking(probability) => {
                let majorant = self.majorants[0];
                self.survived(majorant, &|n| {
                    let shares: Vec<f64> = n.iter().map(|n| n / majorant).collect();
                    probability.of_null(&shares)
                })
            }
        };
        CountDistribution::of_raw(0.0, raw::of_factorial(factorial), self.mesh.relative_error())
    }

    fn survived(&self, rate: f64, survival: &dyn Fn(&[f64]) -> f64) -> [f64; 4] {
        survived(&self.mesh, rate, &|node| {
            let n: Vec<f64> = self.nulls.iter().map(|nulls| nulls[node]).collect();
            survival(&n)
        })
    }
}

/// Factorial moments of the collisions of a walk that flies at a constant rate and survives each with a probability,
/// given at every node.
pub fn survived(mesh: &Mesh, rate: f64, survival: &dyn Fn(usize) -> f64) -> [f64; 4] {
    let mut result = Survival::default();
    for (panel, nodes) in mesh.numbered() {
        let q: Vec<f64> = nodes.map(|i| rate * survival(i)).collect();
        let lost: Vec<f64> = q.iter().map(|q| rate - q).collect();
        let rates = vec![rate; q.len()];
        result.add(mesh.rule(), panel.span.length(), [&rates, &lost, &q]);
    }
    result.factorial()
}

/// Factorial moments of the sum of two independent numbers.
fn added(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    let [a, b] = [a, b].map(|f| [1.0, f[0], f[1], f[2], f[3]]);
    let sum = raw::added(a, b);
    std::array::from_fn(|k| sum[k + 1])
}
