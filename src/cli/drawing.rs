//! Drawing a plan with a bar of progress.

use std::time::Instant;

use super::{Console, output};
use crate::draw::drawn::Draws;
use crate::draw::progress::Step;
use crate::draw::run;
use crate::draw::share::{self, Share};
use crate::draw::store::Store;
use crate::plan::Plan;
use crate::record::{Record, verdict};

/// Draws what the store does not have, and judges all; returns the draws, too.
pub fn judged(plan: &Plan, store: &Store, console: &Console) -> anyhow::Result<(Record, Draws)> {
    let begin = Instant::now();
    let bar = output::progress_until("drawing", "draws", 0, plan.options.seconds, console);
    // Draws of an earlier run tell nothing about the speed of this one.
    let draws = run::draw_heard(plan, store, &|step| match step {
        Step::Drawn(draws) => bar.inc(draws),
        Step::Expected(draws) => bar.set_length(draws),
        Step::Kept(_) => {}
    });
    bar.finish_and_clear();
    let record = verdict::judged(plan, &draws, begin.elapsed().as_secs_f64());
    store.error().map_or(Ok((record, draws)), |error| Err(error.into()))
}

/// Draws a share of a plan, judges nothing; whether all of it is there.
pub fn draw_share(
    plan: &Plan,
    share: Share,
    store: &Store,
    console: &Console,
) -> anyhow::Result<bool> {
    // A share is drawn up to the horizon: nobody looks at it before all shares are there.
    let steps = share::pieces(plan, share).map(|piece| piece.experiments.len() as u64);
    let bar = output::progress("drawing", "draws", steps.sum::<u64>() * plan.step(), console);
    let is_whole = run::draw_share(plan, share, store, &|step| match step {
        Step::Drawn(draws) => bar.inc(draws),
        Step::Kept(draws) => bar.dec_length(draws),
        Step::Expected(draws) => bar.set_length(draws),
    });
    bar.finish_and_clear();
    store.error().map_or(Ok(is_whole), |error| Err(error.into()))
}
