//! Totals of a run, in words that the console and the summaries share.

use crate::record::baseline::Comparison;
use crate::record::{CaseRecord, Record, Suspect, Verdict};
use crate::report::lists::joined;
use numeric::digits::{count, percent, short};

/// Verdict with what tables and pages say of it.
#[derive(Debug, Clone, Copy)]
pub struct KnownVerdict {
    /// The verdict.
    pub verdict: Verdict,
    /// Mark that distinguishes it without colours.
    pub mark: &'static str,
    /// Meaning, in a sentence.
    pub meaning: &'static str,
}

const fn known(verdict: Verdict, mark: &'static str, meaning: &'static str) -> KnownVerdict {
    KnownVerdict { verdict, mark, meaning }
}

/// All verdicts, the most serious first.
pub const VERDICTS: [KnownVerdict; 5] = [
    known(
        Verdict::Fail,
        "✗",
        "Differs from theory by more than chance allows, or a draw is not a number.",
    ),
    known(
        Verdict::Inconclusive,
        "?",
        "Not decided by the draws that were made; the row has the command that decides it.",
    ),
    known(
        Verdict::Underpowered,
        "~",
        "Too few draws to promise a pass, known before the first one; it can still fail.",
    ),
    known(
        Verdict::Refused,
        "⊘",
        "Not drawn: the estimator does not exist or is biased here; the reason names the place on the ray.",
    ),
    known(
        Verdict::Pass,
        "✓",
        "Agrees with theory, and a bias as large as the tolerance ε has been ruled out.",
    ),
];

/// Order of the counts.
const COUNTED: [Verdict; 5] =
    [Verdict::Pass, Verdict::Fail, Verdict::Inconclusive, Verdict::Underpowered, Verdict::Refused];

/// Meaning of a z in parentheses.
pub const NOT_NORMAL: &str = "(z): the draws are too few, or their tails too heavy, to read it as normal; the \
                              verdict does not rest on it";

/// Returns the number of rows of each verdict that occurs.
pub fn counts(cases: &[CaseRecord]) -> Vec<(Verdict, usize)> {
    let rows = || cases.iter().flat_map(CaseRecord::rows);
    let number = |verdict| rows().filter(|row| row.verdict == Some(verdict)).count();
    let all = COUNTED.map(|verdict| (verdict, number(verdict)));
    all.into_iter().filter(|&(_, number)| number > 0).collect()
}

/// Returns the verdicts of a case: `15 pass, 1 underpowered`.
pub fn words(case: &CaseRecord) -> String {
    let counts = counts(std::slice::from_ref(case)).into_iter();
    let words =
        joined(counts.map(|(verdict, number)| format!("{number} {}", verdict.word())), ", ");
    if words.is_empty() { "no experiments".to_owned() } else { words }
}

/// Returns the number of draws that a case took.
pub fn draws(case: &CaseRecord) -> String {
    count(case.experiments.iter().filter_map(|experiment| experiment.drawn).sum())
}

/// Returns the e-BH list without what fails by itself: the most suspect of all other findings.
pub fn suspects(record: &Record) -> Vec<&Suspect> {
    let gate = &record.results.gate;
    gate.triage.iter().filter(|suspect| suspect.ln_e < gate.ln_e_limit).collect()
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
    let (scalars, laws) = (gate.scalars, gate.laws);
    if scalars + laws > 0 {
        let (alpha, beta) = (short(results.alpha, 3), short(gate.beta, 3));
        facts.push(format!(
            "{scalars} scalars and {laws} distributions share α = {alpha}, β = {beta}"
        ));
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

/// Verdict on the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RunVerdict {
    /// Style class, which gives the colour.
    pub class: &'static str,
    failing: usize,
    open: usize,
    is_worse: bool,
    /// Number of rows.
    pub rows: usize,
}

/// Returns the verdict on a run: a failure, or a regression against a stored run, precedes inconclusive results.
pub fn verdict(record: &Record) -> RunVerdict {
    let counts = counts(&record.results.cases);
    let number =
        |verdict| counts.iter().find(|count| count.0 == verdict).map_or(0, |count| count.1);
    let [failing, open, passing] =
        [Verdict::Fail, Verdict::Inconclusive, Verdict::Pass].map(number);
    let is_worse = record.comparison.as_ref().is_some_and(Comparison::fails);
    let class = match (failing > 0 || is_worse, open > 0, passing > 0) {
        (true, ..) => "fail",
        (_, true, _) => "inconclusive",
        (.., true) => "pass",
        _ => "refused",
    };
    let rows = record.results.rows().count();
    RunVerdict { class, failing, open, is_worse, rows }
}

impl RunVerdict {
    /// Returns it in one line.
    pub fn words(&self) -> String {
        let Self { failing, open, is_worse, rows, class } = *self;
        let parts = [
            (failing > 0).then(|| format!("{failing} of {rows} fail")),
            is_worse.then(|| "something became worse than the baseline".to_owned()),
            (open > 0).then(|| format!("{open} of {rows} are inconclusive")),
        ];
        match class {
            "pass" => format!("pass: nothing of {rows} fails or is inconclusive"),
            "refused" => format!("nothing was tested: none of {rows} passes or fails"),
            word => format!("{word}: {}", joined(parts.into_iter().flatten(), ", ")),
        }
    }

    /// Returns what it means for the estimators, in a sentence.
    pub fn meaning(&self, record: &Record) -> String {
        let results = &record.results;
        let bias = results.gate.worst_bias.filter(|bias| bias.is_finite()).map(percent);
        let comparison = record.comparison.as_ref().filter(|_| self.failing == 0 && self.is_worse);
        if let Some(comparison) = comparison {
            return format!(
                "An unchanged program shows such a change with a probability of {} a run.",
                short(comparison.rules.alpha, 3)
            );
        }
        match (self.class, bias) {
            ("fail", _) => format!(
                "Correct estimators show any failure with a probability of {} a run.",
                short(results.alpha, 3)
            ),
            ("inconclusive", _) => {
                "Nothing differs from theory, but more draws must show that nothing is hidden."
                    .to_owned()
            }
            ("pass", Some(bias)) => format!(
                "Every mean that passes is right to {bias}: one that is off by more would have passed with a \
                 probability below {}.",
                percent(results.gate.beta)
            ),
            ("pass", None) => "Nothing differs from theory by more than chance allows.".to_owned(),
            _ => "Every estimator is refused here: `trueflight plan` says why.".to_owned(),
        }
    }
}
