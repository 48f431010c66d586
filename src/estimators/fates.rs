//! What becomes of order-free walks at a pack of collisions.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8};

use super::rules::Collision;
use crate::numeric::Lane;
use crate::numeric::pack::WIDTH;

/// The bits of a whole pack.
const ALL: u64 = (1 << WIDTH) - 1;

/// What becomes of the walks of a pack.
pub struct Fates<S: Simd> {
    /// The factors of their weights.
    factor: f64x8<S>,
    /// Who survives, as bits.
    survived: u64,
    /// Whose ratio is no number, as bits.
    unknown: u64,
}

impl<S: Simd> Fates<S> {
    /// By a rule, at collisions with these ratios, and by numbers in `[0, 1)` where chance decides.
    #[inline(always)]
    pub fn new<R: Collision>(rule: &R, ratio: f64x8<S>, numbers: f64x8<S>) -> Self {
        let outcome = rule.at(ratio);
        if !R::DECIDES {
            return Self { factor: outcome.weight, survived: ALL, unknown: 0 };
        }
        // A ratio that is no number makes the draw none: its walk survives to show it.
        let known = ratio.at_most(ratio);
        let unknown = ALL & !known.to_bitmask();
        let survived = rule.survives(ratio, numbers).to_bitmask() | unknown;
        Self { factor: Lane::select(known, outcome.weight, ratio), survived, unknown }
    }
}

/// The weights of walks; those that survived the collisions so far come first.
pub struct Flock<'a> {
    /// All that were walking.
    pub weights: &'a mut [f64],
    /// How many have survived.
    pub survivors: usize,
}

impl Flock<'_> {
    /// So many walks, the first of which is number `first`, meet their collisions, pack by pack.
    #[inline(always)]
    pub fn meet<S: Simd, R: Collision>(
        &mut self,
        simd: S,
        first: usize,
        count: usize,
        mut fates: impl FnMut(usize) -> Fates<S>,
    ) {
        let whole = count / WIDTH * WIDTH;
        for from in (0..whole).step_by(WIDTH) {
            self.meet_pack::<S, R>(simd, first + from, &fates(from));
        }
        if whole < count {
            self.meet_last(simd, first + whole, first + count, &fates(whole));
        }
    }

    #[inline(always)]
    fn meet_pack<S: Simd, R: Collision>(&mut self, simd: S, from: usize, fates: &Fates<S>) {
        if R::DECIDES && !R::WEIGHS {
            // They have the weight that they began with, unless it is no number.
            if fates.unknown != 0
                && let Some(weight) = self.weights.get_mut(self.survivors)
            {
                *weight = f64::NAN;
            }
            self.survivors += fates.survived.count_ones() as usize;
        } else if let Some(places) = self.weights.get_mut(from..from + WIDTH) {
            let weight = f64x8::from_slice(simd, places) * fates.factor;
            if R::DECIDES {
                let mut pack = [0.0; WIDTH];
                weight.store_slice(&mut pack);
                self.keep(&pack, fates.survived);
            } else {
                weight.store_slice(places);
                self.survivors += WIDTH;
            }
        }
    }

    /// The last of them do not fill a pack.
    #[inline(always)]
    fn meet_last<S: Simd>(&mut self, simd: S, from: usize, until: usize, fates: &Fates<S>) {
        let mut pack = [0.0; WIDTH];
        let last = &self.weights[from..until];
        pack[..last.len()].copy_from_slice(last);
        let there = (1 << last.len()) - 1;
        let weight = f64x8::from_slice(simd, &pack) * fates.factor;
        weight.store_slice(&mut pack);
        self.keep(&pack, fates.survived & there);
    }

    /// Writes the survivors of a pack behind those before them.
    #[inline(always)]
    fn keep(&mut self, pack: &[f64; WIDTH], survived: u64) {
        for (lane, &weight) in pack.iter().enumerate() {
            // Each is written over by the next one that survives.
            if let Some(place) = self.weights.get_mut(self.survivors) {
                *place = weight;
            }
            self.survivors += (survived >> lane & 1) as usize;
        }
    }
}
