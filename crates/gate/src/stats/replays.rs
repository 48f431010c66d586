//! Sequences of draws that repeat earlier ones: the same seed for two passes or two threads.
//!
//! ```text
//! keep     draws whose bits have a certain hash, ever fewer of them, so that the memory is bounded
//! pairs    t values that occur from 2 to m times; d the distance of their first two places
//! replay   c of the d are the same:  p ≤ C(t, c) ∏_{i<c−1} m/(n − i m),  m = 2, 4, 8, …, each at its share 1/(k(k + 1))
//! ```
//!
//! For independent draws of one distribution all orders are equally probable. The first two of at most m places of
//! a value among n are therefore d apart with probability m/n at most, for any distribution; the places of other
//! values leave n − i m. Values that occur very often, the atoms of discrete distributions, are little evidence:
//! see [`super::sequences`]. A draw is kept depending on its value alone: in two equal sequences the same draws are
//! kept, at any distance.

use std::hash::Hasher;

/// Maximum number of draws that are kept.
const MAX_ENTRIES: usize = 1 << 16;
/// Draws that are kept for comparison.
#[derive(Debug, Clone, Default)]
pub struct Replays {
    kept: Vec<(u64, u64)>,
    /// Number of leading bits of a hash that must be 0.
    bits: u32,
    draws: u64,
}

/// A repetition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replay {
    /// Number of draws after which the same draws repeat.
    pub distance: u64,
    /// Number of kept draws that repeat.
    pub count: u64,
    /// Number of times that each of them occurs.
    pub times: u64,
    /// ln of a bound on the probability of that.
    pub ln_p: f64,
}

#[inline(always)]
pub(crate) fn hash(bits: u64) -> u64 {
    // The upper bits of a product depend on all bits below them.
    (bits ^ (bits >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93)
}

/// Odd factor of [`Spread`].
const ODD: u64 = 0x9e37_79b9_7f4a_7c15;

/// Hasher of keys that are nearly hashes: tables go by low bits, which the coarsest tokens leave at 0.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SpreadHasher(u64);

impl Hasher for SpreadHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = self.0.rotate_left(8) ^ u64::from(byte);
        }
    }

    fn write_u64(&mut self, key: u64) {
        let product = key.wrapping_mul(ODD);
        self.0 = product ^ (product >> 32);
    }
}

impl Replays {
    /// Adds draws that follow the last ones.
    pub fn absorb(&mut self, x: &[f64]) {
        for (place, x) in (self.draws..).zip(x) {
            let bits = x.to_bits();
            // Zero is the commonest atom, and its hash would be kept for ever.
            if hash(bits).leading_zeros() >= self.bits && *x != 0.0 {
                self.keep(bits, place);
            }
        }
        self.draws += x.len() as u64;
    }

    /// Keeps a draw, and thins what is kept where that is too much.
    #[cold]
    fn keep(&mut self, bits: u64, place: u64) {
        self.kept.push((bits, place));
        if self.kept.len() >= MAX_ENTRIES {
            self.bits += 1;
            let minimum = self.bits;
            self.kept.retain(|(bits, _)| hash(*bits).leading_zeros() >= minimum);
        }
    }

    /// The most significant of the most frequent distances; `None` where no value occurs twice.
    pub fn found(&self) -> Option<Replay> {
        let mut kept = self.kept.clone();
        kept.sort_unstable();
        let mut groups: Vec<(u64, u64)> = kept
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|group| group.len() > 1)
            .map(|group| (group.len() as u64, group[1].1 - group[0].1))
            .collect();
        groups.sort_unstable();
        let maximum = groups.last()?.0.next_power_of_two().ilog2();
        let of = (1..=maximum).filter_map(|k| self.most_frequent(&groups, k));
        of.min_by(|a, b| a.ln_p.total_cmp(&b.ln_p))
    }

    /// The most frequent distance of values that occur up to 2ᵏ times, given how often each value occurs and its
    /// first distance, in that order.
    fn most_frequent(&self, groups: &[(u64, u64)], k: u32) -> Option<Replay> {
        let known = &groups[..groups.partition_point(|group| group.0 <= 1 << k)];
        let mut distances: Vec<(u64, u64)> = known.iter().map(|&(m, d)| (d, m)).collect();
        distances.sort_unstable();
        let longest = distances.chunk_by(|a, b| a.0 == b.0).max_by_key(|run| run.len())?;
        let (t, c) = (distances.len() as f64, longest.len() as f64);
        let places = f64::from(1 << k);
        // m/(n − i m) is 1/(n/m − i), and no probability is above 1.
        let room = self.draws as f64 / places;
        let counted = (c - 1.0).min((room - 1.0).floor().max(0.0));
        let ln_chance = libm::lgamma(room - counted + 1.0) - libm::lgamma(room + 1.0);
        let ways = libm::lgamma(t + 1.0) - libm::lgamma(c + 1.0) - libm::lgamma(t - c + 1.0);
        let share = f64::from(k) * f64::from(k + 1);
        let ln_p = (ways + ln_chance + share.ln()).min(0.0);
        let times = longest[longest.len() / 2].1;
        Some(Replay { distance: longest[0].0, count: longest.len() as u64, times, ln_p })
    }
}

/// Draws that are written several times each: the length of every run of equal draws is then a multiple of a number.
///
/// ```text
/// a run of a value of probability p:   P(its length is a multiple of k) = p^{k−1}(1 − p)/(1 − p^k)
/// p ≤ ½:   1/(2^k − 1) at most;   of two runs one after the other one has a value of p ≤ ½
/// 2h runs of multiples of some k ≥ 2:   P ≤ Σ_k (2^k − 1)^{−h} ≤ 2 · 3^{−h}  for h ≥ 2
/// ```
///
/// The bound holds for independent draws of every distribution. The first and the last run may be incomplete and do not
/// count.
#[derive(Debug, Clone, Default)]
pub struct Runs {
    last: Option<f64>,
    length: u64,
    /// Runs that ended, the first among them.
    ended: u64,
    divisor: u64,
}

