//! Command line: arguments, exit codes, progress, and the only prints.
//!
//! A program with media and estimators of its own gets all commands by
//! `fn main() -> ExitCode { trueflight::cli::main(&catalogue) }`. If `mpirun` starts it, `bindings/mpi` has the
//! function by which [`main_among`] joins the other ranks.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | all pass |
//! | 1 | at least one experiment fails |
//! | 2 | usage, a bad case file, input or output |
//! | 3 | nothing fails, but something is inconclusive; `--inconclusive fail` makes it 1, `pass` 0 |

#![allow(clippy::missing_errors_doc)] // errors are messages to the person at the console

mod advise;
mod baseline;
mod bench;
mod catalogue;
mod export;
pub mod help;
mod inspect;
mod journal;
mod judge;
pub mod listing;
mod merge;
pub mod numbers;
pub mod output;
mod predict;
mod progress;
pub mod ranks;
mod render;
mod reports;
mod run;
pub mod selection;

use std::ffi::OsString;
use std::process::ExitCode;

use anyhow::bail;
use clap::{Args, FromArgMatches, Parser, Subcommand};

pub use self::help::command;
use self::ranks::Join;
use crate::case::Catalogue;

/// Exit code of every error before or beside the verdicts.
pub const USAGE: u8 = 2;

/// Test whether a light-transport estimator is unbiased and as noisy as theory says: compare its mean, variance, cost
/// and distribution with exact theory over millions of draws.
#[derive(Debug, Parser)]
#[command(name = "trueflight", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    console: Console,
}

/// Options on the console, for every command.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Console")]
pub struct Console {
    /// When to use colours; `NO_COLOR` is honoured by `auto`
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    color: output::When,
    /// No progress and no table, only errors
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw estimators, judge them, and write tables, plots and a page: the main command
    Run(run::Arguments),
    /// Judge a run that several machines drew in parts, by `run --shard`
    Merge(merge::Merge),
    /// Judge estimators in CI: stop as soon as all is decided; JUnit, Markdown and GitHub annotations
    Check(run::CheckArguments),
    /// Print what theory expects, without draws: moments, costs, the best σ̂, refusals
    Predict(predict::Predict),
    /// Rank all estimators of a case, each with its best σ̂ and control, by the time to an error
    Advise(advise::Arguments),
    /// Time estimators: ns per draw, time to an error, speedup over a plain loop
    Bench(bench::Arguments),
    /// Print what a run would draw, and which experiments are refused and why
    Plan(predict::PlanArguments),
    /// Draw pictures of estimators side by side at an equal number of lookups, with their errors
    Render(render::Arguments),
    /// Write the page report.html of a stored run
    Report(merge::Report),
    /// List media, estimators, problems, checks, cases and more
    List(catalogue::List),
    /// Print the manual page of a medium, an estimator, a check, …
    Explain(catalogue::Explain),
    /// List the grids, images and draws in files, with their sizes, boxes and ranges
    Inspect(inspect::Arguments),
    /// Judge draws or images of another program, from files or a pipe
    Judge(Box<judge::Arguments>),
    /// Write a case as a scene of Mitsuba 3 or pbrt-v4, with the expected values of its pixels
    Export(export::Arguments),
    /// Print completions for a shell
    Completions(help::Arguments),
}

/// Runs the command of the program's arguments with this catalogue, and returns its exit code.
pub fn main(catalogue: &Catalogue) -> ExitCode {
    run_with(catalogue, None, &parsed())
}

/// Runs the command of these arguments, the first of which is the program's name.
///
/// # Errors
///
/// A mistake in the arguments, as the command line reports it.
pub fn run_as<T: Into<OsString> + Clone>(
    catalogue: &Catalogue,
    arguments: impl IntoIterator<Item = T>,
) -> Result<ExitCode, String> {
    let matches = help::command().try_get_matches_from(arguments);
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = cli.map_err(|error| help::with_place(error).to_string())?;
    Ok(run_with(catalogue, None, &cli))
}

/// [`main`] for a program that `mpirun` may have started as one of several ranks, with the function to join them.
pub fn main_among(catalogue: &Catalogue, join: Join) -> ExitCode {
    run_with(catalogue, Some(join), &parsed())
}

/// Parses the program's arguments; a mistake ends the process.
fn parsed() -> Cli {
    let matches = help::command().try_get_matches();
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    cli.unwrap_or_else(|error| help::with_place(error).exit())
}

fn run_with(catalogue: &Catalogue, join: Option<Join>, cli: &Cli) -> ExitCode {
    match carry_out(catalogue, join, cli) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            output::complain(&error);
            ExitCode::from(USAGE)
        }
    }
}

/// Returns an error if the processor is older than what kernels are compiled for.
///
/// # Errors
///
/// What the processor lacks.
pub fn can_draw() -> anyhow::Result<()> {
    match numeric::fused::missing() {
        Some(missing) => bail!("this processor lacks {missing}, which kernels are compiled for"),
        None => Ok(()),
    }
}

fn carry_out(catalogue: &Catalogue, join: Option<Join>, cli: &Cli) -> anyhow::Result<u8> {
    let draws = !matches!(
        cli.command,
        Command::Report(_)
            | Command::List(_)
            | Command::Explain(_)
            | Command::Inspect(_)
            | Command::Judge(_)
            | Command::Completions(_)
    );
    if draws {
        can_draw()?;
    }
    // Only `run` can be shared by ranks.
    let link = ranks::join(matches!(cli.command, Command::Run(_)), join)?;
    let console = &cli.console;
    match &cli.command {
        Command::Run(arguments) => match link {
            Some(link) => ranks::main(link, arguments, catalogue, console),
            None => run::main(arguments, catalogue, console),
        },
        Command::Merge(arguments) => merge::merge(arguments, catalogue, console),
        Command::Check(arguments) => run::check(arguments, catalogue, console),
        Command::Predict(arguments) => predict::predict(arguments, catalogue, console),
        Command::Advise(arguments) => advise::main(arguments, catalogue, console),
        Command::Bench(arguments) => bench::main(arguments, catalogue, console),
        Command::Plan(arguments) => predict::plan(arguments, catalogue, console),
        Command::Render(arguments) => render::main(arguments, catalogue, console),
        Command::Report(arguments) => merge::report(arguments, console),
        Command::List(arguments) => catalogue::list(arguments, catalogue, console),
        Command::Explain(arguments) => catalogue::explain(arguments, catalogue, console),
        Command::Inspect(arguments) => inspect::main(arguments, console),
        Command::Judge(arguments) => judge::main(arguments, catalogue, console),
        Command::Export(arguments) => export::main(arguments, catalogue, console),
        Command::Completions(arguments) => help::main(arguments),
    }
}
