//! The table of the stress test: each line fills rows from trials with random parameters.
//!
//! A line names its rows, a strategy for the parameters, and a trial. The trial compares a value of the
//! library with an oracle and reports errors, each in the measure of its row. The place of an error is the `Debug`
//! form of the parameters. Where a bound is broken, the parameters are shrunk to shorter numbers that break it, too.
//!
//! Parameters depend on the seed, the first row of the line and the number of the trial only.

use std::fmt::{Debug, Display};

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::row::TrialRow;
use numeric::rng::name_hash;
use numeric::{DoubleDouble, Known};
use theory::Moments;
use theory::parallel;

/// Duration of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Seconds, for tests.
    Quick,
    /// Minutes.
    Full,
}

impl Effort {
    /// Returns the value for this effort.
    pub fn of<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// Effort and seed of a run.
#[derive(Debug, Clone, Copy)]
pub struct Run {
    /// Duration.
    pub effort: Effort,
    /// Seed of the random parameters.
    pub seed: u64,
}

/// Tasks that the trials of a line are divided into.
const TASKS: usize = 64;
/// Trials that shrinking takes at most.
const MAX_SHRINKS: u32 = 400;

impl Run {
    /// Fills rows with a number of trials, quick and full. A trial that returns `None` is skipped in all rows.
    pub fn fill<S: Strategy, O: Into<Option<()>>>(
        self,
        trials: [u32; 2],
        rows: impl Into<Vec<TrialRow>>,
        parameters: impl Fn() -> S + Sync,
        trial: impl Fn(&S::Value, &mut Seen) -> O + Sync,
    ) -> Vec<TrialRow> {
        let empty: Vec<TrialRow> = rows.into();
        let name = name_hash(&format!("stress|{}|{}", empty[0].quantity, empty[0].range));
        let tree = |number: u32| {
            let words = [self.seed, name, number.into(), 0].map(u64::to_le_bytes);
            let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &words.concat());
            parameters().new_tree(&mut TestRunner::new_with_rng(Config::default(), rng)).ok()
        };
        let try_out = |number: u32, parameters: &S::Value, rows: &mut [TrialRow]| {
            let mut seen = Seen { trial: number, label: String::new(), parameters, rows };
            if trial(parameters, &mut seen).into().is_none() {
                (0..seen.rows.len()).for_each(|row| seen.skip(row));
            }
        };
        let count = self.effort.of(trials[0], trials[1]);
        let task = |first: usize| {
            let mut rows = empty.clone();
            for number in (0..count).skip(first).step_by(TASKS) {
                if let Some(tree) = tree(number) {
                    try_out(number, &tree.current(), &mut rows);
                }
            }
            rows
        };
        let mut computed = empty.clone();
        for later in parallel::range(TASKS, task) {
            computed.iter_mut().zip(later).for_each(|(row, later)| row.merge(later));
        }
        for (index, row) in computed.iter_mut().enumerate().filter(|(_, row)| !row.is_within()) {
            let is_broken = |parameters: &S::Value| {
                let mut rows = empty.clone();
                try_out(row.trial, parameters, &mut rows);
                !rows[index].is_within()
            };
            if let Some(shortest) = tree(row.trial).map(|tree| shrunk(tree, is_broken)) {
                row.place = format!("{}; shortened: {shortest:?}", row.place);
            }
        }
        computed
    }
}

/// Returns the shortest parameters found that break a bound, too.
fn shrunk<T: ValueTree>(mut tree: T, is_broken: impl Fn(&T::Value) -> bool) -> T::Value {
    let mut shortest = tree.current();
    let mut is_open = tree.simplify();
    for _ in 0..MAX_SHRINKS {
        if !is_open {
            break;
        }
        let parameters = tree.current();
        is_open = if is_broken(&parameters) {
            shortest = parameters;
            tree.simplify()
        } else {
            tree.complicate()
        };
    }
    shortest
}

/// Rows that a trial adds its errors to.
pub struct Seen<'a> {
    trial: u32,
    /// Name of the value, if a trial has several.
    label: String,
    parameters: &'a dyn Debug,
    rows: &'a mut [TrialRow],
}

