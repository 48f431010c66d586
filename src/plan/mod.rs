//! Plan of a run: every experiment, prepared, with its questions and their share of the error rate, all before the
//! first draw.
//!
//! ```text
//! n        the number of `--draws` or of the case, or the one that the case's tolerances need
//! fixed    ⌈n/2⌉ in whole blocks: the draws of p-values and z-scores, never a number that data chose
//! horizon  60/27 n: the gate may go on that far
//! α        4/5 to the gate, by e-Bonferroni; 1/5 to the p-values, by Holm
//! ```

pub mod levels;
pub mod options;

pub use crate::case::id::ExperimentId;
pub use options::{Amount, Filter, Options};

use ::gate::CheckId;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::case::sweep::Variation;
use crate::case::{Case, Ready};
use crate::plan::levels::Levels;
use ::gate::stats::gate;
use ::gate::stats::verdict::{BLOCK, Verdict};
use checks::check::ErrorShare;
use checks::{self, Pilot, Question, ScalarCheck, Subject};
use estimators::{DrawBuffer, Knowledge, Refusal};
use numeric::pack::WIDTH;
use numeric::rng::{Address, PILOT, Streams};
use theory::parallel;

/// Number of draws that estimate a variance if theory has none.
const PILOT_DRAWS: usize = 1 << 16;

/// A run, ready to draw.
pub struct Plan<'a> {
    /// Options of the run.
    pub options: Options,
    /// The cases.
    pub cases: Vec<PlannedCase<'a>>,
    /// The levels that the questions share.
    pub levels: Levels,
}

/// A case with its experiments.
pub struct PlannedCase<'a> {
    /// The case.
    pub case: &'a Case,
    /// Its experiments: estimators in the order of the case, each over the sweep.
    pub experiments: Vec<PlannedExperiment>,
}

/// One experiment.
pub struct PlannedExperiment {
    /// Number of the experiment in the plan, from 0.
    pub number: u32,
    /// Index of the estimator in the case.
    pub estimator: usize,
    /// Identity of the experiment.
    pub id: ExperimentId,
    /// Earlier experiment of the case that is the same by definition: both share the same draws.
    pub same_as: Option<ExperimentId>,
    /// Knowledge of the medium that the experiment needs beside lookups.
    pub needs: Vec<Knowledge>,
    /// Number of draws that share the setup lookups of a ray.
    pub draws_per_ray: u64,
    /// Address of its random numbers.
    pub address: Address,
    /// n, the number of planned draws.
    pub draws: u64,
    /// Number of the first draws that p-values and z-scores see.
    pub fixed: u64,
    /// Largest number of draws that the gate may take.
    pub horizon: u64,
    /// True if the case declares it biased.
    pub expect_biased: bool,
    /// The experiment with its prediction, or the reason of its refusal.
    pub outcome: Result<Ready, Refusal>,
    /// Questions about the draws.
    pub questions: Vec<Question>,
    /// Returns the streams of a block's address.
    pub find_streams: fn(Address) -> Streams,
}

impl PlannedExperiment {
    /// Returns the questions that go through the gate.
    pub fn scalars(&self) -> impl Iterator<Item = (&Question, &ScalarCheck)> {
        self.questions.iter().filter_map(|question| Some((question, question.answer.scalar()?)))
    }

    /// Returns whether draws are made for the experiment: not if it is refused, or the same as an earlier one.
    pub fn is_drawn(&self) -> bool {
        self.outcome.is_ok() && self.same_as.is_none()
    }

    /// Returns the number of its rows in a record: one per channel, or one with the reason if it is refused.
    pub fn channels(&self) -> usize {
        self.outcome.as_ref().map_or(1, |ready| ready.prediction.channels.len())
    }

    /// Returns the streams of a block.
    pub fn streams(&self, block: u64) -> Streams {
        (self.find_streams)(Address { block, ..self.address })
    }
}

impl<'a> Plan<'a> {
    /// Returns the number of draws that are merged before the gate may look.
    pub fn step(&self) -> u64 {
        self.options.blocks_per_look * BLOCK
    }

    /// Prepares every experiment of the cases.
    pub fn new(cases: &'a [Case], options: &Options) -> Self {
        Self::with_progress(cases, options, &|_, _| {})
    }

