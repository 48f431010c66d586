//! Flights through σ̂ in space, side by side.
//!
//! ```text
//! σ̂ is one constant, or constant in each cell of a grid:  a flight of optical depth u ends where ∫σ̂ = u
//! ```
//!
//! A flight goes from plane to plane and uses up `σ̂ · length` of its optical depth in each cell, nothing in a cell
//! where σ̂ is 0. Lanes cross the planes between cells together; lanes that have come to their collisions stand
//! still until the others have.
//!
//! Source: the traversal is that of J. Amanatides, A. Woo, *A Fast Voxel Traversal Algorithm for Ray Tracing*,
//! Eurographics 1987.

use super::Majorants;
use numeric::geometry::Point;
use numeric::geometry::exit::{along, ends, meets};
use numeric::{Lane, Mask, kept};

/// σ̂, and the bounds of flights through it.
#[derive(Clone, Copy)]
pub struct MajorantView<'a> {
    majorants: &'a Majorants,
    /// σ̂, where it is one constant.
    constant: Option<f64>,
    cells: [f64; 3],
    /// The number of the last cell along each axis.
    last: [f64; 3],
    low: [f64; 3],
    width: [f64; 3],
    values: &'a [f64],
    /// A black ball that absorbs every particle that reaches it.
    core: Option<(Point, f64)>,
}

/// Distances at which rays end.
#[derive(Clone, Copy)]
pub struct Reach<L: Lane> {
    /// The distances at which their lines enter and leave the body.
    pub ends: [L; 2],
    /// Rays that pass the black ball, and the distances at which the others reach it.
    pub stop: Option<(L::Mask, L)>,
}

impl<'a> MajorantView<'a> {
    /// σ̂, with a black ball in it or without.
    pub fn new(majorants: &'a Majorants, core: Option<(Point, f64)>) -> Self {
        let (cells, low, width, values) = majorants.cells();
        let (constant, cells) = (majorants.single_value(), cells.map(|n| n as f64));
        let last = cells.map(|n| n - 1.0);
        Self { majorants, constant, cells, last, low: low.0, width, values, core }
    }

    /// The ends of rays from places in the body, for the lanes in `which`.
    #[inline(always)]
    pub fn reach<L: Lane>(&self, rays: [[L; 3]; 2], which: L::Mask) -> Reach<L> {
        let ends = ends(self.majorants.bounds(), rays, which);
        let stop = self.core.map(
            #[inline(always)]
            |(centre, radius)| meets(centre, radius, rays[0], rays[1]),
        );
        Reach { ends, stop }
    }

    /// σ̂ in cells.
    #[inline(always)]
    fn value<L: Lane>(&self, [i, j, k]: [L; 3]) -> L {
        let [nx, ny, _] = self.cells;
        ((k * ny + j) * nx + i).entry(self.values)
    }
}

kept! {
    /// Particles, each flying in one direction.
    pub struct Flights<L> {
        /// Origins of the flights.
        pub origin: [L; 3],
        /// Unit vectors.
        pub direction: [L; 3],
        /// The distances flown.
        pub t: L,
        /// Distances at which the rays leave the body.
        end: L,
        /// Distances of the black ball; infinite where the rays miss it.
        stop: L,
        cell: [L; 3],
        planes: [L; 3],
    }
}

/// Ends of flights.
#[derive(Clone, Copy)]
pub struct Flown<L: Lane> {
    /// Lanes with a tentative collision; the others have left.
    pub inside: L::Mask,
    /// σ̂ there.
    pub sampling: L,
    /// The place.
    pub place: [L; 3],
    /// The length of the flight.
    pub length: L,
}

/// Selects the number of an axis out of three: the first or the second by masks, else the third.
#[inline(always)]
fn of_axis<L: Lane>([first, second]: [L::Mask; 2], [x, y, z]: [L; 3]) -> L {
    L::select(first, x, L::select(second, y, z))
}

