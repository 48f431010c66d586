//! The packet kernel of walks that keep their weight until they are killed: Woodcock tracking.
//!
//! Specification: as [`super::product`], where every ratio r is in `[0, 1]`; where one is not, the walks
//! say so, and their draws are of no use.
//!
//! With `0 ≤ r ≤ 1` the chance to go on is `q = 1 − r`, and what is due to a survivor is `(1 − r)/q = 1`:
//! it hands nothing over, and its books show what they showed at the beginning. So none are kept, and a
//! step notes nothing but who ended.

use fearless_simd::{Simd, SimdMask, mask64x8};

use super::product::{Site, Subtracted};
use super::{Ends, Numbers, Walks, ends};
use crate::estimators::ledger::{Reader, Row};
use crate::estimators::rules::Collision;
use crate::estimators::walk::Books;
use crate::media::{Course, Extinction};
use crate::numeric::Lane;

/// The walks.
pub(super) struct Survivals<'a, S: Simd, M, R, K, C> {
    site: Site<'a, S, M, R, K>,
    course: C,
    /// Where every ratio so far was in `[0, 1]`.
    balanced: mask64x8<S>,
}

impl<'a, S: Simd, M, R, K, C> Survivals<'a, S, M, R, K, C> {
    #[inline(always)]
    pub(super) fn new(site: Site<'a, S, M, R, K>, course: C) -> Self {
        let zero = site.zero();
        Self { site, course, balanced: zero.at_most(zero) }
    }
}

impl<S, M, R, K, C> Walks<S> for Survivals<'_, S, M, R, K, C>
where
    S: Simd,
    M: Extinction,
    R: Collision,
    K: Subtracted<S>,
    C: Course<S>,
{
    type Reader = Survivors;

    #[inline(always)]
    fn reader(&self) -> Survivors {
        let begin = self.site.begin;
        Survivors { begin, defect: Books::open(begin).defect(begin) }
    }

    #[inline(always)]
    fn step(&mut self, numbers: Numbers<S>, _: &mut Row) -> Ends {
        let inside = self.course.fly(numbers.depth);
        let met = self.site.met(&self.course);
        let (zero, residual) = (met.residual.each(0.0), met.residual);
        self.balanced &= !inside | (zero.at_most(residual) & residual.at_most(met.sampling));
        let goes_on = inside & !self.site.rule.kills(&met, numbers.decision);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }

    /// Whether books would have shown nothing.
    #[inline(always)]
    fn are_sound(&self) -> bool {
        self.balanced.all_true()
    }
}

/// Reads who survived.
pub(super) struct Survivors {
    begin: f64,
    defect: f64,
}

impl Reader for Survivors {
    const DECIDES: bool = true;

    #[inline(always)]
    fn draw(&self, _: &Row, _: usize, escaped: bool) -> (f64, f64) {
        (if escaped { self.begin } else { 0.0 }, self.defect)
    }
}
