//! Whether a sequence of draws repeats an earlier one: the same seed for two passes or two threads.
//!
//! ```text
//! keep     draws whose bits have a certain hash, ever fewer of them, so that the memory is bounded
//! pairs    t values that occur from 2 to 16 times; d the distance of their first two places
//! replay   c of the d are the same:  p ≤ C(t, c) (16/n)^{c−1}
//! ```
//!
//! Of independent draws of one law all orders are equally likely, so that the first two of at most 16
//! places of a value are d apart with chance 16/n at most, whatever the law. Values that occur more
//! often, the atoms of discrete laws, say nothing. What is kept depends on a value alone, so that of
//! two equal sequences the same draws are kept, however far apart they are.

/// The most draws that are kept.
const MOST: usize = 1 << 16;
/// The most places of a value.
const PLACES: usize = 16;

/// Draws that are kept for comparison.
#[derive(Debug, Clone, Default)]
pub struct Replays {
    kept: Vec<(u64, u64)>,
    /// How many leading bits of a hash must be 0.
    bits: u32,
    draws: u64,
}

/// A repetition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Replay {
    /// How many draws later the same draws come again.
    pub distance: u64,
    /// How many of the kept draws do.
    pub count: u64,
    /// ln of a bound on the chance of that.
    pub ln_p: f64,
}

#[inline(always)]
fn hash(bits: u64) -> u64 {
    // The upper bits of a product depend on all bits below them.
    (bits ^ (bits >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93)
}

impl Replays {
    /// Adds draws that follow the last ones.
    pub fn absorb(&mut self, x: &[f64]) {
        for x in x {
            let bits = x.to_bits();
            // Zero is the commonest atom, and its hash would be kept for ever.
            if *x != 0.0 && hash(bits).leading_zeros() >= self.bits {
                self.kept.push((bits, self.draws));
                if self.kept.len() >= MOST {
                    self.bits += 1;
                    let least = self.bits;
                    self.kept.retain(|(bits, _)| hash(*bits).leading_zeros() >= least);
                }
            }
            self.draws += 1;
        }
    }

    /// The most frequent distance; `None` where no value occurs twice.
    pub fn most_frequent(&self) -> Option<Replay> {
        let mut kept = self.kept.clone();
        kept.sort_unstable();
        let groups = kept.chunk_by(|a, b| a.0 == b.0).filter(|g| (2..=PLACES).contains(&g.len()));
        let mut distances: Vec<u64> = groups.map(|group| group[1].1 - group[0].1).collect();
        distances.sort_unstable();
        let longest = distances.chunk_by(|a, b| a == b).max_by_key(|run| run.len())?;
        let (t, c) = (distances.len() as f64, longest.len() as f64);
        let chance = (PLACES as f64 / self.draws as f64).min(1.0).ln();
        let ways = libm::lgamma(t + 1.0) - libm::lgamma(c + 1.0) - libm::lgamma(t - c + 1.0);
        let ln_p = (ways + (c - 1.0) * chance).min(0.0);
        Some(Replay { distance: longest[0], count: longest.len() as u64, ln_p })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Address, unit};

    fn found(draws: impl Iterator<Item = f64>) -> Option<Replay> {
        let mut replays = Replays::default();
        let draws: Vec<f64> = draws.collect();
        draws.chunks(10_000).for_each(|block| replays.absorb(block));
        replays.most_frequent()
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
}
