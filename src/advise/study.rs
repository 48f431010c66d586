//! V·cost of the candidates over the rays of a medium, by exact theory, and the best setting of each family.

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::AdviceRequest;
use super::candidates::{self, Candidate};
use super::costs::{Price, Prices};
use super::score::{CandidateScore, relative_variance, weights};
use crate::case::sweep::{SweptQuantity, Variation};
use crate::case::{Case, CaseError};
use estimators::Refusal;
use media::Body;
use theory::collisions::Collisions;
use theory::prediction::search::{ABOVE_LIMIT, BEYOND, Goal, Least, PlaceKind, UNKNOWN, up};
use theory::{Moments, Prediction, parallel};

/// Number of rays on which settings are searched; the answer is then evaluated on all of them.
const PROBES: usize = 6;
/// Number of seeds of pilot rays over which a learned σ̂ of a single ray is averaged.
const SEEDS: u64 = 4;
/// Factors on the setting of the probes, of which the first is taken that is allowed on all rays.
const RAISES: [f64; 6] = [1.0, 1.002, 1.02, 1.1, 1.4, 2.0];
/// Factor on the value of the first member of a family beyond which another one is not searched to the end.
const BEHIND: f64 = 1.5;
/// Steps of a factor of two on each side of a constant σ̂ that are tried first: a particle that collides for real and one
/// that seldom does are two minima.
const REACH: i32 = 3;

/// Free quantity of a candidate.
#[derive(Debug, Clone, Copy)]
struct Free {
    what: SweptQuantity,
    /// The largest |σ_t − σ_c| of all rays, or 1 for a factor.
    scale: f64,
    /// Ray with that, if it is no probe: a σ̂ that exists there exists on most others.
    ray: Option<usize>,
}

/// Index of a candidate, with its constant σ̂ or the factor on σ̂; `None` where it is not free.
pub type Setting = (usize, Variation);

/// Candidates on the rays of a medium.
pub struct Study<'a> {
    /// Question.
    pub request: &'a AdviceRequest,
    /// Candidates.
    pub candidates: Vec<Candidate>,
    /// One case for each ray, with the candidates in its list.
    pub cases: Vec<Case>,
    /// Price of each candidate; `None` where it cannot be drawn.
    pub prices: Vec<Option<Price>>,
    /// Cost of a lookup of a setup: the median of those of draws.
    setup_lookup: f64,
    /// `(T/T̄)²` of each ray: errors are relative to the mean transmittance T̄ of all rays.
    weights: Vec<f64>,
    /// Rays on which settings are searched.
    probes: Vec<usize>,
    free: Vec<Option<Free>>,
    /// Predictions at the natural scale, by candidate, ray and seed, of which others are multiples.
    at_scale: Mutex<BTreeMap<(usize, usize, u64), Option<Prediction>>>,
}

/// The best setting of a family of candidates.
pub struct Best<'a> {
    /// Index of the candidate.
    pub candidate: usize,
    /// The constant σ̂ or the factor on σ̂; `None` where it is not free.
    pub setting: Variation,
    /// Cost to the goal on the probes, or the squared error within a budget.
    pub value: f64,
    /// Kind of the setting.
    pub kind: PlaceKind,
    /// Cost to the goal on the probes as a function of the free quantity.
    pub goal: Goal<'a>,
}

impl<'a> Study<'a> {
    /// Reads the candidates on all rays, and measures their prices if they are to be measured.
    ///
    /// # Errors
    ///
    /// Mistakes in the case.
    pub fn new(
        base: &Case,
        rays: &[Body],
        candidates: Vec<Candidate>,
        request: &'a AdviceRequest,
        market: &mut Prices,
    ) -> Result<Self, CaseError> {
        let spec = candidates::replaced(&base.spec, &candidates);
        let cases = parallel::map(rays, |ray| Case::of_body(&spec, ray));
        let cases: Vec<Case> = cases.into_iter().collect::<Result<_, _>>()?;
        let probes = cases.len().min(PROBES);
        let probe = |i: usize| (2 * i + 1) * cases.len() / (2 * probes);
        let probes: Vec<usize> = (0..probes).map(probe).collect();
        let (weights, free) = (weights(base, &cases), free(&cases, &probes, &candidates));
        let case = &cases[cases.len() / 2];
        // Walks of at least one flight or so: shorter ones say little about a lookup.
        let length = case.scenario.media()[0].support().length();
        let begin = |free: Free| match free.what {
            SweptQuantity::Sampling if length > 0.0 && length.is_finite() => {
                free.scale.max(1.0 / length)
            }
            _ => free.scale,
        };
        let price = |(candidate, own): (usize, &Candidate)| {
            let at = |factor| free[candidate].map(|free: Free| (free.what, begin(free) * factor));
            market.of(own.price_key(), case, (candidate, [at(1.0), at(4.0)]))
        };
        let prices: Vec<Option<Price>> = candidates.iter().enumerate().map(price).collect();
        let mut lookups: Vec<f64> = prices.iter().flatten().map(|price| price.lookup).collect();
        lookups.retain(|&lookup| lookup > 0.0);
        lookups.sort_by(f64::total_cmp);
        let setup_lookup = lookups.get(lookups.len() / 2).copied().unwrap_or(0.0);
        let at_scale = Mutex::default();
        Ok(Self {
            request,
            candidates,
            cases,
            prices,
            setup_lookup,
            weights,
            probes,
            free,
            at_scale,
        })
    }

