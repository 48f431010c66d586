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
//! | `file` | `"x.vol"` (Mitsuba), `"x.npy"` (NumPy) or `"x.vdb"` (`OpenVDB`), relative to the case file | | this or `random` |
//! | `grid` | of a `.vdb` file: the name of a grid | | its only grid of floats |
//! | `random` | `{ size = [nx, ny, nz], seed }`: sample (i, j, k) is hash3(i, j, k, seed)/2³² | | this or `file` |
//! | `bounds` | `box = { low, high }` | length | the box in a `.vol` file, else required |
//! | `extinction` | factor on every sample, ≥ 0 | 1/length | 1 |
//! | `interpolation` | `"trilinear"` or `"nearest"` | | `"trilinear"` |
//! | `samples` | `"vertices"`: from corner to corner of the box, u = p(n−1); `"centres"`: in the middle of n cells, u = pn − ½ | | `"centres"` |
//! | `border` | with `"centres"`, samples beyond the box: `"clamp"` (Mitsuba) or `"zero"` (pbrt) | | `"clamp"` |
//!
//! A `.vdb` file says itself where its voxels stand, and takes neither `bounds` nor `samples` nor `border`: the voxel
//! (i, j, k) is a sample at scale·(i, j, k) + shift of its transform. Beside the voxels that are not background stand
//! samples of the background, which must be 0: the field falls to 0 at the next index, and is 0 beyond (`OpenVDB`'s
//! `BoxSampler`; its `PointSampler` with `"nearest"`). A voxel has the value that is stored, whether it is active or not.
//!
//! Here p runs from 0 to 1 across the box. Between two planes of the lattice a ray sees a cubic,
//! whose coefficients are prepared once a ray; lookups, optical depth (Simpson's rule, exact for
//! cubics) and free flight (prefix sums and a bracketed root in one cell) use those. A cubic is the
//! interpolation of the samples to rounding: 32 units in the last place of the largest sample, and
//! the rounding of the place; see the test.

use std::path::Path;
use std::sync::Arc;

use super::cells::Cells;
use super::cubics::Cubics;
use super::grid_file::{self, MOST_SAMPLES, Samples};
use super::lattice::Track;
use super::voxels::{Interpolation, Placement, Voxels};
use super::{Extinction, Field, FreeFlight, OpticalDepth, Smoothness, body, lattice};
use crate::catalogue::{Domain, Settings, Value};
use crate::geometry::{Aabb, Bounds, Ray};
use crate::numeric::{Known, Lane, Span};

/// A voxel grid as a volume.
pub struct Grid(Arc<Voxels>);

/// A voxel grid along a ray.
pub struct GridRay {
    voxels: Arc<Voxels>,
    track: Track,
    cells: Cells,
    cubics: Vec<[f64; 4]>,
    lookups: Cubics,
}

/// `∫` over part of a cell with the given cubic.
fn simpson(cubic: [f64; 4], cell: Span, part: Span) -> f64 {
    if cell.is_empty() {
        return 0.0;
    }
    let value = |t: f64| {
        let x = (t - cell.from) / cell.length();
        ((cubic[3] * x + cubic[2]) * x + cubic[1]) * x + cubic[0]
    };
    part.length() / 6.0 * (value(part.from) + 4.0 * value(part.middle()) + value(part.to))
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
        let cells = cells.summed(|index, cell, part| simpson(cubics[index], cell, part));
        let lookups = Cubics::new(track, inside, |middle, from| {
            voxels.cubic(track.at(middle), track.at(from), track.slope)
        });
        Self { voxels, track, cells, cubics, lookups }
    }

    fn part(&self, index: usize, cell: Span, part: Span) -> f64 {
        simpson(self.cubics[index], cell, part)
    }
}

impl Extinction for GridRay {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        self.lookups.value(t)
    }
}

impl OpticalDepth for GridRay {
    fn optical_depth(&self, span: Span) -> Known {
        let depth = self.cells.integrate(span, |index, cell, part| self.part(index, cell, part));
        // Places are off by their rounding, and the field changes by less than its highest sample
        // in a cell; where it jumps, each plane moves by the rounding of its distance.
        let Track { start, slope } = self.track;
        let reach = |t: f64| (0..3).map(move |j| start[j].abs() + (slope[j] * t).abs());
        let places = span.length() * reach(span.to.abs().max(span.from.abs())).sum::<f64>();
        let jumps =
            if self.voxels.jumps() { self.cells.count() as f64 * span.to.abs() } else { 0.0 };
        let rounding = 4.0 * depth.value + self.voxels.peak() * (2.0 * places + jumps);
        Known::new(depth.value, depth.error + f64::EPSILON * rounding)
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        self.cells.crossings(span)
    }

