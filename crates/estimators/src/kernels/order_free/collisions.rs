//! What becomes of order-free walks at two packs of collisions.

use std::ops::Range;

use fearless_simd::{Simd, f64x8};

use numeric::twin::PAIR;
use numeric::{Lane, Twin};
use theory::rules::{Collision, Met};

/// The bits of a pair of packs.
const ALL: u64 = (1 << PAIR) - 1;

/// Two packs.
type Packs<S> = Twin<f64x8<S>>;

/// What the walks of two packs meet.
pub struct Collisions<S: Simd> {
    /// The medium, and how often it is looked at.
    pub met: Met<Packs<S>>,
    /// Numbers in `[0, 1)`, not looked at where chance does not decide.
    pub decision: Packs<S>,
}

/// What becomes of them.
struct Outcomes<S: Simd> {
    weight: Packs<S>,
    /// Who survives, as bits.
    survived: u64,
}

impl<S: Simd> Collisions<S> {
    /// By a rule, of walks that come with these weights. One whose residual is no number survives, and where
    /// weights change it shows.
    #[inline(always)]
    fn decide<R: Collision>(&self, rule: &R, weight: Packs<S>) -> Outcomes<S> {
        let weighed = rule.weigh(weight, &self.met);
        if !R::DECIDES {
            return Outcomes { weight: weighed, survived: ALL };
        }
        let survived = ALL & !rule.kills(&self.met, self.decision).to_bitmask();
        let residual = self.met.residual;
        Outcomes { weight: Lane::select(residual.at_most(residual), weighed, residual), survived }
    }
}

/// The weights of walks; those that survived the collisions so far come first.
pub struct Weights<'a> {
    /// All that were walking.
    pub values: &'a mut [f64],
    /// How many have survived.
    pub survivors: usize,
}

impl Weights<'_> {
    /// So many walks, the first of which is number `first`, meet their collisions, two packs at a time; answers
    /// whether some residual was no number. (That some were infinite and of both signs looks the same.)
    #[inline(always)]
    pub fn collide<S: Simd, R: Collision>(
        &mut self,
        simd: S,
        rule: &R,
        first: usize,
        count: usize,
        mut collisions: impl FnMut(usize) -> Collisions<S>,
    ) -> bool {
        let whole = count / PAIR * PAIR;
        let mut sum = Packs::splat(simd, 0.0);
        if R::DECIDES {
            for from in (0..whole).step_by(PAIR) {
                let collisions = collisions(from);
                sum = sum + collisions.met.residual;
                self.decide_packs(simd, rule, first + from, &collisions);
            }
        } else {
            // All of them survive, where they are.
            let (pairs, _) = self.values[first..first + whole].as_chunks_mut();
            for (number, weights) in pairs.iter_mut().enumerate() {
                let collisions = collisions(number * PAIR);
                sum = sum + collisions.met.residual;
                let outcomes = collisions.decide(rule, Packs::from_slice(simd, weights));
                outcomes.weight.store_slice(weights);
            }
            self.survivors += whole;
        }
        let mut is_unknown = is_none(sum) != 0;
        if whole < count {
            let collisions = collisions(whole);
            let there = (1 << (count - whole)) - 1;
            is_unknown |= is_none(collisions.met.residual) & there != 0;
            self.collide_last(simd, rule, first + whole..first + count, &collisions);
        }
        is_unknown
    }

    #[inline(always)]
    fn decide_packs<S: Simd, R: Collision>(
        &mut self,
        simd: S,
        rule: &R,
        from: usize,
        collisions: &Collisions<S>,
    ) {
        if !R::WEIGHS {
            // They have the weight that they began with.
            let outcomes = collisions.decide(rule, Packs::splat(simd, 1.0));
            self.survivors += outcomes.survived.count_ones() as usize;
            return;
        }
        let Some((places, _)) =
            self.values.get_mut(from..).and_then(|rest| rest.split_first_chunk_mut())
        else {
            return;
        };
        let outcomes = collisions.decide(rule, Packs::from_slice(simd, places));
        let mut pair = [0.0; PAIR];
        outcomes.weight.store_slice(&mut pair);
        self.keep(&pair, outcomes.survived);
    }

    /// The last of them do not fill two packs.
    #[inline(always)]
    fn collide_last<S: Simd, R: Collision>(
        &mut self,
        simd: S,
        rule: &R,
        walks: Range<usize>,
        collisions: &Collisions<S>,
    ) {
        let mut pair = [0.0; PAIR];
        let last = &self.values[walks];
        pair[..last.len()].copy_from_slice(last);
        let there = (1 << last.len()) - 1;
        let outcomes = collisions.decide(rule, Packs::from_slice(simd, &pair));
        outcomes.weight.store_slice(&mut pair);
        self.keep(&pair, outcomes.survived & there);
    }

    /// Writes the survivors of two packs behind those before them.
    #[inline(always)]
    fn keep(&mut self, pair: &[f64; PAIR], survived: u64) {
        for (lane, &weight) in pair.iter().enumerate() {
            // Each is written over by the next one that survives.
            if let Some(place) = self.values.get_mut(self.survivors) {
                *place = weight;
            }
            self.survivors += (survived >> lane & 1) as usize;
        }
    }
}

/// Which elements are no numbers, as bits.
#[inline(always)]
fn is_none<S: Simd>(packs: Packs<S>) -> u64 {
    ALL & !packs.at_most(packs).to_bitmask()
}
