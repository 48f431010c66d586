//! All walks of one order-free request, each at one more collision that is looked up for it alone.
//!
//! σ̂ and the control have one value. Both are kept as scalars until a pair of packs is decided: of them a compiler
//! knows that all lanes have the same one, and keeps it in one register.

use fearless_simd::{Simd, f64x8, u64x8};

use super::Streams;
use super::collisions::{Collisions, Weights};
use media::{Extinction, Inlined, Lookups};
use numeric::pack::{self, Task};
use numeric::rng::Xoshiro;
use numeric::rng::xoshiro::SCALE;
use numeric::twin::PAIR;
use numeric::{Lane, Twin};
use theory::rules::{Collision, Met};

/// Collisions that are looked up by one call.
const PER_CALL: usize = 256;

/// The walks, and what they meet.
pub struct Layer<'a, R> {
    /// What happens at a collision.
    pub rule: &'a R,
    /// The medium.
    pub medium: &'a Lookups<'a>,
    /// What all collisions have in common.
    pub common: Common,
    /// The streams of the layer.
    pub streams: Streams<'a>,
    /// The walks.
    pub weights: Weights<'a>,
}

/// What all collisions have in common.
#[derive(Clone, Copy)]
pub struct Common {
    /// The least distance at which one may lie.
    pub from: f64,
    /// The step between possible distances: what the integers of a stream are multiplied by.
    pub unit: f64,
    /// `σ̂`.
    pub sampling: f64,
    /// `σ_c`.
    pub subtracted: f64,
}

impl Common {
    #[inline(always)]
    fn places<S: Simd>(self, simd: S, streams: &mut Xoshiro<u64x8<S>>) -> Twin<f64x8<S>> {
        integers(streams).times_plus(Twin::splat(simd, self.unit), Twin::splat(simd, self.from))
    }

    #[inline(always)]
    fn met<S: Simd>(self, simd: S, extinction: Twin<f64x8<S>>) -> Met<Twin<f64x8<S>>> {
        let residual = extinction - Twin::splat(simd, self.subtracted);
        let mean_free_path = Twin::splat(simd, 1.0 / self.sampling);
        Met { residual, sampling: Twin::splat(simd, self.sampling), mean_free_path }
    }
}

/// The next two packs of numbers, uniform among the integers below `2^53`.
#[inline(always)]
fn integers<S: Simd>(streams: &mut Xoshiro<u64x8<S>>) -> Twin<f64x8<S>> {
    Twin(streams.integer(), streams.integer())
}

/// What decides; 0 where chance does not.
#[inline(always)]
fn decisions<S: Simd, R: Collision>(simd: S, streams: &mut Xoshiro<u64x8<S>>) -> Twin<f64x8<S>> {
    if R::DECIDES { integers(streams) * SCALE } else { Twin::splat(simd, 0.0) }
}

impl<R: Collision> Task for Layer<'_, R> {
    type Output = (usize, bool);

    /// Answers how many have survived, and whether some residual was no number.
    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) -> (usize, bool) {
        let is_inlined = const { pack::is_one_register::<S>() && !(R::DECIDES && R::WEIGHS) };
        let is_unknown = match (self.medium.single_value(), self.medium.inlined()) {
            (Some(value), _) => self.through_one_value(simd, value),
            (None, Some(Inlined::Eq21(field))) if is_inlined => self.through(simd, field),
            _ => self.through_calls(simd),
        };
        (self.weights.survivors, is_unknown)
    }
}

/// Each answers whether some residual was no number.
impl<R: Collision> Layer<'_, R> {
    #[inline(always)]
    fn through_one_value<S: Simd>(&mut self, simd: S, value: f64) -> bool {
        let (common, count) = (self.common, self.weights.values.len());
        let mut deciding = self.streams.decisions.awake(simd);
        self.weights.collide(
            simd,
            self.rule,
            0,
            count,
            #[inline(always)]
            |_| {
                let met = common.met(simd, Twin::splat(simd, value));
                Collisions { met, decision: decisions::<S, R>(simd, &mut deciding) }
            },
        )
    }

    /// A field whose formula is in the loop.
    #[inline(always)]
    fn through<S: Simd>(&mut self, simd: S, field: &impl Extinction) -> bool {
        let (common, count) = (self.common, self.weights.values.len());
        let mut placing = self.streams.places.awake(simd);
        let mut deciding = self.streams.decisions.awake(simd);
        // Found while the lookups before are made.
        let mut next = (common.places(simd, &mut placing), decisions::<S, R>(simd, &mut deciding));
        self.weights.collide(
            simd,
            self.rule,
            0,
            count,
            #[inline(always)]
            |_| {
                let (t, decision) = next;
                next = (common.places(simd, &mut placing), decisions::<S, R>(simd, &mut deciding));
                Collisions { met: common.met(simd, field.extinction(t)), decision }
            },
        )
    }

    /// Any field, a call for a batch.
    #[inline(always)]
    fn through_calls<S: Simd>(&mut self, simd: S) -> bool {
        let (common, count) = (self.common, self.weights.values.len());
        let mut placing = self.streams.places.awake(simd);
        let mut deciding = self.streams.decisions.awake(simd);
        let mut is_unknown = false;
        let mut looked_up = [[0.0; PAIR]; PER_CALL / PAIR];
        for first in (0..count).step_by(PER_CALL) {
            let many = PER_CALL.min(count - first);
            let batch = &mut looked_up[..many.div_ceil(PAIR)];
            for pair in &mut *batch {
                common.places(simd, &mut placing).store_slice(pair);
            }
            self.medium.replace_all(batch.as_flattened_mut());
            is_unknown |= self.weights.collide(
                simd,
                self.rule,
                first,
                many,
                #[inline(always)]
                |from| {
                    let met = common.met(simd, Twin::from_slice(simd, &batch[from / PAIR]));
                    Collisions { met, decision: decisions::<S, R>(simd, &mut deciding) }
                },
            );
        }
        is_unknown
    }
}
