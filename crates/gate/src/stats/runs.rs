//! Draws that are written several times each: the length of every run of equal draws is then a multiple of a number.
//!
//! ```text
//! a run of a value of probability p:   P(its length is a multiple of k) = p^{k−1}(1 − p)/(1 − p^k)
//! p ≤ ½:   1/(2^k − 1) at most;   of two runs one after the other one has a value of p ≤ ½
//! 2h runs of multiples of some k ≥ 2:   P ≤ Σ_k (2^k − 1)^{−h} ≤ 2 · 3^{−h}  for h ≥ 2
//! ```
//!
//! The bound holds for independent draws of every law. The first and the last run may be incomplete and do not
//! count.

/// Runs of equal draws.
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

    fn found(draws: &[f64]) -> Option<(u64, f64)> {
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
                let (k, ln_p) = found(&many[from..]).expect("runs");
                assert!(k == times as u64 && ln_p < -30.0, "{times}: {k}, {ln_p}");
            }
        }
    }

    #[test]
    fn coins_that_are_written_once_are_not() {
        for p in [0.5, 0.1, 1e-3, 0.0] {
            assert_eq!(found(&coins(10_000, p)), None, "{p}");
        }
    }

    #[test]
    fn the_bound_by_hand() {
        // Runs 3, then 2, 2, 2, 2, then 1: two pairs count, 2 · 3⁻².
        let draws = [1, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0].map(f64::from);
        let (k, ln_p) = found(&draws).expect("runs");
        assert_eq!(k, 2);
        assert!((ln_p - (2.0f64 / 9.0).ln()).abs() < 1e-12, "{ln_p}");
    }
}
