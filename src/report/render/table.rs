//! `gallery.csv`: one row for every image, without times.

use serde::Serialize;

use crate::render::PictureRecord;
use crate::render::record::Exposure;
use crate::report::ReportError;

/// One image.
#[derive(Serialize)]
struct Row<'a> {
    picture: &'a str,
    problem: &'a str,
    medium: &'a str,
    estimator: &'a str,
    sampling: &'a str,
    control: &'a str,
    columns: usize,
    rows: usize,
    covered_pixels: usize,
    empty_pixels: usize,
    budget: u64,
    draws_per_pixel: Option<f64>,
    lookups_per_pixel: Option<f64>,
    pilot_lookups_per_pixel: Option<f64>,
    rmse: Option<f64>,
    predicted_rmse: Option<f64>,
    mean_error: Option<f64>,
    figure_of_merit: Option<f64>,
    reference: &'a str,
    reference_error: f64,
    reason: &'a str,
}

/// The rows of all pictures.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn csv<'a>(
    records: impl IntoIterator<Item = &'a PictureRecord>,
) -> Result<String, ReportError> {
    let wrong = |source| ReportError::Csv { name: "gallery.csv".into(), source };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in records {
        for exposure in &record.exposures {
            let found = exposure.outcome.as_ref();
            let of = |f: fn(&Exposure) -> f64| found.ok().map(f);
            let row = Row {
                picture: &record.name,
                problem: &record.problem,
                medium: &record.medium,
                estimator: &exposure.estimator,
                sampling: &exposure.sampling,
                control: &exposure.control,
                columns: record.size[0],
                rows: record.size[1],
                covered_pixels: record.covered,
                empty_pixels: record.empty,
                budget: record.budget,
                draws_per_pixel: of(|e| e.draws),
                lookups_per_pixel: of(|e| e.lookups),
                pilot_lookups_per_pixel: of(|e| e.pilots),
                rmse: of(|e| e.rmse),
                predicted_rmse: found.ok().and_then(|e| e.predicted_rmse),
                mean_error: of(|e| e.bias),
                figure_of_merit: found.ok().and_then(|e| e.figure_of_merit),
                reference: &record.reference.how,
                reference_error: record.reference.error,
                reason: found.err().map_or("", String::as_str),
            };
            writer.serialize(row).map_err(wrong)?;
        }
    }
    let bytes = writer.into_inner().map_err(|error| wrong(error.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
