//! The packet kernel of walks that keep their weight until they are killed: Woodcock tracking.
//!
//! Specification: as [`super::product`], where every ratio r is in `[0, 1]`; where one is not, the walks
//! say so, and their draws are of no use.
//!
//! With `0 ≤ r ≤ 1` the chance to go on is `q = 1 − r`, and what is due to a survivor is `(1 − r)/q = 1`:
//! it hands nothing over, and its invariant shows what it showed at the beginning. So none are kept, and a
//! step notes nothing but who ended.

use fearless_simd::{Simd, SimdMask, f64x8, mask64x8};

use super::product::{Site, met};
use super::{Ends, Numbers, Walks, ends};
use crate::kernels::packet::event_queue::{Reader, Row};
use crate::kernels::walk::Invariant;
use media::Course;
use numeric::Lane;
use theory::rules::Collision;

/// The walks.
pub(super) struct Survivals<'a, S: Simd, R, C> {
    site: Site<'a, R>,
    course: C,
    inside: mask64x8<S>,
    /// Where every ratio so far was in `[0, 1]`.
    balanced: mask64x8<S>,
}

impl<'a, S: Simd, R, C> Survivals<'a, S, R, C> {
    #[inline(always)]
    pub(super) fn new(site: Site<'a, R>, course: C, all: mask64x8<S>) -> Self {
        Self { site, course, inside: all, balanced: all }
    }
}

impl<S: Simd, R: Collision, C: Course<S>> Walks<S> for Survivals<'_, S, R, C> {
    type Reader = Survivors;

    #[inline(always)]
    fn reader(&self) -> Survivors {
        let begin = self.site.begin;
        Survivors { begin, defect: Invariant::open(begin).defect(begin) }
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S> {
        self.inside = self.course.fly(numbers.depth);
        self.course.reached()
    }

    #[inline(always)]
    fn collide(&mut self, residual: f64x8<S>, numbers: &Numbers<S>, _: &mut Row) -> Ends {
        let inside = self.inside;
        let met = met(&self.course, residual);
        let zero = residual.each(0.0);
        self.balanced &= !inside | (zero.at_most(residual) & residual.at_most(met.sampling));
        let goes_on = inside & !self.site.rule.kills(&met, numbers.decision);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }

    /// Whether the invariant would have shown nothing.
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
