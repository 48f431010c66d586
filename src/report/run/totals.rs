//! Totals of a run, in words that the console and the summaries share.

use crate::record::{CaseRecord, Record, Suspect, Verdict};
use numeric::digits::{count, percent, short};

const VERDICTS: [Verdict; 5] =
    [Verdict::Pass, Verdict::Fail, Verdict::Inconclusive, Verdict::Underpowered, Verdict::Refused];

/// Meaning of a z in parentheses.
pub const NOT_NORMAL: &str = "(z): the draws are too few, or their tails too heavy, to read it as normal; the \
                              verdict does not rest on it";

/// Returns the number of rows of each verdict that occurs.
pub fn counts(cases: &[CaseRecord]) -> Vec<(Verdict, usize)> {
    let rows = || cases.iter().flat_map(CaseRecord::rows);
    let number = |verdict| rows().filter(|row| row.verdict == Some(verdict)).count();
    let all = VERDICTS.map(|verdict| (verdict, number(verdict)));
    all.into_iter().filter(|&(_, number)| number > 0).collect()
}

/// Returns the verdicts of a case: `15 pass, 1 underpowered`.
pub fn words(case: &CaseRecord) -> String {
    let counts = counts(std::slice::from_ref(case));
    let words: Vec<String> =
        counts.iter().map(|(verdict, number)| format!("{number} {}", verdict.word())).collect();
    if words.is_empty() { "no experiments".to_owned() } else { words.join(", ") }
}

/// Returns the number of draws that a case took.
pub fn draws(case: &CaseRecord) -> String {
    count(case.experiments.iter().filter_map(|experiment| experiment.drawn).sum())
}

/// Returns an entry of the e-BH list: `case: experiment: mean (ln E = 9.1)`.
pub fn suspect(suspect: &Suspect) -> String {
    let Suspect { case, experiment, check, ln_e } = suspect;
    format!("{case}: {experiment}: {check} (ln E = {})", short(*ln_e, 3))
}

/// Returns the error control of a run, fact by fact: levels, margins, assumptions, limits that ended the drawing.
pub fn control(record: &Record) -> Vec<String> {
    let results = &record.results;
    let gate = &results.gate;
    let mut facts = Vec::new();
    if gate.scalars + gate.laws > 0 {
        let (scalars, laws) = (gate.scalars, gate.laws);
        let (alpha, beta) = (short(results.alpha, 3), short(gate.beta, 3));
        facts.push(format!("{scalars} scalars and {laws} laws share α = {alpha}, β = {beta}"));
    }
    if let Some(margin) = gate.smallest_margin {
        let (largest, limit) = (short(gate.ln_e_limit - margin, 3), short(gate.ln_e_limit, 3));
        facts.push(format!("largest ln E {largest} of {limit}"));
    }
    if let Some(ln_e) = gate.ln_mean_e {
        facts.push(format!("ln of the mean e-value {}", short(ln_e, 3)));
    }
    if let Some(bias) = gate.worst_bias {
        facts.push(format!("no pass leaves room for a bias above {}", percent(bias)));
    }
    if gate.variance_assumed > 0 {
        facts.push(format!("{} passes with the variance assumed", gate.variance_assumed));
    }
    facts.push(format!("seed {}", results.seed));
    if results.cut_by_time {
        facts.push("cut short by the time limit or by hand: other machines will differ".to_owned());
    }
    if results.cut_by_budget {
        facts.push("cut short by the budget of draws".to_owned());
    }
    facts
}
