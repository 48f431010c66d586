//! A voxel grid, from a file or at random.
//!
//! ```text
//! trilinear: σ_t(p) = Σ over the 8 samples about p of Πⱼ (1 − |uⱼ − cⱼ|) · extinction · value(c)
//! nearest:   σ_t(p) = extinction · value of the nearest sample
//! ```
//!
//! 3-D only. The field is zero outside its box.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `file` | `"x.npy"` (NumPy), `"x.vol"` (Mitsuba), `"x.vdb"` (`OpenVDB`), `"x.nvdb"` (`NanoVDB`) or `"x.pbrt"` (pbrt), relative to the case file | | this or `random` |
//! | `axes` | of a `.npy` file: the order of the array's axes, first to last: `"zyx"`, `"xyz"` or another order of the three letters | | `"zyx"` |
//! | `channel` | of a `.vol` file: a channel, counted from 0 | | its only channel |
//! | `grid` | of a `.vdb`, `.nvdb` or `.pbrt` file: the name of a grid or a medium | | its only grid of floats |
//! | `random` | `{ size = [nx, ny, nz], seed }`: sample (i, j, k) is hash3(i, j, k, seed)/2³² | | this or `file` |
//! | `bounds` | `box = { low, high }` | length | the box in a `.vol` or `.pbrt` file, else required |
//! | `extinction` | factor on every sample, ≥ 0 | 1/length | 1 |
//! | `interpolation` | `"trilinear"` or `"nearest"` | | `"trilinear"` |
//! | `samples` | `"vertices"`: from corner to corner of the box, u = p(n−1); `"centres"`: in the middle of n cells, u = pn − ½ | | `"centres"` |
//! | `border` | with `"centres"`, samples beyond the box: `"clamp"` (Mitsuba) or `"zero"` (pbrt) | | `"zero"` for `.pbrt`, else `"clamp"` |
//!
//! # Which axis is x
//!
//! A `.npy` file is `array[z, y, x]`, of shape (nz, ny, nx), as in Mitsuba's and pbrt's grids: the last axis is x.
//! With `axes = "xyz"` it is `array[x, y, z]`, of shape (nx, ny, nz), and so on, for arrays in C and in Fortran
//! order. All other formats define which axis is x, and take no `axes`. `trueflight plan` shows the voxels along x,
//! y and z of each grid from a file, and `trueflight inspect FILE` its other contents. Numbers may be float16,
//! float32, float64, integers (without scaling) or booleans, of either byte order.
//!
//! # Formats
//!
//! `.vol`: float32, float16 or uint8, of which 255 is 1; of several channels `channel` is read. `.pbrt`: the density of a
//! `uniformgrid` medium and its box; pbrt's σ_t is that times `scale` and `sigma_a + sigma_s`, which is given as
//! `extinction`. `.nvdb`: grids of the types Float, Fp4, Fp8, Fp16 and `FpN`, of `NanoVDB` 32, plain, zipped or Blosc.
//!
//! A `.vdb` or `.nvdb` file defines the positions of its voxels, and takes neither `bounds` nor `samples` nor
//! `border`: the voxel (i, j, k) is a sample at matrix·(i, j, k) + shift of its transform. Voxels that are not
//! background are surrounded by samples of the background: the field falls to it at the next index (`OpenVDB`'s
//! `BoxSampler`; its `PointSampler` with `"nearest"`), and is 0 beyond. `OpenVDB`'s background has no end; that of
//! a medium ends at this box, and `plan` reports it if it is not 0. A voxel has the stored value, active or not.
//! The transform may rotate and shear the lattice; the bounds are then the box along the axes about it.
//!
//! Here p runs from 0 to 1 across the box. Between two planes of the lattice the field along a ray is a cubic. Its
//! coefficients are prepared once a ray; lookups, optical depth (Simpson's rule, exact for cubics) and free flight
//! (prefix sums and a bracketed root in one cell) use them. A cubic is the interpolation of the samples to
//! rounding: 32 units in the last place of the largest sample, and the rounding of the position; see the test.
//!
//! ```toml
//! title = "An example of grid"
//!
//! [problem.transmittance]
//! volume.grid = { random = { size = [8, 6, 5], seed = 3 }, samples = "centres", bounds.box = { low = [-2, -1.5, -1], high = [2, 1.5, 1] } }
//! ray = { origin = [-3, -0.9, -0.55], direction = [1, 0.3, 0.2], length = 6 }
//! sampling = 1
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::sync::Arc;

