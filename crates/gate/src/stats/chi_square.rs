//! Pearson's test of counts against probabilities.
//!
//! Beyond 10⁴ degrees of freedom the tails of χ² are those of the uniform expansion of the incomplete
//! gamma function, with `a` half the degrees and `x` half the statistic:
//!
//! ```text
//! ½η² = x/a − 1 − ln(x/a),   Q = ½ erfc(η√(a/2)) + e^{−aη²/2} (c₀(η) + c₁(η)/a + …)/√(2πa)
//! ```
//!
//! Power series lose their digits there: the lower tail at a level of 2e-7 was 30 % off at 1e8 degrees.
//!
//! Source: N. M. Temme, *The asymptotic expansion of the incomplete gamma functions*, SIAM Journal on
//! Mathematical Analysis 10 (1979); coefficients by A. R. Di Donato, A. H. Morris, *Computation of the
//! incomplete gamma function ratios and their inverse*, ACM Transactions on Mathematical Software 12
//! (1986).

use std::f64::consts::PI;

use statrs::distribution::{Binomial, ChiSquared, ContinuousCDF, DiscreteCDF};

use super::binomial::deviance;

/// Degrees beyond which the expansion is used: the relative error of two terms is 1e-11 of a tail.
const MANY: f64 = 1e4;

/// The Taylor coefficients of `c₀`.
const C_0: [f64; 10] = [
    -1.0 / 3.0,
    1.0 / 12.0,
    -2.0 / 135.0,
    1.0 / 864.0,
    1.0 / 2835.0,
    -139.0 / 777_600.0,
    3.919_263_178_522_438e-5,
    -2.185_448_510_679_992e-6,
    -1.854_062_210_715_16e-6,
    8.296_711_340_953_086e-7,
];

/// The Taylor coefficients of `c₁`.
const C_1: [f64; 8] = [
    -1.0 / 540.0,
    -1.0 / 288.0,
    1.0 / 378.0,
    -77.0 / 77_760.0,
    2.057_613_168_724_28e-4,
    -4.018_775_720_164_609e-7,
    -1.809_855_033_448_998e-5,
    7.649_160_916_081_11e-6,
];

/// `[P(χ² > statistic), P(χ² < statistic)]`; NaN where the statistic is not a number or the degrees are
/// not positive.
fn tails(statistic: f64, degrees: f64) -> [f64; 2] {
    if degrees > MANY && degrees.is_finite() && statistic > 0.0 && statistic.is_finite() {
        return expanded(0.5 * statistic, 0.5 * degrees);
    }
    ChiSquared::new(degrees)
        .map_or([f64::NAN; 2], |density| [density.sf(statistic), density.cdf(statistic)])
}

/// `[Q(a, x), P(a, x)]` for large a.
fn expanded(x: f64, a: f64) -> [f64; 2] {
    let exponent = deviance(a, x);
    let root = exponent.sqrt().copysign(x - a);
    let eta = root * (2.0 / a).sqrt();
    let series = |c: &[f64]| c.iter().rev().fold(0.0, |sum, c| sum * eta + c);
    let rest = (-exponent).exp() / (2.0 * PI * a).sqrt() * (series(&C_0) + series(&C_1) / a);
    // Beyond e^{−745} the series is invalid, and the rest is 0.
    let rest = if exponent < 745.0 { rest } else { 0.0 };
    [0.5 * libm::erfc(root) + rest, 0.5 * libm::erfc(-root) - rest]
}

/// Minimum number of expected draws of a bin; smaller adjacent bins are merged. With fewer, Pearson's distribution
/// is too small far out: a bin of 10 beside a large one exceeds a level of 2e-7 26 times too often, one of 50 still
/// 6 times.
const MIN_COUNT: f64 = 500.0;

/// The p-value of observed counts against the probabilities of their bins.
///
/// Adjacent bins are merged until each expects at least 500 draws, which keeps levels of 2e-7 to a factor below 2;
/// two bins have their exact binomial distribution. Probabilities that sum to less than 1 leave a last bin for the
/// rest. `None` where fewer than two bins remain, so that there is nothing to test.
///
/// ```text
/// χ² = Σ (O − E)²/E,  bins − 1 degrees of freedom
/// ```
///
/// Source: K. Pearson, *On the criterion …*, Philosophical Magazine 50 (1900), 157–175.
pub fn p_value(observed: &[f64], probability: &[f64]) -> Option<f64> {
    let draws = observed.iter().sum::<f64>();
    let bins = merged(observed.iter().copied(), probability, draws);
    if bins.len() < 2 {
        return None;
    }
    if let [(count, expected), _] = bins[..] {
        return Some(two_bins(count, expected / draws, draws));
    }
    let statistic: f64 = bins.iter().map(|(o, e)| (o - e).powi(2) / e).sum();
    Some(upper(statistic, (bins.len() - 1) as f64))
}

