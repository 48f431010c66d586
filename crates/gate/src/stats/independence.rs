//! Dependence of draws on those shortly before them: exact sign tests for every distribution.
//!
//! ```text
//! four draws  a = x_i − x_{i+D},  b = x_{i+l} − x_{i+l+D},  each draw in one foursome of its lag
//! of independent draws of one distribution ab is as often positive as negative (exchange x_i and x_{i+D})
//! lags        l = 1 … 16
//! scales      the same of sums of 2, 4, 8, … consecutive draws and their neighbours
//! m signs, k of them positive:   e = 2^m B(k + ½, m − k + ½)/π,   E = mean of e over 48 questions
//! ```
//!
//! Draws that resemble adjacent draws make ab positive: an autocorrelated chain, strata in their order, draws
//! written twice. Draws that avoid each other make it negative: shuffled strata, low discrepancies. D is about half
//! a block and changes from block to block, so that no period hides. The signs are independent with probability ½
//! for every distribution, heavy tails and atoms included (ties are left out), and e is a mixture of bets on them:
//! E is valid at any number of looks.
//!
//! Sources: R. E. Krichevsky, V. K. Trofimov, *The performance of universal encoding*, IEEE
//! Transactions on Information Theory 27 (1981), for the mixture; M. G. Kendall, *A new measure of rank
//! correlation*, Biometrika 30 (1938), for the sign of ab.

use std::array::from_fn;

use numeric::fused::in_fused_code;

/// The largest lag.
pub const LAGS: usize = 16;
/// Number of scales: sums of up to 2³² draws.
const SCALES: usize = 32;
/// Number of first blocks in which all lags are tested; later every fourth block is.
const ALL: u64 = 32;
/// Minimum number of values from which pairs are made.
const FEWEST: usize = 8;

/// Evidence on the dependence of adjacent draws.
#[derive(Debug, Clone)]
pub struct Independence {
    lags: [Signs; LAGS],
    /// Signs of sums of 2^(k+1) draws.
    scales: [Signs; SCALES],
    /// Sums of whole blocks and of twice as many each, until there are four.
    waiting: [Vec<f64>; SCALES],
    blocks: u64,
    /// The length of a whole block; later blocks of another length are not summed further.
    length: usize,
    sums: Vec<f64>,
    /// Differences of draws that are D apart.
    apart: Vec<f64>,
}

/// Signs of one lag or scale.
#[derive(Debug, Clone, Copy, Default)]
pub struct Signs {
    positive: u64,
    negative: u64,
    products: f64,
    squares: f64,
}

/// A dependence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dependence {
    /// Number of consecutive draws in each sum: 1 for the draws themselves.
    pub scale: u64,
    /// The distance, in draws or sums.
    pub lag: u64,
    /// An estimate of the correlation.
    pub correlation: f64,
    /// ln e of this lag or scale.
    pub ln_e: f64,
}

impl Signs {
    /// Adds the sign of ab, without branches: a processor cannot predict signs.
    #[allow(clippy::needless_bitwise_bool)] // `||` and `&&` are branches
    #[inline(always)]
    pub fn add(&mut self, a: f64, b: f64) {
        let (up, down) = ([a > 0.0, b > 0.0], [a < 0.0, b < 0.0]);
        self.positive += u64::from(up[0] & up[1] | down[0] & down[1]);
        self.negative += u64::from(up[0] & down[1] | down[0] & up[1]);
        self.products += a * b;
        self.squares += a * a + b * b;
    }

    /// ln e.
    pub fn ln_e(&self) -> f64 {
        let (k, m) = (self.positive as f64, (self.positive + self.negative) as f64);
        let ln_beta = libm::lgamma(k + 0.5) + libm::lgamma(m - k + 0.5) - libm::lgamma(m + 1.0);
        m * std::f64::consts::LN_2 + ln_beta - std::f64::consts::PI.ln()
    }

    /// An estimate of the correlation.
    pub fn correlation(&self) -> f64 {
        if self.squares > 0.0 { 2.0 * self.products / self.squares } else { 0.0 }
    }

    /// All foursomes of a lag: two differences `LAG` apart, each difference in one foursome.
    #[inline(always)]
    fn add_all<const LAG: usize>(&mut self, differences: &[f64]) {
        let mut lanes = [Self::default(); LAG];
        let mut pairs = differences.chunks_exact(2 * LAG);
        for pair in &mut pairs {
            let (first, second) = pair.split_at(LAG);
            for lane in 0..LAG {
                lanes[lane].add(first[lane], second[lane]);
            }
        }
        let (first, second) = pairs.remainder().split_at(pairs.remainder().len().min(LAG));
        for (signs, (&a, &b)) in lanes.iter_mut().zip(first.iter().zip(second)) {
            signs.add(a, b);
        }
        for signs in lanes {
            self.positive += signs.positive;
            self.negative += signs.negative;
            self.products += signs.products;
            self.squares += signs.squares;
        }
    }
}

