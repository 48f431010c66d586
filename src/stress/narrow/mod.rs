//! Single precision against double: where does a renderer's rounding outgrow its noise?
//!
//! The same walk is made twice from the same random words, in doubles of 53 and in
//! [`Narrow`](crate::numeric::Narrow) numbers of 24 bits, through a medium of three waves. The difference of
//! the two means is the bias that single precision adds; with common random numbers a few thousand walks
//! find it. Decisions are averaged in each precision, exactly as it decides: those that end a walk along a
//! ray in `compare`; of walks that scatter, those at boundaries. Which way the latter go at a collision is
//! decided once for both and weighted by its likelihood (`trail`). So walks that end find the bias as well.
//!
//! ```text
//! σ_t(t) = (τ/ℓ)(1 + 0.8 sin(6π(t − t₀)/ℓ)),  t = t₀ … t₀ + ℓ;  a ball of diameter ℓ in `space`
//! bias   |mean of X₂₄ − X₅₃|/E[X]     noise  √(V/n)/E[X] of n = 1e8 draws
//! u₂₄    the upper 24 bits of the word: 1 − k/2²⁴, as renderers make it
//! ```
//!
//! V and the mean are what theory says of a case of the same words. Where it knows no V (roulette, walks in
//! space) that of the doubles' own draws takes its place, and where it has no answer their mean.
//!
//! The lattice of u₂₄ alone shortens flights by `ln(2πN)/(2N) = 5.5e-7`, N = 2²⁴: estimators of small
//! variance notice it first.

mod compare;
mod flights;
mod place;
mod precision;
mod products;
mod rods;
mod scene;
mod single_scattering;
mod slabs;
mod space;
mod trail;

use std::sync::Arc;

use rayon::prelude::*;

use self::compare::{Compared, Stated};
use self::scene::Scene;
use super::{Effort, Measure, Row, text};
use crate::rng::Address;

/// The draws whose statistical error the bias is compared with.
pub const DRAWS: f64 = 1e8;

/// What is varied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// Collisions on the ray: ∫σ̂ at τ = 2.
    Steps,
    /// The optical depth at σ̂ = 20 max σ_t.
    Depth,
    /// The distance of the ray from the origin, in its own lengths, at 40 collisions and τ = 2.
    Origin,
}

impl Along {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Steps, Self::Depth, Self::Origin];

    /// The word in tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Depth => "depth",
            Self::Origin => "origin",
        }
    }

    /// The title of an axis.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Steps => "collisions on the ray, ∫σ\u{302}",
            Self::Depth => "optical depth τ",
            Self::Origin => "distance from the origin, in lengths of the ray",
        }
    }

    /// The scenes along it.
    fn scene(self, x: f64) -> Scene {
        match self {
            Self::Steps => Scene { depth: 2.0, collisions: x, from: 0.0 },
            Self::Depth => Scene { depth: x, collisions: 20.0 * 1.8 * x, from: 0.0 },
            Self::Origin => Scene { depth: 2.0, collisions: 40.0, from: x },
        }
    }
}

/// The values of each quantity.
type Values = [&'static [f64]; 3];

/// Those of estimators whose walks are short.
const FINE: Values = [
    &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6],
    &[0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0],
    &[1.0, 10.0, 1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6],
];
/// Those of rays that light is scattered to.
const RAYS: Values = [
    &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5],
    COARSE[1],
    &[1.0, 10.0, 1e2, 3e2, 1e3, 3e3, 1e4, 1e5, 1e6],
];
/// Those of walks that scatter.
const COARSE: Values = [
    &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4],
    &[0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0],
    &[1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6],
];
/// The same in balls, whose light theory knows up to here.
const BALLS: Values = [COARSE[0], &[0.1, 0.3, 1.0, 3.0, 10.0, 30.0], COARSE[2]];
/// Those of the short form.
const QUICK: Values = [&[10.0, 1e3], &[1.0, 100.0], &[10.0, 1e5]];
/// The same in balls.
const QUICK_BALLS: Values = [&[10.0, 1e3], &[1.0, 10.0], &[10.0, 1e5]];

/// Where, from which seed and for how many collisions both precisions are compared.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    scene: Scene,
    seed: u64,
    budget: f64,
}

/// An estimator in the list of its family.
#[derive(Clone, Copy)]
pub struct Entry {
    name: &'static str,
    compare: fn(Trial) -> Compared,
    along: &'static [Along],
}

