//! `trueflight run` and `trueflight check`: one implementation, which draws, judges and writes; they differ by defaults.

use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Instant;

use anyhow::{Context, bail};
use clap::{Args, Command, FromArgMatches};

use super::baseline::BaselineArguments;
use super::output::{self, Errors};
use super::reports::{Reports, UNDECIDED, close};
use super::selection::{Looks, Selection};
use super::{Console, journal};
use crate::case::Catalogue;
use crate::draw::run::{self, Step};
use crate::draw::share::{self, Share, Threads, Workers};
use crate::draw::store::{Header, Key, Log, Store};
use crate::plan::{Options, Plan, options::DRAWS};
use crate::record::baseline::fingerprint;
use crate::record::build;
use crate::report::run::console as screen;

/// Defaults by which commands differ.
#[derive(Debug, Clone, Copy)]
pub struct CommandDefaults {
    /// Number of draws per experiment if neither an argument nor the case gives it.
    draws: u64,
    /// Folder of the results.
    out: Option<&'static str>,
    /// True if unchanged experiments of an earlier run are reused, and all reports are written.
    is_whole: bool,
}

/// Profile of `run` and `merge`.
pub const RUN: CommandDefaults =
    CommandDefaults { draws: DRAWS, out: Some("results"), is_whole: true };

/// Profile of `check`, for a CI: fewer draws, nothing is kept, and reports are written where an option asks for them.
const CHECK: CommandDefaults = CommandDefaults { draws: 400_000, out: None, is_whole: false };

/// Arguments of `run`.
#[derive(Debug, Clone, Args)]
pub struct Arguments {
    #[command(flatten)]
    pub requested: CheckArguments,
    #[command(flatten)]
    kept: ResumeArguments,
}

/// Arguments that `run` and `check` share.
#[derive(Debug, Clone, Args)]
pub struct CheckArguments {
    #[command(flatten)]
    pub selection: Selection,
    #[command(flatten)]
    looks: Looks,
    #[command(flatten)]
    pub reports: Reports,
    #[command(flatten)]
    baseline: BaselineArguments,
}

/// Options on interrupted and shared runs.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Interrupted and shared runs")]
pub struct ResumeArguments {
    /// Draw every experiment, also those that have not changed since the last run in the same folder, or
    /// that an interrupted one there has begun
    #[arg(long)]
    fresh: bool,
    /// Resume the interrupted run in this folder, with the cases and options of its own command
    #[arg(long, value_name = "DIR", conflicts_with_all = [
        "cases", "filter", "seed", "draws", "alpha", "out", "fixed_draws", "fresh", "strict", "blocks_per_look", "shard",
    ])]
    resume: Option<PathBuf>,
    /// Draw a share of all blocks, such as part 3 of 16, without a verdict: `trueflight merge` judges
    #[arg(long, value_name = "K/N", conflicts_with_all = ["budget", "save_baseline", "baseline"])]
    shard: Option<Share>,
}

impl ResumeArguments {
    /// Draws everything.
    pub const FRESH: Self = Self { fresh: true, resume: None, shard: None };
}

impl CheckArguments {
    /// Returns the words that ask for the draws of these options, on any machine.
    fn words(&self, options: &Options) -> Vec<String> {
        let mut words = options.words();
        words.push("--".to_owned());
        words.extend_from_slice(self.selection.names());
        words
    }

    fn options(&self, profile: CommandDefaults) -> anyhow::Result<Options> {
        Ok(self.looks.of(self.selection.options(profile.draws)?))
    }

    fn out(&self, profile: CommandDefaults) -> Option<PathBuf> {
        self.reports.out.clone().or(profile.out.map(PathBuf::from))
    }
}

impl Arguments {
    /// Reads words that ask for draws.
    pub fn of(words: &[String]) -> anyhow::Result<Self> {
        let command = Self::augment_args(Command::new("run").no_binary_name(true));
        Ok(Self::from_arg_matches(&command.try_get_matches_from(words)?)?)
    }

    /// Returns the words that ask for the same draws.
    pub fn words(&self) -> anyhow::Result<Vec<String>> {
        Ok(self.requested.words(&self.options()?))
    }

    /// Returns the options of the plan.
    pub fn options(&self) -> anyhow::Result<Options> {
        self.requested.options(RUN)
    }

    /// Returns the folder of the results.
    pub fn out(&self) -> PathBuf {
        self.requested.out(RUN).unwrap_or_default()
    }

