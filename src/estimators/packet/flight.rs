//! The packet kernel of free flights by Woodcock tracking.
//!
//! Specification: draw j is, bit for bit, the draw that the page `free_flight/woodcock` makes from
//! stream j mod 16.

use fearless_simd::{Level, Simd, SimdBase, f64x8};

use super::{Ends, Numbers, Request, Walks, ends, pays, run};
use crate::estimators::Setup;
use crate::estimators::ledger::{Reader, Row};
use crate::media::course::{Course, Even, Pieces};
use crate::media::{Control, Extinction, Piecewise};
use crate::numeric::pack::{self, Task};
use crate::numeric::{Lane, Span};
use crate::problems::Problem;

/// Free flights by Woodcock tracking, on the hardware of a level, or handed back where one draw after the
/// other is faster.
pub fn flight<'a, P: Problem, M: Extinction>(
    level: Level,
    setup: &Setup<P>,
    medium: &M,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays::<M>(&setup.sampling, &Control::None) {
        return Some(request);
    }
    let ray = setup.problem.medium().span();
    let task = Flight { sampling: &setup.sampling, ray, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Flight<'a, 'r, M> {
    sampling: &'a Piecewise,
    ray: Span,
    medium: &'a M,
    request: Request<'r>,
}

impl<M: Extinction> Task for Flight<'_, '_, M> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let sampling = self.sampling;
        if let Some(even) = sampling.even() {
            self.along(simd, Even::new(simd, even));
        } else {
            self.along(simd, Pieces::new(simd, sampling));
        }
    }
}

impl<M: Extinction> Flight<'_, '_, M> {
    #[inline(always)]
    fn along<S: Simd, C: Course<S> + Copy>(self, simd: S, course: C) {
        let Self { sampling, ray, medium, request } = self;
        let from = f64x8::splat(simd, sampling.begin().t);
        run(
            simd,
            #[inline(always)]
            || Flights { medium, ray, from, course },
            request,
        );
    }
}

/// The walks of free flights.
struct Flights<'a, S: Simd, M, C> {
    medium: &'a M,
    ray: Span,
    from: f64x8<S>,
    course: C,
}

impl<S: Simd, M: Extinction, C: Course<S>> Walks<S> for Flights<'_, S, M, C> {
    type Reader = Distances;

    #[inline(always)]
    fn reader(&self) -> Distances {
        Distances { ray: self.ray }
    }

    #[inline(always)]
    fn step(&mut self, numbers: Numbers<S>, row: &mut Row) -> Ends {
        let inside = self.course.fly(numbers.depth);
        let t = Lane::select(inside, self.course.reached(), self.from);
        let ratio = self.medium.extinction(t) * self.course.mean_free_path();
        let goes_on = inside & !numbers.decision.below(ratio);
        t.store_slice(&mut row.0[0]);
        self.course.restart(!goes_on);
        ends(inside, goes_on)
    }
}

/// Reads distances.
struct Distances {
    ray: Span,
}

impl Reader for Distances {
    const DECIDES: bool = true;

    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64) {
        (if escaped { self.ray.length() } else { row.0[0][lane] - self.ray.from }, 0.0)
    }
}
