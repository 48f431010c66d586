//! V·cost of the candidates over the rays of a medium, by exact theory.

use super::candidates::{self, family};
use super::costs::{Price, Prices};
use super::search::{self, Kind};
use super::{Request, Target};
use crate::case::sweep::{Variation, What};
use crate::case::{Case, CaseError};
use estimators::Refusal;
use media::Body;
use numeric::sum::Sum;
use theory::prediction::CERTAIN;
use theory::{Channel, Prediction, parallel};

/// Number of rays on which settings are searched; the answer is then evaluated on all of them.
const PROBES: usize = 6;
/// Number of times that a setting of the probes is raised until it is allowed on all rays, and the factor.
const RAISES: i32 = 36;
const RAISE: f64 = 1.02;
/// Relative difference of a mean from the truth that is a bias.
const BIAS: f64 = 1e-9;

/// Factor on the least σ̂ of an estimator at which it is refused.
const BELOW: f64 = 0.98;

/// Candidates on the rays of a medium.
pub struct Study {
    /// Candidates, as entries of a list of estimators.
    pub texts: Vec<String>,
    /// One case for each ray, with the candidates in its list.
    pub cases: Vec<Case>,
    /// `(T/T̄)²` of each ray: errors are relative to the mean transmittance T̄ of all rays.
    weights: Vec<f64>,
    /// Rays on which settings are searched.
    probes: Vec<usize>,
    /// Price of each candidate; `None` where it cannot be drawn.
    pub prices: Vec<Option<Price>>,
    /// Factor by which majorants exceed the maximum.
    looseness: f64,
    /// Goal of the draws.
    target: Target,
}

/// Variance and cost of a candidate at one σ̂.
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    /// Variance of a draw relative to the squared mean transmittance, mean over the rays.
    pub variance: f64,
    /// Relative variance times cost, mean over the rays: the cost at a relative error of 1.
    pub work: f64,
    /// Relative variance times cost of each ray.
    pub works: Vec<f64>,
    /// Cost of a draw with its share of the setup, mean over the rays.
    pub cost: f64,
    /// Expected lookups of a draw, mean over the rays.
    pub lookups: f64,
    /// Setup lookups of a ray, mean over the rays.
    pub setup_lookups: f64,
    /// Largest kurtosis of a draw on a ray; `None` where theory has none or the variance is 0.
    pub kurtosis: Option<f64>,
    /// True if theory only bounds the variance of some ray.
    pub is_bound: bool,
}

impl Score {
    /// Cost to an error, of one draw at least, or the squared error within a budget; infinite beyond it.
    pub fn goal(&self, target: Target) -> f64 {
        match target {
            Target::Error(error) => (self.work / (error * error)).max(self.cost),
            Target::Budget(budget) if self.cost <= budget => self.work / budget,
            Target::Budget(_) => f64::INFINITY,
        }
    }
}

/// The best setting of a candidate.
#[derive(Debug, Clone)]
pub struct Best {
    /// Index of the candidate.
    pub candidate: usize,
    /// The constant σ̂ or the factor on σ̂; `None` where it is not free.
    pub setting: Option<(What, f64)>,
    /// Cost to the goal on the probes, or the squared error within a budget.
    pub goal: f64,
    /// Kind of the setting.
    pub kind: Kind,
}

impl Study {
    /// Reads the candidates on all rays, and measures their prices if they are to be measured.
    ///
    /// # Errors
    ///
    /// Mistakes in the case.
    pub fn new(
        base: &Case,
        rays: &[Body],
        texts: Vec<String>,
        request: &Request,
    ) -> Result<Self, CaseError> {
        let cases = parallel::map(rays, |ray| candidates::case(base, ray, &texts));
        let cases: Vec<Case> = cases.into_iter().collect::<Result<_, _>>()?;
        let weights = weights(base, &cases);
        let probes = cases.len().min(PROBES);
        let probes = (0..probes).map(|i| (2 * i + 1) * cases.len() / (2 * probes)).collect();
        let mut study = Self {
            texts,
            cases,
            weights,
            probes,
            prices: Vec::new(),
            looseness: request.looseness,
            target: request.target,
        };
        let mut prices = Prices::open(&request.costs, &base.spec);
        study.prices = (0..study.texts.len())
            .map(|candidate| {
                let text = &study.texts[candidate];
                // The numbers of a profile depend on the prices.
                let is_profile = text.contains("piecewise-constant");
                let key = if is_profile { family(text) } else { text.clone() };
                let scale = study.scale(candidate);
                let at = |factor| study.what(candidate).map(|what| (what, scale * factor));
                let case = &study.cases[study.probes[study.probes.len() / 2]];
                prices.of(&key, case, (candidate, [at(1.0), at(4.0)]))
            })
            .collect();
        prices.keep();
        Ok(study)
    }