    /// Returns whether the run is shared out.
    pub fn is_share(&self) -> bool {
        self.kept.shard.is_some()
    }

    /// Returns the arguments of the interrupted run that is resumed, or the same.
    pub fn resumed(&self) -> anyhow::Result<Self> {
        let Some(folder) = &self.kept.resume else { return Ok(self.clone()) };
        if self.requested.looks.shares_draws() {
            bail!("a resumed run makes the draws that its command asked for: give --budget a time");
        }
        let header = journal::header(folder)?;
        let Self { mut requested, mut kept } = self.clone();
        let known = Self::of(&header.words)?.requested;
        requested.selection = known.selection.on_threads_of(&requested.selection);
        requested.looks = known.looks.with_budget_of(&requested.looks);
        requested.reports.out = Some(folder.clone());
        kept.shard = header.share;
        Ok(Self { requested, kept })
    }
}

/// Draws a run, or the missing part of it.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    draw(&arguments.resumed()?, Box::new(Threads), catalogue, console)
}

/// Draws and judges with the defaults of `check`.
pub fn check(
    requested: &CheckArguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    judge(requested, CHECK, &ResumeArguments::FRESH, catalogue, console, |_| Ok(Store::default()))
}

/// Lets workers draw a run, or the rest of a resumed one.
pub fn draw(
    arguments: &Arguments,
    workers: Box<dyn Workers>,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    let Arguments { requested, kept } = arguments;
    let out = arguments.out();
    let is_timed = requested.looks.budget.is_some();
    if kept.shard.is_some() && (is_timed || requested.baseline.is_used()) {
        bail!("a share is drawn whole and compared with nothing: leave out --budget and baselines");
    }
    let store = |plan: &Plan| -> anyhow::Result<Store> {
        let header =
            Header::new(plan, &fingerprint()?, &requested.words(&plan.options), kept.shard);
        workers.agree(&header).map_err(anyhow::Error::msg)?;
        if requested.looks.shares_draws() {
            // The number of draws left for an experiment depends on what others have drawn.
            let mut store = Store::new(header);
            store.workers = workers;
            return Ok(store);
        }
        journal::store(&out, header, kept.resume.is_some(), kept.fresh, workers)
    };
    match kept.shard {
        Some(share) => draw_share(arguments, share, catalogue, console, store),
        None => judge(requested, RUN, kept, catalogue, console, store),
    }
}

/// Draws a share of the blocks; the folder then has them, and nothing else.
fn draw_share(
    arguments: &Arguments,
    share: Share,
    catalogue: &Catalogue,
    console: &Console,
    store: impl FnOnce(&Plan) -> anyhow::Result<Store> + Send,
) -> anyhow::Result<u8> {
    let (selection, out) = (&arguments.requested.selection, arguments.out());
    let cases = selection.read(catalogue, console)?;
    output::writable(&out)?;
    let options = arguments.options()?;
    let (is_whole, was_finished) = selection.with_plan(&cases, &options, console, |plan| {
        let store = store(plan)?;
        let was_finished = store.logs.iter().any(|log| log.has(Key::End));
        if was_finished {
            return Ok((true, true));
        }
        // A share is drawn up to the horizon: the gate looks only when all shares are there.
        let blocks = share::blocks(plan, share).count() as u64;
        let bar = output::progress("drawing", "draws", blocks * plan.step(), console);
        let is_whole = run::draw_share(plan, share, &store, &|step| match step {
            Step::Drawn(draws) => bar.inc(draws),
            Step::Kept(draws) => bar.dec_length(draws),
            Step::Expected(draws) => bar.set_length(draws),
        });
        bar.finish_and_clear();
        store.error().map_or(Ok(()), Err)?;
        if is_whole {
            store.logs.iter().try_for_each(|log| log.put(Key::End, &()))?;
            store.logs.iter().try_for_each(Log::synchronise)?;
        }
        Ok((is_whole, false))
    })?;
    if !is_whole {
        let cure = journal::resume(&out);
        bail!("interrupted: share {share} is not finished; {cure} goes on with it");
    }
    if !console.quiet {
        let done = if was_finished { "was drawn before" } else { "is drawn" };
        let (out, program) = (out.display(), output::program());
        output::print(&format!(
            "share {share} {done}: {out}; `{program} merge` judges all parts\n"
        ))?;
    }
    Ok(0)
}

