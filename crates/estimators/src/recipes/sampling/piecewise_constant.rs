//! A σ̂ that is constant between breaks.
//!
//! | setting | meaning | unit |
//! |---|---|---|
//! | `breaks` | ascending distances along the ray, n + 1 of them | length |
//! | `values` | σ̂ ≥ 0 between them, n of them | 1/length |
//!
//! Outside the breaks the first and the last value go on. Free flight inverts the piecewise optical
//! depth exactly.

/// A piecewise-constant σ̂.
pub type PiecewiseConstant = super::piecewise_linear::Given<true>;
