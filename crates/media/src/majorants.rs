//! σ̂ in space: one constant on a body, or constant in the cells of a regular grid over it.
//!
//! ```text
//! cell (i, j, k) of n₁ × n₂ × n₃ cells over the box about the body:  σ̂ = factor · majorant of σ_t there
//! ```
//!
//! A flight goes from plane to plane and spends `σ̂ · length` of its optical depth in each cell; in a cell
//! where σ̂ is 0 it spends nothing, so that empty cells cost no lookup. It ends where it leaves the body,
//! which need not fill its box. With a factor below 1, σ̂ is below σ_t somewhere.
//!
//! Source: the traversal is that of J. Amanatides, A. Woo, *A Fast Voxel Traversal Algorithm for Ray
//! Tracing*, Eurographics 1987; local majorants: L. Szirmay-Kalos, B. Tóth, M. Magdics, *Free Path
//! Sampling in High Resolution Inhomogeneous Participating Media*, Computer Graphics Forum 30 (2011).

use super::Volume;
use numeric::Lane;
use numeric::geometry::{Aabb, Bounds, Point, Ray};

/// A cell's bound is raised by this factor: lookups are rounded.
const MARGIN: f64 = 1.0 + 1e-9;

/// σ̂ in space.
#[derive(Debug, Clone)]
pub struct Majorants {
    bounds: Bounds,
    low: Point,
    width: [f64; 3],
    cells: [usize; 3],
    values: Vec<f64>,
    largest_ratio: f64,
}

/// A particle on its way in one direction.
#[derive(Debug, Clone, Copy)]
pub struct Flight {
    /// Where it began.
    pub origin: Point,
    /// Where it goes, a unit vector.
    pub direction: Point,
    /// How far it has come.
    pub t: f64,
    /// Where it leaves the body; infinite where that has no end.
    pub end: f64,
    cell: [usize; 3],
    planes: [f64; 3],
}

impl Flight {
    /// Where the particle is.
    #[inline(always)]
    pub fn place(&self) -> Point {
        self.origin + self.direction * self.t
    }
}

impl Majorants {
    /// One σ̂ everywhere on a volume.
    pub fn constant(value: f64, volume: &Volume) -> Self {
        let bounds = volume.bounds();
        let highest = match bounds.enclosing_box() {
            Some(within) => volume.majorant(&within),
            // A volume without end is looked up for its bound wherever that may be.
            None => volume.majorant(&EVERYWHERE),
        };
        let low = bounds.enclosing_box().map_or(Point([0.0; 3]), |within| within.low);
        let largest_ratio = highest / value;
        Self { bounds, low, width: [0.0; 3], cells: [1; 3], values: vec![value], largest_ratio }
    }

    /// The bounds of a volume in the cells of a grid over it, times a factor; `None` for a volume
    /// without bounds.
    pub fn grid(cells: [usize; 3], factor: f64, volume: &Volume) -> Option<Self> {
        let bounds = volume.bounds();
        let within = bounds.enclosing_box()?;
        let (low, size) = (within.low, within.high - within.low);
        let width: [f64; 3] = std::array::from_fn(|i| size.0[i] / cells[i] as f64);
        let corner =
            |at: [usize; 3]| Point(std::array::from_fn(|i| low.0[i] + width[i] * at[i] as f64));
        let mut values = Vec::with_capacity(cells.iter().product());
        for k in 0..cells[2] {
            for j in 0..cells[1] {
                for i in 0..cells[0] {
                    let cell = Aabb { low: corner([i, j, k]), high: corner([i + 1, j + 1, k + 1]) };
                    values.push(volume.majorant(&cell) * MARGIN * factor);
                }
            }
        }
        Some(Self { bounds, low, width, cells, values, largest_ratio: 1.0 / factor })
    }

