//! Order-free draws: the walks of a request side by side, one collision after the other.
//!
//! Specification: the draws of a request, in no order, have the law of as many draws of
//! [`super::walk::product`]; their numbers of lookups have the law of [`CountLaw::in_layers`].
//!
//! A product estimator does not care in which order its collisions come, and they lie as they like:
//!
//! ```text
//! X = T_c ∏ Wᵢ,  N ~ Poisson(Λ),  Λ = ∫σ̂,  t₁ … t_N independent with density σ̂/Λ
//! ```
//!
//! So a request is made in layers. Of the m walks that have had i collisions,
//! Binomial(m, P(N = i)/P(N ≥ i)) have no more of them: they have escaped. All others have one more
//! collision, anywhere, and those that survive it are moved together. No logarithm, no lane that
//! waits, no branch that depends on a walk; the price is that the draws of a request come sorted by
//! their lookups, that a walk keeps no books, and that one that is killed had seen not the first
//! collisions of its ray but any.
//!
//! Source: the layers are the multinomial histogram of N, drawn bin by bin; binomial numbers by
//! `rand_distr`.
//!
//! [`CountLaw::in_layers`]: crate::theory::CountLaw::in_layers

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, u64x8};
use rand_distr::{Binomial, Distribution};

use super::Setup;
use super::packet::Request;
use super::rules::Collision;
use crate::media::{Control, Extinction, FreeFlight, Medium, Piecewise, Placement, Visitor};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::problems::Problem;
use crate::rng::{Lanes, Stream, Xoshiro};

/// Collisions that are looked up together: their numbers stay in the first-level cache.
const BATCH: usize = 256;

/// The draws of a product estimator, on the hardware of a level.
pub fn product<P: Problem, R: Collision>(
    level: Level,
    setup: &Setup<P>,
    rule: &R,
    request: Request,
) {
    let Request { streams, count, buffer, .. } = request;
    let Some((values, lookups, defects)) = buffer.one_channel(count) else { return };
    values.fill(setup.control_transmittance);
    defects.fill(0.0);
    let field = (setup.problem.medium(), &setup.control);
    let mut collisions = Collisions::new(level, &setup.sampling, field, Lanes::of(&streams.lanes));
    let hazards = Hazards::new(collisions.placement.depth());
    let (mut walking, mut layer) = (count, 0);
    while walking > 0 {
        // All are alike: let it be the last ones.
        let escaped = binomial(walking, hazards.at(layer), &mut streams.counts);
        let left = walking.saturating_sub(escaped);
        lookups[left..walking].fill(layer);
        layer += 1;
        walking = collisions.one_more(rule, &mut values[..left]);
        values[walking..left].fill(0.0);
        lookups[walking..left].fill(layer);
    }
    streams.lanes = collisions.numbers.apart();
}

/// Collisions anywhere on the support, a batch at a time.
struct Collisions<'a> {
    level: Level,
    medium: &'a Medium,
    control: &'a Control,
    placement: Placement<'a>,
    numbers: Lanes,
    batch: Box<Batch>,
}

/// What is known of each collision of a batch. What has one value everywhere is written once.
#[repr(align(64))]
struct Batch {
    t: [f64; BATCH],
    mean_free_path: [f64; BATCH],
    /// The number that decides what becomes of the walk.
    decision: [f64; BATCH],
    extinction: [f64; BATCH],
    control: [f64; BATCH],
}

impl<'a> Collisions<'a> {
    fn new(
        level: Level,
        sampling: &'a Piecewise,
        (medium, control): (&'a Medium, &'a Control),
        numbers: Lanes,
    ) -> Self {
        let placement = Placement::new(sampling);
        let batch = Box::new(Batch {
            t: [0.0; BATCH],
            mean_free_path: [placement.mean_free_path().unwrap_or_default(); BATCH],
            decision: [0.0; BATCH],
            extinction: [0.0; BATCH],
            control: [control.single_value().unwrap_or_default(); BATCH],
        });
        Self { level, medium, control, placement, numbers, batch }
    }

