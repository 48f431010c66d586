//! A judgement in words: a few lines, each with a word at its left, for every console and every language.

use std::fmt::{self, Write};

use super::judgement::{DistributionFinding, IndependenceFinding, Judgement, ScalarFinding, Stop};
use crate::stats::verdict::Verdict;
use numeric::digits::{count, fixed, short, signed};

impl Judgement {
    /// The lines on draws of that name: what each is about, and what it says.
    pub fn lines(&self, name: &str) -> Vec<(&'static str, String)> {
        let mut lines = vec![("draws", draws(self, name))];
        lines.extend(self.theory.iter().map(|about| ("theory", about.clone())));
        lines.push(("mean", mean(self)));
        lines.extend(variance(self).map(|text| ("variance", text)));
        lines.extend(lookups(self).map(|text| ("lookups", text)));
        lines.extend(self.findings.iter().map(|finding| ("gate", gate(finding))));
        if let Some(drift) = &self.drift {
            let (word, found, limit) = (drift.verdict.word(), drift.ln_e, drift.ln_e_limit);
            let shown = match drift.verdict {
                Verdict::Pass if found >= limit => ", but later draws are like earlier ones",
                _ => "",
            };
            let text =
                format!("ln E = {found:.1} of {limit:.1} for a change of the mean{shown}: {word}");
            lines.push(("drift", text));
        }
        lines.extend(self.distribution.iter().map(|found| ("p-value", p_value(found))));
        lines.push(("order", order(&self.independence)));
        lines.extend(self.guarantees.iter().map(|promise| ("promise", promise.clone())));
        lines.push(("verdict", self.to_string()));
        lines.extend(self.pattern().lines().into_iter().map(|line| ("likely", line)));
        lines
    }
}

/// The verdict, and why.
impl fmt::Display for Judgement {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (word, reason) = (self.verdict.word(), &self.reason);
        if reason.is_empty() { f.write_str(word) } else { write!(f, "{word}: {reason}") }
    }
}

fn draws(judgement: &Judgement, name: &str) -> String {
    let read = count(judgement.draws);
    let of = match judgement.length {
        Some(length) if length != judgement.draws => format!(" of {}", count(length)),
        _ => String::new(),
    };
    let rest = match judgement.stopped {
        Some(Stop::Decided) => "; all was decided, and the rest was not read",
        Some(Stop::Limit) => "; the rest was not read",
        None => "",
    };
    let batch = match judgement.batch {
        1 => String::new(),
        batch => format!(", judged as averages of {}", count(batch)),
    };
    format!("{read}{of} in {name}{rest}{batch}")
}

fn lookups(judgement: &Judgement) -> Option<String> {
    let (found, claimed) = (judgement.lookups?, judgement.predicted_lookups?);
    Some(format!("{} a draw, {} expected", short(found, 8), short(claimed, 8)))
}

/// Whether the draws depend on each other.
fn order(found: &IndependenceFinding) -> String {
    let evidence = match found.replay_ln_p {
        Some(ln_p) => format!("probability e^{ln_p:.1} or less"),
        None => format!("ln E = {:.1} of {:.1}", found.ln_e, found.ln_e_limit),
    };
    match &found.reason {
        Some(reason) => format!("{evidence}: {reason}"),
        None => format!("{evidence} against independent draws: nothing found"),
    }
}

fn mean(judgement: &Judgement) -> String {
    let Some(mean) = judgement.mean else { return "–".into() };
    let truth = short(judgement.truth, 10);
    let error = judgement.standard_error.map(|error| format!(" ± {}", short(error, 3)));
    let kind = if judgement.predicted_variance.is_some() { "predicted" } else { "estimated" };
    let error = error.map_or(String::new(), |error| format!("{error} ({kind})"));
    let z = judgement.z.map_or(String::new(), |z| format!(", z = {}", signed(z)));
    format!("{}{error}, truth {truth}{z}", fixed(mean, 8))
}

fn variance(judgement: &Judgement) -> Option<String> {
    let mut text = format!("s² = {}", short(judgement.variance?, 6));
    if let Some(ratio) = judgement.variance_ratio {
        let _ = write!(text, ", s²/V = {}", fixed(ratio, 5));
        if let Some(band) = judgement.variance_band {
            let _ = write!(text, " (1 ± {})", short(band, 2));
        }
    }
    if let Some(kurtosis) = judgement.kurtosis {
        let _ = write!(text, ", sample kurtosis {}", short(kurtosis, 4));
    }
    Some(text)
}

/// The test of a distribution.
fn p_value(found: &DistributionFinding) -> String {
    let DistributionFinding { check, what, verdict, p, draws, .. } = found;
    let (p, draws) = (short(*p, 3), count(*draws));
    format!("{check}: p = {p} for {what} after {draws} draws: {}", verdict.word())
}

fn gate(finding: &ScalarFinding) -> String {
    let check = &finding.check;
    let word = finding.verdict.word();
    let Some(gate) = &finding.gate else { return format!("{check} not tested: {word}") };
    let [above, below] = gate.ln_p;
    let estimated = match (finding.is_estimated, check.as_str()) {
        (true, "variance") => " · kurtosis estimated",
        (true, _) => " · variance estimated",
        _ => "",
    };
    format!(
        "{check}: ε = {}, ln E = {above_e:.1} of {limit:.1}, ln P± = {above:.1} and {below:.1} of \
         {pass:.1} after {} draws: {word}{estimated}",
        short(gate.tolerance, 3),
        count(gate.draws),
        above_e = gate.ln_e,
        limit = gate.ln_e_limit,
        pass = gate.ln_p_limit,
    )
}
