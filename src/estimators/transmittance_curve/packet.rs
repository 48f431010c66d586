//! Eight curves side by side: the packet kernel of [`super::double`].
//!
//! Specification: draw j is, bit for bit, the draw that `transmittance_curve/double` makes from stream
//! j mod 16.
//!
//! A collision at t changes the weight at all distances beyond it, whether the walk has passed those
//! before it or not: what is kept of a distance is the weight with which it was last ahead.
//!
//! ```text
//! w ← w (1 − r(t));  w_k ← w  where t < s_k;  at the end T̂(s_k) = T_c(s_k) w_k
//! ```
//!
//! So a step has no branch for the distances that it passes.

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};

use crate::estimators::packet::product::Subtracted;
use crate::estimators::packet::{Request, pays};
use crate::estimators::places::{self, Place, Places};
use crate::estimators::walk::Books;
use crate::estimators::{DrawBuffer, Setup};
use crate::media::course::{Course, Even, Pieces};
use crate::media::{Extinction, Lookups};
use crate::numeric::Lane;
use crate::numeric::pack::{self, Task, WIDTH};
use crate::problems::TransmittanceCurve;
use crate::problems::transmittance_curve::MOST;
use crate::rng::LANES;

/// The draws of a curve, on the hardware of a level; a request is handed back where the hardware is too
/// narrow or one draw after the other is faster.
#[must_use]
pub fn curve<'a>(
    level: Level,
    setup: &Setup<TransmittanceCurve>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays(medium, &setup.sampling, &setup.control) {
        return Some(request);
    }
    pack::on_wide(level, Curves { setup, medium, request }).err().map(|task| task.request)
}

struct Curves<'a, 'r> {
    setup: &'a Setup<TransmittanceCurve>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for Curves<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { setup, medium, request } = self;
        if let Some(even) = setup.sampling.even() {
            walk(simd, setup, medium, Even::new(simd, even), request);
        } else {
            walk(simd, setup, medium, Pieces::new(simd, &setup.sampling), request);
        }
    }
}

/// Walks until every lane has made its draws.
#[inline(always)]
fn walk<S: Simd, C: Course<S> + Copy>(
    simd: S,
    setup: &Setup<TransmittanceCurve>,
    medium: &Lookups,
    course: C,
    request: Request,
) {
    let Request { streams, count, buffer } = request;
    let control = Subtracted::new(simd, &setup.control);
    let distances = setup.problem.ascending();
    let from = f64x8::splat(simd, setup.sampling.begin().t);
    let nowhere = f64x8::splat(simd, f64::NEG_INFINITY);
    buffer.make_room(count);
    for (pack, lanes) in streams.packs().iter().enumerate() {
        let mut course = course;
        let (mut weight, mut ahead) = (from.each(1.0), [from.each(1.0); MOST]);
        let mut books = Books::open(weight);
        let mut numbers = lanes.awake(simd);
        let mut places = Places::new(count, streams.turn, pack);
        while places.are_open() {
            let inside = course.fly(-numbers.ln_uniform());
            // Beyond the end there is no field to look at.
            let t = Lane::select(inside, course.reached(), from);
            let residual = medium.extinction(t) - control.at(t);
            let due = weight.each(1.0) - residual * course.mean_free_path();
            let ended = (!inside).to_bitmask();
            if ended != 0 {
                let mut ends = Ends::default();
                for ((end, ahead), control) in
                    ends.values.iter_mut().zip(ahead).zip(&setup.control_curve)
                {
                    (ahead * *control).store_slice(end);
                }
                weight.store_slice(&mut ends.weight);
                books.handed_over.store_slice(&mut ends.handed_over);
                books.turnover.store_slice(&mut ends.turnover);
                let over = ends.collect(&mut places, ended, buffer);
                places::leave(streams, pack, over, numbers);
            }
            places.step();
            books.hand_over(weight, due);
            let fresh = Books::open(from.each(1.0));
            books.handed_over = Lane::select(inside, books.handed_over, fresh.handed_over);
            books.turnover = Lane::select(inside, books.turnover, fresh.turnover);
            weight = Lane::select(inside, weight * due, fresh.begin);
            // To a walk that begins all distances are ahead.
            let t = Lane::select(inside, t, nowhere);
            for (ahead, &distance) in ahead.iter_mut().zip(distances) {
                *ahead = Lane::select(t.below(t.each(distance)), weight, *ahead);
            }
            course.restart(!inside);
        }
    }
    streams.turn = (streams.turn + count) % LANES;
}

/// What eight walks have come to: the curve, what is carried and what was handed over.
#[derive(Default)]
#[repr(align(64))]
struct Ends {
    values: [[f64; WIDTH]; MOST],
    weight: [f64; WIDTH],
    handed_over: [f64; WIDTH],
    turnover: [f64; WIDTH],
}

impl Ends {
    /// Makes draws of the walks in some places.
    #[inline(never)]
    fn collect(&self, places: &mut Places, ended: u64, buffer: &mut DrawBuffer) -> u64 {
        places.fill(ended, |Place { lane, draw, steps }| {
            for (channel, values) in buffer.values.iter_mut().zip(&self.values) {
                channel[draw] = values[lane];
            }
            let (handed_over, turnover) = (self.handed_over[lane], self.turnover[lane]);
            let books = Books { begin: 1.0, handed_over, turnover };
            buffer.defects[draw] = books.defect(self.weight[lane]);
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps;
        })
    }
}