use super::cells::Cells;
use super::cubics::Cubics;
use super::grid_settings::{
    contents, format, no_placement, own_bounds, random, read_bounds, read_placement, read_samples,
};
use super::voxels::{Interpolation, Placement, Voxels};
use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader, Smoothness};
use crate::catalogue::{Domain, Settings};
use crate::formats::Format;
use numeric::geometry::{Aabb, Bounds, Ray};
use numeric::{Known, Lane, Span};

/// A voxel grid as a volume.
pub struct Grid {
    voxels: Arc<Voxels>,
    /// Number of samples along each axis, if they are in the middle of cells.
    cells: Option<[usize; 3]>,
    /// Contents of the file; empty for a random grid.
    contents: Vec<String>,
}

impl Grid {
    /// Random samples in [0, 1), as of the setting `random`.
    pub fn random(
        size: [usize; 3],
        seed: u32,
        bounds: Aabb,
        interpolation: Interpolation,
        placement: Placement,
    ) -> Self {
        let samples = random(size, seed);
        let voxels = Voxels::new(&samples, 1.0, bounds, interpolation, placement);
        Self::placed(voxels, size, placement, Vec::new())
    }

    fn placed(
        voxels: Voxels,
        size: [usize; 3],
        placement: Placement,
        contents: Vec<String>,
    ) -> Self {
        let cells = (placement != Placement::Vertices).then_some(size);
        Self { voxels: Arc::new(voxels), cells, contents }
    }
}

/// A voxel grid along a ray.
pub struct GridRay {
    voxels: Arc<Voxels>,
    /// Sizes of the numbers that make the start and the slope on the lattice.
    terms: [[f64; 3]; 2],
    cells: Cells,
    cubics: Vec<[f64; 4]>,
    lookups: Cubics,
}

/// Integral over part of a cell, given the number of the cell, its interval and the part.
fn simpson(cubics: &[[f64; 4]]) -> impl Fn(usize, Span, Span) -> f64 {
    |index, cell, part| {
        if cell.is_empty() {
            return 0.0;
        }
        let value = |t: f64| {
            let x = (t - cell.from) / cell.length();
            let [a, b, c, d] = cubics[index];
            ((d * x + c) * x + b) * x + a
        };
        part.length() / 6.0 * (value(part.from) + 4.0 * value(part.middle()) + value(part.to))
    }
}

impl GridRay {
    fn new(voxels: Arc<Voxels>, ray: &Ray, inside: Span) -> Self {
        let track = voxels.track(ray);
        let cells = Cells::cross(track, inside);
        let cubics: Vec<[f64; 4]> = (0..cells.count())
            .map(|index| cells.cell(index))
            .map(|cell| {
                let step = track.slope.map(|b| b * cell.length());
                voxels.cubic(track.at(cell.middle()), track.at(cell.from), step)
            })
            .collect();
        let cells = cells.summed(simpson(&cubics));
        let lookups = Cubics::new(track, inside, |middle, from| {
            voxels.cubic(track.at(middle), track.at(from), track.slope)
        });
        let terms = voxels.terms(ray);
        Self { voxels, terms, cells, cubics, lookups }
    }
}

impl Extinction for GridRay {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        self.lookups.value(t)
    }

    fn facts(&self) -> Facts<'_> {
        // The square of a cubic has degree 6.
        Facts { panel_nodes: Some(4), has_inverse: true, ..Facts::default() }
    }
}

impl OpticalDepth for GridRay {
    fn optical_depth(&self, span: Span) -> Known {
        let depth = self.cells.integrate(span, simpson(&self.cubics));
        // Positions are rounded, and the field changes by less than its highest sample in a cell; where it jumps,
        // each plane moves by the rounding of its distance.
        let [start, slope] = self.terms;
        let reach = |t: f64| (0..3).map(move |j| start[j] + slope[j] * t.abs());
        let places = span.length() * reach(span.to.abs().max(span.from.abs())).sum::<f64>();
        let jumps =
            if self.voxels.jumps() { self.cells.count() as f64 * span.to.abs() } else { 0.0 };
        let rounding = 4.0 * depth.value + self.voxels.peak() * (2.0 * places + jumps);
        depth.blurred(f64::EPSILON * rounding)
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        self.cells.crossings(span)
    }

    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        self.cells.invert(span, depth, simpson(&self.cubics))
    }
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::new(&["extinction"]).volume(read_volume)
}

