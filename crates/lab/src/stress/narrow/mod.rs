//! Single precision against double: where does a renderer's rounding outgrow its noise?
//!
//! The estimators' own walks are made twice from the same random words, with lanes of 53 bits and of 24
//! ([`F32`](numeric::F32)). The difference of the two means is the bias that single precision adds. With common random
//! numbers and common decisions (`trail`) a few thousand walks find it.
//!
//! ```text
//! bias   |mean of X₂₄ − X₅₃|/E[X]     noise  √(V/n)/E[X] of n = 1e8 draws
//! u₂₄    the upper 24 bits of a word, as renderers make it: k/2²⁴
//! ```
//!
//! `E[X]` and V are predicted by theory. Where theory has no V (roulette, walks in space), the walks in doubles
//! estimate it.
//!
//! The lattice of u₂₄ alone shortens flights by `ln(2πN)/(2N) = 5.5e-7`, N = 2²⁴. The bias exceeds the noise first for
//! estimators of small variance.

pub mod scene;
pub mod trail;
pub mod walks;

use std::any::Any;

use self::scene::StressScene;
use self::walks::{FamilyEntry, StressSubject};
use super::{Measure, Run, TrialRow};
use numeric::rng::Address;
use theory::{Channel, Prediction, parallel};
use trueflight::case::{Case, CaseText};

/// Number of draws n in the noise that the bias is compared with.
pub const DRAWS: f64 = 1e8;
/// Largest number of walks of a point.
const MAX_WALKS: f64 = 1e6;
/// Smallest number of walks of a point. Their mean number of random words decides how many more fit the budget.
const MIN_WALKS: u64 = 25;

/// A quantity that is varied.
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
    /// All quantities.
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

    /// The scene at a value.
    fn scene(self, x: f64) -> StressScene {
        match self {
            Self::Steps => StressScene { depth: 2.0, collisions: x, from: 0.0 },
            Self::Depth => StressScene { depth: x, collisions: 20.0 * 1.8 * x, from: 0.0 },
            Self::Origin => StressScene { depth: 2.0, collisions: 40.0, from: x },
        }
    }
}

/// Values of each quantity.
const VALUES: [&[f64]; 3] = [
    &[10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6],
    &[0.01, 0.1, 0.3, 1.0, 3.0, 10.0, 20.0, 40.0, 60.0, 80.0, 100.0],
    &[1.0, 10.0, 1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6],
];
/// Values of the short form.
const QUICK: [&[f64]; 3] = [&[10.0, 1e3], &[1.0, 10.0], &[10.0, 1e5]];

/// Estimators of one kind of problem.
pub struct Family {
    title: &'static str,
    /// Its estimators.
    pub entries: &'static [FamilyEntry],
    /// The largest values of each quantity.
    limits: [f64; 3],
    /// Random words that the doubles of a point may take in the short form, and in the full one.
    budget: [f64; 2],
}

const fn family(
    title: &'static str,
    entries: &'static [FamilyEntry],
    [collisions, depth]: [f64; 2],
    budget: [f64; 2],
) -> Family {
    Family { title, entries, limits: [collisions, depth, f64::INFINITY], budget }
}

/// All families. Theory predicts the light in balls up to τ = 30.
pub const FAMILIES: &[Family] = &[
    family("Transmittance by weights and decisions", walks::PRODUCTS, [1e6, 100.0], [3e4, 3e5]),
    family("Transmittance otherwise, free flight", walks::OTHERS, [1e6, 100.0], [3e4, 3e5]),
    family("Rod", walks::RODS, [1e4, 100.0], [2e4, 3e6]),
    family("Slab", walks::SLABS, [1e4, 100.0], [2e4, 3e6]),
    family("Single scattering", walks::POINTS, [1e5, 100.0], [3e4, 3e5]),
    family("Space", walks::SPACE, [1e4, 30.0], [2e4, 3e6]),
];

/// Returns the `Setup<P>` of a case with one estimator, and the prediction for it; `None` where it is refused.
fn prepared(text: &str) -> Option<(Box<dyn Any>, Prediction)> {
    /// Address of pilot draws, where theory has no variance.
    const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };
    let source = CaseText { name: "stress".into(), path: "stress.toml".into(), text: text.into() };
    let case = Case::read(&source).ok()?;
    let at = case.at(None).ok()?;
    Some((at.join(0, NOWHERE).ok()?.into_setup(), at.predict(0, None, NOWHERE)?))
}

/// Both precisions at one point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BothPrecisions {
    /// The value of the quantity that is varied.
    pub x: f64,
    /// Number of walks.
    pub walks: f64,
    /// The relative bias of single precision.
    pub bias: f64,
    /// Its standard error.
    pub error: f64,
    /// The relative standard error of 1e8 draws; NaN where it is unknown, or the walks are too few to estimate it.
    pub noise: f64,
    /// Deviation of the mean of the doubles from the truth, in standard errors.
    pub z: Option<f64>,
}

impl BothPrecisions {
    /// Returns whether the bias exceeds the noise by more than 3 of its standard errors.
    pub fn exceeds(&self) -> bool {
        self.bias.abs() - 3.0 * self.error > self.noise
    }

    /// Returns whether the bias is below the noise by at least 3 of its standard errors. If neither holds, the walks
    /// were too few.
    pub fn holds(&self) -> bool {
        self.error > 0.0 && self.bias.abs() + 3.0 * self.error <= self.noise
    }
}