impl<L: Lane> Flights<L> {
    /// Flights that have not begun.
    #[inline(always)]
    pub fn new(zero: L) -> Self {
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

    /// Begins the flights of the lanes in `which`, from their origins in their directions.
    #[inline(always)]
    pub fn enter(&mut self, ground: &MajorantView, which: L::Mask, reach: &Reach<L>) {
        let Reach { ends: [_, end], stop } = *reach;
        let zero = end.each(0.0);
        self.end.set_where(which, end);
        self.t.set_where(which, zero);
        if let Some((passes, at)) = stop {
            self.stop.set_where(which, L::select(passes, zero.each(f64::INFINITY), at));
        }
        if ground.constant.is_none() {
            (self.cell, self.planes) = self.cells_entered(ground, which);
        }
    }

    /// The cells of the lanes in `which` and the distances to the planes ahead; unchanged for the others.
    #[inline(always)]
    fn cells_entered(mut self, ground: &MajorantView, which: L::Mask) -> ([L; 3], [L; 3]) {
        self.t.outlined_if_narrow(
            #[inline(always)]
            move || {
                let zero = self.t.each(0.0);
                for axis in 0..3 {
                    let place =
                        (self.origin[axis] - ground.low[axis]) / zero.each(ground.width[axis]);
                    let cell = place.or_more(zero).or_less(zero.each(ground.last[axis])).floor();
                    self.cell[axis].set_where(which, cell);
                    let slope = self.direction[axis];
                    let is_up = zero.below(slope);
                    let index = self.cell[axis] + L::select(is_up, zero.each(1.0), zero);
                    let plane = index * ground.width[axis] + ground.low[axis];
                    let far = (plane - self.origin[axis]) / slope;
                    let plane = L::select(slope.equals(0.0), zero.each(f64::INFINITY), far);
                    self.planes[axis].set_where(which, plane);
                }
                (self.cell, self.planes)
            },
        )
    }

    /// Flies the lanes in `which` an optical depth through σ̂; the places of the others are arbitrary. σ̂ in a cell
    /// is `through` of its σ̂ and of that of the cell in which the flight begins.
    #[inline(always)]
    pub fn fly(
        &mut self,
        ground: &MajorantView,
        which: L::Mask,
        depth: L,
        through: impl Fn(L, L) -> L,
    ) -> Flown<L> {
        let before = self.t;
        let (mut inside, sampling) = if let Some(value) = ground.constant {
            let sampling = depth.each(value);
            let inside = depth.below((self.end - self.t) * sampling);
            self.t = L::select(inside, self.t + depth / sampling, self.end);
            (inside, sampling)
        } else {
            let flights = *self;
            let (crossed, inside, sampling) = depth.outlined_if_narrow(
                #[inline(always)]
                move || flights.across_cells(ground, which, depth, through),
            );
            (self.t, self.cell, self.planes) = (crossed.t, crossed.cell, crossed.planes);
            (inside, sampling)
        };
        inside &= which;
        if ground.core.is_some() {
            let is_stopped = self.stop.below(self.t);
            self.t.set_where(is_stopped, self.stop);
            inside &= !is_stopped;
        }
        let place = along(self.origin, self.direction, self.t);
        let length = L::select(which, self.t - before, depth.each(0.0));
        Flown { inside, sampling, place, length }
    }

    /// Flies through one cell after the other, until the optical depth is used up or the body ends.
    #[inline(always)]
    fn across_cells(
        mut self,
        ground: &MajorantView,
        mut on_its_way: L::Mask,
        depth: L,
        through: impl Fn(L, L) -> L,
    ) -> (Self, L::Mask, L) {
        let (zero, one) = (depth.each(0.0), depth.each(1.0));
        let (mut left, mut sampling, mut inside) = (depth, one, zero.below(zero));
        let mut value = ground.value(self.cell);
        let begun = value;
        loop {
            let here = through(value, begun);
            let [x, y, z] = self.planes;
            let edge = x.or_less(y).or_less(z.or_less(self.end));
            let room = (edge - self.t) * here;
            let arrives = on_its_way & left.below(room);
            self.t.set_where(arrives, self.t + left / here);
            sampling.set_where(arrives, value);
            inside |= arrives;
            on_its_way &= !arrives;
            if !on_its_way.maybe() {
                return (self, inside, sampling);
            }
            // A place on a plane may be beyond it by a rounding.
            left = left - room.or_more(zero);
            self.t.set_where(on_its_way, self.t.or_more(edge));
            let is_first = x.at_most(edge);
            let axis = [is_first, !is_first & y.at_most(edge)];
            let slope = of_axis(axis, self.direction);
            let (is_up, cell) = (zero.below(slope), of_axis(axis, self.cell));
            let last = L::select(is_up, of_axis(axis, Point(ground.last).each(zero)), zero);
            let is_last = cell.at_most(last) & last.at_most(cell);
            let leaves = on_its_way & (self.end.at_most(edge) | is_last);
            self.t.set_where(leaves, self.end);
            on_its_way &= !leaves;
            if !on_its_way.any() {
                return (self, inside, sampling);
            }
            let cell = cell + L::select(is_up, one, -one);
            let index = cell + L::select(is_up, one, zero);
            let width = of_axis(axis, Point(ground.width).each(zero));
            let low = of_axis(axis, Point(ground.low).each(zero));
            let plane = (low + width * index - of_axis(axis, self.origin)) / slope;
            let [first, second] = axis;
            for (axis, crossed) in [first, second, !first & !second].into_iter().enumerate() {
                let crossed = crossed & on_its_way;
                self.cell[axis].set_where(crossed, cell);
                self.planes[axis].set_where(crossed, plane);
            }
            value = ground.value(self.cell);
        }
    }
}
