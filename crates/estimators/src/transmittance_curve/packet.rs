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

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use crate::kernels::packet::bank::{self, Numbers, Particles, Slot, Slots};
use crate::kernels::packet::product::Subtracted;
use crate::kernels::packet::{Request, pays};

use crate::kernels::walk::Invariant;
use crate::{DrawBuffer, Setup};
use media::Lookups;
use media::course::{Course, Even, Pieces};
use numeric::Lane;
use numeric::pack::{self, Task, WIDTH};
use theory::problems::TransmittanceCurve;
use theory::problems::transmittance_curve::MOST;

/// The draws of a curve, on the hardware of a level; a request is handed back where the hardware is too
/// narrow or one draw after the other is faster.
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
            pack::outlined(
                simd,
                #[inline(always)]
                move || walk(simd, setup, medium, Even::new(simd, even), request),
            );
        } else {
            pack::outlined(
                simd,
                #[inline(always)]
                move || walk(simd, setup, medium, Pieces::new(simd, &setup.sampling), request),
            );
        }
    }
}

#[inline(always)]
fn walk<S: Simd, C: Course<S> + Copy>(
    simd: S,
    setup: &Setup<TransmittanceCurve>,
    medium: &Lookups,
    course: C,
    request: Request,
) {
    let from = f64x8::splat(simd, setup.sampling.begin().t);
    let one = from.each(1.0);
    let fresh = AlongCurve {
        setup,
        control: Subtracted::new(simd, &setup.control),
        from,
        course,
        inside: mask64x8::splat(simd, true),
        t: from,
        weight: one,
        ahead: [one; MOST],
        invariant: Invariant::open(one),
    };
    bank::run(
        simd,
        #[inline(always)]
        |_| fresh,
        [fresh.from; 2],
        #[inline(always)]
        |places, found| bank::extinctions(simd, medium, places, found),
        request,
    );
}

/// Eight walks along the ray of a curve.
#[derive(Clone, Copy)]
struct AlongCurve<'a, S: Simd, C> {
    setup: &'a Setup<TransmittanceCurve>,
    control: Subtracted<'a, S>,
    from: f64x8<S>,
    course: C,
    inside: mask64x8<S>,
    t: f64x8<S>,
    weight: f64x8<S>,
    /// The weight with which each distance was last ahead.
    ahead: [f64x8<S>; MOST],
    invariant: Invariant<f64x8<S>>,
}

impl<S: Simd, C: Course<S>> Particles<S> for AlongCurve<'_, S, C> {
    type Found = f64x8<S>;

    #[inline(always)]
    fn fly(&mut self, numbers: &mut Numbers<S>) -> f64x8<S> {
        self.inside = self.course.fly(-numbers.ln_uniform());
        // Beyond the end there is no field to look at.
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    #[inline(always)]
    fn collide(&mut self, &extinction: &f64x8<S>, _: &mut Numbers<S>) -> u64 {
        let (inside, weight, invariant) = (self.inside, self.weight, self.invariant);
        let residual = extinction - self.control.at(self.t);
        let due = weight.each(1.0) - residual * self.course.mean_free_path();
        let mut after = invariant;
        after.take(weight, due);
        self.invariant.taken = Lane::select(inside, after.taken, invariant.taken);
        self.invariant.scale = Lane::select(inside, after.scale, invariant.scale);
        self.weight = Lane::select(inside, weight * due, weight);
        let t = Lane::select(inside, self.t, weight.each(f64::INFINITY));
        for (number, &distance) in self.setup.problem.ascending().iter().enumerate() {
            let ahead = &mut self.ahead[number];
            *ahead = Lane::select(t.below(t.each(distance)), self.weight, *ahead);
        }
        (!inside).to_bitmask()
    }

    #[inline(always)]
    fn collect(&self, ended: u64, slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let none = [0.0; WIDTH];
        let mut ends = Ends { values: [none; MOST], weight: none, taken: none, scale: none };
        for (number, &control) in self.setup.control_curve.iter().enumerate() {
            (self.ahead[number] * control).store_slice(&mut ends.values[number]);
        }
        self.weight.store_slice(&mut ends.weight);
        self.invariant.taken.store_slice(&mut ends.taken);
        self.invariant.scale.store_slice(&mut ends.scale);
        ends.collect(slots, ended, buffer)
    }

    #[inline(always)]
    fn restart(&mut self, _: &mut Numbers<S>) {
        let (inside, one) = (self.inside, self.from.each(1.0));
        let fresh = Invariant::open(one);
        self.invariant.taken = Lane::select(inside, self.invariant.taken, fresh.taken);
        self.invariant.scale = Lane::select(inside, self.invariant.scale, fresh.scale);
        self.weight = Lane::select(inside, self.weight, one);
        // To a walk that begins all distances are ahead.
        for ahead in &mut self.ahead {
            *ahead = Lane::select(inside, *ahead, one);
        }
        self.course.restart(!inside);
    }
}

/// What eight walks have come to: the curve, what is carried and what collisions took.
#[repr(align(64))]
struct Ends {
    values: [[f64; WIDTH]; MOST],
    weight: [f64; WIDTH],
    taken: [f64; WIDTH],
    scale: [f64; WIDTH],
}

impl Ends {
    /// Makes draws of those that ended.
    #[inline(never)]
    fn collect(&self, slots: &mut Slots, ended: u64, buffer: &mut DrawBuffer) -> u64 {
        slots.fill(ended, |Slot { lane, draw, steps }| {
            for (number, channel) in buffer.values.iter_mut().enumerate() {
                channel[draw] = self.values[number][lane];
            }
            let (taken, scale) = (self.taken[lane], self.scale[lane]);
            let invariant = Invariant { begin: 1.0, taken, scale };
            buffer.defects[draw] = invariant.defect(self.weight[lane]);
            // The step that leaves looks at nothing.
            buffer.lookups[draw] = steps;
        })
    }
}
