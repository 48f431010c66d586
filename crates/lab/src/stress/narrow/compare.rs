//! Both precisions from the same random words, and what the difference is measured by.

use super::precision::Precision;
use super::scene::Scene;
use super::trail::Trail;
use super::{DRAWS, Point, Trial};
use crate::stress::narrow::dice::Dice;
use numeric::Narrow as F32;
use numeric::fused::in_fused_code;

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

/// What theory says of an estimator.
#[derive(Debug, Clone, Copy)]
pub struct Theory {
    /// The mean; of walks where it is not known, that of the doubles takes its place and is not tested.
    pub truth: Option<f64>,
    /// `V/truth²`; of walks where it is not known, that of the doubles takes its place.
    pub variance: Option<f64>,
    /// What is known of the doubles' own spread.
    pub spread: Spread,
}

/// What is known of the doubles' own spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Averaged decisions leave at most this variance, relative to truth².
    Within(f64),
    /// The same, made by draws so rare that few walks do not see it.
    Rare(f64),
    /// It is of no use: the estimator is biased, or theory has lost the variance.
    Useless,
    /// That of the draws, of walks that scatter.
    Seen,
}

impl Theory {
    /// Of averaged decisions: the truth, `V/truth²` of the estimator and that of what is drawn here.
    pub fn averaged(truth: f64, variance: f64, drawn: f64) -> Self {
        Self { truth: Some(truth), variance: Some(variance), spread: Spread::Within(drawn) }
    }

    /// Where nothing is known.
    pub const UNKNOWN: Self = Self { truth: None, variance: None, spread: Spread::Useless };
}

/// An estimator in either precision.
pub trait Estimator: Sync {
    /// What theory says.
    fn theory(&self, scene: &Scene) -> Theory;
    /// What a draw costs, in collisions; `None` where walks have to tell.
    fn cost(&self, scene: &Scene) -> Option<f64> {
        Some(scene.collisions)
    }
    /// Where walks have the same variance and are short, to find it.
    fn pilots(&self, scene: Scene) -> Scene {
        scene
    }
    /// A draw; that of a walk is weighted by the chances of what was decided.
    fn draw<P: Precision>(&self, scene: &Scene, trail: &mut Trail) -> f64;
}

/// An estimator of which only the comparison is asked for.
pub trait Compare: Sync {
    /// Compares both precisions; the point does not know yet what was varied.
    fn compare(&self, trial: Trial) -> Point;
}

/// A flight of an optical depth of mean 1; 1 − u lies in (0, 1].
#[inline(always)]
pub fn flight<P: Precision>(trail: &mut Trail) -> P {
    let u = trail.uniform::<P>();
    -(u.each(1.0) - u).ln()
}

/// All tentative collisions of a constant σ̂ from a place to another.
#[inline(always)]
pub fn fly<P: Precision>(
    trail: &mut Trail,
    [mut t, end, path]: [P; 3],
    mut collide: impl FnMut(P),
) {
    loop {
        t = t + flight::<P>(trail) * path;
        if !t.below(end) {
            return;
        }
        collide(t);
    }
}

/// What comes through a stretch: the weight of ratio tracking, or the chance that delta tracking does.
#[inline(always)]
pub fn tracked<P: Precision>(
    trail: &mut Trail,
    stretch: [P; 3],
    is_ratio: bool,
    ratio: impl Fn(P) -> P,
) -> (P, f64) {
    let (mut weight, mut chance) = (P::of(1.0), 1.0);
    fly(trail, stretch, |t: P| {
        if is_ratio {
            weight = weight * (P::of(1.0) - ratio(t));
        } else {
            chance *= 1.0 - ratio(t).chance();
        }
    });
    (weight, chance)
}

/// Sums over walks.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    walks: f64,
    double: [f64; 2],
    difference: [f64; 2],
}

