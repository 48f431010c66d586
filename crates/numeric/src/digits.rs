//! Numbers as text: exact for files, short for people.

/// The shortest text that reads back as the same number, with an exponent where plain digits would fill the line.
pub fn number(x: f64) -> String {
    let (plain, scientific) = (format!("{x}"), format!("{x:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

/// A number with at most `digits` significant digits, with an exponent where plain notation would hide or pad
/// them.
pub fn short(x: f64, digits: usize) -> String {
    let text = fixed(x, digits);
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent}", trimmed(mantissa)),
        None => trimmed(&text),
    }
}

/// A number with exactly `digits` significant digits, for columns; otherwise as [`short`].
pub fn fixed(x: f64, digits: usize) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    // Rounded first, so that 999.96 counts as 1000.
    let scientific = format!("{x:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let power: i32 = exponent.parse().unwrap_or(0);
    let precision = i32::try_from(digits).unwrap_or(17) - 1 - power;
    match usize::try_from(precision) {
        Ok(places) if power >= -3 => format!("{x:.places$}"),
        _ => format!("{mantissa}e{power}"),
    }
}

/// A count in full below a million, with three places and an exponent beyond.
pub fn count(n: u64) -> String {
    if n < 1_000_000 { n.to_string() } else { short(n as f64, 4) }
}

/// A number of things in words.
pub fn counted(number: u64, thing: &str) -> String {
    format!("{} {thing}{}", count(number), if number == 1 { "" } else { "s" })
}

/// A needed number of draws rounded up to two significant digits, as options take it.
#[allow(clippy::cast_possible_truncation)] // a power of ten
pub fn enough(draws: f64) -> String {
    let power = draws.log10().floor() - 1.0;
    let unit = if power > 0.0 { 10f64.powi(power as i32) } else { 1.0 };
    short((draws / unit).ceil() * unit, 2)
}

/// Two places and a sign, for z-scores; an exponent where that would be wide.
pub fn signed(z: f64) -> String {
    if z.abs() < 1e4 || !z.is_finite() { format!("{z:+.2}") } else { format!("{z:+.1e}") }
}

/// A time in the unit that suits it, from nanoseconds to years.
pub fn time(seconds: f64) -> String {
    const UNITS: [(f64, &str); 8] = [
        (1e-6, "ns"),
        (1e-3, "µs"),
        (1.0, "ms"),
        (60.0, "s"),
        (3600.0, "min"),
        (86_400.0, "h"),
        (YEAR, "d"),
        (f64::INFINITY, "a"),
    ];
    const SIZES: [f64; 8] = [1e-9, 1e-6, 1e-3, 1.0, 60.0, 3600.0, 86_400.0, YEAR];
    const YEAR: f64 = 365.25 * 86_400.0;
    let at = UNITS.iter().position(|unit| seconds < unit.0).unwrap_or(UNITS.len() - 1);
    format!("{} {}", fixed(seconds / SIZES[at], 3), UNITS[at].1)
}

/// A share in percent.
pub fn percent(share: f64) -> String {
    format!("{} %", short(100.0 * share, 3))
}

/// A range of shares in percent.
pub fn range([minimum, maximum]: [f64; 2]) -> String {
    let [minimum, maximum] = [minimum, maximum].map(percent);
    if minimum == maximum { minimum } else { format!("{minimum} … {maximum}") }
}

fn trimmed(text: &str) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text.to_owned()
    }
}

/// A computed number to six decimals; with six digits and an exponent where six decimals would hide digits or pad
/// them with zeros.
pub fn rounded(x: f64) -> String {
    let size = x.abs();
    let is_plain = x == 0.0 || (1e-3..1e9).contains(&size) || !x.is_finite();
    if is_plain { format!("{x:.6}") } else { format!("{x:.5e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_numbers_read_back_and_are_short() {
        for x in [0.1, 1.0 / 3.0, 1e300, 5e-324, -2.5, 1e6, 123_456.789, 0.0] {
            assert_eq!(number(x).parse::<f64>().expect("reads back"), x);
        }
        for (x, text) in [(1e308, "1e308"), (0.25, "0.25"), (-1.0, "-1"), (5e-324, "5e-324")] {
            assert_eq!(number(x), text);
        }
    }

    #[test]
    fn short_numbers_keep_their_digits() {
        let cases = [
            (0.123_456_7, 4, "0.1235"),
            (0.001_234_56, 4, "0.001235"),
            (0.000_123_456, 4, "1.235e-4"),
            (1234.56, 4, "1235"),
            (123_456.0, 4, "1.235e5"),
            (999.96, 4, "1000"),
            (2.0, 4, "2"),
            (-0.5, 4, "-0.5"),
            (0.0, 4, "0"),
        ];
        for (x, digits, text) in cases {
            assert_eq!(short(x, digits), text);
        }
        assert_eq!(fixed(2.0, 4), "2.000");
        assert_eq!(fixed(2e-7, 4), "2.000e-7");
    }

    #[test]
    fn counts_and_scores() {
        assert_eq!(count(999_999), "999999");
        assert_eq!(count(1_048_576), "1.049e6");
        assert_eq!(signed(-0.314), "-0.31");
        assert_eq!(signed(2.0), "+2.00");
        assert_eq!(signed(123_456.0), "+1.2e5");
    }

    #[test]
    fn what_is_enough_is_never_less_and_an_option_reads_it() {
        let cases = [
            (1_410_001.0, "1.5e6"),
            (7.2e6, "7.2e6"),
            (432.0, "4.4e2"),
            (9.99e8, "1e9"),
            (3.2, "4"),
            (17.0, "17"),
            (99.5, "1e2"),
        ];
        for (needed, text) in cases {
            assert_eq!(enough(needed), text);
            assert!(text.parse::<f64>().expect("a number") >= needed);
        }
    }

    #[test]
    fn times_have_a_unit_that_suits_them() {
        let times = [
            (2.5e-9, "2.50 ns"),
            (4.2e-5, "42.0 µs"),
            (0.5, "500 ms"),
            (59.0, "59.0 s"),
            (90.0, "1.50 min"),
            (7200.0, "2.00 h"),
            (1e6, "11.6 d"),
            (1e12, "3.17e4 a"),
        ];
        for (seconds, text) in times {
            assert_eq!(time(seconds), text);
        }
    }

    #[test]
    fn no_rounded_number_fills_a_line() {
        for (x, text) in [
            (1.2, "1.200000"),
            (0.0, "0.000000"),
            (-0.1, "-0.100000"),
            (1e308, "1.00000e308"),
            (2.5e-12, "2.50000e-12"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(rounded(x), text);
        }
    }
}
