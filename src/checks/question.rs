//! Questions about draws, and what a check knows when it asks them.

use super::check::Check;
use super::law::Law;
use crate::plan::options::Tolerance;
use theory::{Channel, Moments, Prediction};

/// Knowledge of a check before the first draw.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The prediction of theory.
    pub prediction: &'a Prediction,
    /// Number of draws that are planned.
    pub draws: u64,
    /// Largest number of draws that the plan may ask for.
    pub most: u64,
    /// Number of the first draws that p-values see, whatever the gate decides.
    pub fixed: u64,
    /// The differences that matter, where the case says.
    pub tolerance: Tolerance,
    /// Whether the case declares the experiment biased.
    pub expect_biased: bool,
    /// Whether an invariant holds for each draw, see [`estimators::Draw::defect`].
    pub has_invariant: bool,
    /// Whether draws come one like the other; order-free ones come sorted by their lookups.
    pub is_in_turn: bool,
    /// Spreads of pilot draws, channel by channel, where theory has none.
    pub pilots: Option<&'a [Pilot]>,
}

/// The spread of pilot draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pilot {
    /// `Σy²/n`, y the distance from their mean.
    pub variance: f64,
    /// `(Σy²)²/Σy⁴`: how many draws made the variance; its own relative deviation is about one over the
    /// root of it.
    pub size: f64,
}

impl Pilot {
    /// Of some draws.
    pub fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|x| (x - mean) * (x - mean));
        let sums = squares.fold([0.0; 2], |[two, four], y2| [two + y2, four + y2 * y2]);
        Self { variance: sums[0] / n, size: sums[0] * (sums[0] / sums[1]) }
    }
}

/// One question.
pub struct Question {
    /// The name of the check that asks.
    pub check: String,
    /// The channel it is about; `None` for the experiment as a whole.
    pub channel: Option<usize>,
    /// Name of its subject, as in `the mean`.
    pub what: String,
    /// The check that answers it.
    pub answer: Box<dyn Check>,
    /// Whether the case declares a bias, which the answer must show.
    pub expects_bias: bool,
}

impl Question {
    /// A question about the experiment as a whole, without the name of its check.
    pub fn whole(what: &str, answer: impl Check + 'static) -> Self {
        let (check, what, answer) = (String::new(), what.to_owned(), Box::new(answer));
        Self { check, channel: None, what, answer, expects_bias: false }
    }

    /// A question about a distribution, where there is one to test.
    pub fn law(what: &str, law: Option<impl Law + 'static>) -> Vec<Self> {
        law.into_iter().map(|law| Self::whole(what, law)).collect()
    }

    /// A question about one channel.
    pub fn channel(channel: usize, what: &str, answer: Box<dyn Check>) -> Self {
        let (check, what) = (String::new(), what.to_owned());
        Self { check, channel: Some(channel), what, answer, expects_bias: false }
    }
}

/// Relative error of a variance beyond which the spread of draws cannot be compared with it.
pub const BLURRED: f64 = 1e-2;

/// The last channel of an experiment and its moments, where draws can be told from them: where these are
/// known, and rounding does not spoil what draws say of them.
pub fn last_channel<'a>(subject: &Subject<'a>) -> Option<(&'a Channel, Moments)> {
    let channel = subject.prediction.channels.last()?;
    let moments = channel.moments.filter(|moments| moments.error <= BLURRED)?;
    (!super::mean::is_faint(subject, channel)).then_some((channel, moments))
}

/// Rounding of a product of `lookups` factors, relative to the result.
pub fn rounding(lookups: f64) -> f64 {
    16.0 * f64::EPSILON * (1.0 + lookups)
}

/// Rounding of a draw of an experiment, by its expected lookups.
pub fn rounding_of(subject: &Subject) -> f64 {
    rounding(subject.prediction.lookups.as_ref().map_or(0.0, |lookups| lookups.mean))
}
