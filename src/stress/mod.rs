//! Numbers under stress: where doubles run out of digits, and by how much.
//!
//! Every quantity that a verdict rests on is computed where it is hardest, thousands of times, and
//! compared with arithmetic of 32 digits ([`Wide`](crate::numeric::Wide)), with exact integers, or with
//! another method at a higher resolution. A page of this folder stresses one kind of quantity and
//! answers rows; a row is the worst that was found, where, and the bound that it has to keep.
//!
//! ```text
//! relative          |found − exact|/|exact|
//! of stated error   |found − exact| in units of the error bound that the value carries
//! deviations        an error in units of the standard deviation
//! −log₁₀ p          of independent random numbers: 6 is one false alarm in a million
//! count             wrong verdicts, values that are no number: none is allowed
//! ```
//!
//! Everything that hands out a number with an error bound, and what it is measured against:
//!
//! | stated by | page | measured against | values |
//! |---|---|---|--:|
//! | optical depths of fields in 1-D, of stretches | [`depths`] | closed forms, 32 digits | 9,600 a field |
//! | optical depths in 3-D | [`depths`] | quadrature of lookups | 1,090 |
//! | ends of chords, their optical depth | [`geometry`] | 32 digits | 160,000; 8,000 |
//! | transmittance, moments of products | [`moments`] | 32 digits | 6,400; 31,000 |
//! | moments of next-flight and MIS | [`collided`] | power series, 32 digits | 2 × 1,270 |
//! | mean free flight, lookups, curves | [`costs`] | closed forms, 32 digits | 1,200; 2,400; 18,000 |
//! | rods: truths, moments, lookups | [`rods`], [`costs`] | closed forms, 32 digits | 94,000; 2,200; 2,300 |
//! | rods: orders, flux, absorption; moments | [`inside`] | power series, 32 digits | 4,000; 1,400 |
//! | slabs: R, T, collisions | [`slabs`] | twice the resolution; ordinates, 32 digits | 1,150; 1,540 |
//! | walks in slabs: moments | [`walks`] | ordinates, 32 digits; more directions; Peierls' equation; more directions where r varies | 1,980; 1,930; 1,540; 510 |
//! | walks in slabs: lookups | [`walks`] | ordinates, 32 digits; more directions | 500; 480 |
//! | light in balls | [`balls`] | ordinates, 32 digits; white light; a finer solution | 1,150; 1,540; 1,320 |
//! | point sources in balls: no verdict asks | [`balls`] | a finer solution | 1,020 |
//! | Case's formula, squared distances | [`mod@infinite`] | trapezoidal rule, 32 digits | 3,070; 3,840 |
//! | H-function | [`mod@infinite`] | trapezoidal rule, 32 digits | 1,540 |
//! | `∫σ_t dV` | [`contents`] | closed forms, 32 digits; rules exact in cells | 2,080; 1,020 |
//! | radiance of single scattering | [`scattering`] | 32 digits; panels of distance | 1,270; 1,010 |
//! | single scattering: moments of one point, of walks | [`scattered`] | power series, 32 digits | 600; 650 |
//! | single scattering: lookups | [`scattered`] | power series, 32 digits | 580 |
//! | single scattering: moments in fields | [`gathered`] | panels of distance | 290 |
//! | 1, in a furnace | – | nothing is computed | – |
//!
//! Not among them: optical depths where chords are cut by the eye, as in pictures.
//!
//! Random parameters come from addresses of their own, so that a run finds the same numbers on every
//! machine that rounds alike, whatever its threads.

pub mod accumulators;
pub mod balls;
mod bodies;
mod chains;
pub mod collided;
pub mod contents;
pub mod costs;
pub mod depths;
pub mod elementary;
pub mod extremes;
pub mod flights;
pub mod gathered;
pub mod generator;
pub mod geometry;
pub mod infinite;
pub mod inside;
pub mod moments;
pub mod narrow;
mod ordinates;
mod peierls;
pub mod rods;
pub mod scattered;
pub mod scattering;
pub mod slabs;
pub mod tails;
mod techniques;
mod text;
pub mod verdicts;
pub mod walks;

use rayon::prelude::*;

