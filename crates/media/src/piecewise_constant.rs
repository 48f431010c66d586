//! Layers of homogeneous extinction.
//!
//! ```text
//! σ_t(x) = valuesᵢ,   breaksᵢ ≤ x < breaksᵢ₊₁
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D it is the height `p·axis` of a plane-parallel medium.
//! Outside the breaks the field keeps the first and the last value.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `breaks` | ascending, n + 1 of them | length | required |
//! | `values` | σ_t ≥ 0 of each layer, n of them | 1/length | required |
//! | `axis` | 3-D only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Optical depth and free flight are closed forms.
//!
//! ```toml
//! title = "An example of piecewise-constant"
//!
//! [problem.transmittance]
//! medium.piecewise-constant = { breaks = [0, 1, 2], values = [0.4, 0.8] }
//! span = [0, 2]
//! estimators = ["regular"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use super::piecewise_linear::Pieces;

/// A constant between every two breaks.
pub type PiecewiseConstant = Pieces<true>;