    /// Prepares every experiment of the cases. `listen` receives the number of prepared experiments, and of all.
    pub fn with_progress(
        cases: &'a [Case],
        options: &Options,
        listen: &(dyn Fn(usize, usize) + Sync),
    ) -> Self {
        let points: Vec<(&Case, Vec<(usize, Variation)>)> =
            cases.iter().map(|case| (case, points(case, options))).collect();
        let (prepared, all) = (AtomicUsize::new(0), points.iter().map(|one| one.1.len()).sum());
        listen(0, all);
        let mut cases = parallel::map(&points, |(case, points)| {
            let experiments = parallel::map(points, |&point| {
                let planned = plan_experiment(case, options, point);
                listen(prepared.fetch_add(1, Ordering::Relaxed) + 1, all);
                planned
            });
            PlannedCase { case, experiments }
        });
        cases.retain(|case| !case.experiments.is_empty());
        let ready =
            |case: &PlannedCase| case.experiments.iter().filter(|e| e.outcome.is_ok()).count();
        let ready: usize = cases.iter().map(ready).sum();
        // A budget is shared equally; draws that are saved go to the experiments that are still open.
        let share = options.budget.map(|budget| {
            let share = (budget / ready.max(1) as u64).max(2);
            // Whole blocks, since looks come at their ends.
            if share < BLOCK { share } else { share / BLOCK * BLOCK }
        });
        let all = cases.iter_mut().flat_map(|case| &mut case.experiments);
        (0..).zip(all).for_each(|(number, planned)| planned.number = number);
        parallel::change(&mut cases, |PlannedCase { case, experiments }| {
            for planned in &mut *experiments {
                planned.draws = share.map_or(planned.draws, |share| planned.draws.min(share));
                planned.ask(case, options);
            }
            for index in 0..experiments.len() {
                let (earlier, rest) = experiments.split_at_mut(index);
                let same = earlier.iter().find(|other| other.is_same(&rest[0]));
                rest[0].same_as = same.map(|other| other.id.clone());
            }
        });
        let mut counts = [0; 3];
        for experiment in cases.iter().flat_map(|case| &case.experiments) {
            for question in &experiment.questions {
                match question.answer.share() {
                    ErrorShare::Gate if question.expects_bias => counts[2] += 1,
                    ErrorShare::Gate => counts[0] += 1,
                    ErrorShare::PValues => counts[1] += 1,
                    ErrorShare::Nothing => {}
                }
            }
        }
        let levels = Levels::new(options.alpha, counts);
        Self { options: options.clone(), cases, levels }
    }

    /// Splits into plans of one experiment each, at the same levels. All are drawn, those that are the same as others, too.
    pub fn singly(self) -> impl Iterator<Item = Self> {
        let Self { options, cases, levels } = self;
        let all = cases.into_iter().flat_map(|PlannedCase { case, experiments }| {
            experiments.into_iter().map(move |planned| (case, planned))
        });
        all.map(move |(case, planned)| {
            let experiments = vec![PlannedExperiment { number: 0, same_as: None, ..planned }];
            Self {
                options: options.clone(),
                cases: vec![PlannedCase { case, experiments }],
                levels,
            }
        })
    }

    /// Changes the seed of the random numbers; pilots stay as they are.
    pub fn reseed(&mut self, seed: u64) {
        self.options.seed = seed;
        for planned in self.cases.iter_mut().flat_map(|case| &mut case.experiments) {
            planned.address.seed = seed;
        }
    }

    /// Returns all experiments with their case.
    pub fn experiments(&self) -> impl Iterator<Item = (&PlannedCase<'a>, &PlannedExperiment)> {
        let mut all = Vec::new();
        for case in &self.cases {
            for planned in &case.experiments {
                all.push((case, planned));
            }
        }
        all.into_iter()
    }
}

/// Returns the selected experiments of a case: each estimator at each value of the sweep.
fn points(case: &Case, options: &Options) -> Vec<(usize, Variation)> {
    let mut points: Vec<(usize, Variation)> = Vec::new();
    for estimator in 0..case.scenario.estimators() {
        match &case.sweep {
            Some(axis) if case.scenario.depends_on(estimator, axis.what) => {
                let values = axis.values.iter();
                points.extend(values.map(|&value| (estimator, Some((axis.what, value)))));
            }
            _ => points.push((estimator, None)),
        }
    }
    if let Some(filter) = &options.filter {
        points.retain(|&(estimator, variation)| {
            filter.keeps(&case.name, &case.id(estimator, variation).estimator)
        });
    }
    points
}

fn plan_experiment(
    case: &Case,
    options: &Options,
    (estimator, variation): (usize, Variation),
) -> PlannedExperiment {
    let maximum = options.draws.of(case.draws);
    let address = case.address(options.seed, estimator, variation);
    let pilots = case.pilots(options.seed, estimator);
    let at = case.at(variation);
    let needs = at.as_ref().map_or_else(|_| Vec::new(), |at| at.needs(estimator));
    let outcome = at.and_then(|at| at.prepare(estimator, pilots));
    PlannedExperiment {
        number: 0,
        estimator,
        id: case.id(estimator, variation),
        same_as: None,
        needs,
        draws_per_ray: case.draws_per_ray,
        address,
        draws: maximum,
        fixed: maximum,
        horizon: maximum,
        expect_biased: case.scenario.expects_bias(estimator),
        outcome,
        questions: Vec::new(),
        find_streams: Address::streams,
    }
}

