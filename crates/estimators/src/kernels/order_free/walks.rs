//! The walks of one order-free request: what becomes of them at its collisions.

use fearless_simd::{Level, Simd, f64x8};
use rand_distr::{Binomial, Distribution};

use super::collisions::{Collisions, Weights};
use super::layer::{Common, Layer};
use super::{BATCH, Sites, Streams};
use crate::kernels::DrawBuffer;
use crate::setup::Setup;
use media::{Control, Lookups, Placement};
use numeric::Twin;
use numeric::pack::{self, Task};
use numeric::rng::Stream;
use numeric::rng::xoshiro::SCALE;
use numeric::twin::PAIR;
use theory::problems::Problem;
use theory::rules::{Collision, Met};

/// Walks with as many collisions behind them, which do not care in which order they came.
pub trait OrderFree {
    /// Whether chance decides what becomes of them at a collision.
    fn decides(&self) -> bool;

    /// How many are on their way to another collision.
    fn walking(&self) -> usize;

    /// Those that have no more than so many collisions escape.
    fn escape(&mut self, layer: u32);

    /// A batch of the others, from number `first` on, meets its collisions.
    fn collide(&mut self, level: Level, sites: &Sites, first: usize);

    /// All of them meet collisions that nobody shares; `false`, and none has met one, where places have
    /// to be noted first, since σ̂ or the control varies, or the hardware is too narrow to gain by not
    /// noting them.
    fn collide_alone(
        &mut self,
        level: Level,
        medium: &Lookups,
        placement: &Placement,
        streams: Streams,
    ) -> bool;

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
) -> Option<Box<dyn OrderFree + 'a>> {
    Walks::begin(setup, rule, request).map(|walks| Box::new(walks) as Box<dyn OrderFree>)
}

/// The walks of a product estimator.
struct Walks<'a, R> {
    rule: R,
    control: &'a Control,
    /// `σ_c` at the collisions of a batch, written once where it has one value; `None` before the first.
    subtracted: Option<Box<[f64; BATCH]>>,
    /// `σ̂`, where it has one value.
    sampling: Option<f64>,
    hazards: Hazards,
    counts: &'a mut Stream,
    /// The weights; those of the walks on their way come first.
    weights: &'a mut [f64],
    lookups: &'a mut [u32],
    walking: usize,
    survivors: usize,
    /// Whether some residual was no number.
    is_unknown: bool,
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
            subtracted: None,
            sampling: placement.single_value(),
            hazards: Hazards::new(placement.depth()),
            counts,
            weights,
            lookups,
            walking: count,
            survivors: 0,
            is_unknown: false,
        })
    }
}

impl<R: Collision> Walks<'_, R> {
    /// So many are still on their way.
    fn go_on(&mut self, walking: usize) {
        self.walking = walking;
        // Weights that stay say nothing of residuals that are no numbers: one draw does.
        if walking == 0
            && self.is_unknown
            && let Some(weight) = self.weights.first_mut()
        {
            *weight = f64::NAN;
        }
    }
}

impl<R: Collision> OrderFree for Walks<'_, R> {
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
        self.survivors = 0;
        self.go_on(left);
    }

    fn collide(&mut self, level: Level, sites: &Sites, first: usize) {
        let count = sites.length.min(self.walking.saturating_sub(first));
        if count == 0 {
            return;
        }
        let single = self.control.single_value();
        let subtracted =
            self.subtracted.get_or_insert_with(|| Box::new([single.unwrap_or_default(); BATCH]));
        if single.is_none() {
            let length = sites.length;
            self.control.look_up(level, &sites.t[..length], &mut subtracted[..length]);
        }
        let batch = Batch {
            rule: &self.rule,
            sites,
            subtracted,
            sampling: self.sampling,
            weights: Weights {
                values: &mut self.weights[..self.walking],
                survivors: self.survivors,
            },
            first,
            count,
        };
        let is_unknown;
        (self.survivors, is_unknown) = pack::on(level, batch);
        self.is_unknown |= is_unknown;
    }

    fn collide_alone(
        &mut self,
        level: Level,
        medium: &Lookups,
        placement: &Placement,
        streams: Streams,
    ) -> bool {
        let (Some([from, length, sampling]), Some(subtracted)) =
            (placement.plain(), self.control.single_value())
        else {
            return false;
        };
        let unit = length * SCALE;
        if !unit.is_normal() {
            return false; // It would have lost digits.
        }
        let weights = Weights { values: &mut self.weights[..self.walking], survivors: 0 };
        let common = Common { from, unit, sampling, subtracted };
        let layer = Layer { rule: &self.rule, medium, common, streams, weights };
        let Ok((survivors, is_unknown)) = pack::on_wide(level, layer) else { return false };
        self.survivors = survivors;
        self.is_unknown |= is_unknown;
        true
    }

    fn close(&mut self, layer: u32) {
        self.weights[self.survivors..self.walking].fill(0.0);
        self.lookups[self.survivors..self.walking].fill(layer + 1);
        self.go_on(self.survivors);
    }
}

/// The walks of a batch, the first of which is number `first`, and its collisions.
struct Batch<'a, R> {
    rule: &'a R,
    sites: &'a Sites,
    subtracted: &'a [f64; BATCH],
    sampling: Option<f64>,
    weights: Weights<'a>,
    first: usize,
    count: usize,
}

#[inline(always)]
fn pair<S: Simd>(simd: S, row: &[f64; BATCH], number: usize) -> Twin<f64x8<S>> {
    let (pairs, _) = row.as_chunks();
    Twin::from_slice(simd, &pairs[number])
}

impl<R: Collision> Task for Batch<'_, R> {
    type Output = (usize, bool);

    /// Answers how many have survived, with those before, and whether some residual was no number.
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> (usize, bool) {
        let Self { rule, sites, subtracted, sampling: single, mut weights, first, count } = self;
        let one = Twin::splat(simd, 1.0);
        let sampling = Twin::splat(simd, single.unwrap_or(1.0));
        let mean_free_path = one / sampling;
        let is_unknown = weights.collide(
            simd,
            rule,
            first,
            count,
            #[inline(always)]
            |from| {
                let number = from / PAIR;
                let residual =
                    pair(simd, &sites.extinction, number) - pair(simd, subtracted, number);
                let met = if single.is_some() {
                    Met { residual, sampling, mean_free_path }
                } else {
                    let sampling = pair(simd, &sites.sampling, number);
                    Met { residual, sampling, mean_free_path: one / sampling }
                };
                Collisions { met, decision: pair(simd, &sites.decision, number) }
            },
        );
        (weights.survivors, is_unknown)
    }
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
