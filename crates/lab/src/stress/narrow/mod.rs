//! Single precision against double: where does a renderer's rounding outgrow its noise?
//!
//! The same walk is made twice from the same random words, in doubles of 53 and in
//! [`Narrow`](numeric::Narrow) numbers of 24 bits, through a medium of three waves. The difference of
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

pub mod compare;
pub mod dice;
pub mod layers;
mod place;
pub mod precision;
pub mod scene;
mod single_scattering;
mod space;
pub mod trail;
pub mod transmittance;

use self::compare::{Compare, Spread, Theory};
use self::scene::Scene;
use super::{Measure, Row, Run};
use theory::parallel;

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
    pub fn word(self) -> &'static str {
        match self {
            Self::Steps => "steps",
            Self::Depth => "depth",
            Self::Origin => "origin",
        }
    }

    /// The title of an axis.
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
            Self::Steps => Scene::new(2.0, x, 0.0),
            Self::Depth => Scene::new(x, 20.0 * 1.8 * x, 0.0),
            Self::Origin => Scene::new(2.0, 40.0, x),
        }
    }
}

/// The values of each quantity.
pub type Values = [&'static [f64]; 3];

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
    /// Where.
    pub scene: Scene,
    /// The seed of its walks.
    pub seed: u64,
    /// How many collisions it may cost.
    pub budget: f64,
}

/// An estimator in the list of its family, and what is varied.
pub type Entry = (&'static str, &'static dyn Compare, &'static [Along]);

/// All that can be varied.
const EVERY: &[Along] = &Along::ALL;
/// Without σ̂ there are no collisions.
const NO_STEPS: &[Along] = &[Along::Depth, Along::Origin];
/// Without an end there is no depth.
const NO_DEPTH: &[Along] = &[Along::Steps, Along::Origin];

/// Estimators of one kind of problem.
pub struct Family {
    title: &'static str,
    /// Its estimators.
    pub entries: &'static [Entry],
    /// In the short form and the full one.
    values: [Values; 2],
    /// How many collisions a point may cost, likewise.
    budget: [f64; 2],
}

const fn family(
    title: &'static str,
    entries: &'static [Entry],
    values: [Values; 2],
    budget: [f64; 2],
) -> Family {
    Family { title, entries, values, budget }
}

const SHORT: [f64; 2] = [3e4, 3e5];
const LONG: [f64; 2] = [2e4, 3e5];

/// All families.
pub const FAMILIES: &[Family] = &[
    family("Transmittance by weights and chances", transmittance::PRODUCTS, [QUICK, FINE], SHORT),
    family("Transmittance otherwise, free flight", transmittance::OTHERS, [QUICK, FINE], SHORT),
    family("Rod", layers::RODS, [QUICK, COARSE], LONG),
    family("Slab", layers::SLABS, [QUICK, COARSE], LONG),
    family("Single scattering", single_scattering::ALL, [QUICK, RAYS], SHORT),
    family("Space", space::ALL, [QUICK_BALLS, BALLS], LONG),
];

/// Truth and relative variance that theory states of a channel of a case with one estimator, the only channel where
/// it has no name. Cases are read by the program only.
pub type Stated = fn(text: &str, channel: &str) -> Option<(f64, Option<f64>)>;

/// What theory says of a channel of a case.
fn stated(scene: &Scene, text: &str, channel: &str) -> Theory {
    let nothing = Theory { truth: None, variance: None, spread: Spread::Seen };
    (scene.stated)(text, channel).map_or(nothing, |(truth, variance)| Theory {
        truth: Some(truth),
        variance,
        ..nothing
    })
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
    /// Whether the bias is certainly larger than the noise.
    pub fn exceeds(&self) -> bool {
        self.bias.abs() - 3.0 * self.error > self.noise
    }

    /// Whether the bias is certainly smaller than the noise; with neither, the walks were too few.
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
    pub fn fails_from(&self) -> Option<f64> {
        self.points.iter().find(|point| point.exceeds()).map(|point| point.x)
    }

    /// The last value up to which the bias is certainly below the noise.
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
    pub fn rows(&self) -> Vec<Row> {
        let estimators: usize = FAMILIES.iter().map(|family| family.entries.len()).sum();
        let range = format!("{estimators} estimators, all points of the plot");
        let name = "mean of doubles beside f32";
        let row = Row::new(name, range, Measure::Deviations, 6.0);
        let mut tally = row.tally();
        for curve in &self.curves {
            for point in &curve.points {
                let place =
                    || format!("{}, {} = {:e}", curve.estimator, curve.along.word(), point.x);
                if let Some(z) = point.z {
                    tally.see(z.abs(), place);
                }
            }
        }
        vec![row.with(&tally, String::clone)]
    }
}

/// Measures all curves.
pub fn measure(Run { effort, seed }: Run, stated: Stated) -> Narrow {
    let of = |values: &[&'static [f64]; 2]| effort.of(values[0], values[1]);
    let mut curves = Vec::new();
    for &Family { title, entries, values: [quick, full], budget: [least, most] } in FAMILIES {
        for (i, along) in Along::ALL.into_iter().enumerate() {
            for &(estimator, compare, varied) in entries {
                let values = if varied.contains(&along) { of(&[quick[i], full[i]]) } else { &[] };
                let curve = Curve { family: title, estimator, along, points: Vec::new() };
                curves.push((curve, values, compare, effort.of(least, most)));
            }
        }
    }
    let points = parallel::map(&curves, |(curve, values, compare, budget)| {
        parallel::map(values, |&x| {
            let budget = *budget;
            let found = compare.compare(Trial {
                scene: Scene { stated, ..curve.along.scene(x) },
                seed,
                budget,
            });
            Point { x, ..found }
        })
    });
    let measured = curves.into_iter().zip(points);
    Narrow { curves: measured.map(|((curve, ..), points)| Curve { points, ..curve }).collect() }
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
}
