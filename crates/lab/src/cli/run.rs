//! `trueflight-lab stress` and `trueflight-lab self-test`: the limits of doubles, and the test of the gate itself.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use crate::report::{self_test, stress as page};
use crate::self_test::{SelfTest, calibration, mutation, streams};
use crate::stress::{self, Effort, PAGES, Run};
use numeric::digits::counted;
use trueflight::cli::selection::{Seed, Threads};
use trueflight::cli::{Console, numbers, output};

/// Arguments of `stress`.
#[derive(Debug, Args)]
pub struct Stress {
    /// A short form of every part: seconds instead of minutes
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    threads: Threads,
    /// Folder of results; report.html, tables and plot go to `stress` below it
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
}

/// Runs the stress test, prints and writes the table, and returns 1 if any bound is broken.
pub(super) fn stress(arguments: &Stress, console: &Console) -> anyhow::Result<u8> {
    output::can_write(&arguments.out.join("stress"))?;
    let effort = if arguments.quick { Effort::Quick } else { Effort::Full };
    // Single precision comes after the pages.
    let bar = output::progress("stressing", "parts", PAGES.values.len() as u64 + 1, console);
    let run = Run { effort, seed: arguments.seed.seed };
    if !console.quiet {
        let form = if arguments.quick { "the short form" } else { "the long form" };
        let (parts, seed) = (PAGES.values.len() + 1, run.seed);
        output::print(&format!("stress: {parts} parts, {form}, seed {seed}\n"))?;
    }
    let computed = arguments.threads.install(|| Ok(stress::all(run, &|_| bar.inc(1))))?;
    bar.finish_and_clear();
    let written = output::write(&page::artifacts(&computed)?, &arguments.out);
    if !console.quiet {
        output::print(&page::table(&computed, output::pen(console)))?;
    }
    written?;
    if !console.quiet {
        output::print(&output::report_in(&arguments.out.join("stress")))?;
    }
    Ok(u8::from(!computed.holds()))
}

/// Number of independent runs of the long calibration.
const LONG: u64 = 10_000;

/// Number of streams of each distribution in the long form.
const LONG_STREAMS: u64 = 1000;

/// Arguments of `self-test`.
#[derive(Debug, Args)]
pub struct SelfTestArguments {
    /// Independent runs of the calibration
    #[arg(long, default_value_t = 400, value_name = "N", value_parser = numbers::whole::<u64>(1..=1_000_000), allow_negative_numbers = true)]
    runs: u64,
    /// Streams of correct foreign draws of each distribution
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = numbers::whole::<u64>(1..=1_000_000), allow_negative_numbers = true)]
    streams: u64,
    /// Calibrate with 10 000 independent runs, and judge 1000 streams of each distribution
    #[arg(long, conflicts_with_all = ["runs", "streams"])]
    long: bool,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    threads: Threads,
    /// Also write the tables as CSV into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Calibrates, draws all mutants, and prints the tables.
pub(super) fn self_test(arguments: &SelfTestArguments, console: &Console) -> anyhow::Result<u8> {
    arguments.out.iter().try_for_each(|out| output::can_write(out))?;
    let runs = if arguments.long { LONG } else { arguments.runs };
    let many = if arguments.long { LONG_STREAMS } else { arguments.streams };
    let begin = Instant::now();
    if !console.quiet {
        let (laws, seed) = (streams::LAWS.len(), arguments.seed.seed);
        output::print(&format!(
            "self-test: {runs} runs of the calibration, {} of each of {laws} distributions, all known bugs, seed {seed}\n",
            counted(many, "stream")
        ))?;
    }
    let computed = arguments.threads.install(|| {
        let bar = output::progress("calibrating", "runs", runs, console);
        let calibration = calibration::calibrate(runs, &|n| bar.inc(n))?;
        bar.finish_and_clear();
        let laws = streams::LAWS.len() as u64;
        let bar = output::progress("judging", "streams", many * laws, console);
        let streams = streams::all(many, &|n| bar.inc(n));
        bar.finish_and_clear();
        let mutants = mutation::all(arguments.seed.seed)?;
        Ok(SelfTest { calibration, streams, mutants, seconds: begin.elapsed().as_secs_f64() })
    })?;
    if let Some(out) = &arguments.out {
        output::write(&self_test::artifacts(&computed)?, out)?;
    }
    if !console.quiet {
        output::print(&self_test::table(&computed, output::pen(console)))?;
        if let Some(out) = &arguments.out {
            output::print(&format!("tables: {}\n", out.join("self-test").display()))?;
        }
    }
    Ok(u8::from(!computed.holds()))
}
