//! Numbers that options take, and messages about wrong ones.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

use gate::stats::verdict::BLOCK;
use numeric::digits::short;

/// Returns a parser of whole numbers of a range.
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

/// Parses a seed of random numbers.
pub fn seed(text: &str) -> Result<u64, String> {
    whole(0..=u64::MAX)(text)
}

/// Parses a number of threads.
pub fn threads(text: &str) -> Result<u16, String> {
    whole(1..=1024)(text)
}

/// Parses a number of draws such as 4e6.
pub fn draws(text: &str) -> Result<u64, String> {
    whole_draws(text).ok_or_else(|| "it takes a whole number from 2 to 1e12, such as 4e6".into())
}

/// Parses a whole number that may be written with an exponent.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked just before
fn whole_draws(text: &str) -> Option<u64> {
    let number = text.parse::<f64>().ok();
    let number = number.filter(|n| n.fract() == 0.0 && (2.0..=1e12).contains(n));
    number.map(|n| n as u64)
}

/// Parses any number.
pub fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| "it takes a number, such as 0.25 or 1e-3".into())
}

/// Parses a number that may be written in percent.
pub fn percentage(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 100.0));
    let number = number.trim().parse::<f64>().map(|number| number / unit);
    number.map_err(|_| "it takes a number, such as 0.05, 5% or 1e-3".into())
}

/// Refuses a share of 1 or more, which is a percentage without its sign.
pub fn check_share(option: &str, share: f64) -> anyhow::Result<()> {
    if share.is_finite() && share >= 1.0 {
        let (percent, small) = (short(100.0 * share, 6), short(0.01 * share, 6));
        let given = short(share, 6);
        anyhow::bail!(
            "{option} {given} is {percent} %; did you mean {small}, or {given}%? give less than 1"
        );
    }
    Ok(())
}

/// Parses a probability.
pub fn alpha(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(alpha) if alpha > 0.0 && alpha < 1.0 => Ok(alpha),
        _ => Err("it takes a probability above 0 and below 1, such as 1e-3".into()),
    }
}

/// Parses a share of 0 or more.
pub fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if share >= 0.0 => Ok(share),
        _ => Err("it takes a share of 0 or more, such as 0.25, or inf".into()),
    }
}

/// Limit of the cost of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Budget {
    /// Seconds.
    Seconds(f64),
    /// Draws of all experiments together.
    Draws(u64),
}

/// Parses a time with its unit, or a number of draws: one block at least, for all experiments together.
pub fn budget(text: &str) -> Result<Budget, String> {
    let takes =
        format!("a time such as 30s or 5m, or a number of draws from {BLOCK} to 1e12, such as 1e8");
    if let Some(number) = text.strip_suffix(['s', 'm', 'h']) {
        let unit = if text.ends_with('h') {
            3600.0
        } else if text.ends_with('m') {
            60.0
        } else {
            1.0
        };
        let seconds = number.parse::<f64>().ok().map(|number| number * unit);
        let seconds = seconds.filter(|seconds| *seconds > 0.0 && seconds.is_finite());
        return seconds.map(Budget::Seconds).ok_or_else(|| format!("it takes {takes}"));
    }
    let small = |number: &f64| *number > 0.0 && *number < BLOCK as f64;
    match (
        whole_draws(text).filter(|&draws| draws >= BLOCK),
        text.parse::<f64>().ok().filter(small),
    ) {
        (Some(draws), _) => Ok(Budget::Draws(draws)),
        // A number without a unit is ambiguous.
        (None, Some(_)) => Err(format!(
            "without a unit it is a number of draws, and {text} is less than one block of {BLOCK}: give \
             {text}s, {text}m or {text}h for a time, or {BLOCK} draws at least"
        )),
        (None, None) => Err(format!("it takes {takes}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_says_what_it_counts() {
        assert_eq!(budget("5m"), Ok(Budget::Seconds(300.0)));
        assert_eq!(budget("0.5s"), Ok(Budget::Seconds(0.5)));
        assert_eq!(budget("1h"), Ok(Budget::Seconds(3600.0)));
        assert_eq!(budget("16384"), Ok(Budget::Draws(16384)));
        assert_eq!(budget("1e8"), Ok(Budget::Draws(100_000_000)));
        for few in ["5", "1", "0.5", "60", "3600", "16383", "1e4"] {
            let said = budget(few).expect_err("too few draws");
            for cure in [format!("{few}s"), format!("{few}m"), "16384".to_owned()] {
                assert!(said.contains(&cure), "{said}");
            }
        }
        for wrong in [
            "0", "-1", "-5m", "nan", "inf", "1e308", "1e13", "16384.5", "1e308h", "0s", "nans",
            "5d", "5 m", "m", "", "many",
        ] {
            let said = budget(wrong).expect_err(wrong);
            assert!(said.contains("30s") && said.contains("1e8"), "{wrong}: {said}");
        }
    }

    #[test]
    fn a_share_may_be_a_percentage_below_100() {
        assert_eq!(
            [percentage("5%"), percentage("5 %"), percentage("0.05")],
            [Ok(0.05), Ok(0.05), Ok(0.05)]
        );
        assert!(percentage("five%").is_err() && percentage("%").is_err());
        assert!(check_share("--tolerance", 0.99).is_ok());
        let said = check_share("--tolerance", 5.0).expect_err("too much").to_string();
        assert_eq!(said, "--tolerance 5 is 500 %; did you mean 0.05, or 5%? give less than 1");
    }

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
