//! What theory says of an experiment, as the rows of a record.

use crate::plan::{Planned, PlannedCase};
use crate::record::{Course, Row, Verdict};
use estimators::Refusal;

/// A longer list of probabilities is left out of the record.
const LONGEST_LAW: usize = 100;

/// The rows of an experiment with what theory says of each channel.
pub fn theory_rows(case: &PlannedCase, planned: &Planned) -> Vec<Row> {
    let blank = Row {
        estimator: planned.id.label(),
        listed: Some(planned.estimator),
        needs: planned.needs.clone(),
        sampling: planned.id.sampling.constant.map(|value| value.0),
        sampling_kind: planned.id.sampling.kind.clone(),
        control: planned.id.control.clone(),
        swept: planned.variation.map(|(_, value)| value),
        ..Row::default()
    };
    let ready = match &planned.outcome {
        Ok(ready) => ready,
        Err(refusal) => {
            let (verdict, reason) = (Some(Verdict::Refused), refusal.to_string());
            return vec![Row {
                verdict,
                reason,
                courses: courses(case, planned, refusal),
                ..blank
            }];
        }
    };
    let prediction = &ready.prediction;
    let lookups = prediction.lookups.as_ref().map(|law| law.mean);
    let cost = prediction.cost(planned.draws_per_ray);
    let law = prediction.lookups.as_ref();
    let kernel = ready.experiment.order().word();
    let same_as = twin(case, planned).unwrap_or_default();
    let rows = prediction.channels.iter().map(|channel| {
        let moments = channel.resolved_moments();
        let variance = moments.map(|moments| moments.variance());
        let fom = variance.zip(cost).map(|(v, m)| 1.0 / (v * m));
        Row {
            kernel: kernel.to_owned(),
            sharing: sharing(case, planned),
            same_as: same_as.clone(),
            skipped: Some(ready.experiment.skipped()).filter(|&share| share > 0.0),
            channel: channel.name.clone(),
            truth: Some(channel.truth.value),
            truth_error: Some(channel.truth.error),
            predicted_variance: finite(variance),
            predicted_lookups: lookups,
            setup_lookups: Some(prediction.setup_lookups),
            predicted_skewness: finite(moments.and_then(|m| m.skewness())),
            predicted_kurtosis: finite(moments.and_then(|m| m.kurtosis())),
            predicted_fom: finite(fom),
            stable_share: prediction.stable_share,
            losses: channel.losses,
            relative_moments: moments
                .map_or([None; 3], |moments| moments.relative.map(|m| finite(Some(m)))),
            lookups_variance: law.map(|law| law.variance),
            lookups_pmf: law
                .filter(|law| law.pmf.len() <= LONGEST_LAW)
                .map_or_else(Vec::new, |law| law.pmf.clone()),
            moments_error: finite(channel.moments_error()),
            rare_event_size: finite(moments.map(|_| channel.tails.rare_event_size)),
            eighth_moment_ratio: finite(moments.map(|_| channel.tails.eighth_moment_ratio)),
            log_unit: Some(channel.log_unit).filter(|&unit| unit != 0.0),
            ..blank.clone()
        }
    });
    rows.collect()
}

/// The fields along the ray, for the eye to see where the inequality fails.
fn courses(case: &PlannedCase, planned: &Planned, refusal: &Refusal) -> Vec<Course> {
    let at = match refusal {
        Refusal::Inequality { at, .. } => Some(*at),
        _ => None,
    };
    let case = case.case.at(planned.variation);
    case.map(|case| case.courses(planned.estimator, planned.address, at)).unwrap_or_default()
}

/// The estimator that an experiment is by definition, where the case has it too.
fn twin(case: &PlannedCase, planned: &Planned) -> Option<String> {
    let index = case.experiments.iter().position(|other| std::ptr::eq(other, planned))?;
    case.twin(index).map(|twin| case.experiments[twin].id.label())
}

/// How many experiments of the case share an experiment's lookups.
fn sharing(case: &PlannedCase, planned: &Planned) -> Option<u64> {
    let shared = planned.shared?;
    let all = case.experiments.iter().filter(|other| other.shared == Some(shared)).count();
    (all > 1).then_some(all as u64)
}

/// A number that files can hold.
pub fn finite(x: Option<f64>) -> Option<f64> {
    x.filter(|x| x.is_finite())
}