impl Default for Independence {
    fn default() -> Self {
        Self {
            lags: [Signs::default(); LAGS],
            scales: [Signs::default(); SCALES],
            waiting: from_fn(|_| Vec::new()),
            blocks: 0,
            length: 0,
            sums: Vec::new(),
            apart: Vec::new(),
        }
    }
}

/// The differences of draws that are D apart.
#[inline(always)]
fn differences(x: &[f64], block: u64, apart: &mut Vec<f64>) {
    let reach = x.len() * 7 / 16;
    // A multiplicative hash: no period of the draws is that of D.
    let spread = (block.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 33) as usize;
    let distance = reach + spread % (x.len() - 2 * reach).max(1);
    apart.clear();
    apart.extend(x[..reach].iter().zip(&x[distance..]).map(|(near, far)| near - far));
}

/// Adds the foursomes of all lags.
#[inline(always)]
fn add_lags(lags: &mut [Signs; LAGS], apart: &[f64]) {
    macro_rules! add {
        ($($lag:literal)*) => { $(lags[$lag - 1].add_all::<$lag>(apart);)* };
    }
    add!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16);
}

impl Independence {
    /// Adds a block of draws that follow the last one.
    pub fn absorb(&mut self, x: &[f64]) {
        let block = self.blocks;
        self.blocks += 1;
        if self.length == 0 {
            self.length = x.len();
        }
        let is_whole = x.len() == self.length && x.len().is_power_of_two();
        let (mut sums, mut apart) =
            (std::mem::take(&mut self.sums), std::mem::take(&mut self.apart));
        in_fused_code(
            #[inline(always)]
            || {
                if x.len() >= FEWEST && (block < ALL || block.is_multiple_of(4)) {
                    differences(x, block, &mut apart);
                    add_lags(&mut self.lags, &apart);
                }
                sums.clear();
                sums.extend(x.as_chunks::<2>().0.iter().map(|[a, b]| a + b));
            },
        );
        let mut scale = 0;
        while sums.len() > 1 && scale < SCALES {
            if sums.len() >= FEWEST {
                differences(&sums, block, &mut apart);
                self.scales[scale].add_all::<1>(&apart);
            } else if let [a, b, c, d] = sums[..] {
                self.scales[scale].add(a - c, b - d);
            }
            scale += 1;
            let half = sums.len() / 2;
            for k in 0..half {
                sums[k] = sums[2 * k] + sums[2 * k + 1];
            }
            sums.truncate(half);
        }
        if let (true, [whole]) = (is_whole, &sums[..]) {
            self.pass_on(scale, *whole);
        }
        (self.sums, self.apart) = (sums, apart);
    }

    /// Adds the sum of a whole block to those of the blocks before.
    fn pass_on(&mut self, scale: usize, sum: f64) {
        let Some(waiting) = self.waiting.get_mut(scale) else { return };
        waiting.push(sum);
        let [a, b, c, d] = waiting[..] else { return };
        waiting.clear();
        self.scales[scale].add(a - c, b - d);
        self.pass_on(scale + 1, a + b);
        self.pass_on(scale + 1, c + d);
    }

    fn questions(&self) -> impl Iterator<Item = Dependence> {
        let about = |signs: &Signs, scale, lag| Dependence {
            scale,
            lag,
            correlation: signs.correlation(),
            ln_e: signs.ln_e(),
        };
        let lags = (1..).zip(&self.lags).map(move |(lag, signs)| about(signs, 1, lag));
        let scales = (1..).zip(&self.scales).map(move |(k, signs)| about(signs, 1 << k, 1));
        lags.chain(scales)
    }

    /// ln E.
    pub fn ln_e(&self) -> f64 {
        super::capital::ln_mean_exp(&self.questions().map(|result| result.ln_e).collect::<Vec<_>>())
    }

    /// The first dependence with evidence of its own that reaches `ln_limit`, else the strongest.
    pub fn strongest(&self, ln_limit: f64) -> Option<Dependence> {
        let all = (LAGS + SCALES) as f64;
        let first = self.questions().find(|result| result.ln_e >= ln_limit + all.ln());
        first.or_else(|| self.questions().max_by(|a, b| a.ln_e.total_cmp(&b.ln_e)))
    }

