//! Drawing a plan with a bar of progress.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;
use std::time::Instant;

use anyhow::Context;

use super::{Console, output};
use crate::draw::cache::Cache;
use crate::draw::progress::Step;
use crate::draw::run;
use crate::draw::share::{self, Share};
use crate::draw::store::Store;
use crate::plan::Plan;
use crate::record::Record;
use crate::record::baseline::fingerprint;
use crate::record::verdict;
use media::files;

/// The file beside the results that keeps what was drawn.
pub const CACHE: &str = "draws.bin";

/// Draws a plan and judges it, for no plots.
pub fn draw(plan: &Plan, console: &Console) -> Record {
    judged(plan, &mut Cache::default(), &Store::default(), console)
}

/// Draws what neither cache nor store has, keeps it, judges all, and adds the lines of plots.
pub fn draw_with(
    plan: &Plan,
    cache: &mut Cache,
    store: &Store,
    console: &Console,
) -> anyhow::Result<Record> {
    let mut record = judged(plan, cache, store, console);
    store.fault().map_or(Ok(()), Err)?;
    verdict::add_curves(plan, &mut record);
    Ok(record)
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
    store.fault().map_or(Ok(()), Err)?;
    Ok(is_whole)
}

fn judged(plan: &Plan, cache: &mut Cache, store: &Store, console: &Console) -> Record {
    let begin = Instant::now();
    let bar = output::progress_until("drawing", "draws", 0, plan.options.seconds, console);
    // What an earlier run drew says nothing about the speed of this one.
    let draws = run::draw_heard(plan, cache, store, &|step| match step {
        Step::Drawn(draws) => bar.inc(draws),
        Step::Expected(draws) => bar.set_length(draws),
        Step::Kept(_) => {}
    });
    bar.finish_and_clear();
    cache.keep(plan, &draws);
    verdict::judged(plan, &draws, begin.elapsed().as_secs_f64())
}

/// What this program has drawn for the results in a folder.
pub fn cached(out: &Path) -> anyhow::Result<Cache> {
    let path = out.join(CACHE);
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        // There is nothing to reuse, and that is no mistake.
        Err(error) if error.kind() == ErrorKind::NotFound => Vec::new(),
        Err(error) => {
            let cure = || format!("cannot read {}; move it away", path.display());
            return Err(error).with_context(cure);
        }
    };
    Ok(Cache::read(&bytes, &fingerprint()?))
}

/// Writes what was drawn beside the results.
pub fn keep(cache: &Cache, out: &Path) -> anyhow::Result<()> {
    let path = out.join(CACHE);
    let bytes = cache.bytes().with_context(|| format!("cannot encode {}", path.display()))?;
    files::replace(&path, &bytes).with_context(|| format!("cannot write {}", path.display()))
}
