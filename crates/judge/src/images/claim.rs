//! Claims about the pixels of a pass, and mistakes in them.

use std::io;

use super::picture::{Picture, Size, Stack};
use super::variance::Estimated;
use crate::ROUNDING;
use gate::stats::verdict::FURTHEST;
use numeric::digits::counted;

/// One number for all pixels, or one for each.
#[derive(Debug, Clone, PartialEq)]
pub enum Level {
    /// Number for all pixels.
    All(f64),
    /// One number for each value of a pass. A picture of one channel stands for all channels.
    Each(Picture),
}

impl Level {
    pub(super) fn spread(&self, what: &str, size: Size) -> Result<Vec<f64>, ImageError> {
        match self {
            Self::All(value) => Ok(vec![*value; size.values()]),
            Self::Each(picture) => {
                let actual = picture.size;
                if actual == size {
                    return Ok(picture.values.clone());
                }
                if actual != (Size { channels: 1, ..size }) {
                    let (file, other) = (format!("the picture of the {what}"), "a pass".to_owned());
                    return Err(ImageError::Differ { file, actual, other, expected: size });
                }
                let pixels = picture.values.iter();
                Ok(pixels.flat_map(|&x| std::iter::repeat_n(x, size.channels)).collect())
            }
        }
    }

    fn rounding(&self) -> f64 {
        match self {
            Self::All(_) => 0.0,
            Self::Each(picture) => picture.rounding,
        }
    }
}

/// Claim about correct pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Claim {
    /// Their means.
    pub truth: Level,
    /// Number of independent passes that the truth is the mean of; `None` for an exact truth. Needs a variance.
    pub truth_passes: Option<usize>,
    /// The variance of a pixel of one pass, if it is known.
    pub variance: Option<Level>,
    /// Number of independent passes, other than those judged, that the variance is the sample variance of; `None` for
    /// an exact variance. Entries below 0 count as 0; a value with a variance of NaN or infinity is not judged.
    pub variance_passes: Option<usize>,
    /// Independent passes with the distribution of the pixels, from which the variance is estimated, instead of
    /// `variance`.
    pub variance_stack: Option<Stack>,
    /// Upper bound of the kurtosis (3 for the normal distribution) of the values of a tile about their truths. Without
    /// any variance it is a ground for a verdict; with an estimated variance it replaces the kurtosis that the passes
    /// show.
    pub kurtosis: Option<f64>,
    /// Range of all values, if it is known; either end may be infinite.
    pub range: Option<[f64; 2]>,
    /// Bound on the rounding error of a value, relative to its truth; at least that of the files.
    pub rounding: f64,
}

impl Claim {
    /// Claims the truth alone: a verdict also needs a variance or a range.
    pub fn of_truth(truth: Level) -> Self {
        Self {
            truth,
            truth_passes: None,
            variance: None,
            variance_passes: None,
            variance_stack: None,
            kurtosis: None,
            range: None,
            rounding: ROUNDING,
        }
    }
}

/// Claim for every value of a pass.
pub(super) struct Pixels {
    pub truth: Vec<f64>,
    pub variance: Option<Vec<f64>>,
    /// An estimated variance, if it is not exact.
    pub estimate: Option<Estimated>,
    /// 1 over the number of passes that the truth is the mean of; 0 for an exact truth.
    pub truth_share: f64,
    pub kurtosis: Option<f64>,
    pub range: Option<[f64; 2]>,
    pub rounding: f64,
    /// Mean |truth| of each channel; 1 if that is 0.
    pub units: Vec<f64>,
}

