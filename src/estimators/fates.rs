//! What becomes of order-free walks at a pack of collisions.

use std::ops::Range;

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::rules::Collision;
use crate::numeric::Lane;
use crate::numeric::pack::WIDTH;

/// The bits of a whole pack.
const ALL: u64 = (1 << WIDTH) - 1;

/// What the walks of a pack meet.
pub struct Collisions<S: Simd> {
    /// `σ_t − σ_c`.
    pub residual: f64x8<S>,
    /// `1/σ̂`.
    pub mean_free_path: f64x8<S>,
    /// Numbers in `[0, 1)`, not looked at where chance does not decide.
    pub decision: f64x8<S>,
}

/// What becomes of them.
struct Fates<S: Simd> {
    weight: f64x8<S>,
    /// Who survives, as bits.
    survived: u64,
    /// Whose ratio is a number.
    known: mask64x8<S>,
}

impl<S: Simd> Collisions<S> {
    /// By a rule, of walks that come with these weights. A ratio that is no number makes a draw none, and
    /// where weights change its walk survives to show it.
    #[inline(always)]
    fn decide<R: Collision>(&self, rule: &R, weight: f64x8<S>) -> Fates<S> {
        let ratio = self.residual * self.mean_free_path;
        let known = ratio.at_most(ratio);
        let weighed = rule.weigh(weight, self.residual, self.mean_free_path);
        if !R::DECIDES {
            return Fates { weight: weighed, survived: ALL, known };
        }
        let survives = rule.survives(ratio, self.decision);
        if !R::WEIGHS {
            return Fates { weight: weighed, survived: survives.to_bitmask(), known };
        }
        let survived = (survives | !known).to_bitmask();
        Fates { weight: Lane::select(known, weighed, ratio), survived, known }
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
        rule: &R,
        first: usize,
        count: usize,
        mut collisions: impl FnMut(usize) -> Collisions<S>,
    ) {
        let whole = count / WIDTH * WIDTH;
        let mut known = mask64x8::splat(simd, true);
        for from in (0..whole).step_by(WIDTH) {
            known &= self.meet_pack(simd, rule, first + from, &collisions(from));
        }
        let mut unknown = !known.all_true();
        if whole < count {
            unknown |=
                self.meet_last(simd, rule, first + whole..first + count, &collisions(whole)) != 0;
        }
        // Weights that stay say nothing of ratios that are no number: one survivor does.
        if R::DECIDES
            && !R::WEIGHS
            && unknown
            && let Some(weight) = self.weights.first_mut()
        {
            *weight = f64::NAN;
            self.survivors = self.survivors.max(1);
        }
    }

    /// Answers whose ratio is a number.
    #[inline(always)]
    fn meet_pack<S: Simd, R: Collision>(
        &mut self,
        simd: S,
        rule: &R,
        from: usize,
        collisions: &Collisions<S>,
    ) -> mask64x8<S> {
        if R::DECIDES && !R::WEIGHS {
            // They have the weight that they began with.
            let fates = collisions.decide(rule, f64x8::splat(simd, 1.0));
            self.survivors += fates.survived.count_ones() as usize;
            return fates.known;
        }
        let Some(places) = self.weights.get_mut(from..from + WIDTH) else {
            return mask64x8::splat(simd, false);
        };
        let fates = collisions.decide(rule, f64x8::from_slice(simd, places));
        if R::DECIDES {
            let mut pack = [0.0; WIDTH];
            fates.weight.store_slice(&mut pack);
            self.keep(&pack, fates.survived);
        } else {
            fates.weight.store_slice(places);
            self.survivors += WIDTH;
        }
        fates.known
    }

    /// The last of them do not fill a pack. Answers whose ratio is no number, as bits.
    #[inline(always)]
    fn meet_last<S: Simd, R: Collision>(
        &mut self,
        simd: S,
        rule: &R,
        walks: Range<usize>,
        collisions: &Collisions<S>,
    ) -> u64 {
        let mut pack = [0.0; WIDTH];
        let last = &self.weights[walks];
        pack[..last.len()].copy_from_slice(last);
        let there = (1 << last.len()) - 1;
        let fates = collisions.decide(rule, f64x8::from_slice(simd, &pack));
        fates.weight.store_slice(&mut pack);
        self.keep(&pack, fates.survived & there);
        (!fates.known).to_bitmask() & there
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

#[cfg(test)]
mod tests {
    use fearless_simd::Level;

    use super::*;
    use crate::estimators::rules::{Null, Single, Weight};
    use crate::numeric::pack::{Task, on};

    /// Twenty walks of weight 1 at collisions with ratio ¼, but for one; the number ½ decides.
    struct Twenty<R>(R, usize, f64);

    impl<R: Collision> Task for Twenty<R> {
        type Output = Vec<f64>;

        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Vec<f64> {
            let Self(rule, odd, value) = self;
            let mut weights = [1.0; 20];
            let mut flock = Flock { weights: &mut weights, survivors: 0 };
            flock.meet(
                simd,
                &rule,
                0,
                20,
                #[inline(always)]
                |from| {
                    let at = |lane| if from + lane == odd { value } else { 0.5 };
                    let residual = f64x8::from_slice(simd, &std::array::from_fn::<_, WIDTH, _>(at));
                    let half = f64x8::splat(simd, 0.5);
                    Collisions { residual, mean_free_path: half, decision: half }
                },
            );
            flock.weights[..flock.survivors].to_vec()
        }
    }

    #[test]
    fn walks_are_weighed_and_killed_by_their_ratio() {
        for level in [Level::new(), Level::baseline()] {
            for odd in [3, 17] {
                let mut weighed = [0.75; 20];
                weighed[odd] = -1.0;
                assert_eq!(on(level, Twenty(Weight, odd, 4.0)), weighed);
                assert_eq!(on(level, Twenty(Null, odd, 4.0)), [1.0; 19]);
                let single = on(level, Twenty(Single::Clamped, odd, 4.0));
                assert_eq!((single.len(), single.iter().sum::<f64>()), (20, 18.0));
            }
        }
    }

    #[test]
    fn a_ratio_that_is_no_number_shows() {
        let shows = |weights: Vec<f64>| weights.iter().any(|weight| weight.is_nan());
        for level in [Level::new(), Level::baseline()] {
            for odd in [0, 13, 19] {
                assert!(shows(on(level, Twenty(Null, odd, f64::NAN))));
                assert!(shows(on(level, Twenty(Weight, odd, f64::NAN))));
                assert!(shows(on(level, Twenty(Single::Clamped, odd, f64::NAN))));
            }
        }
    }
}
