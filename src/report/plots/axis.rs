//! Axis: its range, its ticks, and the positions of values on it.

use numeric::digits::short;

/// Axis of a panel.
#[derive(Debug, Clone)]
pub struct Axis {
    /// Title with symbol and unit.
    pub title: String,
    /// True if it is logarithmic.
    pub log: bool,
    /// Value at its beginning.
    pub low: f64,
    /// Value at its end.
    pub high: f64,
}

/// Mark on an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tick {
    /// Value.
    pub at: f64,
    /// Label; empty for a small mark.
    pub label: String,
}

/// Returns the logarithm of a value on a logarithmic axis, otherwise the value.
fn scaled(log: bool, value: f64) -> f64 {
    if log { value.log10() } else { value }
}

/// Returns the range that contains a value, too, if that is finite.
fn widened([low, high]: [f64; 2], value: f64) -> [f64; 2] {
    if value.is_finite() { [low.min(value), high.max(value)] } else { [low, high] }
}

impl Axis {
    /// Returns an axis that shows all values which it can show, with a margin of this share of its length on both
    /// sides. An axis that can show none goes from 0.1 to 1.
    pub fn around(
        title: impl Into<String>,
        log: bool,
        margin: f64,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for value in values {
            range = widened(range, scaled(log, value));
        }
        Self::over(title.into(), log, margin, range)
    }

    /// Returns the axis over a range of scaled values.
    fn over(title: String, log: bool, margin: f64, [low, high]: [f64; 2]) -> Self {
        let scale = |value| scaled(log, value);
        let (low, high) = if low > high { (scale(0.1), scale(1.0)) } else { (low, high) };
        let minimum = if log { 0.02 } else { low.abs().max(high.abs()).max(1e-300) * 1e-6 };
        let widen = if high - low < minimum {
            if log { 0.3 } else { low.abs().max(1e-3) * 0.1 }
        } else {
            margin * (high - low)
        };
        let mut axis = Self { title, log, low: 0.0, high: 0.0 };
        axis.low = axis.unscaled(low - widen);
        axis.high = axis.unscaled(high + widen);
        axis
    }

    /// Returns the axis with room beyond its end, by a share of its length.
    #[must_use]
    pub fn extended(self, share: f64) -> Self {
        let [low, high] = [self.low, self.high].map(|value| self.scaled(value));
        Self { high: self.unscaled(high + share * (high - low)), ..self }
    }

    /// Returns the position of a value: 0 at the beginning, 1 at the end; `None` if it has none, as zero on a
    /// logarithmic axis.
    pub fn place(&self, value: f64) -> Option<f64> {
        let [low, high, at] = [self.low, self.high, value].map(|v| self.scaled(v));
        let place = (at - low) / (high - low);
        place.is_finite().then_some(place)
    }

    /// Returns the marks, about as many labels as `count`.
    pub fn ticks(&self, count: usize) -> Vec<Tick> {
        let mut ticks = if self.log { self.log_ticks(count) } else { self.even_ticks(count) };
        ticks.retain(|tick| self.place(tick.at).is_some_and(|p| (-1e-9..=1.0 + 1e-9).contains(&p)));
        ticks
    }

    fn scaled(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }

    fn unscaled(&self, value: f64) -> f64 {
        // Short of the ends of f64, so that the range stays finite and positive.
        if self.log { 10_f64.powf(value.clamp(-300.0, 300.0)) } else { value.clamp(-1e300, 1e300) }
    }

    fn log_ticks(&self, count: usize) -> Vec<Tick> {
        let (low, high) = (self.low.log10(), self.high.log10());
        if high - low < 0.6 {
            return self.even_ticks(count);
        }
        // Both are within ±300.
        #[expect(clippy::cast_possible_truncation)]
        let (first, last) = (low.floor() as i32, high.ceil() as i32);
        let decades = usize::try_from(last - first).unwrap_or(1).max(1);
        let few = high - low < 2.2;
        let step = i32::try_from(decades.div_ceil(count.max(1))).unwrap_or(1);
        let powers = self.low < 0.9e-3 || self.high > 1.1e4;
        let mut ticks = Vec::new();
        for exponent in first..=last {
            let decade = 10_f64.powi(exponent);
            for digit in 1..10_u8 {
                let labelled = match digit {
                    1 => exponent.rem_euclid(step) == 0,
                    2 | 5 => few,
                    3 | 7 => high - low < 0.9,
                    _ => false,
                };
                if labelled {
                    let label = log_label(digit, exponent, powers);
                    ticks.push(Tick { at: f64::from(digit) * decade, label });
                } else if step == 1 || (digit == 1 && decades < 30) {
                    ticks.push(Tick { at: f64::from(digit) * decade, label: String::new() });
                }
            }
        }
        ticks
    }

