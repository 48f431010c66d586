//! Fields along the ray of an experiment that is refused, for plots that show why.

use serde::{Deserialize, Serialize};

use media::{Control, Medium, Piecewise};

/// σ_t, control and σ̂ along the ray of an experiment that is refused.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Course {
    /// Distances along the ray, ascending; not more than 100.
    #[serde(with = "gate::extended")]
    pub t: Vec<f64>,
    /// σ_t there, 1/length.
    #[serde(with = "gate::extended")]
    pub extinction: Vec<f64>,
    /// The control there, 1/length; empty for none, or where it cannot be made.
    #[serde(with = "gate::extended")]
    pub control: Vec<f64>,
    /// σ̂ there, 1/length; empty for none, or where it cannot be made.
    #[serde(with = "gate::extended")]
    pub sampling: Vec<f64>,
    /// Place where the inequality does not hold; `None` where something else is refused.
    pub at: Option<f64>,
}

impl Course {
    /// Leaves out the places where a field has no finite value.
    pub(super) fn finite(self) -> Self {
        let fields = [&self.t, &self.extinction, &self.control, &self.sampling];
        let is_finite =
            |i: &usize| fields.iter().all(|field| field.get(*i).is_none_or(|v| v.is_finite()));
        let kept: Vec<usize> = (0..self.t.len()).filter(is_finite).collect();
        let [t, extinction, control, sampling] =
            fields.map(|field| kept.iter().filter_map(|&i| field.get(i).copied()).collect());
        Self { t, extinction, control, sampling, at: self.at }
    }
}

/// Number of evenly spaced places on the ray; the place where an inequality fails is added.
const PLACES: usize = 99;

/// Fields of a channel, as far as they could be made.
pub(super) struct ChannelFields<'a> {
    /// σ_t.
    pub(super) medium: &'a Medium,
    /// σ_c.
    pub(super) control: Option<&'a Control>,
    /// σ̂.
    pub(super) sampling: Option<&'a Piecewise>,
}

impl ChannelFields<'_> {
    /// Returns the values along the ray and at a place of interest; `None` on a ray of infinite length.
    pub(super) fn course(&self, at: Option<f64>) -> Option<Course> {
        let (span, support) = (self.medium.span(), self.medium.support());
        let length = span.length();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        let place = |i: usize| span.from + length * (i as f64 / (PLACES - 1) as f64);
        let mut t: Vec<f64> = (0..PLACES).map(place).collect();
        t.extend(at.filter(|at| span.from <= *at && *at <= span.to));
        t.sort_by(f64::total_cmp);
        t.dedup();
        let inside = |t: f64| support.from <= t && t <= support.to;
        let along = |field: &dyn Fn(f64) -> f64| -> Vec<f64> {
            t.iter().map(|&t| if inside(t) { field(t) } else { 0.0 }).collect()
        };
        let control = self.control.filter(|control| !control.is_none());
        Some(Course {
            extinction: along(&|t| self.medium.extinction(t)),
            control: control.map_or_else(Vec::new, |control| along(&|t| control.extinction(t))),
            sampling: self.sampling.map_or_else(Vec::new, |field| along(&|t| field.value(t))),
            at,
            t,
        })
    }
}