use crate::rng::{Address, Stream, name_hash};

/// How long is looked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Seconds: what the tests run.
    Quick,
    /// Minutes.
    Full,
}

impl Effort {
    /// A number of trials for either.
    #[must_use]
    pub fn of<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}

/// What an error is measured in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// `|found − exact|/|exact|`.
    Relative,
    /// `|found − exact|`.
    Absolute,
    /// `|found − exact|` in units of the stated bound.
    OfStated,
    /// In standard deviations of one draw.
    Deviations,
    /// `−log₁₀` of a p-value.
    Improbability,
    /// How many were wrong.
    Count,
}

impl Measure {
    /// The words in tables.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Relative => "relative",
            Self::Absolute => "absolute",
            Self::OfStated => "of stated error",
            Self::Deviations => "deviations",
            Self::Improbability => "−log₁₀ p",
            Self::Count => "count",
        }
    }
}

/// The worst of many trials of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What was computed.
    pub quantity: String,
    /// The range that was tried.
    pub range: String,
    /// How many trials.
    pub trials: u64,
    /// How many more were drawn and gave nothing to compare: refused, out of range, unknown.
    pub skipped: u64,
    /// The first of those.
    pub first_skipped: String,
    /// What the error is measured in.
    pub measure: Measure,
    /// The largest error; not a number once one was none.
    pub worst: f64,
    /// What it may be.
    pub bound: f64,
    /// Where the largest error was.
    pub place: String,
}

impl Row {
    /// Before the first trial.
    #[must_use]
    pub fn new(
        quantity: impl Into<String>,
        range: impl Into<String>,
        measure: Measure,
        bound: f64,
    ) -> Self {
        let (quantity, range) = (quantity.into(), range.into());
        let (place, first_skipped) = Default::default();
        let (trials, skipped, worst) = (0, 0, 0.0);
        Self { quantity, range, trials, skipped, first_skipped, measure, worst, bound, place }
    }

    /// Parameters that gave nothing to compare.
    pub fn skip(&mut self, place: impl FnOnce() -> String) {
        if self.skipped == 0 {
            self.first_skipped = place();
        }
        self.skipped += 1;
    }

    /// One trial.
    pub fn see(&mut self, error: f64, place: impl FnOnce() -> String) {
        self.trials += 1;
        if !self.worst.is_nan() && (error.is_nan() || error > self.worst || self.trials == 1) {
            (self.worst, self.place) = (error, place());
        }
    }

    /// One trial of which only right or wrong is known.
    pub fn count(&mut self, is_wrong: bool, place: impl FnOnce() -> String) {
        self.trials += 1;
        if is_wrong {
            if self.worst == 0.0 {
                self.place = place();
            }
            self.worst += 1.0;
        }
    }

    /// Adds the trials of a later part of the same quantity.
    #[must_use]
    pub fn and(mut self, later: Self) -> Self {
        self.trials += later.trials;
        if self.skipped == 0 {
            self.first_skipped = later.first_skipped;
        }
        self.skipped += later.skipped;
        if self.measure == Measure::Count {
            if self.worst == 0.0 {
                self.place = later.place;
            }
            self.worst += later.worst;
        } else if !self.worst.is_nan() && (later.worst.is_nan() || later.worst > self.worst) {
            (self.worst, self.place) = (later.worst, later.place);
        }
        self
    }

    /// Whether the bound holds. What was never tried does not, nor what was mostly skipped.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.trials > 0 && !self.is_mostly_skipped() && self.worst <= self.bound
    }

    /// Whether more was skipped than compared: such a row says nothing of its range.
    #[must_use]
    pub fn is_mostly_skipped(&self) -> bool {
        self.skipped > self.trials
    }
}

/// Random parameters.
pub struct Dice(Stream);

