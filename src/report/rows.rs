//! The rows of a record joined with their case and their timing, as CSV and JSON.
//!
//! `summary.csv`, the files of the cases and `--format csv|json` share these columns, so that a
//! number has one name everywhere.

use serde::ser::{Serialize, Serializer};

use crate::harness::record::{CaseRecord, Record, Row, Verdict};
use crate::report::ReportError;
use crate::report::number::exact;

/// A row of the record with what it belongs to.
#[derive(Debug, Clone, Copy)]
pub struct JoinedRow<'a> {
    /// The case.
    pub case: &'a CaseRecord,
    /// The row.
    pub row: &'a Row,
    /// The run's seed.
    pub seed: u64,
    /// Processor seconds of the experiment's drawing.
    pub seconds: Option<f64>,
    /// Whether an earlier run drew it.
    pub is_reused: bool,
}

impl JoinedRow<'_> {
    /// Nanoseconds of processor time for one lookup of `σ_t`; `None` where nothing was looked up.
    #[must_use]
    pub fn ns_per_lookup(&self) -> Option<f64> {
        let lookups = self.row.drawn? as f64 * self.row.lookups_per_draw?;
        (lookups > 0.0).then_some(self.seconds? * 1e9 / lookups)
    }
}

/// Every row of the record, joined.
#[must_use]
pub fn joined(record: &Record) -> Vec<JoinedRow<'_>> {
    let seed = record.results.seed;
    let mut rows = Vec::new();
    for (c, case) in record.results.cases.iter().enumerate() {
        for (r, row) in case.rows.iter().enumerate() {
            let seconds = record.timing.rows.get(c).and_then(|rows| *rows.get(r)?);
            let reused = record.timing.reused.get(c).and_then(|rows| rows.get(r));
            let is_reused = reused.copied().unwrap_or_default();
            rows.push(JoinedRow { case, row, seed, seconds, is_reused });
        }
    }
    rows
}

/// What stands in one field.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words; empty where there are none.
    Text(String),
    /// A word of a fixed list, if there is one.
    Word(Option<&'static str>),
    /// A number, if it is known.
    Number(Option<f64>),
    /// A count, if it is known.
    Count(Option<u64>),
    /// Numbers; empty where there are none.
    List(Vec<f64>),
}

impl Cell {
    /// The field in a CSV file; empty where unknown.
    #[must_use]
    pub fn csv(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Word(word) => word.unwrap_or_default().to_owned(),
            Self::Number(number) => number.map(exact).unwrap_or_default(),
            Self::Count(count) => count.map(|n| n.to_string()).unwrap_or_default(),
            Self::List(list) => list.iter().map(|&x| exact(x)).collect::<Vec<_>>().join(" "),
        }
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(text) => serializer.serialize_str(text),
            Self::Word(word) => word.serialize(serializer),
            Self::Number(number) => number.serialize(serializer),
            Self::Count(count) => count.serialize(serializer),
            Self::List(list) => list.serialize(serializer),
        }
    }
}

/// A column: its name in files and what stands in it.
#[derive(Clone, Copy)]
pub struct Column {
    /// The name in the first line.
    pub name: &'static str,
    /// The field.
    pub cell: fn(&JoinedRow) -> Cell,
    /// Whether it differs from run to run, so that results proper leave it out.
    pub timed: bool,
}

macro_rules! columns {
    ($($name:ident = |$joined:ident| $cell:expr;)*) => {
        &[$(Column { name: stringify!($name), cell: |$joined| $cell, timed: false }),*]
    };
    (timed $($name:ident = |$joined:ident| $cell:expr;)*) => {
        &[$(Column { name: stringify!($name), cell: |$joined| $cell, timed: true }),*]
    };
}

use Cell::{Count, List, Number, Text, Word};

const RESULTS: &[Column] = columns! {
    case = |joined| Text(joined.case.name.clone());
    problem = |joined| Text(joined.case.problem.clone());
    medium = |joined| Text(joined.case.medium.clone());
    estimator = |joined| Text(joined.row.estimator.clone());
    sampling = |joined| Number(joined.row.sampling);
    control = |joined| Text(joined.row.control.clone());
    channel = |joined| Text(joined.row.channel.clone());
    seed = |joined| Count(Some(joined.seed));
    draws = |joined| Count(joined.row.draws);
    mean = |joined| Number(joined.row.mean);
    standard_error = |joined| Number(joined.row.standard_error);
    truth = |joined| Number(joined.row.truth);
    truth_error = |joined| Number(joined.row.truth_error);
    z_mean = |joined| Number(joined.row.z_mean);
    variance = |joined| Number(joined.row.variance);
    predicted_variance = |joined| Number(joined.row.predicted_variance);
    z_variance = |joined| Number(joined.row.z_variance);
    lookups_per_draw = |joined| Number(joined.row.lookups_per_draw);
    predicted_lookups = |joined| Number(joined.row.predicted_lookups);
    z_lookups = |joined| Number(joined.row.z_lookups);
    predicted_kurtosis = |joined| Number(joined.row.predicted_kurtosis);
    detectable_bias = |joined| Number(joined.row.detectable_bias);
    fom = |joined| Number(joined.row.fom);
};

