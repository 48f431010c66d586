//! Resolution of values: ties, single precision, and bits that are never set.
//!
//! ```text
//! n draws from m equally probable values:  E[ties] = n − m(1 − (1 − 1/m)^n) ≈ n²/(2m)
//! OR of w words:  a bit stays 0 with probability 2^{−w}
//! ```
//!
//! Source: D. E. Knuth, *The Art of Computer Programming*, volume 2, 3rd edition (1997), section 3.3.2 I (the test
//! of collisions). A distribution of 53 bits gives n²/2⁵⁴ ties, one of 24 bits n²/2²⁵.

use numeric::order;

/// Number of values that equal one before them; sorts the values.
///
/// `0` and `−0` are equal; NaN equals nothing.
pub fn ties(values: &mut [f64]) -> usize {
    order::ascend(values);
    values.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// `log₂` of the number of equally probable values that would make this number of pairs, among draws that occur
/// once or twice; `None` where fewer than 5 occur twice or 100 once. Sorts the values. Atoms of a distribution
/// occur more often.
pub fn resolution(values: &mut [f64]) -> Option<f64> {
    order::ascend(values);
    let count = |size: usize| {
        values.chunk_by(|a, b| a == b).filter(|group| group.len() == size).count() as f64
    };
    let (once, twice) = (count(1), count(2));
    let draws = once + 2.0 * twice;
    (twice >= 5.0 && once >= 100.0).then(|| (0.5 * draws * draws / twice).log2())
}

/// Probability of `ties` or more ties where `expected` are expected: their number is Poisson.
#[cfg(feature = "distributions")]
pub fn p_value(ties: usize, expected: f64) -> f64 {
    if ties == 0 {
        return 1.0;
    }
    // P(N ≥ k) = P(Gamma(k) < λ) = P(χ² with 2k degrees < 2λ).
    super::chi_square::lower(2.0 * expected, 2.0 * ties as f64)
}

/// Returns whether every finite value is a single-precision number; false without finite values.
#[allow(clippy::cast_possible_truncation)] // what the truncation loses is the question
pub fn all_single_precision(values: &[f64]) -> bool {
    let mut finite = values.iter().filter(|x| x.is_finite()).peekable();
    finite.peek().is_some() && finite.all(|&x| f64::from(x as f32) == x)
}

/// The bits that are set in at least one word.
pub fn or_of_words(words: impl Iterator<Item = u64>) -> u64 {
    words.fold(0, |seen, word| seen | word)
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::*;
    use numeric::rng::{Address, unit};

    fn stream() -> numeric::rng::Stream {
        Address { seed: 1, experiment: 0, block: 0, lane: 0 }.stream()
    }

    #[test]
    fn coarse_values_show_their_resolution() {
        let mut rng = stream();
        let fine: Vec<f64> = (0..16_384).map(|_| unit(&mut rng)).collect();
        assert_eq!(resolution(&mut fine.clone()), None);
        for bits in [18, 20, 22] {
            let steps = f64::from(1 << bits);
            let mut coarse: Vec<f64> = fine.iter().map(|u| (u * steps).floor() / steps).collect();
            // An atom is left out.
            coarse.extend([0.25; 1000]);
            let result = resolution(&mut coarse).expect("a resolution");
            assert!((result - f64::from(bits)).abs() < 0.6, "{result} for {bits}");
        }
    }

    #[test]
    fn ties_are_those_of_the_resolution() {
        let mut rng = stream();
        let mut fine: Vec<f64> = (0..100_000).map(|_| unit(&mut rng)).collect();
        let (n, m) = (fine.len() as f64, 16_777_216.0);
        let mut coarse: Vec<f64> = fine.iter().map(|u| (u * m).floor() / m).collect();
        let expected = n - m * -(n * (-1.0f64 / m).ln_1p()).exp_m1();
        assert_eq!(ties(&mut fine), 0);
        let result = ties(&mut coarse) as f64;
        assert!((result - expected).abs() < 5.0 * expected.sqrt(), "{result} against {expected}");
    }

    #[cfg(feature = "distributions")]
    #[test]
    fn chances_of_ties_by_hand() {
        assert_eq!(p_value(0, 1e-8), 1.0);
        assert!((p_value(1, 1e-8) / 1e-8 - 1.0).abs() < 1e-7);
        let (x, two) = (0.5f64, p_value(2, 0.5));
        assert!((two - (1.0 - (-x).exp() * (1.0 + x))).abs() < 1e-12);
    }

    #[test]
    fn equal_is_what_compares_equal() {
        assert_eq!(ties(&mut [0.5, f64::NAN, -0.0, 0.5, f64::NAN, 0.0, 0.5]), 3);
        assert_eq!(ties(&mut []), 0);
    }

    #[test]
    fn single_precision_is_seen() {
        assert!(all_single_precision(&[0.5, f64::from(0.1f32), f64::NAN]));
        assert!(!all_single_precision(&[0.5, 0.1]));
        assert!(!all_single_precision(&[f64::INFINITY]));
        assert!(!all_single_precision(&[]));
    }

    #[test]
    fn missing_bits_are_seen() {
        let mut rng = stream();
        let words: Vec<u64> = (0..256).map(|_| rng.next_u64() >> 11).collect();
        assert_eq!(or_of_words(words.iter().copied()), (1 << 53) - 1);
        let coarse = words.iter().map(|word| word >> 29 << 29);
        assert_eq!(or_of_words(coarse).trailing_zeros(), 29);
        assert_eq!(or_of_words(std::iter::empty()), 0);
    }
}