impl Sums {
    /// Of both precisions of so many walks.
    fn of(walks: u64, mut draw: impl FnMut(u64) -> [f64; 2]) -> Self {
        let mut all = Self::default();
        for number in 0..walks {
            let [double, narrow] = draw(number);
            all.walks += 1.0;
            let off = narrow - double;
            for (sums, x) in [(&mut all.double, double), (&mut all.difference, off)] {
                sums[0] += x;
                sums[1] += x * x;
            }
        }
        all
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

/// A draw, in the code of machines that multiply and add at once: the same numbers, sooner. Compiled once for each precision.
#[inline(never)]
fn draw<E: Estimator, P: Precision>(estimator: &E, scene: &Scene, trail: &mut Trail) -> f64 {
    in_fused_code(
        #[inline(always)]
        || estimator.draw::<P>(scene, trail),
    )
}

/// How many walks a budget pays for: those that scatter say by some pilots what they cost.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
fn walks<E: Estimator>(estimator: &E, Trial { scene, seed, budget }: Trial) -> u64 {
    if let Some(cost) = estimator.cost(&scene) {
        return (budget / cost).clamp(LEAST, MOST) as u64;
    }
    let pilot = |number: u64| {
        let mut trail = Trail::new(Dice::new(seed, "narrow-cost", number));
        draw::<_, f64>(estimator, &scene, &mut trail);
        trail.length()
    };
    let cost = (0..PILOTS).map(pilot).sum::<f64>() / PILOTS as f64 + OVERHEAD;
    (budget / cost).clamp(LEAST_BY_CHANCE, MOST) as u64
}

/// The variance of walks that decide all by chance, as estimators do.
fn own_variance<E: Estimator>(estimator: &E, trial: Trial) -> f64 {
    let scene = estimator.pilots(trial.scene);
    let pilots = Sums::of(walks(estimator, Trial { scene, ..trial }), |number| {
        let mut trail = Trail::by_chance(Dice::new(trial.seed, "narrow-pilot", number));
        [draw::<_, f64>(estimator, &scene, &mut trail), 0.0]
    });
    let [_, spread] = pilots.mean(pilots.double);
    spread * spread * (pilots.walks - 1.0)
}

impl<E: Estimator> Compare for E {
    /// Where so few walks reach what is sought that their spread is not seen, nothing is said of the noise.
    fn compare(&self, trial: Trial) -> Point {
        let Trial { scene, seed, .. } = trial;
        let Theory { truth, mut variance, spread } = self.theory(&scene);
        let scatters = spread == Spread::Seen;
        let unit = if scatters { 1.0 } else { truth.unwrap_or(1.0) };
        let sums = Sums::of(walks(self, trial), |number| {
            let dice = || Dice::new(seed, "narrow", number);
            let mut trail = Trail::new(dice());
            let double = draw::<_, f64>(self, &scene, &mut trail) / unit;
            [double, draw::<_, F32>(self, &scene, &mut trail.again(dice())) / unit]
        });
        let [mean, own] = sums.mean(sums.double);
        let exact = if scatters { truth.unwrap_or(mean) } else { 1.0 };
        let [bias, error] = sums.mean(sums.difference).map(|x| x / exact);
        if scatters && variance.is_none() {
            variance = Some(own_variance(self, trial) / (exact * exact));
        }
        let error_of = |variance: f64| Some((variance / sums.walks).sqrt());
        let (is_seen, own) = match spread {
            Spread::Within(drawn) => (true, error_of(drawn)),
            Spread::Rare(drawn) => (sums.sees(drawn), error_of(drawn)),
            Spread::Useless => (true, None),
            Spread::Seen => (variance.is_some_and(|v| sums.sees(v)), (own > 0.0).then_some(own)),
        };
        // Without a variance nothing exceeds it, and nothing holds.
        let noise = variance.filter(|_| is_seen).map_or(f64::NAN, |v| (v / DRAWS).sqrt());
        let own = own.filter(|_| is_seen && truth.is_some());
        let z = own.map(|own| (mean - exact) / own);
        Point { x: f64::NAN, walks: sums.walks, bias, error, noise, z }
    }
}
