//! Eight flights through σ̂ side by side: [`Majorants::enter`] and [`Majorants::fly`], bit for bit.
//!
//! Lanes cross the planes between cells together; those that have come to their collisions wait for the
//! others.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::exit::{Points, ends, meets};
use media::Majorants;
use numeric::geometry::Point;
use numeric::{Lane, pack};

/// Where σ̂ has which value.
pub struct Ground<'a> {
    majorants: &'a Majorants,
    /// σ̂, where it is one constant.
    constant: Option<f64>,
    cells: [f64; 3],
    /// The number of the last cell along each axis.
    last: [f64; 3],
    low: [f64; 3],
    width: [f64; 3],
    values: &'a [f64],
    /// A black ball that stops all that meets it.
    core: Option<(Point, f64)>,
}

/// How far eight rays reach.
#[derive(Clone, Copy)]
pub struct Reach<S: Simd> {
    /// Where their lines enter and leave the body.
    pub ends: [f64x8<S>; 2],
    /// Which of them pass the black ball, and where the others meet it.
    pub stop: Option<(mask64x8<S>, f64x8<S>)>,
}

impl<'a> Ground<'a> {
    /// How far rays from places in the body reach, for those that a mask names.
    #[inline(always)]
    pub fn reach<S: Simd>(
        &self,
        [origin, direction]: [Points<S>; 2],
        which: mask64x8<S>,
    ) -> Reach<S> {
        let ends = ends(self.majorants.bounds(), [origin, direction], which);
        let stop = self.core.map(
            #[inline(always)]
            |(centre, radius)| meets(centre, radius, origin, direction),
        );
        Reach { ends, stop }
    }

    /// That of σ̂, with a black ball in it or without.
    pub fn new(majorants: &'a Majorants, core: Option<(Point, f64)>) -> Self {
        let (cells, low, width, values) = majorants.cells();
        let (constant, cells) = (majorants.single_value(), cells.map(|n| n as f64));
        let last = cells.map(|n| n - 1.0);
        Self { majorants, constant, cells, last, low: low.0, width, values, core }
    }
}

/// Eight particles, each on its way in one direction.
#[derive(Clone, Copy)]
pub struct Flights<S: Simd> {
    /// Where they began.
    pub origin: Points<S>,
    /// Where they go, unit vectors.
    pub direction: Points<S>,
    /// How far they have come.
    pub t: f64x8<S>,
    /// Where they leave the body.
    end: f64x8<S>,
    /// Where they meet the black ball; infinite where they do not.
    stop: f64x8<S>,
    cell: Points<S>,
    planes: Points<S>,
}

/// Where eight flights have come to.
#[derive(Clone, Copy)]
pub struct Flown<S: Simd> {
    /// Whether there is a tentative collision: else the particle has left.
    pub inside: mask64x8<S>,
    /// σ̂ there.
    pub sampling: f64x8<S>,
    /// Where.
    pub place: Points<S>,
    /// How far it was.
    pub length: f64x8<S>,
}

/// The one of three numbers that belongs to an axis: the first or the second, as masks say, else the third.
#[inline(always)]
fn of_axis<L: Lane>([first, second]: [L::Mask; 2], [x, y, z]: [L; 3]) -> L {
    L::select(first, x, L::select(second, y, z))
}