impl Pixels {
    pub(super) fn new(
        claim: &Claim,
        stack: &Stack,
        tolerance: Option<f64>,
    ) -> Result<Self, ImageError> {
        let size = stack.size;
        if !(claim.rounding >= 0.0 && claim.rounding.is_finite()) {
            let (what, value) = ("rounding", claim.rounding);
            return Err(ImageError::Number { what, value, required: "a finite number, 0 or more" });
        }
        let truth = claim.truth.spread("truth", size)?;
        let is_inside = |x: f64| match claim.range {
            Some([low, high]) => x.is_finite() && low <= x && x <= high,
            None => x.is_finite(),
        };
        let required = match claim.range {
            Some([low, high]) => format!("a number from {low} to {high}"),
            None => "a finite number".to_owned(),
        };
        check("truth", size, &truth, &is_inside, &required)?;
        check_numbers(claim)?;
        let (variance, estimate) = if let Some((variance, estimate)) = Estimated::of(claim, size)? {
            (Some(variance), Some(estimate))
        } else {
            let level = claim.variance.as_ref();
            (level.map(|variance| variance.spread("variance", size)).transpose()?, None)
        };
        if let (Some(variance), None) = (&variance, &estimate) {
            let is_fine = |x: f64| x.is_finite() && x >= 0.0;
            check("variance", size, variance, &is_fine, EXACT)?;
        }
        let mut units = vec![0.0; size.channels];
        for pixel in truth.chunks_exact(size.channels) {
            units.iter_mut().zip(pixel).for_each(|(unit, x)| *unit += x.abs());
        }
        for unit in &mut units {
            *unit /= size.pixels() as f64;
        }
        if units.iter().all(|&unit| unit == 0.0) && tolerance.is_none() {
            return Err(ImageError::NoUnit);
        }
        units.iter_mut().filter(|unit| **unit == 0.0).for_each(|unit| *unit = 1.0);
        let rounding = claim.rounding.max(stack.rounding).max(claim.truth.rounding());
        let truth_share = claim.truth_passes.map_or(0.0, |passes| 1.0 / passes as f64);
        let (range, kurtosis) = (claim.range, claim.kurtosis);
        let actual =
            Self { truth, variance, estimate, truth_share, kurtosis, range, rounding, units };
        let of = |i: usize| actual.floor(i) / actual.units[i % size.channels];
        let floor = (0..size.values()).map(of).fold(0.0, f64::max);
        match tolerance.filter(|&tolerance| tolerance < 4.0 * floor) {
            Some(tolerance) => Err(ImageError::Unresolved { tolerance, floor }),
            None => Ok(actual),
        }
    }

    /// Returns a bound on the rounding error of a value.
    pub(super) fn floor(&self, index: usize) -> f64 {
        self.rounding * self.truth[index].abs()
    }

    /// Returns whether the truth is an end of the range; the mean of a few passes may equal it without being exact.
    fn is_end(&self, index: usize) -> bool {
        let is_end = self.range.is_some_and(|range| range.contains(&self.truth[index]));
        is_end && self.truth_share == 0.0
    }

    /// Returns whether a value has no spread: by its exact variance, or because its truth is an end of the range.
    pub(super) fn is_certain(&self, index: usize) -> bool {
        let is_end = self.is_end(index);
        let exact = self.variance.as_ref().filter(|_| self.estimate.is_none());
        let variance = exact.map(|variance| variance[index]);
        is_end || variance.is_some_and(|v| FURTHEST * v.sqrt() <= self.floor(index))
    }

    /// Returns whether a value is judged: not if the estimate of its variance is no number.
    pub(super) fn is_known(&self, index: usize) -> bool {
        self.estimate.as_ref().is_none_or(|actual| !actual.is_unknown[index])
    }

    /// Returns whether a variance that was estimated is 0 everywhere.
    pub(super) fn is_flat(&self) -> bool {
        let estimated = self.variance.as_ref().filter(|_| self.estimate.is_some());
        estimated.is_some_and(|variance| variance.iter().all(|&v| v == 0.0))
    }

    /// Returns the largest distance of a value without spread from its truth.
    pub(super) fn bound(&self, index: usize) -> f64 {
        let variance = self.variance.as_ref().map_or(0.0, |variance| variance[index]);
        let is_end = self.is_end(index);
        self.floor(index) + if is_end { 0.0 } else { FURTHEST * variance.sqrt() }
    }

    /// Returns the range, widened by the rounding error at each end.
    pub(super) fn widened(&self) -> Option<[f64; 2]> {
        let [low, high] = self.range?;
        let finite = [low, high].map(|end| if end.is_finite() { end.abs() } else { 0.0 });
        let slack = self.rounding * finite[0].max(finite[1]);
        Some([low - slack, high + slack])
    }

    /// Returns the truths at some places.
    pub(super) fn truths(&self, places: &[usize]) -> Vec<f64> {
        places.iter().map(|&i| self.truth[i]).collect()
    }

