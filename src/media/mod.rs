//! Extinction fields, one page each, as one ray sees them and as volumes that a ray is clipped to.
//!
//! Floor 1. A field promises as much as it can, one trait per capability, each asking for the one
//! before it: [`Extinction`] can be looked up, [`OpticalDepth`] can also be integrated exactly,
//! [`FreeFlight`] can also be inverted. A medium and a control variate need the second, a sampling
//! extinction needs the third; which role a field plays is its place in a struct.
//!
//! A page implements [`Field`] and is registered by its line in the list at the foot of this file.

pub mod body;
pub mod cells;
pub mod constant;
pub mod control;
pub mod course;
pub mod cubics;
pub mod cursor;
pub mod eq21;
pub mod even;
pub mod exponential;
pub mod gaussian;
pub mod grid;
pub mod grid_file;
pub mod inverse;
pub mod lattice;
pub mod majorants;
pub mod medium;
pub mod noise;
pub mod piecewise;
pub mod piecewise_constant;
pub mod piecewise_linear;
pub mod placement;
pub mod radial;
pub mod search;
pub mod sines;
pub mod voxels;

use fearless_simd::{Level, Simd, SimdBase, f64x8};

use crate::catalogue::{Catalogue, Settings};
use crate::geometry::{Aabb, Bounds, Point, Ray};
use crate::numeric::pack::{self, Task, WIDTH};
use crate::numeric::{Known, Lane, Span, roots};

pub use body::Body;
pub use control::Control;
pub use course::Course;
pub use cursor::Cursor;
pub use inverse::Inverse;
pub use majorants::Majorants;
pub use medium::Medium;
pub use piecewise::Piecewise;
pub use placement::Placement;

/// A field that can be looked up: `σ_t(t)` in 1/length at distance `t` along the ray.
pub trait Extinction: Send + Sync {
    /// Whether a lookup costs so much that all else in a walk hardly counts.
    const IS_COSTLY: bool = false;

    /// The extinction at `t`, written once for every lane type.
    fn extinction<L: Lane>(&self, t: L) -> L;
}

/// Looks a field up at many distances, eight at a time on the hardware of a level; what is beyond the
/// last eight is left out.
pub fn look_up<F: Extinction>(level: Level, field: &F, at: &[f64], extinction: &mut [f64]) {
    pack::on(level, Packs { field, at, extinction });
}

struct Packs<'a, F> {
    field: &'a F,
    at: &'a [f64],
    extinction: &'a mut [f64],
}

impl<F: Extinction> Task for Packs<'_, F> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let (at, _) = self.at.as_chunks::<WIDTH>();
        let (extinction, _) = self.extinction.as_chunks_mut::<WIDTH>();
        for (at, extinction) in at.iter().zip(extinction) {
            self.field.extinction(f64x8::from_slice(simd, at)).store_slice(extinction);
        }
    }
}

/// A field whose integral is known.
pub trait OpticalDepth: Extinction {
    /// `τ(a, b) = ∫ₐᵇ σ_t(t) dt` with a bound on its own error.
    fn optical_depth(&self, span: Span) -> Known;

    /// The distances inside `span` where the field or one of its derivatives jumps, or that frame
    /// a feature which quadrature would otherwise step over. In any order.
    fn breaks(&self, span: Span) -> Vec<f64> {
        let _ = span;
        Vec::new()
    }

    /// About how many breaks there are, known without finding them.
    fn pieces(&self, span: Span) -> f64 {
        let _ = span;
        0.0
    }

    /// How many Gauss nodes between two breaks integrate `σ_t` and its square to rounding; `None`
    /// where no fixed number does and panels are halved until they agree.
    fn panel_nodes(&self) -> Option<usize> {
        None
    }
}

/// A field whose integral can be inverted.
pub trait FreeFlight: OpticalDepth {
    /// Whether the inverse is found at once, without a search for a root of the optical depth.
    const IS_DIRECT: bool = false;

    /// The distance `s` with `τ(span.from, s) = depth`; `None` where the ray leaves the span first.
    ///
    /// The default brackets the root of the exact optical depth; pages with a closed form
    /// override it.
    fn free_flight(&self, span: Span, depth: f64) -> Option<f64> {
        let depth_to = |s: f64| self.optical_depth(Span::new(span.from, s)).value;
        if depth_to(span.to) <= depth {
            return None;
        }
        Some(roots::rising(span.from, span.to, |s| (depth_to(s) - depth, self.extinction(s))))
    }
}

/// A page of the catalogue: how a field is read from a case file, in 1-D and in 3-D.
pub trait Field: Sized + Send + Sync + 'static {
    /// What one ray sees.
    type Profile: FreeFlight + 'static;

    /// Whether it has a 1-D form.
    const IN_LINE: bool = true;

    /// Reads the 1-D form, a function of the distance `t`, from `medium.NAME = { … }`.
    ///
    /// The default is for fields that exist in 3-D only.
    fn line(settings: &Settings) -> Option<Self::Profile> {
        let help = "write `volume` instead of `medium`, and give a `ray`";
        settings.fault_at(settings.span.clone(), "", "this field has no 1-D form", help);
        None
    }

    /// Reads the 3-D form from `volume.NAME = { … }`.
    fn volume(settings: &Settings) -> Option<Self>;

    /// Where the volume may be non-zero; a ray is clipped to it.
    fn bounds(&self) -> Bounds;

    /// `σ_t(p)` for a point within the bounds.
    fn extinction_at(&self, p: Point) -> f64;

    /// A number that `σ_t` exceeds nowhere in the box.
    fn majorant(&self, within: &Aabb) -> f64;

    /// About how many pieces a ray sees in a length at most, known without finding them.
    fn pieces(&self, length: f64) -> f64 {
        let _ = length;
        0.0
    }

    /// The largest coordinate that a stretch of a ray reaches on the field's own lattice; 0 for fields
    /// that have none.
    fn farthest(&self, ray: &Ray, inside: Span) -> f64 {
        let _ = (ray, inside);
        0.0
    }

    /// Whether the volume is a ball in which σ_t depends on the distance from its centre only.
    fn is_radial(&self) -> bool {
        false
    }

    /// What the ray sees on the stretch `inside`, which lies within the bounds.
    fn along(&self, ray: &Ray, inside: Span) -> Self::Profile;

    /// The same field with only its first few octaves, for explorers; `None` if it has no octaves.
    fn coarsened(&self, octaves: usize) -> Option<Self> {
        let _ = octaves;
        None
    }
}

