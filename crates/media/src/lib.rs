//! Extinction fields, one page each: along a ray, and as volumes that a ray is clipped to.
//!
//! Floor 1. A field has one trait for each of its capabilities, and each trait requires the one before it:
//! [`Extinction`] can be looked up, [`OpticalDepth`] can also be integrated exactly, [`FreeFlight`] can also be
//! inverted. A medium and a control variate need the second, a sampling extinction needs the third; the role of a
//! field is its place in a struct.
//!
//! A page implements [`Field`] and is registered by its line in the list at the foot of this file.

pub mod axes;
pub mod body;
pub mod catalogue;
pub mod cells;
pub mod constant;
pub mod control;
pub mod course;
pub mod cubics;
pub mod cursor;
pub mod eq21;
pub mod even;
pub mod exponential;
pub mod files;
pub mod gaussian;
pub mod grid;
pub mod grid_file;
mod grid_settings;
pub mod grid_vdb;
pub mod inlined;
pub mod inverse;
pub mod lattice;
pub mod lookup;
pub mod majorants;
pub mod medium;
pub mod misses;
pub mod noise;
pub mod own;
pub mod phase;
pub mod piecewise;
pub mod piecewise_constant;
pub mod piecewise_linear;
pub mod radial;
pub mod reader;
pub mod search;
pub mod sines;
mod turn;
pub mod voxels;

use std::sync::{Arc, LazyLock};

use fearless_simd::Level;

use crate::catalogue::{PageList, Settings};
use numeric::fused::in_fused_code;
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span, roots};

pub use body::Body;
pub use control::Control;
pub use course::Course;
pub use cursor::Cursor;
pub use inlined::Inlined;
pub use inverse::Inverse;
pub use lookup::{Batches, Lookups, Points};
pub use majorants::Majorants;
pub use medium::Medium;
pub use piecewise::Piecewise;
pub use reader::Reader;

/// A field that can be looked up: `σ_t(t)` in 1/length at distance `t` along the ray.
pub trait Extinction: Send + Sync {
    /// The extinction at `t`, as one formula for every lane type.
    fn extinction<L: Lane>(&self, t: L) -> L;

    /// The value, where there is only one.
    fn single_value(&self) -> Option<f64> {
        None
    }

    /// Returns true if lookups dominate the time of a walk.
    fn is_costly(&self) -> bool {
        false
    }
}

/// A field that is looked up, with its type erased.
pub trait LookUp: Send + Sync {
    /// `σ_t(t)`. Not for loops of kernels, which take [`LookUp::lookups`].
    fn at(&self, t: f64) -> f64;

    /// `σ_t` for the kernels of a level of hardware.
    fn lookups(&self, level: Level) -> Lookups<'_>;
}

impl<F: Extinction + 'static> LookUp for F {
    fn at(&self, t: f64) -> f64 {
        in_fused_code(
            #[inline(always)]
            || self.extinction(t),
        )
    }

    fn lookups(&self, level: Level) -> Lookups<'_> {
        Lookups::new(self, level)
    }
}

/// A field with a known integral.
pub trait OpticalDepth: LookUp {
    /// `τ(a, b) = ∫ₐᵇ σ_t(t) dt` with a bound on its own error.
    fn optical_depth(&self, span: Span) -> Known;

    /// The distances inside `span` where the field or one of its derivatives jumps, or that enclose a feature which
    /// quadrature would otherwise miss. In any order.
    fn breaks(&self, span: Span) -> Vec<f64> {
        let _ = span;
        Vec::new()
    }

    /// Approximate number of breaks, without finding them.
    fn pieces(&self, span: Span) -> f64 {
        let _ = span;
        0.0
    }

    /// Number of Gauss nodes between two breaks that integrate `σ_t` and its square to rounding; `None` if there is
    /// no such number, and panels are halved until they agree.
    fn panel_nodes(&self) -> Option<usize> {
        None
    }
}

/// A field with an integral that can be inverted.
pub trait FreeFlight: OpticalDepth {
    /// Returns true if the inverse has a closed form, without a search for a root of the optical depth.
    fn is_direct(&self) -> bool {
        false
    }

