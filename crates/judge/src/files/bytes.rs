//! Formats of numbers without a header that their first bytes contradict.

/// Format that bytes have in place of the claimed one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mistaken {
    /// Numbers of 4 bytes.
    Single,
    /// Numbers of 8 bytes.
    Double,
    /// Numbers with the highest byte first, and the first of them as it was read.
    Swapped(f64),
}

/// Returns the format of bytes that are not little-endian numbers of `width` bytes.
pub(super) fn mistaken(bytes: &[u8], width: usize) -> Option<Mistaken> {
    let swapped = if width == 8 {
        let (words, _) = bytes.as_chunks::<8>();
        let read = words.iter().map(|&word| f64::from_le_bytes(word));
        swapped(read, words.iter().map(|&word| f64::from_be_bytes(word)))
    } else {
        let (words, _) = bytes.as_chunks::<4>();
        let read = words.iter().map(|&word| f64::from(f32::from_le_bytes(word)));
        swapped(read, words.iter().map(|&word| f64::from(f32::from_be_bytes(word))))
    };
    match width {
        8 if looks_single(bytes) => Some(Mistaken::Single),
        4 if looks_double(bytes) => Some(Mistaken::Double),
        _ => swapped.map(Mistaken::Swapped),
    }
}

/// Returns whether a number is 0 or of usual size.
fn is_usual(x: f64) -> bool {
    x == 0.0 || (1e-12..=1e12).contains(&x.abs())
}

/// Returns the first unusual number, if half of them are, and all are of usual size with their bytes reversed.
fn swapped(
    read: impl Iterator<Item = f64>,
    reversed: impl ExactSizeIterator<Item = f64> + Clone,
) -> Option<f64> {
    let count = reversed.len();
    if count < MIN_WORDS || !reversed.clone().all(is_usual) {
        return None;
    }
    // One number over and over may be of usual size by coincidence.
    let first = reversed.clone().next();
    if reversed.clone().all(|x| Some(x) == first) {
        return None;
    }
    let unusual: Vec<f64> = read.filter(|x| !is_usual(*x)).collect();
    let others = reversed.filter(|x| *x != 0.0).count();
    unusual.first().copied().filter(|_| 2 * unusual.len() >= others.max(MIN_WORDS))
}

/// Minimum number of words of 8 bytes that show whether they are pairs of words of 4 bytes.
const MIN_WORDS: usize = 64;

/// Returns whether bytes look like float32.
///
/// The low half of a float64 holds the last bits of its mantissa. Read as float32 these have any exponent, or are
/// 0 and few other values if the number has few bits. Halves of usual size, many different ones or 1 among them,
/// are numbers of their own.
fn looks_single(bytes: &[u8]) -> bool {
    let (words, _) = bytes.as_chunks::<8>();
    let is_usual = |half: f32| is_usual(f64::from(half));
    let halves = words.iter().map(|&[a, b, c, d, e, f, g, h]| {
        [f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h])]
    });
    let mut seen = std::collections::BTreeSet::new();
    for [low, high] in halves {
        if !is_usual(low) || !is_usual(high) {
            return false;
        }
        if seen.len() <= MIN_WORDS {
            seen.insert(low.to_bits());
        }
    }
    words.len() >= MIN_WORDS && (seen.len() > MIN_WORDS / 4 || seen.contains(&1.0_f32.to_bits()))
}

/// Minimum number of words with a high half that is not 0, beside low halves that all are: 2⁻²⁰ by accident.
const MIN_HIGH: usize = 20;

/// Returns whether bytes look like float64.
///
/// As float32 the high half of a float64 of usual size lies between 0.05 and 60, and the low half has any exponent, or is
/// 0 in every number. Numbers of float32 that are independent have equally many unusual ones in both places.
fn looks_double(bytes: &[u8]) -> bool {
    let (words, _) = bytes.as_chunks::<8>();
    let (mut unusual, mut zeros, mut high_zeros) = (0, 0, 0);
    for word in words {
        let [a, b, c, d, e, f, g, h] = *word;
        let [low, high] = [f32::from_le_bytes([a, b, c, d]), f32::from_le_bytes([e, f, g, h])];
        if !is_usual(f64::from_le_bytes(*word)) {
            return false;
        }
        unusual += usize::from(!is_usual(f64::from(low)));
        zeros += usize::from(low == 0.0);
        high_zeros += usize::from(high == 0.0);
    }
    let all = words.len();
    let has_few_bits = zeros == all && all - high_zeros >= MIN_HIGH;
    all >= MIN_WORDS && (4 * unusual >= all || has_few_bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns numbers of 53 bits between 0 and 1.
    fn doubles() -> Vec<f64> {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / 53_f64.exp2()
        };
        (0..500).map(|_| next()).collect()
    }

    fn bytes<const N: usize>(words: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
        words.flatten().collect()
    }

    #[test]
    fn each_format_is_told_from_the_others() {
        #[allow(clippy::cast_possible_truncation)] // rounds
        let singles: Vec<f32> = doubles().iter().map(|x| *x as f32).collect();
        let double = bytes(doubles().iter().map(|x| x.to_le_bytes()));
        let single = bytes(singles.iter().map(|x| x.to_le_bytes()));
        assert_eq!([mistaken(&double, 8), mistaken(&single, 4)], [None, None]);
        assert_eq!(mistaken(&double, 4), Some(Mistaken::Double));
        assert_eq!(mistaken(&single, 8), Some(Mistaken::Single));
        let double = bytes(doubles().iter().map(|x| x.to_be_bytes()));
        let single = bytes(singles.iter().map(|x| x.to_be_bytes()));
        for (bytes, width) in [(&double, 8), (&single, 4)] {
            let actual = mistaken(bytes, width);
            assert!(matches!(actual, Some(Mistaken::Swapped(_))), "{actual:?}");
        }
    }

    #[test]
    fn numbers_of_few_bits_are_told_as_well() {
        let coarse = |x: &f64| (4.0 * x).floor() / 4.0;
        let few: Vec<f64> = doubles().iter().map(coarse).collect();
        let little = bytes(few.iter().map(|x| x.to_le_bytes()));
        assert_eq!((mistaken(&little, 8), mistaken(&little, 4)), (None, Some(Mistaken::Double)));
        let big = bytes(few.iter().map(|x| x.to_be_bytes()));
        assert!(matches!(mistaken(&big, 8), Some(Mistaken::Swapped(x)) if x.abs() < 1e-300));
        let ones = bytes(few.iter().map(|x| if *x > 0.5 { 1_f32 } else { 0.0 }.to_le_bytes()));
        assert_eq!(mistaken(&ones, 4), None);
        // One draw in five is 1, the others 0.
        let rare = doubles().into_iter().map(|x| if x > 0.8 { 1.0_f64 } else { 0.0 });
        assert_eq!(mistaken(&bytes(rare.map(f64::to_le_bytes)), 4), Some(Mistaken::Double));
    }
}