    fn even_ticks(&self, count: usize) -> Vec<Tick> {
        let step = nice_step((self.high - self.low) / count.max(1) as f64);
        if !(step.is_finite() && step > 0.0) {
            return Vec::new();
        }
        let first = (self.low / step).ceil();
        let largest = self.low.abs().max(self.high.abs());
        let label = |at: f64| {
            if (1e-3..1e5).contains(&largest) {
                let places = (-(step * 1.0001).log10().floor()).clamp(0.0, 12.0);
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // 0 to 12
                let places = places as usize;
                format!("{at:.places$}").replace('-', "−")
            } else {
                in_powers(&short(at, 3))
            }
        };
        (0..=4 * u32::try_from(count).unwrap_or(8))
            .map(|i| (first + f64::from(i)) * step)
            .take_while(|&at| at <= self.high + 1e-9 * step)
            // A zero with a rounding error would be labelled −0.
            .map(|at| if at.abs() < 1e-9 * step { 0.0 } else { at })
            .map(|at| Tick { at, label: label(at) })
            .collect()
    }
}

/// Returns the smallest of 1, 2, 5 times a power of ten that is not below `rough`.
fn nice_step(rough: f64) -> f64 {
    let power = 10_f64.powf(rough.log10().floor());
    let nice = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power >= rough * 0.999);
    nice.unwrap_or(10.0) * power
}

fn log_label(digit: u8, exponent: i32, powers: bool) -> String {
    if !powers || (0..=1).contains(&exponent) {
        let places = usize::try_from(-exponent).unwrap_or(0);
        return format!("{:.places$}", f64::from(digit) * 10_f64.powi(exponent));
    }
    let power = format!("10{}", raised(exponent));
    if digit == 1 { power } else { format!("{digit}·{power}") }
}

/// Returns `2.5e-7` as `2.5·10⁻⁷`.
fn in_powers(text: &str) -> String {
    let text = text.replace('-', "−");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let exponent = exponent.replace('−', "-").parse().unwrap_or(0);
    format!("{mantissa}·10{}", raised(exponent))
}

fn raised(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raise = |c: char| match c.to_digit(10) {
        Some(digit) => DIGITS[digit as usize],
        None => '⁻',
    };
    exponent.to_string().chars().map(raise).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks(6).into_iter().map(|t| t.label).filter(|l| !l.is_empty()).collect()
    }

    fn axis(log: bool, low: f64, high: f64) -> Axis {
        Axis { title: String::new(), log, low, high }
    }

    #[test]
    fn a_decade_has_readable_ticks() {
        assert_eq!(labels(&axis(true, 0.4, 4.0)), ["0.5", "1", "2"]);
        assert_eq!(labels(&axis(true, 0.9, 2.1)), ["1.0", "1.2", "1.4", "1.6", "1.8", "2.0"]);
        assert_eq!(labels(&axis(true, 0.2, 1e4)), ["1", "10", "100", "1000", "10000"]);
        assert_eq!(labels(&axis(true, 1e-3, 1.0)), ["0.001", "0.01", "0.1", "1"]);
        assert_eq!(labels(&axis(true, 1e-6, 2e-3)), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³"]);
        assert_eq!(labels(&axis(false, -4.4, 4.4)), ["−4", "−2", "0", "2", "4"]);
        assert_eq!(labels(&axis(false, 0.0, 1e-7))[1], "2·10⁻⁸");
    }

    #[test]
    fn ticks_stay_few_over_any_range() {
        for (low, high) in [(1e-300, 1e300), (1e-9, 1e12), (1.0, 1.000_001), (3.0, 3.3)] {
            let count = labels(&axis(true, low, high)).len();
            assert!((1..=13).contains(&count), "{low} to {high}: {count}");
        }
    }

    #[test]
    fn any_values_make_a_range() {
        let odd = [0.0, -1.0, f64::NAN, f64::INFINITY, 5e-324, 1e308];
        for log in [true, false] {
            for values in [&odd[..], &odd[..0], &odd[..1], &[2.0], &[2.0, 2.0]] {
                let axis = Axis::around("", log, 0.05, values.iter().copied());
                assert!(axis.low < axis.high && axis.high.is_finite(), "{axis:?}");
                assert!(!log || axis.low > 0.0, "{axis:?}");
                assert!(axis.ticks(6).len() < 200);
            }
        }
        assert_eq!(axis(true, 1.0, 10.0).place(0.0), None);
    }
}
