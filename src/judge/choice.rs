//! Choice of one experiment of a case, and what may be wrong with it.

use numeric::digits::{number, short};

/// Which experiment of a case.
#[derive(Debug, Clone, Copy, Default)]
pub struct Choice<'a> {
    /// The estimator's label in tables, or its name in the catalogue.
    pub estimator: &'a str,
    /// The swept value, where it is swept.
    pub swept: Option<f64>,
    /// Whether the nearest value of the case's sweep is taken in place of the swept value. Otherwise the value is taken
    /// as it is, be it in the sweep or not; without a sweep it is a constant σ̂.
    pub nearest: bool,
    /// The channel, where a draw has several.
    pub channel: Option<&'a str>,
    /// The seed of pilot rays, where σ̂ is learned from them.
    pub seed: u64,
}

/// Reason why no draws can be judged by a choice.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs)] // messages name the fields
pub enum ChoiceError {
    /// No estimator of that name.
    #[error("{case}: no estimator is called `{name}`; choose one of: {}", candidates.join(", "))]
    NoEstimator { case: String, name: String, candidates: Vec<String> },
    /// Several estimators of that name.
    #[error("{case}: several estimators are called `{name}`; choose one of: {}", candidates.join(", "))]
    Ambiguous { case: String, name: String, candidates: Vec<String> },
    /// The value of the sweep is missing.
    #[error(
        "{case}: `{estimator}` is swept over {what}: {}; say at which value your draws were made, by --swept (in Python \
         sampling=, elsewhere the last argument of `of`); any value will do that is {wanted}",
        list(values)
    )]
    Swept {
        case: String,
        estimator: String,
        what: &'static str,
        values: Vec<f64>,
        wanted: &'static str,
    },
    /// A value that the swept thing cannot have.
    #[error(
        "{case}: `{estimator}`: {what} = {} is not {wanted}{}",
        number(*value),
        near(*nearest)
    )]
    NoSuchValue {
        case: String,
        estimator: String,
        what: &'static str,
        value: f64,
        wanted: &'static str,
        nearest: Option<f64>,
    },
    /// A value of a sweep where nothing is swept.
    #[error("{case}: `{estimator}` is not swept; leave the swept value and --nearest out")]
    NotSwept { case: String, estimator: String },
    /// A draw has several values.
    #[error("{case}: a draw has {} channels; choose one of: {}", channels.len(), channels.join(", "))]
    Channel { case: String, channels: Vec<String> },
    /// Theory works in units of a transmittance that few doubles hold.
    #[error(
        "{case}: `{estimator}` sees an optical depth of {depth:.0}, where theory is in units of T; multiply the \
         draws by e^τ and give the truth 1 and what else is known of them by numbers"
    )]
    Deep { case: String, estimator: String, depth: f64 },
    /// The experiment is refused.
    #[error(
        "{case}: `{estimator}` is refused: {why}{}",
        if nearest.is_some() { near(*nearest) } else { "; choose an estimator that is unbiased there".to_owned() }
    )]
    Refused { case: String, estimator: String, why: String, nearest: Option<f64> },
}

/// Largest number of values that are listed; longer lists are cut in the middle.
const LISTED: usize = 8;

/// Values as tables print them; of many the first and the last.
fn list(values: &[f64]) -> String {
    let words = |values: &[f64]| {
        let words: Vec<String> = values.iter().map(|&value| short(value, 4)).collect();
        words.join(", ")
    };
    match values {
        [first @ .., last] if values.len() > LISTED => {
            format!("{}, …, {} ({} values)", words(&first[..3]), short(*last, 4), values.len())
        }
        _ => words(values),
    }
}

/// The value of a sweep that could be meant.
fn near(nearest: Option<f64>) -> String {
    let named = |value: f64| {
        format!("; the nearest value of the sweep is {}: give it, or add --nearest", number(value))
    };
    nearest.map_or(String::new(), named)
}
