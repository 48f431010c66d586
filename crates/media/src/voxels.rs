//! Samples on a lattice, their interpolation at a point and in a whole cell.
//!
//! ```text
//! u = (p − low)·scale + shift,   i = ⌊u⌋,   f = u − i
//! trilinear: Σ over the 8 samples about u of Πⱼ (1 − |uⱼ − cⱼ|) · value(c)      nearest: value(i)
//! ```
//!
//! On a turned lattice u is a matrix times p − origin. The field is 0 in its bounds outside the lattice.
//!
//! Border samples are stored, so that lookups do not test for them: cell-centred grids that are interpolated get a
//! layer of them on every side.

use super::grid_file::Samples;
use super::lattice::Track;
use super::turn::Turn;
use numeric::Lane;
use numeric::geometry::{Aabb, Ray};

/// Interpolation between samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// Linear along x, y and z.
    Trilinear,
    /// The value of the nearest sample.
    Nearest,
}

/// Positions of the samples in the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Placement {
    /// On the lattice from corner to corner of the box: n − 1 cells along each axis.
    Vertices,
    /// In the middle of n cells along each axis; beyond the outermost samples the field is constant.
    CentresClamped,
    /// In the middle of n cells along each axis; samples beyond the box are zero.
    CentresZero,
}

/// A voxel grid in a box.
pub struct Voxels {
    size: [usize; 3],
    values: Vec<f64>,
    bounds: Aabb,
    interpolation: Interpolation,
    scale: [f64; 3],
    shift: f64,
    /// The largest index of a cell along each axis.
    last: [usize; 3],
    peak: f64,
    turn: Option<Turn>,
}

