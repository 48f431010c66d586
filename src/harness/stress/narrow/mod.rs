//! Single precision against double: where does a renderer's rounding outgrow its noise?
//!
//! The same walk is made twice from the same random words, in doubles of 53 and in
//! [`Narrow`](crate::numeric::Narrow) numbers of 24 bits, through a medium of three waves. The difference of
//! the two means is the bias that single precision adds; with common random numbers a few thousand walks
//! find it, and decisions are averaged in each precision (`walks`), so that walks that end find it as well.
//!
//! ```text
//! σ_t(t) = (τ/ℓ)(1 + 0.8 sin(6π(t − t₀)/ℓ)),  t = t₀ … t₀ + ℓ
//! bias   |mean of X₂₄ − X₅₃|/T        noise  √(V/n)/T of n = 1e8 draws, V in theory
//! u₂₄    the upper 24 bits of the word: 1 − k/2²⁴, as renderers make it
//! ```
//!
//! The lattice of u₂₄ alone shortens flights by `ln(2πN)/(2N) = 5.5e-7`, N = 2²⁴: estimators of small
//! variance notice it first.

mod precision;
mod scene;
mod walks;

use rayon::prelude::*;

use self::scene::Scene;
use self::walks::ESTIMATORS;
use super::{Effort, Measure, Row};

/// The draws whose statistical error the bias is compared with.
pub const DRAWS: f64 = 1e8;
/// Walks at most.
const MOST: f64 = 1e5;
/// Walks at least.
const LEAST: f64 = 8.0;

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

    fn values(self, effort: Effort) -> &'static [f64] {
        match (self, effort) {
            (Self::Steps, Effort::Full) => {
                &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6]
            }
            (Self::Steps, Effort::Quick) => &[10.0, 1e3],
            (Self::Depth, Effort::Full) => {
                &[0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0]
            }
            (Self::Depth, Effort::Quick) => &[1.0, 100.0],
            (Self::Origin, Effort::Full) => {
                &[1.0, 10.0, 1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6]
            }
            (Self::Origin, Effort::Quick) => &[10.0, 1e5],
        }
    }
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
    /// The estimator.
    pub estimator: &'static str,
    /// What is varied.
    pub along: Along,
    /// The points, ascending.
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
    /// Every estimator along every quantity.
    pub curves: Vec<Curve>,
}

impl Narrow {
    /// The comparison is sound where the doubles find T.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        let range = format!("{} estimators, all points of the plot", ESTIMATORS.len());
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
    let steps = effort.of(3e4, 5e5);
    let mut jobs = Vec::new();
    for along in Along::ALL {
        for estimator in ESTIMATORS {
            jobs.extend(along.values(effort).iter().map(|&x| (along, estimator, x)));
        }
    }
    let points: Vec<Point> = jobs
        .par_iter()
        .map(|&(along, (_, compare), x)| {
            let scene = along.scene(x);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
            let walks = (steps / scene.collisions).clamp(LEAST, MOST) as u64;
            let (known, sums) = compare(scene, seed, walks);
            let bias = sums.difference[0] / sums.walks;
            let spread = (sums.difference[1] / sums.walks - bias * bias).max(0.0);
            let mean = sums.double / sums.walks;
            Point {
                x,
                walks: sums.walks,
                bias,
                error: (spread / (sums.walks - 1.0)).sqrt(),
                // Without a variance nothing exceeds it, and nothing holds.
                noise: known.map_or(f64::NAN, |known| (known.variance / DRAWS).sqrt()),
                z: known
                    .and_then(|known| known.drawn)
                    .map(|variance| (mean - 1.0) / (variance / sums.walks).sqrt()),
            }
        })
        .collect();
    let mut points = points.into_iter();
    let mut curves = Vec::new();
    for along in Along::ALL {
        for (estimator, _) in ESTIMATORS {
            let points = points.by_ref().take(along.values(effort).len()).collect();
            curves.push(Curve { estimator, along, points });
        }
    }
    Narrow { curves }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bias_counts_only_where_it_is_certain() {
        let point = Point { x: 1.0, walks: 9.0, bias: -1e-4, error: 1e-5, noise: 5e-5, z: None };
        assert!(point.exceeds());
        assert!(!Point { error: 3e-5, ..point }.exceeds());
        let curve = Curve { estimator: "ratio", along: Along::Steps, points: vec![point] };
        assert_eq!(curve.fails_from(), Some(1.0));
    }
}
