//! Tests of the whole distribution of foreign draws, a test or several from each page that has any.
//!
//! Foreign draws may be rounded. Values are matched within their rounding. Distances are not tested if the test would
//! notice how many of them rounding moves across the ends of classes. Resolutions of 22 bits or of single precision
//! count as fine; coarser ones fail, and finer ones are reported.

use std::borrow::Cow;

use super::distribution::DistributionTest;
use gate::session::TestRequest;
use theory::Prediction;

/// Relative error of a product in single precision.
const SINGLE_PRODUCT: f64 = 1e-5;
/// Error of a distance in single precision, relative to its position.
const SINGLE_POSITION: f64 = 1.2e-7;

/// Properties of foreign draws on which their tests depend.
#[derive(Debug, Clone, Copy)]
pub struct ForeignDraws<'a> {
    /// The prediction of theory.
    pub prediction: &'a Prediction,
    /// Number, values, lookups and rounding of the draws.
    pub request: TestRequest,
    /// True if all draws are numbers of single precision.
    pub is_single: bool,
}

impl<'a> ForeignDraws<'a> {
    /// Returns the prediction if the draws have all of its channels.
    pub fn in_full(&self) -> Option<&'a Prediction> {
        (self.request.values == self.prediction.channels.len()).then_some(self.prediction)
    }

    /// Returns the rounding error of a product, relative to it.
    pub fn error_of_product(&self) -> f64 {
        self.error(SINGLE_PRODUCT)
    }

    /// Returns the rounding error of a distance, relative to its position.
    pub fn error_of_position(&self) -> f64 {
        self.error(SINGLE_POSITION)
    }

    fn error(&self, single: f64) -> f64 {
        if self.is_single { single } else { 0.0 }.max(self.request.rounding)
    }
}

/// Test of the distribution of foreign draws.
pub struct ForeignTest {
    /// Name of the distribution in sentences.
    pub what: Cow<'static, str>,
    /// The test, or the reason why it is missing.
    pub test: Result<Box<dyn DistributionTest>, String>,
    /// Smallest and largest number of draws for which the test is valid.
    pub between: [f64; 2],
}

/// Any number of draws.
pub const ANY: [f64; 2] = [0.0, f64::INFINITY];

impl ForeignTest {
    /// Returns a test that is valid for numbers of draws between two; none if there is no test.
    pub fn of(
        what: &'static str,
        test: Option<impl DistributionTest + 'static>,
        between: [f64; 2],
    ) -> Vec<Self> {
        let test = test.map(|test| Self { what: what.into(), test: Ok(Box::new(test)), between });
        test.into_iter().collect()
    }
}
