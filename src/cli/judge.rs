//! `trueflight judge`: the gate over the draws of another renderer.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Args, ValueEnum};
use trueflight::harness::case::Case;
use trueflight::harness::foreign::claim::{Choice, Claim, ROUNDING};
use trueflight::harness::foreign::judge::{Trial, Wanted};
use trueflight::harness::foreign::judgement::Judgement;
use trueflight::harness::foreign::{self, Column, Draws, Format};
use trueflight::harness::record::Verdict;
use trueflight::harness::source::CaseError;
use trueflight::report::console::judgement;

use super::{Console, output, selection};

/// Arguments of `judge`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// File of draws (.csv or .txt, .npy, .f64 or .bin or .raw), or `-` for a pipe with --input.
    /// Reading stops at the decision: a writer at the other end of a pipe may see it close early
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// What the mean should be
    #[arg(long, value_name = "T", allow_hyphen_values = true, conflicts_with = "case")]
    #[arg(required_unless_present = "case")]
    truth: Option<f64>,
    /// The variance of one draw; without it, it is estimated and not tested
    #[arg(long, value_name = "V", allow_hyphen_values = true, conflicts_with = "case")]
    #[arg(group = "claimed")]
    variance: Option<f64>,
    /// The kurtosis of one draw (3 for the normal law); without it, it is estimated
    #[arg(long, value_name = "K", allow_hyphen_values = true, conflicts_with = "case")]
    kurtosis: Option<f64>,
    /// Take truth, variance and kurtosis from theory: a case file or a built-in case
    #[arg(long, value_name = "CASE", requires = "estimator", group = "claimed")]
    case: Option<String>,
    /// The estimator of the case: its label in tables, or its name in the catalogue
    #[arg(long, value_name = "NAME", requires = "case")]
    estimator: Option<String>,
    /// The swept value, where the estimator is swept
    #[arg(long, value_name = "VALUE", requires = "case", allow_hyphen_values = true)]
    swept: Option<f64>,
    /// The channel of a draw, where it has several
    #[arg(long, value_name = "NAME", requires = "case")]
    channel: Option<String>,
    /// Seed of the case's pilot rays, where σ̂ is learned from them
    #[arg(long, default_value_t = 1, value_name = "N", requires = "case")]
    seed: u64,
    /// The bias that a pass excludes, relative to the truth (absolute for a truth of 0) [default:
    /// what the file's draws can see, at most 0.05; for a pipe 0.01]
    #[arg(long, value_name = "E", allow_hyphen_values = true)]
    tolerance: Option<f64>,
    /// The same for the variance, relative to it [default: what the draws can see, at most 0.2]
    #[arg(long, value_name = "E", allow_hyphen_values = true, requires = "claimed")]
    variance_tolerance: Option<f64>,
    /// Chance that correct draws fail
    #[arg(long, default_value_t = 1e-3, value_name = "A", value_parser = selection::alpha)]
    #[arg(allow_hyphen_values = true)]
    alpha: f64,
    /// What rounding may add to a draw, relative to the truth (absolute for a truth of 0)
    #[arg(long, default_value_t = ROUNDING, value_name = "R", allow_hyphen_values = true)]
    rounding: f64,
    /// Column of a table, by name or by place from 0 on
    #[arg(long, value_name = "COLUMN")]
    column: Option<String>,
    /// How the draws are written [default: by the file's ending]
    #[arg(long, value_enum, value_name = "FORMAT")]
    input: Option<Input>,
    /// Read to the end, also after the decision
    #[arg(long)]
    all: bool,
    /// How the verdict is printed
    #[arg(long, value_enum, default_value_t)]
    format: Shown,
}

/// How draws are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Input {
    /// One number a line, or a column of a table
    Csv,
    /// NumPy's array file
    Npy,
    /// Little-endian float64, nothing else
    F64,
}

