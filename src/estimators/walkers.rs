//! The walks of one order-free request: what becomes of them at the collisions of [`super::layers`].

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};
use rand_distr::{Binomial, Distribution};

use super::layers::{BATCH, Sites};
use super::rules::Collision;
use super::{DrawBuffer, Setup};
use crate::media::{Control, Placement};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::problems::Problem;
use crate::rng::Stream;

/// Walks with as many collisions behind them, which do not care in which order they came.
pub trait Walkers {
    /// Whether chance decides what becomes of them at a collision.
    fn decides(&self) -> bool;

    /// How many are on their way to another collision.
    fn walking(&self) -> usize;

    /// Those that have no more than so many collisions escape.
    fn escape(&mut self, layer: u32);

    /// A batch of the others, from number `first` on, meets its collisions.
    fn collide(&mut self, level: Level, sites: &Sites, first: usize);

    /// All have met theirs.
    fn close(&mut self, layer: u32);
}

/// What is to be drawn.
pub struct Request<'a> {
    /// The stream that says how many walks have how many collisions.
    pub counts: &'a mut Stream,
    /// How many draws.
    pub count: usize,
    /// Where they go.
    pub buffer: &'a mut DrawBuffer,
}

/// The draws of a product estimator; `None` where a draw has no channel.
pub fn product<'a, P: Problem, R: Collision>(
    setup: &'a Setup<P>,
    rule: R,
    request: Request<'a>,
) -> Option<Box<dyn Walkers + 'a>> {
    Walks::begin(setup, rule, request).map(|walks| Box::new(walks) as Box<dyn Walkers>)
}

/// The walks of a product estimator.
struct Walks<'a, R> {
    rule: R,
    control: &'a Control,
    /// `σ_c` at the collisions of a batch; written once where it has one value.
    subtracted: [f64; BATCH],
    /// `1/σ̂`, where it has one value.
    mean_free_path: Option<f64>,
    hazards: Hazards,
    counts: &'a mut Stream,
    /// The weights; those of the walks on their way come first.
    weights: &'a mut [f64],
    lookups: &'a mut [u32],
    walking: usize,
    survivors: usize,
}

impl<'a, R: Collision> Walks<'a, R> {
    /// So many walks at their beginning; `None` where a draw has no channel.
    fn begin<P: Problem>(setup: &'a Setup<P>, rule: R, request: Request<'a>) -> Option<Self> {
        let Request { counts, count, buffer } = request;
        let (weights, lookups, defects) = buffer.one_channel(count)?;
        weights.fill(setup.control_transmittance);
        defects.fill(0.0);
        let placement = Placement::new(&setup.sampling);
        Some(Self {
            rule,
            control: &setup.control,
            subtracted: [setup.control.single_value().unwrap_or_default(); BATCH],
            mean_free_path: placement.mean_free_path(),
            hazards: Hazards::new(placement.depth()),
            counts,
            weights,
            lookups,
            walking: count,
            survivors: 0,
        })
    }
}

impl<R: Collision> Walkers for Walks<'_, R> {
    fn decides(&self) -> bool {
        R::DECIDES
    }

    fn walking(&self) -> usize {
        self.walking
    }

    fn escape(&mut self, layer: u32) {
        // Others may still be walking: they take no number from this stream.
        if self.walking == 0 {
            return;
        }
        // All are alike: let it be the last ones.
        let escaped = binomial(self.walking, self.hazards.at(layer), self.counts);
        let left = self.walking.saturating_sub(escaped);
        self.lookups[left..self.walking].fill(layer);
        (self.walking, self.survivors) = (left, 0);
    }

    fn collide(&mut self, level: Level, sites: &Sites, first: usize) {
        let count = sites.length.min(self.walking.saturating_sub(first));
        if count == 0 {
            return;
        }
        if self.control.single_value().is_none() {
            let length = sites.length;
            self.control.look_up(level, &sites.t[..length], &mut self.subtracted[..length]);
        }
        let (subtracted, mean_free_path) = (&self.subtracted, self.mean_free_path);
        let fate = Fate {
            collisions: Collisions { rule: &self.rule, sites, subtracted, mean_free_path },
            weights: &mut self.weights[..self.walking],
            first,
            count,
            survivors: self.survivors,
        };
        self.survivors = pack::on(level, fate);
    }

    fn close(&mut self, layer: u32) {
        self.weights[self.survivors..self.walking].fill(0.0);
        self.lookups[self.survivors..self.walking].fill(layer + 1);
        self.walking = self.survivors;
    }
}

/// The collisions of a batch, as these walks see them.
struct Collisions<'a, R> {
    rule: &'a R,
    sites: &'a Sites,
    subtracted: &'a [f64; BATCH],
    mean_free_path: Option<f64>,
}

impl<R: Collision> Collisions<'_, R> {
    /// What becomes of the walks at the collisions of a pack.
    #[inline(always)]
    fn fate<S: Simd>(&self, simd: S, from: usize) -> Fates<S> {
        let Self { rule, sites, subtracted, mean_free_path } = self;
        let mean_free_path = match *mean_free_path {
            Some(path) => f64x8::splat(simd, path),
            None => eight(simd, &sites.mean_free_path, from),
        };
        let residual = eight(simd, &sites.extinction, from) - eight(simd, subtracted, from);
        let ratio = residual * mean_free_path;
        let outcome = rule.at(ratio);
        if !R::DECIDES {
            return Fates { factor: outcome.weight, survived: ALL, unknown: 0 };
        }
        // A ratio that is no number makes the draw none: its walk survives to show it.
        let known = ratio.at_most(ratio);
        let survived = eight(simd, &sites.decision, from).below(outcome.survival);
        let unknown = ALL & !known.to_bitmask();
        let factor = Lane::select(known, outcome.weight, ratio);
        Fates { factor, survived: survived.to_bitmask() | unknown, unknown }
    }
}