impl<S: Simd> Flights<S> {
    /// Nowhere.
    #[inline(always)]
    pub fn new(simd: S) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let nowhere = [zero; 3];
        Self {
            origin: nowhere,
            direction: nowhere,
            t: zero,
            end: zero,
            stop: zero,
            cell: nowhere,
            planes: [zero.each(f64::INFINITY); 3],
        }
    }

    /// Those that a mask names begin anew, from the origins and in the directions that are set, which reach so far.
    #[inline(always)]
    pub fn enter(&mut self, ground: &Ground, which: mask64x8<S>, reach: &Reach<S>) {
        let Reach { ends: [_, end], stop } = *reach;
        let zero = end.each(0.0);
        self.end = Lane::select(which, end, self.end);
        self.t = Lane::select(which, zero, self.t);
        if let Some((passes, at)) = stop {
            let stop = Lane::select(passes, zero.each(f64::INFINITY), at);
            self.stop = Lane::select(which, stop, self.stop);
        }
        if ground.constant.is_none() {
            (self.cell, self.planes) = self.cells_entered(ground, which);
        }
    }

    /// In which cells those that a mask names are, and how far it is to the planes ahead; for the others as it was.
    #[inline(always)]
    fn cells_entered(mut self, ground: &Ground, which: mask64x8<S>) -> (Points<S>, Points<S>) {
        pack::outlined_if_narrow(
            self.t.token(),
            #[inline(always)]
            move || {
                let zero = self.t.each(0.0);
                for axis in 0..3 {
                    let place =
                        (self.origin[axis] - ground.low[axis]) / zero.each(ground.width[axis]);
                    let cell =
                        Lane::floor(place.or_more(zero).or_less(zero.each(ground.last[axis])));
                    self.cell[axis] = Lane::select(which, cell, self.cell[axis]);
                    let slope = self.direction[axis];
                    let is_up = zero.below(slope);
                    let index = self.cell[axis] + Lane::select(is_up, zero.each(1.0), zero);
                    let plane = index * ground.width[axis] + ground.low[axis];
                    let far = (plane - self.origin[axis]) / slope;
                    let is_level = slope.at_most(zero) & zero.at_most(slope);
                    let plane = Lane::select(is_level, zero.each(f64::INFINITY), far);
                    self.planes[axis] = Lane::select(which, plane, self.planes[axis]);
                }
                (self.cell, self.planes)
            },
        )
    }

    /// Those that a mask names fly an optical depth through σ̂; the places of the others mean nothing.
    #[inline(always)]
    pub fn fly(&mut self, ground: &Ground, which: mask64x8<S>, depth: f64x8<S>) -> Flown<S> {
        let before = self.t;
        let (mut inside, sampling) = if let Some(value) = ground.constant {
            let sampling = depth.each(value);
            let inside = depth.below((self.end - self.t) * sampling);
            self.t = Lane::select(inside, self.t + depth / sampling, self.end);
            (inside, sampling)
        } else {
            let (crossed, inside, sampling) = self.cross_cells(ground, which, depth);
            (self.t, self.cell, self.planes) = (crossed.t, crossed.cell, crossed.planes);
            (inside, sampling)
        };
        inside &= which;
        if ground.core.is_some() {
            let is_stopped = self.stop.below(self.t);
            self.t = Lane::select(is_stopped, self.stop, self.t);
            inside &= !is_stopped;
        }
        let [a, b, c] = self.origin;
        let [x, y, z] = self.direction;
        let place = [a + x * self.t, b + y * self.t, c + z * self.t];
        let length = Lane::select(which, self.t - before, depth.each(0.0));
        Flown { inside, sampling, place, length }
    }

    #[inline(always)]
    fn cross_cells(
        self,
        ground: &Ground,
        which: mask64x8<S>,
        depth: f64x8<S>,
    ) -> (Self, mask64x8<S>, f64x8<S>) {
        pack::outlined_if_narrow(
            depth.token(),
            #[inline(always)]
            move || self.across_cells(ground, which, depth),
        )
    }

    /// Through one cell after the other, to where the optical depths end or the body does.
    #[inline(always)]
    fn across_cells(
        mut self,
        ground: &Ground,
        mut on_its_way: mask64x8<S>,
        depth: f64x8<S>,
    ) -> (Self, mask64x8<S>, f64x8<S>) {
        let (zero, one) = (depth.each(0.0), depth.each(1.0));
        let [nx, ny, _] = ground.cells;
        let (mut left, mut sampling, mut inside) = (depth, one, zero.below(zero));
        loop {
            let [i, j, k] = self.cell;
            let here = ((k * ny + j) * nx + i).entry(ground.values);
            let [x, y, z] = self.planes;
            let edge = x.or_less(y).or_less(z.or_less(self.end));
            let room = (edge - self.t) * here;
            let arrives = on_its_way & left.below(room);
            self.t = Lane::select(arrives, self.t + left / here, self.t);
            sampling = Lane::select(arrives, here, sampling);
            inside |= arrives;
            on_its_way &= !arrives;
            // A place on a plane may be beyond it by a rounding.
            left -= room.or_more(zero);
            self.t = Lane::select(on_its_way, self.t.or_more(edge), self.t);
            let first = x.at_most(edge);
            let axis = [first, !first & y.at_most(edge)];
            let slope = of_axis(axis, self.direction);
            let (is_up, cell) = (zero.below(slope), of_axis(axis, self.cell));
            let last = of_axis(axis, lanes(zero, ground.last));
            let last = Lane::select(is_up, last, zero);
            let is_last = cell.at_most(last) & last.at_most(cell);
            let leaves = on_its_way & (self.end.at_most(edge) | is_last);
            self.t = Lane::select(leaves, self.end, self.t);
            on_its_way &= !leaves;
            if on_its_way.to_bitmask() == 0 {
                return (self, inside, sampling);
            }
            let cell = cell + Lane::select(is_up, one, -one);
            let index = cell + Lane::select(is_up, one, zero);
            let width = of_axis(axis, lanes(zero, ground.width));
            let low = of_axis(axis, lanes(zero, ground.low));
            let plane = (low + width * index - of_axis(axis, self.origin)) / slope;
            let [first, second] = axis;
            for (axis, crossed) in [first, second, !first & !second].into_iter().enumerate() {
                let crossed = crossed & on_its_way;
                self.cell[axis] = Lane::select(crossed, cell, self.cell[axis]);
                self.planes[axis] = Lane::select(crossed, plane, self.planes[axis]);
            }
        }
    }
}

/// Three numbers in all lanes.
#[inline(always)]
fn lanes<L: Lane>(like: L, [x, y, z]: [f64; 3]) -> [L; 3] {
    [like.each(x), like.each(y), like.each(z)]
}
