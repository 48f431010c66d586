//! Single precision against double: where does a renderer's rounding outgrow its noise?
//!
//! The same walk is made twice from the same random words, in doubles of 53 and in [`Narrow`] numbers of
//! 24 bits, through a medium of three waves. The difference of the two means is the bias that single
//! precision adds; with common random numbers a few thousand walks find it.
//!
//! ```text
//! σ_t(t) = (τ/ℓ)(1 + 0.8 sin(6π(t − t₀)/ℓ)),  t = t₀ … t₀ + ℓ
//! bias   |mean of X₂₄ − X₅₃|/T        noise  √(V/n)/T of n = 1e8 draws, V in theory
//! u₂₄    the upper 24 bits of the word: 1 − k/2²⁴, as renderers make it
//! ```
//!
//! The lattice of u₂₄ alone shortens flights by `ln(2πN)/(2N) = 5.5e-7`, N = 2²⁴: estimators of small
//! variance notice it first.

use rayon::prelude::*;

use super::{Dice, Effort, Measure, Row};
use crate::estimators::rules::{Collision, Null, Single, Weight};
use crate::media::Extinction;
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::{Lane, Narrow as F32};
use crate::theory::Rule;

/// The draws whose statistical error the bias is compared with.
pub const DRAWS: f64 = 1e8;
/// Walks at most.
const MOST: f64 = 1e5;

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
                &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6]
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

/// A ray of length 1 through the waves.
#[derive(Debug, Clone, Copy)]
struct Scene {
    depth: f64,
    collisions: f64,
    from: f64,
}

impl Extinction for Scene {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        let wave = ((t - self.from) * (6.0 * std::f64::consts::PI)).sin();
        (wave * 0.8 + 1.0) * self.depth
    }
}

/// Compares both precisions on a scene, with a control, from a seed, over so many walks.
type Comparison = fn(Scene, f64, u64, u64) -> Sums;

/// The rules of all product estimators.
const ESTIMATORS: [(&str, Comparison); 8] = [
    ("ratio", |scene, _, seed, walks| compare(scene, 0.0, &Weight, seed, walks)),
    ("residual-ratio", |scene, control, seed, walks| compare(scene, control, &Weight, seed, walks)),
    ("woodcock", |scene, _, seed, walks| compare(scene, 0.0, &Null, seed, walks)),
    ("single (terminating)", |scene, _, seed, walks| {
        compare(scene, 0.0, &Single::Terminating, seed, walks)
    }),
    ("single (non-terminating, a = 0.7)", |scene, _, seed, walks| {
        compare(scene, 0.0, &Single::NonTerminating { albedo: 0.7 }, seed, walks)
    }),
    ("single (adaptive, a = 0.7)", |scene, _, seed, walks| {
        compare(scene, 0.0, &Single::Adaptive { albedo: 0.7 }, seed, walks)
    }),
    ("single (clamped)", |scene, _, seed, walks| {
        compare(scene, 0.0, &Single::Clamped, seed, walks)
    }),
    ("weighted-delta", |scene, _, seed, walks| {
        compare(scene, 0.0, &Single::NonTerminating { albedo: 1.0 }, seed, walks)
    }),
];

/// What walks from the same words gave.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    walks: f64,
    /// Σ X/T in doubles.
    double: f64,
    /// Σ (X₂₄ − X₅₃)/T and its square.
    difference: [f64; 2],
    /// V/T² in theory.
    variance: f64,
}

/// A walk, with the numbers of a word made by `number`.
#[inline(always)]
fn walk<L: Lane<Mask = bool>, R: Collision>(
    scene: &Scene,
    control: f64,
    rule: &R,
    dice: &mut Dice,
    number: impl Fn(u64) -> L,
) -> L {
    let start = number(0);
    let (end, path) = (start.each(scene.from + 1.0), start.each(1.0 / scene.collisions));
    let (mut t, mut weight) = (start.each(scene.from), start.each((-control).exp()));
    loop {
        // 1 − u lies in (0, 1].
        let flight = -(start.each(1.0) - number(dice.word())).ln();
        let decision = if R::DECIDES { number(dice.word()) } else { start };
        t = t + flight * path;
        if !t.below(end) {
            return weight;
        }
        let ratio = (scene.extinction(t) - control) * path;
        let outcome = rule.at(ratio);
        if R::DECIDES && !decision.below(outcome.survival) {
            return start.each(0.0);
        }
        weight = weight * outcome.weight;
    }
}