/// Without σ̂ there are no collisions.
const NO_STEPS: &[Along] = &[Along::Depth, Along::Origin];
/// Without an end there is no depth.
const NO_DEPTH: &[Along] = &[Along::Steps, Along::Origin];

/// A line of a family's list.
macro_rules! entry {
    ($name:expr, $compare:expr) => {
        entry!($name, $compare, &$crate::stress::narrow::Along::ALL)
    };
    ($name:expr, $compare:expr, $along:expr) => {
        Entry { name: $name, compare: $compare, along: $along }
    };
}
use entry;

/// Estimators that are drawn in one row of panels.
struct Family {
    title: &'static str,
    entries: &'static [Entry],
    full: Values,
    quick: Values,
    /// How many collisions a point may cost.
    budget: [f64; 2],
}

const SHORT: [f64; 2] = [3e4, 3e5];
const LONG: [f64; 2] = [2e4, 3e5];

const FAMILIES: &[Family] = &[
    Family {
        title: "Transmittance by weights and chances",
        entries: products::ALL,
        full: FINE,
        quick: QUICK,
        budget: SHORT,
    },
    Family {
        title: "Transmittance otherwise, free flight",
        entries: flights::ALL,
        full: FINE,
        quick: QUICK,
        budget: SHORT,
    },
    Family { title: "Rod", entries: rods::ALL, full: COARSE, quick: QUICK, budget: LONG },
    Family { title: "Slab", entries: slabs::ALL, full: COARSE, quick: QUICK, budget: LONG },
    Family {
        title: "Single scattering",
        entries: single_scattering::ALL,
        full: RAYS,
        quick: QUICK,
        budget: SHORT,
    },
    Family { title: "Space", entries: space::ALL, full: BALLS, quick: QUICK_BALLS, budget: LONG },
];

/// Pilot draws are found here, where theory has no variance.
const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };

/// What theory says of a channel of a case with one estimator, the only one where it has no name.
fn stated(text: &str, channel: &str) -> Stated {
    let prepared = text::case(text).map(|case| Arc::new(case).scenario.prepare(0, None, NOWHERE));
    let Some(Ok(ready)) = prepared.map(|prepared| prepared.outcome) else {
        return Stated::default();
    };
    let found = ready.prediction.channels.iter().find(|found| found.name == channel);
    let Some(found) = found else { return Stated::default() };
    let truth = found.truth.value;
    let variance = found.moments.map(|moments| moments.variance() / (truth * truth));
    Stated { truth: Some(truth), variance: variance.filter(|variance| variance.is_finite()) }
}

/// Both precisions at one point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The value of what is varied.
    pub x: f64,
    /// How many walks.
    pub walks: f64,
    /// The relative bias of single precision.
    pub bias: f64,
    /// Its standard error.
    pub error: f64,
    /// The relative standard error of 1e8 draws.
    pub noise: f64,
    /// The doubles' own mean against the truth, in standard errors; not for a biased estimator.
    pub z: Option<f64>,
}

impl Point {
    fn of(x: f64, found: Compared) -> Self {
        let Compared { walks, bias, error, noise, z } = found;
        Self { x, walks, bias, error, noise, z }
    }

    /// Whether the bias is certainly larger than the noise.
    #[must_use]
    pub fn exceeds(&self) -> bool {
        self.bias.abs() - 3.0 * self.error > self.noise
    }

    /// Whether the bias is certainly smaller than the noise; with neither, the walks were too few.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.error > 0.0 && self.bias.abs() + 3.0 * self.error <= self.noise
    }
}

/// One estimator along one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// What it is drawn together with.
    pub family: &'static str,
    /// The estimator.
    pub estimator: &'static str,
    /// What is varied.
    pub along: Along,
    /// The points, ascending; none where there is nothing to vary.
    pub points: Vec<Point>,
}

impl Curve {
    /// The first value at which the bias exceeds the noise, there and up to the end of the curve or
    /// not; `None` where it nowhere does.
    #[must_use]
    pub fn fails_from(&self) -> Option<f64> {
        self.points.iter().find(|point| point.exceeds()).map(|point| point.x)
    }

