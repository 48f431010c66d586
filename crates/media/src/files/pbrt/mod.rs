//! Voxel grids in scene files of pbrt: media of the type `uniformgrid` (pbrt-v4) or `heterogeneous` (pbrt-v3).
//!
//! ```text
//! MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" [ 2 ] "integer ny" [ 1 ] "integer nz" [ 1 ]
//!   "point3 p0" [ 0 0 0 ] "point3 p1" [ 2 1 1 ] "float density" [ 0.5 1 ]
//! ```
//!
//! Words are names, texts in quotes, numbers and brackets; # begins a comment. A parameter is `"type name"` and a
//! value or a list in brackets. Only the directives that make a medium or move it are used: `Translate` and `Scale`
//! are applied to the box, and directives that rotate it are refused. Included files are not read. Density alone is
//! read, x fastest, then y, then z: pbrt's σ_t is that times `scale` and the sum of `sigma_a` and `sigma_s`.
//!
//! The crate `pbrt4` (0.2) reads whole scenes, and depends on `glam` and a second `thiserror`.
//!
//! Sources: M. Pharr, W. Jakob, G. Humphreys, *Physically Based Rendering*, 4th edition (2023), and the description of its
//! scene format.

mod moved;
mod scene;
mod words;

pub use scene::{NamedMedium, PbrtGrid, grids, read};
