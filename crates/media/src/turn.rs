//! Lattices with axes of their own, which are not those of the world.

use super::grid_file::Turned;
use super::voxels::Interpolation;
use numeric::Lane;
use numeric::geometry::Point;

/// Map from the world to a turned or sheared lattice: u = rows · (p − origin) + shift.
pub(super) struct Turn {
    origin: [f64; 3],
    rows: [Point; 3],
    /// The lowest and the highest coordinate of the lattice along each axis: beyond them the field is 0.
    ends: [[f64; 2]; 3],
}

impl Turn {
    /// The map to a lattice with a number of samples.
    pub(super) fn new(turned: &Turned, size: [usize; 3], interpolation: Interpolation) -> Self {
        let Turned { origin, steps } = *turned;
        let [a, b, c] = [0, 1, 2].map(|j| Point([0, 1, 2].map(|i| steps[i][j])));
        let volume = a.dot(b.cross(c));
        let rows = [b.cross(c), c.cross(a), a.cross(b)].map(|row| Point(row.0.map(|x| x / volume)));
        // The nearest samples are those of whole voxels, without the layer of background about them.
        let ends = size.map(|n| match interpolation {
            Interpolation::Trilinear => [0.0, (n - 1) as f64],
            Interpolation::Nearest => [1.0, (n - 1) as f64],
        });
        Self { origin, rows, ends }
    }

    /// A point in lattice coordinates.
    #[inline(always)]
    pub(super) fn lattice<L: Lane>(&self, [x, y, z]: [L; 3], shift: f64) -> [L; 3] {
        let ([a, b, c], [p, q, r]) = (self.origin, self.rows);
        let from_origin = [x - a, y - b, z - c];
        [p.along(from_origin) + shift, q.along(from_origin) + shift, r.along(from_origin) + shift]
    }

    /// A direction in lattice coordinates.
    pub(super) fn slope(&self, direction: [f64; 3]) -> [f64; 3] {
        self.rows.map(|row| row.dot(Point(direction)))
    }

    /// Sizes for a beginning and a direction: 2 ε of each bounds the rounding of its lattice coordinates. Up to five
    /// operations round the three terms, by ε/2 each.
    pub(super) fn terms(&self, [point, direction]: [[f64; 3]; 2], shift: f64) -> [[f64; 3]; 2] {
        let far = [0, 1, 2].map(|j| (point[j] - self.origin[j]).abs());
        let sizes = self.rows.map(|row| Point(row.0.map(f64::abs)));
        let size = |terms: [f64; 3]| sizes.map(|row| 1.25 * row.dot(Point(terms)));
        [size(far).map(|x| x + shift), size(direction.map(f64::abs))]
    }

    /// Returns the value at a position of the lattice; 0 outside it.
    #[inline(always)]
    pub(super) fn cut<L: Lane>(&self, at: [L; 3], value: L) -> L {
        let zero = value.each(0.0);
        let mut inside = zero.at_most(zero);
        for (axis, &u) in at.iter().enumerate() {
            let [low, high] = self.ends[axis];
            inside = inside & zero.each(low).at_most(u) & u.at_most(zero.each(high));
        }
        L::select(inside, value, zero)
    }

    /// Returns whether a position in lattice coordinates is on the lattice.
    pub(super) fn holds(&self, u: [f64; 3]) -> bool {
        (0..3).all(|j| self.ends[j][0] <= u[j] && u[j] <= self.ends[j][1])
    }
}
