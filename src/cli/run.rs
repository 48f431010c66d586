//! `trueflight run`: the main job, whole, a share of it, or what an interrupted one has left.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use anyhow::Context;
use clap::{Args, Command, FromArgMatches};

use super::baseline::BaselineArguments;
use super::output::{self, Errors, Format};
use super::selection::{Looks, Selection};
use super::verdict::{Inconclusive, UNDECIDED, close};
use super::{Console, drawing, journal, numbers};
use crate::case::Case;
use crate::case::Catalogue;
use crate::draw::share::Share;
use crate::draw::store::{Header, Key, Log, Store};
use crate::draw::workers::{Threads, Workers};
use crate::plan::Options;
use crate::plan::Plan;
use crate::plan::options::DRAWS;
use crate::record::baseline::fingerprint;
use crate::record::verdict;
use crate::report;

/// Arguments of `run`.
#[derive(Debug, Clone, Args)]
pub struct Arguments {
    #[command(flatten)]
    pub selection: Selection,
    /// Folder for report.html, summary.csv, checks.csv, record.json, the cases' CSV files and the plots
    #[arg(long, default_value = "results", value_name = "DIR")]
    pub out: PathBuf,
    /// Go on with the interrupted run in this folder; what is drawn is what its command said
    #[arg(long, value_name = "DIR", conflicts_with_all = [
        "cases", "filter", "kernel", "seed", "draws", "alpha", "out", "fixed_draws", "fresh", "strict", "blocks_per_look", "shard",
    ])]
    resume: Option<PathBuf>,
    /// Draw a share of all blocks, such as part 3 of 16, and judge nothing: that does `trueflight merge`
    #[arg(long, value_name = "K/N", conflicts_with_all = ["time", "save_baseline", "baseline"])]
    pub shard: Option<Share>,
    /// Stop drawing after this time, such as 30s, 5m or 90 (seconds); results then depend on the machine
    #[arg(long, value_name = "T", value_parser = numbers::seconds, allow_negative_numbers = true)]
    time: Option<f64>,
    #[command(flatten)]
    looks: Looks,
    /// Draw every experiment, also those that have not changed since the last run in the same folder, or
    /// that an interrupted one there has begun
    #[arg(long)]
    pub fresh: bool,
    /// What an inconclusive experiment counts as [default: exit code 3]
    #[arg(long, value_enum, value_name = "AS")]
    pub inconclusive: Option<Inconclusive>,
    #[command(flatten)]
    baseline: BaselineArguments,
    /// Print every row, not only those that do not pass
    #[arg(long, short)]
    pub verbose: bool,
    /// Form of the rows on stdout; csv and json have all of them
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

impl Arguments {
    /// The words that ask for the same draws, wherever they are made.
    pub fn words(&self) -> Vec<String> {
        let mut words = self.selection.words();
        words.extend(self.looks.words());
        words.push("--".to_owned());
        words.extend_from_slice(self.selection.names());
        words
    }

    /// What such words ask for.
    pub fn of(words: &[String]) -> anyhow::Result<Self> {
        let command = Self::augment_args(Command::new("run").no_binary_name(true));
        Ok(Self::from_arg_matches(&command.try_get_matches_from(words)?)?)
    }

    pub fn options(&self) -> anyhow::Result<Options> {
        let options = Options { seconds: self.time, ..self.selection.options(DRAWS)? };
        Ok(self.looks.of(options))
    }

    /// The same, or what an interrupted run was asked that is to be gone on with.
    pub fn resumed(&self) -> anyhow::Result<Self> {
        let Some(folder) = &self.resume else { return Ok(self.clone()) };
        let header = journal::header(folder)?;
        let known = Self::of(&header.words)?;
        Ok(Self {
            selection: known.selection.on_threads_of(&self.selection),
            looks: known.looks,
            out: folder.clone(),
            shard: header.share,
            ..self.clone()
        })
    }
}

/// Draws what is asked for, or what is missing of it.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    draw(&arguments.resumed()?, Box::new(Threads), catalogue, console)
}

