//! Extinction fields, one page each: along a ray, and as volumes that a ray is clipped to.
//!
//! A field of one coordinate implements [`Stratified`], which makes a medium along a line and plane-parallel
//! layers of it. Other fields implement [`Extinction`] and [`OpticalDepth`] along a ray, and [`Field`] in space, and
//! are read from case files by their `reader`. The role of a field (medium, control variate) is its place in a struct;
//! the sampling extinction and its flights are in [`sampling`].

pub mod axes;
pub mod body;
pub mod catalogue;
pub mod cells;
pub mod constant;
pub mod cubics;
pub mod eq21;
pub mod exponential;
pub mod field;
pub mod files;
pub mod formats;
pub mod gaussian;
pub mod grid;
pub mod grid_file;
mod grid_settings;
pub mod grid_vdb;
pub mod inlined;
pub mod lattice;
pub mod layered;
pub mod lookup;
pub mod medium;
pub mod misses;
pub mod noise;
pub mod own;
pub mod phase;
pub mod piecewise_constant;
pub mod piecewise_linear;
pub mod profile;
pub mod radial;
pub mod reader;
pub mod sampling;
pub mod sines;
mod turn;
pub mod voxels;

use crate::catalogue::Registry;

pub use body::Body;
pub use field::{Facts, Field, InSpace, Smoothness};
pub use inlined::Inlined;
pub use layered::{Layered, Stratified};
pub use lookup::{Batches, Lookups};
pub use medium::Medium;
pub use profile::{Extinction, LookUp, OpticalDepth};
pub use reader::Reader;
pub use sampling::{Control, Inverse, Majorants, Piecewise};

/// A field along one ray, with its type erased.
pub type Profile = dyn OpticalDepth;

/// A field in space, with its type erased.
pub type Volume = dyn InSpace;

/// Every page, in the order of registration. A field of one coordinate has the reader of [`Stratified`]; any other page
/// has its own.
pub static CATALOGUE: Registry<fn() -> Reader> = registry![
    constant::Constant::reader,
    piecewise_constant::PiecewiseConstant::reader,
    piecewise_linear::PiecewiseLinear::reader,
    exponential::Exponential::reader,
    gaussian::reader,
    radial::reader,
    sines::reader,
    eq21::reader,
    noise::reader,
    grid::reader,
];
