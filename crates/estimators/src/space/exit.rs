//! Where eight rays that begin in a body leave it: [`Bounds::clip`] for rays side by side, bit for bit.
//!
//! ```text
//! ball:  foot = (c − o)·d,  offset = |c − o − foot d|,  end = foot + √((R − offset)(R + offset))
//! box:   end = min over the axes of the larger of (low − o)/d and (high − o)/d
//! ```
//!
//! Rays that graze a ball lose digits there: they are clipped in 32 digits.

use std::ops::RangeInclusive;

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::grazing;
use numeric::Lane;
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::pack::{self, WIDTH, fuses};

/// Radii of which no square overflows or underflows, nor what is left of one after 32 digits.
const SIZES: RangeInclusive<f64> = 1e-60..=1e60;

/// Three coordinates of eight points or directions.
pub type Points<S> = [f64x8<S>; 3];

/// The same point in every lane.
#[inline(always)]
pub fn splat<S: Simd>(simd: S, Point([x, y, z]): Point) -> Points<S> {
    [f64x8::splat(simd, x), f64x8::splat(simd, y), f64x8::splat(simd, z)]
}

/// The scalar products of two packs of vectors.
#[inline(always)]
pub fn dot<L: Lane>([a, b, c]: [L; 3], [x, y, z]: [L; 3]) -> L {
    a * x + b * y + c * z
}

/// Where the lines of rays that begin in a body enter and leave it, for the rays that a mask names: from no later than
/// their beginnings, to infinity where there is no boundary. The one is not before the other where a ray only grazes.
///
/// On AVX2 it is a function of its own.
#[inline(always)]
pub fn ends<S: Simd>(bounds: &Bounds, rays: [Points<S>; 2], which: mask64x8<S>) -> [f64x8<S>; 2] {
    if matches!(bounds, Bounds::Everywhere) {
        let simd = rays[0][0].token();
        return [f64x8::splat(simd, 0.0), f64x8::splat(simd, f64::INFINITY)];
    }
    pack::outlined_if_narrow(
        rays[0][0].token(),
        #[inline(always)]
        move || ends_in_place(bounds, rays, which),
    )
}

/// The same in place, for who asks in every step.
#[inline(always)]
pub fn ends_in_place<S: Simd>(
    bounds: &Bounds,
    [origin, direction]: [Points<S>; 2],
    which: mask64x8<S>,
) -> [f64x8<S>; 2] {
    match bounds {
        Bounds::Everywhere => [origin[0].each(0.0), origin[0].each(f64::INFINITY)],
        Bounds::Box(within) => of_box(within, origin, direction),
        Bounds::Sphere { centre, radius } => chords(*centre, *radius, [origin, direction], which),
    }
}

/// Where the lines of rays that begin in a ball enter and leave it, for the rays that a mask names; the one is
/// not before the other where they do not.
#[inline(always)]
pub fn chords<S: Simd>(
    centre: Point,
    radius: f64,
    [origin, direction]: [Points<S>; 2],
    which: mask64x8<S>,
) -> [f64x8<S>; 2] {
    let ([from, to], is_plain) = of_ball(centre, radius, origin, direction);
    let is_grazing = which & !is_plain;
    let grazing = is_grazing.to_bitmask();
    if grazing == 0 {
        return [from, to];
    }
    if fuses(to.token().level()) && SIZES.contains(&radius) {
        let [begin, end] = pack::outlined(
            to.token(),
            #[inline(always)]
            move || grazing::chord(centre, radius, origin, direction),
        );
        return [Lane::select(is_grazing, begin, from), Lane::select(is_grazing, end, to)];
    }
    let mut ends = rows([from, to, to]);
    one_by_one(
        &Bounds::Sphere { centre, radius },
        &[rows(origin), rows(direction)],
        grazing,
        &mut ends,
    );
    [f64x8::from_slice(to.token(), &ends[0]), f64x8::from_slice(to.token(), &ends[1])]
}

