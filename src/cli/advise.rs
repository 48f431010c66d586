//! `trueflight advise`: which estimator, which σ̂, and what they cost.

use std::path::PathBuf;

use clap::Args;

use super::output::{self, Errors, RowFormat};
use super::selection::{Seed, Threads};
use super::{Console, numbers};
use crate::advise::options::{self, Budget};
use crate::advise::{AdviceRequest, Costs, advise, rays::MAX_RAYS};
use crate::case::{Catalogue, Spec, catalogue};
use crate::report::advise as page;

/// Arguments of `advise`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A case file, or the name of a built-in case; its estimators are candidates beside all others of its problem
    #[arg(value_name = "CASE", value_parser = super::help::Names::Cases, hide_possible_values = true)]
    case: String,
    /// Relative standard error to reach, such as 1% or 0.01
    #[arg(long, value_name = "E", default_value = "1%", value_parser = options::error, allow_hyphen_values = true)]
    error: f64,
    /// Reach the least error within a time (30s, 5ms) or a number of lookups (1e6), for each ray
    #[arg(long, value_name = "B", conflicts_with = "error", value_parser = options::budget, allow_hyphen_values = true)]
    budget: Option<Budget>,
    /// Costs of your own code, such as lookup=2us or draw=50ns,lookup=2us, in place of those of this machine
    #[arg(long, value_name = "COSTS", value_parser = options::costs, allow_hyphen_values = true)]
    cost: Option<Costs>,
    /// Measure the costs of this machine again; they are kept in the user's cache folder
    #[arg(long, conflicts_with = "cost")]
    calibrate: bool,
    /// Factor by which your majorants exceed the maximum of σ_t, 1 or more
    #[arg(long, value_name = "F", default_value = "1", value_parser = options::looseness, allow_hyphen_values = true)]
    majorant: f64,
    /// Random rays through the volume, uniform and isotropic, in place of the case's own
    #[arg(long, value_name = "N", value_parser = numbers::whole::<u64>(1..=MAX_RAYS), allow_negative_numbers = true)]
    rays: Option<u64>,
    #[command(flatten)]
    seed: Seed,
    #[command(flatten)]
    threads: Threads,
    /// Folder for report.html, advise.csv and the figure
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Form of the rows on stdout
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
}

/// Advises, writes, prints.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    arguments.out.iter().try_for_each(|out| output::can_write(out))?;
    let source = catalogue::source(&arguments.case);
    let request = arguments.request();
    let result = match source.and_then(|source| Spec::parse(&source, catalogue.own_pages())) {
        Ok(spec) => arguments.threads.install(|| Ok(advise(&spec, &request)))?,
        Err(error) => Err(error),
    };
    let wrong = |error| output::mistakes(&[error], console, ["case file", "nothing was advised"]);
    let advice = result.map_err(wrong)?;
    let mut errors = Errors::default();
    errors.keep(match arguments.format {
        RowFormat::Table if console.quiet => Ok(()),
        RowFormat::Table => output::print(&page::console::table(&advice, output::pen(console))),
        RowFormat::Csv => output::print(&page::csv(&advice)?),
        RowFormat::Json => output::print(&page::json(&advice)?),
    });
    if let Some(out) = &arguments.out {
        let files = errors.write(page::render(&advice), out);
        let is_told = arguments.format == RowFormat::Table && !console.quiet && files.is_some();
        errors.keep(if is_told { output::print(&output::report_in(out)) } else { Ok(()) });
    }
    Ok(errors.close(0))
}

impl Arguments {
    fn request(&self) -> AdviceRequest {
        let costs = self.cost.clone().unwrap_or_else(|| Costs::of_this_machine(self.calibrate));
        let (target, costs) = options::goal(self.error, self.budget, costs);
        let (rays, seed) = (self.rays, self.seed.seed);
        AdviceRequest {
            target,
            costs,
            rays,
            seed,
            looseness: self.majorant,
            curves: self.out.is_some(),
        }
    }
}
