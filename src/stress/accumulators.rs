//! Sums of draws: mean and central moments to the fourth order.
//!
//! Draws are multiples of 2⁻²⁴ or of 2⁻⁵², so that the sums of their powers are whole numbers: exact
//! in 128 bits over 2³⁰ draws. Where one draw is too large for that the reference is a sum of 32 digits.
//!
//! ```text
//! a lane adds up 512 numbers of a buffer: error ≤ 512·2⁻⁵³ of Σ|yᵏ|; buffers are merged with the
//! rounding errors kept
//! ```

use super::trial::{Trial, central};
use super::{Dice, Effort, Measure, Row, in_parts};
use gate::stats::{Powers, Tally};
use numeric::Wide;
use numeric::sum::Sum;
use theory::parallel;

/// Draws of a buffer, as of a run.
const BUFFER: usize = 4096;
/// Buffers of a part that one thread works on.
const BUFFERS: u64 = 256;
/// 512 additions and four roundings of a power.
const BOUND: f64 = 516.0 * f64::EPSILON / 2.0;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let parts = effort.of(8, 1024);
    let mut rows = whole_numbers("uniform draws", seed, parts, &UNIFORM);
    rows.extend(whole_numbers("draws of variance 4e-21 mean²", seed, parts, &NEAR_CONSTANT));
    rows.extend(one_huge_draw(effort, seed));
    let range = "±x of 1e-12 … 1e12 and a rest of 1, any order";
    let sum = Row::relative("compensated sum that cancels", range, 1e-15);
    let parts = effort.of(20, 400);
    rows.extend(in_parts(parts, "cancelling", seed, |part| part.run(1, [sum.clone()], cancelling)));
    rows.push(threads(effort, seed));
    rows
}

/// Draws `offset + k·unit` with `0 ≤ k < 2^bits`.
struct Law {
    bits: u32,
    unit: f64,
    offset: f64,
    range: &'static str,
}

const UNIFORM: Law =
    Law { bits: 24, unit: 1.0 / 16_777_216.0, offset: 0.0, range: "k·2⁻²⁴ in [0, 1)" };
const NEAR_CONSTANT: Law =
    Law { bits: 20, unit: f64::EPSILON, offset: 1.0, range: "1 + k·2⁻⁵², k < 2²⁰" };

impl Law {
    /// The prediction: half way.
    fn centre(&self) -> i64 {
        1 << (self.bits - 1)
    }

    fn shift(&self) -> f64 {
        self.offset + self.centre() as f64 * self.unit
    }
}

/// Exact sums of the powers of `k − centre`.
#[derive(Clone, Copy, Default)]
struct Exact([i128; 4]);

impl Exact {
    fn absorb(&mut self, k: i64) {
        let square = i128::from(k * k);
        self.0[0] += i128::from(k);
        self.0[1] += square;
        self.0[2] += square * i128::from(k);
        self.0[3] += square * square;
    }

    fn merge(&mut self, later: &Self) {
        self.0.iter_mut().zip(later.0).for_each(|(sum, later)| *sum += later);
    }

    /// Mean, variance with `n − 1`, and kurtosis of the `k`s, in 32 digits.
    fn moments(&self, draws: u64) -> [Wide; 3] {
        let n = Wide::from(draws as f64);
        let raw = self.0.map(|sum| whole(sum) / n);
        let [variance, fourth] = central(raw, Wide::ONE);
        [raw[0], variance * n / (n - 1.0), fourth / (variance * variance)]
    }
}

/// A whole number in 32 digits.
fn whole(k: i128) -> Wide {
    let high = k as f64;
    #[allow(clippy::cast_possible_truncation)] // a whole number below 2¹²⁷
    let rest = k - high as i128;
    Wide::from(high) + rest as f64
}

/// What one thread summed.
struct Part {
    exact: Exact,
    tally: Tally,
    powers: Powers,
}

impl Part {
    fn of(law: &Law, name: &str, seed: u64, part: u64) -> Self {
        let mut dice = Dice::new(seed, name, part);
        let (shift, mask) = (law.shift(), (1 << law.bits) - 1);
        let mut found =
            Self { exact: Exact::default(), tally: Tally::default(), powers: Powers::default() };
        let (mut draws, mut y) = (vec![0.0; BUFFER], vec![0.0; BUFFER]);
        for _ in 0..BUFFERS {
            for pair in draws.chunks_exact_mut(2) {
                let word = dice.word();
                for (draw, k) in pair.iter_mut().zip([word >> 40, word >> 8 & 0xffff_ffff]) {
                    let k = (k & mask).cast_signed();
                    *draw = law.offset + k as f64 * law.unit;
                    found.exact.absorb(k - law.centre());
                }
            }
            y.iter_mut().zip(&draws).for_each(|(y, x)| *y = x - shift);
            found.tally.merge(&Tally::of(&draws, shift, 1.0));
            found.powers.absorb(&y);
        }
        found
    }
}

/// Joins neighbours at random until one is left: a tree of any shape.
fn in_a_tree(mut parts: Vec<(Tally, Powers)>, dice: &mut Dice) -> (Tally, Powers) {
    while parts.len() > 1 {
        let at = dice.below(parts.len() - 1);
        let later = parts.remove(at + 1);
        parts[at].0.merge(&later.0);
        parts[at].1.merge(&later.1);
    }
    parts.remove(0)
}