impl Seen<'_> {
    /// Says which of several values of a trial comes next.
    pub fn at(&mut self, label: impl Display) {
        self.label = format!("{label}, ");
    }

    /// Adds an error, in the measure of the row.
    pub fn see(&mut self, row: usize, error: f64) {
        let Self { trial, label, parameters, rows } = self;
        rows[row].see(error, *trial, || format!("{label}{parameters:?}"));
    }

    /// Adds an answer that is right or wrong.
    pub fn wrong(&mut self, row: usize, is_wrong: bool) {
        self.see(row, f64::from(u8::from(is_wrong)));
    }

    /// Returns an answer of the library; a missing one breaks the bound of a row.
    pub fn computed<T>(&mut self, row: usize, answer: Option<T>) -> Option<T> {
        if answer.is_none() {
            self.see(row, f64::NAN);
        }
        answer
    }

    /// Adds a trial without anything to compare.
    pub fn skip(&mut self, row: usize) {
        let Self { label, parameters, rows, .. } = self;
        rows[row].skip(|| format!("{label}{parameters:?}"));
    }

    /// Adds a value with its stated error; a value that rounds to the truth has none.
    pub fn stated(&mut self, row: usize, computed: Known, exact: DoubleDouble) {
        self.see(row, of_stated(computed, exact));
    }

    /// Adds a value with its stated error, beyond half a unit in the last place of the truth.
    pub fn beyond_rounding(&mut self, row: usize, computed: Known, exact: DoubleDouble) {
        let slack = 0.5 * f64::EPSILON * exact.high.abs();
        self.see(row, over((off(computed.value, exact) - slack).max(0.0), computed.error));
    }

    /// Adds a value beside an exact one, relative.
    pub fn relative(&mut self, row: usize, computed: f64, exact: DoubleDouble) {
        self.see(row, exact.relative_error(computed));
    }

    /// Adds variance and fourth moment to two rows, given raw moments up to the first infinite one; skipped where
    /// theory has none.
    pub fn moments(&mut self, rows: [usize; 2], computed: Option<Moments>, raw: &[DoubleDouble]) {
        self.compare(rows, computed, raw, |seen, row| seen.see(row, f64::INFINITY));
    }

    /// Adds variance and fourth moment likewise where theory resolves them: one of both infinite is skipped.
    pub fn resolved(&mut self, rows: [usize; 2], computed: Option<Moments>, raw: &[DoubleDouble]) {
        self.compare(rows, computed, raw, Self::skip);
    }

    fn compare(
        &mut self,
        rows: [usize; 2],
        computed: Option<Moments>,
        raw: &[DoubleDouble],
        differ: impl Fn(&mut Self, usize),
    ) {
        let Some(Moments { scale, relative, error, .. }) = computed else {
            return rows.into_iter().for_each(|row| self.skip(row));
        };
        let raw =
            std::array::from_fn(|k| raw.get(k).copied().unwrap_or(DoubleDouble::from(f64::NAN)));
        let exact = central(raw, DoubleDouble::from(scale));
        for ((row, computed), exact) in rows.into_iter().zip([relative[0], relative[2]]).zip(exact)
        {
            match (computed == f64::INFINITY, exact.high.is_finite()) {
                (false, true) => {
                    self.stated(row, Known::new(computed, computed.abs() * error), exact);
                }
                (true, false) => self.see(row, 0.0),
                _ => differ(self, row),
            }
        }
    }

    /// Adds a central moment with a relative error; skipped where theory does not resolve it.
    pub fn central(&mut self, row: usize, computed: f64, error: f64, exact: DoubleDouble) {
        if computed.is_finite() {
            self.stated(row, Known::new(computed, computed.abs() * error), exact);
        } else {
            self.skip(row);
        }
    }
}

/// Returns the absolute error of a value.
pub fn off(computed: f64, exact: DoubleDouble) -> f64 {
    (computed - exact).abs().value()
}

/// Returns an error in units of what is allowed; an exact value is allowed none.
pub fn over(off: f64, allowed: f64) -> f64 {
    if off == 0.0 { 0.0 } else { off / allowed }
}

/// Returns the error of a value in units of its stated error; a value that rounds to the truth has none.
pub fn of_stated(computed: Known, exact: DoubleDouble) -> f64 {
    let off = off(computed.value, exact);
    if off <= 0.5 * f64::EPSILON * exact.high.abs() { 0.0 } else { off / computed.error }
}

/// Returns variance and fourth central moment of raw moments, in a unit.
pub fn central([m1, m2, m3, m4]: [DoubleDouble; 4], unit: DoubleDouble) -> [DoubleDouble; 2] {
    let [one, two, three, four] =
        [m1, m2 / unit, m3 / (unit * unit), m4 / (unit * unit * unit)].map(|moment| moment / unit);
    let square = one * one;
    let fourth = four - 4.0 * three * one + 6.0 * two * square - 3.0 * square * square;
    [two - square, fourth]
}
