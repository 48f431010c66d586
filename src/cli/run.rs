//! `trueflight run`: the main job.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;

use super::baseline::BaselineArguments;
use super::output::{self, Errors, Format};
use super::selection::Selection;
use super::verdict::{self, Inconclusive};
use super::{Console, drawing};
use crate::harness::Catalogue;
use crate::harness::Options;
use crate::harness::options::DRAWS;
use crate::report::{self, console::View};

/// Arguments of `run`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// Folder for summary.csv, checks.csv, record.json, the cases' CSV files and the plots
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
    /// Stop drawing after this time, such as 30s or 5m; results then depend on the machine
    #[arg(long, value_name = "T", value_parser = drawing::seconds)]
    time: Option<f64>,
    /// Draw exactly what is planned: no check stops the drawing, none prolongs it
    #[arg(long)]
    fixed_draws: bool,
    /// Draw every experiment, also those that have not changed since the last run in the same folder
    #[arg(long)]
    fresh: bool,
    /// Let every underpowered check make its experiment inconclusive
    #[arg(long)]
    strict: bool,
    /// What an inconclusive experiment counts as [default: exit code 3]
    #[arg(long, value_enum, value_name = "AS")]
    inconclusive: Option<Inconclusive>,
    #[command(flatten)]
    baseline: BaselineArguments,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Draws, judges, writes, prints.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    let options = Options {
        seconds: arguments.time,
        fixed: arguments.fixed_draws,
        strict: arguments.strict,
        ..selection.options(DRAWS)?
    };
    // Better to learn now than after the drawing that nothing can be written.
    output::writable(&arguments.out)?;
    let baselines = arguments.baseline.open()?;
    let mut cache = drawing::cached(&arguments.out)?;
    // A comparison wants times and evidence of its own.
    cache.is_fresh = arguments.fresh || arguments.baseline.is_used();
    let (record, [reused, ready]) = selection.with_plan(&cases, &options, |plan| {
        let counts = cache.count(plan);
        Ok((drawing::draw_uncached(plan, &mut cache, console), counts))
    })?;
    let (record, run) = baselines.compare(record, &cases);
    let mut errors = Errors::default();
    let files = errors.write(report::render(&record), &arguments.out);
    errors.keep(drawing::keep(&cache, &arguments.out));
    errors.keep(output::print_record(&record, View::Run, arguments.format, console));
    errors.extend(baselines.complaint(&record));
    let stored = errors.keep(baselines.store(&record, run.as_ref()));
    let is_told = arguments.format == Format::Table && !console.quiet;
    if let Some(files) = files.filter(|_| is_told) {
        let mut said = format!("{files} files in {}\n", arguments.out.display());
        if reused > 0 {
            let _ = writeln!(
                said,
                "{reused} of {ready} experiments have not changed since the last run there: their \
                 draws were reused (--fresh makes them anew)"
            );
        }
        errors.keep(output::print(&(said + &stored)));
    }
    Ok(verdict::close(&record, arguments.inconclusive, &errors))
}
