//! `trueflight bench`: run time against error.

use std::path::PathBuf;

use anyhow::{anyhow, bail};
use clap::Args;
use trueflight::bench::compare::{Comparison, compare};
use trueflight::bench::record::Bench;
use trueflight::bench::stored::Stored;
use trueflight::bench::{Amounts, measure};
use trueflight::harness::baseline::Baseline;
use trueflight::harness::{Amount, Plan};
use trueflight::report::{self, bench as page};

use super::output::{self, Format};
use super::selection::{self, Experiments};
use super::{Console, USAGE, baseline};

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    experiments: Experiments,
    /// Draws of an experiment in a round, such as 1e6; with the default the built-in suite takes
    /// about half a minute on one core
    #[arg(long, default_value = "32768", value_name = "N", value_parser = selection::draws)]
    #[arg(allow_hyphen_values = true)]
    draws: u64,
    /// Rounds; each times every experiment and its plain loop in turn
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    rounds: u32,
    /// Threads that draw at once, so many times as many draws; with several, time is elapsed and not processor
    /// time, and the column `scaling` compares them with one: give more draws then
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: u16,
    /// Folder for bench.csv, the cases' CSV files and the plots
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
    /// How much more time per draw is no regression, as a share; `inf` for any
    #[arg(long, value_name = "R", default_value_t = 0.25, value_parser = baseline::share)]
    #[arg(allow_hyphen_values = true)]
    time_tolerance: f64,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Times, compares, writes, prints.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let Arguments { experiments, draws, rounds, threads, .. } = arguments;
    let cases = experiments.read(console)?;
    let options = experiments.options(Amount::Exactly(*draws))?;
    output::writable(&arguments.out)?;
    let baselines = arguments.open()?;
    // Whatever is timed on, the plan may use all processors.
    let plan = selection::on_threads(0, || experiments.plan(&cases, &options))?;
    let ready = drawable(&plan)?;
    let total = ready * u64::from(*rounds) * draws;
    let mut bench = selection::on_threads(usize::from(*threads), || {
        let bar = output::progress("timing", "draws", total, console);
        let amounts = Amounts { draws: *draws, rounds: *rounds };
        let bench = measure(&plan, amounts, &|draws| bar.inc(draws));
        bar.finish_and_clear();
        Ok(bench)
    })?;
    let now = Stored::of(&bench);
    bench.comparison = baselines
        .stored
        .as_ref()
        .map(|(name, _, stored)| compare(name, stored, &now, arguments.time_tolerance));
    let is_worse = bench.comparison.as_ref().is_some_and(Comparison::fails);
    // What cannot be written keeps nothing else from being told.
    let mut errors = Vec::new();
    errors.extend(baselines.complaint(&bench));
    let files = page::render(&bench).map(|artifacts| {
        let failed = report::write(&artifacts, &arguments.out);
        let written = artifacts.len() - failed.len();
        errors.extend(failed.into_iter().map(anyhow::Error::from));
        written
    });
    errors.extend(arguments.print(&bench, console).err());
    let keeps = match &bench.comparison {
        Some(comparison) if comparison.fails() => Err("something became slower"),
        Some(comparison) if comparison.is_empty() => Err("nothing was compared"),
        _ => Ok(()),
    };
    let stored = baselines.store(&now, keeps).unwrap_or_else(|error| {
        errors.push(error);
        String::new()
    });
    match files {
        Ok(files) if arguments.format == Format::Table && !console.quiet => {
            let said = format!("{files} files in {}\n{stored}", arguments.out.display());
            errors.extend(output::print(&said).err());
        }
        Ok(_) => {}
        Err(error) => errors.push(error.into()),
    }
    errors.iter().for_each(output::complain);
    Ok(if errors.is_empty() { u8::from(is_worse) } else { USAGE })
}

/// How many experiments can be timed; none is an error.
fn drawable(plan: &Plan) -> anyhow::Result<u64> {
    match plan.experiments().filter(|(_, planned)| planned.outcome.is_ok()).count() {
        0 => bail!(
            "every experiment is refused, so there is nothing to time; `trueflight plan` says why"
        ),
        ready => Ok(ready as u64),
    }
}

/// What is compared with, and where it is stored; known before anything is timed.
struct Baselines {
    stored: Option<(String, PathBuf, Stored)>,
    save: Option<(String, PathBuf)>,
}

impl Baselines {
    /// What is wrong with a comparison that was asked for and says nothing.
    fn complaint(&self, bench: &Bench) -> Option<anyhow::Error> {
        let (comparison, (_, path, _)) = bench.comparison.as_ref().zip(self.stored.as_ref())?;
        let nothing = page::diff::nothing(comparison)?;
        Some(anyhow!(
            "{}: {nothing}; time the cases of the baseline, or make it anew with --save-baseline",
            path.display()
        ))
    }

    /// Stores the times where that is wished, unless there is a reason not to. Answers what to print.
    fn store(&self, now: &Stored, keeps: Result<(), &str>) -> anyhow::Result<String> {
        let Some((name, path)) = &self.save else { return Ok(String::new()) };
        if let Err(why) = keeps {
            return Ok(format!("baseline {name} not stored: {why}\n"));
        }
        now.write(path)?;
        Ok(format!("baseline {name} stored in {}\n", path.display()))
    }
}

impl Arguments {
    /// Reads the baseline and tries the folder.
    fn open(&self) -> anyhow::Result<Baselines> {
        let stored = self.baseline.as_ref().map(|name| -> anyhow::Result<_> {
            let path = Stored::path(&self.baselines, name)?;
            let stored = Stored::read(&path)?;
            let threads = usize::from(self.threads);
            if stored.threads != threads {
                let theirs = stored.threads;
                bail!("baseline {name} was timed with {theirs} threads; give --threads {theirs}");
            }
            Ok((name.clone(), path, stored))
        });
        let save = self.save_baseline.as_ref().map(|name| -> anyhow::Result<_> {
            let path = Stored::path(&self.baselines, name)?;
            Baseline::writable(&path)?;
            Ok((name.clone(), path))
        });
        Ok(Baselines { stored: stored.transpose()?, save: save.transpose()? })
    }

    fn print(&self, bench: &Bench, console: &Console) -> anyhow::Result<()> {
        let text = match self.format {
            Format::Table if console.quiet => return Ok(()),
            Format::Table => page::console::table(bench, output::pen(console)),
            Format::Csv => page::rows::csv(bench)?,
            Format::Json => page::rows::json(bench)?,
        };
        output::print(&text)
    }
}
