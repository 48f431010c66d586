//! `trueflight plan`: what would run, what is refused, and why.

use std::path::PathBuf;

use clap::Args;

use super::output::{self, Format};
use super::selection::Selection;
use super::{Console, drawing};
use crate::case::Catalogue;
use crate::plan::options::DRAWS;
use crate::record::verdict;
use crate::report::console::View;

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// Folder of the results of an earlier run: what has not changed since would not be drawn
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Prints the experiments with their draws, or why they are refused.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    let (record, [kept, ready]) =
        selection.with_plan(&cases, &selection.options(DRAWS)?, console, |plan| {
            Ok((verdict::planned(plan), drawing::cached(&arguments.out)?.count(plan)))
        })?;
    output::print_record(&record, View::Plan, arguments.format, console)?;
    if kept > 0 && arguments.format == Format::Table && !console.quiet {
        let folder = arguments.out.display();
        output::print(&format!(
            "{kept} of {ready} experiments have not changed since the last run in {folder}: `run` \
             would reuse their draws (--fresh makes them anew)\n"
        ))?;
    }
    Ok(0)
}