    /// The same times a factor.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value *= factor);
        self.largest_ratio /= factor;
        self
    }

    /// Where particles are followed.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// σ̂, where it is one constant.
    pub fn single_value(&self) -> Option<f64> {
        match *self.values.as_slice() {
            [value] => Some(value),
            _ => None,
        }
    }

    /// The largest σ̂.
    pub fn largest(&self) -> f64 {
        self.values.iter().copied().fold(0.0, f64::max)
    }

    /// A number that `σ_t/σ̂` exceeds nowhere: exact for cells up to their own margin.
    pub fn largest_ratio(&self) -> f64 {
        self.largest_ratio
    }

    /// `∫σ̂ dV`; `None` for cells over a ball, of which its boundary cuts off parts.
    pub fn content(&self) -> Option<f64> {
        match (self.single_value(), self.bounds) {
            (Some(value), _) => Some(value * self.bounds.content()),
            (None, Bounds::Box(_)) => {
                let cell: f64 = self.width.iter().product();
                Some(cell * self.values.iter().sum::<f64>())
            }
            (None, _) => None,
        }
    }

    /// The share of the box in which σ̂ is 0.
    pub fn empty_share(&self) -> f64 {
        let empty = self.values.iter().filter(|&&value| value == 0.0).count();
        empty as f64 / self.values.len() as f64
    }

    /// The values of the cells, the first index fastest, with their number along each axis, the
    /// lowest corner and the width of a cell.
    pub fn cells(&self) -> ([usize; 3], Point, [f64; 3], &[f64]) {
        (self.cells, self.low, self.width, &self.values)
    }

    /// A particle at a place in the body, or on its boundary, about to fly in a direction.
    #[inline(always)]
    pub fn enter(&self, origin: Point, direction: Point) -> Flight {
        let ray = Ray { origin, direction, length: f64::INFINITY };
        let end = self.bounds.clip(&ray).to;
        let mut flight =
            Flight { origin, direction, t: 0.0, end, cell: [0; 3], planes: [f64::INFINITY; 3] };
        if self.values.len() > 1 {
            for axis in 0..3 {
                let place = (origin.0[axis] - self.low.0[axis]) / self.width[axis];
                flight.cell[axis] = cell_of(place, self.cells[axis]);
                self.aim(&mut flight, axis);
            }
        }
        flight
    }

    /// Finds the distance of the next plane across an axis.
    #[inline(always)]
    fn aim(&self, flight: &mut Flight, axis: usize) {
        let slope = flight.direction.0[axis];
        if slope == 0.0 {
            return;
        }
        let index = flight.cell[axis] + usize::from(slope > 0.0);
        let plane = self.low.0[axis] + self.width[axis] * index as f64;
        flight.planes[axis] = (plane - flight.origin.0[axis]) / slope;
    }

    /// σ̂ where the particle is.
    #[inline(always)]
    pub fn here(&self, flight: &Flight) -> f64 {
        let [i, j, k] = flight.cell;
        self.values[(k * self.cells[1] + j) * self.cells[0] + i]
    }

    /// Flies an optical depth through σ̂ and answers σ̂ there; `None` beyond the end.
    #[inline(always)]
    pub fn fly(&self, flight: &mut Flight, depth: f64) -> Option<f64> {
        self.fly_by(flight, depth, |here| here)
    }

    /// The same through what is made of the σ̂ of each cell.
    #[inline(always)]
    pub fn fly_by(
        &self,
        flight: &mut Flight,
        depth: f64,
        through: impl Fn(f64) -> f64,
    ) -> Option<f64> {
        let mut left = depth;
        loop {
            let here = self.here(flight);
            let flown = through(here);
            let [x, y, z] = flight.planes;
            let edge = Lane::or_less(Lane::or_less(x, y), Lane::or_less(z, flight.end));
            let room = (edge - flight.t) * flown;
            if left < room {
                flight.t += left / flown;
                return Some(here);
            }
            // A place on a plane may be beyond it by a rounding.
            left -= Lane::or_more(room, 0.0);
            flight.t = Lane::or_more(flight.t, edge);
            if edge >= flight.end || !self.cross(flight, edge) {
                flight.t = flight.end;
                return None;
            }
        }
    }

    /// Goes on into the next cell; `false` where the grid ends.
    #[inline(always)]
    fn cross(&self, flight: &mut Flight, edge: f64) -> bool {
        let axis = (0..3).find(|&axis| flight.planes[axis] <= edge).unwrap_or(2);
        let is_up = flight.direction.0[axis] > 0.0;
        let last = if is_up { self.cells[axis] - 1 } else { 0 };
        if flight.cell[axis] == last {
            return false;
        }
        flight.cell[axis] = if is_up { flight.cell[axis] + 1 } else { flight.cell[axis] - 1 };
        self.aim(flight, axis);
        true
    }
}