    /// Returns the range of x − T for these T, in units of `unit`.
    pub(super) fn range_about(&self, truths: &[f64], unit: f64) -> Option<[f64; 2]> {
        let [low, high] = self.widened()?;
        let minimum = truths.iter().copied().fold(f64::INFINITY, f64::min);
        let maximum = truths.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Some([low - maximum, high - minimum].map(|end| end / unit))
    }

    /// Returns the range of x − T for any T in the range, in units of `unit`.
    pub(super) fn span(&self, unit: f64) -> Option<[f64; 2]> {
        self.widened().map(|[low, high]| [low - high, high - low].map(|end| end / unit))
    }
}

/// Description of a valid exact variance.
const EXACT: &str = "a finite number, 0 or more (if the variance was estimated from passes, say from how many by \
                     --variance-passes N: then such values are allowed)";

/// Validates the numbers of passes and the kurtosis.
fn check_numbers(claim: &Claim) -> Result<(), ImageError> {
    let number = |what, value, required| Err(ImageError::Number { what, value, required });
    let few = |passes: Option<usize>| passes.filter(|&passes| passes < 2);
    if let Some(passes) = few(claim.variance_passes) {
        return number("variance-passes", passes as f64, "a number of passes, 2 or more");
    }
    if claim.truth_passes == Some(0) {
        return number("truth-passes", 0.0, "a number of passes, 1 or more");
    }
    match claim.kurtosis {
        Some(k) if !(k >= 1.0 && k.is_finite()) => {
            number("kurtosis", k, "a finite number, 1 or more")
        }
        _ => Ok(()),
    }
}

pub(super) fn check(
    what: &'static str,
    size: Size,
    values: &[f64],
    is_fine: &dyn Fn(f64) -> bool,
    required: &str,
) -> Result<(), ImageError> {
    let Some(index) = values.iter().position(|&x| !is_fine(x)) else { return Ok(()) };
    let ([row, column, channel], value) = (size.place(index), values[index]);
    Err(ImageError::Pixel { what, row, column, channel, value, required: required.to_owned() })
}

/// Reason why pictures could not be read or judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // messages name the fields
pub enum ImageError {
    /// The system refused.
    #[error("{file}: {cause}; give a file that can be read")]
    Unreadable { file: String, cause: io::Error },
    /// The name does not show the format.
    #[error("{file}: its name ends with none of .npy, .pfm and .exr; give images as one of these")]
    Format { file: String },
    /// The content is not of the format of the name, or only a part of it.
    #[error("{file}: not {what} that can be read ({cause}); {cure}")]
    Faulty { file: String, what: &'static str, cause: String, cure: &'static str },
    /// The shape of an array is not that of a picture.
    #[error("{file}: an array of shape {shape}; save {required}")]
    Shape { file: String, shape: String, required: &'static str },
    /// Pictures of different sizes.
    #[error("{file}: {actual}, but {other} has {expected}; give pictures of one size")]
    Differ { file: String, actual: Size, other: String, expected: Size },
    /// Values that do not fill the picture.
    #[error(
        "{} for {} of {expected}; give one for each, and at least one",
        counted(*actual as u64, "value"),
        if *passes == 1 { "1 pass".to_owned() } else { format!("{passes} passes") }
    )]
    Count { expected: Size, passes: usize, actual: usize },
    /// One pass alone.
    #[error(
        "there is one pass; give two or more: an array of shape (passes, height, width[, channels]), \
         or several files of one pass each"
    )]
    OnePass,
    /// A pixel of a claim has an impossible value.
    #[error(
        "the {what} of row {row}, column {column}, channel {channel} is {value}, not {required}; mend it"
    )]
    Pixel {
        what: &'static str,
        row: usize,
        column: usize,
        channel: usize,
        value: f64,
        required: String,
    },
    /// A number has an impossible value.
    #[error("{what} = {value} is not {required}; give {what} as {required}")]
    Number { what: &'static str, value: f64, required: &'static str },
    /// A tolerance is smaller than rounding.
    #[error(
        "a tolerance of {tolerance:e} is below 4 times what rounding may add to a pixel, {floor:.1e} of the \
         picture's mean; give a wider tolerance, a smaller rounding, or images of more digits"
    )]
    Unresolved { tolerance: f64, floor: f64 },
    /// A truth of 0 everywhere without a tolerance.
    #[error(
        "a truth of 0 everywhere has no relative tolerance; give a tolerance, which is then absolute"
    )]
    NoUnit,
}