/// How the verdict is printed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum Shown {
    /// A block of lines for people
    #[default]
    Table,
    /// An object with every number
    Json,
}

/// Reads, judges, prints.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let is_pipe = arguments.file == Path::new("-");
    let format = arguments.input_format(is_pipe)?;
    let claim = arguments.claim()?;
    let wanted = Wanted {
        tolerance: arguments.tolerance,
        variance_tolerance: arguments.variance_tolerance,
        alpha: arguments.alpha,
        all: arguments.all,
    };
    // What is wrong with the question is said before anything is read.
    Trial::new(claim, wanted, None)?;
    let (name, mut draws, length) = if is_pipe {
        let draws = Draws::from_reader(std::io::stdin(), "stdin", format)?;
        let length = draws.known_length();
        ("stdin".to_owned(), draws, length)
    } else {
        let path = &arguments.file;
        let length = match (Draws::open(path, format.clone())?.known_length(), &format) {
            (None, Format::Csv { .. }) if arguments.tolerance.is_none() && path.is_file() => {
                Some(foreign::count(path, format.clone())?)
            }
            (length, _) => length,
        };
        (path.display().to_string(), Draws::open(path, format)?, length)
    };
    let judgement = Trial::new(claim, wanted, length)?.judge(&mut draws)?;
    show(&judgement, &name, arguments.format, console)?;
    Ok(match judgement.verdict {
        Verdict::Fail => 1,
        Verdict::Pass => 0,
        _ => 3,
    })
}

impl Arguments {
    fn input_format(&self, is_pipe: bool) -> anyhow::Result<Format> {
        let format = match self.input {
            Some(Input::Csv) => Some(Format::Csv { column: None }),
            Some(Input::Npy) => Some(Format::Npy),
            Some(Input::F64) => Some(Format::Raw),
            None if is_pipe => None,
            None => Format::of_path(&self.file),
        };
        let file = self.file.display();
        let place = if is_pipe { "a pipe".to_owned() } else { format!("{file}") };
        let format = format.with_context(|| {
            format!("the name of {place} does not tell its format; add --input csv, npy or f64")
        })?;
        let column = self.column.as_deref().and_then(|text| text.parse::<Column>().ok());
        match (format, column) {
            (Format::Csv { .. }, column) => Ok(Format::Csv { column }),
            (format, None) => Ok(format),
            _ => anyhow::bail!("only csv has columns; leave --column out"),
        }
    }

    fn claim(&self) -> anyhow::Result<Claim> {
        let (Some(name), Some(estimator)) = (&self.case, &self.estimator) else {
            let truth = self.truth.unwrap_or(f64::NAN);
            return Ok(Claim::new(truth, self.variance, self.kurtosis, self.rounding)?);
        };
        let cases = selection::read_case(name).map_err(|errors| {
            let shown = errors.iter().map(|error| match error {
                CaseError::Faulty { .. } => format!("{error}\n\n{}", error.render(false)),
                other => other.to_string(),
            });
            anyhow::anyhow!("--case: {}", shown.collect::<Vec<_>>().join("\n\n"))
        })?;
        let [case] = &cases[..] else {
            let names: Vec<&str> = cases.iter().map(|case: &Case| case.name.as_str()).collect();
            anyhow::bail!("--case {name} is several cases; choose one of: {}", names.join(", "));
        };
        let channel = self.channel.as_deref();
        let choice = Choice { estimator, swept: self.swept, channel, seed: self.seed };
        Ok(Claim::of_case(case, &choice, self.rounding)?)
    }
}

fn show(judgement: &Judgement, name: &str, form: Shown, console: &Console) -> anyhow::Result<()> {
    match form {
        Shown::Table if console.quiet => Ok(()),
        Shown::Table => {
            output::print(&judgement::block(judgement, name, output::pen(console).width))
        }
        Shown::Json => output::print(&(serde_json::to_string_pretty(judgement)? + "\n")),
    }
}
