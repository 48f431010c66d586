//! What all pages share: random parameters, a loop over them, and how far a number is from a reference.

use super::Row;
use numeric::rng::{Address, Stream, name_hash};
use numeric::{Known, Wide};
use theory::Moments;
use theory::parallel;

/// Random parameters.
pub struct Dice(Stream);

impl Dice {
    /// Those of a part of a quantity.
    pub fn new(seed: u64, quantity: &str, part: u64) -> Self {
        let experiment = name_hash(&format!("stress|{quantity}"));
        Self(Address { seed, experiment, block: part, lane: 0 }.stream())
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// Of any size between two powers of ten.
    pub fn sized(&mut self, least: f64, most: f64) -> f64 {
        10f64.powf(self.between(least, most))
    }

    /// 1 or −1.
    pub fn sign(&mut self) -> f64 {
        if self.0.uniform() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Below a bound.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below the bound
    pub fn below(&mut self, bound: usize) -> usize {
        ((bound as f64 * self.0.uniform()) as usize).min(bound.saturating_sub(1))
    }

    /// 64 bits.
    pub fn word(&mut self) -> u64 {
        self.0.word()
    }
}

/// Joins the rows of the parts of a quantity in the order of the parts.
pub fn joined(found: Vec<Vec<Row>>) -> Vec<Row> {
    let mut found = found.into_iter();
    let first = found.next().unwrap_or_default();
    found.fold(first, |rows, later| {
        rows.into_iter().zip(later).map(|(row, later)| row.and(later)).collect()
    })
}

/// Runs the parts of a page on all threads, each with random parameters of its own.
pub fn in_parts(
    parts: u64,
    page: &str,
    seed: u64,
    fill: impl Fn(&mut Part) + Sync + Send,
) -> Vec<Row> {
    let part = |number: u64| {
        let dice = Dice::new(seed, page, number);
        let mut part = Part { number, dice, rows: Vec::new() };
        fill(&mut part);
        part.rows
    };
    joined(parallel::numbered(parts, part))
}

/// What a trial answers: nothing, or `None` where there was nothing to compare.
pub trait Outcome {
    /// Whether it is skipped in all rows.
    fn skips(self) -> bool;
}

impl Outcome for () {
    fn skips(self) -> bool {
        false
    }
}

impl Outcome for Option<()> {
    fn skips(self) -> bool {
        self.is_none()
    }
}

/// A part of a page: the rows of its table, one group after the other.
pub struct Part {
    /// Which part.
    pub number: u64,
    dice: Dice,
    rows: Vec<Row>,
}

impl Part {
    /// Rows that the same trials fill. A trial that answers `None` is skipped in all of them.
    pub fn run<const N: usize, O: Outcome>(
        &mut self,
        trials: u32,
        rows: [Row; N],
        trial: impl Fn(&mut Trial) -> O,
    ) {
        let (place, mut rows) = (String::new(), rows);
        let (part, dice) = (self.number, &mut self.dice);
        let mut at = Trial { part, number: 0, dice, rows: &mut rows, place };
        for number in 0..trials {
            at.number = number;
            at.place.clear();
            if trial(&mut at).skips() {
                (0..N).for_each(|row| at.skip(row));
            }
        }
        self.rows.extend(rows);
    }
}

/// One draw of parameters, and the rows that it may add to.
pub struct Trial<'a> {
    /// Which part of the page.
    pub part: u64,
    /// Which of the trials of a part.
    pub number: u32,
    /// The random parameters.
    pub dice: &'a mut Dice,
    rows: &'a mut [Row],
    /// Where in the range of parameters it is.
    pub place: String,
}

impl Trial<'_> {
    /// An error, in the measure of a row.
    pub fn see(&mut self, row: usize, error: f64) {
        self.rows[row].see(error, || self.place.clone());
    }

    /// Whether something is wrong.
    pub fn count(&mut self, row: usize, is_wrong: bool) {
        self.rows[row].count(is_wrong, || self.place.clone());
    }

    /// Whether there is such a row.
    pub fn has(&self, row: usize) -> bool {
        row < self.rows.len()
    }

