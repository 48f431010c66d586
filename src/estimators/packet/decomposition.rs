//! The packet kernel of decomposition tracking.
//!
//! Specification: draw j is, bit for bit, the draw that the page `transmittance/decomposition` makes from
//! stream j mod 16. The first step of each walk is the control's flight, which looks at nothing.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Ends, Numbers, Request, Walks, ends, pays, run};
use crate::estimators::Setup;
use crate::estimators::ledger::{Reader, Row};
use crate::media::course::{Course, Even, Pieces};
use crate::media::{Control, Extinction, Piecewise};
use crate::numeric::pack::{self, Task};
use crate::numeric::{Lane, Span};
use crate::problems::Problem;

/// The draws of decomposition tracking beside a constant control, on the hardware of a level; a request
/// is handed back where the hardware is too narrow or one draw after the other is faster.
pub fn decomposition<'a, P: Problem, M: Extinction>(
    level: Level,
    setup: &Setup<P>,
    control: f64,
    medium: &M,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays::<M>(&setup.sampling, &Control::None) {
        return Some(request);
    }
    let (support, sampling) = (setup.mesh.support(), &setup.sampling);
    let survivor = Lane::exp(setup.log_unit);
    let task = Decomposition { sampling, support, control, survivor, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Decomposition<'a, 'r, M> {
    sampling: &'a Piecewise,
    support: Span,
    control: f64,
    survivor: f64,
    medium: &'a M,
    request: Request<'r>,
}

impl<M: Extinction> Task for Decomposition<'_, '_, M> {
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

impl<M: Extinction> Decomposition<'_, '_, M> {
    #[inline(always)]
    fn along<S: Simd, C: Course<S> + Copy>(self, simd: S, course: C) {
        let Self { support, control, survivor, medium, request, .. } = self;
        let from = f64x8::splat(simd, support.from);
        let path = f64x8::splat(simd, 1.0 / control);
        let control = f64x8::splat(simd, control);
        let (begins, flown) = (mask64x8::splat(simd, true), from);
        let reader = Survivors { end: support.to, survivor };
        run(
            simd,
            #[inline(always)]
            || Residuals { medium, control, path, from, course, begins, flown, reader },
            request,
        );
    }
}

/// The walks through the residual.
struct Residuals<'a, S: Simd, M, C> {
    medium: &'a M,
    control: f64x8<S>,
    path: f64x8<S>,
    from: f64x8<S>,
    course: C,
    /// Whose next step is the control's flight.
    begins: mask64x8<S>,
    /// Where the control's flights ended.
    flown: f64x8<S>,
    reader: Survivors,
}

impl<S: Simd, M: Extinction, C: Course<S>> Walks<S> for Residuals<'_, S, M, C> {
    type Reader = Survivors;

    #[inline(always)]
    fn reader(&self) -> Survivors {
        self.reader
    }

    #[inline(always)]
    fn step(&mut self, numbers: Numbers<S>, row: &mut Row) -> Ends {
        let inside = self.course.fly(numbers.depth);
        let t = Lane::select(inside, self.course.reached(), self.from);
        let collides = inside & !self.flown.at_most(t) & !self.begins;
        let ratio = (self.medium.extinction(t) - self.control) * self.course.mean_free_path();
        let killed = numbers.decision.below(ratio);
        self.flown.store_slice(&mut row.0[0]);
        let control_flight = numbers.depth.times_plus(self.path, self.from);
        self.flown = Lane::select(self.begins, control_flight, self.flown);
        let goes_on = self.begins | (collides & !killed);
        self.course.restart(self.begins | !goes_on);
        self.begins = !goes_on;
        ends(collides, goes_on)
    }
}

/// Reads who passed.
#[derive(Clone, Copy)]
struct Survivors {
    end: f64,
    survivor: f64,
}

impl Reader for Survivors {
    const DECIDES: bool = true;

    #[inline(always)]
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64) {
        let stopped = row.0[0][lane] < self.end;
        (if escaped && !stopped { self.survivor } else { 0.0 }, 0.0)
    }

    #[inline(always)]
    fn lookups(&self, _: &Row, _: usize, steps: u32) -> u32 {
        steps - 1
    }
}