/// All the space that doubles reach without overflow of their squares.
const EVERYWHERE: Aabb = Aabb { low: Point([-1e150; 3]), high: Point([1e150; 3]) };

/// The cell that holds a place, which rounding may have carried out of the grid.
#[inline(always)]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the grid
fn cell_of(place: f64, cells: usize) -> usize {
    place.clamp(0.0, (cells - 1) as f64) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eq21::Eq21;

    fn grid() -> Majorants {
        let cells = [2, 1, 1];
        let low = Point([0.0; 3]);
        let cube = Aabb { low, high: Point([2.0, 1.0, 1.0]) };
        let values = vec![0.5, 2.0];
        let bounds = Bounds::Box(cube);
        Majorants { bounds, low, width: [1.0; 3], cells, values, largest_ratio: 1.0 }
    }

    #[test]
    fn a_flight_spends_its_depth_cell_by_cell() {
        let grid = grid();
        let mut flight = grid.enter(Point([0.0, 0.5, 0.5]), Point([1.0, 0.0, 0.0]));
        assert_eq!(grid.fly(&mut flight, 0.25), Some(0.5));
        assert_eq!(flight.t, 0.5);
        // 0.25 up to the plane, 0.5 in the second cell: a quarter of it.
        assert_eq!(grid.fly(&mut flight, 0.75), Some(2.0));
        assert_eq!(flight.place(), Point([1.25, 0.5, 0.5]));
        assert_eq!(grid.content(), Some(2.5));
        assert_eq!(grid.fly(&mut flight, 1.6), None);
        assert_eq!(flight.t, 2.0);
        let mut back = grid.enter(Point([2.0, 0.5, 0.5]), Point([-1.0, 0.0, 0.0]));
        assert_eq!(grid.fly(&mut back, 2.25), Some(0.5));
        assert_eq!(back.t, 1.5);
    }

    #[test]
    fn empty_cells_cost_nothing() {
        let mut grid = grid();
        grid.values[0] = 0.0;
        assert_eq!(grid.empty_share(), 0.5);
        let mut flight = grid.enter(Point([0.0, 0.5, 0.5]), Point([1.0, 0.0, 0.0]));
        assert_eq!(grid.fly(&mut flight, 1.0), Some(2.0));
        assert_eq!(flight.t, 1.5);
        let mut across = grid.enter(Point([0.5, 0.0, 0.5]), Point([0.0, 1.0, 0.0]));
        assert_eq!(grid.fly(&mut across, 1e-9), None);
    }

    #[test]
    fn cells_bound_the_field_along_any_ray_and_a_constant_grid_is_a_constant() {
        let volume: &Volume = &Eq21;
        let cells = Majorants::grid([7, 5, 9], 1.0, volume).expect("bounded");
        let direction = Point([0.3, -0.5, 0.7]).normalised().expect("a direction");
        let mut flight = cells.enter(Point([1.0, 2.0, 3.0]), direction);
        let mut seen = 0;
        while let Some(here) = cells.fly(&mut flight, 0.01) {
            assert!(volume.extinction_at(flight.place()) <= here);
            seen += 1;
        }
        assert!(seen > 100);
        assert!(
            (cells.bounds.clip(&Ray { length: 99.0, ..ray(&flight) }).to - flight.t).abs() < 1e-9
        );
        // A sphere is left at its own boundary, not at that of its box.
        assert!((flight.place() - Point([0.0, 0.0, 10.0])).norm() - 10.0 < 1e-9);
        let one = Majorants::constant(0.8, volume);
        assert_eq!((one.single_value(), one.largest_ratio()), (Some(0.8), 1.25));
        assert_eq!(cells.scaled(0.5).largest_ratio(), 2.0);
    }

    fn ray(flight: &Flight) -> Ray {
        Ray { origin: flight.origin, direction: flight.direction, length: 1.0 }
    }
}
