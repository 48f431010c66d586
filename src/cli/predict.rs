//! `trueflight predict`: theory only, no draws.

use clap::Args;

use super::Console;
use super::output::{self, Format};
use super::selection::Selection;
use crate::case::Catalogue;
use crate::plan::options::DRAWS;
use crate::record::verdict;
use crate::report::console::View;

/// Arguments of `predict`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// Show J₁ to J₄, the relative central moments with their error, the cost and the rare-event size
    #[arg(long)]
    moments: bool,
    /// Search the constant σ̂ with the largest figure of merit, channel by channel: a hundred
    /// predictions for each estimator. Where the figure of merit rises with σ̂ to a limit there is no
    /// optimum: the σ̂ that reaches 90 % of the limit is named so, with the limit
    #[arg(long)]
    optimum: bool,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Prints what theory says of each experiment.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    let predict =
        if arguments.optimum { verdict::predicted_with_optima } else { verdict::predicted };
    let options = selection.options(DRAWS)?;
    let record = selection.with_plan(&cases, &options, console, |plan| Ok(predict(plan)))?;
    let view = if arguments.moments { View::Moments } else { View::Predict };
    output::print_record(&record, view, arguments.format, console)?;
    Ok(0)
}