fn whole_numbers(name: &str, seed: u64, parts: u64, law: &Law) -> Vec<Row> {
    let found = parallel::numbered(parts, |part| Part::of(law, name, seed, part));
    let mut exact = Exact::default();
    for part in &found {
        exact.merge(&part.exact);
    }
    let draws = parts * BUFFERS * BUFFER as u64;
    let range = format!("{:.1e} draws, {}", draws as f64, law.range);
    let [mean, variance, kurtosis] = exact.moments(draws);
    let deviation = variance.sqrt();
    let row = |what: &str, measure| Row::new(format!("{what} of {name}"), &range, measure, BOUND);
    let mut of_mean = row("mean", Measure::Deviations);
    let mut of_variance = row("variance", Measure::Relative);
    // Four moments enter, the largest three times as large as their difference.
    let mut of_kurtosis = Row { bound: 4.0 * BOUND, ..row("kurtosis", Measure::Relative) };
    let pieces: Vec<(Tally, Powers)> = found.iter().map(|part| (part.tally, part.powers)).collect();
    let mut dice = Dice::new(seed, name, u64::MAX);
    for tree in 0..20 {
        let (tally, powers) = in_a_tree(pieces.clone(), &mut dice);
        let place = || format!("tree {tree}");
        let unit = Wide::from(law.unit);
        let Some(moments) = tally.moments() else {
            of_mean.see(f64::NAN, place);
            continue;
        };
        for mean_found in [moments.mean, powers.mean()] {
            let off = (Wide::from(mean_found) / unit - mean) / deviation;
            of_mean.see(off.abs().value(), place);
        }
        let exact = variance * unit * unit;
        for variance_found in [moments.variance.unwrap_or(f64::NAN), powers.variance()] {
            of_variance.see(exact.relative_error(variance_found), place);
        }
        of_kurtosis.see(kurtosis.relative_error(powers.kurtosis()), place);
    }
    vec![of_mean, of_variance, of_kurtosis]
}

/// Uniform draws with one among them that is larger by powers of ten.
fn one_huge_draw(effort: Effort, seed: u64) -> Vec<Row> {
    let draws = effort.of(1 << 18, 1 << 22);
    let range = format!("{draws} draws, one of them 1e3 … 1e60");
    let mut of_variance = Row::relative("variance with one huge draw", &range, BOUND);
    let mut of_kurtosis = Row::relative("kurtosis with one huge draw", &range, 8.0 * BOUND);
    for power in [3_i32, 6, 9, 15, 30, 60] {
        let mut dice = Dice::new(seed, "one huge draw", power.unsigned_abs().into());
        let mut x: Vec<f64> = (0..draws).map(|_| dice.between(0.0, 1.0)).collect();
        x[draws / 3] = 10f64.powi(power);
        let (mut tally, mut powers) = (Tally::default(), Powers::default());
        for buffer in x.chunks(BUFFER) {
            tally.merge(&Tally::of(buffer, 0.0, 1.0));
            powers.absorb(buffer);
        }
        let n = Wide::from(draws as f64);
        let mean = x.iter().map(|&x| Wide::from(x)).sum::<Wide>() / n;
        let central = |k| x.iter().map(|&x| (Wide::from(x) - mean).powi(k)).sum::<Wide>() / n;
        let [second, fourth] = [central(2), central(4)];
        let variance = second * n / (n - Wide::ONE);
        let place = || format!("1e{power}");
        let found = tally.moments().and_then(|moments| moments.variance).unwrap_or(f64::NAN);
        of_variance.see(variance.relative_error(found), place);
        of_variance.see(variance.relative_error(powers.variance()), place);
        let kurtosis = fourth / (second * second);
        of_kurtosis.see(kurtosis.relative_error(powers.kurtosis()), place);
    }
    vec![of_variance, of_kurtosis]
}

/// Terms of both signs and all sizes that add up to almost nothing.
fn cancelling(t: &mut Trial) {
    let mut terms = vec![1.0];
    for _ in 0..500 {
        let x = t.dice.sized(-12.0, 12.0);
        terms.extend([x, -x]);
    }
    for i in (1..terms.len()).rev() {
        let j = t.dice.below(i + 1);
        terms.swap(i, j);
    }
    let sum: Sum = terms.iter().copied().collect();
    t.place = format!("part {}", t.part);
    t.see(0, (sum.value() - 1.0).abs());
}

/// The same sums on any number of threads.
fn threads(effort: Effort, seed: u64) -> Row {
    let range = "1, 2, 3, 7 threads";
    let mut row = Row::wrong("bits that depend on threads", range);
    let parts = effort.of(4, 32);
    let sums = |threads| -> Option<String> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()?;
        let found = pool.install(|| {
            parallel::numbered(parts, |part| Part::of(&UNIFORM, "threads", seed, part))
        });
        let mut all = (Tally::default(), Powers::default());
        for part in &found {
            all.0.merge(&part.tally);
            all.1.merge(&part.powers);
        }
        // Every digit of every sum.
        Some(format!("{all:?}"))
    };
    let alone = sums(1);
    for threads in [2, 3, 7] {
        row.count(alone.is_none() || sums(threads) != alone, || format!("{threads} threads"));
    }
    row
}
