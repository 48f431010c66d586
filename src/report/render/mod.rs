//! Rendered pictures as files: a sheet of all images with their errors, the images themselves as PFM and
//! EXR, and a table.

pub mod colour;
pub mod html;
pub mod palette;
pub mod sheet;

use std::path::PathBuf;

use serde::Serialize;

use crate::render::PictureRecord;
use crate::render::record::{Exposure, ExposureRecord};
use crate::report::{Artifact, ReportError};
use media::files::{exr, pfm};

/// Prefix of the names of an EXR's channels of standard errors.
const ERROR: &str = "standard_error.";

/// Returns the files of a picture: `NAME.png`, and `NAME/` with the reference and the image of each estimator, as PFM
/// and as EXR. The EXR has the standard error of each value in channels of its own.
///
/// # Errors
///
/// The sheet cannot be painted, or an image cannot be encoded.
pub fn artifacts(record: &PictureRecord) -> Result<Vec<Artifact>, ReportError> {
    let wrong = |message| ReportError::Draw { figure: record.name.clone(), message };
    let png = sheet::png(record).map_err(wrong)?;
    let mut files =
        vec![Artifact { path: PathBuf::from(format!("{}.png", record.name)), bytes: png }];
    let mut keep = |name: &str, image: &[f64], errors: &[f64]| -> Result<(), ReportError> {
        let path = |ending| PathBuf::from(format!("{}/{name}.{ending}", record.name));
        let bytes = pfm::write(record.size, record.channels, image);
        files.push(Artifact { path: path("pfm"), bytes });
        let images = [("", image), (ERROR, errors)];
        let bytes = exr::write(record.size, record.channels, &images).map_err(wrong)?;
        files.push(Artifact { path: path("exr"), bytes });
        Ok(())
    };
    keep("reference", &record.reference.image, &record.reference.errors)?;
    for (number, exposure) in (1..).zip(&record.exposures) {
        if let Ok(Exposure { image, errors, .. }) = &exposure.outcome {
            keep(&format!("{number}-{}", exposure.estimator.name), image, errors)?;
        }
    }
    Ok(files)
}

/// Returns σ̂ and control in words.
fn given(exposure: &ExposureRecord) -> String {
    let mut words = Vec::new();
    if !exposure.sampling.is_empty() {
        words.push(format!("σ̂ {}", exposure.sampling));
    }
    if !exposure.control.is_empty() {
        words.push(format!("control {}", exposure.control));
    }
    words.join(", ")
}

/// Returns three digits, without an exponent if that is short.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 {
        return "0".into();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{x:.2e}");
    }
    let decimals = [(100.0, 0), (10.0, 1), (1.0, 2), (0.1, 3), (0.01, 4), (0.001, 5)];
    let decimals =
        decimals.into_iter().find(|&(least, _)| size >= least).map_or(6, |found| found.1);
    format!("{x:.decimals$}")
}

/// Row of the table: one image.
#[derive(Serialize)]
struct Row<'a> {
    picture: &'a str,
    problem: &'a str,
    medium: &'a str,
    estimator: String,
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

/// Returns `gallery.csv`: one row for every image, without times.
///
/// # Errors
///
/// The encoder fails.
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
                estimator: exposure.estimator.to_string(),
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

#[cfg(test)]
mod tests {
    use super::short;

    #[test]
    fn numbers_have_three_digits() {
        let shown = [0.0, 123_456.0, 12.34, 0.012_345, -0.5, 1.2e-7].map(short);
        assert_eq!(shown, ["0", "123456", "12.3", "0.0123", "-0.500", "1.20e-7"]);
    }
}
