//! The command that repeats an experiment.

use super::options::Options;
use super::plan::{Plan, Planned, PlannedCase};
use super::suite;

/// A word as a shell reads it, whatever is in it.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "_./:@%+=-".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// The command that draws an experiment again, and writes nothing.
pub fn command(plan: &Plan, case: &PlannedCase, planned: &Planned) -> String {
    let case = case.case;
    // A built-in case has no file, and a file has no name that the command would know.
    let is_built_in = suite::find(&case.name).is_some_and(|source| source.path == case.path);
    let place = if is_built_in { case.name.clone() } else { case.path.display().to_string() };
    // Twins are numbered by the plan; a filter sees them all under one name.
    let estimator = planned.names.estimator.split(" #").next().unwrap_or_default();
    let Options { seed, alpha, fixed, strict, kernel, blocks_per_look, .. } = plan.options;
    let (place, filter) = (quoted(&place), quoted(&format!("*:{estimator}")));
    let draws = planned.draws;
    let mut command = format!(
        "trueflight check {place} --filter {filter} --seed {seed} --draws {draws} --verbose"
    );
    if alpha != Options::default().alpha {
        command = format!("{command} --alpha {alpha}");
    }
    if let Some(kernel) = kernel {
        command = format!("{command} --kernel {}", kernel.word());
    }
    if blocks_per_look != Options::default().blocks_per_look {
        command = format!("{command} --blocks-per-look {blocks_per_look}");
    }
    for (flag, _) in [(" --fixed-draws", fixed), (" --strict", strict)].iter().filter(|f| f.1) {
        command.push_str(flag);
    }
    command
}
