//! The packet kernel of decomposition tracking.
//!
//! Specification: draw j is, bit for bit, the draw that the page `transmittance/decomposition` makes from
//! stream j mod 16. The first step of each walk is the control's flight, which looks at nothing.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Ends, Numbers, Request, Walks, ends, pays, run};
use crate::kernels::packet::event_queue::{Reader, Row};
use crate::setup::Setup;
use media::course::{Course, Even, Pieces};
use media::{Control, Lookups, Piecewise};
use numeric::pack::{self, Task};
use numeric::{Lane, Span};
use theory::problems::Problem;

/// The draws of decomposition tracking beside a constant control, on the hardware of a level; a request
/// is handed back where the hardware is too narrow or one draw after the other is faster.
pub fn decomposition<'a, P: Problem>(
    level: Level,
    setup: &Setup<P>,
    control: f64,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays(medium, &setup.sampling, &Control::None) {
        return Some(request);
    }
    let (support, sampling) = (setup.mesh.support(), &setup.sampling);
    let survivor = Lane::exp(setup.log_unit);
    let task = Decomposition { sampling, support, control, survivor, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct Decomposition<'a, 'r> {
    sampling: &'a Piecewise,
    support: Span,
    control: f64,
    survivor: f64,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Decomposition<'_, '_> {
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

impl Decomposition<'_, '_> {
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
            || Residuals {
                control,
                path,
                from,
                course,
                inside: begins,
                t: from,
                begins,
                flown,
                reader,
            },
            #[inline(always)]
            |places| medium.pair(simd, places),
            request,
        );
    }
}

/// The walks through the residual.
struct Residuals<S: Simd, C> {
    control: f64x8<S>,
    path: f64x8<S>,
    from: f64x8<S>,
    course: C,
    inside: mask64x8<S>,
    t: f64x8<S>,
    /// Whose next step is the control's flight.
    begins: mask64x8<S>,
    /// Where the control's flights ended.
    flown: f64x8<S>,
    reader: Survivors,
}

impl<S: Simd, C: Course<S>> Walks<S> for Residuals<S, C> {
    type Reader = Survivors;

    #[inline(always)]
    fn reader(&self) -> Survivors {
        self.reader
    }

    #[inline(always)]
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S> {
        self.inside = self.course.fly(numbers.depth);
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, extinction: f64x8<S>, numbers: &Numbers<S>, row: &mut Row) -> Ends {
        let collides = self.inside & !self.flown.at_most(self.t) & !self.begins;
        let ratio = (extinction - self.control) * self.course.mean_free_path();
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