    /// Returns the free quantity of a candidate.
    fn what(&self, candidate: usize) -> Option<What> {
        let scenario = &self.cases[0].scenario;
        let is_free = |what: &What| scenario.depends_on(candidate, *what);
        let is_given = self.texts[candidate].contains("piecewise-constant");
        [What::Sampling, What::SamplingScale].into_iter().find(is_free).filter(|_| !is_given)
    }

    /// Returns the natural scale of the free quantity: the largest |σ_t − σ_c| of all rays, or 1.
    fn scale(&self, candidate: usize) -> f64 {
        if self.what(candidate) != Some(What::Sampling) {
            return 1.0;
        }
        let scales = parallel::map(&self.cases, |case| {
            case.at(None).map_or(0.0, |at| at.natural_scale(candidate))
        });
        scales.into_iter().fold(0.0, f64::max)
    }

    /// Predicts a candidate on a ray; `None` if it is refused there.
    pub fn predict(&self, candidate: usize, setting: Variation, ray: usize) -> Option<Prediction> {
        let case = &self.cases[ray];
        case.at(setting).ok()?.predict(candidate, None, case.pilots(1, candidate))
    }

    /// Returns the score of a candidate over some rays; `None` if it is refused on one of them, or if theory does not
    /// know its variance or cost.
    pub fn score(&self, candidate: usize, setting: Variation, rays: &[usize]) -> Option<Score> {
        let price = self.prices[candidate]?;
        let [mut variance, mut work, mut cost, mut lookups, mut setup] = [Sum::default(); 5];
        let (mut works, mut kurtosis, mut is_bound) = (Vec::new(), None, false);
        for &ray in rays {
            let prediction = self.predict(candidate, setting, ray)?;
            let draws_per_ray = self.cases[ray].draws_per_ray;
            let own = price.draw + price.lookup * prediction.cost(draws_per_ray)?;
            let channels = &prediction.channels;
            let mut relative = 0.0;
            for channel in channels {
                relative += self.weights[ray] * relative_variance(channel)? / channels.len() as f64;
                is_bound |= channel.moments.is_none();
                let own = channel.moments.and_then(|moments| moments.kurtosis());
                kurtosis = [kurtosis, own].into_iter().flatten().reduce(f64::max);
            }
            works.push(relative * own);
            variance.add(relative);
            work.add(relative * own);
            cost.add(own);
            lookups.add(prediction.lookups.as_ref()?.mean);
            setup.add(prediction.setup_lookups as f64);
        }
        let [variance, work, cost, lookups, setup_lookups] =
            [variance, work, cost, lookups, setup].map(|sum| sum.value() / rays.len() as f64);
        let score =
            Score { variance, work, works, cost, lookups, setup_lookups, kurtosis, is_bound };
        score.work.is_finite().then_some(score)
    }

