//! Fields in space: `σ_t(p)` in 1/length within bounds.

use std::sync::Arc;

use fearless_simd::Level;

use super::lookup::Depths;
use super::{Batches, Profile, Volume};
use numeric::fused::in_fused_code;
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Lane, Span};

/// Smoothness of σ_t in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Smoothness {
    /// Without jumps or kinks, except at the bounds.
    #[default]
    Smooth,
    /// A polynomial in cells along the axes, which join smoothly.
    SmoothCells,
    /// A polynomial in cells along the axes, with kinks between them.
    Cells,
    /// In layers, with jumps or kinks between them.
    Layers,
}

/// Optional facts of a field, along a ray or in space. The defaults hold for every field.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Facts<'a> {
    /// The value (within the bounds), if there is only one.
    pub single_value: Option<f64>,
    /// True if lookups dominate the time of a walk.
    pub is_costly: bool,
    /// Approximate maximum number of pieces on a unit of length along a ray.
    pub pieces_per_length: f64,
    /// Along a ray: number of Gauss nodes between two breaks that integrate `σ_t` and its square to rounding. `None`
    /// if there is no such number: panels are then halved until they agree.
    pub panel_nodes: Option<usize>,
    /// Along a ray: true if free flights need no search for a root of the optical depth.
    pub has_inverse: bool,
    /// In space: smoothness.
    pub smoothness: Smoothness,
    /// In space: true if the volume is a ball in which σ_t depends on the distance from its centre only.
    pub is_radial: bool,
    /// In space: numbers of cells along x, y and z with a sample in the middle of each; true if a lookup takes the
    /// nearest one.
    pub cells: Option<([usize; 3], bool)>,
    /// Contents of the file of the field, a sentence each.
    pub contents: &'a [String],
}

/// A field in space. Its type is erased in a [`Volume`].
pub trait Field: Send + Sync + 'static {
    /// Bounds of the volume, to which a ray is clipped.
    fn bounds(&self) -> Bounds;

    /// `σ_t(p)` for a point within the bounds, as one formula for every lane type.
    fn value<L: Lane>(&self, p: [L; 3]) -> L
    where
        Self: Sized;

    /// An upper bound of `σ_t` in the box.
    fn majorant(&self, within: &Aabb) -> f64;

    /// The field along the ray on the interval `inside`, which lies within the bounds.
    fn along(&self, ray: &Ray, inside: Span) -> Arc<Profile>;

    /// Optional facts.
    fn facts(&self) -> Facts<'_> {
        Facts::default()
    }

    /// The largest coordinate that an interval of a ray reaches on the field's own lattice; 0 for fields without a
    /// lattice.
    fn max_lattice_coordinate(&self, ray: &Ray, inside: Span) -> f64 {
        let _ = (ray, inside);
        0.0
    }

    /// The optical depths of intervals of rays within the bounds on the hardware of a level, if the field has one formula of
    /// them for every lane type.
    fn depths(&self, level: Level) -> Option<Box<dyn Depths + '_>> {
        let _ = level;
        None
    }

    /// The field with only its first few octaves, for explorers; `None` if it has no octaves.
    fn coarsened(&self, octaves: usize) -> Option<Arc<Volume>> {
        let _ = octaves;
        None
    }
}

/// Lookups of a field in space, with its type erased.
pub trait InSpace: Field {
    /// `σ_t(p)` for a point within the bounds.
    fn extinction_within(&self, p: Point) -> f64;

    /// `σ_t(p)`, zero outside the bounds.
    fn extinction_at(&self, p: Point) -> f64;

    /// `σ_t` at points within the bounds for the packets of a level of hardware; with `clipped`, zero
    /// outside them.
    fn batches(&self, level: Level, clipped: bool) -> Batches<'_>;
}

impl<F: Field> InSpace for F {
    fn extinction_within(&self, p: Point) -> f64 {
        in_fused_code(
            #[inline(always)]
            || self.value(p.0),
        )
    }

    fn extinction_at(&self, p: Point) -> f64 {
        if self.bounds().contains(p.0) { self.value(p.0) } else { 0.0 }
    }

    fn batches(&self, level: Level, clipped: bool) -> Batches<'_> {
        Batches::new(self, level, clipped)
    }
}