/// Draws the blocks that the store does not have, judges, writes, prints.
pub fn judge(
    requested: &CheckArguments,
    profile: CommandDefaults,
    kept: &ResumeArguments,
    catalogue: &Catalogue,
    console: &Console,
    store: impl FnOnce(&Plan) -> anyhow::Result<Store> + Send,
) -> anyhow::Result<u8> {
    let (selection, reports) = (&requested.selection, &requested.reports);
    let cases = selection.read(catalogue, console)?;
    let out = requested.out(profile);
    // A folder that cannot be written to is reported before the drawing, not after it.
    reports.writable(out.as_deref(), &cases)?;
    let baselines = requested.baseline.open()?;
    // A comparison needs times and evidence of its own.
    let is_fresh = kept.fresh || requested.baseline.is_used();
    let finished = out.as_deref().filter(|_| profile.is_whole && !requested.looks.shares_draws());
    let finished = finished.map(journal::finished);
    let cure = out.as_deref().map_or(String::new(), journal::resume);
    let options = requested.options(profile)?;
    let (record, [reused, ready], finishing, store) =
        selection.with_plan(&cases, &options, console, |plan| {
            let mut store = store(plan)?;
            if let Some(path) = &finished {
                let wrong = || format!("cannot read {}; move it away", path.display());
                store.reuse(path, is_fresh).with_context(wrong)?;
            }
            let counts = store.reusable(plan);
            if reports.is_table() && !console.quiet {
                output::print(&screen::opening(plan))?;
            }
            let begin = Instant::now();
            let bar = output::progress_until("drawing", "draws", 0, plan.options.seconds, console);
            // Draws of an earlier run are not part of the speed of this one.
            let draws = run::draw_with(plan, &store, &|step| match step {
                Step::Drawn(draws) => bar.inc(draws),
                Step::Expected(draws) => bar.set_length(draws),
                Step::Kept(_) => {}
            });
            bar.finish_and_clear();
            let mut record = build::judged(plan, &draws, begin.elapsed().as_secs_f64());
            record.timing.date = output::date();
            record.timing.command = output::command_line();
            let not_finished = || format!("not finished; {cure} goes on with what is kept");
            store.error().map_or(Ok(()), Err).with_context(not_finished)?;
            let finishing = finished.as_ref().map_or(Ok(()), |path| store.finish(path, &draws));
            if profile.is_whole {
                build::add_curves(plan, &mut record);
            }
            Ok((record, counts, finishing, store))
        })?;
    // A run with a time limit is complete when the time is over; an interrupted or resumed run is not.
    let is_asked = store.stop.load(Ordering::Relaxed) || kept.resume.is_some();
    let was_stopped = record.results.cut_by_time && is_asked && store.keeps;
    let (record, run) = baselines.compare(record, &cases);
    let mut errors = Errors::default();
    let files = reports.write(&record, out.as_deref(), profile.is_whole, &mut errors);
    errors.keep(finishing);
    if let Some(out) = out.as_deref().filter(|_| store.keeps && errors.is_empty() && !was_stopped) {
        errors.keep(journal::end(out));
    }
    drop(store);
    errors.keep(output::print_run(&record, reports.format, reports.verbose, console));
    errors.extend(baselines.complaint(&record));
    // A run that will be resumed is no baseline yet.
    let store = || baselines.store(&record, run.as_ref());
    let mut reason = if was_stopped { String::new() } else { errors.keep(store()) };
    if let (Some(out), Some(files)) = (&out, files) {
        if reused > 0 {
            reason = format!(
                "{reused} of {ready} experiments have not changed since the last run there: their \
                 draws were reused (--fresh makes them anew)\n{reason}"
            );
        }
        reason = format!("{files} files in {}\n{reason}", out.display());
    }
    if reports.is_table() && !console.quiet {
        let meaning = screen::meaning(&record, output::pen(console));
        let page = out.as_ref().filter(|_| files.is_some()).map(|out| output::report_in(out));
        errors.keep(output::print(&format!("{reason}{meaning}{}", page.unwrap_or_default())));
    }
    reports.annotate(&record, &mut errors);
    let code = close(&record, reports.inconclusive, &errors);
    if was_stopped {
        output::warn(&format!(
            "interrupted, or out of time: this is judged on what was drawn; {cure} goes on"
        ));
    }
    // A run that was cut short is no pass, whatever counts as one.
    Ok(if was_stopped && code == 0 { UNDECIDED } else { code })
}
