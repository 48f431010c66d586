//! Sums of draws: mean and central moments to the fourth order.
//!
//! Draws are multiples of 2⁻²⁴ or of 2⁻⁵², so that the sums of their powers are whole numbers: exact
//! in 128 bits. Where one draw is too large for that the reference is a sum of 32 digits.
//!
//! ```text
//! a lane adds up 512 numbers of a buffer: error ≤ 512·2⁻⁵³ of Σ|yᵏ|; buffers are merged with the
//! rounding errors kept
//! ```

use proptest::num::u64::ANY as WORD;

use super::prelude::*;
use gate::stats::{Powers, Tally};
use numeric::rng::Stream;
use numeric::sum::Sum;

/// Draws of a buffer.
const BUFFER: usize = 4096;
/// Buffers of a trial.
const BUFFERS: usize = 256;
/// Number of times that all draws are added to themselves: 2³⁰ draws.
const DOUBLINGS: i32 = 10;
/// 512 additions and four roundings of a power.
const BOUND: f64 = 516.0 * f64::EPSILON / 2.0;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let mut rows = Vec::new();
    for distribution in [UNIFORM, NEAR_CONSTANT] {
        let row = |what: &str, measure, bound| {
            TrialRow::new(
                format!("{what} of {}", distribution.name),
                format!("1e9 draws, {}", distribution.range),
                measure,
                bound,
            )
        };
        let of_law = [
            row("mean", Measure::Deviations, BOUND),
            row("variance", Measure::Relative, BOUND),
            // Four moments enter, the largest three times as large as their difference.
            row("kurtosis", Measure::Relative, 4.0 * BOUND),
        ];
        rows.extend(run.fill(
            [8, 256],
            of_law,
            || WORD,
            |&seed, seen| whole_numbers(distribution, seed, seen),
        ));
    }
    let range = "262144 draws, one of them 1e3 … 1e60";
    let huge = [
        TrialRow::relative("variance with one huge draw", range, BOUND),
        TrialRow::relative("kurtosis with one huge draw", range, 8.0 * BOUND),
    ];
    rows.extend(run.fill([4, 64], huge, Huge::any, one_huge_draw));
    let range = "±x of 1e-12 … 1e12 and a rest of 1, any order";
    let sum = TrialRow::relative("compensated sum that cancels", range, 1e-15);
    rows.extend(run.fill([20, 400], [sum], Terms::any, cancelling));
    rows
}

parameters! {
    /// Uniform draws with one among them that is larger by powers of ten.
    Huge {
        power: i32 = any_of(&[3, 6, 9, 15, 30, 60]),
        seed: u64 = WORD,
    }
    /// Terms of both signs and all sizes, and an order.
    Terms {
        sizes: Vec<f64> = vec(sized(-12.0, 12.0), 500),
        order: u64 = WORD,
    }
}

/// A stream of random numbers that starts at a word.
fn stream(seed: u64) -> Stream {
    Stream::at([seed, 1, 2, 3])
}

/// A number below a bound.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below the bound
fn below(stream: &mut Stream, bound: usize) -> usize {
    (bound as f64 * stream.uniform()) as usize
}

/// Draws `offset + k·unit` with `0 ≤ k < 2^bits`.
#[derive(Clone, Copy)]
struct OffsetDraws {
    name: &'static str,
    range: &'static str,
    bits: u32,
    unit: f64,
    offset: f64,
}

const UNIFORM: OffsetDraws = OffsetDraws {
    name: "uniform draws",
    range: "k·2⁻²⁴ in [0, 1)",
    bits: 24,
    unit: 1.0 / 16_777_216.0,
    offset: 0.0,
};
const NEAR_CONSTANT: OffsetDraws = OffsetDraws {
    name: "draws of variance 4e-21 mean²",
    range: "1 + k·2⁻⁵², k < 2²⁰",
    bits: 20,
    unit: f64::EPSILON,
    offset: 1.0,
};

/// A whole number in 32 digits.
fn whole(k: i128) -> DoubleDouble {
    let high = k as f64;
    #[allow(clippy::cast_possible_truncation)] // a whole number below 2¹²⁷
    let rest = k - high as i128;
    DoubleDouble::from(high) + rest as f64
}