/// A computation that is compiled once for each profile type.
pub trait Visitor {
    /// What it answers.
    type Output;

    /// The computation.
    fn visit<F: FreeFlight>(self, field: &F) -> Self::Output;
}

/// A computation that is compiled once for each type of volume.
pub trait VolumeVisitor {
    /// What it answers.
    type Output;

    /// The computation.
    fn visit<F: Field>(self, field: &F) -> Self::Output;
}

/// Lists the pages: from one line each come the module, the variants of [`Profile`] and
/// [`Volume`], the name in case files and the row in `trueflight list`.
macro_rules! media {
    ($($module:ident :: $Field:ident,)*) => {
        /// Every page, in the order of registration.
        pub const CATALOGUE: Catalogue =
            Catalogue { name: "media", pages: &[$($crate::page!($module)),*] };

        /// What one ray sees of some field of the catalogue.
        #[allow(clippy::large_enum_variant)] // one per experiment
        #[allow(missing_docs)] // each variant is its page
        pub enum Profile { $($Field(<$module::$Field as Field>::Profile)),* }

        impl Profile {
            /// Runs a computation on the concrete type: names become types here, once.
            pub fn visit<V: Visitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$Field(field) => visitor.visit(field)),* }
            }

            /// `τ` over a span.
            #[must_use]
            pub fn optical_depth(&self, span: Span) -> Known {
                match self { $(Self::$Field(field) => field.optical_depth(span)),* }
            }

            /// Whether the fields, page by page, have a 1-D form.
            const IN_LINE: &[bool] = &[$(<$module::$Field as Field>::IN_LINE),*];

            /// Reads `NAME = { … }` in its 1-D form.
            fn read(index: usize, settings: &Settings) -> Option<Self> {
                let readers = [$(|s: &Settings| {
                    <$module::$Field as Field>::line(s).map(Self::$Field)
                }),*];
                readers[index](settings)
            }
        }

        /// Some field of the catalogue in its 3-D form.
        #[allow(missing_docs)] // each variant is its page
        pub enum Volume { $($Field($module::$Field)),* }

        impl Volume {
            /// Runs a computation on the concrete type: names become types here, once.
            pub fn visit<V: VolumeVisitor>(&self, visitor: V) -> V::Output {
                match self { $(Self::$Field(field) => visitor.visit(field)),* }
            }

            /// Where the volume may be non-zero.
            #[must_use]
            pub fn bounds(&self) -> Bounds {
                match self { $(Self::$Field(field) => field.bounds()),* }
            }

            /// `σ_t(p)`, zero outside the bounds.
            #[must_use]
            pub fn extinction_at(&self, p: Point) -> f64 {
                if !self.bounds().contains(p) {
                    return 0.0;
                }
                match self { $(Self::$Field(field) => field.extinction_at(p)),* }
            }

            /// A number that `σ_t` exceeds nowhere in the box.
            #[must_use]
            pub fn majorant(&self, within: &Aabb) -> f64 {
                match self { $(Self::$Field(field) => field.majorant(within)),* }
            }

            /// About how many pieces a ray sees in a length at most.
            #[must_use]
            pub fn pieces(&self, length: f64) -> f64 {
                match self { $(Self::$Field(field) => field.pieces(length)),* }
            }

            /// The largest coordinate that a stretch of a ray reaches on the field's own lattice.
            #[must_use]
            pub fn farthest(&self, ray: &Ray, inside: Span) -> f64 {
                match self { $(Self::$Field(field) => field.farthest(ray, inside)),* }
            }

            /// Whether the volume is a ball in which σ_t depends on the distance from its centre only.
            #[must_use]
            pub fn is_radial(&self) -> bool {
                match self { $(Self::$Field(field) => field.is_radial()),* }
            }

            /// What the ray sees on the stretch `inside`.
            #[must_use]
            pub fn along(&self, ray: &Ray, inside: Span) -> Profile {
                match self {
                    $(Self::$Field(field) => Profile::$Field(field.along(ray, inside))),*
                }
            }

            /// The same field with only its first few octaves; `None` if it has no octaves.
            #[must_use]
            pub fn coarsened(&self, octaves: usize) -> Option<Self> {
                match self { $(Self::$Field(field) => field.coarsened(octaves).map(Self::$Field)),* }
            }

            /// Reads `NAME = { … }` in its 3-D form.
            fn read(index: usize, settings: &Settings) -> Option<Self> {
                let readers = [$(|s: &Settings| {
                    <$module::$Field as Field>::volume(s).map(Self::$Field)
                }),*];
                readers[index](settings)
            }
        }
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