    fn panel_nodes(&self) -> Option<usize> {
        // The square of a cubic has degree 6.
        Some(4)
    }
}

impl FreeFlight for GridRay {
    fn is_direct(&self) -> bool {
        true
    }

    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        self.cells.invert(span, depth, |index, cell, part| self.part(index, cell, part))
    }
}

impl Field for Grid {
    type Profile = GridRay;

    const IN_LINE: bool = false;

    fn volume(settings: &Settings) -> Option<Self> {
        let samples = read_samples(settings);
        let interpolation =
            settings.word_or("interpolation", &["trilinear", "nearest"], "trilinear");
        let is_vdb = has_vdb(settings);
        let placement = if is_vdb { no_placement(settings) } else { read_placement(settings) };
        let factor = settings.number_or("extinction", Domain::NonNegative, 1.0);
        let bounds = (!is_vdb && settings.has("bounds")).then(|| read_bounds(settings));
        let (samples, placement, factor) = (samples?, placement?, factor?);
        let interpolation = match interpolation? {
            "nearest" => Interpolation::Nearest,
            _ => Interpolation::Trilinear,
        };
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
        Some(Self(Arc::new(Voxels::new(&samples, factor, bounds, interpolation, placement))))
    }

    fn smoothness(&self) -> Smoothness {
        Smoothness::Cells
    }

    fn bounds(&self) -> Bounds {
        Bounds::Box(self.0.bounds())
    }

    #[inline(always)]
    fn extinction_at<L: Lane>(&self, p: [L; 3]) -> L {
        self.0.value(self.0.lattice(p))
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        // A cubic may exceed the samples about it by its rounding.
        self.0.highest(within) * (1.0 + 64.0 * f64::EPSILON)
    }

    fn farthest(&self, ray: &Ray, inside: Span) -> f64 {
        self.0.track(ray).farthest(inside)
    }

    fn along(&self, ray: &Ray, inside: Span) -> GridRay {
        GridRay::new(self.0.clone(), ray, inside)
    }
}

fn read_samples(settings: &Settings) -> Option<Samples> {
    match (settings.has("file"), settings.has("random")) {
        (true, false) => {
            let name = settings.text("file")?;
            let grid = if has_vdb(settings) {
                settings.optional("grid", |key| settings.text(key))?
            } else {
                None
            };
            let read = grid_file::read(&settings.folder.join(&name), grid.as_deref());
            read.map_err(|e| settings.fault("file", format!("{name}: {}", e.message), e.help)).ok()
        }
        (false, true) => read_random(&settings.table("random")?),
        (both, _) => {
            let found = if both { "both `file` and `random`" } else { "no samples are given" };
            let help = "give `file = \"x.vdb\"` or `random = { size = [nx, ny, nz], seed = n }`";
            settings.fault_at(settings.span.clone(), "", found, help);
            None
        }
    }
}

#[allow(clippy::cast_possible_truncation)] // sizes and seed are read within 32 bits
fn read_random(settings: &Settings) -> Option<Samples> {
    let size = settings.counts("size", 1..=4096);
    let seed = settings.count_or("seed", 0..=u64::from(u32::MAX), 0);
    settings.close();
    let (size, seed) = (size?, seed? as u32);
    if size.iter().product::<usize>() as u64 > MOST_SAMPLES {
        let help = format!("a grid has at most {MOST_SAMPLES} samples");
        settings.fault("size", "the grid is too large", help);
        return None;
    }
    let [nx, ny, nz] = size.map(|n| n as u32);
    let hash = |x, y, z| f64::from(lattice::hash3(x, y, z, seed)) / 4_294_967_296.0;
    let rows = (0..nz).flat_map(|z| (0..ny).map(move |y| (y, z)));
    let values = rows.flat_map(|(y, z)| (0..nx).map(move |x| hash(x, y, z))).collect();
    Some(Samples { size, values, bounds: None })
}

/// Whether the samples are those of `OpenVDB`.
fn has_vdb(settings: &Settings) -> bool {
    let name = settings.entry("file").map(|entry| &entry.node.value);
    matches!(name, Some(Value::Text(name)) if grid_file::is_vdb(Path::new(name)))
}

