//! Layers of linearly varying extinction.
//!
//! ```text
//! σ_t(x) = the straight line through (knotsᵢ, valuesᵢ) and (knotsᵢ₊₁, valuesᵢ₊₁)
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D it is the height `p·axis` of a plane-parallel medium.
//! Outside the knots the field keeps the first and the last value.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `knots` | ascending, two or more | length | required |
//! | `values` | σ_t ≥ 0 at each knot | 1/length | required |
//! | `axis` | 3-D only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Optical depth and free flight are closed forms.
//!
//! ```toml
//! title = "An example of piecewise-linear"
//!
//! [problem.transmittance]
//! medium.piecewise-linear = { knots = [0, 2, 3], values = [0.2, 1, 0.4] }
//! span = [0, 3]
//! sampling = 1
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use super::layered::{Heights, Stratified};
use super::{Extinction, Facts, OpticalDepth, Piecewise, Smoothness};
use crate::catalogue::{Domain, Settings};
use numeric::{Known, Lane, Span};

/// Straight pieces, constant ones if they are steps.
#[derive(Clone)]
pub struct Pieces<const STEPS: bool>(pub Piecewise);

/// Straight lines between the knots.
pub type PiecewiseLinear = Pieces<false>;

/// Reads `values` between every two `breaks`, or at every one of `knots`.
pub fn read_pieces(settings: &Settings, is_steps: bool) -> Option<Piecewise> {
    let (key, one, at, fewest) =
        if is_steps { ("breaks", "break", "between", 1) } else { ("knots", "knot", "at", 2) };
    let places = settings.numbers(key, Domain::Finite, 2);
    let values = settings.numbers("values", Domain::NonNegative, fewest);
    let (places, values) = (places?, values?);
    if places.windows(2).any(|ends| ends[0] >= ends[1]) {
        let help = format!("each {one} is above the one before");
        settings.fault(key, format!("`{key}` do not ascend"), help);
        return None;
    }
    if values.len() + usize::from(is_steps) != places.len() {
        let message = format!("{} values stand {at} {} {key}", values.len(), places.len());
        let every = if is_steps { "every two breaks" } else { "every knot" };
        settings.fault("values", message, format!("there is one value {at} {every}"));
        return None;
    }
    Some(if is_steps {
        Piecewise::steps(&places, &values)
    } else {
        Piecewise::lines(&places, &values)
    })
}

impl<const STEPS: bool> Stratified for Pieces<STEPS> {
    const EXTINCTIONS: &'static [&'static str] = &["values"];

    fn read(settings: &Settings) -> Option<Self> {
        read_pieces(settings, STEPS).map(Self)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, x: L) -> L {
        self.0.value(x)
    }

    fn integral(&self, x: Span) -> Known {
        self.0.optical_depth(x)
    }

    fn highest(&self, x: Span) -> f64 {
        self.0.on(x).corner_values().fold(0.0, f64::max)
    }

    fn inverse(&self, x: Span, depth: f64) -> Option<f64> {
        self.0.free_flight(x, depth)
    }

    fn features(&self, x: Span) -> Vec<f64> {
        self.0.breaks(x)
    }

    fn facts(&self) -> Facts<'_> {
        Facts { smoothness: Smoothness::Layers, ..Extinction::facts(&self.0) }
    }

    /// Heights become distances.
    fn along(&self, heights: &Heights, inside: Span) -> Option<Self> {
        let constant = |x: f64| Some(Self(Piecewise::constant(self.0.value(x), inside)));
        if heights.is_level() {
            return constant(heights.start);
        }
        let Heights { start, slope, .. } = *heights;
        let crossings = self.0.knots().iter().map(|knot| (knot - start) / slope);
        let crossings = inside.cut(crossings.collect());
        if crossings.len() < 2 {
            return constant(start + slope * inside.from);
        }
        // Two lookups inside each piece determine its line, away from the jumps at its ends.
        let ends = crossings.windows(2).map(|piece| {
            let at = |u: f64| {
                let t = piece[0] + u * (piece[1] - piece[0]);
                self.0.value(start + slope * t)
            };
            let (a, b) = (at(0.25), at(0.75));
            (1.5 * a - 0.5 * b, 1.5 * b - 0.5 * a)
        });
        Some(Self(Piecewise::joined(&crossings, ends)))
    }
}