fn compare<R: Collision>(scene: Scene, control: f64, rule: &R, seed: u64, walks: u64) -> Sums {
    const SCALE: f64 = 1.0 / 9_007_199_254_740_992.0;
    let mut sums = Sums { variance: variance(&scene, control, rule), ..Sums::default() };
    let truth = (-scene.depth).exp();
    for number in 0..walks {
        let dice = || Dice::new(seed, "narrow", number);
        let double: f64 =
            walk(&scene, control, rule, &mut dice(), |word| (word >> 11) as f64 * SCALE);
        let narrow: F32 = walk(&scene, control, rule, &mut dice(), |word| {
            F32::of((word >> 40) as f64 / 16_777_216.0)
        });
        let (double, narrow) = (double / truth, f64::from(narrow.0) / truth);
        sums.walks += 1.0;
        sums.double += double;
        sums.difference[0] += narrow - double;
        sums.difference[1] += (narrow - double) * (narrow - double);
    }
    sums
}

/// `expm1 ∫σ̂ E[(1 − W)²]`.
fn variance(scene: &Scene, control: f64, rule: &dyn Rule) -> f64 {
    let gauss = GaussLegendre::new(20);
    let loss = |t: f64| {
        let ratio = (scene.extinction(scene.from + t) - control) / scene.collisions;
        rule.outcome(ratio).mean_loss(2)
    };
    let panels: f64 = (0..24)
        .map(|i| f64::from(i) / 24.0)
        .map(|a| gauss.integrate(a, a + 1.0 / 24.0, loss))
        .sum();
    (scene.collisions * panels).exp_m1()
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
    /// The doubles' own mean against T, in standard errors.
    pub z: f64,
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
        let range = "8 estimators, all points of the plot";
        let name = "mean of doubles beside f32";
        let mut row = Row::new(name, range, Measure::Deviations, 6.0);
        for curve in &self.curves {
            for point in &curve.points {
                let place =
                    || format!("{}, {} = {:e}", curve.estimator, curve.along.word(), point.x);
                row.see(point.z.abs(), place);
            }
        }
        vec![row]
    }
}

/// Measures all curves.
#[must_use]
pub fn measure(effort: Effort, seed: u64) -> Narrow {
    let steps = effort.of(3e4, 1.5e6);
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
            let walks = (steps / scene.collisions).clamp(4.0, MOST) as u64;
            let sums = compare(scene, scene.depth, seed, walks);
            let bias = sums.difference[0] / sums.walks;
            let spread = (sums.difference[1] / sums.walks - bias * bias).max(0.0);
            let deviation = sums.variance.sqrt();
            Point {
                x,
                walks: sums.walks,
                bias,
                error: (spread / sums.walks).sqrt(),
                noise: deviation / DRAWS.sqrt(),
                z: (sums.double / sums.walks - 1.0) / (deviation / sums.walks.sqrt()),
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
    fn long_walks_fail_in_single_precision_and_short_ones_do_not() {
        let at = |collisions: f64, walks| {
            let scene = Scene { depth: 2.0, collisions, from: 0.0 };
            compare(scene, 0.0, &Weight, 1, walks)
        };
        let (short, long) = (at(10.0, 2000), at(1e5, 6));
        let bias = |sums: &Sums| (sums.difference[0] / sums.walks).abs();
        assert!(bias(&short) < 1e-5, "{short:?}");
        assert!(bias(&long) > long.variance.sqrt() / DRAWS.sqrt(), "{long:?}");
    }

    #[test]
    fn a_bias_counts_only_where_it_is_certain() {
        let point = Point { x: 1.0, walks: 9.0, bias: -1e-4, error: 1e-5, noise: 5e-5, z: 0.0 };
        assert!(point.exceeds());
        assert!(!Point { error: 3e-5, ..point }.exceeds());
        let curve = Curve { estimator: "ratio", along: Along::Steps, points: vec![point] };
        assert_eq!(curve.fails_from(), Some(1.0));
    }
}