impl Dice {
    /// Those of a part of a quantity.
    #[must_use]
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

/// Runs the parts of a quantity on all threads and joins their rows in the order of the parts.
pub fn in_parts(parts: u64, part: impl Fn(u64) -> Vec<Row> + Sync + Send) -> Vec<Row> {
    let found: Vec<Vec<Row>> = (0..parts).into_par_iter().map(part).collect();
    let mut found = found.into_iter();
    let first = found.next().unwrap_or_default();
    found.fold(first, |rows, later| {
        rows.into_iter().zip(later).map(|(row, later)| row.and(later)).collect()
    })
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Stress {
    /// One row per quantity.
    pub rows: Vec<Row>,
    /// Where single precision fails.
    pub narrow: narrow::Narrow,
    /// Wall-clock seconds.
    pub seconds: f64,
}

impl Stress {
    /// Whether every bound holds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.rows.iter().all(Row::holds)
    }
}

/// Lists the pages: from one line each come the module and its turn.
macro_rules! pages {
    ($($module:ident,)*) => {
        /// Every page with the function that stresses its quantities.
        pub const PAGES: &[(&str, fn(Effort, u64) -> Vec<Row>)] =
            &[$((stringify!($module), $module::rows)),*];
    };
}

pages! {
    accumulators,
    elementary,
    tails,
    generator,
    depths,
    geometry,
    flights,
    moments,
    collided,
    rods,
    inside,
    slabs,
    walks,
    balls,
    infinite,
    contents,
    scattering,
    scattered,
    gathered,
    costs,
    extremes,
    verdicts,
}

/// Stresses everything; `done` is told the name of each page that is finished.
pub fn all(effort: Effort, seed: u64, done: &(dyn Fn(&str) + Sync)) -> Stress {
    let begin = std::time::Instant::now();
    // At once: the last parts of a page alone would leave threads idle.
    let (rows, narrow) = rayon::join(
        || {
            let pages = PAGES.par_iter().map(|(name, rows)| {
                let found = rows(effort, seed);
                done(name);
                found
            });
            pages.collect::<Vec<_>>()
        },
        || {
            let narrow = narrow::measure(effort, seed);
            done("narrow");
            narrow
        },
    );
    let mut rows: Vec<Row> = rows.into_iter().flatten().collect();
    rows.extend(narrow.rows());
    Stress { rows, narrow, seconds: begin.elapsed().as_secs_f64() }
}

/// By how much an error is beyond what the reference itself is off; what is no number stays none.
fn beyond(off: f64, slack: f64) -> f64 {
    if off <= slack { 0.0 } else { off - slack }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_keeps_the_worst_and_what_is_no_number() {
        let mut row = Row::new("q", "r", Measure::Relative, 1e-9);
        assert!(!row.holds(), "nothing was tried");
        row.see(1e-12, || "a".into());
        row.see(1e-10, || "b".into());
        row.see(1e-11, || "c".into());
        assert!(row.holds() && row.place == "b" && row.trials == 3);
        let mut later = Row::new("q", "r", Measure::Relative, 1e-9);
        later.see(f64::NAN, || "d".into());
        later.see(1.0, || "e".into());
        let both = row.and(later);
        assert!(both.worst.is_nan() && both.place == "d" && !both.holds());
    }

    #[test]
    fn one_wrong_verdict_is_too_many() {
        let mut row = Row::new("q", "r", Measure::Count, 0.0);
        row.count(false, || "a".into());
        assert!(row.holds());
        let mut later = row.clone();
        later.count(true, || "b".into());
        let both = row.and(later);
        assert!(!both.holds() && both.place == "b" && both.worst == 1.0);
    }

    #[test]
    fn what_is_mostly_skipped_does_not_hold() {
        let mut row = Row::new("q", "r", Measure::Relative, 1e-9);
        row.see(0.0, || "a".into());
        row.skip(|| "b".into());
        assert!(row.holds() && row.first_skipped == "b");
        let mut later = Row::new("q", "r", Measure::Relative, 1e-9);
        later.skip(|| "c".into());
        let both = row.and(later);
        assert!(!both.holds() && both.skipped == 2 && both.first_skipped == "b");
    }

    #[test]
    fn parts_are_joined_in_their_order() {
        let rows = in_parts(5, |part| {
            let mut row = Row::new("q", "r", Measure::Absolute, 9.0);
            row.see(if part == 3 { 2.0 } else { 1.0 }, || part.to_string());
            vec![row]
        });
        assert_eq!((rows[0].trials, rows[0].place.as_str()), (5, "3"));
    }
}
