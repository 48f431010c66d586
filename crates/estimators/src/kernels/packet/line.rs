//! Walks on and back along a line through σ̂, as particles of a [`bank`]: what rods and slabs share.

use fearless_simd::{Level, Simd, SimdBase, f64x8};

use super::bank::{self, Numbers, Particles};
use super::{Request, pays};
use media::course::{BothWays, Even, Pieces};
use media::{Control, Lookups, Piecewise};
use numeric::pack::{self, Task};

/// How walks along a line begin.
pub trait Walks {
    /// Eight of them on a course.
    type Pack<S: Simd, C: BothWays<f64x8<S>>>: Particles<S, Found = f64x8<S>>;

    /// At the beginning of a course, which lies at a distance.
    fn begin<S: Simd, C: BothWays<f64x8<S>>>(
        &self,
        course: C,
        from: f64x8<S>,
        numbers: &mut Numbers<S>,
    ) -> Self::Pack<S, C>;
}

/// The draws of walks through σ̂, on the hardware of a level; a request is handed back where the hardware is too
/// narrow or one draw after the other is faster.
pub fn walks<'a>(
    level: Level,
    walks: &impl Walks,
    sampling: &Piecewise,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    if !pays(medium, sampling, &Control::None) {
        return Some(request);
    }
    let task = AlongLine { walks, sampling, medium, request };
    pack::on_wide(level, task).err().map(|task| task.request)
}

struct AlongLine<'a, 'r, W> {
    walks: &'a W,
    sampling: &'a Piecewise,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl<W: Walks> Task for AlongLine<'_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let sampling = self.sampling;
        match sampling.even() {
            Some(even) => pack::outlined(
                simd,
                #[inline(always)]
                move || self.through(simd, Even::new(f64x8::splat(simd, 0.0), even)),
            ),
            None => pack::outlined(
                simd,
                #[inline(always)]
                move || self.through(simd, Pieces::new(f64x8::splat(simd, 0.0), sampling)),
            ),
        }
    }
}

impl<W: Walks> AlongLine<'_, '_, W> {
    #[inline(always)]
    fn through<S: Simd, C: BothWays<f64x8<S>>>(self, simd: S, course: C) {
        let Self { walks, sampling, medium, request } = self;
        let from = f64x8::splat(simd, sampling.begin().t);
        bank::run(
            simd,
            #[inline(always)]
            |numbers| walks.begin(course, from, numbers),
            [from; 2],
            #[inline(always)]
            |places, found| bank::extinctions(simd, medium, places, found),
            request,
        );
    }
}
