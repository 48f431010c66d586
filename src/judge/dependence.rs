//! What else must hold for the gate: draws that are independent, and of one mean from beginning to end.

use super::judgement::{DriftFinding, IndependenceFinding};
use super::reading::{DRIFT, Reading};
use crate::catalogue::deviation::Deviation;
use crate::stats::verdict::Verdict;

/// Whether the mean changes on the way: only where that says more than that it is off.
pub(super) fn drift(reading: &Reading) -> Option<DriftFinding> {
    // Without a ground to fail the mean there is none to say when it changes.
    let mean = reading.mean.as_ref().filter(|mean| mean.has_ground())?;
    let change = mean.change();
    let limit = -(DRIFT * reading.trial.wanted.alpha).ln();
    let is_shown = change.ln_e >= limit && change.ln_e > mean.ln_e() && mean.is_founded();
    let from = change.from * reading.trial.wanted.batch;
    let verdict = if is_shown { Verdict::Fail } else { Verdict::Pass };
    let reason = if is_shown {
        let claim = &reading.trial.claim;
        let draws = (reading.draws() / reading.trial.wanted.batch).saturating_sub(change.from);
        let later = Deviation::new(claim.truth + claim.unit * change.off, claim.truth, draws);
        format!(
            "the mean changes: from draw {from} on it is off by {later} (ln E = {:.1} ≥ {limit:.1})",
            change.ln_e
        )
    } else {
        String::new()
    };
    let from = (change.ln_e > 0.0).then_some(from);
    let (ln_e, off) = (change.ln_e, change.off);
    Some(DriftFinding { verdict, reason, ln_e, ln_e_limit: limit, from, off })
}

/// Whether draws depend on each other: half of the level for neighbours, half for replays.
pub(super) fn independence(reading: &Reading) -> IndependenceFinding {
    let ln_e_limit = (2.0 / reading.trial.wanted.alpha).ln();
    let mut found = IndependenceFinding {
        ln_e: reading.independence.ln_e(),
        ln_e_limit,
        ..IndependenceFinding::default()
    };
    // Draws that have no spread are all alike.
    if reading.mean.is_none() {
        return found;
    }
    let because = |what: String| format!("the draws are not independent: {what}");
    if found.ln_e >= ln_e_limit
        && let Some(strongest) = reading.independence.strongest(ln_e_limit)
    {
        let (scale, lag, r) = (strongest.scale, strongest.lag, strongest.correlation);
        (found.scale, found.lag, found.correlation) = (Some(scale), Some(lag), Some(r));
        found.batch = reading.independence.free_batch(ln_e_limit);
        found.reason = because(match scale {
            1 => format!("correlation at lag {lag} is {r:.2}"),
            _ => format!("correlation between sums of {scale} consecutive draws is {r:.2}"),
        });
    }
    if let Some(replay) = reading.replays.most_frequent()
        && replay.ln_p <= -ln_e_limit
    {
        found.replay = Some(replay.distance);
        found.reason = because(match replay.distance {
            1 => "draws are written more than once".to_owned(),
            distance => format!("the same draws come again {distance} draws later"),
        });
    }
    found
}
