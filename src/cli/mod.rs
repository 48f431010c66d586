//! Arguments, exit codes, progress, and the only prints. Floor 8.
//!
//! | exit code | meaning |
//! |---|---|
//! | 0 | all pass |
//! | 1 | at least one experiment fails |
//! | 2 | usage, a bad case file, input or output |
//! | 3 | nothing fails, but something is inconclusive; `--inconclusive fail` makes it 1, `pass` 0 |

mod baseline;
mod bench;
mod check;
mod completions;
mod drawing;
mod explain;
mod export;
mod judge;
mod list;
mod output;
mod plan;
mod predict;
mod render;
mod run;
mod selection;
mod self_test;
mod stress;
mod verdict;

use std::process::ExitCode;

use clap::{Args, Parser, Subcommand};

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

/// What concerns the console, whatever the command.
#[derive(Debug, Clone, Args)]
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
    /// The gate for a CI: as run, tuned to decide, with JUnit, Markdown and GitHub annotations
    Check(check::Arguments),
    /// Theory only, no draws: moments, costs, the best σ̂, what is refused
    Predict(predict::Arguments),
    /// Run time against error: ns per draw, time to an error, and how much faster than a plain loop
    Bench(bench::Arguments),
    /// What would run, what is refused, and why
    Plan(plan::Arguments),
    /// Pictures: estimators side by side at an equal number of lookups, with their errors
    Render(render::Arguments),
    /// Does the gate keep its promises, and does it catch known bugs?
    SelfTest(self_test::Arguments),
    /// Numerical stability: every quantity where it is hardest, against 32 digits
    Stress(stress::Arguments),
    /// The catalogue: media, estimators, problems, checks, cases and more
    List(list::Arguments),
    /// The manual page of a medium, an estimator, a check, …
    Explain(explain::Arguments),
    /// Judge the draws of another renderer, from a file or a pipe
    Judge(judge::Arguments),
    /// A case as a scene of Mitsuba 3 or pbrt-v4, with what its pixels must be
    Export(export::Arguments),
    /// Shell completions
    Completions(completions::Arguments),
}

/// Runs the command and answers its exit code.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let console = &cli.console;
    let done = match &cli.command {
        Command::Run(arguments) => run::main(arguments, console),
        Command::Check(arguments) => check::main(arguments, console),
        Command::Predict(arguments) => predict::main(arguments, console),
        Command::Bench(arguments) => bench::main(arguments, console),
        Command::Plan(arguments) => plan::main(arguments, console),
        Command::Render(arguments) => render::main(arguments, console),
        Command::SelfTest(arguments) => self_test::main(arguments, console),
        Command::Stress(arguments) => stress::main(arguments, console),
        Command::List(arguments) => list::main(arguments, console),
        Command::Explain(arguments) => explain::main(arguments, console),
        Command::Judge(arguments) => judge::main(arguments, console),
        Command::Export(arguments) => export::main(arguments, console),
        Command::Completions(arguments) => completions::main(arguments),
    };
    match done {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            output::complain(&error);
            ExitCode::from(USAGE)
        }
    }
}