const TIMED: &[Column] = columns! { timed
    seconds = |joined| Number(joined.seconds);
    ns_per_lookup = |joined| Number(joined.ns_per_lookup());
};

const VERDICTS: &[Column] = columns! {
    verdict = |joined| Word(joined.row.verdict.map(Verdict::word));
    reason = |joined| Text(joined.row.reason.clone());
    sampling_kind = |joined| Text(joined.row.sampling_kind.clone());
    swept = |joined| Number(joined.row.swept);
    predicted_skewness = |joined| Number(joined.row.predicted_skewness);
    predicted_fom = |joined| Number(joined.row.predicted_fom);
    stable_share = |joined| Number(joined.row.stable_share);
    best_sampling = |joined| Number(joined.row.best_sampling);
    best_fom = |joined| Number(joined.row.best_fom);
    p_law = |joined| Number(joined.row.p_law);
    drawn = |joined| Count(joined.row.drawn);
    kernel = |joined| Text(joined.row.kernel.clone());
    same_as = |joined| Text(joined.row.same_as.clone());
    sharing = |joined| Count(joined.row.sharing);
    skipped = |joined| Number(joined.row.skipped);
    loss_1 = |joined| Number(joined.row.losses.map(|losses| losses[0]));
    loss_2 = |joined| Number(joined.row.losses.map(|losses| losses[1]));
    loss_3 = |joined| Number(joined.row.losses.map(|losses| losses[2]));
    loss_4 = |joined| Number(joined.row.losses.map(|losses| losses[3]));
    relative_m2 = |joined| Number(joined.row.relative_moments[0]);
    relative_m3 = |joined| Number(joined.row.relative_moments[1]);
    relative_m4 = |joined| Number(joined.row.relative_moments[2]);
    lookups_variance = |joined| Number(joined.row.lookups_variance);
    rare_event_size = |joined| Number(joined.row.rare_event_size);
    log_unit = |joined| Number(joined.row.log_unit);
};

const KEPT: &[Column] = columns! { timed
    reused = |joined| Word(joined.is_reused.then_some("yes"));
};

/// What later versions added.
const ERRORS: &[Column] = columns! {
    moments_error = |joined| Number(joined.row.moments_error);
};

/// Which z of a row are not to be read as normal.
const NORMALITY: &[Column] = columns! {
    not_normal = |joined| Text(joined.row.not_normal.join(" "));
};

/// What JSON has beside the columns.
const LISTS: &[Column] = columns! {
    lookups_pmf = |joined| List(joined.row.lookups_pmf.clone());
};

/// The columns, in the order in which files have them.
pub fn columns() -> impl Iterator<Item = &'static Column> + Clone {
    RESULTS.iter().chain(TIMED).chain(VERDICTS).chain(KEPT).chain(ERRORS).chain(NORMALITY)
}

/// The rows of a record as CSV, with a first line of names.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn csv(record: &Record) -> Result<String, ReportError> {
    let header = columns().map(|column| column.name);
    let rows = joined(record);
    let lines = rows.iter().map(|row| columns().map(|column| (column.cell)(row).csv()));
    table("the rows", header, lines)
}

/// The rows of a record as a JSON array of objects, one to a line. The names are the columns of
/// the CSV, and `lookups_pmf`, an array that is empty where it is unknown or long; unknown is `null`, and so is an infinite number, which JSON cannot write.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn json(record: &Record) -> Result<String, ReportError> {
    let rows = joined(record);
    let objects: Result<Vec<_>, _> =
        rows.iter().map(|row| serde_json::to_string(&Object(row))).collect();
    let objects = objects?.join(",\n");
    Ok(if objects.is_empty() { "[]\n".to_owned() } else { format!("[\n{objects}\n]\n") })
}

struct Object<'a>(&'a JoinedRow<'a>);

impl Serialize for Object<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let all = columns().chain(LISTS);
        serializer.collect_map(all.map(|column| (column.name, (column.cell)(self.0))))
    }
}

/// CSV text of a header and lines; `name` is what an error speaks of.
pub(in crate::report) fn table<H, L, F>(
    name: &str,
    header: H,
    lines: L,
) -> Result<String, ReportError>
where
    H: IntoIterator<Item = &'static str>,
    L: IntoIterator<Item = F>,
    F: IntoIterator<Item = String>,
{
    let wrong = |source| ReportError::Csv { name: name.to_owned(), source };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).map_err(wrong)?;
    for line in lines {
        writer.write_record(line).map_err(wrong)?;
    }
    let bytes = writer.into_inner().map_err(|error| wrong(error.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
