//! `CASE.csv`, `CASE.theory.csv` and `CASE.anatomy.csv`: data of the plots of a case.
//!
//! They have results only, without timing, so that the files are the same to the byte for any number of threads on any
//! machine.

use crate::record::{Anatomy, CaseRecord, Record, Row, Sweep};
use crate::report::fields::table;
use crate::report::run::fields::{TIMED, of_files};
use crate::report::run::summary_csv::Line;
use crate::report::{Artifact, ReportError, case_path};
use numeric::digits::exact;

/// Returns the rows, the predicted curves and the profiles of each case.
///
/// # Errors
///
/// An encoder or the painter fails.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let mut artifacts = Vec::new();
    for case in &record.results.cases {
        let rows = case_rows(case, record.results.seed)?;
        artifacts.push(Artifact::text(case_path(&case.name, "csv"), rows));
        if let Some(sweep) = &case.sweep {
            artifacts
                .push(Artifact::text(case_path(&case.name, "theory.csv"), theory(case, sweep)?));
        }
        if let Some(anatomy) = &case.anatomy {
            artifacts.push(Artifact::text(
                case_path(&case.name, "anatomy.csv"),
                profiles(case, anatomy)?,
            ));
        }
    }
    Ok(artifacts)
}

/// Column of deviations, for error bars.
type Bar = (&'static str, fn(&Row) -> Option<f64>);

fn case_rows(case: &CaseRecord, seed: u64) -> Result<String, ReportError> {
    let mut untimed = of_files();
    untimed.retain(|column| !TIMED.contains(&column.name));
    let bars: [Bar; 2] = [
        ("variance_deviation", |row| row.variance_deviation),
        ("lookups_deviation", |row| row.experiment.lookups_deviation),
    ];
    let header = untimed.iter().map(|column| column.name).chain(bars.map(|(name, _)| name));
    let lines = case.rows().map(|row| {
        let line = Line { row, seed };
        let fields = untimed.iter().map(move |column| (column.cell)(&line).csv());
        fields.chain(bars.map(|(_, value)| value(&row).map(exact).unwrap_or_default()))
    });
    table(&case.name, header, lines)
}

fn theory(case: &CaseRecord, sweep: &Sweep) -> Result<String, ReportError> {
    // Problems with one channel have no name for it.
    let is_named = sweep.curves.iter().any(|curve| !curve.channel.is_empty());
    let words = ["estimator", "control", "channel"];
    let words = &words[..if is_named { 3 } else { 2 }];
    let header = words.iter().copied().chain(["x", "variance", "lookups", "fom", "setup_lookups"]);
    let lines = sweep.curves.iter().flat_map(|curve| {
        curve.points.iter().map(|point| {
            let texts = [curve.estimator.clone(), curve.control.clone(), curve.channel.clone()];
            let numbers = [point.x, point.variance, point.lookups, point.fom].map(exact);
            let setup = point.setup_lookups.to_string();
            texts.into_iter().take(words.len()).chain(numbers).chain([setup])
        })
    });
    table(&case.name, header, lines)
}

fn profiles(case: &CaseRecord, anatomy: &Anatomy) -> Result<String, ReportError> {
    let columns: [(&str, &[f64]); 7] = [
        ("t", &anatomy.t),
        ("extinction", &anatomy.extinction),
        ("control", &anatomy.control),
        ("residual", &anatomy.residual),
        ("sampling", &anatomy.sampling),
        ("transmittance", &anatomy.transmittance),
        ("deviation", &anatomy.deviation),
    ];
    let lines = (0..anatomy.t.len())
        .map(|i| columns.map(|(_, values)| values.get(i).copied().map(exact).unwrap_or_default()));
    table(&case.name, columns.map(|(name, _)| name), lines)
}
