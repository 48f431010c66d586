//! Orders of doubles, compiled once: the standard library's sorts are some thirty functions for each type and comparison.
//!
//! Doubles are compared by [`f64::total_cmp`]: −0 is below 0, and NaN beyond infinities.

/// Sorts doubles.
pub fn ascend(values: &mut [f64]) {
    values.sort_unstable_by(f64::total_cmp);
}

/// Returns the places of values in ascending order; equal values keep their order.
pub fn ascending_places(values: &[f64]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..values.len()).collect();
    places.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_ascend_and_equal_ones_keep_their_places() {
        let mut values = [2.0, f64::INFINITY, -1.0, 0.0, -0.0, 2.0];
        assert_eq!(ascending_places(&values), [2, 4, 3, 0, 5, 1]);
        ascend(&mut values);
        assert_eq!(
            values.map(f64::to_bits),
            [-1.0, -0.0, 0.0, 2.0, 2.0, f64::INFINITY].map(f64::to_bits)
        );
    }
}
