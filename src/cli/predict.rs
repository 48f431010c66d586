//! `trueflight predict` and `trueflight plan`: theory and the plan of a run, no draws.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::output::{self, RowFormat};
use super::selection::Selection;
use super::{Console, journal};
use crate::case::Catalogue;
use crate::draw::store::{Header, Store};
use crate::plan::options::DRAWS;
use crate::record::baseline::fingerprint;
use crate::record::build;
use crate::report::run::console::{TableView, prediction_heading};

/// Arguments of `predict`.
#[derive(Debug, Args)]
pub struct Predict {
    #[command(flatten)]
    selection: Selection,
    /// Show J₁ to J₄, the relative central moments with their error, the cost and the rare-event size
    #[arg(long)]
    moments: bool,
    /// Search the constant σ̂ with the largest figure of merit, channel by channel: a hundred predictions for each
    /// estimator. If the figure of merit rises with σ̂ to a limit there is no optimum: the table then shows the σ̂ that
    /// reaches 90 % of the limit, and the limit
    #[arg(long)]
    optimum: bool,
    /// Form of the rows on stdout
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
}

/// Prints the prediction of each experiment.
pub fn predict(
    arguments: &Predict,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    let predict = if arguments.optimum { build::predicted_with_optima } else { build::predicted };
    let options = selection.options(DRAWS)?;
    let is_told = arguments.format == RowFormat::Table && !console.quiet;
    let record = selection.with_plan(&cases, &options, console, |plan| {
        if is_told {
            output::print(&prediction_heading(plan))?;
        }
        Ok(predict(plan))
    })?;
    let view = if arguments.moments { TableView::Moments } else { TableView::Predict };
    output::print_record(&record, view, arguments.format, console)?;
    if is_told {
        output::print("`trueflight run` draws these estimators and compares them with theory.\n")?;
    }
    Ok(0)
}

/// Arguments of `plan`.
#[derive(Debug, Args)]
pub struct PlanArguments {
    #[command(flatten)]
    selection: Selection,
    /// Folder of the results of an earlier run: experiments that have not changed since are not drawn
    #[arg(long, default_value = "results", value_name = "DIR")]
    out: PathBuf,
    /// Form of the rows on stdout
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
}

/// Prints the experiments with their draws, or why they are refused.
pub fn plan(
    arguments: &PlanArguments,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    let (record, [kept, ready]) =
        selection.with_plan(&cases, &selection.options(DRAWS)?, console, |plan| {
            let mut store = Store::new(Header::new(plan, &fingerprint()?, &[], None));
            let finished = journal::finished(&arguments.out);
            let wrong = || format!("cannot read {}; move it away", finished.display());
            store.reuse(&finished, false).with_context(wrong)?;
            Ok((build::planned(plan), store.reusable(plan)))
        })?;
    output::print_record(&record, TableView::Plan, arguments.format, console)?;
    if kept > 0 && arguments.format == RowFormat::Table && !console.quiet {
        let folder = arguments.out.display();
        output::print(&format!(
            "{kept} of {ready} experiments have not changed since the last run in {folder}: `run` \
             would reuse their draws (--fresh makes them anew)\n"
        ))?;
    }
    Ok(0)
}
