//! Lattices with axes of their own, which are not those of the world.

use super::grid_file::Turned;
use super::voxels::Interpolation;
use numeric::Lane;

/// Map from the world to a turned or sheared lattice: u = rows · (p − origin) + shift.
pub(super) struct Turn {
    origin: [f64; 3],
    rows: [[f64; 3]; 3],
    /// The lowest and the highest coordinate of the lattice along each axis: beyond them the field is 0.
    ends: [[f64; 2]; 3],
}

impl Turn {
    /// The map to a lattice with a number of samples.
    pub(super) fn new(turned: &Turned, size: [usize; 3], interpolation: Interpolation) -> Self {
        let Turned { origin, steps } = *turned;
        let column = |j: usize| [0, 1, 2].map(|i| steps[i][j]);
        let [a, b, c] = [column(0), column(1), column(2)];
        let volume = dot(a, cross(b, c));
        let rows = [cross(b, c), cross(c, a), cross(a, b)].map(|row| row.map(|x| x / volume));
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
        let (x, y, z) = (x - a, y - b, z - c);
        [
            x * p[0] + y * p[1] + z * p[2] + shift,
            x * q[0] + y * q[1] + z * q[2] + shift,
            x * r[0] + y * r[1] + z * r[2] + shift,
        ]
    }

    /// A direction in lattice coordinates.
    pub(super) fn slope(&self, direction: [f64; 3]) -> [f64; 3] {
        self.rows.map(|row| dot(row, direction))
    }

    /// Sizes for a beginning and a direction: 2 ε of each bounds the rounding of its lattice coordinates. Up to five
    /// operations round the three terms, by ε/2 each.
    pub(super) fn terms(&self, [point, direction]: [[f64; 3]; 2], shift: f64) -> [[f64; 3]; 2] {
        let far = [0, 1, 2].map(|j| (point[j] - self.origin[j]).abs());
        let size = |terms: [f64; 3]| self.rows.map(|row| 1.25 * dot(row.map(f64::abs), terms));
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

    /// Returns true if a position in lattice coordinates is on the lattice.
    pub(super) fn holds(&self, u: [f64; 3]) -> bool {
        (0..3).all(|j| self.ends[j][0] <= u[j] && u[j] <= self.ends[j][1])
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|j| a[j] * b[j]).sum()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|j| {
        let (k, l) = ((j + 1) % 3, (j + 2) % 3);
        a[k] * b[l] - a[l] * b[k]
    })
}