impl PlannedExperiment {
    /// Returns whether two experiments make the same draws, and have the same questions.
    fn is_same(&self, other: &Self) -> bool {
        let of = |one: &Self| (one.address, one.draws, one.fixed, one.horizon, one.expect_biased);
        let requested = |one: &Self| one.questions.iter().map(|q| q.check).collect::<Vec<_>>();
        self.outcome.is_ok()
            && other.outcome.is_ok()
            && of(self) == of(other)
            && requested(self) == requested(other)
    }

    /// Collects the questions of all checks, first for the number of draws that the case's tolerances need, then for
    /// good.
    fn ask(&mut self, case: &Case, options: &Options) {
        let Ok(ready) = &self.outcome else { return };
        let maximum = self.draws;
        let channels = || ready.prediction.channels.iter();
        let forced = self.expect_biased && channels().any(|channel| channel.moments.is_none());
        let pilots = (forced || channels().any(|channel| channel.pilot_variance_allowed))
            .then(|| self.pilots(ready));
        let mut subject = Subject {
            prediction: &ready.prediction,
            draws: maximum,
            maximum,
            fixed: fixed(maximum),
            tolerance: case.tolerance,
            expect_biased: self.expect_biased,
            has_invariant: ready.experiment.has_invariant(),
            pilots: pilots.as_deref(),
        };
        if case.tolerance.is_given() {
            let needed = needed(&checks::questions(&subject), maximum);
            subject.draws = needed;
            subject.fixed = fixed(needed);
        }
        if options.fixed {
            subject.fixed = subject.draws;
        }
        let mut questions = checks::questions(&subject);
        let decides = |question: &Question| question.answer.share() != ErrorShare::Nothing;
        let is_certain = !questions.iter().any(decides);
        if is_certain {
            // Draws without randomness are all equal: one pack is enough.
            subject.draws = subject.draws.min(WIDTH as u64);
            subject.fixed = subject.draws;
            questions = checks::questions(&subject);
        }
        (self.draws, self.fixed) = (subject.draws, subject.fixed);
        // A budget of less than a block allows no continuation.
        let is_tight = options.budget.is_some() && self.draws < BLOCK;
        let is_fixed = options.fixed || is_tight || is_certain;
        self.horizon = if is_fixed { self.draws } else { horizon(self.draws) };
        for question in &mut questions {
            let counts = question.check == CheckId::Mean && !case.allow_underpowered;
            if counts || options.strict {
                question.too_weak = Verdict::Inconclusive;
            }
        }
        self.questions = questions;
    }

    /// Returns the spreads of a few draws from streams of their own, channel by channel.
    fn pilots(&self, ready: &Ready) -> Vec<Pilot> {
        let mut streams = Address { block: PILOT, ..self.address }.streams();
        let channels = ready.prediction.channels.len();
        let mut buffer = DrawBuffer::new(channels);
        let mut values = vec![Vec::with_capacity(PILOT_DRAWS); channels];
        while values.iter().any(|values| values.len() < PILOT_DRAWS) {
            ready.experiment.fill(&mut streams, DrawBuffer::length(channels), &mut buffer);
            values.iter_mut().zip(&buffer.values).for_each(|(all, new)| all.extend(new));
        }
        values.iter().map(|values| Pilot::of(values)).collect()
    }
}

/// Returns half of the planned draws in whole blocks; all of them if they are few.
fn fixed(draws: u64) -> u64 {
    let half = draws.div_ceil(2).div_ceil(BLOCK) * BLOCK;
    if draws < 4 * BLOCK { draws } else { half }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of draws
fn horizon(draws: u64) -> u64 {
    (draws as f64 * gate::HORIZON / gate::PLANNED).ceil() as u64
}

/// Returns the number of draws that every check needs that can pass within `maximum` draws: at the case's tolerances or,
/// where it has none, at the widest for which a pass is promised.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most `maximum`
fn needed(questions: &[Question], maximum: u64) -> u64 {
    let promised = questions.iter().filter_map(|question| {
        let planned = &question.answer.scalar()?.planned;
        planned.underpowered.is_none().then_some(planned.minimum)
    });
    let needed = promised.fold(0.0, f64::max);
    if needed > 0.0 { needed.ceil().min(maximum as f64) as u64 } else { maximum }
}
