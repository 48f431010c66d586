//! Every known bug against the built-in suite: its check must catch it, and must not catch its correct control.
//!
//! The levels are those of the whole suite, and the draws those of its default budget. A control that makes the same
//! draws as the estimator, bit for bit, shares the estimator's verdict, which is judged once for all mutants of an
//! experiment.

use std::collections::HashMap;

use crate::case::{Case, CaseError, suite};
use crate::draw::run;
use crate::plan::levels::Levels;
use crate::plan::options::{Amount, Options};
use crate::plan::{BLOCK, Plan, Planned};
use crate::record::{Finding, Verdict, evaluate};
use estimators::{DrawBuffer, Experiment, Refusal};
use gate::causes::Pattern;
use lab::mutants::{self, About, Caught, StreamMutant, Target, streams};
use theory::parallel;

pub use lab::mutants::Walk;

/// Draws and judges all mutants and their controls.
///
/// # Errors
///
/// A built-in case cannot be read.
pub fn all(seed: u64) -> Result<Vec<Caught>, CaseError> {
    of(seed, &|_| true)
}

/// Draws and judges the mutants of some names, and their controls.
///
/// # Errors
///
/// A built-in case cannot be read.
pub fn of(seed: u64, is_wanted: &dyn Fn(&str) -> bool) -> Result<Vec<Caught>, CaseError> {
    let bench = Bench::new(Options { seed, ..Options::default() })?;
    let (abouts, of_streams) = wanted(is_wanted);
    let mut targets: HashMap<(&str, usize), Target> = HashMap::new();
    for target in abouts.iter().map(|about| about.target).chain([streams::TARGET]) {
        targets.insert((target.case, target.index), target);
    }
    let targets: Vec<_> = targets.into_iter().collect();
    let honest = parallel::map(&targets, |(key, target)| (*key, bench.passes(target)));
    let honest: HashMap<(&str, usize), bool> = honest.into_iter().collect();
    let passes = |target: &Target| honest.get(&(target.case, target.index)).copied();
    let mut caught = parallel::map(&abouts, |about| {
        bench.estimator(about, passes(&about.target).unwrap_or(false))
    });
    let twin = passes(&streams::TARGET).unwrap_or(false);
    caught.extend(parallel::map(&of_streams, |mutant| bench.streams(mutant, twin)));
    Ok(caught)
}

/// Returns the failing checks of each mutant of some names if nothing stops the drawing early, in the order of
/// [`mutants::all`], those of streams at the end.
///
/// # Errors
///
/// A built-in case cannot be read.
pub fn patterns(
    seed: u64,
    draws: u64,
    is_wanted: &dyn Fn(&str) -> bool,
) -> Result<Vec<(&'static str, Pattern)>, CaseError> {
    let draws = Amount::Exactly(draws);
    let bench = Bench::new(Options { seed, draws, ..Options::default() })?;
    let (abouts, of_streams) = wanted(is_wanted);
    let mut found = parallel::map(&abouts, |about| {
        (about.name, bench.faulty(about, None).map(|judged| judged.pattern()).unwrap_or_default())
    });
    found.extend(parallel::map(&of_streams, |mutant| {
        (mutant.name, bench.with_streams(mutant, None).map(|j| j.pattern()).unwrap_or_default())
    }));
    Ok(found)
}

/// Returns the mutants of some names, those of estimators and those of streams.
fn wanted(is_wanted: &dyn Fn(&str) -> bool) -> (Vec<About>, Vec<&'static StreamMutant>) {
    let abouts = mutants::all().into_iter().filter(|about| is_wanted(about.name));
    let of_streams = streams::MUTANTS.iter().filter(|mutant| is_wanted(mutant.name));
    (abouts.collect(), of_streams.collect())
}

/// Finds a mutant's experiment in a plan that has its case.
pub fn find<'p>(target: &Target, plan: &'p Plan) -> Option<(&'p Case, &'p Planned)> {
    let fits = |planned: &Planned| {
        planned.estimator == target.index && planned.id.swept_value() == target.swept
    };
    let mut experiments = plan.experiments();
    experiments
        .find(|(case, planned)| case.case.name == target.case && fits(planned))
        .map(|(case, planned)| (case.case, planned))
}

/// Returns a mutant's experiment, prepared as the plan prepared the correct one; `None` if the case's problem has no
/// mutant of that name.
pub fn experiment(
    about: &About,
    walk: Walk,
    case: &Case,
    planned: &Planned,
    seed: u64,
) -> Option<Result<Box<dyn Experiment>, Refusal>> {
    let pilots = case.pilots(seed, planned.estimator);
    match case.at(planned.id.variation()).and_then(|at| at.setup(planned.estimator, pilots)) {
        Ok(setup) => mutants::experiment(about.name, walk, setup).map(Ok),
        Err(refusal) => Some(Err(refusal)),
    }
}

/// Built-in suite, on which mutants are drawn one experiment at a time.
struct Bench {
    cases: Vec<Case>,
    options: Options,
    levels: Levels,
}

impl Bench {
    /// Reads the suite, and shares the error rate among its checks.
    fn new(options: Options) -> Result<Self, CaseError> {
        let cases: Vec<Case> = suite::suite().iter().map(Case::read).collect::<Result<_, _>>()?;
        let levels = Plan::new(&cases, &options).levels;
        Ok(Self { cases, options, levels })
    }