/// What becomes of the walks of a pack.
struct Fates<S: Simd> {
    /// The factors of their weights.
    factor: f64x8<S>,
    /// Who survives, as bits.
    survived: u64,
    /// Whose ratio is no number, as bits.
    unknown: u64,
}

/// The bits of a whole pack.
const ALL: u64 = (1 << WIDTH) - 1;

#[inline(always)]
fn eight<S: Simd>(simd: S, row: &[f64; BATCH], from: usize) -> f64x8<S> {
    f64x8::from_slice(simd, &row[from..from + WIDTH])
}

/// What becomes of the walks of a batch, the first of which is number `first`.
struct Fate<'a, R> {
    collisions: Collisions<'a, R>,
    weights: &'a mut [f64],
    first: usize,
    count: usize,
    survivors: usize,
}

impl<R: Collision> Task for Fate<'_, R> {
    type Output = usize;

    /// Answers how many have survived, with those before.
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> usize {
        let Self { collisions, weights, first, count, mut survivors } = self;
        let whole = count / WIDTH * WIDTH;
        for from in (0..whole).step_by(WIDTH) {
            let Fates { factor, survived, unknown } = collisions.fate(simd, from);
            if R::DECIDES && !R::WEIGHS {
                // They have the weight that they began with, unless it is no number.
                if unknown != 0
                    && let Some(weight) = weights.get_mut(survivors)
                {
                    *weight = f64::NAN;
                }
                survivors += survived.count_ones() as usize;
            } else if let Some(places) = weights.get_mut(first + from..first + from + WIDTH) {
                let weight = f64x8::from_slice(simd, places) * factor;
                if R::DECIDES {
                    let mut pack = [0.0; WIDTH];
                    weight.store_slice(&mut pack);
                    survivors = keep(weights, survivors, &pack, survived);
                } else {
                    weight.store_slice(places);
                    survivors += WIDTH;
                }
            }
        }
        if whole < count {
            let Fates { factor, survived, .. } = collisions.fate(simd, whole);
            let mut pack = [0.0; WIDTH];
            let last = &weights[first + whole..first + count];
            pack[..last.len()].copy_from_slice(last);
            let there = (1 << last.len()) - 1;
            let weight = f64x8::from_slice(simd, &pack) * factor;
            weight.store_slice(&mut pack);
            survivors = keep(weights, survivors, &pack, survived & there);
        }
        survivors
    }
}

/// Writes the survivors of a pack behind those before them; answers how many there are.
#[inline(always)]
fn keep(weights: &mut [f64], mut survivors: usize, pack: &[f64; WIDTH], survived: u64) -> usize {
    for (lane, &weight) in pack.iter().enumerate() {
        // Each is written over by the next one that survives.
        if let Some(place) = weights.get_mut(survivors) {
            *place = weight;
        }
        survivors += (survived >> lane & 1) as usize;
    }
    survivors
}

/// How likely a walk with so many collisions has no more of them.
///
/// ```text
/// P(N = i)/P(N ≥ i) = 1/Rᵢ,  Rᵢ = 1 + Λ/(i + 1) Rᵢ₊₁
/// ```
///
/// Nothing cancels; where `Rᵢ` overflows, the chance is below 1e-308.
struct Hazards(Vec<f64>);

impl Hazards {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked by the plan
    fn new(depth: f64) -> Self {
        // P(N > Λ + 12√Λ + 40) < 1e-30.
        let last = (depth + 12.0 * depth.sqrt() + 40.0) as usize;
        let mut hazards = vec![1.0; last + 1];
        let mut rest = 1.0;
        for i in (0..last).rev() {
            rest = 1.0 + depth / (i + 1) as f64 * rest;
            hazards[i] = 1.0 / rest;
        }
        Self(hazards)
    }

    /// For the walks with so many collisions.
    fn at(&self, layer: u32) -> f64 {
        self.0.get(layer as usize).copied().unwrap_or(1.0)
    }
}

/// How many of so many.
#[allow(clippy::cast_possible_truncation)] // not more than there are
fn binomial(count: usize, chance: f64, numbers: &mut Stream) -> usize {
    // A chance is in [0, 1], so there is such a law.
    Binomial::new(count as u64, chance).map_or(count, |law| law.sample(numbers) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::theory::count::poisson;

    #[test]
    fn hazards_are_those_of_the_poisson_law() {
        for (depth, layers) in [(0.0, 1), (1e-3, 1), (0.7, 4), (8.0, 17), (60.0, 84)] {
            let hazards = Hazards::new(depth);
            let mut rest = 1.0;
            for i in 0..layers {
                let there = poisson(i, depth);
                assert!((hazards.at(i) - there / rest).abs() < 1e-11, "{depth}: {i}");
                rest -= there;
            }
        }
        assert_eq!(Hazards::new(0.0).at(0), 1.0, "without collisions all escape at once");
        assert_eq!(Hazards::new(1e4).at(0), 0.0, "below the least double");
    }
}
