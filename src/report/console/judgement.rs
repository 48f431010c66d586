//! What is said of another program's draws, on the screen: a small block of lines.

use std::fmt::Write;

use super::layout::wrapped;
use crate::harness::foreign::judgement::{Judgement, ScalarFinding};
use crate::report::number::{count, fixed, short, signed};

/// The widest word at the left.
const INDENT: usize = 10;

/// The block, `width` columns wide.
#[must_use]
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
    for finding in &judgement.findings {
        line("gate", &gate(finding));
    }
    for promise in &judgement.guarantees {
        line("promise", promise);
    }
    let why =
        if judgement.reason.is_empty() { String::new() } else { format!(": {}", judgement.reason) };
    line("verdict", &format!("{}{why}", judgement.verdict.word()));
    text
}

fn draws(judgement: &Judgement, name: &str) -> String {
    let read = count(judgement.draws);
    match judgement.length {
        Some(length) if length != judgement.draws => {
            format!("{read} of {} in {name}; the rest was not needed", count(length))
        }
        _ => format!("{read} in {name}"),
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
        (true, "mean") => " · variance estimated",
        (true, _) => " · kurtosis estimated",
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
