//! Draws that take few values: each value once, with how often it comes.
//!
//! Whatever is summed over draws then costs as much as there are values, not as there are draws.

use numeric::pack::in_fused_code;

/// Places of the table of values: twice as many as are let in, so that few collide.
const PLACES: usize = 128;
/// More values than this are not few.
const MOST: usize = PLACES / 2;
/// Counts are kept fourfold, so that one need not wait for the last to be stored.
const FOLD: usize = 4;
/// Whole numbers up to this are counted in a table.
const LARGEST: usize = 1023;
/// In so many draws there must be more per value than this, or counting them saves nothing.
const WORTH: usize = 8;

/// Values and how often each comes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Census<T> {
    /// The values, each different from the others, in no order that means anything.
    pub values: Vec<T>,
    /// How often each comes: whole numbers above 0.
    pub times: Vec<f64>,
}

impl<T> Census<T> {
    /// `Σ f(value)` over all draws.
    pub fn sum(&self, f: impl Fn(&T) -> f64) -> f64 {
        self.values.iter().zip(&self.times).map(|(value, times)| times * f(value)).sum()
    }

    fn with(mut self, value: T, times: [u32; FOLD]) -> Self {
        let times: u32 = times.iter().sum();
        if times > 0 {
            self.values.push(value);
            self.times.push(f64::from(times));
        }
        self
    }
}

impl Census<f64> {
    /// Counts numbers, told apart by their bits; `None` where too many of them differ.
    pub fn of(draws: &[f64]) -> Option<Self> {
        let mut table = Table::EMPTY;
        let (rows, rest) = draws.as_chunks::<FOLD>();
        for row in rows.iter().map(|row| &row[..]).chain([rest]) {
            for (fold, x) in row.iter().enumerate() {
                let place = table.find(x.to_bits())?;
                table.times[place][fold] += 1;
            }
        }
        let both = table.bits.into_iter().zip(table.times);
        Some(both.fold(Self::default(), |all, (bits, n)| all.with(f64::from_bits(bits), n)))
    }
}

/// Values by their bits. Whether a place is taken is asked for every draw and changes rarely: it is
/// kept apart from the counts, so that it need not wait for them to be stored.
struct Table {
    bits: [u64; PLACES],
    taken: [bool; PLACES],
    times: [[u32; FOLD]; PLACES],
    used: usize,
}

impl Table {
    const EMPTY: Self =
        Self { bits: [0; PLACES], taken: [false; PLACES], times: [[0; FOLD]; PLACES], used: 0 };

    /// The place of a value, which a new one takes; `None` where there is no room for it.
    #[inline(always)]
    fn find(&mut self, bits: u64) -> Option<usize> {
        // The upper bits of the product depend on all bits of the value.
        let mut place = (bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 57) as usize;
        loop {
            if self.taken[place] && self.bits[place] == bits {
                return Some(place);
            }
            if !self.taken[place] {
                self.used += 1;
                self.taken[place] = true;
                self.bits[place] = bits;
                return (self.used <= MOST).then_some(place);
            }
            place = (place + 1) % PLACES;
        }
    }
}

impl Census<u32> {
    /// Counts whole numbers; `None` where they are large, or too many of them differ.
    pub fn of(draws: &[u32]) -> Option<Self> {
        let largest = in_fused_code(
            #[inline(always)]
            || draws.iter().fold(0, |most, &n| most.max(n)),
        ) as usize;
        if largest > LARGEST || largest * WORTH > draws.len() {
            return None;
        }
        let mut times = vec![[0; FOLD]; largest + 1];
        let (rows, rest) = draws.as_chunks::<FOLD>();
        for row in rows.iter().map(|row| &row[..]).chain([rest]) {
            for (fold, &n) in row.iter().enumerate() {
                times[n as usize][fold] += 1;
            }
        }
        Some((0..).zip(times).fold(Self::default(), |all, (n, times)| all.with(n, times)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_value_is_counted_once() {
        let draws = [0.0, 1.5, 0.0, -0.0, 1.5, 0.0, f64::INFINITY];
        let census = Census::<f64>::of(&draws).expect("few");
        let mut counted: Vec<(u64, f64)> =
            census.values.iter().map(|x| x.to_bits()).zip(census.times.clone()).collect();
        counted.sort_by_key(|pair| pair.0);
        let zero = (0.0f64.to_bits(), 3.0);
        let others = [(1.5f64.to_bits(), 2.0), (f64::INFINITY.to_bits(), 1.0)];
        assert_eq!(counted, [zero, others[0], others[1], ((-0.0f64).to_bits(), 1.0)]);
    }

    #[test]
    fn sixty_four_values_are_few_and_sixty_five_are_not() {
        let values = |n: u32| (0..4096).map(|i| f64::from(i % n).sqrt()).collect::<Vec<_>>();
        let census = Census::<f64>::of(&values(64)).expect("few");
        assert_eq!(census.values.len(), 64);
        assert_eq!(census.times, [64.0; 64]);
        assert_eq!(Census::<f64>::of(&values(65)), None);
    }

    #[test]
    fn whole_numbers_are_counted_in_order() {
        let draws: Vec<u32> = (0..100).map(|i| i % 3 + 2).collect();
        let census = Census::<u32>::of(&draws).expect("few");
        assert_eq!((census.values, census.times), (vec![2, 3, 4], vec![34.0, 33.0, 33.0]));
        assert_eq!(Census::<u32>::of(&vec![5000; 100_000]), None);
        assert_eq!(Census::<u32>::of(&[]), Some(Census::default()));
    }

    #[test]
    fn a_sum_over_values_is_the_sum_over_draws() {
        let draws: Vec<u32> = (0..1000).map(|i| i * i % 7).collect();
        let census = Census::<u32>::of(&draws).expect("few");
        let whole: f64 = draws.iter().map(|&n| f64::from(n) + 0.5).sum();
        assert_eq!(census.sum(|&n| f64::from(n) + 0.5), whole);
    }
}
