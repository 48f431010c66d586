//! `trueflight plan`: what would run, what is refused, and why.

use clap::Args;
use trueflight::harness::{judge, options::DRAWS};
use trueflight::report::console::View;

use super::Console;
use super::output::{self, Format};
use super::selection::Selection;

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Prints the experiments with their draws, or why they are refused.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(console)?;
    let options = selection.options(DRAWS)?;
    let record = selection.on_threads(|| Ok(judge::planned(&selection.plan(&cases, &options)?)))?;
    output::print_record(&record, View::Plan, arguments.format, console)?;
    Ok(0)
}
