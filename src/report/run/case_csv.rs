//! `CASE.csv`, `CASE.theory.csv` and `CASE.anatomy.csv`: data of the plots of a case.
//!
//! They have results only, without timing, so that the files are the same to the byte for any number of threads on any
//! machine.

use crate::record::{Anatomy, CaseRecord, CurvePoint, PredictedCurve, Record, Sweep};
use crate::report::fields::{self, Field, Table, fields, place, table};
use crate::report::run::fields::TIMED;
use crate::report::run::summary_csv::SummaryRow;
use crate::report::{Artifact, ReportError, case_path};

/// Returns the rows, the predicted curves and the profiles of each case.
pub fn render(record: &Record) -> Result<Vec<Artifact>, ReportError> {
    let mut artifacts = Vec::new();
    for case in &record.results.cases {
        let mut keep =
            |ending, text| artifacts.push(Artifact::text(case_path(&case.name, ending), text));
        keep("csv", case_rows(case, record.results.seed)?);
        if let Some(sweep) = &case.sweep {
            keep("theory.csv", theory(case, sweep)?);
        }
        if let Some(anatomy) = &case.anatomy {
            keep("anatomy.csv", profiles(case, anatomy)?);
        }
    }
    Ok(artifacts)
}

fn case_rows(case: &CaseRecord, seed: u64) -> Result<String, ReportError> {
    let mut fields = SummaryRow::of_files();
    fields.retain(|field| !TIMED.contains(&field.name));
    fields.extend(deviations());
    fields::csv(&case.name, &fields, case.rows().map(|row| SummaryRow { row, seed }))
}

/// Returns the fields of error bars, which only these files have.
pub fn deviations<'a>() -> Vec<Field<SummaryRow<'a>>> {
    fields! {
        "variance_deviation": "Standard error of the measured variance" = |line| line.variance_deviation;
        "lookups_deviation": "Standard error of the mean number of lookups" = |line| line.experiment.lookups_deviation;
    }
}

/// Point of a predicted curve.
pub struct Predicted<'a> {
    curve: &'a PredictedCurve,
    point: &'a CurvePoint,
}

table! {
    impl<'a> for Predicted<'a> {
        "estimator" = |of| &of.curve.estimator;
        "control" = |of| &of.curve.control;
        "channel": "Which value of a draw; the column is missing if a draw is one value" = |of| &of.curve.channel;
        "x": "Value of the swept quantity" = |of| of.point.x;
        "variance": "Variance of one draw" = |of| of.point.variance;
        "lookups": "Expected number of lookups of a draw" = |of| of.point.lookups;
        "fom": "Figure of merit 1/(variance × lookups)" = |of| of.point.fom;
        "setup_lookups" = |of| of.point.setup_lookups;
    }
}

fn theory(case: &CaseRecord, sweep: &Sweep) -> Result<String, ReportError> {
    let mut fields = Predicted::fields();
    if sweep.curves.iter().all(|curve| curve.channel.is_empty()) {
        fields.remove(const { place::<Predicted>("channel") });
    }
    let curves = sweep.curves.iter();
    let points =
        curves.flat_map(|curve| curve.points.iter().map(|point| Predicted { curve, point }));
    fields::csv(&case.name, &fields, points)
}

/// Point of the ray of a case.
pub struct RayPoint<'a> {
    anatomy: &'a Anatomy,
    number: usize,
}

impl RayPoint<'_> {
    fn of(&self, values: fn(&Anatomy) -> &[f64]) -> Option<f64> {
        values(self.anatomy).get(self.number).copied()
    }
}

table! {
    impl<'a> for RayPoint<'a> {
        "t": "Distance along the ray" = |place| place.of(|ray| &ray.t);
        "extinction": "Extinction σ_t" = |place| place.of(|ray| &ray.extinction);
        "control": "Control extinction σ_c; empty without one" = |place| place.of(|ray| &ray.control);
        "residual": "σ_t − σ_c" = |place| place.of(|ray| &ray.residual);
        "sampling": "Sampling extinction σ̂" = |place| place.of(|ray| &ray.sampling);
        "transmittance": "Transmittance T(t)" = |place| place.of(|ray| &ray.transmittance);
        "deviation": "Standard deviation of a draw of T(t); empty if unknown" = |place| place.of(|ray| &ray.deviation);
    }
}

fn profiles(case: &CaseRecord, anatomy: &Anatomy) -> Result<String, ReportError> {
    let places = (0..anatomy.t.len()).map(|number| RayPoint { anatomy, number });
    fields::csv(&case.name, &RayPoint::fields(), places)
}
