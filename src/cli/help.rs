//! Help pages and completions: examples, exit codes, the manual, and names of cases and estimators.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, TypedValueParser, UnknownArgumentValueParser};
use clap::error::{ContextKind, ContextValue};
use clap::{Arg, Args, Command, CommandFactory};
use clap_complete::Shell;

use super::catalogue::pages;
use super::{Cli, output};
use crate::case::{Catalogue, suite};

/// Exit codes of commands that judge.
const VERDICT: &str = "  0  everything passes
  1  an experiment fails, or is worse than the baseline
  2  wrong usage, a mistake in a case file, or a failure to read or write
  3  nothing fails, but something is inconclusive (--inconclusive changes it)";

/// Exit codes of `judge`.
const JUDGED: &str = "  0  the draws pass
  1  the draws fail
  2  wrong usage, a mistake in a file, or a failure to read or write
  3  the draws do not decide it (--inconclusive changes the exit code)";

/// Exit codes of other commands.
pub const DONE: &str = "  0  done
  2  wrong usage, a mistake in a file, or a failure to read or write";

/// End of a help page: command, examples, exit codes, page of the manual.
pub type HelpEnd = (&'static str, &'static [&'static str], &'static str, &'static str);

/// Ends of all help pages.
const PAGES: [HelpEnd; 15] = [
    (
        "run",
        &[
            "trueflight run",
            "trueflight run case.toml --draws 1e6 --filter *:ratio",
            "trueflight run cases --draws 1e8 --shard 3/16 --out part-3",
            "trueflight run --resume results",
        ],
        VERDICT,
        "docs/commands.md, docs/verdicts.md, docs/long-runs.md",
    ),
    (
        "merge",
        &["trueflight merge part-1 part-2 part-3 --out results"],
        VERDICT,
        "docs/long-runs.md",
    ),
    (
        "check",
        &[
            "trueflight check cases",
            "trueflight check cases --budget 5m --junit report.xml --out results",
            "trueflight check cases --baseline main",
        ],
        VERDICT,
        "docs/ci.md, docs/baselines.md",
    ),
    (
        "predict",
        &[
            "trueflight predict transmittance/eq21-overview",
            "trueflight predict case.toml --optimum",
        ],
        DONE,
        "docs/variance.md",
    ),
    (
        "advise",
        &[
            "trueflight advise transmittance/eq21-overview",
            "trueflight advise case.toml --error 0.1% --cost lookup=2us",
            "trueflight advise cloud.toml --rays 64 --budget 1e6",
        ],
        DONE,
        "docs/advise.md",
    ),
    (
        "bench",
        &["trueflight bench case.toml", "trueflight bench case.toml --baseline main"],
        "  0  done
  1  something is slower than the baseline
  2  wrong usage, a mistake in a case file, or a failure to read or write",
        "docs/speed.md",
    ),
    (
        "plan",
        &["trueflight plan cases", "trueflight plan case.toml --format csv"],
        DONE,
        "docs/commands.md",
    ),
    (
        "render",
        &["trueflight render", "trueflight render picture.toml --out results"],
        DONE,
        "docs/pictures.md",
    ),
    ("report", &["trueflight report results"], DONE, "docs/reports.md"),
    (
        "list",
        &["trueflight list", "trueflight list estimators --format json"],
        DONE,
        "docs/commands.md",
    ),
    (
        "explain",
        &["trueflight explain ratio", "trueflight explain media"],
        DONE,
        "docs/commands.md",
    ),
    ("inspect", &["trueflight inspect smoke.vdb image.exr"], DONE, "docs/media.md"),
    (
        "judge",
        &[
            "trueflight judge draws.npy --truth 0.25 --variance 0.1",
            "trueflight judge draws.csv --case transmittance/eq21-overview --estimator ratio",
            "trueflight judge passes.npy --images --truth-image truth.exr",
        ],
        JUDGED,
        "docs/judge.md, docs/renderers.md",
    ),
    (
        "export",
        &["trueflight export case.toml --to mitsuba --out scene"],
        DONE,
        "docs/renderers.md",
    ),
    (
        "completions",
        &["trueflight completions bash > ~/.local/share/bash-completion/completions/trueflight"],
        DONE,
        "docs/commands.md",
    ),
];

/// Returns the command line with the ends of its help pages; options are in alphabetical order.
pub fn command() -> Command {
    let mut command = with_ends(Cli::command(), &PAGES);
    for name in ["run", "check", "merge"] {
        let renamed = [("time", "--budget"), ("json", "--record")].map(|(old, new)| {
            let suggest = UnknownArgumentValueParser::suggest_arg(new);
            Arg::new(old).long(old).hide(true).value_parser(suggest)
        });
        command = command.mut_subcommand(name, |command| command.args(renamed));
    }
    command.after_help(
        "Manual: docs/index.md; `trueflight COMMAND --help` shows examples and exit codes",
    )
}

/// Adds the ends of the help pages of subcommands, and puts their options in alphabetical order.
pub fn with_ends(command: Command, pages: &[HelpEnd]) -> Command {
    pages.iter().fold(command, |command, (name, examples, codes, manual)| {
        let examples = examples.join("\n  ");
        let end = format!("Examples:\n  {examples}\n\nExit codes:\n{codes}\n\nManual: {manual}");
        command.mut_subcommand(name, |command| {
            command.after_help(end).mut_args(|argument| argument.display_order(0))
        })
    })
}

/// Adds to the error about a command of the lab where that command is.
pub fn with_place(mut error: clap::Error) -> clap::Error {
    let name = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(name)) => name.as_str(),
        _ => "",
    };
    if ["self-test", "stress"].contains(&name) {
        let place = format!("`cargo run --release -p trueflight-lab -- {name}` in a checkout");
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![place.into()]));
    }
    error
}

/// Text argument that shells complete by names of the catalogue; any other text is valid, too.
#[derive(Debug, Clone, Copy)]
pub enum Names {
    /// Built-in cases.
    Cases,
    /// Estimators.
    Estimators,
    /// Patterns on cases and estimators.
    Experiments,
    /// Pages of the catalogue.
    Pages,
}

impl Names {
    fn names(self) -> Vec<String> {
        let cases = || suite::suite().into_iter().map(|source| source.name);
        let pages = || pages(&Catalogue::builtin()).into_iter();
        let estimators = || {
            let estimators = pages().filter(|(part, _)| part.starts_with("estimators"));
            estimators.map(|(_, page)| page.name())
        };
        let mut names: Vec<String> = match self {
            Self::Cases => cases().collect(),
            Self::Estimators => estimators().collect(),
            Self::Experiments => cases().chain(estimators()).collect(),
            Self::Pages => pages().map(|(_, page)| page.name()).chain(cases()).collect(),
        };
        names.sort();
        names.dedup();
        names
    }
}

impl TypedValueParser for Names {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, clap::Error> {
        clap::builder::StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names().into_iter().map(PossibleValue::new)))
    }
}

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// The shell
    shell: Shell,
}

/// Prints the completions.
pub fn main(arguments: &Arguments) -> anyhow::Result<u8> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut command(), output::program(), &mut script);
    let mut script = String::from_utf8(script)?;
    if arguments.shell == Shell::Zsh {
        // Names alone would hide case files in zsh; bash and fish fall back to files.
        let names = Names::Cases.names().join(" ");
        script = script.replace(&format!("({names})"), &format!("{{compadd -- {names}; _files}}"));
    }
    output::print(&script)?;
    Ok(0)
}
