//! The packet kernel of the walk that next-flight estimators share.
//!
//! Specification: draw j is, bit for bit, the draw that [`crate::kernels::scoring::walk`] makes from
//! stream j mod 16.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Ends, Numbers, Request, Walks, ends, extinctions, run};
use crate::kernels::packet::event_queue::{Reader, Row};
use crate::kernels::scoring::{Score, Share};
use crate::setup::Setup;
use media::course::{Course, Even};
use media::{Inlined, Lookups, even};
use numeric::pack::{self, Task};
use numeric::{Lane, Twin};

/// The draws of a next-flight estimator, on the hardware of a level; a request is handed back where the
/// hardware is too narrow or σ̂ is not constant.
pub fn score<'a, P, H: Share>(
    level: Level,
    setup: &Setup<P>,
    share: &H,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let (even, value) = (setup.sampling.even(), setup.sampling.single_value());
    let Some(sampling) = even.filter(|_| value.is_some()) else { return Some(request) };
    let unit = setup.control_transmittance;
    let task = Scored { sampling, unit, share, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Scored<'a, 'r, H> {
    sampling: &'a even::Even,
    unit: f64,
    share: &'a H,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl<H: Share> Task for Scored<'_, '_, H> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let medium = self.medium;
        match medium.inlined() {
            Some(Inlined::Eq21(field)) if const { pack::is_one_register::<S>() } => self.along(
                simd,
                #[inline(always)]
                move |places| extinctions(field, places),
            ),
            _ => self.along(
                simd,
                #[inline(always)]
                move |places| medium.pair(simd, places),
            ),
        }
    }
}

impl<H: Share> Scored<'_, '_, H> {
    /// Walks along the ray; `look_up` answers σ_t.
    #[inline(always)]
    fn along<S: Simd>(self, simd: S, look_up: impl Fn(Twin<f64x8<S>>) -> Twin<f64x8<S>> + Copy) {
        let Self { sampling, unit, share, request, .. } = self;
        pack::outlined(
            simd,
            #[inline(always)]
            move || {
                let from = f64x8::splat(simd, sampling.from);
                let end = f64x8::splat(simd, sampling.to);
                let rate = f64x8::splat(simd, sampling.value);
                let fresh = Score::open(share.of((end - from) * rate));
                let (course, inside) = (Even::new(simd, sampling), mask64x8::splat(simd, true));
                run(
                    simd,
                    #[inline(always)]
                    || Scores {
                        share,
                        unit,
                        from,
                        end,
                        rate,
                        course,
                        inside,
                        t: from,
                        fresh,
                        score: fresh,
                    },
                    look_up,
                    request,
                );
            },
        );
    }
}

/// The walks of a next-flight estimator.
struct Scores<'a, S: Simd, H> {
    share: &'a H,
    unit: f64,
    from: f64x8<S>,
    end: f64x8<S>,
    rate: f64x8<S>,
    course: Even<'a, S>,
    inside: mask64x8<S>,
    t: f64x8<S>,
    fresh: Score<f64x8<S>>,
    score: Score<f64x8<S>>,
}

impl<S: Simd, H: Share> Walks<S> for Scores<'_, S, H> {
    type Reader = Totals;

    #[inline(always)]
    fn reader(&self) -> Totals {
        Totals { unit: self.unit }
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S> {
        self.inside = self.course.fly(numbers.depth);
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, extinction: f64x8<S>, _: &Numbers<S>, row: &mut Row) -> Ends {
        let (inside, t) = (self.inside, self.t);
        let ratio = extinction * self.course.mean_free_path();
        let score = self.score;
        score.total::<H>().store_slice(&mut row.0[0]);
        let next = score.collided(ratio, self.share.of((self.end - t) * self.rate));
        self.score.weight = Lane::select(inside, next.weight, self.fresh.weight);
        self.score.last = Lane::select(inside, next.last, self.fresh.last);
        self.score.sum = Lane::select(inside, next.sum, self.fresh.sum);
        self.course.restart(!inside);
        ends(inside, inside)
    }
}

/// Reads scores.
struct Totals {
    unit: f64,
}

impl Reader for Totals {
    const DECIDES: bool = false;

    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, _: bool) -> (f64, f64) {
        (row.0[0][lane] * self.unit, 0.0)
    }
}
