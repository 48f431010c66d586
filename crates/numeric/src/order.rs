//! Lists and maps in order, for lists that are short or sorted once.
//!
//! The stable sort of the standard library is some thirty functions, compiled again for each type and each order. Here it
//! is compiled once, for numbers of items, with an indirect call for each comparison.

use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Sorts a list as [`slice::sort_by`] does: equal items keep their order.
pub fn sort_by<T>(list: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let order = sorted(list.len(), &|a, b| compare(&list[a], &list[b]));
    for (place, other) in swaps(order) {
        list.swap(place, other);
    }
}

/// Sorts a list as [`slice::sort_by_key`] does: equal items keep their order.
pub fn sort_by_key<T, K: Ord>(list: &mut [T], key: impl Fn(&T) -> K) {
    sort_by(list, |a, b| key(a).cmp(&key(b)));
}

/// Sorts a list.
pub fn sort<T: Ord>(list: &mut [T]) {
    sort_by(list, T::cmp);
}

/// Returns the numbers of `count` items in their order; equal items keep theirs.
pub fn sorted(count: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| compare(a, b));
    order
}

/// Sorts doubles by [`f64::total_cmp`]: −0 is below 0, and NaN beyond infinities.
pub fn ascend(values: &mut [f64]) {
    values.sort_unstable_by(f64::total_cmp);
}

/// Returns a map of pairs; later ones replace earlier ones. (`collect` would sort them first.)
pub fn map<K: Ord, V>(pairs: impl IntoIterator<Item = (K, V)>) -> BTreeMap<K, V> {
    let mut map = BTreeMap::new();
    for (key, value) in pairs {
        map.insert(key, value);
    }
    map
}

/// Returns the exchanges that bring items into an order.
fn swaps(mut order: Vec<usize>) -> Vec<(usize, usize)> {
    let mut swaps = Vec::new();
    for place in 0..order.len() {
        let mut other = order[place];
        // An item whose place was taken is where that exchange has brought it.
        while other < place {
            other = order[other];
        }
        order[place] = other;
        if other != place {
            swaps.push((place, other));
        }
    }
    swaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_sorted_as_the_standard_library_sorts_them() {
        // Every list of up to 7 items of 3 kinds, with the number of each item behind its kind.
        for count in 0..=7 {
            for code in 0..3_usize.pow(count) {
                let items = (0..count).map(|place| (code / 3_usize.pow(place) % 3, place));
                let mut wanted: Vec<(usize, u32)> = items.collect();
                let mut found = wanted.clone();
                wanted.sort_by_key(|item| item.0);
                sort_by_key(&mut found, |item| item.0);
                assert_eq!(found, wanted);
            }
        }
    }

    #[test]
    fn doubles_ascend_and_zeros_have_signs() {
        let mut values = [2.0, f64::INFINITY, -1.0, 0.0, -0.0, 2.0];
        ascend(&mut values);
        assert_eq!(
            values.map(f64::to_bits),
            [-1.0, -0.0, 0.0, 2.0, 2.0, f64::INFINITY].map(f64::to_bits)
        );
    }

    #[test]
    fn a_map_is_that_of_the_standard_library() {
        let pairs = [(2, "a"), (1, "b"), (2, "c"), (3, "d"), (1, "e")];
        assert_eq!(map(pairs), BTreeMap::from_iter(pairs));
    }

    #[test]
    fn each_order_of_long_lists_is_reached() {
        for step in [1, 7, 500, 996] {
            let mut list: Vec<usize> = (0..997).map(|place| place * step % 997).collect();
            sort(&mut list);
            assert!(list.iter().copied().eq(0..997), "{step}");
            list.rotate_right(step);
            sort(&mut list);
            assert!(list.iter().copied().eq(0..997), "{step}");
        }
    }
}
