//! Every known bug against the built-in suite: its check must catch it, and must not catch its correct control.
//!
//! The levels are those of the whole suite, and the draws those of its default budget. The suite is planned once. All
//! bugs of an experiment are drawn in its place one after another, against the same prediction. A control that makes the
//! same draws as the estimator, bit for bit, shares the estimator's verdict.

use crate::mutants::{self, About, Caught, MutantTarget, StreamMutant, streams};
use estimators::{DrawBuffer, Experiment, Refusal};
use gate::CheckId;
use gate::causes::Pattern;
use gate::stats::verdict::BLOCK;
use numeric::rng::Address;
use theory::parallel;
use trueflight::case::{Case, CaseError, suite};
use trueflight::draw::run;
use trueflight::plan::options::{Amount, Options};
use trueflight::plan::{Plan, PlannedExperiment};
use trueflight::record::{Finding, Verdict, evaluate};

pub use crate::mutants::MutantWalk;

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
    on_stands(&Options { seed, ..Options::default() }, is_wanted, |stand, known| {
        let twin_passes = stand.has_twin(known) && stand.passes();
        let About { name, bug, target, check } = known.about();
        let judged = stand.faulty(known, Some(check));
        caught([name, bug], check, &target, judged.as_ref(), twin_passes)
    })
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
    let options = Options { seed, draws: Amount::Exactly(draws), ..Options::default() };
    on_stands(&options, is_wanted, |stand, known| {
        let judged = stand.faulty(known, None);
        (known.about().name, judged.map(|judged| judged.pattern()).unwrap_or_default())
    })
}

/// Returns a mutant's experiment, prepared as the plan prepared the correct one; `None` if the case's problem has no
/// mutant of that name.
pub fn experiment(
    about: &About,
    walk: MutantWalk,
    case: &Case,
    planned: &PlannedExperiment,
    seed: u64,
) -> Option<Result<Box<dyn Experiment>, Refusal>> {
    let pilots = case.pilots(seed, planned.estimator);
    match case.at(planned.id.variation()).and_then(|at| at.join(planned.estimator, pilots)) {
        Ok(joined) => mutants::experiment(about.name, walk, joined.into_setup()).map(Ok),
        Err(refusal) => Some(Err(refusal)),
    }
}

/// A known bug: in an estimator, or in the streams of its random numbers.
#[derive(Clone, Copy)]
enum KnownBug {
    Estimator(About),
    Streams(&'static StreamMutant),
}

impl KnownBug {
    fn about(&self) -> About {
        match *self {
            Self::Estimator(about) => about,
            Self::Streams(mutant) => mutant.about(),
        }
    }
}

/// Calls `draw` for each mutant of some names, on its stand; the results are in the order of [`mutants::all`], those of
/// streams at the end.
fn on_stands<T: Send>(
    options: &Options,
    is_wanted: &dyn Fn(&str) -> bool,
    draw: impl Fn(&mut Stand, &KnownBug) -> T + Sync,
) -> Result<Vec<T>, CaseError> {
    let cases: Vec<Case> = suite::suite().iter().map(Case::read).collect::<Result<_, _>>()?;
    let of_estimators = mutants::all().into_iter().map(KnownBug::Estimator);
    let known = of_estimators.chain(streams::MUTANTS.iter().map(KnownBug::Streams));
    let known = known.filter(|known| is_wanted(known.about().name));
    let mut plans: Vec<Plan> = Plan::new(&cases, options).singly().collect();
    let mut groups: Vec<BugGroup<T>> = Vec::new();
    for numbered in known.enumerate() {
        let target = numbered.1.about().target;
        if let Some(group) = groups.iter_mut().find(|group| group.stand.target == target) {
            group.bugs.push(numbered);
            continue;
        }
        let plan = plans.iter().position(|plan| is_at(plan, &target)).map(|at| plans.remove(at));
        let stand = Stand { target, plan, passes: None };
        groups.push(BugGroup { stand, bugs: vec![numbered], computed: Vec::new() });
    }
    parallel::change(&mut groups, |BugGroup { stand, bugs, computed }| {
        computed.extend(bugs.iter().map(|(number, known)| (*number, draw(stand, known))));
    });
    let mut computed: Vec<(usize, T)> =
        groups.into_iter().flat_map(|group| group.computed).collect();
    computed.sort_by_key(|(number, _)| *number);
    Ok(computed.into_iter().map(|(_, computed)| computed).collect())
}

/// The bugs of one stand with their numbers, and their results.
struct BugGroup<'a, T> {
    stand: Stand<'a>,
    bugs: Vec<(usize, KnownBug)>,
    computed: Vec<(usize, T)>,
}

