//! Command line of `trueflight-lab`.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | every bound holds, and every known bug is caught |
//! | 1 | a bound is broken, or a known bug is not caught |
//! | 2 | wrong usage, or a failure to write |

mod known_bugs;
mod run;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use trueflight::cli::help::{DONE, HelpEnd, with_ends};
use trueflight::cli::{Console, USAGE, can_draw, output};

/// Test Trueflight itself: its gate, its known bugs, and its numbers under stress.
#[derive(Debug, Parser)]
#[command(name = "trueflight-lab", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Task,
    #[command(flatten)]
    console: Console,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Test the gate: its rates of errors, and whether it catches known bugs
    SelfTest(run::SelfTestArguments),
    /// Compare all numerical routines with 32-digit references at extreme parameters
    Stress(run::Stress),
    /// List the known bugs
    List(known_bugs::List),
    /// Print what a known bug does, and which check catches it
    Explain(known_bugs::Explain),
}

/// Exit codes of tests.
const TEST: &str = "  0  every bound holds, and every known bug is caught
  1  a bound is broken, or a known bug is not caught
  2  wrong usage, or a failure to write";

/// Ends of the help pages.
const PAGES: [HelpEnd; 4] = [
    (
        "self-test",
        &["trueflight-lab self-test", "trueflight-lab self-test --long"],
        TEST,
        "docs/self-test.md",
    ),
    ("stress", &["trueflight-lab stress --quick"], TEST, "docs/stress.md"),
    ("list", &["trueflight-lab list --format json"], DONE, "docs/self-test.md"),
    ("explain", &["trueflight-lab explain control-twice"], DONE, "docs/self-test.md"),
];

fn command() -> Command {
    with_ends(Cli::command(), &PAGES)
}

/// Runs the command of the program's arguments, and returns its exit code.
pub fn main() -> ExitCode {
    let cli = Cli::from_arg_matches(&command().get_matches());
    carry_out(&cli.unwrap_or_else(|error| error.exit()))
}

/// Runs the command of these arguments, the first of which is the program's name.
///
/// # Errors
///
/// A mistake in the arguments, as the command line reports it.
pub fn run_as<T: Into<OsString> + Clone>(
    arguments: impl IntoIterator<Item = T>,
) -> Result<ExitCode, String> {
    let matches = command().try_get_matches_from(arguments);
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    Ok(carry_out(&cli.map_err(|error| error.to_string())?))
}

fn carry_out(cli: &Cli) -> ExitCode {
    let console = &cli.console;
    let done = match &cli.command {
        Task::SelfTest(arguments) => can_draw().and_then(|()| run::self_test(arguments, console)),
        Task::Stress(arguments) => can_draw().and_then(|()| run::stress(arguments, console)),
        Task::List(arguments) => known_bugs::list(arguments, console),
        Task::Explain(arguments) => known_bugs::explain(arguments, console),
    };
    done.map_or_else(
        |error| {
            output::complain(&error);
            ExitCode::from(USAGE)
        },
        ExitCode::from,
    )
}
