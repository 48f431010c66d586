//! Both precisions from the same random words, and what the difference is measured by.

use super::precision::Precision;
use super::scene::Scene;
use super::trail::Trail;
use super::{DRAWS, Trial};
use crate::numeric::Narrow as F32;
use crate::stress::Dice;

/// Walks at most.
const MOST: f64 = 1e5;
/// Walks at least.
const LEAST: f64 = 8.0;
/// The same where their own spread has to be found.
const LEAST_BY_CHANCE: f64 = 25.0;
/// Walks that say how many collisions others will have.
const PILOTS: u64 = 12;
/// What a walk costs beside its collisions, in collisions.
const OVERHEAD: f64 = 4.0;

/// What theory says of a draw with averaged decisions.
#[derive(Debug, Clone, Copy)]
pub struct Known {
    /// The mean.
    pub truth: f64,
    /// `V/truth²` of the estimator.
    pub variance: f64,
    /// That of what is drawn here.
    pub drawn: Drawn,
}

/// What is known of the doubles' own spread.
#[derive(Debug, Clone, Copy)]
pub enum Drawn {
    /// Its variance, relative to truth², is at most this.
    Within(f64),
    /// The same, made by draws so rare that few walks do not see it.
    Rare(f64),
    /// It is of no use: the estimator is biased.
    Biased,
}

/// What theory says of a walk that scatters.
#[derive(Debug, Clone, Copy, Default)]
pub struct Stated {
    /// The mean; where it is not known, that of the doubles takes its place and is not tested.
    pub truth: Option<f64>,
    /// `V/truth²`; where it is not known, that of the doubles takes its place.
    pub variance: Option<f64>,
}

/// What a comparison came to, relative to the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// How many walks.
    pub walks: f64,
    /// The bias of single precision.
    pub bias: f64,
    /// Its standard error.
    pub error: f64,
    /// The standard error of 1e8 draws; not a number where it is not known.
    pub noise: f64,
    /// The doubles' own mean against the truth, in standard errors; not for a biased estimator.
    pub z: Option<f64>,
}

/// An estimator whose decisions are averaged, in either precision.
pub trait Averaged: Sync {
    /// What theory says; `None` where it has lost the variance.
    fn known(&self, scene: &Scene) -> Option<Known>;
    /// What a draw costs, in collisions.
    fn cost(&self, scene: &Scene) -> f64 {
        scene.collisions
    }
    /// A draw.
    fn draw<P: Precision>(&self, scene: &Scene, dice: &mut Dice) -> f64;
}

/// A walk that scatters, in either precision.
pub trait Walk: Sync {
    /// What theory says.
    fn stated(&self, scene: &Scene) -> Stated;
    /// Where walks have the same variance and are short, to find it.
    fn pilots(&self, scene: Scene) -> Scene {
        scene
    }
    /// A draw, weighted by the chances of what was decided.
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64;
}

/// A flight of an optical depth of mean 1; 1 − u lies in (0, 1].
#[inline(always)]
pub fn flight<P: Precision>(dice: &mut Dice) -> P {
    let u = P::uniform(dice.word());
    -(u.each(1.0) - u).ln()
}

/// All tentative collisions of a constant σ̂.
#[inline(always)]
pub fn fly<P: Precision>(scene: &Scene, dice: &mut Dice, mut collide: impl FnMut(P)) {
    let (end, path) = (P::of(scene.from + 1.0), P::of(1.0 / scene.collisions));
    let mut t = P::of(scene.from);
    loop {
        t = t + flight::<P>(dice) * path;
        if !t.below(end) {
            return;
        }
        collide(t);
    }
}

/// Sums over walks.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    walks: f64,
    double: [f64; 2],
    difference: [f64; 2],
}

impl Sums {
    fn see(&mut self, double: f64, narrow: f64) {
        let off = narrow - double;
        self.walks += 1.0;
        for (sums, x) in [(&mut self.double, double), (&mut self.difference, off)] {
            sums[0] += x;
            sums[1] += x * x;
        }
    }

    /// A mean and the standard error of it.
    fn mean(&self, [sum, square]: [f64; 2]) -> [f64; 2] {
        let mean = sum / self.walks;
        let spread = (square / self.walks - mean * mean).max(0.0);
        [mean, (spread / (self.walks - 1.0)).sqrt()]
    }

