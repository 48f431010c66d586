//! What is said of another program's draws, on the screen: a small block of lines.

use std::fmt::Write;

use crate::harness::record::Verdict;
use crate::judge::judgement::{IndependenceFinding, Judgement, ScalarFinding, Stop};
use crate::report::console::layout::wrapped;
use crate::report::number::{count, fixed, short, signed};

/// The widest word at the left.
const INDENT: usize = 10;

/// The block, `width` columns wide.
pub fn block(judgement: &Judgement, name: &str, width: usize) -> String {
    let mut text = String::new();
    let mut line = |word: &str, what: &str| {
        for (i, part) in wrapped(what, width.max(40) - INDENT).iter().enumerate() {
            let word = if i == 0 { word } else { "" };
            let _ = writeln!(text, "{word:INDENT$}{part}");
        }
    };
    line("draws", &draws(judgement, name));
    line("mean", &mean(judgement));
    if let Some(variance) = variance(judgement) {
        line("variance", &variance);
    }
    if let Some(lookups) = lookups(judgement) {
        line("lookups", &lookups);
    }
    for finding in &judgement.findings {
        line("gate", &gate(finding));
    }
    if let Some(drift) = &judgement.drift {
        let (word, found, limit) = (drift.verdict.word(), drift.ln_e, drift.ln_e_limit);
        line("drift", &format!("ln E = {found:.1} of {limit:.1} for a change of the mean: {word}"));
    }
    line("order", &order(&judgement.independence));
    for promise in &judgement.guarantees {
        line("promise", promise);
    }
    let why =
        if judgement.reason.is_empty() { String::new() } else { format!(": {}", judgement.reason) };
    line("verdict", &format!("{}{why}", judgement.verdict.word()));
    text
}

/// What several verdicts come to.
pub fn together(judged: &[(String, Judgement)], worst: Verdict, alpha: f64) -> String {
    let of = |verdict: Verdict| {
        let count = judged.iter().filter(|(_, judgement)| judgement.verdict == verdict).count();
        (count > 0).then(|| format!("{count} {}", verdict.word()))
    };
    let counts: Vec<String> =
        [Verdict::Pass, Verdict::Fail, Verdict::Inconclusive].into_iter().filter_map(of).collect();
    let alpha = short(alpha, 3);
    format!(
        "\n{}: {} of {} files, α = {alpha} shared\n",
        worst.word(),
        counts.join(", "),
        judged.len()
    )
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
    let evidence = format!("ln E = {:.1} of {:.1}", found.ln_e, found.ln_e_limit);
    if found.is_refuted() {
        format!("{evidence}: {}", found.reason)
    } else {
        format!("{evidence} against independent draws: nothing found")
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