    /// The last value up to which the bias is certainly below the noise.
    #[must_use]
    pub fn holds_to(&self) -> Option<f64> {
        self.points.iter().take_while(|point| point.holds()).last().map(|point| point.x)
    }
}

/// Where single precision fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Narrow {
    /// Every estimator along every quantity: family by family, quantity by quantity.
    pub curves: Vec<Curve>,
}

impl Narrow {
    /// The comparison is sound where the doubles find the truth.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        let estimators: usize = FAMILIES.iter().map(|family| family.entries.len()).sum();
        let range = format!("{estimators} estimators, all points of the plot");
        let name = "mean of doubles beside f32";
        let mut row = Row::new(name, range, Measure::Deviations, 6.0);
        for curve in &self.curves {
            for point in &curve.points {
                let place =
                    || format!("{}, {} = {:e}", curve.estimator, curve.along.word(), point.x);
                if let Some(z) = point.z {
                    row.see(z.abs(), place);
                }
            }
        }
        vec![row]
    }
}

/// Measures all curves.
#[must_use]
pub fn measure(effort: Effort, seed: u64) -> Narrow {
    let mut curves = Vec::new();
    let mut jobs = Vec::new();
    for family in FAMILIES {
        let values = effort.of(family.quick, family.full);
        let budget = effort.of(family.budget[0], family.budget[1]);
        for (along, values) in Along::ALL.into_iter().zip(values) {
            for entry in family.entries {
                let values = if entry.along.contains(&along) { values } else { &[] };
                let points = Vec::with_capacity(values.len());
                let (family, estimator) = (family.title, entry.name);
                curves.push((Curve { family, estimator, along, points }, values.len()));
                jobs.extend(values.iter().map(|&x| (along, entry, x, budget)));
            }
        }
    }
    let points: Vec<Point> = jobs
        .par_iter()
        .map(|&(along, entry, x, budget)| {
            let scene = along.scene(x);
            Point::of(x, (entry.compare)(Trial { scene, seed, budget }))
        })
        .collect();
    let mut points = points.into_iter();
    let filled = curves.into_iter().map(|(mut curve, count)| {
        curve.points.extend(points.by_ref().take(count));
        curve
    });
    Narrow { curves: filled.collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bias_counts_only_where_it_is_certain() {
        let point = Point { x: 1.0, walks: 9.0, bias: -1e-4, error: 1e-5, noise: 5e-5, z: None };
        assert!(point.exceeds());
        assert!(!Point { error: 3e-5, ..point }.exceeds());
        let (family, estimator) = ("Rod", "rod, analog");
        let curve = Curve { family, estimator, along: Along::Steps, points: vec![point] };
        assert_eq!(curve.fails_from(), Some(1.0));
    }

    #[test]
    fn doubles_find_the_mean_of_every_unbiased_estimator() {
        for depth in [0.3, 4.0] {
            let scene = Scene { depth, collisions: 9.0 * depth, from: 2.0 };
            // Enough walks for the spread that roulette makes, 15 times the squared mean.
            let trial = Trial { scene, seed: 7, budget: 16_000.0 * scene.collisions };
            for entry in FAMILIES.iter().flat_map(|family| family.entries) {
                let found = (entry.compare)(trial);
                let Some(z) = found.z else {
                    assert!(["regular", "ray-marching"].contains(&entry.name), "{}", entry.name);
                    continue;
                };
                assert!(z.abs() < 5.0, "{} at τ = {depth}: {z}", entry.name);
                assert!(found.bias.abs() < 1e-4 + 5.0 * found.error, "{}: {found:?}", entry.name);
            }
        }
    }

    #[test]
    fn what_is_far_from_the_origin_fails_in_single_precision_and_what_is_near_does_not() {
        let at = |from: f64, entry: &Entry| {
            let scene = Scene { depth: 2.0, collisions: 20.0, from };
            Point::of(from, (entry.compare)(Trial { scene, seed: 3, budget: 2e5 }))
        };
        let failing = ["ratio", "next-flight", "source-driven", "attenuation-driven"];
        for entry in FAMILIES.iter().flat_map(|family| family.entries) {
            let near = at(0.0, entry);
            assert!(near.holds() || entry.along != Along::ALL, "{}: {near:?}", entry.name);
            if failing.contains(&entry.name) {
                let far = at(1e6, entry);
                assert!(far.exceeds(), "{}: {far:?}", entry.name);
            }
        }
    }
}
