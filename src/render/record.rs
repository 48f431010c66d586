//! Record of a rendered picture: everything that its reports use.

use serde::Serialize;

use super::budget::PixelValues;
use super::scene::Rendered;
use super::view::View;
use crate::case::id::EstimatorName;

/// A rendered picture.
#[derive(Debug, Clone, Serialize)]
pub struct PictureRecord {
    /// Its name.
    pub name: String,
    /// One line above it.
    pub title: String,
    /// Sentences below the title that say what to see; may be empty.
    pub caption: String,
    /// The problem's name.
    pub problem: String,
    /// The field.
    pub medium: String,
    /// Columns and rows.
    pub size: [usize; 2],
    /// Number of values of a pixel: one, or those of red, green and blue.
    pub channels: usize,
    /// Number of pixels that the volume covers.
    pub covered: usize,
    /// Number of pixels that it does not cover: they cost nothing.
    pub empty: usize,
    /// Lookups per covered pixel that every estimator was given.
    pub budget: u64,
    /// Radiance that is shown as white.
    pub white: f64,
    /// Difference that is shown in the strongest colour.
    pub strongest: f64,
    /// The reference of the images.
    pub reference: ReferenceRecord,
    /// Estimators, in the order of the file.
    pub exposures: Vec<ExposureRecord>,
}

/// Reference of images.
#[derive(Debug, Clone, Serialize)]
pub struct ReferenceRecord {
    /// Method, in words.
    pub how: String,
    /// Root mean squared error over covered pixels: measured if it was drawn; NaN if it is not known.
    pub error: f64,
    /// Its lookups per covered pixel.
    pub lookups: f64,
    /// Row after row from the top, each pixel with its channels.
    pub image: Vec<f64>,
    /// The error of each value: measured where it was drawn, a bound where it was computed.
    pub errors: Vec<f64>,
}

/// Estimator with its image or the reason of its refusal.
#[derive(Debug, Clone, Serialize)]
pub struct ExposureRecord {
    /// The estimator with its settings.
    pub estimator: EstimatorName,
    /// σ̂ in words.
    pub sampling: String,
    /// The control in words.
    pub control: String,
    /// Image, or the reason why there is no image.
    pub outcome: Result<Exposure, String>,
}

/// An image with its error and its cost. Means are over covered pixels, those of values over their channels, too.
#[derive(Debug, Clone, Serialize)]
pub struct Exposure {
    /// Row after row from the top, each pixel with its channels.
    pub image: Vec<f64>,
    /// Standard error of each value, measured: zero outside the volume, and NaN for a single draw.
    pub errors: Vec<f64>,
    /// Draws per pixel.
    pub draws: f64,
    /// Lookups per pixel.
    pub lookups: f64,
    /// Lookups per pixel of the pilot draws, which are not part of the image.
    pub pilots: f64,
    /// Root mean squared difference to the reference.
    pub rmse: f64,
    /// Predicted root mean squared difference; `None` without a prediction.
    pub predicted_rmse: Option<f64>,
    /// Mean difference to the reference.
    pub bias: f64,
    /// `1/(MSE · lookups)`; `None` without error.
    pub figure_of_merit: Option<f64>,
}

impl PictureRecord {
    /// Compares the images of a rendering with its reference.
    pub(super) fn new(words: [&String; 4], view: &View, rendered: Rendered) -> Self {
        let [name, title, caption, problem] = words.map(String::clone);
        let Rendered { budget, channels, covered, reference, images } = rendered;
        let exposures: Vec<ExposureRecord> = images
            .into_iter()
            .map(|(names, outcome)| ExposureRecord {
                estimator: names.estimator,
                sampling: names.sampling,
                control: names.control,
                outcome: outcome
                    .map(|exposed| {
                        Exposure::new(view, channels, &covered, [&reference.1, &exposed])
                    })
                    .and_then(|exposure| {
                        let is_finite = exposure.rmse.is_finite();
                        is_finite.then_some(exposure).ok_or("its image is not finite".into())
                    }),
            })
            .collect();
        let (how, exposed) = reference;
        let mut errors: Vec<f64> = exposures
            .iter()
            .filter_map(|exposure| exposure.outcome.as_ref().ok().map(|exposure| exposure.rmse))
            .collect();
        errors.sort_by(f64::total_cmp);
        let middle = errors.get(errors.len() / 2).copied().unwrap_or_default();
        let values = channels * covered.len();
        let is_whole = exposed.values.len() == values;
        let error = mean(exposed.square_errors.iter().copied(), values).sqrt();
        let error = if is_whole { error } else { f64::NAN };
        let lookups = mean(exposed.lookups.iter().map(|&n| n as f64), covered.len());
        let image = image(view, channels, &covered, &exposed.values);
        let errors = roots(view, channels, &covered, &exposed.square_errors);
        Self {
            name,
            title,
            caption,
            problem,
            medium: view.medium.clone(),
            size: view.size,
            channels,
            covered: covered.len(),
            empty: view.pixels() - covered.len(),
            budget,
            white: bright(&image),
            strongest: round_up(2.5 * middle),
            reference: ReferenceRecord { how, error, lookups, image, errors },
            exposures,
        }
    }
}

