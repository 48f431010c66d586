//! Numbers under stress: where doubles run out of digits, and by how much.
//!
//! Every quantity that a verdict rests on is computed where it is hardest, thousands of times, and
//! compared with arithmetic of 32 digits ([`Wide`](numeric::Wide)), with exact integers, or with
//! another method at a higher resolution. A page of this folder stresses one kind of quantity and
//! answers rows; a row is the worst that was found, where, and the bound that it has to keep ([`row`]).
//! Most pages are tables: rows, how many trials fill them, and a trial, which draws parameters and compares
//! what the crate finds with a reference ([`trial`]). References share power series and linear equations
//! (`series`) with each other, and nothing with what they check.
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
pub mod row;
pub mod scattered;
pub mod scattering;
mod series;
mod shared_walk;
pub mod slabs;
pub mod tails;
mod techniques;
mod text;
pub mod trial;
pub mod verdicts;
pub mod walks;

pub use self::row::{Measure, Row};
pub use self::trial::Dice;
use self::trial::{in_parts, joined};
use theory::parallel;

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
    pub fn of<T>(self, quick: T, full: T) -> T {
        match self {
            Self::Quick => quick,
            Self::Full => full,
        }
    }
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
            parallel::map(PAGES, |(name, rows)| {
                let found = rows(effort, seed);
                done(name);
                found
            })
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
