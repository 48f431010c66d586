//! Sweep of a case: every experiment is drawn at every value of one quantity.
//!
//! | key | varies | takes |
//! |---|---|---|
//! | `sweep.sampling` | a constant σ̂, for every estimator without its own | 1/length, > 0 |
//! | `sweep.sampling-scale` | a factor on each estimator's own σ̂ | > 0 |
//! | `sweep.albedo` | the albedo, of the medium or of estimators that have one of their own | 0 to 1 |
//! | `sweep.control` | a constant control, for estimators that take one and have none of their own | 1/length |
//! | `sweep.points` | the number of explorer points, for controls through explorers | whole, ≥ 2 |
//! | `sweep.density` | a factor s on σ_t, σ̂ and σ_c, wherever they are given in 1/length | > 0 |
//! | `sweep.albedo-scale` | a factor s on the medium's albedos, which stay within [0, 1] | ≥ 0 |
//! | `sweep.contrast` | the contrast c of settings that are listed channel by channel: σ_t, σ̂, albedos and `p_f` | ≥ 0 |
//!
//! ```text
//! contrast   x_λ → (1 − c) x̄ + c x_λ,  x̄ the mean over the channels: grey at c = 0, as written at c = 1
//! ```
//!
//! The channels then share one field with different extinctions. An estimator's σ̂ for all channels moves likewise
//! about the mean of the case's `sampling` list, and the largest of the list stays the largest. The last three sweeps
//! change the answer: every estimator is drawn at every value.
//!
//! Each is a list of values, as in `sweep.sampling = [1, 2, 4]`, which is short for `{ values = [ … ] }`. The other
//! form is `{ from, to, points, scale }` with `scale = "linear"` or `"log"`: `points` values from end to end.
//! Estimators that do not depend on the swept quantity are drawn once.

use media::catalogue::{Domain, Settings};
use serde::{Deserialize, Serialize};

/// The quantity that a sweep varies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SweptQuantity {
    /// A constant σ̂, for every estimator without its own.
    Sampling,
    /// A factor on each estimator's own σ̂.
    SamplingScale,
    /// The albedo, of the medium or of estimators that have one of their own.
    Albedo,
    /// A constant control, for every estimator that takes one and has none of its own.
    Control,
    /// The number of explorer points, for controls through explorers.
    Points,
    /// A factor on all extinctions.
    Density,
    /// A factor on the medium's albedos.
    AlbedoScale,
    /// Factor on the distance of the channels from their mean.
    Contrast,
}

/// Swept quantity with one of its values; `None` outside the sweep.
pub type Variation = Option<(SweptQuantity, f64)>;

/// Every quantity with its key in case files, the axis title, and the range of its values.
const KINDS: [(SweptQuantity, &str, &str, Domain); 8] = {
    use Domain::{Finite, NonNegative, Positive, Unit};
    [
        (SweptQuantity::Sampling, "sampling", "sampling extinction σ̂ [1/length]", Positive),
        (SweptQuantity::SamplingScale, "sampling-scale", "factor on σ̂", Positive),
        (SweptQuantity::Albedo, "albedo", "albedo a", Unit),
        (SweptQuantity::Control, "control", "control σ_c [1/length]", Finite),
        (SweptQuantity::Points, "points", "explorer points", Positive),
        (SweptQuantity::Density, "density", "density: factor on σₜ and σ̂", Positive),
        (SweptQuantity::AlbedoScale, "albedo-scale", "factor on the albedos", NonNegative),
        (SweptQuantity::Contrast, "contrast", "colour contrast c", NonNegative),
    ]
};

/// Swept quantity and its values.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepAxis {
    /// Swept quantity.
    pub what: SweptQuantity,
    /// The values, in the order of the case.
    pub values: Vec<f64>,
    /// True if they are spaced by factors.
    pub log: bool,
}

