//! Rendered pictures as files: a sheet of all images with their errors, the images themselves as PFM and
//! EXR, and a table.

pub mod colour;
pub mod html;
pub mod sheet;

use std::path::PathBuf;

use crate::render::PictureRecord;
use crate::render::record::{Exposure, ExposureRecord};
use crate::report::fields::{self, Table, table};
use crate::report::lists;
use crate::report::plots;
use crate::report::{Artifact, ReportError};
use media::files::{exr, pfm};

/// Prefix of the names of an EXR's channels of standard errors.
const ERROR: &str = "standard_error.";

/// Returns the files of a picture: `NAME.png`, and `NAME/` with the reference and the image of each estimator, as PFM
/// and as EXR. The EXR has the standard error of each value in channels of its own.
pub fn artifacts(record: &PictureRecord) -> Result<Vec<Artifact>, ReportError> {
    let wrong = |message| ReportError::Draw { figure: record.name.clone(), message };
    let mut files = vec![plots::picture(&record.name, |face| sheet::compose(record, face))?];
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
    let known = |name: &str, words: &str| {
        if words.is_empty() { String::new() } else { format!("{name} {words}") }
    };
    lists::joined([known("σ̂", &exposure.sampling), known("control", &exposure.control)], ", ")
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
        decimals.into_iter().find(|&(minimum, _)| size >= minimum).map_or(6, |finding| finding.1);
    format!("{x:.decimals$}")
}

/// Image with its picture.
#[derive(Debug, Clone, Copy)]
pub struct PictureImage<'a> {
    /// Picture.
    pub picture: &'a PictureRecord,
    /// Image.
    pub exposure: &'a ExposureRecord,
}

impl PictureImage<'_> {
    fn finding<T>(&self, figure: fn(&Exposure) -> T) -> Option<T> {
        self.exposure.outcome.as_ref().ok().map(figure)
    }
}

table! {
    impl<'a> for PictureImage<'a> {
        "picture": "Name of the picture" = |of| &of.picture.name;
        "problem" = |of| &of.picture.problem;
        "medium" = |of| &of.picture.medium;
        "estimator" = |of| of.exposure.estimator.to_string();
        "sampling" ["σ̂", "", Plain]: "Sampling extinction σ̂, in words" = |of| &of.exposure.sampling;
        "control" = |of| &of.exposure.control;
        "columns": "Width of the picture in pixels" = |of| of.picture.size[0];
        "rows": "Height of the picture in pixels" = |of| of.picture.size[1];
        "covered_pixels": "Number of pixels that the volume covers" = |of| of.picture.covered;
        "empty_pixels": "Number of pixels that take no lookup" = |of| of.picture.empty;
        "budget": "Lookups of a covered pixel" = |of| of.picture.budget;
        "draws_per_pixel" ["draws/pixel", "", Short(3)]: "Draws of a pixel" = |of| of.finding(|finding| finding.draws);
        "lookups_per_pixel" ["lookups/pixel", "", Short(3)]: "Lookups of σ_t for a pixel" = |of| of.finding(|finding| finding.lookups);
        "pilot_lookups_per_pixel": "Lookups of pilot rays for a pixel" = |of| of.finding(|finding| finding.pilots);
        "rmse" ["RMSE", "", Short(3)]: "Root mean squared difference from the reference" = |of| of.finding(|finding| finding.rmse);
        "predicted_rmse" ["in theory", "", Short(3)]: "Root mean squared difference in theory" = |of| of.finding(|finding| finding.predicted_rmse).flatten();
        "mean_error" ["mean error", "", Short(3)]: "Mean difference from the reference" = |of| of.finding(|finding| finding.bias);
        "figure_of_merit" ["1/(MSE · lookups)", "", Short(3)]: "Figure of merit: larger is better" = |of| of.finding(|finding| finding.figure_of_merit).flatten();
        "reference": "Source of the reference" = |of| &of.picture.reference.how;
        "reference_error": "Root mean squared error of the reference" = |of| of.picture.reference.error;
        "reason" ["refused", "", Plain]: "Reason why there is no image" = |of| of.exposure.outcome.as_ref().err().map_or("", String::as_str);
    }
}

/// Returns the images of pictures.
pub fn joined<'a>(
    pictures: impl IntoIterator<Item = &'a PictureRecord>,
) -> impl Iterator<Item = PictureImage<'a>> {
    let images = |picture: &'a PictureRecord| {
        picture.exposures.iter().map(move |exposure| PictureImage { picture, exposure })
    };
    pictures.into_iter().flat_map(images)
}

/// Returns `gallery.csv`: one row for every image, without times.
pub fn csv<'a>(
    pictures: impl IntoIterator<Item = &'a PictureRecord>,
) -> Result<String, ReportError> {
    fields::csv("gallery.csv", &PictureImage::fields(), joined(pictures))
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
