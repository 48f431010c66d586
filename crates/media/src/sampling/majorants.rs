//! σ̂ in space: one constant on a body, or a constant in each cell of a regular grid over it.
//!
//! ```text
//! cell (i, j, k) of n₁ × n₂ × n₃ cells over the box about the body:  σ̂ = factor · majorant of σ_t there
//! ```
//!
//! [`Flights`] go from plane to plane. Empty cells cost no lookup. With a factor below 1, σ̂ is below σ_t somewhere.
//!
//! Source: L. Szirmay-Kalos, B. Tóth, M. Magdics, *Free Path Sampling in High Resolution Inhomogeneous Participating
//! Media*, Computer Graphics Forum 30 (2011).

pub mod flights;

use crate::Volume;
use numeric::geometry::{Aabb, Bounds, Point};

/// Factor on a cell's bound, because lookups are rounded.
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

impl Majorants {
    /// A constant σ̂ on a volume.
    pub fn constant(value: f64, volume: &Volume) -> Self {
        let bounds = volume.bounds();
        let highest = match bounds.enclosing_box() {
            Some(within) => volume.majorant(&within),
            // The bound of an infinite volume is that over all space that doubles reach.
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

    /// σ̂ times a factor.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value *= factor);
        self.largest_ratio /= factor;
        self
    }

    /// The body in which particles are tracked.
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

    /// An upper bound of `σ_t/σ̂`: exact for cells up to their own margin.
    pub fn largest_ratio(&self) -> f64 {
        self.largest_ratio
    }

    /// `∫σ̂ dV`; `None` for cells over a ball: its boundary cuts off parts of cells.
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
}

/// The space that doubles reach without overflow of their squares.
const EVERYWHERE: Aabb = Aabb { low: Point([-1e150; 3]), high: Point([1e150; 3]) };

#[cfg(test)]
mod tests {
    use super::flights::{Flights, MajorantView};
    use super::*;
    use crate::eq21::Eq21;
    use numeric::geometry::Ray;
    use numeric::geometry::exit::along;

    fn grid() -> Majorants {
        let cells = [2, 1, 1];
        let low = Point([0.0; 3]);
        let cube = Aabb { low, high: Point([2.0, 1.0, 1.0]) };
        let values = vec![0.5, 2.0];
        let bounds = Bounds::Box(cube);
        Majorants { bounds, low, width: [1.0; 3], cells, values, largest_ratio: 1.0 }
    }

    /// A flight of one particle.
    struct SingleFlight<'a>(MajorantView<'a>, Flights<f64>);

    impl<'a> SingleFlight<'a> {
        fn enter(grid: &'a Majorants, origin: [f64; 3], direction: [f64; 3]) -> Self {
            let (ground, mut flight) = (MajorantView::new(grid, None), Flights::new(0.0));
            (flight.origin, flight.direction) = (origin, direction);
            flight.enter(&ground, true, &ground.reach([origin, direction], true));
            Self(ground, flight)
        }

        /// Flies, and returns σ̂ at the end.
        fn fly(&mut self, depth: f64) -> Option<f64> {
            let flown = self.1.fly(&self.0, true, depth, |here, _| here);
            flown.inside.then_some(flown.sampling)
        }

        fn place(&self) -> Point {
            Point(along(self.1.origin, self.1.direction, self.1.t))
        }
    }

    #[test]
    fn a_flight_spends_its_depth_cell_by_cell() {
        let grid = grid();
        let mut flight = SingleFlight::enter(&grid, [0.0, 0.5, 0.5], [1.0, 0.0, 0.0]);
        assert_eq!(flight.fly(0.25), Some(0.5));
        assert_eq!(flight.1.t, 0.5);
        // 0.25 up to the plane, 0.5 in the second cell: a quarter of it.
        assert_eq!(flight.fly(0.75), Some(2.0));
        assert_eq!(flight.place(), Point([1.25, 0.5, 0.5]));
        assert_eq!(grid.content(), Some(2.5));
        assert_eq!(flight.fly(1.6), None);
        assert_eq!(flight.1.t, 2.0);
        let mut back = SingleFlight::enter(&grid, [2.0, 0.5, 0.5], [-1.0, 0.0, 0.0]);
        assert_eq!(back.fly(2.25), Some(0.5));
        assert_eq!(back.1.t, 1.5);
    }

    #[test]
    fn empty_cells_cost_nothing() {
        let mut grid = grid();
        grid.values[0] = 0.0;
        assert_eq!(grid.empty_share(), 0.5);
        let mut flight = SingleFlight::enter(&grid, [0.0, 0.5, 0.5], [1.0, 0.0, 0.0]);
        assert_eq!(flight.fly(1.0), Some(2.0));
        assert_eq!(flight.1.t, 1.5);
        let mut across = SingleFlight::enter(&grid, [0.5, 0.0, 0.5], [0.0, 1.0, 0.0]);
        assert_eq!(across.fly(1e-9), None);
    }

    #[test]
    fn cells_bound_the_field_along_any_ray_and_a_constant_grid_is_a_constant() {
        let volume: &Volume = &Eq21;
        let cells = Majorants::grid([7, 5, 9], 1.0, volume).expect("bounded");
        let direction = Point([0.3, -0.5, 0.7]).normalised().expect("a direction");
        let mut flight = SingleFlight::enter(&cells, [1.0, 2.0, 3.0], direction.0);
        let mut seen = 0;
        while let Some(here) = flight.fly(0.01) {
            assert!(volume.extinction_at(flight.place()) <= here);
            seen += 1;
        }
        assert!(seen > 100);
        let ray = Ray { origin: Point([1.0, 2.0, 3.0]), direction, length: 99.0 };
        assert!((cells.bounds.clip(&ray).to - flight.1.t).abs() < 1e-9);
        // A sphere is left at its own boundary, not at that of its box.
        assert!((flight.place() - Point([0.0, 0.0, 10.0])).norm() - 10.0 < 1e-9);
        let one = Majorants::constant(0.8, volume);
        assert_eq!((one.single_value(), one.largest_ratio()), (Some(0.8), 1.25));
        assert_eq!(cells.scaled(0.5).largest_ratio(), 2.0);
    }
}
