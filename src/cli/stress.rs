//! `trueflight stress`: where doubles run out of digits, and by how much.

use std::path::PathBuf;

use clap::Args;
use numeric::rng::Address;

use super::{Console, numbers, output};
use crate::case::Case;
use crate::case::source::Source;
use crate::report::{self, stress as page};
use crate::stress::{self, Effort, PAGES, Run};

/// Arguments of `stress`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A short form of every part: seconds instead of minutes
    #[arg(long)]
    quick: bool,
    /// Seed of the random parameters
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = numbers::seed, allow_negative_numbers = true)]
    seed: u64,
    /// Threads [default: one per processor]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = numbers::threads, allow_negative_numbers = true)]
    threads: Option<u16>,
    /// Folder of results; report.html, tables and plot go to `stress` below it
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
}

/// Runs the stress test, prints and writes the table, and returns 1 if any bound is broken.
///
/// # Errors
///
/// A folder that cannot be written, a pool of threads that cannot be started, or an encoder that fails.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    output::writable(&arguments.out.join("stress"))?;
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let effort = if arguments.quick { Effort::Quick } else { Effort::Full };
    // Single precision comes after the pages.
    let bar = output::progress("stressing", "parts", PAGES.len() as u64 + 1, console);
    let found =
        pool.install(|| stress::all(Run { effort, seed: arguments.seed }, stated, &|_| bar.inc(1)));
    bar.finish_and_clear();
    let written = report::write(&page::artifacts(&found)?, &arguments.out);
    if !console.quiet {
        output::print(&page::table(&found, output::pen(console)))?;
    }
    if let Some(error) = written.into_iter().next() {
        return Err(error.into());
    }
    if !console.quiet {
        output::print(&output::report_in(&arguments.out.join("stress")))?;
    }
    Ok(u8::from(!found.holds()))
}

/// Returns truth and relative variance that theory states of a channel of a case with one estimator.
pub fn stated(text: &str, channel: &str) -> Option<(f64, Option<f64>)> {
    /// Address of pilot draws, where theory has no variance.
    const NOWHERE: Address = Address { seed: 0, experiment: 0, block: 0, lane: 0 };
    let source = Source { name: "stress".into(), path: "stress.toml".into(), text: text.into() };
    let case = Case::read(&source).ok()?;
    let ready = case.at(None).and_then(|at| at.prepare(0, NOWHERE)).ok()?;
    let found = ready.prediction.channels.iter().find(|found| found.name == channel)?;
    let truth = found.truth.value;
    let variance = found.moments.map(|moments| moments.variance() / (truth * truth));
    Some((truth, variance.filter(|variance| variance.is_finite())))
}