/// Buffers of whole numbers, merged in a random tree, and then with themselves.
fn whole_numbers(distribution: OffsetDraws, seed: u64, seen: &mut Seen) -> Option<()> {
    let (mut stream, centre) = (stream(seed), 1_i64 << (distribution.bits - 1));
    let shift = distribution.offset + centre as f64 * distribution.unit;
    let mut exact = [0_i128; 4];
    let mut buffers: Vec<(Tally, Powers)> = Vec::new();
    for _ in 0..BUFFERS {
        let mut draw = || {
            let k = (stream.word() >> (64 - distribution.bits)).cast_signed();
            let off = i128::from(k - centre);
            let powers = [off, off * off, off * off * off, off * off * off * off];
            exact.iter_mut().zip(powers).for_each(|(sum, power)| *sum += power);
            distribution.offset + k as f64 * distribution.unit
        };
        let draws: Vec<f64> = (0..BUFFER).map(|_| draw()).collect();
        let shifted: Vec<f64> = draws.iter().map(|x| x - shift).collect();
        let mut powers = Powers::default();
        powers.absorb(&shifted);
        buffers.push((Tally::of(&draws, shift, 1.0), powers));
    }
    while buffers.len() > 1 {
        let at = below(&mut stream, buffers.len() - 1);
        let later = buffers.remove(at + 1);
        buffers[at].0.merge(&later.0);
        buffers[at].1.merge(&later.1);
    }
    let (mut tally, mut powers) = buffers.remove(0);
    for _ in 0..DOUBLINGS {
        tally.merge(&tally.clone());
        powers.merge(&powers.clone());
    }
    let draws = DoubleDouble::from((BUFFER * BUFFERS) as f64);
    let raw = exact.map(|sum| whole(sum) / draws);
    let [second, fourth] = central(raw, DoubleDouble::ONE);
    let (n, unit) = (draws.scaled(DOUBLINGS), DoubleDouble::from(distribution.unit));
    let variance = second * n / (n - 1.0);
    let moments = tally.moments()?;
    for computed in [moments.mean, powers.mean()] {
        seen.see(
            0,
            ((DoubleDouble::from(computed) / unit - raw[0]) / variance.sqrt()).abs().value(),
        );
    }
    for computed in [moments.variance?, powers.variance()] {
        seen.relative(1, computed, variance * unit * unit);
    }
    seen.relative(2, powers.kurtosis(), fourth / (second * second));
    Some(())
}

fn one_huge_draw(&Huge { power, seed }: &Huge, seen: &mut Seen) -> Option<()> {
    let mut stream = stream(seed);
    let mut x: Vec<f64> = (0..1 << 18).map(|_| stream.uniform()).collect();
    x[87_381] = 10f64.powi(power);
    let (mut tally, mut powers) = (Tally::default(), Powers::default());
    for buffer in x.chunks(BUFFER) {
        tally.merge(&Tally::of(buffer, 0.0, 1.0));
        powers.absorb(buffer);
    }
    let n = DoubleDouble::from(x.len() as f64);
    let mean = x.iter().map(|&x| DoubleDouble::from(x)).sum::<DoubleDouble>() / n;
    let central =
        |k| x.iter().map(|&x| (DoubleDouble::from(x) - mean).powi(k)).sum::<DoubleDouble>() / n;
    let [second, fourth] = [central(2), central(4)];
    for computed in [tally.moments()?.variance?, powers.variance()] {
        seen.relative(0, computed, second * n / (n - DoubleDouble::ONE));
    }
    seen.relative(1, powers.kurtosis(), fourth / (second * second));
    Some(())
}

fn cancelling(Terms { sizes, order }: &Terms, seen: &mut Seen) {
    let mut terms = vec![1.0];
    terms.extend(sizes.iter().flat_map(|&x| [x, -x]));
    let mut stream = stream(*order);
    for i in (1..terms.len()).rev() {
        terms.swap(i, below(&mut stream, i + 1));
    }
    seen.see(0, (terms.iter().copied().collect::<Sum>().value() - 1.0).abs());
}
