//! Failures of a run, finding by finding, in words that the console and the reports share.

use crate::case::sweep::SweptQuantity;
use crate::record::{Finding, Record, Row, Verdict};
use crate::report::fields::{Shown, Table, shown};
use crate::report::lists::joined;
use crate::report::run::checks_csv::FindingRow;
use crate::report::run::summary_csv::SummaryRow;
use gate::CheckId;
use gate::causes::{Pattern, SweepPart};

/// Finding with another verdict than pass, with its row.
#[derive(Debug, Clone, Copy)]
pub struct Failure<'a> {
    /// The experiment and channel.
    pub row: Row<'a>,
    /// Finding; `None` if the row has a verdict and no findings.
    pub finding: Option<&'a Finding>,
    /// The run's seed.
    pub seed: u64,
}

/// Returns the failures of all rows with this verdict. A finding about an experiment as a whole belongs to all of its
/// rows, and is listed once.
pub fn failing(record: &Record, verdict: Verdict) -> Vec<Failure<'_>> {
    let seed = record.results.seed;
    let rows = record.results.rows().filter(|row| row.verdict == Some(verdict));
    let failures = rows.flat_map(|row| of_row(row, seed));
    let is_own = |failure: &Failure| {
        let is_of_channel = |finding: &Finding| !finding.channel.is_empty();
        failure.row.is_first() || failure.finding.is_none_or(is_of_channel)
    };
    failures.filter(is_own).collect()
}

/// Returns the findings that gave a row its verdict.
pub fn of_row(row: Row<'_>, seed: u64) -> Vec<Failure<'_>> {
    let mut failures: Vec<Failure> =
        row.deciding().map(|finding| Failure { row, finding: Some(finding), seed }).collect();
    if failures.is_empty() {
        failures.push(Failure { row, finding: None, seed });
    }
    failures
}

impl Failure<'_> {
    /// Returns its experiment; without a channel if it concerns the experiment as a whole.
    pub fn experiment(&self) -> String {
        let channel = self.finding.map_or(&self.row.values.channel, |finding| &finding.channel);
        self.row.name_with(channel)
    }

    /// Returns the check; `None` if the row has no findings.
    pub fn check(&self) -> Option<CheckId> {
        self.finding.map(|finding| finding.check)
    }

    /// Returns the check's name; empty if the row has no findings.
    pub fn check_name(&self) -> &'static str {
        self.check().map_or("", CheckId::name)
    }

    /// Returns the address of the random numbers: `seed 1, block 3`.
    pub fn place(&self) -> String {
        let block = self.finding.and_then(|finding| finding.block);
        let block = block.map_or_else(String::new, |block| format!(", block {block}"));
        format!("seed {}{block}", self.seed)
    }

    /// Returns everything but the command, on one line.
    pub fn line(&self) -> String {
        let experiment = self.experiment();
        let reason = self.reason();
        let parts = [self.row.case.name.as_str(), &experiment, self.check_name(), &reason];
        format!("{} ({})", joined(parts, ": "), self.place())
    }

    /// Returns everything that is known, one name and value per line, and the usual causes. Names are those of the files.
    pub fn details(&self) -> String {
        let Self { row, finding, seed } = *self;
        let known =
            |name: &str, text: String| (!text.is_empty()).then(|| format!("{name}: {text}"));
        let line = SummaryRow { row, seed };
        let finding = finding.map(|finding| FindingRow { of: row, finding });
        let reason = finding.is_none().then(|| self.reason());
        let stream = row.experiment.stream.map(|stream| stream.to_string());
        let mut lines = vec![
            known("case", row.case.name.clone()),
            known("experiment", self.experiment()),
            known("reason", reason.unwrap_or_default()),
        ];
        lines.extend(finding.iter().flat_map(|finding| texts(finding, OF_FINDING, known)));
        lines.extend(texts(&line, OF_ROW, known));
        lines.push(known("stream", stream.unwrap_or_default()));
        lines.extend(row.next_command().map(|(word, command)| known(word, command.to_owned())));
        lines.into_iter().flatten().chain(causes(&row)).collect::<Vec<_>>().join("\n") + "\n"
    }
}

/// Fields of a finding in its details.
const OF_FINDING: &[Shown] = shown!(FindingRow:
    "check", "what", "verdict", "reason", "block", "draws", "mean_of_y", "tolerance", "ln_e", "ln_e_limit", "ln_p_above",
    "ln_p_below", "ln_p_limit", "needed", "z", "p"
);

/// Fields of its row.
const OF_ROW: &[Shown] = shown!(SummaryRow:
    "seed", "mean", "standard_error", "truth", "z_mean", "variance", "predicted_variance", "z_variance",
    "lookups_per_draw", "predicted_lookups", "z_lookups"
);

/// Returns fields of a row as text, by name.
fn texts<T: Table>(
    row: &T,
    columns: &[Shown],
    text: impl Fn(&str, String) -> Option<String>,
) -> Vec<Option<String>> {
    let fields = T::fields();
    let field = |column: &Shown| &fields[column.place];
    columns.iter().map(field).map(|field| text(field.name, field.text(row))).collect()
}

/// Smallest number of swept values for which an end is distinguished.
const MIN_POINTS: usize = 3;

/// Returns the likely causes of a failing row, line by line; empty for a row that does not fail.
pub fn causes(row: &Row) -> Vec<String> {
    pattern(row).lines()
}

/// Returns which checks of a row fail, on which side, and at which place of the sweep.
pub fn pattern(row: &Row) -> Pattern {
    let mut pattern = Pattern::default();
    if row.verdict != Some(Verdict::Fail) {
        return pattern;
    }
    // A declared bias that is not shown is no evidence of a bug.
    let failing = row.findings().filter(|f| f.verdict == Verdict::Fail && !f.expects_bias);
    for finding in failing {
        // Draws without randomness fail a bound, not the gate, so that the bias comes from the mean.
        let measured = || row.mean.zip(row.truth).map(|(mean, truth)| mean - truth);
        let off = finding.gate.map(|gate| gate.mean);
        pattern.note(
            finding.check,
            off.or_else(|| measured().filter(|_| finding.check == CheckId::Mean)),
        );
    }
    pattern.place = place(row);
    pattern
}

/// Returns the end of a sweep of σ̂ if an estimator fails at that end only, else [`Place::Anywhere`].
fn place(row: &Row) -> SweepPart {
    let swept = row.case.sweep.as_ref().map(|sweep| sweep.what);
    if !matches!(swept, Some(SweptQuantity::Sampling | SweptQuantity::SamplingScale)) {
        return SweepPart::Anywhere;
    }
    let is_same = |other: &Row| {
        (other.experiment.listed, &other.channel) == (row.experiment.listed, &row.channel)
            && other.verdict != Some(Verdict::Refused)
    };
    let along = row.case.rows().filter(is_same).filter_map(|other| {
        Some((other.experiment.swept()?, other.verdict == Some(Verdict::Fail)))
    });
    let mut along: Vec<(f64, bool)> = along.collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Failing values must be contiguous: exactly one change along the sweep.
    let changes = along.windows(2).filter(|pair| pair[0].1 != pair[1].1).count();
    match (along.len() >= MIN_POINTS && changes == 1, along.first()) {
        (true, Some((_, true))) => SweepPart::LowEnd,
        (true, Some((_, false))) => SweepPart::HighEnd,
        _ => SweepPart::Anywhere,
    }
}
