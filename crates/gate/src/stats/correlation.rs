//! Correlations between streams of random numbers that should be independent.
//!
//! Values are standardised: mean 0 and variance 1 for correct streams.

use std::f64::consts::FRAC_1_SQRT_2;
use std::ops::RangeInclusive;

use crate::stats::chi_square;
use numeric::sum::Sum;

/// The two-sided p-value of the sums of `streams` streams, index by index; `None` where there is no distribution to
/// compare with.
///
/// With `S_i = Σ_b z_{b,i}` over the `B` streams and `κ` the excess kurtosis of one `z`,
///
/// ```text
/// Q = Σ_{i=1}^{L} S_i²/B,  E[Q] = L,  Var[Q] = L(2 + κ/B)
/// Q/c ~ χ² with L/c degrees of freedom,  c = 1 + κ/(2B)
/// ```
///
/// the scaled `χ²` that has both moments. Streams that are alike make `Q` large (all equal: `E[Q] = LB`), streams
/// that avoid each other make it small.
///
/// Source: F. E. Satterthwaite, *An approximate distribution of estimates of variance components*,
/// Biometrics Bulletin 2 (1946), 110–114. Exact for normal `z`; otherwise good down to levels of
/// 1e-7 for `L ≥ 1000 κ/B` and `E[z⁸] ≤ 0.06 L B³`: with heavier tails one draw decides.
pub fn index_sums(sums: &[f64], streams: usize, excess_kurtosis: f64) -> Option<f64> {
    let scale = 1.0 + excess_kurtosis / (2.0 * streams as f64);
    if sums.is_empty() || streams == 0 || !scale.is_finite() || scale <= 0.0 {
        return None;
    }
    let squares: Sum = sums.iter().map(|s| s * s).collect();
    let statistic = squares.value() / streams as f64;
    Some(chi_square::two_sided(statistic / scale, sums.len() as f64 / scale))
}

/// The largest of many correlations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lagged {
    /// The lag `l` at which it was found.
    pub lag: i32,
    /// `z_l` there, standard normal for independent streams.
    pub z: f64,
    /// Two-sided p-value, times the number of lags.
    pub p_value: f64,
}