impl Voxels {
    /// The samples times a factor, in a box. With `Vertices` there are two or more along each axis.
    pub fn new(
        samples: &Samples,
        factor: f64,
        bounds: Aabb,
        interpolation: Interpolation,
        placement: Placement,
    ) -> Self {
        let vertices = placement == Placement::Vertices;
        let edge: [f64; 3] = std::array::from_fn(|j| bounds.high.0[j] - bounds.low.0[j]);
        let cells = samples.size.map(|n| if vertices { n - 1 } else { n } as f64);
        let scale = std::array::from_fn(|j| cells[j] / edge[j]);
        let pad = usize::from(interpolation == Interpolation::Trilinear && !vertices);
        let size = samples.size.map(|n| n + 2 * pad);
        let mut values = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    values.push(factor * sample(samples, [x, y, z], pad, placement));
                }
            }
        }
        // Nearest: cells begin half a step below their sample. Centres: the first sample stands
        // half a step inside the box, and one step further on behind its border sample.
        let (shift, last) = match (interpolation, vertices) {
            (Interpolation::Trilinear, true) => (0.0, size.map(|n| n - 2)),
            (Interpolation::Trilinear, false) => (0.5, size.map(|n| n - 2)),
            (Interpolation::Nearest, true) => (0.5, size.map(|n| n - 1)),
            (Interpolation::Nearest, false) => (0.0, size.map(|n| n - 1)),
        };
        let peak = values.iter().copied().fold(0.0, f64::max);
        let turn = samples.turned.as_ref().map(|turned| Turn::new(turned, size, interpolation));
        Self { size, values, bounds, interpolation, scale, shift, last, peak, turn }
    }

    /// The box.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The largest sample.
    pub fn peak(&self) -> f64 {
        self.peak
    }

    /// Returns whether a lookup takes the nearest sample.
    pub fn is_nearest(&self) -> bool {
        self.interpolation == Interpolation::Nearest
    }

    /// Returns whether the field jumps between cells.
    pub fn jumps(&self) -> bool {
        self.is_nearest() || self.turn.is_some()
    }

    /// Returns whether the axes of the lattice are not those of the world.
    pub fn is_turned(&self) -> bool {
        self.turn.is_some()
    }

    /// A point in lattice coordinates: cells lie between integers.
    #[inline(always)]
    pub fn lattice<L: Lane>(&self, [x, y, z]: [L; 3]) -> [L; 3] {
        if let Some(turn) = &self.turn {
            return turn.lattice([x, y, z], self.shift);
        }
        let ([a, b, c], [i, j, k]) = (self.bounds.low.0, self.scale);
        [(x - a) * i + self.shift, (y - b) * j + self.shift, (z - c) * k + self.shift]
    }

    /// A ray in lattice coordinates.
    pub fn track(&self, ray: &Ray) -> Track {
        let slope = match &self.turn {
            Some(turn) => turn.slope(ray.direction.0),
            None => std::array::from_fn(|j| ray.direction.0[j] * self.scale[j]),
        };
        Track { start: self.lattice(ray.origin.0), slope }
    }

    /// Sizes for a ray's start and its slope: 2 ε of each bounds the rounding of lattice coordinates.
    pub fn terms(&self, ray: &Ray) -> [[f64; 3]; 2] {
        if let Some(turn) = &self.turn {
            return turn.terms([ray.origin.0, ray.direction.0], self.shift);
        }
        let Track { start, slope } = self.track(ray);
        [start.map(f64::abs), slope.map(f64::abs)]
    }

    /// The cell that holds a position, and the position within it; a position that rounding left outside the box
    /// counts as on its face.
    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below 2^27 and above 0
    fn place(&self, u: [f64; 3]) -> ([usize; 3], [f64; 3]) {
        let mut cell = [0; 3];
        let mut rest = [0.0; 3];
        for j in 0..3 {
            let last = self.last[j];
            let inside = u[j].max(0.0).min((last + 1) as f64);
            cell[j] = (inside as i32 as usize).min(last);
            rest[j] = inside - cell[j] as f64;
        }
        (cell, rest)
    }

    /// Cell and position within it for lanes along one axis.
    #[inline(always)]
    fn place_along<L: Lane>(&self, axis: usize, u: L) -> (L, L) {
        let last = self.last[axis] as f64;
        let inside = u.or_more(u.each(0.0)).or_less(u.each(last + 1.0));
        let cell = Lane::floor(inside).or_less(u.each(last));
        (cell, inside - cell)
    }

    /// The field at a position in lattice coordinates.
    #[inline(always)]
    pub fn value<L: Lane>(&self, at: [L; 3]) -> L {
        let [x, y, z] = at;
        let ((i, x), (j, y)) = (self.place_along(0, x), self.place_along(1, y));
        let (k, z) = self.place_along(2, z);
        let [nx, ny, _] = self.size.map(|n| n as f64);
        let first = (k * ny + j) * nx + i;
        let value = if self.interpolation == Interpolation::Nearest {
            first.entry(&self.values)
        } else {
            self.linear(first, [x, y, z])
        };
        let Some(turn) = &self.turn else { return value };
        turn.cut(at, value)
    }

    /// Interpolates between the eight samples from the index `first` on.
    #[inline(always)]
    fn linear<L: Lane>(&self, first: L, [x, y, z]: [L; 3]) -> L {
        let [nx, ny, _] = self.size.map(|n| n as f64);
        let near = between(y, self.row(first, x), self.row(first + nx, x));
        let above = first + nx * ny;
        between(z, near, between(y, self.row(above, x), self.row(above + nx, x)))
    }

    /// Interpolates between a sample and the next along x.
    #[inline(always)]
    fn row<L: Lane>(&self, at: L, share: L) -> L {
        between(share, at.entry(&self.values), (at + 1.0).entry(&self.values))
    }

    /// The field along an interval of a ray within the cell about `middle`: a polynomial in the relative position
    /// `x ∈ [0, 1]`. The interval begins at `start` and has the total change `step`.
    pub fn cubic(&self, middle: [f64; 3], start: [f64; 3], step: [f64; 3]) -> [f64; 4] {
        if self.turn.as_ref().is_some_and(|turn| !turn.holds(middle)) {
            return [0.0; 4];
        }
        let ([i, j, k], _) = self.place(middle);
        let [nx, ny, _] = self.size;
        let first = (k * ny + j) * nx + i;
        if self.interpolation == Interpolation::Nearest {
            return [self.values[first], 0.0, 0.0, 0.0];
        }
        let from = [start[0] - i as f64, start[1] - j as f64, start[2] - k as f64];
        // a + (from + step·x)(b − a), for polynomials a and b in x.
        let lerp = |axis: usize, a: [f64; 4], b: [f64; 4]| {
            let rise: [f64; 4] = std::array::from_fn(|n| b[n] - a[n]);
            std::array::from_fn(|n| {
                let shifted = if n == 0 { 0.0 } else { step[axis] * rise[n - 1] };
                a[n] + from[axis] * rise[n] + shifted
            })
        };
        let row = |at: usize| {
            let constant = |value: f64| [value, 0.0, 0.0, 0.0];
            lerp(0, constant(self.values[at]), constant(self.values[at + 1]))
        };
        let near = lerp(1, row(first), row(first + nx));
        let far = lerp(1, row(first + nx * ny), row(first + nx * ny + nx));
        lerp(2, near, far)
    }

    /// The lowest and the highest lattice coordinates of a box.
    fn reach(&self, within: &Aabb) -> [[f64; 3]; 2] {
        let ends = [self.lattice(within.low.0), self.lattice(within.high.0)];
        if self.turn.is_none() {
            return ends;
        }
        let corner =
            |n: usize| std::array::from_fn(|j| [within.low.0, within.high.0][n >> j & 1][j]);
        (0..8).map(|n| self.lattice(corner(n))).fold(ends.map(|_| ends[0]), |[low, high], u| {
            [[0, 1, 2].map(|j| u[j].min(low[j])), [0, 1, 2].map(|j| u[j].max(high[j]))]
        })
    }

    /// The largest sample that a lookup in the box can use.
    pub fn highest(&self, within: &Aabb) -> f64 {
        // A billionth of a cell covers the rounding of a lookup's position.
        let [from, to] = self.reach(within);
        let low = self.place(from.map(|u| u - 1e-9)).0;
        let high = self.place(to.map(|u| u + 1e-9)).0;
        let more = usize::from(self.interpolation == Interpolation::Trilinear);
        let [nx, ny, _] = self.size;
        let mut highest = 0.0f64;
        for z in low[2]..=high[2] + more {
            for y in low[1]..=high[1] + more {
                let row = (z * ny + y) * nx;
                let row = &self.values[row + low[0]..=row + high[0] + more];
                highest = row.iter().copied().fold(highest, f64::max);
            }
        }
        highest
    }
}