impl SweptQuantity {
    /// Returns the key in case files.
    pub fn key(self) -> &'static str {
        self.kind().1
    }

    /// Returns the axis title with symbol and unit.
    pub fn axis(self) -> &'static str {
        self.kind().2
    }

    /// Returns all quantities, in the order of the manual.
    pub fn all() -> impl Iterator<Item = Self> {
        KINDS.iter().map(|kind| kind.0)
    }

    /// Returns whether the medium itself varies, and with it the answer.
    pub fn varies_medium(self) -> bool {
        matches!(self, Self::Density | Self::AlbedoScale | Self::Contrast)
    }

    /// Returns whether the quantity can have that value.
    pub fn allows(self, value: f64) -> bool {
        let is_whole = self != Self::Points || (value >= 2.0 && value.fract() == 0.0);
        self.kind().3.contains(value) && is_whole
    }

    /// Returns the values that it can have, in words.
    pub fn domain(self) -> &'static str {
        if self == Self::Points { "a whole number from 2" } else { self.kind().3.words() }
    }

    fn kind(self) -> &'static (SweptQuantity, &'static str, &'static str, Domain) {
        KINDS.iter().find(|kind| kind.0 == self).unwrap_or(&KINDS[0])
    }
}

impl SweepAxis {
    /// Reads `sweep.WHAT = { from, to, points, scale }` or `{ values }`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let names: Vec<String> = KINDS.iter().map(|kind| kind.1.to_owned()).collect();
        let (index, sweep) = settings.choice(&names)?;
        let (what, _, _, domain) = KINDS[index];
        let read = if sweep.has("values") {
            let values = sweep.numbers("values", domain, 1);
            sweep.close();
            values.map(|values| {
                let log = is_log(&values);
                Self { what, values, log }
            })
        } else {
            Self::read_range(what, domain, &sweep)
        };
        let read = read?;
        if what == SweptQuantity::Points && !read.values.iter().all(|&n| what.allows(n)) {
            let help = "explorer points are whole numbers from 2";
            sweep.fault_at(sweep.span.clone(), "", "these are no numbers of points", help);
            return None;
        }
        Some(read)
    }

    fn read_range(what: SweptQuantity, domain: Domain, sweep: &Settings) -> Option<Self> {
        let from = sweep.number("from", domain);
        let to = sweep.number("to", domain);
        let points = sweep.count("points", 1..=1000);
        let scale = sweep.word_or("scale", &["linear", "log"], "linear");
        sweep.close();
        let (from, to, points, log) = (from?, to?, points?, scale? == "log");
        if log && (from <= 0.0 || to <= 0.0) {
            sweep.fault("scale", "a log scale needs positive ends", "write scale = \"linear\"");
            return None;
        }
        let at = |i: u64| {
            let u = if points == 1 { 0.0 } else { i as f64 / (points - 1) as f64 };
            // The last point is the end as written, without rounding.
            match (i + 1 == points && points > 1, log) {
                (true, _) => to,
                (false, true) => from * (to / from).powf(u),
                (false, false) => from + (to - from) * u,
            }
        };
        let round = |x: f64| if what == SweptQuantity::Points { x.round() } else { tidy(x) };
        let mut values: Vec<f64> = (0..points).map(at).map(round).collect();
        values.dedup();
        Some(Self { what, values, log })
    }
}

/// Rounds a swept value to nine significant digits: 0.55652 reads better in tables than 0.5565196017382173, and is as
/// good a point to test at.
fn tidy(x: f64) -> f64 {
    format!("{x:.8e}").parse().unwrap_or(x)
}

/// Returns whether positive values spread over a factor of 8 or more: then a log axis shows them better.
fn is_log(values: &[f64]) -> bool {
    let (low, high) =
        values.iter().fold((f64::INFINITY, 0.0f64), |(low, high), &x| (low.min(x), high.max(x)));
    low > 0.0 && high >= 8.0 * low
}
