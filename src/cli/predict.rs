//! `trueflight predict`: theory only, no draws.

use clap::Args;
use trueflight::harness::{Amount, judge};
use trueflight::report::console::View;

use super::Console;
use super::output::{self, Format};
use super::selection::Selection;

/// Arguments of `predict`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Prints what theory says of each experiment.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(console)?;
    let options = selection.options(Amount::Case)?;
    let record =
        selection.on_threads(|| Ok(judge::predicted(&selection.plan(&cases, &options)?)))?;
    output::print_record(&record, View::Predict, arguments.format, console)?;
    Ok(0)
}