    fn collisions(&self, candidate: usize) -> Option<Collisions> {
        self.cases[0].scenario.collisions(candidate)
    }

    /// Returns whether a candidate learns its σ̂ by lookups at random places.
    pub fn learns(&self, candidate: usize) -> bool {
        self.cases[0].scenario.learns(candidate)
    }

    /// Returns the rule of a product estimator with one free constant σ̂; `None` for other candidates.
    pub fn rule(&self, candidate: usize) -> Option<Collisions> {
        let is_constant = self.free[candidate]?.what == SweptQuantity::Sampling;
        self.collisions(candidate).filter(|_| is_constant)
    }

    /// Predicts a candidate on a ray, for a seed of its pilot rays; `None` if it is refused there.
    fn predict(&self, (candidate, at): Setting, (ray, seed): (usize, u64)) -> Option<Prediction> {
        let case = &self.cases[ray];
        case.at(at).ok()?.predict(candidate, None, case.pilots(seed, candidate))
    }

    /// Estimates variance and lookups of a candidate on a ray, for searches: with a weight at every collision, without new
    /// integrals.
    fn estimate(&self, (candidate, at): Setting, (ray, seed): (usize, u64)) -> Option<Prediction> {
        let is_weight = self.collisions(candidate) == Some(Collisions::Weight);
        let free = self.free[candidate].filter(|_| is_weight);
        let case = &self.cases[ray];
        let estimate = |at| case.at(at).ok()?.estimate(candidate, case.pilots(seed, candidate));
        let Some((Free { what, scale, .. }, (_, x))) = free.zip(at) else { return estimate(at) };
        let key = (candidate, ray, seed);
        let known = self.at_scale.lock().unwrap_or_else(PoisonError::into_inner).get(&key).cloned();
        let mut prediction = known.unwrap_or_else(|| {
            let result = estimate(Some((what, scale)));
            let mut all = self.at_scale.lock().unwrap_or_else(PoisonError::into_inner);
            all.entry(key).or_insert(result).clone()
        })?;
        let factor = x / scale;
        for channel in &mut prediction.channels {
            let (losses, error) = (channel.losses?, channel.moments?.error);
            let power = |(k, loss): (i32, f64)| loss * factor.powi(-k);
            let [j1, j2, j3, j4] = losses;
            let losses = [(0, j1), (1, j2), (2, j3), (3, j4)].map(power);
            channel.moments = Some(Moments::of_product(channel.truth.value, losses, error));
        }
        prediction.lookups.as_mut()?.mean *= factor;
        Some(prediction)
    }

    /// Returns the reason why a candidate is refused at a setting on a ray; `None` if it is not.
    fn refusal(&self, (candidate, at): Setting, ray: usize) -> Option<Refusal> {
        let case = &self.cases[ray];
        case.at(at).and_then(|at| at.prepare(candidate, case.pilots(1, candidate))).err()
    }

    /// Returns the reason why a candidate is refused at its natural scale on the first ray; `None` if it is not.
    pub fn refusal_at_scale(&self, candidate: usize) -> Option<Refusal> {
        self.refusal((candidate, self.free[candidate].map(|free| (free.what, free.scale))), 0)
    }