    /// Whether there are enough of them for a variance relative to truth².
    fn sees(&self, variance: f64) -> bool {
        self.walks >= LEAST_BY_CHANCE * variance.max(1.0)
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
fn walks(budget: f64, cost: f64, least: f64) -> u64 {
    (budget / cost).clamp(least, MOST) as u64
}

/// Compares both precisions of an estimator with averaged decisions.
pub fn compare<E: Averaged>(estimator: &E, trial: Trial) -> Compared {
    let Trial { scene, seed, budget } = trial;
    let known = estimator.known(&scene);
    let truth = known.map_or(1.0, |known| known.truth);
    let mut sums = Sums::default();
    for number in 0..walks(budget, estimator.cost(&scene), LEAST) {
        let dice = || Dice::new(seed, "narrow", number);
        let double = estimator.draw::<f64>(&scene, &mut dice()) / truth;
        sums.see(double, estimator.draw::<F32>(&scene, &mut dice()) / truth);
    }
    let [bias, error] = sums.mean(sums.difference);
    let (drawn, is_seen) = match known.map_or(Drawn::Biased, |known| known.drawn) {
        Drawn::Within(variance) => (Some(variance), true),
        Drawn::Rare(variance) => (Some(variance), sums.sees(variance)),
        Drawn::Biased => (None, true),
    };
    let off = sums.double[0] / sums.walks - 1.0;
    Compared {
        walks: sums.walks,
        bias,
        error,
        // Without a variance nothing exceeds it, and nothing holds.
        noise: known.filter(|_| is_seen).map_or(f64::NAN, |known| (known.variance / DRAWS).sqrt()),
        z: drawn.filter(|_| is_seen).map(|variance| off / (variance / sums.walks).sqrt()),
    }
}

/// The decisions of a walk, on average, and what it costs besides.
fn cost<W: Walk>(walk: &W, scene: &Scene, seed: u64) -> f64 {
    let pilot = |number: u64| {
        let mut trail = Trail::new(Dice::new(seed, "narrow-cost", number));
        walk.draw::<f64>(scene, &mut trail);
        trail.length()
    };
    (0..PILOTS).map(pilot).sum::<f64>() / PILOTS as f64 + OVERHEAD
}

/// Compares both precisions of a walk that scatters.
///
/// Where so few walks reach what is sought that their spread is not seen, nothing is said of the noise.
pub fn compare_walks<W: Walk>(walk: &W, trial: Trial) -> Compared {
    let Trial { scene, seed, budget } = trial;
    let cost = cost(walk, &scene, seed);
    let mut sums = Sums::default();
    for number in 0..walks(budget, cost, LEAST_BY_CHANCE) {
        let dice = || Dice::new(seed, "narrow", number);
        let mut trail = Trail::new(dice());
        let double = walk.draw::<f64>(&scene, &mut trail);
        let narrow = walk.draw::<F32>(&scene, &mut trail.again(dice()));
        sums.see(double, narrow);
    }
    let stated = walk.stated(&scene);
    let [mean, spread] = sums.mean(sums.double);
    let truth = stated.truth.unwrap_or(mean);
    let [bias, error] = sums.mean(sums.difference).map(|x| x / truth);
    let variance = stated.variance.unwrap_or_else(|| {
        let scene = walk.pilots(scene);
        let mut pilots = Sums::default();
        for number in 0..walks(budget, self::cost(walk, &scene, seed), LEAST_BY_CHANCE) {
            let mut trail = Trail::by_chance(Dice::new(seed, "narrow-pilot", number));
            pilots.see(walk.draw::<f64>(&scene, &mut trail), 0.0);
        }
        let [_, spread] = pilots.mean(pilots.double);
        spread * spread * (pilots.walks - 1.0) / (truth * truth)
    });
    let is_seen = sums.sees(variance);
    Compared {
        walks: sums.walks,
        bias,
        error,
        noise: if is_seen { (variance / DRAWS).sqrt() } else { f64::NAN },
        z: stated.truth.filter(|_| is_seen && spread > 0.0).map(|truth| (mean - truth) / spread),
    }
}