/// Where the lines of rays are nearest to a point, and how near that is.
#[inline(always)]
pub fn foot_and_offset<L: Lane>(centre: Point, origin: [L; 3], direction: [L; 3]) -> [L; 2] {
    let (Point([a, b, c]), [x, y, z]) = (centre, origin);
    let to_centre = [x.each(a) - x, y.each(b) - y, z.each(c) - z];
    let foot = dot(to_centre, direction);
    let [a, b, c] = to_centre;
    let [x, y, z] = direction;
    let aside = [a - x * foot, b - y * foot, c - z * foot];
    [foot, dot(aside, aside).root()]
}

/// Which rays do not meet a ball that they begin outside, and how far it is for the others.
#[inline(always)]
pub fn meets<L: Lane>(
    centre: Point,
    radius: f64,
    origin: [L; 3],
    direction: [L; 3],
) -> (L::Mask, L) {
    let [foot, offset] = foot_and_offset(centre, origin, direction);
    let (size, zero) = (foot.each(radius), foot.each(0.0));
    let near = (foot - ((size - offset) * (size + offset)).root()).or_more(zero);
    (foot.at_most(zero) | size.at_most(offset), near)
}

/// By doubles, and whether these keep the digits: see [`Bounds::clip`].
#[inline(always)]
fn of_ball<S: Simd>(
    centre: Point,
    radius: f64,
    origin: Points<S>,
    direction: Points<S>,
) -> ([f64x8<S>; 2], mask64x8<S>) {
    let [foot, offset] = foot_and_offset(centre, origin, direction);
    let size = foot.each(radius);
    let half = ((size - offset) * (size + offset)).root();
    let is_large = foot.each(1e-100).below(size);
    // The origin is in the ball, so that it is not far.
    ([foot - half, foot + half], offset.below(size * 0.9) & is_large)
}

/// The same ray by ray, for those whose bits are set.
#[inline(never)]
pub fn one_by_one(
    bounds: &Bounds,
    rays: &[[[f64; WIDTH]; 3]; 2],
    which: u64,
    [from, to, _]: &mut [[f64; WIDTH]; 3],
) {
    for lane in (0..WIDTH).filter(|lane| which >> lane & 1 == 1) {
        let [origin, direction] = rays.map(|rows| Point(rows.map(|row| row[lane])));
        let inside = bounds.clip(&Ray { origin, direction, length: f64::INFINITY });
        (from[lane], to[lane]) = (inside.from, inside.to);
    }
}

/// The elements of three packs.
#[inline(always)]
pub fn rows<S: Simd>(points: Points<S>) -> [[f64; WIDTH]; 3] {
    let mut rows = [[0.0; WIDTH]; 3];
    for (axis, row) in rows.iter_mut().enumerate() {
        points[axis].store_slice(row);
    }
    rows
}

#[inline(always)]
fn of_box<L: Lane>(within: &Aabb, origin: [L; 3], direction: [L; 3]) -> [L; 2] {
    let zero = origin[0].each(0.0);
    let (mut from, mut to) = (zero, zero.each(f64::INFINITY));
    let mut is_over = zero.below(zero);
    for axis in 0..3 {
        let (o, d) = (origin[axis], direction[axis]);
        let (low, high) = (zero.each(within.low.0[axis]), zero.each(within.high.0[axis]));
        let is_level = d.at_most(zero) & zero.at_most(d);
        let is_outside = is_level & (o.below(low) | high.below(o));
        let (a, b) = ((low - o) / d, (high - o) / d);
        let later = from.or_more(a.or_less(b));
        let sooner = to.or_less(a.or_more(b));
        let is_empty = !is_level & !later.below(sooner);
        // An empty stretch has its end at its beginning.
        let end = later.or_less(to).or_more(from);
        let stays = is_over | (is_level & !is_outside);
        let next = Lane::select(is_empty, end, sooner);
        to = Lane::select(stays, to, Lane::select(is_outside, from, next));
        from = Lane::select(stays | is_level | is_empty, from, later);
        is_over = is_over | is_outside | is_empty;
    }
    [from, to]
}