/// The largest cross-correlation of `a_i` and `b_{i+l}` over the lags `l`; `None` where no lag lets
/// them overlap.
///
/// ```text
/// z_l = Σ_i a_i b_{i+l}/√m over the m pairs that overlap,  p = min(1, (lags) · 2Φ̄(max |z_l|))
/// ```
///
/// Bonferroni's bound: C. E. Bonferroni, *Teoria statistica delle classi e calcolo delle probabilità*
/// (1936). A product of two kurtoses `κ_a κ_b` leaves `z` an excess kurtosis of `(κ_a κ_b − 3)/m`: for
/// normal values `m ≥ 1e4` is enough at levels of 1e-6. Where `a` is `b`, leave out lag 0.
pub fn lagged(a: &[f64], b: &[f64], lags: RangeInclusive<i32>) -> Option<Lagged> {
    let mut tested = 0.0;
    let mut largest: Option<(i32, f64)> = None;
    for lag in lags {
        let shift = lag.unsigned_abs() as usize;
        let (a, b) = if lag < 0 { (a.get(shift..), Some(b)) } else { (Some(a), b.get(shift..)) };
        let (Some(a), Some(b)) = (a, b) else { continue };
        let pairs = a.len().min(b.len());
        if pairs == 0 {
            continue;
        }
        tested += 1.0;
        let products: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
        let z = products / (pairs as f64).sqrt();
        // NaN stays, so that it is not mistaken for a small value.
        if largest.is_none_or(|(_, old)| z.is_nan() || z.abs() > old.abs()) {
            largest = Some((lag, z));
        }
    }
    largest.map(|(lag, z)| {
        let p_value = (tested * libm::erfc(z.abs() * FRAC_1_SQRT_2)).clamp(0.0, 1.0);
        Lagged { lag, z, p_value }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::rng::{Address, exponential};

    /// Exponential draws less 1: mean 0, variance 1, excess kurtosis 6.
    fn stream(block: u64, length: usize) -> Vec<f64> {
        let mut rng = Address { seed: 3, experiment: 0, block, lane: 0 }.stream();
        (0..length).map(|_| exponential(&mut rng) - 1.0).collect()
    }

    fn sums(streams: &[Vec<f64>]) -> Vec<f64> {
        (0..streams[0].len()).map(|i| streams.iter().map(|z| z[i]).sum()).collect()
    }

    #[test]
    fn p_values_of_independent_streams_are_uniform() {
        let mut p: Vec<f64> = (0..400)
            .map(|run| {
                let streams: Vec<_> = (0..4).map(|b| stream(4 * run + b, 2000)).collect();
                index_sums(&sums(&streams), 4, 6.0).expect("a law")
            })
            .collect();
        p.sort_by(f64::total_cmp);
        assert!(crate::stats::anderson_darling::p_value_of_uniforms(&p) > 1e-3);
        // Without the kurtosis, the spread is 1.32 times too wide.
        let mut naive: Vec<f64> = (0..400)
            .map(|run| {
                let streams: Vec<_> = (0..4).map(|b| stream(4 * run + b, 2000)).collect();
                index_sums(&sums(&streams), 4, 0.0).expect("a law")
            })
            .collect();
        naive.sort_by(f64::total_cmp);
        assert!(crate::stats::anderson_darling::p_value_of_uniforms(&naive) < 1e-6);
    }

    #[test]
    fn one_shared_stream_is_seen() {
        let mut streams: Vec<_> = (0..16).map(|b| stream(b, 20_000)).collect();
        assert!(index_sums(&sums(&streams), 16, 6.0).expect("a law") > 1e-6);
        streams[7] = streams[2].clone();
        assert!(index_sums(&sums(&streams), 16, 6.0).expect("a law") < 1e-12);
    }

    #[test]
    fn opposite_streams_are_seen() {
        let a = stream(0, 1000);
        let b: Vec<f64> = a.iter().map(|z| -z).collect();
        assert_eq!(index_sums(&sums(&[a, b]), 2, 6.0), Some(0.0));
    }

    #[test]
    fn nothing_to_compare_is_no_p_value() {
        assert_eq!(index_sums(&[], 2, 0.0), None);
        assert_eq!(index_sums(&[1.0], 0, 0.0), None);
        assert_eq!(index_sums(&[1.0], 1, f64::INFINITY), None);
        assert_eq!(index_sums(&[1.0], 1, -2.0), None);
        assert_eq!(lagged(&[1.0], &[], -3..=3), None);
        assert_eq!(lagged(&[1.0], &[1.0], 1..=3), None);
    }

    #[test]
    fn an_overlap_is_found_at_its_lag() {
        let whole = stream(0, 30_000);
        let (a, b) = (&whole[..20_000], &whole[7..]);
        let result = lagged(a, b, -16..=16).expect("pairs");
        assert_eq!(result.lag, -7);
        assert!(result.p_value < 1e-300 && result.z > 100.0);
        let result = lagged(b, a, -16..=16).expect("pairs");
        assert_eq!(result.lag, 7);
    }

    #[test]
    fn independent_streams_have_small_correlations() {
        let result = lagged(&stream(0, 100_000), &stream(1, 100_000), -64..=64).expect("pairs");
        assert!(result.p_value > 1e-6, "{result:?}");
    }

    #[test]
    fn a_correlation_by_hand() {
        // Lag 1: 1·5 + 2·6 over √2; two lags are tested.
        let result = lagged(&[1.0, 2.0, 9.0], &[0.0, 5.0, 6.0], 1..=2).expect("pairs");
        assert_eq!(result.lag, 1);
        assert!((result.z - 17.0 / 2.0f64.sqrt()).abs() < 1e-12);
        let result = lagged(&[1.0], &[2.0], 0..=0).expect("a pair");
        assert!((result.p_value - 0.045_500_263_896_358_4).abs() < 1e-12);
    }
}
