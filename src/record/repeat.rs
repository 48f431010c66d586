//! Commands that draw an experiment again: with the same draws, or with enough to decide it.

use crate::case::suite;
use crate::plan::levels::Foreseen;
use crate::plan::options::Options;
use crate::plan::{Filter, Plan, PlannedCase, PlannedExperiment};
use crate::record::{Finding, Verdict};
use numeric::digits::enough;

/// Largest number of draws that `--draws` takes.
const MAX_DRAWS: f64 = 1e12;
/// Factor on the draws that halves ε: a bias of about half of ε is then decided.
const HALVING: f64 = 4.0;

/// Quotes any word for a shell.
pub(crate) fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_./:@%+=-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// Returns the case as an argument: its name if it is built in, else its file.
fn place(case: &PlannedCase) -> String {
    let case = case.case;
    let is_built_in = suite::find(&case.name).is_some_and(|source| source.path == case.path);
    quoted(&if is_built_in { case.name.clone() } else { case.path.display().to_string() })
}

/// Returns the pattern of an experiment's estimator. Namesakes are numbered by the plan; a filter gives them one name.
fn pattern(planned: &PlannedExperiment) -> String {
    format!("*:{}", planned.id.estimator)
}

/// Returns the options on all experiments that differ from the defaults, each with a space before it.
fn flags(options: &Options) -> String {
    let usual = Options::default().words();
    let of_one = |word: &str| {
        ["--seed", "--draws", "--filter", "--budget"].iter().any(|of| word.starts_with(of))
    };
    let own = options.words().into_iter().filter(|word| !usual.contains(word) && !of_one(word));
    own.fold(String::new(), |flags, word| flags + " " + &word.replacen('=', " ", 1))
}

fn check(plan: &Plan, case: &PlannedCase, planned: &PlannedExperiment, draws: &str) -> String {
    let (place, filter) = (place(case), quoted(&pattern(planned)));
    let (seed, flags) = (plan.options.seed, flags(&plan.options));
    format!(
        "trueflight check {place} --filter {filter} --seed {seed} --draws {draws} --verbose{flags}"
    )
}

/// Returns the command that draws an experiment again, and writes nothing.
pub fn command(plan: &Plan, case: &PlannedCase, planned: &PlannedExperiment) -> String {
    check(plan, case, planned, &planned.draws.to_string())
}

/// Returns the command that decides an inconclusive experiment, and all others that its filter keeps; empty if no
/// number of draws does. `findings` are those of the experiment, empty before it was drawn.
pub fn deciding(
    plan: &Plan,
    case: &PlannedCase,
    planned: &PlannedExperiment,
    findings: &[Finding],
) -> String {
    let Some(own) = decisive_draws(case, planned, findings) else { return String::new() };
    let filter = Filter::new(&pattern(planned)).ok();
    let together = case.experiments.iter().filter(|other| {
        filter.as_ref().is_some_and(|f| f.keeps(&case.case.name, &other.id.estimator))
    });
    let draws = together.filter_map(|other| decisive_draws(case, other, &[])).fold(own, f64::max);
    if draws > MAX_DRAWS { String::new() } else { check(plan, case, planned, &enough(draws)) }
}

/// Returns the command that decides all experiments of a case that the planned draws leave inconclusive; empty if no
/// number of draws does.
pub fn deciding_all(plan: &Plan, case: &PlannedCase) -> String {
    let ready = case.experiments.iter().filter(|planned| planned.outcome.is_ok());
    let open = ready.filter(|planned| {
        (0..planned.channels()).any(|channel| {
            Foreseen::of(planned, channel).is_some_and(|one| one.verdict == Verdict::Inconclusive)
        })
    });
    let draws = open.filter_map(|planned| decisive_draws(case, planned, &[]));
    let Some(draws) = draws.reduce(f64::max).filter(|&draws| draws <= MAX_DRAWS) else {
        return String::new();
    };
    let mut command = format!("trueflight run {} --draws {}", place(case), enough(draws));
    if let Some(filter) = &plan.options.filter {
        command = format!("{command} --filter {}", quoted(filter.pattern()));
    }
    if plan.options.seed != Options::default().seed {
        command = format!("{command} --seed {}", plan.options.seed);
    }
    command + &flags(&plan.options)
}

/// Returns the number of draws that decide an experiment; `None` if no number does.
fn decisive_draws(
    case: &PlannedCase,
    planned: &PlannedExperiment,
    findings: &[Finding],
) -> Option<f64> {
    planned.outcome.as_ref().ok()?;
    let mut draws = planned.draws as f64;
    for channel in 0..planned.channels() {
        let foreseen = Foreseen::of(planned, channel);
        if let Some(open) = foreseen.filter(|one| one.verdict == Verdict::Inconclusive) {
            draws = draws.max(open.needed?);
        }
    }
    // A check that was promised a decision and did not get it has a bias of about half of ε.
    let is_open = |finding: &&Finding| {
        finding.verdict == Verdict::Inconclusive
            && finding.gate.is_some_and(|gate| {
                gate.needed.is_none() && !gate.is_decided && gate.draws >= planned.draws
            })
    };
    if findings.iter().any(|finding| is_open(&finding)) {
        // More draws do not narrow a tolerance of the case.
        if case.case.tolerance.is_given() {
            return None;
        }
        draws = draws.max(HALVING * planned.draws as f64);
    }
    Some(draws)
}
