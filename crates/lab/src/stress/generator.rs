//! Random numbers: their ends and their grain. Every run checks streams for overlaps, correlation and spread.

use proptest::num::u64::ANY as WORD;

use super::prelude::*;
use numeric::rng::{Stream, exponential, unit};

/// Uniform numbers are multiples of this.
const GRAIN: f64 = f64::EPSILON / 2.0;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "words 0, 2¹¹, 2⁶³, 2⁶⁴ − 1 and neighbours";
    let ends = TrialRow::wrong("uniforms outside their range", range);
    let word = || {
        (any_of(&[0, 1 << 11, 1 << 63, u64::MAX]), 0..3_u64)
            .prop_map(|(near, step)| near.wrapping_add(step).wrapping_sub(1))
    };
    let mut rows = run.fill([64, 64], [ends], word, edges);
    let range = "τ = 1e-18 … 36, all 2⁵³ numbers";
    let probability =
        TrialRow::new("probability of a collision", range, Measure::Absolute, 3.0 * GRAIN);
    rows.extend(run.fill([400, 4000], [probability], || sized(-18.0, 1.55), collisions));
    let distance = TrialRow::relative("distance of a flight", "σ̂ = 1e-9 … 1e9", 1e-15);
    rows.extend(run.fill([950, 38_000], [distance], Flight::any, distances));
    rows
}

parameters! {
    /// A flight with the depth of a random word.
    Flight {
        power: i32 = -9..=9,
        word: u64 = WORD,
    }
}

/// A stream with a known next word.
fn before(word: u64) -> Stream {
    // out = s₀ + s₃ with s₀ = 0.
    Stream::at([0, 1, 2, word])
}

fn edges(&word: &u64, seen: &mut Seen) {
    let numbers = [before(word).uniform(), unit(&mut before(word))];
    let positive = before(word).positive_uniform();
    let flights = [-before(word).ln_uniform(), exponential(&mut before(word))];
    let is_right = before(word).word() == word
        && numbers.iter().all(|u| (0.0..1.0).contains(u))
        && positive > 0.0
        && positive <= 1.0
        && flights.iter().all(|depth| (0.0..36.8).contains(depth));
    seen.wrong(0, !is_right);
}

/// Number of the 2⁵³ numbers that make a flight end within an optical depth, found by bisection, against
/// `1 − e^{−τ}`.
fn collisions(&depth: &f64, seen: &mut Seen) {
    let is_within = |k: u64| -before(k << 11).ln_uniform() < depth;
    let (mut low, mut high) = (0, 1_u64 << 53);
    while low < high {
        let middle = low.midpoint(high);
        if is_within(middle) { low = middle + 1 } else { high = middle }
    }
    seen.see(0, off(low as f64 * GRAIN, -(-DoubleDouble::from(depth)).exp_m1()));
}

/// Flights through σ̂ of any size: each is `−ln(u)/σ̂`.
fn distances(&Flight { power, word }: &Flight, seen: &mut Seen) -> Option<()> {
    let sampling = 10f64.powi(power);
    let field = Piecewise::constant(sampling, Span::new(0.0, 40.0 / sampling));
    let uniform = before(word).positive_uniform();
    let mut cursor = field.begin();
    cursor.fly(-before(word).ln_uniform()).filter(|_| uniform < 1.0)?;
    seen.relative(0, cursor.t(), -DoubleDouble::from(uniform).ln() / DoubleDouble::from(sampling));
    Some(())
}