/// The placement of a file that says it itself.
fn no_placement(settings: &Settings) -> Option<Placement> {
    let given = ["bounds", "samples", "border"].into_iter().filter(|key| settings.has(key));
    let faults = given.map(|key| {
        let message =
            format!("a .vdb file says itself where its voxels stand, and `{key}` has no say");
        settings.fault(key, message, "leave it out, or move the grid by its transform");
    });
    (faults.count() == 0).then_some(Placement::Vertices)
}

fn read_placement(settings: &Settings) -> Option<Placement> {
    if settings.word_or("samples", &["centres", "vertices"], "centres")? == "vertices" {
        return Some(Placement::Vertices);
    }
    let border = settings.word_or("border", &["clamp", "zero"], "clamp")?;
    Some(if border == "zero" { Placement::CentresZero } else { Placement::CentresClamped })
}

fn read_bounds(settings: &Settings) -> Option<Aabb> {
    let Bounds::Box(bounds) = body::read_bounds(settings)? else {
        settings.fault("bounds", "a grid has no sphere", "it takes `box = { low, high }`");
        return None;
    };
    Some(bounds)
}

/// The box that the file gives, if it is one.
fn own_bounds(settings: &Settings, samples: &Samples) -> Option<Aabb> {
    let proper = |bounds: &Aabb| {
        (0..3).all(|j| {
            let edge = bounds.high.0[j] - bounds.low.0[j];
            edge > 0.0 && edge.is_finite()
        })
    };
    let own = samples.bounds.filter(proper);
    if own.is_none() {
        let (key, found) = match samples.bounds {
            Some(_) => ("file", "the corners in the file do not make a box"),
            None => ("bounds", "the grid has no box"),
        };
        settings.fault(key, found, "give `bounds.box = { low = [x, y, z], high = [x, y, z] }`");
    }
    own
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

    fn grid(seed: u32) -> Grid {
        let hash =
            |n: u32| f64::from(lattice::hash3(n % 5, n / 5 % 5, n / 25, seed)) / 4_294_967_296.0;
        let samples = Samples { size: [5; 3], values: (0..125).map(hash).collect(), bounds: None };
        let cube = Aabb { low: Point([0.0; 3]), high: Point([4.0; 3]) };
        let (linear, vertices) = (Interpolation::Trilinear, Placement::Vertices);
        Grid(Arc::new(Voxels::new(&samples, 1.0, cube, linear, vertices)))
    }

    fn depth(field: &Grid, origin: [f64; 3], direction: [f64; 3]) -> Known {
        let ray = Ray::new(Point(origin), Point(direction), 100.0).expect("a direction");
        let inside = field.bounds().clip(&ray);
        field.along(&ray, inside).optical_depth(inside)
    }

    #[test]
    fn depths_agree_with_thirty_digit_arithmetic() {
        let rays = [
            ([-1.0, 0.4, 0.9], [4.2, 2.2, 1.9], 1.875_699_680_225_863_9),
            ([0.25, 1.5, -3.0], [0.0, 0.0, 1.0], 2.094_530_095_055_233_7),
        ];
        for (origin, direction, exact) in rays {
            let depth = depth(&grid(7), origin, direction);
            let off = (depth.value - exact).abs();
            assert!(off <= depth.error && off < 4e-15, "{origin:?}: off by {off:e}");
        }
    }

    #[test]
    fn cubics_are_the_interpolation_to_rounding() {
        let samples = |seed: u32| {
            let hash = |n: u32| f64::from(lattice::hash3(n, 0, 0, seed)) / 4_294_967_296.0;
            Samples { size: [9, 8, 7], values: (0..504).map(hash).collect(), bounds: None }
        };
        let cube = Aabb { low: Point([-1.0, 0.0, 2.0]), high: Point([4.0, 3.0, 4.0]) };
        let places = [Placement::Vertices, Placement::CentresClamped, Placement::CentresZero];
        for (seed, placement) in (0..).zip(places) {
            let linear = Interpolation::Trilinear;
            let field = Arc::new(Voxels::new(&samples(seed), 1.0, cube, linear, placement));
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
                    let Track { start, slope } = seen.track;
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

    #[test]
    fn an_edge_is_the_trapezoid_of_its_samples() {
        let value = |z| f64::from(lattice::hash3(0, 0, z, 7)) / 4_294_967_296.0;
        let hand = 0.5 * (value(0) + value(4)) + value(1) + value(2) + value(3);
        let seen = depth(&grid(7), [0.0, 0.0, -1.0], [0.0, 0.0, 1.0]).value;
        assert!((seen - hand).abs() < 1e-15);
    }
}
