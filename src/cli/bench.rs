//! `trueflight bench`: run time against error.

use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use fearless_simd::Level;

use super::baseline::Files;
use super::output::{self, Errors, RowFormat};
use super::selection::{self, Experiments};
use super::{Console, numbers};
use crate::bench::record::Bench;
use crate::bench::stored::{BenchComparison, Stored, compare};
use crate::bench::{Amounts, measure};
use crate::case::Catalogue;
use crate::plan::{Amount, Plan};
use crate::report::bench as page;
use numeric::pack;

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    experiments: Experiments,
    /// Draws of an experiment in a round, such as 1e6; with the default the built-in suite takes
    /// about half a minute on one core
    #[arg(long, default_value = "32768", value_name = "N", value_parser = numbers::draws)]
    #[arg(allow_hyphen_values = true)]
    draws: u64,
    /// Rounds; each times every experiment and its plain loop in turn
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = numbers::whole::<u32>(1..=10_000), allow_negative_numbers = true)]
    rounds: u32,
    /// Threads that draw at once, each with the full number of draws; with several, time is elapsed and not processor
    /// time, and the column `scaling` compares them with one: give more draws then
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = numbers::threads, allow_negative_numbers = true)]
    threads: u16,
    /// Vector hardware to draw with, one of those of this machine [default: the best]
    #[arg(long, value_name = "LEVEL", value_parser = level)]
    level: Option<Level>,
    /// Folder for report.html, bench.csv, the cases' CSV files and the plots
    #[arg(long, default_value = "results/bench", value_name = "DIR")]
    out: PathBuf,
    /// Store the times as a baseline, to compare later ones with
    #[arg(long, value_name = "NAME")]
    save_baseline: Option<String>,
    /// Compare with stored times: fail where the time per draw has grown
    #[arg(long, value_name = "NAME")]
    baseline: Option<String>,
    /// Folder of the baselines
    #[arg(long, value_name = "DIR", default_value = "baselines")]
    baselines: PathBuf,
    /// Increase of the time per draw that is no regression, as a share; `inf` for any
    #[arg(long, value_name = "R", default_value_t = 0.25, value_parser = numbers::share)]
    #[arg(allow_hyphen_values = true)]
    time_tolerance: f64,
    /// Form of the rows on stdout
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
}

/// Times, compares, writes, prints.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let Arguments { experiments, draws, rounds, threads, .. } = arguments;
    let cases = experiments.read(catalogue, console)?;
    let options = experiments.options(Amount::Exactly(*draws))?;
    output::can_write(&arguments.out)?;
    let baselines = arguments.open()?;
    // The plan may use all processors, whatever the number of timed threads.
    let plan = selection::on_threads(0, || experiments.plan(&cases, &options, console))?;
    let ready = drawable(&plan)?;
    let level = arguments.level.unwrap_or_else(Level::new);
    let is_told = arguments.format == RowFormat::Table && !console.quiet;
    if is_told {
        output::print(&page::console::opening(&plan, *rounds, *draws))?;
    }
    let total = ready * u64::from(*rounds) * draws;
    let mut bench = selection::on_threads(usize::from(*threads), || {
        let bar = output::progress("timing", "draws", total, console);
        let amounts = Amounts { draws: *draws, rounds: *rounds, level };
        let bench = measure(&plan, amounts, &|draws| bar.inc(draws));
        bar.finish_and_clear();
        Ok(bench)
    })?;
    let now = Stored::of(&bench);
    bench.comparison = baselines
        .stored
        .as_ref()
        .map(|(name, _, stored)| compare(name, stored, &now, arguments.time_tolerance));
    let is_worse = bench.comparison.as_ref().is_some_and(BenchComparison::fails);
    let mut errors = Errors::default();
    let nothing = bench.comparison.as_ref().and_then(page::diff::nothing);
    let complain =
        |nothing: String| baselines.complaint(&nothing, "time the cases of the baseline");
    errors.extend(nothing.and_then(complain));
    let files = errors.write(page::render(&bench), &arguments.out);
    errors.keep(arguments.print(&bench, console));
    let why_not = match &bench.comparison {
        Some(comparison) if comparison.fails() => Some("something became slower"),
        Some(comparison) if comparison.is_empty() => Some("nothing was compared"),
        _ => None,
    };
    let stored = errors.keep(baselines.store(why_not, |path| now.write(path)));
    if let Some(files) = files.filter(|_| is_told) {
        let (out, page) = (arguments.out.display(), output::report_in(&arguments.out));
        let meaning = page::console::meaning(&bench);
        let said = format!("{files} files in {out}\n{stored}{meaning}{page}");
        errors.keep(output::print(&said));
    }
    Ok(errors.close(u8::from(is_worse)))
}

/// Returns a level of vector hardware by its name.
fn level(name: &str) -> Result<Level, String> {
    let levels = pack::levels();
    let result = levels.iter().find(|level| pack::word(**level) == name);
    result.copied().ok_or_else(|| {
        let names: Vec<String> = levels.iter().map(|&level| pack::word(level)).collect();
        format!("this machine has {}", names.join(", "))
    })
}

/// Returns the number of experiments that can be timed; 0 is an error.
fn drawable(plan: &Plan) -> anyhow::Result<u64> {
    match plan.experiments().filter(|(_, planned)| planned.outcome.is_ok()).count() {
        0 => bail!(
            "every experiment is refused, so there is nothing to time; `trueflight plan` says why"
        ),
        ready => Ok(ready as u64),
    }
}

impl Arguments {
    /// Reads the baseline and checks the folder.
    fn open(&self) -> anyhow::Result<Files<Stored>> {
        Files::open(
            [self.baseline.as_ref(), self.save_baseline.as_ref()],
            |name| Stored::path(&self.baselines, name),
            |name, path| {
                let stored = Stored::read(path)?;
                let theirs = stored.threads;
                if theirs != usize::from(self.threads) {
                    bail!(
                        "baseline {name} was timed with {theirs} threads; give --threads {theirs}"
                    );
                }
                Ok(stored)
            },
        )
    }

    fn print(&self, bench: &Bench, console: &Console) -> anyhow::Result<()> {
        let text = match self.format {
            RowFormat::Table if console.quiet => return Ok(()),
            RowFormat::Table => page::console::table(bench, output::pen(console)),
            RowFormat::Csv => page::tables::csv(bench)?,
            RowFormat::Json => page::tables::json(bench)?,
        };
        output::print(&text)
    }
}