    /// Returns the goal on the probes as a function of the free quantity; infinite where the candidate is refused.
    pub fn goal(&self, candidate: usize, what: Option<What>) -> impl Fn(f64) -> f64 + '_ {
        move |x| {
            let score = self.score(candidate, what.map(|what| (what, x)), &self.probes);
            score.map_or(f64::INFINITY, |score| score.goal(self.target))
        }
    }

    /// Searches the best setting of a candidate; `None` if it is refused everywhere.
    pub fn best(&self, candidate: usize) -> Option<Best> {
        self.prices[candidate]?;
        let what = self.what(candidate);
        let f = self.goal(candidate, what);
        let Some(what) = what else {
            let best = Best { candidate, setting: None, goal: f(1.0), kind: Kind::Fixed };
            return Some(best).filter(|best| best.goal.is_finite());
        };
        let (mut x, mut goal, kind) = search::best(self.scale(candidate), &f)?;
        // An estimator that is refused just below needs a majorant.
        if self.looseness > 1.0 && f(x * BELOW).is_infinite() {
            x *= self.looseness;
            goal = f(x);
        }
        Some(Best { candidate, setting: Some((what, x)), goal, kind })
    }

    /// Returns a setting that is allowed on all rays, not only on the probes, with its score; `None` if no setting up to
    /// twice the given one is allowed.
    pub fn on_all(&self, best: &Best) -> Option<(Best, Score)> {
        let rays: Vec<usize> = (0..self.cases.len()).collect();
        let tries = if best.setting.is_some() { RAISES } else { 1 };
        (0..tries).find_map(|i| {
            let factor = RAISE.powi(i);
            let setting = best.setting.map(|(what, x)| (what, search::up(x * factor)));
            let score = self.score(best.candidate, setting, &rays)?;
            Some((Best { setting, ..best.clone() }, score))
        })
    }

    /// Returns the best setting of each family of candidates.
    pub fn best_of_families(&self) -> Vec<Best> {
        let all = parallel::range(self.texts.len(), |candidate| self.best(candidate));
        let mut kept: Vec<Best> = Vec::new();
        for best in all.into_iter().flatten() {
            let of = |best: &Best| family(&self.texts[best.candidate]);
            match kept.iter_mut().find(|other| of(other) == of(&best)) {
                Some(other) if best.goal < other.goal => *other = best,
                Some(_) => {}
                None => kept.push(best),
            }
        }
        kept
    }

    /// Returns the reason why a candidate is refused at its natural scale on the first ray; `None` if it is not.
    pub fn refusal(&self, candidate: usize) -> Option<Refusal> {
        let setting = self.what(candidate).map(|what| (what, self.scale(candidate)));
        let case = &self.cases[0];
        let prepared =
            case.at(setting).and_then(|at| at.prepare(candidate, case.pilots(1, candidate)));
        prepared.err()
    }

    /// Returns whether a candidate exists on all probes at a setting: whether no inequality refuses it.
    pub fn exists(&self, candidate: usize, setting: Variation) -> bool {
        let is_refused = |&ray: &usize| {
            let case = &self.cases[ray];
            let prepared = || case.at(setting)?.prepare(candidate, case.pilots(1, candidate));
            self.predict(candidate, setting, ray).is_none()
                && matches!(prepared(), Err(Refusal::Inequality { .. }))
        };
        !self.probes.iter().any(is_refused)
    }
}

/// Returns the variance of a channel relative to its squared mean, or a bound on it; `None` where theory has neither,
/// and of a biased estimator.
fn relative_variance(channel: &Channel) -> Option<f64> {
    let truth = channel.truth.value;
    let off = (channel.mean.value - truth).abs();
    if off > BIAS * truth.abs() + channel.mean.error + channel.truth.error {
        return None;
    }
    match channel.moments {
        Some(moments) if moments.relative[0] <= CERTAIN => Some(0.0),
        Some(_) => Some(channel.resolved_moments()?.variance() / (truth * truth)),
        None => Some(channel.variance_bound? / (truth * truth)),
    }
}

/// Returns `(T/T̄)²` of each ray; 1 for problems other than transmittance, and for a single ray.
fn weights(base: &Case, cases: &[Case]) -> Vec<f64> {
    let depth = |case: &Case| {
        let medium = &case.scenario.media()[0];
        medium.optical_depth(medium.support()).value
    };
    let all: Vec<f64> = cases.iter().map(|case| (-depth(case)).exp()).collect();
    let mean = all.iter().sum::<f64>() / all.len() as f64;
    if base.problem != "transmittance" || cases.len() == 1 || mean == 0.0 {
        return vec![1.0; cases.len()];
    }
    all.into_iter().map(|t| (t / mean).powi(2)).collect()
}