impl PictureRecord {
    /// Returns the reason why no image can be shown, and the cure; `None` if one can.
    pub fn refusal(&self) -> Option<String> {
        if self.covered == 0 {
            return Some("the volume covers no pixel: turn the camera, or move it".into());
        }
        let ReferenceRecord { how, error, image, .. } = &self.reference;
        if !(error.is_finite() && image.iter().all(|x| x.is_finite())) {
            let help = "it needs finite values, and two draws for each pixel where it is drawn";
            return Some(format!("the reference is of no use ({how}): {help}"));
        }
        let mut reasons = self.exposures.iter().map(|exposure| exposure.outcome.as_ref().err());
        if reasons.clone().any(|reason| reason.is_none()) {
            return None;
        }
        let first = reasons.next().flatten().map_or("none is listed", String::as_str);
        Some(format!("every estimator is refused; the first: {first}"))
    }
}

impl Exposure {
    fn new(
        view: &View,
        channels: usize,
        covered: &[usize],
        [truth, exposed]: [&PixelValues; 2],
    ) -> Self {
        let (pixels, values) = (covered.len(), channels * covered.len());
        let apart = || exposed.values.iter().zip(&truth.values).map(|(x, truth)| x - truth);
        let square = mean(apart().map(|x| x * x), values);
        let lookups = mean(exposed.lookups.iter().map(|&n| n as f64), pixels);
        let is_predicted = !exposed.predicted.is_empty();
        Self {
            image: image(view, channels, covered, &exposed.values),
            errors: roots(view, channels, covered, &exposed.square_errors),
            draws: mean(exposed.draws.iter().map(|&n| n as f64), pixels),
            lookups,
            pilots: exposed.pilots as f64 / pixels.max(1) as f64,
            rmse: square.sqrt(),
            predicted_rmse: is_predicted
                .then(|| mean(exposed.predicted.iter().copied(), values).sqrt()),
            bias: mean(apart(), values),
            figure_of_merit: (square > 0.0 && lookups > 0.0).then(|| 1.0 / (square * lookups)),
        }
    }
}

fn mean(values: impl Iterator<Item = f64>, count: usize) -> f64 {
    values.sum::<f64>() / count.max(1) as f64
}

/// Returns the whole image: covered pixels as drawn, the others exactly.
fn image(view: &View, channels: usize, covered: &[usize], values: &[f64]) -> Vec<f64> {
    let background = |pixel| std::iter::repeat_n(view.background(pixel), channels);
    whole((0..view.pixels()).flat_map(background).collect(), channels, covered, values)
}

/// Returns the roots of squared errors; pixels that are not covered have none.
fn roots(view: &View, channels: usize, covered: &[usize], squares: &[f64]) -> Vec<f64> {
    let roots: Vec<f64> = squares.iter().map(|square| square.sqrt()).collect();
    whole(vec![0.0; view.pixels() * channels], channels, covered, &roots)
}

/// Returns an image with the values of the covered pixels.
fn whole(mut image: Vec<f64>, channels: usize, covered: &[usize], values: &[f64]) -> Vec<f64> {
    for (&pixel, values) in covered.iter().zip(values.chunks_exact(channels)) {
        image[pixel * channels..][..channels].copy_from_slice(values);
    }
    image
}

/// Returns the 99th percentile of the pixels, so that a few bright ones do not darken the rest.
fn bright(image: &[f64]) -> f64 {
    let mut sorted = image.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = sorted.len().saturating_sub(1) * 99 / 100;
    let bright = sorted.get(at).copied().unwrap_or_default();
    if bright > 0.0 { bright } else { 1.0 }
}

/// Returns the next of 1, 2, 5, 10, … times a power of ten.
fn round_up(x: f64) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return 1.0;
    }
    let unit = 10f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0].into_iter().map(|n| n * unit).find(|&n| n >= x).unwrap_or(10.0 * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        assert_eq!([0.013, 0.2, 6.0, 0.0].map(round_up), [0.02, 0.2, 10.0, 1.0]);
    }

    #[test]
    fn a_few_bright_pixels_do_not_set_the_white() {
        let mut image = vec![0.5; 199];
        image.push(80.0);
        assert_eq!(bright(&image), 0.5);
        assert_eq!(bright(&[0.0; 4]), 1.0);
    }
}