/// Returns whether a plan of one experiment is that of a target.
fn is_at(plan: &Plan, target: &MutantTarget) -> bool {
    plan.experiments().any(|(case, planned)| {
        case.case.name == target.case
            && planned.estimator == target.index
            && planned.id.swept_value() == target.swept
    })
}

/// An experiment of the suite, in the place of which known bugs are drawn.
struct Stand<'a> {
    target: MutantTarget,
    /// Its plan at the levels of the suite; `None` if the suite has no such experiment.
    plan: Option<Plan<'a>>,
    /// True if the correct estimator passes; `None` if it has not been drawn.
    passes: Option<bool>,
}

impl<'a> Stand<'a> {
    fn parts(&mut self) -> Option<(&'a Case, &mut PlannedExperiment)> {
        let case = self.plan.as_mut()?.cases.first_mut()?;
        Some((case.case, case.experiments.first_mut()?))
    }

    /// Draws and judges what the plan has at present.
    fn judged(&mut self, until_failed: Option<CheckId>) -> Option<JudgedExperiment> {
        let plan = self.plan.as_mut()?;
        plan.options.until_failed = until_failed;
        let draws = run::draw(plan, &|_| {});
        let judged = evaluate::run(plan, &draws).into_iter();
        let findings = judged.flat_map(|one| one.findings).collect();
        let planned = self.parts()?.1;
        Some(JudgedExperiment {
            estimator: planned.id.estimator.to_string(),
            fixed: planned.fixed,
            findings,
        })
    }

    /// Returns whether the correct estimator passes.
    fn passes(&mut self) -> bool {
        if let Some(passes) = self.passes {
            return passes;
        }
        let is_passed =
            |finding: &Finding| matches!(finding.verdict, Verdict::Pass | Verdict::Underpowered);
        let passes = self.judged(None).is_some_and(|judged| judged.findings.iter().all(is_passed));
        *self.passes.insert(passes)
    }

    /// Makes a walk of a mutant of an estimator.
    fn walk(&mut self, about: &About, walk: MutantWalk) -> Option<Box<dyn Experiment>> {
        let seed = self.plan.as_ref()?.options.seed;
        let (case, planned) = self.parts()?;
        experiment(about, walk, case, planned, seed)?.ok()
    }

    /// Returns whether the control of a bug makes the estimator's own draws. Wrong streams are drawn by the estimator.
    fn has_twin(&mut self, known: &KnownBug) -> bool {
        let KnownBug::Estimator(about) = known else { return true };
        let twin = self.walk(about, MutantWalk::Control);
        let parts = self.parts().zip(twin);
        parts.is_some_and(|((_, planned), twin)| same(planned, twin.as_ref()))
    }

    /// Judges the draws of a bug.
    fn faulty(
        &mut self,
        known: &KnownBug,
        until_failed: Option<CheckId>,
    ) -> Option<JudgedExperiment> {
        match known {
            KnownBug::Estimator(about) => {
                let faulty = self.walk(about, MutantWalk::Faulty)?;
                let control = self.replace(faulty)?;
                let judged = self.judged(until_failed);
                self.replace(control)?;
                judged
            }
            KnownBug::Streams(mutant) => {
                self.parts()?.1.find_streams = mutant.streams;
                let judged = self.judged(until_failed);
                self.parts()?.1.find_streams = Address::streams;
                judged
            }
        }
    }

    /// Replaces the experiment that is drawn; returns the one before.
    fn replace(&mut self, experiment: Box<dyn Experiment>) -> Option<Box<dyn Experiment>> {
        let ready = self.parts()?.1.outcome.as_mut().ok()?;
        Some(std::mem::replace(&mut ready.experiment, experiment))
    }
}

/// Findings on one experiment.
struct JudgedExperiment {
    /// The estimator's name.
    estimator: String,
    /// The number of draws for its distributions.
    fixed: u64,
    findings: Vec<Finding>,
}

impl JudgedExperiment {
    /// Returns which checks fail.
    fn pattern(&self) -> Pattern {
        let mut pattern = Pattern::default();
        for finding in self.findings.iter().filter(|computed| computed.verdict == Verdict::Fail) {
            pattern.note(finding.check, finding.gate.map(|gate| gate.mean));
        }
        pattern
    }
}

fn caught(
    [name, bug]: [&'static str; 2],
    check: CheckId,
    target: &MutantTarget,
    judged: Option<&JudgedExperiment>,
    twin_passes: bool,
) -> Caught {
    let failing: Vec<&Finding> = judged
        .into_iter()
        .flat_map(|judged| &judged.findings)
        .filter(|finding| finding.verdict == Verdict::Fail)
        .collect();
    let mut failed: Vec<CheckId> = failing.iter().map(|finding| finding.check).collect();
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
fn same(planned: &PlannedExperiment, twin: &dyn Experiment) -> bool {
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
