//! Deviations of measured quantities from theory, in the one form that every message uses.
//!
//! ```text
//! +17 % (measured 0.00590, expected 0.00503), z = +23.8 over 4e6 draws
//! ```
//!
//! The percentage is relative to the expected value. `z` is the deviation in standard errors of that many draws.

use std::fmt;

use numeric::digits::{count, fixed, short};

/// Maximum number of digits that distinguish a measured from an expected value.
const MAX_DIGITS: usize = 12;

/// A measured quantity beside its expected value.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Deviation {
    /// The measured value.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub measured: f64,
    /// The value that theory expects, in the same unit.
    #[cfg_attr(feature = "serde", serde(with = "crate::extended"))]
    pub expected: f64,
    /// The deviation in standard errors; `None` where the standard error is not known.
    pub z: Option<f64>,
    /// Number of measured draws.
    pub draws: u64,
    /// Unit in which draws are counted.
    pub unit: DrawUnit,
}

/// Unit in which draws are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum DrawUnit {
    /// Single draws.
    Draws,
    /// Averages of several draws.
    Averages,
    /// Whole images.
    Passes,
}

impl DrawUnit {
    /// The word, in the plural.
    pub fn word(self) -> &'static str {
        match self {
            Self::Draws => "draws",
            Self::Averages => "averages",
            Self::Passes => "passes",
        }
    }
}

impl Deviation {
    /// The deviation of a mean over `draws` draws.
    pub fn new(measured: f64, expected: f64, draws: u64) -> Self {
        Self { measured, expected, z: None, draws, unit: DrawUnit::Draws }
    }

    /// Deviation with its number of standard errors, if that is a finite number.
    #[must_use]
    pub fn with_z(self, z: f64) -> Self {
        Self { z: Some(z).filter(|z| z.is_finite()), ..self }
    }

    /// (measured − expected)/|expected|; `None` where the expected value is 0.
    pub fn relative(&self) -> Option<f64> {
        let relative = (self.measured - self.expected) / self.expected.abs();
        relative.is_finite().then_some(relative)
    }
}

impl fmt::Display for Deviation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let &Self { measured, expected, draws, unit, .. } = self;
        match self.relative() {
            Some(relative) => f.write_str(&signed_percent(relative))?,
            None => f.write_str(&signed(measured - expected, 2))?,
        }
        let digits = distinct_digits(measured, expected);
        let (measured, expected) = (fixed(measured, digits), fixed(expected, digits));
        write!(f, " (measured {measured}, expected {expected})")?;
        if let Some(z) = self.z {
            write!(f, ", z = {}", score(z))?;
        }
        write!(f, " over {} {}", count(draws), unit.word())
    }
}

/// A relative difference in percent with its sign: two significant digits, all digits of whole percents below 1000.
pub fn signed_percent(relative: f64) -> String {
    let percent = 100.0 * relative;
    let digits = if (99.5..999.5).contains(&percent.abs()) { 3 } else { 2 };
    format!("{} %", signed(percent, digits))
}

/// A number with its sign.
fn signed(x: f64, digits: usize) -> String {
    let text = short(x, digits);
    if x > 0.0 { format!("+{text}") } else { text }
}

/// A z-score with three digits.
fn score(z: f64) -> String {
    match z.abs() {
        size if size < 10.0 => format!("{z:+.2}"),
        size if size < 1e4 => format!("{z:+.1}"),
        _ => format!("{z:+.1e}"),
    }
}

/// Number of digits at which two numbers differ by two places.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 3 and MAX_DIGITS
fn distinct_digits(a: f64, b: f64) -> usize {
    let relative = (a - b).abs() / a.abs().max(b.abs());
    let places = -relative.log10();
    // A power of ten is not rounded up.
    let places = (places - 1e-6).ceil();
    let digits = if places.is_finite() { (places + 2.0).max(3.0) } else { 3.0 };
    (digits as usize).min(MAX_DIGITS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_has_percent_values_z_and_draws() {
        let written = |measured, expected, z| {
            Deviation::new(measured, expected, 4_000_000).with_z(z).to_string()
        };
        // 0.0059/0.00503 − 1 = 17.3 %.
        let usual = "+17 % (measured 0.00590, expected 0.00503), z = +23.8 over 4e6 draws";
        assert_eq!(written(0.0059, 0.005_03, 23.8), usual);
        let small = "-0.01 % (measured 0.999900, expected 1.00000), z = -5.12 over 4e6 draws";
        assert_eq!(written(0.9999, 1.0, -5.12), small);
        let large = "+133 % (measured 2.33, expected 1.00), z = +1.2e5 over 4e6 draws";
        assert_eq!(written(2.33, 1.0, 123_456.0), large);
        let huge = "+1.2e5 % (measured 1200, expected 1.00), z = +99.0 over 4e6 draws";
        assert_eq!(written(1200.0, 1.0, 99.0), huge.replace("1200,", "1.20e3,"));
        let negative = "-50 % (measured -3.00, expected -2.00), z = -4.00 over 4e6 draws";
        assert_eq!(written(-3.0, -2.0, -4.0), negative);
    }

    #[test]
    fn without_an_expected_value_or_a_standard_error_they_are_left_out() {
        let zero = Deviation::new(0.25, 0.0, 1000).with_z(f64::INFINITY).to_string();
        assert_eq!(zero, "+0.25 (measured 0.250, expected 0) over 1000 draws");
        let equal =
            Deviation { unit: DrawUnit::Averages, ..Deviation::new(1.0, 1.0, 16) }.to_string();
        assert_eq!(equal, "0 % (measured 1.00, expected 1.00) over 16 averages");
    }
}
