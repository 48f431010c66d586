//! The command line: arguments, exit codes, progress, and the only prints.
//!
//! A program with media and estimators of its own has all commands by
//! `fn main() -> ExitCode { trueflight::cli::main(&catalogue) }`. Where `mpirun` begins it, `bindings/mpi` has
//! the way to join the others for [`main_among`].
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | all pass |
//! | 1 | at least one experiment fails |
//! | 2 | usage, a bad case file, input or output |
//! | 3 | nothing fails, but something is inconclusive; `--inconclusive fail` makes it 1, `pass` 0 |

mod baseline;
mod bench;
mod catalogue;
mod export;
mod help;
mod inspect;
mod journal;
mod judge;
pub mod lab;
mod merge;
mod numbers;
mod output;
mod predict;
pub mod ranks;
mod render;
mod reports;
mod run;
mod selection;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{Args, FromArgMatches, Parser, Subcommand};

use self::ranks::Join;
use crate::case::Catalogue;

/// Everything that went wrong before or beside the verdicts.
pub const USAGE: u8 = 2;

/// Prove that a light-transport estimator is fair: compare its mean, variance, cost and law with
/// exact theory over millions of draws.
#[derive(Debug, Parser)]
#[command(name = "trueflight", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    console: Console,
}

/// Options on the console, whatever the command.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Console")]
pub struct Console {
    /// When to use colours; `NO_COLOR` is honoured by `auto`
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    color: output::When,
    /// No progress and no table, only errors
    #[arg(long, short, global = true)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Draw, judge, and write tables and plots: the main job
    Run(run::Arguments),
    /// Judge a run that many machines drew: the parts of `run --shard`
    Merge(merge::Merge),
    /// The gate for a CI: as run, tuned to decide, with JUnit, Markdown and GitHub annotations
    Check(run::Asked),
    /// Theory only, no draws: moments, costs, the best σ̂, what is refused
    Predict(predict::Predict),
    /// Run time against error: ns per draw, time to an error, and how much faster than a plain loop
    Bench(bench::Arguments),
    /// What would run, what is refused, and why
    Plan(predict::Plan),
    /// Pictures: estimators side by side at an equal number of lookups, with their errors
    Render(render::Arguments),
    /// The page report.html of a stored run, for a browser
    Report(merge::Report),
    /// Does the gate keep its promises, and does it catch known bugs?
    SelfTest(lab::SelfTestArguments),
    /// Numerical stability: every quantity where it is hardest, against 32 digits
    Stress(lab::Stress),
    /// The catalogue: media, estimators, problems, checks, cases and more
    List(catalogue::List),
    /// The manual page of a medium, an estimator, a check, …
    Explain(catalogue::Explain),
    /// List the grids, images and draws in files, with their sizes, boxes and ranges
    Inspect(inspect::Arguments),
    /// Judge the draws of another renderer, from a file or a pipe
    Judge(Box<judge::Arguments>),
    /// A case as a scene of Mitsuba 3 or pbrt-v4, with what its pixels must be
    Export(export::Arguments),
    /// Shell completions
    Completions(help::Arguments),
}

/// Runs the command that the program's arguments ask for, with this catalogue, and answers its exit code.
pub fn main(catalogue: &Catalogue) -> ExitCode {
    run_with(catalogue, None, &parsed())
}

/// The same with these arguments, the first of which is the program's name.
///
/// # Errors
///
/// What is wrong with the arguments, in the words of the command line.
pub fn run_as<T: Into<OsString> + Clone>(
    catalogue: &Catalogue,
    arguments: impl IntoIterator<Item = T>,
) -> Result<ExitCode, String> {
    let matches = help::command().try_get_matches_from(arguments);
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = cli.map_err(|error| error.to_string())?;
    Ok(run_with(catalogue, None, &cli))
}

/// [`main`] for a program that `mpirun` may have begun among others, and that knows how to join them.
pub fn main_among(catalogue: &Catalogue, join: Join) -> ExitCode {
    run_with(catalogue, Some(join), &parsed())
}

/// Parses the program's arguments; a mistake ends the process.
fn parsed() -> Cli {
    let cli = Cli::from_arg_matches(&help::command().get_matches());
    cli.unwrap_or_else(|error| error.exit())
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

fn carry_out(catalogue: &Catalogue, join: Option<Join>, cli: &Cli) -> anyhow::Result<u8> {
    // Every command is refused among others, but for `run`.
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
        Command::Bench(arguments) => bench::main(arguments, catalogue, console),
        Command::Plan(arguments) => predict::plan(arguments, catalogue, console),
        Command::Render(arguments) => render::main(arguments, catalogue, console),
        Command::Report(arguments) => merge::report(arguments, console),
        Command::SelfTest(arguments) => lab::self_test(arguments, console),
        Command::Stress(arguments) => lab::stress(arguments, console),
        Command::List(arguments) => catalogue::list(arguments, catalogue, console),
        Command::Explain(arguments) => catalogue::explain(arguments, catalogue, console),
        Command::Inspect(arguments) => inspect::main(arguments, console),
        Command::Judge(arguments) => judge::main(arguments, catalogue, console),
        Command::Export(arguments) => export::main(arguments, catalogue, console),
        Command::Completions(arguments) => help::main(arguments),
    }
}