fn read_volume(settings: &Settings) -> Option<Grid> {
    let samples = read_samples(settings);
    let kinds = [("trilinear", Interpolation::Trilinear), ("nearest", Interpolation::Nearest)];
    let interpolation = settings.one_of("interpolation", &kinds);
    let format = format(settings);
    let has_transform = format.is_some_and(Format::has_transform);
    let placement = match format {
        Some(format) if has_transform => no_placement(settings, format),
        _ => read_placement(settings, format),
    };
    let factor = settings.number_or("extinction", Domain::NonNegative, 1.0);
    let bounds = (!has_transform && settings.has("bounds")).then(|| read_bounds(settings));
    let (samples, placement, factor, interpolation) =
        (samples?, placement?, factor?, interpolation?);
    let bounds = match bounds {
        Some(given) => given?,
        None => own_bounds(settings, &samples)?,
    };
    if placement == Placement::Vertices && samples.size.iter().any(|&n| n < 2) {
        let [x, y, z] = samples.size;
        let message = format!("{x} × {y} × {z} samples do not reach from corner to corner");
        settings.fault("samples", message, "give two or more along each axis, or \"centres\"");
        return None;
    }
    let contents = contents(settings, &samples, bounds);
    let voxels = Voxels::new(&samples, factor, bounds, interpolation, placement);
    Some(Grid::placed(voxels, samples.size, placement, contents))
}

impl Field for Grid {
    fn facts(&self) -> Facts<'_> {
        // Cells whose faces are not along the axes are no better than layers.
        let is_turned = self.voxels.is_turned();
        let smoothness = if is_turned { Smoothness::Layers } else { Smoothness::Cells };
        let cells = self.cells.map(|size| (size, self.voxels.is_nearest()));
        Facts { smoothness, cells, contents: &self.contents, ..Facts::default() }
    }

    fn bounds(&self) -> Bounds {
        Bounds::Box(self.voxels.bounds())
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        self.voxels.value(self.voxels.lattice(p))
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        // A cubic may exceed the samples about it by its rounding.
        self.voxels.highest(within) * (1.0 + 64.0 * f64::EPSILON)
    }

    fn max_lattice_coordinate(&self, ray: &Ray, inside: Span) -> f64 {
        self.voxels.track(ray).max_coordinate(inside)
    }

    fn along(&self, ray: &Ray, inside: Span) -> Arc<Profile> {
        Arc::new(GridRay::new(self.voxels.clone(), ray, inside))
    }
}

#[cfg(test)]
mod tests {
    use super::super::lattice::Track;
    use super::*;
    use numeric::geometry::Point;

    #[test]
    fn cubics_are_the_interpolation_to_rounding() {
        let cube = Aabb { low: Point([-1.0, 0.0, 2.0]), high: Point([4.0, 3.0, 4.0]) };
        let places = [Placement::Vertices, Placement::CentresClamped, Placement::CentresZero];
        for (seed, placement) in (0..).zip(places) {
            let (samples, linear) = (random([9, 8, 7], seed), Interpolation::Trilinear);
            let field = Arc::new(Voxels::new(&samples, 1.0, cube, linear, placement));
            let directions =
                [[1.0, 0.6, 0.4], [-1.0, 0.3, 0.0], [0.0, 0.0, -1.0], [1e-9, -1.0, 1e-3]];
            for direction in directions {
                let direction = Point(direction);
                let ray = Ray::new(Point([1.1, 1.3, 2.9]) - direction * 4.0, direction, 20.0);
                let ray = ray.expect("a direction");
                let inside = Bounds::Box(cube).clip(&ray);
                let seen = GridRay::new(field.clone(), &ray, inside);
                for n in 0..=20_000 {
                    let t = inside.from + inside.length() * (f64::from(n) / 20_000.0);
                    let Track { start, slope } = field.track(&ray);
                    let at: [f64; 3] = std::array::from_fn(|j| start[j] + slope[j] * t);
                    // The field changes by less than its largest sample in a cell.
                    let place: f64 =
                        (0..3).map(|j| start[j].abs() + 2.0 * (slope[j] * t).abs()).sum();
                    let bound = f64::EPSILON * field.peak() * (32.0 + place);
                    let off = (seen.extinction(t) - field.value(at)).abs();
                    assert!(off <= bound, "{direction:?} at {t}: {off:e} above {bound:e}");
                }
            }
        }
    }
}
