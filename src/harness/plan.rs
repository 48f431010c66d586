//! A plan: every experiment of a run, prepared, with its draws and its share of the error rate.

use rayon::prelude::*;

use super::case::Case;
use super::checks::{self, Kind, Limits, Statistic, Subject};
use super::filter::Filter;
use super::scenario::{Names, Prepared, Ready, Variation};
use crate::estimators::Refusal;
use crate::rng::{Address, name_hash};
use crate::stats::normal;

/// The share of the error rate that goes to tests of whole laws.
const LAW_SHARE: f64 = 0.2;
/// The chance of missing a difference that matters.
const MISS: f64 = 0.01;

/// What a run is asked to do.
#[derive(Debug, Clone)]
pub struct Options {
    /// The seed of all random numbers.
    pub seed: u64,
    /// Draws per experiment, whatever the cases say.
    pub draws: Option<u64>,
    /// The chance that a correct run shows any failure.
    pub alpha: f64,
    /// Stop drawing after this many seconds.
    pub seconds: Option<f64>,
    /// Only these experiments.
    pub filter: Option<Filter>,
}

impl Default for Options {
    fn default() -> Self {
        Self { seed: 1, draws: None, alpha: 1e-3, seconds: None, filter: None }
    }
}

/// Draws per experiment where neither the options nor the case say.
pub const DRAWS: u64 = 4_000_000;

/// A run, ready to draw.
pub struct Plan<'a> {
    /// What was asked.
    pub options: Options,
    /// The cases.
    pub cases: Vec<PlannedCase<'a>>,
    /// The levels that the checks share.
    pub limits: Limits,
    /// How many hypotheses the run tests.
    pub hypotheses: usize,
}

/// A case with its experiments.
pub struct PlannedCase<'a> {
    /// The case.
    pub case: &'a Case,
    /// Its experiments: estimators in the order of the case, each over the sweep.
    pub experiments: Vec<Planned>,
}

/// One experiment.
pub struct Planned {
    /// Which estimator of the case.
    pub estimator: usize,
    /// Where in the sweep.
    pub variation: Variation,
    /// What it is called.
    pub names: Names,
    /// Where its random numbers are.
    pub address: Address,
    /// How many draws it makes.
    pub draws: u64,
    /// Whether the case declares it biased.
    pub expect_biased: bool,
    /// What draws and what theory says, or why it is refused.
    pub outcome: Result<Ready, Refusal>,
    /// For each check, the sums it needs.
    pub statistics: Vec<Option<Box<dyn Statistic>>>,
}

impl Planned {
    /// What the checks know of it; `None` if it is refused.
    #[must_use]
    pub fn subject<'p>(&'p self, case: &Case) -> Option<Subject<'p>> {
        let ready = self.outcome.as_ref().ok()?;
        Some(Subject {
            prediction: &ready.prediction,
            draws: self.draws,
            tolerance: case.tolerance,
            expect_biased: self.expect_biased,
            allow_underpowered: case.allow_underpowered,
        })
    }
}

impl<'a> Plan<'a> {
    /// Prepares every experiment of the cases.
    #[must_use]
    pub fn new(cases: &'a [Case], options: &Options) -> Self {
        let cases: Vec<PlannedCase> = cases
            .par_iter()
            .map(|case| plan_case(case, options))
            .filter(|case| !case.experiments.is_empty())
            .collect();
        let mut counts = [0_usize; 2];
        for planned in &cases {
            for experiment in &planned.experiments {
                let Some(subject) = experiment.subject(planned.case) else { continue };
                for check in checks::ALL {
                    counts[usize::from(check.kind() == Kind::Law)] += check.hypotheses(&subject);
                }
            }
        }
        let [scalars, laws] = counts.map(|count| count.max(1) as f64);
        let limits = Limits {
            z: normal::two_sided(options.alpha * (1.0 - LAW_SHARE) / scalars),
            p: options.alpha * LAW_SHARE / laws,
            power: normal::upper_quantile(MISS),
        };
        let hypotheses = counts.iter().sum();
        Self { options: options.clone(), cases, limits, hypotheses }
    }

    /// All experiments with their case.
    pub fn experiments(&self) -> impl Iterator<Item = (&PlannedCase<'a>, &Planned)> {
        self.cases.iter().flat_map(|case| case.experiments.iter().map(move |e| (case, e)))
    }
}

fn plan_case<'a>(case: &'a Case, options: &Options) -> PlannedCase<'a> {
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
            filter.keeps(&case.name, &case.scenario.names(estimator, variation).estimator)
        });
    }
    let draws = options.draws.or(case.draws).unwrap_or(DRAWS);
    let plan = |&(estimator, variation): &(usize, Variation)| {
        let mut names = case.scenario.names(estimator, variation);
        // Two estimators may be called the same, as where each has a field of its own as control.
        let twins = (0..estimator).filter(|&e| case.scenario.names(e, variation) == names).count();
        let address = address(options.seed, &case.name, &names, variation, twins);
        if twins > 0 {
            names.estimator = format!("{} #{}", names.estimator, twins + 1);
        }
        let Prepared { outcome, expect_biased } =
            case.scenario.prepare(estimator, variation, address);
        let mut planned = Planned {
            estimator,
            variation,
            names,
            address,
            draws,
            expect_biased,
            outcome,
            statistics: Vec::new(),
        };
        planned.statistics = match planned.subject(case) {
            Some(subject) => checks::ALL
                .iter()
                .map(|check| {
                    (check.hypotheses(&subject) > 0).then(|| check.statistic(&subject)).flatten()
                })
                .collect(),
            None => Vec::new(),
        };
        planned
    };
    let experiments = points.par_iter().map(plan).collect();
    PlannedCase { case, experiments }
}

/// The address of an experiment's streams: made of names, so that it keeps its random numbers when
/// other experiments join or leave the run. `twins` come before it in the case under the same name.
fn address(seed: u64, case: &str, names: &Names, variation: Variation, twins: usize) -> Address {
    let Names { estimator, sampling, sampling_kind, control } = names;
    let sampling = sampling.map_or(String::new(), |value| value.to_string());
    let swept = variation.map_or(String::new(), |(what, x)| format!("{}={x}", what.key()));
    let mut name = format!("{case}|{estimator}|{sampling}|{sampling_kind}|{control}|{swept}");
    if twins > 0 {
        name = format!("{name}|{twins}");
    }
    Address { seed, experiment: name_hash(&name), block: 0, lane: 0 }
}