    /// Returns the plan of one experiment, at the levels of the suite.
    fn plan(&self, target: &Target, until_failed: Option<&str>) -> Option<Plan<'_>> {
        let case = self.cases.iter().find(|case| case.name == target.case)?;
        let until_failed = until_failed.map(str::to_owned);
        let options = Options { until_failed, ..self.options.clone() };
        Plan::of_one(case, &options, target.index, target.swept, self.levels)
    }

    fn judged(plan: &Plan) -> Judged {
        let fixed = plan.experiments().map(|(_, planned)| planned.fixed).max().unwrap_or(0);
        let draws = run::draw(plan, &|_| {});
        let judged = evaluate::run(plan, &draws).into_iter();
        let planned = plan.experiments().next();
        let estimator = planned.map_or_else(String::new, |(_, one)| one.id.estimator.to_string());
        Judged { estimator, fixed, findings: judged.flat_map(|one| one.findings).collect() }
    }

    fn passes(&self, target: &Target) -> bool {
        let Some(plan) = self.plan(target, None) else { return false };
        let judged = Self::judged(&plan);
        judged
            .findings
            .iter()
            .all(|finding| matches!(finding.verdict, Verdict::Pass | Verdict::Underpowered))
    }

    /// Returns the plan of a mutant's experiment, and the mutant or its control.
    fn walk(
        &self,
        about: &About,
        walk: Walk,
        until_failed: Option<&str>,
    ) -> Option<(Plan<'_>, Box<dyn Experiment>)> {
        let plan = self.plan(&about.target, until_failed)?;
        let case = plan.cases.first()?;
        let (case, planned) = (case.case, case.experiments.first()?);
        let drawn = experiment(about, walk, case, planned, self.options.seed)?;
        Some((plan, drawn.ok()?))
    }

    /// Judges the draws of a mutant.
    fn faulty(&self, about: &About, until_failed: Option<&str>) -> Option<Judged> {
        let (mut plan, faulty) = self.walk(about, Walk::Faulty, until_failed)?;
        let planned = plan.cases.first_mut()?.experiments.first_mut()?;
        planned.outcome.as_mut().ok()?.experiment = faulty;
        Some(Self::judged(&plan))
    }

    fn estimator(&self, about: &About, honest_passes: bool) -> Caught {
        let is_twin = self.walk(about, Walk::Twin, None).is_some_and(|(plan, twin)| {
            plan.cases[0].experiments.first().is_some_and(|planned| same(planned, twin.as_ref()))
        });
        let judged = self.faulty(about, Some(about.check));
        let About { name, bug, target, check } = *about;
        caught([name, bug, check], &target, judged.as_ref(), is_twin && honest_passes)
    }

    /// Judges the draws of wrong streams.
    fn with_streams(&self, mutant: &StreamMutant, until_failed: Option<&str>) -> Option<Judged> {
        let mut plan = self.plan(&streams::TARGET, until_failed)?;
        for planned in plan.cases.iter_mut().flat_map(|case| &mut case.experiments) {
            planned.find_streams = mutant.streams;
        }
        Some(Self::judged(&plan))
    }

    fn streams(&self, mutant: &StreamMutant, twin_passes: bool) -> Caught {
        let judged = self.with_streams(mutant, Some(mutant.check));
        let words = [mutant.name, mutant.bug, mutant.check];
        caught(words, &streams::TARGET, judged.as_ref(), twin_passes)
    }
}

/// Findings on one experiment.
struct Judged {
    /// The estimator's name.
    estimator: String,
    /// The number of draws for its distributions.
    fixed: u64,
    findings: Vec<Finding>,
}

impl Judged {
    /// Returns which checks fail.
    fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        for finding in self.findings.iter().filter(|found| found.verdict == Verdict::Fail) {
            pattern.note(&finding.check, finding.gate.map(|gate| gate.mean));
        }
        pattern
    }
}

fn caught(
    [name, bug, check]: [&'static str; 3],
    target: &Target,
    judged: Option<&Judged>,
    twin_passes: bool,
) -> Caught {
    let failing: Vec<&Finding> = judged
        .into_iter()
        .flat_map(|judged| &judged.findings)
        .filter(|finding| finding.verdict == Verdict::Fail)
        .collect();
    let mut failed: Vec<String> = failing.iter().map(|finding| finding.check.clone()).collect();
    failed.dedup();
    // A distribution is tested on the plan's fixed draws, a bound on the draws up to its violation.
    let fixed = judged.map_or(0, |judged| judged.fixed);
    let by_check = failing.iter().filter(|finding| finding.check == check);
    let draws = by_check
        .map(|finding| match (finding.gate, finding.block) {
            (Some(gate), _) => gate.draws,
            (None, Some(block)) => (block + 1) * BLOCK,
            (None, None) => fixed,
        })
        .min();
    let estimator = judged.map_or_else(String::new, |judged| judged.estimator.clone());
    let case = target.case;
    Caught { name, bug, case, estimator, check, draws, failed, twin_passes }
}

/// Returns whether two experiments make the same draws, bit for bit, over a buffer.
fn same(planned: &Planned, twin: &dyn Experiment) -> bool {
    let Ok(ready) = &planned.outcome else { return false };
    let fill = |experiment: &dyn Experiment| {
        let channels = ready.prediction.channels.len();
        let mut buffer = DrawBuffer::new(channels);
        experiment.fill(&mut planned.streams(0), DrawBuffer::length(channels), &mut buffer);
        let bits = |values: &Vec<f64>| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        (buffer.values.iter().map(bits).collect::<Vec<_>>(), buffer.lookups)
    };
    fill(ready.experiment.as_ref()) == fill(twin)
}
