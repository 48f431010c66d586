//! Numbers under stress: where doubles run out of digits, and by how much.
//!
//! Verdicts depend on computed quantities. The test computes each of them where it is hardest, up to many thousand
//! times. The oracle is arithmetic of 32 digits ([`DoubleDouble`](numeric::DoubleDouble)), exact integers, or another
//! method at a higher resolution. A page of this folder tests one kind of quantity. It consists of lines of the table
//! ([`table`]). A line has rows ([`row`]), a strategy for the parameters (`parameters`), a trial and an oracle.
//! Oracles share linear equations and their solution by nodes (`equations`, `nodes`) with each other, and nothing
//! with the code that they check.
//!
//! ```text
//! relative          |found − exact|/|exact|
//! of stated error   |found − exact| in units of the error bound that the value carries
//! deviations        an error in units of the standard deviation
//! count             number of wrong answers: none is allowed
//! ```
//!
//! | quantity with a stated error | page | oracle |
//! |---|---|---|
//! | optical depths of fields in 1-D, of stretches | [`depths`] | closed forms, 32 digits |
//! | optical depths in 3-D | [`depths`] | quadrature of lookups |
//! | ends of chords, their optical depth | [`geometry`] | 32 digits |
//! | transmittance, moments of products | [`moments`] | 32 digits |
//! | moments of next-flight and MIS | [`collided`] | nodes, 32 digits |
//! | mean free flight, lookups, curves | [`costs`] | closed forms, 32 digits |
//! | rods: truths, moments, lookups | [`rods`] | closed forms, 32 digits |
//! | rods: orders, flux, absorption; moments | [`inside`] | nodes, 32 digits |
//! | rods with an emitter, bidirectional paths: moments | [`lit_rods`] | nodes, 32 digits |
//! | slabs: R, T, collisions | [`slabs`] | twice the resolution; ordinates, 32 digits |
//! | walks in slabs: moments, lookups | [`walks`] | ordinates, 32 digits; more directions; Peierls' equation |
//! | slabs with a light behind them | [`lit_slabs`] | closed forms, 32 digits; other techniques |
//! | several channels: transmittance, rods, slabs | [`spectral`] | closed forms, ordinates, 32 digits |
//! | light in balls | [`balls`] | ordinates, 32 digits; white light; a finer solution |
//! | Case's formula, squared distances, H-function | [`mod@infinite`] | trapezoidal rule, 32 digits |
//! | `∫σ_t dV` | [`contents`] | quadrature of lookups |
//! | single scattering: radiance | [`scattering`] | nodes, 32 digits |
//! | single scattering: moments, lookups | [`scattered`] | nodes, 32 digits |
//!
//! Not tested: optical depths of chords that begin inside the volume, as at the eye of a picture. In a furnace the
//! answer is 1.
//!
//! Random parameters depend on the seed and the line only: a run finds the same numbers on every machine that rounds
//! alike, whatever its threads.

// Trials take their parameters, numbers too, by reference.
#![allow(clippy::trivially_copy_pass_by_ref)]

pub mod accumulators;
pub mod balls;
pub mod collided;
pub mod contents;
pub mod costs;
pub mod depths;
pub mod elementary;
mod equations;
mod fields;
pub mod flights;
pub mod generator;
pub mod geometry;
pub mod infinite;
pub mod inside;
pub mod lit_rods;
pub mod lit_slabs;
pub mod moments;
pub mod narrow;
mod nodes;
mod ordinates;
pub mod parameters;
mod peierls;
mod rays;
pub mod rods;
pub mod row;
pub mod scattered;
pub mod scattering;
pub mod shared_walk;
pub mod slabs;
pub mod spectral;
pub mod table;
pub mod tails;
mod techniques;
pub mod walks;

/// Imports of most pages.
mod prelude {
    pub(super) use super::parameters::{
        NumberStrategy, any_of, between, parameters, share, sign, sized,
    };
    pub(super) use super::row::{Measure, TrialRow};
    pub(super) use super::table::{Run, Seen, central, off, over};
    pub(super) use media::{Control, Medium, Piecewise};
    pub(super) use numeric::quadrature::GaussLegendre;
    pub(super) use numeric::{DoubleDouble, Known, Span};
    pub(super) use proptest::collection::vec;
    pub(super) use proptest::prop_oneof;
    pub(super) use proptest::strategy::{Just, Strategy};
    pub(super) use theory::Mesh;
}

pub use self::row::{Measure, TrialRow};
pub use self::table::{Effort, Run};
use media::catalogue::Registry;
use media::registry;
use theory::parallel;

/// Result of the stress test.
#[derive(Debug, Clone)]
pub struct Stress {
    /// One row per quantity.
    pub rows: Vec<TrialRow>,
    /// Comparison of single precision with doubles.
    pub narrow: narrow::Narrow,
    /// Wall-clock seconds.
    pub seconds: f64,
}

impl Stress {
    /// Returns whether every bound holds.
    pub fn holds(&self) -> bool {
        self.rows.iter().all(TrialRow::holds)
    }
}

/// Every page with the function that fills its rows, in the order of the rows.
pub static PAGES: Registry<fn(Run) -> Vec<TrialRow>> = registry![
    accumulators::rows,
    elementary::rows,
    tails::rows,
    generator::rows,
    depths::rows,
    geometry::rows,
    flights::rows,
    moments::rows,
    collided::rows,
    rods::rows,
    inside::rows,
    slabs::rows,
    walks::rows,
    balls::rows,
    infinite::rows,
    contents::rows,
    scattering::rows,
    scattered::rows,
    costs::rows,
    lit_rods::rows,
    lit_slabs::rows,
    spectral::rows,
];

/// Runs the stress test; `done` receives the name of each page that is finished.
pub fn all(run: Run, done: &(dyn Fn(&str) + Sync)) -> Stress {
    let begin = std::time::Instant::now();
    // At once: the last trials of a page alone would leave threads idle.
    let (rows, narrow) = rayon::join(
        || {
            let pages: Vec<_> = PAGES.entries().collect();
            parallel::map(&pages, |(page, rows)| {
                let computed = rows(run);
                done(page.module);
                computed
            })
        },
        || {
            let narrow = narrow::measure(run);
            done("narrow");
            narrow
        },
    );
    let mut rows: Vec<TrialRow> = rows.into_iter().flatten().collect();
    rows.extend(narrow.rows());
    Stress { rows, narrow, seconds: begin.elapsed().as_secs_f64() }
}
