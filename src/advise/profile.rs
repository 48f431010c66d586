//! σ̂(t) with the smallest V·cost, in equal steps along a ray.
//!
//! ```text
//! V/T² = e^J − 1,  J = ∫ σ̂ E[(1 − W)²] dt,   cost = a + b C,  C = ∫ σ̂ e^{−K} dt,  K(t) = ∫₀ᵗ σ̂(1 − q)
//! ```
//!
//! A weight at every collision has `J = ∫ρ²/σ̂` and `C = ∫σ̂`, ρ the residual. A variation of σ̂ leaves V·cost as it is
//! only if `σ̂(t) = κ|ρ(t)|`: in steps, κ times the root mean square of the residual in each. V·cost then falls to the
//! limit `b T² (∫|ρ|)²` as κ grows, whatever the fixed cost. A constant σ̂ has the limit `b T² ℓ ∫ρ²`, which is never
//! less (Cauchy and Schwarz).
//!
//! The single particle may end, so that σ̂ at t also changes the cost of everything behind t. With `R(t)` the lookups
//! behind t, the best σ̂(t) minimises `E j(σ̂) + b/cost (σ̂ e^{−K} − d(σ̂) R)` (Pontryagin's principle). Here
//! `E = e^J/(e^J − 1)`, `j = σ̂ E[(1 − W)²]` and `d = σ̂(1 − q)`. Steps are improved one by one until nothing is gained.

use super::candidates::{Collisions, RECIPE};
use super::search::{Goal, up};
use super::study::Study;
use super::{Profile, Row};
use numeric::digits::number;
use theory::collisions::Rule;
use theory::collisions::rules::{Single, Weight};

/// Steps of a profile.
pub const STEPS: usize = 64;
/// Places in each step at which the residual is looked up.
pub const PLACES: usize = 32;
/// Least σ̂ of a step, relative to the step with the largest: a residual may hide between the places.
const MIN_SHARE: f64 = 1e-3;
/// Maximum number of passes over the steps.
const PASSES: usize = 60;
/// Relative gain of a pass that ends the search.
const GAIN: f64 = 1e-7;

/// Returns the profile of a candidate with one free constant σ̂, on the first ray of a study, and the candidate with it.
/// It is compared with the rows of others.
pub fn of(study: &Study, rows: &[Row], row: &Row, rule: Collisions) -> Option<(Profile, String)> {
    let (case, text) = (&study.cases[0], &study.texts[row.candidate]);
    let (price, (_, start)) = (study.prices[row.candidate]?, row.setting?);
    let medium = &case.scenario.media()[0];
    let control = case.at(None).ok()?.control(row.candidate, case.pilots(1, row.candidate))?;
    let support = medium.support();
    // A ray that misses the medium has no steps.
    if support.is_empty() {
        return None;
    }
    let width = support.length() / STEPS as f64;
    let place = |step: usize, share: f64| support.from + width * (step as f64 + share);
    let inside = |place_in_step: usize| (place_in_step as f64 + 0.5) / PLACES as f64;
    let residual = |t: f64| medium.extinction(t) - control.extinction(t);
    let places = |step| (0..PLACES).map(|i| residual(place(step, inside(i)))).collect();
    // The setup is a fixed cost.
    let price = [row.score.cost - price.lookup * row.score.lookups, price.lookup];
    let steps = Steps { residual: (0..STEPS).map(places).collect(), width, price };
    let values: Vec<f64> = steps.best(rule, start)?.into_iter().map(up).collect();
    let own = steps.work(rule.rule(), &values);
    // The same walk with local majorants, at the same price.
    let is_local = |other: &&Row| {
        let other = &study.texts[other.candidate];
        let plain = other.split("sampling.").next().unwrap_or_default();
        other.contains("local-majorants")
            && text.starts_with(plain.trim_end_matches([' ', '{', ',']))
    };
    let work = |row: &Row| row.score.variance * (price[0] + price[1] * row.score.lookups);
    let local = rows.iter().filter(is_local).map(work).reduce(f64::min);
    let mut breaks: Vec<f64> = (0..STEPS).map(|step| place(step, 0.0)).collect();
    breaks.push(support.to);
    let list = |numbers: &[f64]| numbers.iter().map(|&x| number(x)).collect::<Vec<_>>().join(", ");
    let sampling =
        format!("{RECIPE} = {{ breaks = [{}], values = [{}] }}", list(&breaks), list(&values));
    let (name, settings) = text.split_once(" = ")?;
    let settings = settings.trim_start_matches('{').trim_end_matches('}').trim();
    let comma = if settings.is_empty() { "" } else { ", " };
    let residual = (0..STEPS * 4).map(|i| {
        let t = place(i / 4, (i % 4) as f64 / 4.0 + 0.125);
        [t, residual(t).abs()]
    });
    let profile = Profile {
        estimator: row.estimator.clone(),
        over_constant: steps.work(rule.rule(), &[start; STEPS]) / own,
        over_local: local.map(|local| local / own),
        residual: residual.collect(),
        breaks,
        values,
    };
    Some((profile, format!("{name} = {{ {settings}{comma}{sampling} }}")))
}

/// The residual in the steps of a ray, and what a walk costs.
pub struct Steps {
    /// The residual at the places of each step, 1/length.
    pub residual: Vec<Vec<f64>>,
    /// Length of a step.
    pub width: f64,
    /// Fixed cost of a draw, and cost of a lookup.
    pub price: [f64; 2],
}

