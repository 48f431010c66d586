//! Local majorants: σ̂ constant on the segments of a grid, each a bound of what lies in it.
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `segments` | cut the support into n equal segments and bound the residual on each | one of the two |
//! | `grid` | 3-D: `[nx, ny, nz]` cells over the volume's bounds; each bounds σ_t in its cell | is required |
//!
//! With `segments` the bound is the largest `|σ_t − σ_c|` of the segment, searched on the ray. With
//! `grid` it is the volume's own bound on each cell that the ray crosses, as a renderer stores it:
//! safe, and less tight; particles that leave the ray fly through the same cells. Free flight inverts the piecewise optical depth; `local-majorant` walks the
//! same segments and starts afresh at each boundary.
//!
//! Source: Y. Yue et al., *Unbiased, adaptive stochastic sampling for rendering inhomogeneous
//! participating media*, ACM Transactions on Graphics 29 (2010).
//!
//! ```toml
//! title = "An example of local-majorants"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling.local-majorants.segments = 10
//! estimators = ["woodcock"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Recipe, along_ray_only};
use crate::Knowledge;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::{Body, Control, Majorants, Piecewise, Volume};
use numeric::Span;
use numeric::geometry::{Aabb, Point, Ray};

/// A segment's bound is raised by this factor over the largest value that the search found.
const MARGIN: f64 = 1.0 + 1e-9;

/// More cells than this are a mistake in the case.
const MAX_CELLS: usize = 10_000_000;

/// Local majorants.
#[derive(Debug, Clone, Copy)]
pub enum LocalMajorants {
    /// Equal segments of the support.
    Segments(usize),
    /// Cells over the volume's bounds.
    Grid([usize; 3]),
}

impl FromSettings for LocalMajorants {
    /// Reads `{ segments }` or `{ grid }`.
    #[allow(clippy::cast_possible_truncation)] // at most 65536
    fn read(settings: &Settings, body: Option<&Body>) -> Option<Self> {
        match (settings.has("segments"), settings.has("grid")) {
            (true, false) => {
                settings.count("segments", 1..=65_536).map(|n| Self::Segments(n as usize))
            }
            (false, true) => {
                let cells = settings.counts("grid", 1..=4096)?;
                if cells.iter().product::<usize>() > MAX_CELLS {
                    let actual =
                        format!("{} × {} × {} cells are too many", cells[0], cells[1], cells[2]);
                    settings.fault("grid", actual, "take 1e7 at most");
                    return None;
                }
                let bounded = match body {
                    Some(Body::Volume { volume, .. }) => volume.bounds().enclosing_box().is_some(),
                    Some(Body::Line { .. } | Body::Spectral { .. }) => false,
                    None => true,
                };
                if !bounded {
                    let help = "use `segments`, or give the volume `bounds`";
                    settings.fault("grid", "a grid needs a volume with bounds", help);
                    return None;
                }
                Some(Self::Grid(cells))
            }
            _ => {
                let help = "give `segments = n` or `grid = [nx, ny, nz]`, not both";
                settings.fault_at(settings.span.clone(), "", "local majorants need cells", help);
                None
            }
        }
    }
}

impl Recipe for LocalMajorants {
    fn label(&self) -> String {
        match self {
            Self::Segments(n) => format!("local majorants, {n} segments"),
            Self::Grid([x, y, z]) => format!("local majorants, grid {x}×{y}×{z}"),
        }
    }

    fn is_local(&self) -> bool {
        true
    }

    fn needs(&self) -> Option<Knowledge> {
        Some(match self {
            Self::Segments(_) => Knowledge::LocalMaxima,
            Self::Grid(_) => Knowledge::Bounds,
        })
    }

    fn prepare(&self, site: &Site, control: &Control) -> Result<Piecewise, Refusal> {
        let support = site.mesh.support();
        if support.is_empty() {
            return Ok(Piecewise::constant(0.0, support));
        }
        match (self, site.body) {
            (Self::Segments(n), _) => Ok(on_segments(site, control, *n)),
            (Self::Grid(cells), Body::Volume { volume, ray, .. }) => {
                in_cells(&**volume, ray, support, *cells)
            }
            (Self::Grid(_), Body::Line { .. } | Body::Spectral { .. }) => {
                Err(Refusal::mismatch("a volume for its grid", "a field in 1-D"))
            }
        }
    }

    fn in_space(&self, volume: &Volume) -> Result<Majorants, Refusal> {
        match self {
            Self::Segments(_) => Err(along_ray_only(&self.label())),
            Self::Grid(cells) => Majorants::grid(*cells, 1.0, volume)
                .ok_or_else(|| Refusal::mismatch("bounds for its grid", "a volume without bounds")),
        }
    }
}

fn on_segments(site: &Site, control: &Control, n: usize) -> Piecewise {
    let support = site.mesh.support();
    let step = support.length() / n as f64;
    let mut breaks: Vec<f64> = (0..n).map(|i| support.from + step * i as f64).collect();
    breaks.push(support.to);
    let mut cuts = breaks.clone();
    cuts.extend(control.breaks());
    let cut = site.mesh.refined(&cuts, &|_, _| Vec::new());
    let bound = |ends: &[f64]| {
        let span = Span::new(ends[0], ends[1]);
        let largest = cut.largest_in(span, &|t, sigma| (sigma - control.extinction(t)).abs());
        largest.map_or(0.0, |(_, size)| size * MARGIN)
    };
    let values: Vec<f64> = breaks.windows(2).map(bound).collect();
    Piecewise::steps(&breaks, &values)
}

fn in_cells(
    volume: &Volume,
    ray: &Ray,
    support: Span,
    cells: [usize; 3],
) -> Result<Piecewise, Refusal> {
    let Some(bounds) = volume.bounds().enclosing_box() else {
        return Err(Refusal::mismatch("bounds for its grid", "a volume without bounds"));
    };
    let width: [f64; 3] =
        std::array::from_fn(|axis| (bounds.high.0[axis] - bounds.low.0[axis]) / cells[axis] as f64);
    let mut crossings = vec![support.from, support.to];
    for axis in 0..3 {
        let (origin, slope) = (ray.origin.0[axis], ray.direction.0[axis]);
        if slope != 0.0 {
            let planes = (1..cells[axis]).map(|i| bounds.low.0[axis] + width[axis] * i as f64);
            crossings.extend(planes.map(|plane| (plane - origin) / slope));
        }
    }
    crossings.retain(|&t| t >= support.from && t <= support.to);
    crossings.sort_by(f64::total_cmp);
    crossings.dedup();
    let majorant = |ends: &[f64]| {
        let middle = ray.at(0.5 * (ends[0] + ends[1]));
        let low: [f64; 3] = std::array::from_fn(|axis| {
            let cell = ((middle.0[axis] - bounds.low.0[axis]) / width[axis]).floor();
            bounds.low.0[axis] + cell.clamp(0.0, cells[axis] as f64 - 1.0) * width[axis]
        });
        let high: [f64; 3] = std::array::from_fn(|axis| low[axis] + width[axis]);
        volume.majorant(&Aabb { low: Point(low), high: Point(high) }) * MARGIN
    };
    let values: Vec<f64> = crossings.windows(2).map(majorant).collect();
    Ok(Piecewise::steps(&crossings, &values))
}