impl Runs {
    /// Adds draws that follow the last ones.
    pub fn absorb(&mut self, x: &[f64]) {
        for &x in x {
            // Nothing divides 1: no later run can change that.
            if self.divisor == 1 {
                return;
            }
            if self.last == Some(x) {
                self.length += 1;
                continue;
            }
            if self.last.is_some() {
                if self.ended > 0 {
                    self.divisor = greatest_common_divisor(self.divisor, self.length);
                }
                self.ended += 1;
            }
            (self.last, self.length) = (Some(x), 1);
        }
    }

    /// Number of times that each draw is written, and ln of a bound on the probability of that; `None` for once.
    pub fn found(&self) -> Option<(u64, f64)> {
        let pairs = self.ended.saturating_sub(1) / 2;
        (self.divisor > 1 && pairs >= 2).then(|| {
            let ln_p = std::f64::consts::LN_2 - pairs as f64 * 3f64.ln();
            (self.divisor, ln_p.min(0.0))
        })
    }
}

fn greatest_common_divisor(mut a: u64, mut b: u64) -> u64 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::rng::{Address, unit};

    fn found(draws: impl Iterator<Item = f64>) -> Option<Replay> {
        let mut replays = Replays::default();
        let draws: Vec<f64> = draws.collect();
        draws.chunks(10_000).for_each(|block| replays.absorb(block));
        replays.found()
    }

    fn uniforms(n: usize) -> Vec<f64> {
        let mut rng = Address { seed: 5, experiment: 0, block: 0, lane: 0 }.stream();
        (0..n).map(|_| unit(&mut rng)).collect()
    }

    #[test]
    fn a_pass_of_the_same_seed_is_found_at_its_distance() {
        let once = uniforms(300_000);
        for passes in [2, 5] {
            let replay = found(once.iter().copied().cycle().take(passes * 300_000)).expect("one");
            assert_eq!(replay.distance, 300_000);
            assert!(replay.ln_p < -1000.0, "{replay:?}");
        }
        for (draws, times) in [(500, 24), (1000, 17), (100, 1000), (20, 12), (5000, 200)] {
            let replay = found(once[..draws].iter().copied().cycle().take(times * draws - 7));
            let replay = replay.expect("one");
            assert_eq!((replay.distance, replay.times), (draws as u64, times as u64));
            assert!(replay.ln_p < -15.0, "{replay:?}");
        }
        // A short overlap between long streams.
        let overlap = once.iter().chain(&once[299_000..]).copied();
        let replay = found(overlap).expect("one");
        assert_eq!(replay.distance, 1000);
        assert!(replay.ln_p < -100.0, "{replay:?}");
    }

    #[test]
    fn draws_of_which_half_are_zero_are_compared_by_the_others() {
        let once: Vec<f64> = uniforms(100_000).iter().map(|u| (2.0 * u - 1.0).max(0.0)).collect();
        let replay = found(once.iter().copied().cycle().take(400_000)).expect("one");
        assert_eq!(replay.distance, 100_000);
        assert!(replay.ln_p < -1000.0, "{replay:?}");
        let fresh: Vec<f64> = uniforms(400_000).iter().map(|u| (2.0 * u - 1.0).max(0.0)).collect();
        assert_eq!(found(fresh.into_iter()), None);
    }

    #[test]
    fn coarse_and_discrete_draws_are_no_replays() {
        assert_eq!(found(uniforms(300_000).into_iter()), None);
        for steps in [2.0, 100.0, 1e4, 1e5, 1e6] {
            let replay = found(uniforms(300_000).iter().map(|u| (u * steps).floor()));
            assert!(replay.is_none_or(|replay| replay.ln_p > -7.0), "{steps}: {replay:?}");
        }
    }

    fn runs(draws: &[f64]) -> Option<(u64, f64)> {
        let mut runs = Runs::default();
        draws.chunks(100).for_each(|block| runs.absorb(block));
        runs.found()
    }

    fn coins(n: usize, p: f64) -> Vec<f64> {
        let mut rng = Address { seed: 3, experiment: 0, block: 0, lane: 0 }.stream();
        (0..n).map(|_| f64::from(u8::from(unit(&mut rng) < p))).collect()
    }

    #[test]
    fn coins_that_are_written_several_times_are_found_from_any_place() {
        for times in [2, 3, 16, 100] {
            let many: Vec<f64> =
                coins(200, 0.5).iter().flat_map(|&x| std::iter::repeat_n(x, times)).collect();
            for from in [0, 1, times / 2] {
                let (k, ln_p) = runs(&many[from..]).expect("runs");
                assert!(k == times as u64 && ln_p < -30.0, "{times}: {k}, {ln_p}");
            }
        }
    }

    #[test]
    fn coins_that_are_written_once_are_not() {
        for p in [0.5, 0.1, 1e-3, 0.0] {
            assert_eq!(runs(&coins(10_000, p)), None, "{p}");
        }
    }

    #[test]
    fn the_bound_by_hand() {
        // Runs 3, then 2, 2, 2, 2, then 1: two pairs count, 2 · 3⁻².
        let draws = [1, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0].map(f64::from);
        let (k, ln_p) = runs(&draws).expect("runs");
        assert_eq!(k, 2);
        assert!((ln_p - (2.0f64 / 9.0).ln()).abs() < 1e-12, "{ln_p}");
    }
}
