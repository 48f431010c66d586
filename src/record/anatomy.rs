//! The ray seen from the side, with what was measured on it.

use crate::draw::drawn::Drawn;
use crate::plan::{Planned, PlannedCase};
use crate::record::{Anatomy, MeasuredPoint};

/// The anatomy of an experiment on a curve; `None` of any other.
pub fn anatomy(case: &PlannedCase, planned: &Planned, drawn: &Drawn) -> Option<Anatomy> {
    let ready = planned.outcome.as_ref().ok()?;
    let at = case.case.at(planned.variation).ok()?;
    let (ray_view, explorers) = at.ray_view(planned.estimator, planned.address)?;
    let distances = at.scenario().distances();
    let channels = ready.prediction.channels.iter().zip(&drawn.tallies).zip(&distances);
    let measured = channels.filter_map(|((channel, tally), &t)| {
        let moments = tally.moments()?;
        let unit = channel.truth.value;
        let deviation = moments.variance?.sqrt() * unit;
        Some(MeasuredPoint {
            t,
            mean: channel.mean.value + moments.mean * unit,
            standard_error: deviation / (tally.draws as f64).sqrt(),
            deviation,
        })
    });
    let residual = ray_view.extinction.iter().zip(&ray_view.control).map(|(s, c)| s - c).collect();
    let controlled = !planned.id.control.is_empty();
    Some(Anatomy {
        estimator: planned.id.label(),
        measured: measured.collect(),
        residual,
        control: if controlled { ray_view.control } else { Vec::new() },
        explorers,
        t: ray_view.t,
        extinction: ray_view.extinction,
        sampling: ray_view.sampling,
        transmittance: ray_view.transmittance,
        deviation: ray_view.deviation,
        collisions: ray_view.collisions,
        walks: ray_view.walks,
    })
}