    /// Returns the inequality, in words, that a setting violates on one of some rays; `None` if it violates none.
    pub fn violated(
        &self,
        setting: Setting,
        rays: impl IntoIterator<Item = usize>,
    ) -> Option<Cow<'static, str>> {
        // A prediction is faster than a preparation with its reason.
        let mut refused = rays.into_iter().filter(|&ray| self.predict(setting, (ray, 1)).is_none());
        refused.find_map(|ray| match self.refusal(setting, ray)? {
            Refusal::Inequality { needs, .. } => Some(needs),
            _ => None,
        })
    }

    /// Returns the score of a candidate over some rays, from predictions for a ray and a seed; `None` if it is refused on one
    /// of them, or if theory does not know its variance or cost.
    fn score(
        &self,
        candidate: usize,
        rays: &[usize],
        predict: impl Fn((usize, u64)) -> Option<Prediction>,
    ) -> Option<CandidateScore> {
        let price = self.prices[candidate]?;
        let mut score = CandidateScore::default();
        let is_learned = self.cases.len() == 1 && self.learns(candidate);
        let seeds = if is_learned { SEEDS } else { 1 };
        let share = 1.0 / (rays.len() as f64 * seeds as f64);
        for (&ray, seed) in rays.iter().flat_map(|ray| (1..=seeds).map(move |seed| (ray, seed))) {
            let prediction = predict((ray, seed))?;
            let channels = &prediction.channels;
            let mut relative = 0.0;
            for channel in channels {
                relative += self.weights[ray] * relative_variance(channel)? / channels.len() as f64;
                score.is_bound |= channel.moments.is_none();
                let kurtosis = channel.moments.and_then(|moments| moments.kurtosis());
                score.kurtosis = [score.kurtosis, kurtosis].into_iter().flatten().reduce(f64::max);
            }
            let (lookups, setup) = (
                prediction.lookups.as_ref()?.mean,
                prediction.shared_setup(self.cases[ray].draws_per_ray),
            );
            // Where nothing is left to sample, no σ̂ is too small: all with less than a lookup are as good.
            let counted = if relative == 0.0 && lookups > 0.0 { lookups.max(1.0) } else { lookups };
            let own = price.draw + price.lookup * counted + self.setup_lookup * setup;
            score.works.push(relative * own);
            score.variance += share * relative;
            score.work += share * relative * own;
            score.cost += share * own;
            score.lookups += share * lookups;
            score.setup_lookups += share * prediction.setup_lookups as f64;
        }
        score.work.is_finite().then_some(score)
    }

    /// Returns the score of a candidate over all rays.
    pub fn score_of_all(&self, setting: Setting) -> Option<CandidateScore> {
        let rays: Vec<usize> = (0..self.cases.len()).collect();
        self.score(setting.0, &rays, |place| self.predict(setting, place))
    }

    /// Returns the goal on the probes as a function of the free quantity, of a σ̂ that is larger than needed by a factor.
    pub fn goal(&self, candidate: usize, looseness: f64) -> Goal<'_> {
        let free = self.free[candidate];
        let largest = free.and_then(|free| free.ray);
        Goal::new(move |x| {
            let at = |x: f64| (candidate, free.map(|free| (free.what, x)));
            let is_refused = |x| {
                let rays = self.probes.iter().copied().chain(largest);
                self.violated(at(x), rays).is_some()
            };
            if looseness > 1.0 && is_refused(x / looseness) {
                return f64::INFINITY;
            }
            let is_missing = Cell::new(false);
            let predict = |place| {
                let prediction = self.estimate(at(x), place);
                is_missing.set(is_missing.get() || prediction.is_none());
                prediction
            };
            let exists = |ray| predict((ray, 1)).is_some();
            let score = self.score(candidate, &self.probes, predict);
            match score.filter(|_| largest.is_none_or(exists)) {
                Some(score) => score.goal(self.request.target),
                None if is_missing.get() && is_refused(x) => f64::INFINITY,
                None => UNKNOWN,
            }
        })
    }

    /// Returns the candidates with a price, family by family.
    pub fn families(&self) -> Vec<Vec<usize>> {
        let mut families: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for candidate in (0..self.candidates.len()).filter(|&i| self.prices[i].is_some()) {
            families.entry(self.candidates[candidate].family()).or_default().push(candidate);
        }
        families.into_values().collect()
    }

    /// Searches the best setting of a family; `None` if it is refused everywhere. The member in the middle tells the others
    /// where to begin. A limit may cost those near the least value their lead, so that all of them are searched to the end.
    pub fn best(&self, family: &[usize]) -> Option<Best<'_>> {
        let lead = family[family.len() / 2];
        let scale = |candidate: usize| self.free[candidate].map_or(1.0, |free| free.scale);
        let is_constant = self.free[lead].is_some_and(|free| free.what == SweptQuantity::Sampling);
        let reach = if is_constant { REACH } else { 1 };
        let first = self.least(lead, (scale(lead), reach), f64::INFINITY);
        let start = first.as_ref().map_or(1.0, |(minimum, _)| minimum.x / scale(lead));
        let enough = first.as_ref().map_or(f64::INFINITY, |(minimum, _)| BEHIND * minimum.value);
        let others: Vec<usize> = family.iter().copied().filter(|&other| other != lead).collect();
        let search = |&other: &usize| self.least(other, (start * scale(other), 1), enough);
        let all = others.iter().copied().zip(parallel::map(&others, search));
        let all: Vec<_> =
            all.chain([(lead, first)]).filter_map(|(i, result)| Some((i, result?))).collect();
        let minimum =
            all.iter().map(|(_, (minimum, _))| minimum.value).fold(f64::INFINITY, f64::min);
        let near =
            all.into_iter().filter(|(_, (own, _))| own.value <= minimum * (1.0 + ABOVE_LIMIT));
        let near = near.map(|(candidate, (minimum, goal))| {
            let (setting, value, kind) = match self.free[candidate] {
                None => (None, minimum.value, PlaceKind::Fixed),
                Some(Free { what, .. }) => {
                    let (x, value, kind) = goal.settled(minimum);
                    (Some((what, x)), value, kind)
                }
            };
            Best { candidate, setting, value, kind, goal }
        });
        let mut best = near.min_by(|a, b| a.value.total_cmp(&b.value))?;
        if self.request.looseness > 1.0 {
            best.goal = self.goal(best.candidate, 1.0);
        }
        Some(best)
    }

    /// Searches the least value of a candidate near a place, unless it is above `enough` there; `None` if it is refused
    /// everywhere.
    fn least(
        &self,
        candidate: usize,
        (start, reach): (f64, i32),
        enough: f64,
    ) -> Option<(Least, Goal<'_>)> {
        let looseness = self.request.looseness;
        let goal = self.goal(candidate, looseness);
        if self.free[candidate].is_none() {
            let value = Some(goal.of(1.0)).filter(|&value| value < BEYOND)?;
            return Some((Least { x: 1.0, value, is_open: false }, goal));
        }
        let is_too_small = looseness > 1.0 && goal.of(start).is_infinite();
        let start = if is_too_small { start * looseness } else { start };
        Some((goal.least(start, reach, enough)?, goal))
    }

    /// Returns a setting that is allowed on all rays, not only on the probes, with its score; `None` if no setting up to
    /// twice the given one is allowed.
    pub fn on_all(&self, best: &Best) -> Option<(Variation, CandidateScore)> {
        let tries = if best.setting.is_some() { &RAISES[..] } else { &RAISES[..1] };
        tries.iter().find_map(|factor| {
            let setting = best.setting.map(|(what, x)| (what, up(x * factor)));
            Some((setting, self.score_of_all((best.candidate, setting))?))
        })
    }
}