    /// Nothing to compare.
    pub fn skip(&mut self, row: usize) {
        self.rows[row].skip(|| self.place.clone());
    }

    /// A value with its stated error.
    pub fn stated(&mut self, row: usize, found: Known, exact: Wide) {
        self.see(row, of_stated(found, exact));
    }

    /// A value beside an exact one, relative.
    pub fn relative(&mut self, row: usize, found: f64, exact: Wide) {
        self.see(row, exact.relative_error(found));
    }

    /// Variance and fourth moment from raw moments, in two rows that follow each other; skipped where theory
    /// has none.
    pub fn moments(
        &mut self,
        row: usize,
        found: Option<Moments>,
        raw: impl FnOnce(f64) -> [Wide; 2],
    ) {
        let Some(Moments { scale, relative, error }) = found else {
            self.skip(row);
            return self.skip(row + 1);
        };
        let exact = raw(scale);
        for (row, (found, exact)) in (row..).zip([relative[0], relative[2]].into_iter().zip(exact))
        {
            // Beyond the range of doubles for both.
            let is_beyond = found == f64::INFINITY && !exact.high.is_finite();
            self.see(row, if is_beyond { 0.0 } else { exact.relative_error(found) / error });
        }
    }

    /// A central moment with a relative error; skipped where theory does not resolve it.
    pub fn central(&mut self, row: usize, found: f64, error: f64, exact: Wide) {
        if found.is_finite() {
            self.stated(row, Known::new(found, found.abs() * error), exact);
        } else {
            self.skip(row);
        }
    }
}

/// How far a value is off.
pub fn off(found: f64, exact: Wide) -> f64 {
    (found - exact).abs().value()
}

/// An error in units of what is allowed, which may be nothing where there is none.
pub fn of_allowed(off: f64, allowed: f64) -> f64 {
    if off == 0.0 { 0.0 } else { off / allowed }
}

/// How far a value is off, in units of its stated error; what rounds to the truth is not.
pub fn of_stated(found: Known, exact: Wide) -> f64 {
    let off = off(found.value, exact);
    let rounding = 0.5 * f64::EPSILON * exact.high.abs();
    if off <= rounding { 0.0 } else { off / found.error }
}

/// The same beyond half a unit in the last place, which the nearest double may be off; what is no number
/// stays none.
pub fn beyond_rounding(found: Known, exact: Wide) -> f64 {
    beyond(off(found.value, exact), 0.5 * f64::EPSILON * exact.high) / found.error
}

/// By how much an error is beyond what may be off anyway.
pub fn beyond(off: f64, slack: f64) -> f64 {
    if off <= slack { 0.0 } else { off - slack }
}

/// From raw moments `m₂ − m₁²` and the fourth central moment, in a unit.
pub fn central([m1, m2, m3, m4]: [Wide; 4], unit: Wide) -> [Wide; 2] {
    let [one, two, three, four] =
        [m1, m2 / unit, m3 / (unit * unit), m4 / (unit * unit * unit)].map(|moment| moment / unit);
    let square = one * one;
    let fourth = four - 4.0 * three * one + 6.0 * two * square - 3.0 * square * square;
    [two - square, fourth]
}

/// A number in [0, 1], often next to an end.
pub fn share(dice: &mut Dice) -> f64 {
    match dice.below(5) {
        0 => dice.sized(-12.0, -1.0),
        1 => 1.0 - dice.sized(-15.0, -1.0),
        2 => [0.0, 0.5, 1.0][dice.below(3)],
        _ => dice.between(0.0, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::Measure;

    #[test]
    fn parts_are_joined_in_their_order() {
        let rows = in_parts(5, "q", 1, |part| {
            let error = if part.number == 3 { 2.0 } else { 1.0 };
            let said = part.number.to_string();
            part.run(1, [Row::new("q", "r", Measure::Absolute, 9.0)], |t| {
                t.place.clone_from(&said);
                t.see(0, error);
            });
        });
        assert_eq!((rows[0].trials, rows[0].place.as_str()), (5, "3"));
    }
}
