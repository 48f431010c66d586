//! The ray seen from the side, with what was measured on it.

use super::drawn::Drawn;
use super::plan::{Planned, PlannedCase};
use super::record::{Anatomy, MeasuredPoint};

/// The anatomy of an experiment on a curve; `None` of any other.
pub fn anatomy(case: &PlannedCase, planned: &Planned, drawn: &Drawn) -> Option<Anatomy> {
    let ready = planned.outcome.as_ref().ok()?;
    let scenario = &case.case.scenario;
    let (portrait, explorers) =
        scenario.portrait(planned.estimator, planned.variation, planned.address)?;
    let distances = scenario.distances();
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
    let residual = portrait.extinction.iter().zip(&portrait.control).map(|(s, c)| s - c).collect();
    let controlled = !planned.names.control.is_empty();
    Some(Anatomy {
        estimator: planned.names.estimator.clone(),
        measured: measured.collect(),
        residual,
        control: if controlled { portrait.control } else { Vec::new() },
        explorers,
        t: portrait.t,
        extinction: portrait.extinction,
        sampling: portrait.sampling,
        transmittance: portrait.transmittance,
        deviation: portrait.deviation,
        collisions: portrait.collisions,
        walks: portrait.walks,
    })
}
