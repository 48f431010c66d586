//! Ends of rays that begin in a body: [`Bounds::clip`] for rays side by side, bit for bit.
//!
//! ```text
//! ball:  foot = (c − o)·d,  offset = |c − o − foot d|,  end = foot + √((R − offset)(R + offset))
//! box:   end = min over the axes of the larger of (low − o)/d and (high − o)/d
//! ```
//!
//! Rays that graze a ball lose digits there: they are clipped in 32 digits.

use std::ops::RangeInclusive;

use super::{Aabb, Bounds, Point, Ray, grazing};
use crate::lane::WIDTH;
use crate::{Kept, Lane, Mask};

/// Radii of which no square overflows or underflows, nor what is left of one after 32 digits.
const SIZES: RangeInclusive<f64> = 1e-60..=1e60;

/// The scalar products of vectors side by side.
#[inline(always)]
pub fn dot<L: Lane>([a, b, c]: [L; 3], [x, y, z]: [L; 3]) -> L {
    a * x + b * y + c * z
}

/// Points `t` along rays.
#[inline(always)]
pub fn along<L: Lane>([a, b, c]: [L; 3], [x, y, z]: [L; 3], t: L) -> [L; 3] {
    [a + x * t, b + y * t, c + z * t]
}

/// Distances at which the lines of rays that begin in a body enter and leave it, for the lanes in `which`: from no later
/// than their beginnings, to infinity where there is no boundary. A ray that only grazes leaves no later than it enters.
///
/// On AVX2 it is not inlined.
#[inline(always)]
pub fn ends<L: Lane>(bounds: &Bounds, rays: [[L; 3]; 2], which: L::Mask) -> [L; 2] {
    let like = rays[0][0];
    if matches!(bounds, Bounds::Everywhere) {
        return [like.each(0.0), like.each(f64::INFINITY)];
    }
    like.outlined_if_narrow(
        #[inline(always)]
        move || ends_in_place(bounds, rays, which),
    )
}

/// [`ends`] in place, for loops that need them in every step.
#[inline(always)]
pub fn ends_in_place<L: Lane>(
    bounds: &Bounds,
    [origin, direction]: [[L; 3]; 2],
    which: L::Mask,
) -> [L; 2] {
    match bounds {
        Bounds::Everywhere => [origin[0].each(0.0), origin[0].each(f64::INFINITY)],
        Bounds::Box(within) => of_box(within, origin, direction),
        Bounds::Sphere { centre, radius } => chords(*centre, *radius, [origin, direction], which),
    }
}

/// Distances at which the lines of rays that begin in a ball enter and leave it, for the lanes in `which`; without a chord
/// a ray leaves no later than it enters.
#[inline(always)]
pub fn chords<L: Lane>(
    centre: Point,
    radius: f64,
    [origin, direction]: [[L; 3]; 2],
    which: L::Mask,
) -> [L; 2] {
    let ([from, to], is_plain) = of_ball(centre, radius, origin, direction);
    let is_grazing = which & !is_plain;
    if !is_grazing.any() {
        return [from, to];
    }
    let mut chord = [from, to];
    if SIZES.contains(&radius) {
        chord.set_where(
            is_grazing,
            to.outlined(
                #[inline(always)]
                move || grazing::chord(centre, radius, origin, direction),
            ),
        );
        return chord;
    }
    let (ball, mut ends) = (Bounds::Sphere { centre, radius }, rows([from, to, to]));
    one_by_one(&ball, &[rows(origin), rows(direction)], is_grazing.bits(), &mut ends);
    [from.load(&ends[0]), to.load(&ends[1])]
}

/// Distances at which the lines of rays are nearest to a point, and how near that is.
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

/// Rays that miss a ball which they begin outside, and the distances at which the others meet it.
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

/// The ends by doubles, and whether these keep the digits: see [`Bounds::clip`].
#[inline(always)]
fn of_ball<L: Lane>(
    centre: Point,
    radius: f64,
    origin: [L; 3],
    direction: [L; 3],
) -> ([L; 2], L::Mask) {
    let [foot, offset] = foot_and_offset(centre, origin, direction);
    let size = foot.each(radius);
    let half = ((size - offset) * (size + offset)).root();
    let is_large = foot.each(1e-100).below(size);
    // The origin is in the ball, so that it is not far.
    ([foot - half, foot + half], offset.below(size * 0.9) & is_large)
}

/// [`Bounds::clip`] ray by ray, for those in `which`, as bits.
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

/// The elements of three lanes.
#[inline(always)]
pub fn rows<L: Lane>(points: [L; 3]) -> [[f64; WIDTH]; 3] {
    let mut rows = [[0.0; WIDTH]; 3];
    for (axis, row) in rows.iter_mut().enumerate() {
        points[axis].store(row);
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