    /// Minimum number of consecutive draws from which on sums show no dependence at `ln_limit`.
    pub fn free_batch(&self, ln_limit: f64) -> Option<u64> {
        let limit = ln_limit + ((LAGS + SCALES) as f64).ln();
        let is_refuted = |signs: &Signs| signs.ln_e() >= limit;
        let last = self.scales.iter().rposition(is_refuted).map_or(0, |last| last + 1);
        // Averages hide no correlation over a lag that is longer than they are.
        let lag = self.lags.iter().rposition(is_refuted).map_or(0, |lag| lag + 1);
        let scale = last.max(lag.next_power_of_two().ilog2() as usize);
        let signs = self.scales.get(scale)?;
        // A scale of few signs has too little evidence.
        (signs.positive + signs.negative >= 40).then_some(2 << scale)
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use numeric::rng::{Address, exponential, unit};

    const LIMIT: f64 = 6.9;

    fn found(draws: impl Iterator<Item = f64>) -> Independence {
        let draws: Vec<f64> = draws.collect();
        let mut independence = Independence::default();
        draws.chunks(1 << 14).for_each(|block| independence.absorb(block));
        independence
    }

    fn stream(seed: u64) -> numeric::rng::Stream {
        Address { seed, experiment: 0, block: 0, lane: 0 }.stream()
    }

    #[test]
    fn independent_draws_of_any_law_are_independent() {
        for seed in 0..20 {
            let mut rng = stream(seed);
            let draw: &mut dyn FnMut() -> f64 = match seed % 4 {
                0 => &mut || exponential(&mut rng),
                1 => &mut || f64::from(u8::from(unit(&mut rng) < 0.01)),
                2 => &mut || unit(&mut rng).powi(-3),
                _ => &mut || (12.0 * exponential(&mut rng)).exp(),
            };
            let independence = found((0..100_000).map(|_| draw()));
            assert!(independence.ln_e() < LIMIT, "{seed}: {:?}", independence.strongest(LIMIT));
        }
    }

    #[test]
    fn a_chain_is_found_with_its_correlation() {
        let mut rng = stream(1);
        let mut state = 0.0;
        let chain = (0..100_000).map(|_| {
            let normal: f64 = (0..12).map(|_| unit(&mut rng)).sum::<f64>() - 6.0;
            state = 0.9 * state + normal * (1.0 - 0.81f64).sqrt();
            state
        });
        let independence = found(chain);
        let dependence = independence.strongest(LIMIT).expect("a question");
        assert!(independence.ln_e() > 100.0);
        assert_eq!((dependence.scale, dependence.lag), (1, 1));
        assert!((dependence.correlation - 0.9).abs() < 0.02, "{dependence:?}");
        let batch = independence.free_batch(LIMIT).expect("a batch");
        assert!((16..1024).contains(&batch), "{batch}");
    }

    #[test]
    fn strata_in_order_shuffled_strata_and_doubled_draws_are_found() {
        let n = 100_000;
        let mut rng = stream(2);
        let sorted = found((0..n).map(|i| (f64::from(i) + unit(&mut rng)) / f64::from(n)));
        assert!(sorted.ln_e() > 100.0);
        for strata in [4, 10, 16, 64, 100] {
            let cycles = found((0..n).map(|i| (f64::from(i % strata) + unit(&mut rng)).powi(2)));
            assert!(cycles.ln_e() > 20.0, "{strata}: {}", cycles.ln_e());
            let mut order: Vec<i32> = (0..strata).collect();
            let mut shuffled = Vec::new();
            for _ in 0..n / strata {
                for k in (1..order.len()).rev() {
                    order.swap(k, rng.random_range(0..=k));
                }
                shuffled.extend(order.iter().map(|&k| f64::from(k) + unit(&mut rng)));
            }
            let shuffled = found(shuffled.into_iter());
            assert!(shuffled.ln_e() > LIMIT, "{strata}: {}", shuffled.ln_e());
        }
        let mut last = 0.0;
        let doubled = found((0..n).map(|i| {
            last = if i % 2 == 0 { exponential(&mut rng) } else { last };
            last
        }));
        assert!(doubled.ln_e() > 100.0);
        // Half of all adjacent draws are equal.
        assert!((doubled.strongest(LIMIT).expect("one").correlation - 1.0).abs() < 0.6);
    }

    #[test]
    fn evidence_by_hand() {
        // Three signs alike: 2³ B(3.5, 0.5)/π = 8 · (5/16) = 2.5.
        let signs = Signs { positive: 3, ..Signs::default() };
        assert!((signs.ln_e() - 2.5f64.ln()).abs() < 1e-13);
        let none = Signs::default();
        assert!(none.ln_e().abs() < 1e-13);
        assert!(found(std::iter::empty()).ln_e().abs() < 1e-13);
    }
}
