//! Fields along a ray at a hundred places: what a refused experiment would have worked on.

use crate::record::plot_data::Course;
use media::{Control, Medium, Piecewise};

/// Even places on the ray; the one where an inequality fails comes to them.
const PLACES: usize = 99;

/// The fields of a channel, as far as they could be made.
pub struct Fields<'a> {
    /// σ_t.
    pub medium: &'a Medium,
    /// σ_c.
    pub control: Option<&'a Control>,
    /// σ̂.
    pub sampling: Option<&'a Piecewise>,
}

impl Fields<'_> {
    /// Their values along the ray and at a place of interest; `None` on a ray without end.
    pub fn course(&self, at: Option<f64>) -> Option<Course> {
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
