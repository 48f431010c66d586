//! `trueflight self-test`: the test button of the gate itself.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;

use super::{Console, numbers, output};
use crate::report::{self, self_test as page};
use crate::self_test::{SelfTest, calibration, mutation};
use lab::streams;

/// Independent runs of the long calibration.
const LONG: u64 = 10_000;

/// Streams of each law in the long form.
const MANY: u64 = 1000;

/// Arguments of `self-test`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Independent runs of the calibration
    #[arg(long, default_value_t = 400, value_name = "N", value_parser = numbers::whole::<u64>(1..=1_000_000), allow_negative_numbers = true)]
    runs: u64,
    /// Streams of correct foreign draws of each law
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = numbers::whole::<u64>(1..=1_000_000), allow_negative_numbers = true)]
    streams: u64,
    /// Calibrate with 10 000 independent runs, and judge 1000 streams of each law
    #[arg(long, conflicts_with_all = ["runs", "streams"])]
    long: bool,
    /// Seed of the mutants' draws
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = numbers::seed, allow_negative_numbers = true)]
    seed: u64,
    /// Threads [default: one per processor]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = numbers::threads, allow_negative_numbers = true)]
    threads: Option<u16>,
    /// Also write the tables as CSV into this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Calibrates, draws all mutants, and prints the tables.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    if let Some(out) = &arguments.out {
        output::writable(out)?;
    }
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let runs = if arguments.long { LONG } else { arguments.runs };
    let many = if arguments.long { MANY } else { arguments.streams };
    let begin = Instant::now();
    let found = pool.install(|| -> anyhow::Result<SelfTest> {
        let bar = output::progress("calibrating", "runs", runs, console);
        let calibration = calibration::calibrate(runs, &|n| bar.inc(n))?;
        bar.finish_and_clear();
        let laws = streams::LAWS.len() as u64;
        let bar = output::progress("judging", "streams", many * laws, console);
        let streams = streams::all(many, &|n| bar.inc(n));
        bar.finish_and_clear();
        let mutants = mutation::all(arguments.seed)?;
        Ok(SelfTest { calibration, streams, mutants, seconds: begin.elapsed().as_secs_f64() })
    })?;
    let written = match &arguments.out {
        Some(out) => report::write(&page::artifacts(&found)?, out),
        None => Vec::new(),
    };
    if let Some(error) = written.into_iter().next() {
        return Err(error.into());
    }
    if !console.quiet {
        output::print(&page::table(&found, output::pen(console)))?;
    }
    Ok(u8::from(!found.holds()))
}
