//! The packet kernel of free flights by Woodcock tracking.
//!
//! Specification: draw j is, bit for bit, the draw that the page `free_flight/woodcock` makes from
//! stream j mod 16.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Ends, Numbers, Request, Walks, ends, pays, run};
use crate::kernels::packet::event_queue::{Reader, Row};
use crate::setup::Setup;
use media::course::{Course, Even, Pieces};
use media::{Control, Lookups, Piecewise};
use numeric::pack::{self, Task};
use numeric::{Lane, Span};
use theory::problems::Problem;

/// Free flights by Woodcock tracking, on the hardware of a level, or handed back where one draw after the
/// other is faster.
pub fn flight<'a, P: Problem>(
    level: Level,
    setup: &Setup<P>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays(medium, &setup.sampling, &Control::None) {
        return Some(request);
    }
    let ray = setup.problem.medium().span();
    let task = Flight { sampling: &setup.sampling, ray, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Flight<'a, 'r> {
    sampling: &'a Piecewise,
    ray: Span,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Flight<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let sampling = self.sampling;
        if let Some(even) = sampling.even() {
            pack::outlined(
                simd,
                #[inline(always)]
                move || self.along(simd, Even::new(simd, even)),
            );
        } else {
            pack::outlined(
                simd,
                #[inline(always)]
                move || self.along(simd, Pieces::new(simd, sampling)),
            );
        }
    }
}

impl Flight<'_, '_> {
    #[inline(always)]
    fn along<S: Simd, C: Course<S> + Copy>(self, simd: S, course: C) {
        let Self { sampling, ray, medium, request } = self;
        let from = f64x8::splat(simd, sampling.begin().t);
        run(
            simd,
            #[inline(always)]
            || Flights { ray, course, inside: mask64x8::splat(simd, true), t: from, from },
            #[inline(always)]
            |places| medium.pair(simd, places),
            request,
        );
    }
}

/// The walks of free flights.
struct Flights<S: Simd, C> {
    ray: Span,
    from: f64x8<S>,
    course: C,
    inside: mask64x8<S>,
    t: f64x8<S>,
}

impl<S: Simd, C: Course<S>> Walks<S> for Flights<S, C> {
    type Reader = Distances;

    #[inline(always)]
    fn reader(&self) -> Distances {
        Distances { ray: self.ray }
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S> {
        self.inside = self.course.fly(numbers.depth);
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, extinction: f64x8<S>, numbers: &Numbers<S>, row: &mut Row) -> Ends {
        let ratio = extinction * self.course.mean_free_path();
        let goes_on = self.inside & !numbers.decision.below(ratio);
        self.t.store_slice(&mut row.0[0]);
        self.course.restart(!goes_on);
        ends(self.inside, goes_on)
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