/// Counts and expected draws of bins that are merged until each expects enough.
fn merged(
    mut observed: impl Iterator<Item = f64>,
    probability: &[f64],
    draws: f64,
) -> Vec<(f64, f64)> {
    let mut bins: Vec<(f64, f64)> = Vec::new();
    let (mut count, mut expected) = (0.0, 0.0);
    for (p, o) in probability.iter().zip(observed.by_ref()) {
        count += o;
        expected += p * draws;
        if expected >= MIN_COUNT {
            bins.push((count, expected));
            (count, expected) = (0.0, 0.0);
        }
    }
    let rest = draws - bins.iter().map(|bin| bin.1).sum::<f64>();
    count += observed.sum::<f64>();
    if rest >= MIN_COUNT {
        bins.push((count, rest));
    } else if let Some(last) = bins.last_mut() {
        last.0 += count;
        last.1 += rest;
    }
    bins
}

/// `2 min(P(N ≤ count), P(N ≥ count))` of a binomial number N.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
fn two_bins(count: f64, probability: f64, draws: f64) -> f64 {
    Binomial::new(probability.clamp(0.0, 1.0), draws as u64).map_or(f64::NAN, |density| {
        let count = count as u64;
        let above = if count == 0 { 1.0 } else { density.sf(count - 1) };
        (2.0 * density.cdf(count).min(above)).min(1.0)
    })
}

/// `P(χ² > statistic)`; NaN where the statistic is not a number or the degrees are not positive.
pub fn upper(statistic: f64, degrees: f64) -> f64 {
    tails(statistic, degrees)[0]
}

/// `P(χ² < statistic)`; NaN as for [`upper`].
pub fn lower(statistic: f64, degrees: f64) -> f64 {
    tails(statistic, degrees)[1]
}

/// `2 min(P(χ² > statistic), P(χ² < statistic))`: small for a statistic too large and for one too
/// small; NaN as for [`upper`].
///
/// Right to 1e-9, relative, up to 1e9 degrees and beyond, at levels down to 1e-12.
pub fn two_sided(statistic: f64, degrees: f64) -> f64 {
    let [above, below] = tails(statistic, degrees);
    (2.0 * if above < below { above } else { below }).clamp(0.0, 1.0)
}

/// The number of bins that [`p_value`] would test at a planned number of draws.
pub fn testable_bins(probability: &[f64], draws: f64) -> usize {
    merged(std::iter::repeat_n(0.0, probability.len()), probability, draws).len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perfect_counts_pass_and_shifted_ones_do_not() {
        let p = [0.25; 4];
        assert!((p_value(&[2500.0; 4], &p).expect("bins") - 1.0).abs() < 1e-12);
        assert!(p_value(&[2800.0, 2200.0, 2500.0, 2500.0], &p).expect("bins") < 1e-6);
    }

    #[test]
    fn two_bins_have_the_binomial_law() {
        // P(N ≤ 900) of 2000 fair coins, by exact summation: 4.18e-6 (twice: both sides).
        let p = p_value(&[900.0, 1100.0], &[0.5, 0.5]).expect("bins");
        let normal = 2.0 * 0.5 * libm::erfc(99.5 / 500f64.sqrt() / 2f64.sqrt());
        assert!((p / normal - 1.0).abs() < 0.02, "{p} {normal}");
    }

    #[test]
    fn rare_bins_are_merged_and_one_bin_is_no_test() {
        assert_eq!(testable_bins(&[0.999, 0.0005, 0.0005], 1000.0), 1);
        assert_eq!(p_value(&[1000.0, 0.0, 0.0], &[0.999, 0.0005, 0.0005]), None);
    }

    #[test]
    fn both_forms_of_the_tails_agree() {
        for z in [-7.0, -3.0, -0.1, 0.0, 0.1, 3.0, 7.0] {
            let degrees: f64 = 2e4;
            let statistic = degrees + z * (2.0 * degrees).sqrt();
            let density = ChiSquared::new(degrees).expect("a law");
            let [above, below] = tails(statistic, degrees);
            assert!((above / density.sf(statistic) - 1.0).abs() < 1e-9, "{z}: {above}");
            assert!((below / density.cdf(statistic) - 1.0).abs() < 1e-9, "{z}: {below}");
        }
        // Far out the tail is 0, and never negative.
        assert_eq!(tails(4e9, 1e9), [0.0, 1.0]);
        assert_eq!(tails(1e8, 1e9), [1.0, 0.0]);
        assert_eq!(tails(0.0, 1e9), [1.0, 0.0]);
    }

    #[test]
    fn tails_of_closed_form() {
        // Two degrees of freedom: P(χ² > x) = e^{−x/2}.
        assert!((upper(60.0, 2.0) / (-30.0f64).exp() - 1.0).abs() < 1e-12);
        assert!((two_sided(60.0, 2.0) / (-30.0f64).exp() - 2.0).abs() < 1e-12);
        assert!((two_sided(1e-9, 2.0) / -2.0 / (-5e-10f64).exp_m1() - 1.0).abs() < 1e-9);
        assert!((two_sided(2.0 * std::f64::consts::LN_2, 2.0) - 1.0).abs() < 1e-12);
        assert_eq!(upper(f64::INFINITY, 3.0), 0.0);
        assert_eq!(two_sided(0.0, 3.0), 0.0);
        assert!(upper(f64::NAN, 3.0).is_nan() && two_sided(f64::NAN, 3.0).is_nan());
        assert!(upper(1.0, 0.0).is_nan() && two_sided(1.0, f64::NAN).is_nan());
    }
}
