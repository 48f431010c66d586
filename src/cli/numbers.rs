//! The numbers that options take, and what is said of others.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Whole numbers of a range.
pub fn whole<N>(range: RangeInclusive<N>) -> impl Fn(&str) -> Result<N, String> + Clone
where
    N: FromStr + PartialOrd + Display + Clone,
{
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        let takes = || format!("it takes a whole number from {} to {}", range.start(), range.end());
        number.ok_or_else(takes)
    }
}

/// A seed of random numbers.
pub fn seed(text: &str) -> Result<u64, String> {
    whole(0..=u64::MAX)(text)
}

/// A number of threads.
pub fn threads(text: &str) -> Result<u16, String> {
    whole(1..=1024)(text)
}

/// A number of draws such as 4e6.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just before
pub fn draws(text: &str) -> Result<u64, String> {
    match text.parse::<f64>() {
        Ok(n) if n.fract() == 0.0 && (2.0..=1e12).contains(&n) => Ok(n as u64),
        _ => Err("it takes a whole number from 2 to 1e12, such as 4e6".into()),
    }
}

/// Any number.
pub fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "it takes a number, such as 0.25 or 1e-3".into())
}

/// A probability.
pub fn alpha(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(alpha) if alpha > 0.0 && alpha < 1.0 => Ok(alpha),
        _ => Err("it takes a probability above 0 and below 1, such as 1e-3".into()),
    }
}

/// A share of 0 or more.
pub fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if share >= 0.0 => Ok(share),
        _ => Err("it takes a share of 0 or more, such as 0.25, or inf".into()),
    }
}

/// A time such as 30s, 5m or 1h, in seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix(['s', 'm', 'h']) {
        Some(number) if text.ends_with('m') => (number, 60.0),
        Some(number) if text.ends_with('h') => (number, 3600.0),
        Some(number) => (number, 1.0),
        None => (text, 1.0),
    };
    match number.parse::<f64>() {
        Ok(time) if time > 0.0 && time.is_finite() => Ok(time * unit),
        _ => Err("it takes a time such as 30s, 5m or 1h".into()),
    }
}

/// What a run may cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// So many seconds.
    Seconds(f64),
    /// So many draws of all experiments together.
    Draws(u64),
}

/// A time with its unit, or a number of draws.
pub fn budget(text: &str) -> Result<Budget, String> {
    let budget = if text.ends_with(['s', 'm', 'h']) {
        seconds(text).map(Budget::Seconds)
    } else {
        draws(text).map(Budget::Draws)
    };
    budget.map_err(|_| "it takes a time such as 30s or 5m, or a number of draws such as 1e8".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_number_may_be_is_said() {
        assert_eq!(whole::<u16>(2..=512)("512"), Ok(512));
        assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
        for wrong in ["1", "513", "-3", "2.5", "1e2", "many", ""] {
            let said = whole::<u16>(2..=512)(wrong);
            assert_eq!(said, Err("it takes a whole number from 2 to 512".into()), "{wrong}");
        }
        assert_eq!(number("-1e308"), Ok(-1e308));
        assert!(number("half").is_err() && threads("0").is_err() && seed("-1").is_err());
    }
}
