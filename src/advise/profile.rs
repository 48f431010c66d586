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

use super::candidates::Candidate;
use super::row::Row;
use super::study::Study;
use theory::collisions::rules::{Single, Weight};
use theory::collisions::{Collisions, Rule};
use theory::prediction::search::{Goal, up};

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

/// The best σ̂ along a ray, in steps.
#[derive(Debug, Clone)]
pub struct SamplingProfile {
    /// Estimator.
    pub estimator: String,
    /// Ends of the steps.
    pub breaks: Vec<f64>,
    /// σ̂ in each, 1/length.
    pub values: Vec<f64>,
    /// Distances and |σ_t − σ_c| there.
    pub residual: Vec<[f64; 2]>,
    /// V·cost of the best constant σ̂ over that of the profile.
    pub over_constant: f64,
    /// V·cost of local majorants over that of the profile, if the estimator was tried with some.
    pub over_local: Option<f64>,
}

/// Returns the profile of a candidate with one free constant σ̂, on the first ray of a study, and the candidate with it.
/// It is compared with the rows of others.
pub fn of(
    study: &Study,
    rows: &[Row],
    row: &Row,
    rule: Collisions,
) -> Option<(SamplingProfile, Candidate)> {
    let (case, candidate) = (&study.cases[0], &study.candidates[row.candidate]);
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
    let residual = |t: f64| medium.extinction(t) - control.extinction(t);
    let inside = |i: usize| (i as f64 + 0.5) / PLACES as f64;
    let places = |step| (0..PLACES).map(|i| residual(place(step, inside(i)))).collect();
    // The setup is a fixed cost.
    let price = [row.score.cost - price.lookup * row.score.lookups, price.lookup];
    let steps = Steps { residual: (0..STEPS).map(places).collect(), width, price };
    let values: Vec<f64> = steps.best(rule, start)?.into_iter().map(up).collect();
    let own = steps.work(rule.rule(), &values);
    // Where one draw is enough, the advised constant is not that of the least V·cost.
    let of_constant = Goal::new(|x| steps.work(rule.rule(), &[x; STEPS]));
    let start = match rule {
        Collisions::Weight => steps.start(&[1.0; STEPS]),
        Collisions::Single(_) => start,
    };
    let (_, constant, _) = of_constant.best(start, 1)?;
    drop(of_constant);
    // The same walk with local majorants, at the same price.
    let is_local = |other: &&Row| {
        [&other.estimator, &other.control] == [&row.estimator, &row.control]
            && case.scenario.is_local(other.candidate)
    };
    let work = |row: &Row| row.score.variance * (price[0] + price[1] * row.score.lookups);
    let local = rows.iter().filter(is_local).map(work).reduce(f64::min);
    let breaks: Vec<f64> = (0..=STEPS).map(|step| place(step, 0.0)).collect();
    let residual = (0..STEPS * 4).map(|i| {
        let t = place(i / 4, (i % 4) as f64 / 4.0 + 0.125);
        [t, residual(t).abs()]
    });
    let profile = SamplingProfile {
        estimator: row.estimator.clone(),
        over_constant: constant / own,
        over_local: local.map(|local| local / own),
        residual: residual.collect(),
        breaks,
        values,
    };
    let candidate = candidate.with_profile(&profile.breaks, &profile.values);
    Some((profile, candidate))
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

/// Contribution of a step to V·cost.
#[derive(Clone, Copy)]
struct StepShare {
    /// `∫ σ̂ E[(1 − W)²]` over the step; infinite where the rule does not exist.
    loss: f64,
    /// Probability that a walk which begins the step survives it.
    survival: f64,
    /// Expected lookups in the step of such a walk.
    lookups: f64,
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
        let minimum = MIN_SHARE * roots.iter().copied().fold(0.0, f64::max);
        roots.into_iter().map(|root| root.max(minimum)).collect()
    }

    /// `κ` times the root mean square of the residual in each step.
    fn of_weights(&self) -> Option<Vec<f64>> {
        let roots = self.roots();
        let scaled = |kappa: f64| roots.iter().map(|root| kappa * root).collect::<Vec<f64>>();
        let goal = Goal::new(|kappa| self.work(&Weight, &scaled(kappa)));
        goal.best(self.start(&roots), 1).map(|(kappa, ..)| scaled(kappa))
    }

    /// κ for which a walk through `κ · profile` costs as much as what is fixed, and a lookup.
    fn start(&self, profile: &[f64]) -> f64 {
        let walk: f64 = profile.iter().map(|value| self.price[1] * self.width * value).sum();
        (self.price[0] + self.price[1]) / walk
    }

    /// Improves the steps one by one.
    fn of_particle(&self, rule: &Single, start: f64) -> Vec<f64> {
        let (minimum, roots) = (MIN_SHARE * start, self.roots());
        let mut sampling = vec![start; self.residual.len()];
        let mut shares: Vec<StepShare> =
            (0..sampling.len()).map(|step| self.share(rule, step, start)).collect();
        let mut last = self.of(shares.iter().copied());
        for _ in 0..PASSES {
            for step in 0..sampling.len() {
                let goal = Goal::new(|here| {
                    let own = self.share(rule, step, here);
                    let all = shares.iter().enumerate();
                    self.of(all.map(|(i, &share)| if i == step { own } else { share }))
                });
                // A particle that collides for real and one that seldom does are two minima.
                let starts =
                    [sampling[step], roots[step]].map(|start| goal.least(start, 1, f64::INFINITY));
                let result =
                    starts.into_iter().flatten().min_by(|a, b| a.value.total_cmp(&b.value));
                drop(goal);
                sampling[step] = result.map_or(sampling[step], |result| result.x).max(minimum);
                shares[step] = self.share(rule, step, sampling[step]);
            }
            let next = self.of(shares.iter().copied());
            if next >= last * (1.0 - GAIN) {
                break;
            }
            last = next;
        }
        sampling
    }

    /// Relative variance times cost of a σ̂ in steps.
    pub fn work(&self, rule: &dyn Rule, sampling: &[f64]) -> f64 {
        self.of(sampling.iter().enumerate().map(|(step, &here)| self.share(rule, step, here)))
    }

    /// `(e^J − 1)(a + b C)`.
    fn of(&self, shares: impl Iterator<Item = StepShare>) -> f64 {
        let (mut loss, mut lookups, mut alive) = (0.0, 0.0, 1.0);
        for share in shares {
            loss += share.loss;
            lookups += alive * share.lookups;
            alive *= share.survival;
        }
        f64::exp_m1(loss) * (self.price[0] + self.price[1] * lookups)
    }

    /// Returns the contribution of a step.
    fn share(&self, rule: &dyn Rule, step: usize, sampling: f64) -> StepShare {
        let share = self.width / self.residual[step].len() as f64;
        let [loss, death] = self.residual[step].iter().fold([0.0; 2], |[j, d], residual| {
            let ratio = residual / sampling;
            let outcome = rule.outcome(ratio);
            // Unbiased: q W = 1 − r. Beyond the domain of a rule it is not.
            let is_fair = (outcome.survival * outcome.weight - (1.0 - ratio)).abs()
                <= 1e-9 * (1.0 + ratio.abs());
            let loss = if is_fair { sampling * outcome.mean_loss(2) } else { f64::INFINITY };
            [j + share * loss, d + share * sampling * outcome.death]
        });
        // Mean share of the step that is flown.
        let flown = if death.abs() < 1e-8 { 1.0 - 0.5 * death } else { -(-death).exp_m1() / death };
        StepShare { loss, survival: (-death).exp(), lookups: sampling * self.width * flown }
    }
}