/// Returns the free quantity of each candidate: a constant σ̂, or a factor on σ̂.
fn free(cases: &[Case], probes: &[usize], candidates: &[Candidate]) -> Vec<Option<Free>> {
    let mut scales: BTreeMap<String, (f64, usize)> = BTreeMap::new();
    let mut free = |(candidate, own): (usize, &Candidate)| {
        let scenario = &cases[0].scenario;
        let is_free = |what: &SweptQuantity| scenario.depends_on(candidate, *what);
        let what =
            [SweptQuantity::Sampling, SweptQuantity::SamplingScale].into_iter().find(is_free)?;
        if own.is_profile {
            return None;
        }
        if what == SweptQuantity::SamplingScale {
            return Some(Free { what, scale: 1.0, ray: None });
        }
        // Candidates with one control have one residual.
        let own = || {
            let scale = |case: &Case| case.at(None).map_or(0.0, |at| at.natural_scale(candidate));
            let all = parallel::map(cases, scale).into_iter().enumerate();
            all.max_by(|a, b| a.1.total_cmp(&b.1)).map_or((0.0, 0), |(ray, scale)| (scale, ray))
        };
        let control = cases[0].at(None).map(|at| at.id(candidate).control).unwrap_or_default();
        let (scale, ray) = *scales.entry(control).or_insert_with(own);
        // Where nothing is left to sample, any σ̂ will do.
        let ray = Some(ray).filter(|ray| !probes.contains(ray));
        Some(Free { what, scale: if scale > 0.0 { scale } else { 1.0 }, ray })
    };
    candidates.iter().enumerate().map(&mut free).collect()
}