/// Interpolates from one value to another by a share.
#[inline(always)]
fn between<L: Lane>(share: L, from: L, to: L) -> L {
    from + share * (to - from)
}

/// The sample at an index of the padded grid.
fn sample(samples: &Samples, at: [usize; 3], pad: usize, placement: Placement) -> f64 {
    let [nx, ny, _] = samples.size;
    let inner: [usize; 3] =
        std::array::from_fn(|j| at[j].saturating_sub(pad).min(samples.size[j] - 1));
    let outside = (0..3).any(|j| at[j] != inner[j] + pad);
    if outside && placement == Placement::CentresZero {
        return 0.0;
    }
    samples.values[(inner[2] * ny + inner[1]) * nx + inner[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::geometry::Point;

    fn pair(interpolation: Interpolation, placement: Placement) -> impl Fn(f64) -> f64 {
        let samples = Samples {
            size: [2, 2, 2],
            values: vec![1.0, 3.0, 1.0, 3.0, 1.0, 3.0, 1.0, 3.0],
            ..Samples::default()
        };
        let cube = Aabb { low: Point([0.0; 3]), high: Point([4.0; 3]) };
        let grid = Voxels::new(&samples, 1.0, cube, interpolation, placement);
        move |x| grid.value(grid.lattice([x, 2.0, 2.0]))
    }

    #[test]
    fn conventions_differ_at_the_border() {
        let clamped = pair(Interpolation::Trilinear, Placement::CentresClamped);
        assert_eq!([0.0, 1.0, 2.0, 4.0].map(clamped), [1.0, 1.0, 2.0, 3.0]);
        let zero = pair(Interpolation::Trilinear, Placement::CentresZero);
        assert_eq!([0.0, 1.0, 2.0, 4.0].map(zero), [0.5, 1.0, 2.0, 1.5]);
        let vertices = pair(Interpolation::Trilinear, Placement::Vertices);
        assert_eq!([0.0, 1.0, 2.0, 4.0].map(vertices), [1.0, 1.5, 2.0, 3.0]);
    }

    #[test]
    fn the_nearest_sample_changes_in_the_middle() {
        for placement in [Placement::CentresZero, Placement::Vertices] {
            let nearest = pair(Interpolation::Nearest, placement);
            assert_eq!([0.0, 1.9, 2.1, 4.0].map(nearest), [1.0, 1.0, 3.0, 3.0]);
        }
    }
}