    /// The distance `s` with `τ(span.from, s) = depth`; `None` where the ray leaves the span first.
    ///
    /// The default brackets the root of the exact optical depth; pages with a closed form
    /// override it.
    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        free_flight_by_root(self, span, depth)
    }
}

/// The default of [`FreeFlight::free_flight`].
fn free_flight_by_root<F: OpticalDepth + ?Sized>(field: &F, span: Span, depth: f64) -> Option<f64> {
    let depth_to = |s: f64| field.optical_depth(Span::new(span.from, s)).value;
    if depth_to(span.to) <= depth {
        return None;
    }
    Some(roots::rising(span.from, span.to, |s| (depth_to(s) - depth, field.at(s))))
}

/// Smoothness of σ_t in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Smoothness {
    /// Without jumps or kinks, except at the bounds.
    Smooth,
    /// A polynomial in cells along the axes, which join smoothly.
    SmoothCells,
    /// A polynomial in cells along the axes, with kinks between them.
    Cells,
    /// In layers, with jumps or kinks between them.
    Layers,
}

/// A page of the catalogue: the reader of a field from a case file, in 1-D and in 3-D.
pub trait Field: Sized + Send + Sync + 'static {
    /// The field along one ray.
    type Profile: FreeFlight + 'static;

    /// Settings to which σ_t is proportional, all together: sweeps of the density and of the contrast change these.
    const EXTINCTIONS: &'static [&'static str];

    /// True if it has a 1-D form.
    const IN_LINE: bool = true;

    /// Reads the 1-D form, a function of the distance `t`, from `medium.NAME = { … }`.
    ///
    /// The default is for fields that exist in 3-D only.
    fn line(settings: &Settings) -> Option<Self::Profile> {
        let _ = settings;
        None
    }

    /// Reads the 3-D form from `volume.NAME = { … }`.
    fn volume(settings: &Settings) -> Option<Self>;

    /// Bounds of the volume, to which a ray is clipped.
    fn bounds(&self) -> Bounds;

    /// `σ_t(p)` for a point within the bounds, as one formula for every lane type.
    fn extinction_at<L: Lane>(&self, p: [L; 3]) -> L;

    /// An upper bound of `σ_t` in the box.
    fn majorant(&self, within: &Aabb) -> f64;

    /// The value within the bounds, where there is only one.
    fn single_value(&self) -> Option<f64> {
        None
    }

    /// Smoothness in space.
    fn smoothness(&self) -> Smoothness {
        Smoothness::Smooth
    }

    /// Approximate maximum number of pieces along a ray of a length, without finding them.
    fn pieces(&self, length: f64) -> f64 {
        let _ = length;
        0.0
    }

    /// The largest coordinate that an interval of a ray reaches on the field's own lattice; 0 for fields without a
    /// lattice.
    fn farthest(&self, ray: &Ray, inside: Span) -> f64 {
        let _ = (ray, inside);
        0.0
    }

    /// Returns true if the volume is a ball in which σ_t depends on the distance from its centre only.
    fn is_radial(&self) -> bool {
        false
    }

    /// Numbers of cells along x, y and z with a sample in the middle of each; true if a lookup takes the nearest
    /// one. `None` for other fields.
    fn cells(&self) -> Option<([usize; 3], bool)> {
        None
    }

    /// Contents of the file of the field, a sentence each; empty for other fields.
    fn facts(&self) -> Vec<String> {
        Vec::new()
    }

    /// The field along the ray on the interval `inside`, which lies within the bounds.
    fn along(&self, ray: &Ray, inside: Span) -> Self::Profile;

    /// The optical depths of intervals of rays within the bounds, if these have one formula for every lane type.
    /// Their bits are those of [`Self::along`].
    #[inline(always)]
    fn depths_along<L: Lane>(&self, rays: [[L; 3]; 2], stretch: [L; 2]) -> Option<L> {
        let _ = (rays, stretch);
        None
    }

    /// The field with only its first few octaves, for explorers; `None` if it has no octaves.
    fn coarsened(&self, octaves: usize) -> Option<Self> {
        let _ = octaves;
        None
    }
}

