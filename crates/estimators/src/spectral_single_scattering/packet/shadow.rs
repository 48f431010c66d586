//! Shadow rays of eight walks, through the σ̂ of their heroes.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use crate::kernels::packet::kept::Keep;
use crate::space::exit::{Points, chords, one_by_one, rows};
use media::body::MOST_CHANNELS;
use numeric::Lane;
use numeric::geometry::Bounds;
use numeric::pack::WIDTH;
use numeric::twin::PAIR;
use theory::problems::SingleScattering;

/// Shadow rays on their way.
pub struct Shadows<S: Simd> {
    origin: Points<S>,
    direction: Points<S>,
    /// How far they have come, and where they leave the medium or come to the light.
    t: f64x8<S>,
    end: f64x8<S>,
    /// How long they are in the medium.
    pub length: f64x8<S>,
    /// `Π (1 − r_λ)`.
    pub through: [f64x8<S>; MOST_CHANNELS],
}

impl<S: Simd> Shadows<S> {
    /// None, all of them where the ray enters.
    #[inline(always)]
    pub fn new(lit: &SingleScattering, from: f64x8<S>) -> Self {
        let (origin, direction, _) = lit.to_light(from);
        let (zero, one) = (from.each(0.0), from.each(1.0));
        Self { origin, direction, t: zero, end: zero, length: zero, through: [one; MOST_CHANNELS] }
    }

    /// Some begin at distances along the ray; answers which meet the medium.
    #[inline(always)]
    pub fn cast(
        &mut self,
        keep: Keep<S>,
        lit: &SingleScattering,
        (which, s): (mask64x8<S>, f64x8<S>),
    ) -> mask64x8<S> {
        let ([from, to], [origin, direction]) = inside(lit, which, s);
        for axis in 0..3 {
            keep.put(&mut self.origin[axis], which, origin[axis]);
            keep.put(&mut self.direction[axis], which, direction[axis]);
        }
        keep.put(&mut self.t, which, from);
        keep.put(&mut self.end, which, to);
        keep.put(&mut self.length, which, to - from);
        which & from.below(to)
    }

    /// Those that a mask names fly on; answers which are still in the medium, and writes where.
    #[inline(always)]
    pub fn fly(
        &mut self,
        keep: Keep<S>,
        which: mask64x8<S>,
        flight: f64x8<S>,
        (points, number): (&mut [[f64; PAIR]; 3], usize),
    ) -> mask64x8<S> {
        let t = self.t + flight;
        keep.put(&mut self.t, which, t);
        let inside = which & !self.end.at_most(self.t);
        // Beyond the end there is no field to look at.
        let t = Lane::select(inside, self.t, self.end);
        for (axis, row) in points.iter_mut().enumerate() {
            let place = self.origin[axis] + self.direction[axis] * t;
            place.store_slice(&mut row[number * WIDTH..][..WIDTH]);
        }
        inside
    }
}

/// Where the medium is on shadow rays from distances along the ray, for those that a mask names, and the origins and
/// directions of these: as [`SingleScattering::shadow`].
#[inline(always)]
pub fn inside<S: Simd>(
    lit: &SingleScattering,
    which: mask64x8<S>,
    s: f64x8<S>,
) -> ([f64x8<S>; 2], [Points<S>; 2]) {
    let (origin, direction, distance) = lit.to_light(s);
    let zero = s.each(0.0);
    let bounds = lit.volume().bounds();
    let [from, to] = match bounds {
        Bounds::Everywhere => [zero, distance],
        Bounds::Sphere { centre, radius } => chords(centre, radius, [origin, direction], which),
        Bounds::Box(_) => {
            let mut ends = rows([zero, zero, zero]);
            let lines = [rows(origin), rows(direction)];
            one_by_one(&bounds, &lines, which.to_bitmask(), &mut ends);
            let simd = s.token();
            [f64x8::from_slice(simd, &ends[0]), f64x8::from_slice(simd, &ends[1])]
        }
    };
    ([from.or_more(zero), distance.or_less(to)], [origin, direction])
}