/// Lets workers draw what is asked for, as it was resumed.
pub fn draw(
    asked: &Arguments,
    workers: Box<dyn Workers>,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    if asked.shard.is_some() && (asked.time.is_some() || asked.baseline.is_used()) {
        anyhow::bail!(
            "a share is drawn whole and compared with nothing: leave out --time and baselines"
        );
    }
    let store = |plan: &Plan| -> anyhow::Result<Store> {
        let header = Header::new(plan, &fingerprint()?, &asked.words(), asked.shard);
        workers.agree(&header).map_err(anyhow::Error::msg)?;
        journal::store(&asked.out, header, asked.resume.is_some(), asked.fresh, workers)
    };
    match asked.shard {
        Some(share) => draw_share(asked, share, catalogue, console, store),
        None => judge(asked, catalogue, console, store),
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
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    output::writable(&arguments.out)?;
    let out = arguments.out.display();
    let (is_whole, was_finished) =
        selection.with_plan(&cases, &arguments.options()?, console, |plan| {
            let store = store(plan)?;
            let was_finished = store.logs.iter().any(|log| log.has(Key::End));
            let is_whole = was_finished || drawing::draw_share(plan, share, &store, console)?;
            if is_whole && !was_finished {
                store.logs.iter().try_for_each(|log| log.put(Key::End, &()))?;
                store.logs.iter().try_for_each(Log::synchronise)?;
            }
            Ok((is_whole, was_finished))
        })?;
    if !is_whole {
        let cure = journal::resume(&arguments.out);
        anyhow::bail!("interrupted: share {share} is not finished; {cure} goes on with it");
    }
    if !console.quiet {
        let done = if was_finished { "was drawn before" } else { "is drawn" };
        output::print(&format!(
            "share {share} {done}: {out}; `{} merge` judges all parts\n",
            output::program()
        ))?;
    }
    Ok(0)
}

/// Draws what the store does not have, judges, writes, prints.
pub fn judge(
    arguments: &Arguments,
    catalogue: &Catalogue,
    console: &Console,
    store: impl FnOnce(&Plan) -> anyhow::Result<Store> + Send,
) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases: Vec<Case> = selection.read(catalogue, console)?;
    // Better to learn now than after the drawing that nothing can be written.
    output::writable(&arguments.out)?;
    let baselines = arguments.baseline.open()?;
    // A comparison needs times and evidence of its own.
    let is_fresh = arguments.fresh || arguments.baseline.is_used();
    let (finished, cure) = (journal::finished(&arguments.out), journal::resume(&arguments.out));
    let (record, [reused, ready], kept, store) =
        selection.with_plan(&cases, &arguments.options()?, console, |plan| {
            let mut store = store(plan)?;
            let wrong = || format!("cannot read {}; move it away", finished.display());
            store.reuse(&finished, is_fresh).with_context(wrong)?;
            let counts = store.reusable(plan);
            let drawn = drawing::judged(plan, &store, console);
            let (mut record, draws) =
                drawn.with_context(|| format!("not finished; {cure} goes on with what is kept"))?;
            let kept = store.finish(&finished, plan, &draws);
            verdict::add_curves(plan, &mut record);
            Ok((record, counts, kept, store))
        })?;
    // The time is up, or somebody wants it to end; a run that was begun with a limit of time is over then.
    let is_asked = store.stop.load(Ordering::Relaxed) || arguments.resume.is_some();
    let was_stopped = record.results.cut_by_time && is_asked && store.keeps;
    let (record, run) = baselines.compare(record, &cases);
    let mut errors = Errors::default();
    let files = errors.write(report::render(&record), &arguments.out);
    errors.keep(kept);
    if store.keeps && errors.is_empty() && !was_stopped {
        errors.keep(journal::end(&arguments.out));
    }
    drop(store);
    errors.keep(output::print_run(&record, arguments.format, arguments.verbose, console));
    errors.extend(baselines.complaint(&record));
    // What is to be gone on with is no baseline yet.
    let store = || baselines.store(&record, run.as_ref());
    let stored = if was_stopped { String::new() } else { errors.keep(store()) };
    let is_told = arguments.format == Format::Table && !console.quiet;
    if let Some(files) = files.filter(|_| is_told) {
        let reuse = if reused > 0 {
            format!(
                "{reused} of {ready} experiments have not changed since the last run there: their \
                 draws were reused (--fresh makes them anew)\n"
            )
        } else {
            String::new()
        };
        let (out, page) = (arguments.out.display(), output::report_in(&arguments.out));
        errors.keep(output::print(&format!("{files} files in {out}\n{reuse}{stored}{page}")));
    }
    let code = close(&record, arguments.inconclusive, &errors);
    if was_stopped {
        output::warn(&format!(
            "interrupted, or out of time: this is judged on what was drawn; {cure} goes on"
        ));
    }
    // What was cut short is no pass, whatever counts as one.
    Ok(if was_stopped && code == 0 { UNDECIDED } else { code })
}