impl Steps {
    /// Returns the best σ̂ of each step.
    pub fn best(&self, collisions: Collisions, start: f64) -> Option<Vec<f64>> {
        match collisions {
            Collisions::Weight => self.of_weights(),
            Collisions::Single(rule) => Some(self.of_particle(&rule, start)),
        }
    }

    /// Returns the root mean square of the residual in each step, or a small share of the largest.
    fn roots(&self) -> Vec<f64> {
        let square = |step: &Vec<f64>| step.iter().map(|x| x * x).sum::<f64>() / step.len() as f64;
        let roots: Vec<f64> = self.residual.iter().map(|step| square(step).sqrt()).collect();
        let least = MIN_SHARE * roots.iter().copied().fold(0.0, f64::max);
        roots.into_iter().map(|root| root.max(least)).collect()
    }

    /// `κ` times the root mean square of the residual in each step.
    fn of_weights(&self) -> Option<Vec<f64>> {
        let roots = self.roots();
        let scaled = |kappa: f64| roots.iter().map(|root| kappa * root).collect::<Vec<f64>>();
        let goal = Goal::new(|kappa| self.work(&Weight, &scaled(kappa)));
        // Where walks cost as much as what is fixed.
        let walk: f64 = roots.iter().map(|root| self.price[1] * self.width * root).sum();
        let start = (self.price[0] + self.price[1]) / walk;
        goal.best(start, 1).map(|(kappa, ..)| scaled(kappa))
    }

    /// Improves the steps one by one.
    fn of_particle(&self, rule: &Single, start: f64) -> Vec<f64> {
        let (least, roots) = (MIN_SHARE * start, self.roots());
        let mut sampling = vec![start; self.residual.len()];
        let mut last = self.work(rule, &sampling);
        for _ in 0..PASSES {
            let all: Vec<[f64; 2]> =
                (0..sampling.len()).map(|i| self.rates(rule, i, sampling[i])).collect();
            let behind = self.behind(&all, &sampling);
            let mut loss: f64 = all.iter().map(|rates| rates[0]).sum();
            let (mut alive, mut before) = (1.0, 0.0);
            for i in 0..sampling.len() {
                let others = loss - self.rates(rule, i, sampling[i])[0];
                let goal = Goal::new(|here: f64| {
                    let [j, d] = self.rates(rule, i, here);
                    let lookups = here * self.width * survived(d) + (-d).exp() * behind[i + 1];
                    self.of(others + j, before + alive * lookups)
                });
                // A particle that collides for real and one that seldom does are two minima.
                let starts = [sampling[i], roots[i]].map(|start| goal.least(start, 1));
                let found = starts.into_iter().flatten().min_by(|a, b| a.1.total_cmp(&b.1));
                drop(goal);
                sampling[i] = found.map_or(sampling[i], |(x, ..)| x).max(least);
                let [j, d] = self.rates(rule, i, sampling[i]);
                loss = others + j;
                before += alive * sampling[i] * self.width * survived(d);
                alive *= (-d).exp();
            }
            let next = self.work(rule, &sampling);
            if next >= last * (1.0 - GAIN) {
                break;
            }
            last = next;
        }
        sampling
    }

    /// Relative variance times cost of a σ̂ in steps.
    pub fn work(&self, rule: &dyn Rule, sampling: &[f64]) -> f64 {
        let all: Vec<[f64; 2]> =
            (0..sampling.len()).map(|i| self.rates(rule, i, sampling[i])).collect();
        self.of(all.iter().map(|rates| rates[0]).sum(), self.behind(&all, sampling)[0])
    }

    /// `(e^J − 1)(a + b C)`.
    fn of(&self, loss: f64, lookups: f64) -> f64 {
        loss.exp_m1() * (self.price[0] + self.price[1] * lookups)
    }

    /// `∫ σ̂ E[(1 − W)²]` and `∫ σ̂(1 − q)` over a step; infinite where the rule does not exist.
    fn rates(&self, rule: &dyn Rule, step: usize, sampling: f64) -> [f64; 2] {
        let share = self.width / self.residual[step].len() as f64;
        self.residual[step].iter().fold([0.0; 2], |[j, d], residual| {
            let ratio = residual / sampling;
            let outcome = rule.outcome(ratio);
            // Unbiased: q W = 1 − r. Beyond the domain of a rule it is not.
            let is_fair = (outcome.survival * outcome.weight - (1.0 - ratio)).abs()
                <= 1e-9 * (1.0 + ratio.abs());
            let loss = if is_fair { sampling * outcome.mean_loss(2) } else { f64::INFINITY };
            [j + share * loss, d + share * sampling * outcome.death]
        })
    }

    /// Expected lookups from each step on, of a walk that is alive there.
    fn behind(&self, all: &[[f64; 2]], sampling: &[f64]) -> Vec<f64> {
        let mut behind = vec![0.0; sampling.len() + 1];
        for i in (0..sampling.len()).rev() {
            let death = all[i][1];
            behind[i] = sampling[i] * self.width * survived(death) + (-death).exp() * behind[i + 1];
        }
        behind
    }
}

/// `(1 − e^{−d})/d`: mean share of a step that is flown.
fn survived(death: f64) -> f64 {
    if death.abs() < 1e-8 { 1.0 - 0.5 * death } else { -(-death).exp_m1() / death }
}