/// A field along one ray, with its type erased.
pub type Profile = dyn FreeFlight;

/// A field in space, with its type erased.
pub type Volume = dyn InSpace;

/// A field in space, with its type erased.
pub trait InSpace: Send + Sync {
    /// Bounds, outside of which it is zero.
    fn bounds(&self) -> Bounds;
    /// `σ_t(p)`, zero outside the bounds.
    fn extinction_at(&self, p: Point) -> f64;
    /// Lookups for kernels, at points within the bounds.
    fn points(&self) -> Points<'_>;
    /// `σ_t` at points within the bounds for the packets of a level of hardware; with `clipped`, zero
    /// outside them.
    fn batches(&self, level: Level, clipped: bool) -> Batches<'_>;
    /// See [`Field::majorant`].
    fn majorant(&self, within: &Aabb) -> f64;
    /// See [`Field::single_value`].
    fn single_value(&self) -> Option<f64>;
    /// See [`Field::smoothness`].
    fn smoothness(&self) -> Smoothness;
    /// See [`Field::pieces`].
    fn pieces(&self, length: f64) -> f64;
    /// See [`Field::farthest`].
    fn farthest(&self, ray: &Ray, inside: Span) -> f64;
    /// See [`Field::is_radial`].
    fn is_radial(&self) -> bool;
    /// See [`Field::cells`].
    fn cells(&self) -> Option<([usize; 3], bool)>;
    /// See [`Field::facts`].
    fn facts(&self) -> Vec<String>;
    /// The field along the ray on the interval `inside`.
    fn along(&self, ray: &Ray, inside: Span) -> Arc<Profile>;
    /// See [`Field::coarsened`].
    fn coarsened(&self, octaves: usize) -> Option<Arc<Volume>>;
}

impl<F: Field> InSpace for F {
    fn bounds(&self) -> Bounds {
        Field::bounds(self)
    }

    fn extinction_at(&self, p: Point) -> f64 {
        if Field::bounds(self).contains(p) { Field::extinction_at(self, p.0) } else { 0.0 }
    }

    fn points(&self) -> Points<'_> {
        Points::new(self)
    }

    fn batches(&self, level: Level, clipped: bool) -> Batches<'_> {
        Batches::new(self, level, clipped)
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        Field::majorant(self, within)
    }

    fn single_value(&self) -> Option<f64> {
        Field::single_value(self)
    }

    fn smoothness(&self) -> Smoothness {
        Field::smoothness(self)
    }

    fn pieces(&self, length: f64) -> f64 {
        Field::pieces(self, length)
    }

    fn farthest(&self, ray: &Ray, inside: Span) -> f64 {
        Field::farthest(self, ray, inside)
    }

    fn is_radial(&self) -> bool {
        Field::is_radial(self)
    }

    fn cells(&self) -> Option<([usize; 3], bool)> {
        Field::cells(self)
    }

    fn facts(&self) -> Vec<String> {
        Field::facts(self)
    }

    fn along(&self, ray: &Ray, inside: Span) -> Arc<Profile> {
        Arc::new(Field::along(self, ray, inside))
    }

    fn coarsened(&self, octaves: usize) -> Option<Arc<Volume>> {
        Field::coarsened(self, octaves).map(|field| Arc::new(field) as Arc<Volume>)
    }
}

/// Lists the pages: each line gives the name in case files, the reader and the row in `trueflight list`.
macro_rules! media {
    ($($module:ident :: $Field:ident,)*) => {
        /// Every page, in the order of registration.
        pub const CATALOGUE: PageList =
            PageList { name: "media", pages: &[$($crate::page!($module)),*] };

        static READERS: LazyLock<Vec<Reader>> =
            LazyLock::new(|| vec![$(Reader::of::<$module::$Field>()),*]);
    };
}

media! {
    constant::Constant,
    piecewise_constant::PiecewiseConstant,
    piecewise_linear::PiecewiseLinear,
    exponential::Exponential,
    gaussian::Gaussian,
    radial::Radial,
    sines::Sines,
    eq21::Eq21,
    noise::Noise,
    grid::Grid,
}