    /// One collision of each walk. Those that survive it come first, as many as it answers.
    fn one_more<R: Collision>(&mut self, rule: &R, weights: &mut [f64]) -> usize {
        let (mut first, mut survivors) = (0, 0);
        while first < weights.len() {
            let count = BATCH.min(weights.len() - first);
            // Whole packs: what is beyond the last walk is not used.
            let length = count.next_multiple_of(WIDTH);
            let chance = Chance {
                level: self.level,
                placement: &self.placement,
                numbers: &mut self.numbers,
                batch: &mut self.batch,
                length,
                decides: R::DECIDES,
            };
            self.medium.profile().visit(chance);
            if self.control.single_value().is_none() {
                let Batch { t, control, .. } = &mut *self.batch;
                self.control.look_up(self.level, &t[..length], &mut control[..length]);
            }
            let fate = Fate { rule, batch: &self.batch, weights, first, count, survivors };
            survivors = pack::on(self.level, fate);
            first += count;
        }
        survivors
    }
}

/// Where the collisions of a batch are, what the medium is there, and the numbers that decide.
struct Chance<'a> {
    level: Level,
    placement: &'a Placement<'a>,
    numbers: &'a mut Lanes,
    batch: &'a mut Batch,
    length: usize,
    decides: bool,
}

impl Visitor for Chance<'_> {
    type Output = ();

    fn visit<F: FreeFlight>(self, medium: &F) {
        pack::on(self.level, Lookups { chance: self, medium });
    }
}

struct Lookups<'a, M> {
    chance: Chance<'a>,
    medium: &'a M,
}

impl<M: Extinction> Task for Lookups<'_, M> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Chance { placement, numbers, batch, length, decides, .. } = self.chance;
        let mut stream: Xoshiro<u64x8<S>> = numbers.awake(simd);
        let varies = placement.mean_free_path().is_none();
        for from in (0..length).step_by(WIDTH) {
            let place = from..from + WIDTH;
            let (t, mean_free_path) = placement.at(stream.uniform());
            t.store_slice(&mut batch.t[place.clone()]);
            if varies {
                mean_free_path.store_slice(&mut batch.mean_free_path[place.clone()]);
            }
            self.medium.extinction(t).store_slice(&mut batch.extinction[place]);
        }
        if decides {
            for decision in batch.decision[..length].as_chunks_mut::<WIDTH>().0 {
                stream.uniform().store_slice(decision);
            }
        }
        *numbers = stream.at_rest();
    }
}

/// What becomes of the walks of a batch, the first of which is number `first`.
struct Fate<'a, R> {
    rule: &'a R,
    batch: &'a Batch,
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
        let Self { rule, batch, weights, first, count, mut survivors } = self;
        let whole = count / WIDTH * WIDTH;
        for from in (0..whole).step_by(WIDTH) {
            let (factor, survived) = fate(simd, rule, batch, from);
            let places = first + from..first + from + WIDTH;
            if R::DECIDES && !R::WEIGHS {
                // They have the weight that they began with.
                survivors += survived.count_ones() as usize;
            } else if let Some(places) = weights.get_mut(places) {
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
            let (factor, survived) = fate(simd, rule, batch, whole);
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

/// The factors of the weights at the collisions of a pack, and who survives, as bits.
#[inline(always)]
fn fate<S: Simd, R: Collision>(simd: S, rule: &R, batch: &Batch, from: usize) -> (f64x8<S>, u64) {
    let pack = |row: &[f64; BATCH]| f64x8::from_slice(simd, &row[from..from + WIDTH]);
    let residual = pack(&batch.extinction) - pack(&batch.control);
    let outcome = rule.at(residual * pack(&batch.mean_free_path));
    let survived = if R::DECIDES {
        pack(&batch.decision).below(outcome.survival).to_bitmask()
    } else {
        u64::MAX
    };
    (outcome.weight, survived)
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
        for depth in [0.0, 1e-3, 0.7, 8.0, 60.0] {
            let hazards = Hazards::new(depth);
            let mut rest = 1.0;
            for i in 0..(depth + 3.0 * f64::sqrt(depth)) as u32 {
                let there = poisson(i, depth);
                assert!((hazards.at(i) - there / rest).abs() < 1e-11, "{depth}: {i}");
                rest -= there;
            }
        }
        assert_eq!(Hazards::new(0.0).at(0), 1.0, "without collisions all escape at once");
        assert_eq!(Hazards::new(1e4).at(0), 0.0, "below the least double");
    }
}
