//! Layers of homogeneous extinction.
//!
//! ```text
//! σ_t(x) = valuesᵢ,   breaksᵢ ≤ x < breaksᵢ₊₁
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D it is the height `p·axis` of a plane-parallel medium.
//! Outside the breaks the first and the last value go on.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `breaks` | ascending, n + 1 of them | length | required |
//! | `values` | σ_t ≥ 0 of each layer, n of them | 1/length | required |
//! | `axis` | 3-D only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Optical depth and free flight are closed forms.

use super::Piecewise;
use super::piecewise_linear::{Layers, Points};
use crate::catalogue::{Domain, Settings};

/// A plane-parallel volume of homogeneous layers.
pub type PiecewiseConstant = Layers<Steps>;

/// One value between every two breaks.
pub struct Steps;

/// Reads `breaks` and `values`, one value between every two breaks.
pub fn read_steps(settings: &Settings) -> Option<Piecewise> {
    let breaks = settings.numbers("breaks", Domain::Finite, 2);
    let values = settings.numbers("values", Domain::NonNegative, 1);
    let (breaks, values) = (breaks?, values?);
    if breaks.windows(2).any(|ends| ends[0] >= ends[1]) {
        settings.fault("breaks", "`breaks` do not ascend", "each break is above the one before");
        return None;
    }
    if values.len() + 1 != breaks.len() {
        let message = format!("{} values stand between {} breaks", values.len(), breaks.len());
        settings.fault("values", message, "there is one value between every two breaks");
        return None;
    }
    Some(Piecewise::steps(&breaks, &values))
}

impl Points for Steps {
    fn read(settings: &Settings) -> Option<Piecewise> {
        read_steps(settings)
    }
}