/// Compares both precisions in a scene, by walks from a seed with a budget of random words. Returns `None` where theory
/// refuses the case.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MAX_WALKS
pub fn compare(
    entry: &FamilyEntry,
    scene: &StressScene,
    (seed, budget): (u64, f64),
) -> Option<BothPrecisions> {
    let (setup, prediction) = prepared(&scene.case(entry.requested, entry.written))?;
    let expected = entry.requested[3];
    let is_wanted = |channel: &Channel| expected.is_empty() || channel.name == expected;
    let channel = prediction.channels.iter().position(is_wanted)?;
    let subject = StressSubject { scene, setup: &*setup, channel, is_kept: entry.is_kept };
    let Channel { truth, moments, .. } = &prediction.channels[channel];
    // Σx and Σx² of the doubles, and of the differences.
    let (mut sums, mut words) = ([[0.0; 2]; 2], 0.0);
    let (mut walk, mut walks) = (0, MIN_WALKS);
    while walk < walks {
        let ([double, single], taken) = entry.draws.pair(subject, seed, walk)?;
        for (sums, x) in sums.iter_mut().zip([double, single - double]) {
            let x = x / truth.value;
            *sums = [sums[0] + x, sums[1] + x * x];
        }
        (walk, words) = (walk + 1, words + taken);
        if walk == MIN_WALKS {
            walks = (budget / words * walk as f64).clamp(walk as f64, MAX_WALKS) as u64;
        }
    }
    let walks = walks as f64;
    let [[mean, spread], [bias, error]] = sums.map(|[sum, square]| {
        let mean = sum / walks;
        [mean, ((square / walks - mean * mean).max(0.0) / (walks - 1.0)).sqrt()]
    });
    let known = moments.map(|moments| moments.variance() / (truth.value * truth.value));
    let known = known.filter(|variance| variance.is_finite());
    let variance = known.unwrap_or(spread * spread * walks);
    let is_seen = entry.is_kept || walks >= MIN_WALKS as f64 * variance.max(1.0);
    let noise = if is_seen { (variance / DRAWS).sqrt() } else { f64::NAN };
    let z = (is_seen && variance > 0.0).then_some((mean - 1.0) / (variance / walks).sqrt());
    Some(BothPrecisions { x: f64::NAN, walks, bias, error, noise, z })
}

/// One estimator along one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct PrecisionCurve {
    /// The family in which it is drawn.
    pub family: &'static str,
    /// The estimator.
    pub estimator: &'static str,
    /// The quantity that is varied.
    pub along: Along,
    /// The points, ascending; empty where the quantity is not varied, or theory refuses all cases.
    pub points: Vec<BothPrecisions>,
}

impl PrecisionCurve {
    /// The first value at which the bias exceeds the noise; `None` if it exceeds it nowhere.
    pub fn fails_from(&self) -> Option<f64> {
        self.points.iter().find(|point| point.exceeds()).map(|point| point.x)
    }

    /// The last value up to which the bias is certainly below the noise.
    pub fn holds_to(&self) -> Option<f64> {
        self.points.iter().take_while(|point| point.holds()).last().map(|point| point.x)
    }
}

/// The comparison of single precision with doubles.
#[derive(Debug, Clone, PartialEq)]
pub struct Narrow {
    /// Every estimator along every quantity: family by family, quantity by quantity.
    pub curves: Vec<PrecisionCurve>,
}

impl Narrow {
    /// One row: the comparison is valid if the means of the doubles agree with the truth.
    pub fn rows(&self) -> Vec<TrialRow> {
        let estimators: usize = FAMILIES.iter().map(|family| family.entries.len()).sum();
        let range = format!("{estimators} estimators, all points of the plot");
        let mut row = TrialRow::new("mean of doubles beside f32", range, Measure::Deviations, 6.0);
        for PrecisionCurve { estimator, along, points, .. } in &self.curves {
            for (point, number) in points.iter().zip(0..) {
                let place = || format!("{estimator}, {} = {:e}", along.word(), point.x);
                if let Some(z) = point.z {
                    row.see(z.abs(), number, place);
                }
            }
        }
        vec![row]
    }
}

/// Measures all curves.
pub fn measure(Run { effort, seed }: Run) -> Narrow {
    let mut curves = Vec::new();
    for Family { title, entries, limits, budget } in FAMILIES {
        for (along, limit) in Along::ALL.into_iter().zip(limits) {
            curves.extend(entries.iter().map(|entry| (*title, along, entry, *limit, budget)));
        }
    }
    let curves = parallel::map(&curves, |&(family, along, entry, limit, budget)| {
        let [quick, full] = [QUICK, VALUES].map(|values| values[along as usize]);
        let mut values = effort.of(quick, full).to_vec();
        values.retain(|&x| x <= limit && entry.varied.contains(&along));
        let points = parallel::map(&values, |&x| {
            let scene = along.scene(x);
            let budget = effort.of(budget[0], budget[1]);
            Some(BothPrecisions { x, ..compare(entry, &scene, (seed, budget))? })
        });
        let points = points.into_iter().flatten().collect();
        PrecisionCurve { family, estimator: entry.name, along, points }
    });
    Narrow { curves }
}
