//! `trueflight judge`: the gate over the draws or images of another renderer.

mod claimed;
mod images;

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Args, ValueEnum};

use self::claimed::Claimed;
use super::help::Names;
use super::reports::Inconclusive;
use super::{Console, USAGE, numbers, output};
use crate::case::Catalogue;
use crate::json;
use crate::judge::{self, Column, DrawSource, Judgement, NumberFormat, Options, ROUNDING};
use crate::record::Verdict;
use crate::report::judge as report;
use crate::report::judge::junit::JUnitCase;
use media::files;

/// Largest number of draws that are read from a pipe, which may be endless.
const OF_A_PIPE: u64 = 1 << 26;

/// Arguments of `judge`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Files of independent draws (.csv or .txt, .npy, .f64 or .bin or .raw), or `-` for a pipe with
    /// --input. Several files share --alpha. With --images a stack (.npy), a pass in each (.npy, .pfm, .exr), or one
    /// folder of them
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Expected mean of the draws
    #[arg(long, value_name = "T", allow_hyphen_values = true, conflicts_with = "case")]
    #[arg(value_parser = numbers::number)]
    truth: Option<f64>,
    /// The variance of one draw, or of one average with --batch; without it the variance is not tested
    #[arg(long, value_name = "V", allow_hyphen_values = true, value_parser = numbers::number)]
    variance: Option<f64>,
    /// The kurtosis of one draw (3 for the normal distribution); without --variance, an upper bound of it. With
    /// --images an upper bound of that of all values of a tile about their truths
    #[arg(long, value_name = "K", allow_hyphen_values = true, value_parser = numbers::number)]
    kurtosis: Option<f64>,
    /// Range of all correct draws, as in 0,1 or 0,inf: a ground for a verdict without a variance
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, value_parser = range)]
    range: Option<[f64; 2]>,
    /// Take truth, variance, kurtosis, lookups and the distribution from theory: a case file or a built-in case
    #[arg(long, value_name = "CASE", value_parser = Names::Cases, hide_possible_values = true)]
    case: Option<String>,
    /// The estimator of the case: its label in tables, or its name in the catalogue
    #[arg(long, value_name = "NAME", requires = "case", value_parser = Names::Estimators, hide_possible_values = true)]
    estimator: Option<String>,
    /// The swept value, where the estimator is swept: any that it can have
    #[arg(long, value_name = "VALUE", requires = "case", allow_hyphen_values = true, value_parser = numbers::number)]
    swept: Option<f64>,
    /// Take the nearest value of the case's sweep in place of --swept
    #[arg(long, requires = "swept")]
    nearest: bool,
    /// The one channel to judge, if a draw has several [default: all, from a file that has them as columns]
    #[arg(long, value_name = "NAME", requires = "case")]
    channel: Option<String>,
    /// Take only the truth from the case, for an estimator of your own
    #[arg(long, requires = "case")]
    mean_only: bool,
    /// Seed of the case's pilot rays, where σ̂ is learned from them
    #[arg(long, default_value_t = 1, value_name = "N", value_parser = numbers::seed, allow_negative_numbers = true, requires = "case")]
    seed: u64,
    /// Judge averages of N consecutive draws: for stratified or quasi-random draws, or passes of a
    /// renderer. --variance and --kurtosis are then those of averages; --case then gives only the truth
    #[arg(long, default_value_t = 1, value_name = "N")]
    #[arg(value_parser = numbers::whole::<u64>(1..=1 << 40), allow_negative_numbers = true)]
    batch: u64,
    /// The bias that a pass excludes, relative to the truth (absolute for a truth of 0); a bias that is shown
    /// fails, even a smaller one, such as 1% or 0.01 [default: the smallest that the file's draws can show, at most 0.05;
    /// for a pipe 0.01]
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = numbers::percentage)]
    tolerance: Option<f64>,
    /// Tolerance of the variance, relative to it [default: the smallest that the draws can show, at most 0.2]
    #[arg(long, value_name = "E", allow_hyphen_values = true, value_parser = numbers::percentage)]
    variance_tolerance: Option<f64>,
    /// Probability that correct draws fail, all files together
    #[arg(long, default_value_t = 1e-3, value_name = "A", value_parser = numbers::alpha)]
    #[arg(allow_hyphen_values = true)]
    alpha: f64,
    /// Rounding error of a draw, relative to the truth (absolute for a truth of 0)
    #[arg(long, default_value_t = ROUNDING, value_name = "R", allow_hyphen_values = true, value_parser = numbers::number)]
    rounding: f64,
    /// Column of a table or of an array of shape (draws, values), by name or by place from 0 on
    #[arg(long, value_name = "COLUMN")]
    column: Option<String>,
    /// Column of a table with the number of lookups of each draw
    #[arg(long, value_name = "COLUMN")]
    lookups: Option<String>,
    /// Expected mean number of lookups
    #[arg(long, value_name = "M", requires = "lookups", conflicts_with = "case", value_parser = numbers::number)]
    #[arg(allow_hyphen_values = true)]
    expected_lookups: Option<f64>,
    /// The variance of the number of lookups of one draw, or of one average with --batch
    #[arg(long, value_name = "V", requires = "expected_lookups", allow_hyphen_values = true, value_parser = numbers::number)]
    lookups_variance: Option<f64>,
    /// Format of the draws [default: by the file's ending]
    #[arg(long, value_enum, value_name = "FORMAT")]
    input: Option<Input>,
    /// Stop reading as soon as everything is decided: later draws are ignored
    #[arg(long)]
    stop_early: bool,
    /// Largest number of draws to read [default: all of a file, 67108864 of a pipe]
    #[arg(long, value_name = "N", value_parser = numbers::draws, allow_hyphen_values = true)]
    draws: Option<u64>,
    /// Meaning of an inconclusive verdict for the exit code [default: exit code 3]
    #[arg(long, value_enum, value_name = "AS")]
    inconclusive: Option<Inconclusive>,
    /// Write a JUnit report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Form of the verdict on stdout
    #[arg(long, value_enum, default_value_t)]
    format: VerdictForm,
    #[command(flatten)]
    images: images::Arguments,
}

/// Returns the two ends of a range.
fn range(text: &str) -> Result<[f64; 2], String> {
    let wrong = || format!("`{text}` is no range; give LOW,HIGH as in 0,1 or 0,inf");
    let (low, high) = text.split_once(',').ok_or_else(wrong)?;
    let end = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
    let (low, high) = (end(low)?, end(high)?);
    if low < high { Ok([low, high]) } else { Err(wrong()) }
}

/// Format of draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Input {
    /// One number a line, or a column of a table
    Csv,
    /// NumPy's array file
    Npy,
    /// Little-endian float64, nothing else
    F64,
    /// Little-endian float32, nothing else
    F32,
}

/// Form of the verdict.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum VerdictForm {
    /// A block of lines for people
    #[default]
    Table,
    /// An object with every number
    Json,
}

/// Reads, judges, prints.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    if arguments.images.images {
        return images::main(arguments, console);
    }
    let claimed = arguments.claimed(catalogue)?;
    let options = Options {
        tolerance: arguments.tolerance,
        variance_tolerance: arguments.variance_tolerance,
        alpha: arguments.alpha / arguments.files.len() as f64,
        batch: arguments.batch,
        stop_early: arguments.stop_early,
        maximum: arguments.draws,
    };
    // Mistakes in the arguments are reported before anything is read.
    claimed.check(options)?;
    if let Some(tolerance) = options.tolerance.filter(|_| claimed.is_relative()) {
        numbers::check_share("--tolerance", tolerance)?;
    }
    if let Some(tolerance) = options.variance_tolerance {
        numbers::check_share("--variance-tolerance", tolerance)?;
    }
    if arguments.files.iter().filter(|file| is_pipe(file)).count() > 1 {
        anyhow::bail!("there is one pipe; give `-` once");
    }
    arguments.check_junit("draws")?;
    let (mut judged, mut errors) = (Vec::new(), Vec::new());
    for file in &arguments.files {
        match arguments.judge(file, &claimed, options) {
            Ok(finding) => judged.extend(finding),
            Err(error) => errors.push((name(file), error)),
        }
    }
    arguments.show(&judged, console)?;
    let tests: Vec<JUnitCase> = judged
        .iter()
        .map(|finding| JUnitCase::of_draws(&finding.name(), &finding.judgement))
        .collect();
    let unread: Vec<(String, String)> =
        errors.iter().map(|(name, error)| (name.clone(), format!("{error:#}"))).collect();
    arguments.write_junit(&tests, &unread)?;
    for (_, error) in &errors {
        output::complain(error);
    }
    if !errors.is_empty() {
        return Ok(USAGE);
    }
    Ok(arguments.code(worst(&judged.iter().map(|finding| &finding.judgement))))
}

/// Verdict on the draws of a file, or on one channel of them.
struct JudgedDraws {
    file: String,
    /// Name of the channel; empty if a draw has one channel only, or one was chosen.
    channel: String,
    judgement: Judgement,
}

impl JudgedDraws {
    /// Returns the name in a report.
    fn name(&self) -> String {
        let Self { file, channel, .. } = self;
        if channel.is_empty() { file.clone() } else { format!("{channel} of {file}") }
    }
}

fn is_pipe(file: &Path) -> bool {
    file == Path::new("-")
}

fn name(file: &Path) -> String {
    if is_pipe(file) { "stdin".to_owned() } else { file.display().to_string() }
}

/// Returns the worst of all verdicts.
fn worst<'a>(judged: &(impl Iterator<Item = &'a Judgement> + Clone)) -> Verdict {
    Verdict::worst(judged.clone().map(|judgement| judgement.verdict))
}

impl Arguments {
    /// Fails before the reading, not after it, if the JUnit report cannot be written.
    fn check_junit(&self, what: &str) -> anyhow::Result<()> {
        let Some(path) = &self.junit else { return Ok(()) };
        let wrong = || format!("cannot write {}; give another file with --junit", path.display());
        if self.files.iter().any(|file| file == path) {
            return Err(anyhow::anyhow!("it holds {what}").context(wrong()));
        }
        files::writable(path).with_context(wrong)
    }

    fn write_junit(&self, tests: &[JUnitCase], unread: &[(String, String)]) -> anyhow::Result<()> {
        let Some(path) = &self.junit else { return Ok(()) };
        let inconclusive = Inconclusive::in_junit(self.inconclusive);
        let text = report::junit::text(tests, unread, self.alpha, inconclusive);
        files::replace(path, text.as_bytes())
            .with_context(|| format!("cannot write {} (--junit)", path.display()))
    }

    /// Returns the exit code.
    fn code(&self, verdict: Verdict) -> u8 {
        let open = match self.inconclusive {
            None => 3,
            Some(Inconclusive::Fail) => 1,
            Some(Inconclusive::Pass) => 0,
        };
        match verdict {
            Verdict::Fail => 1,
            Verdict::Pass => 0,
            _ => open,
        }
    }

    /// Reads a file and judges it, channel by channel.
    fn judge(
        &self,
        file: &Path,
        claimed: &Claimed,
        options: Options,
    ) -> anyhow::Result<Vec<JudgedDraws>> {
        let format = self.input_format(file)?;
        let layout = claimed.layout(self.column.as_deref());
        if !file.is_file() && (is_pipe(file) || file.exists()) {
            // A pipe can be opened only once, and may be endless.
            let mut draws = if is_pipe(file) {
                DrawSource::from_reader_as(std::io::stdin(), "stdin", format, &layout)?
            } else {
                DrawSource::open_as(file, format, &layout)?
            };
            let length = draws.known_length();
            let maximum = options.maximum.or_else(|| length.is_none().then_some(OF_A_PIPE));
            let options = Options { maximum, ..options };
            return claimed.judge(&name(file), &mut draws, options, length);
        }
        let length =
            match (DrawSource::open_as(file, format.clone(), &layout)?.known_length(), &format) {
                // Tests of a distribution need a number of draws that is known before the first.
                (None, NumberFormat::Csv { .. })
                    if self.tolerance.is_none() || claimed.has_theory() =>
                {
                    Some(judge::count(file, format.clone(), &layout)?)
                }
                (length, _) => length,
            };
        let mut draws = DrawSource::open_as(file, format, &layout)?;
        claimed.judge(&name(file), &mut draws, options, length)
    }

    fn input_format(&self, file: &Path) -> anyhow::Result<NumberFormat> {
        let is_pipe = is_pipe(file);
        let plain = NumberFormat::Csv { column: None, lookups: None };
        let format = match self.input {
            Some(Input::Csv) => Some(plain),
            Some(Input::Npy) => Some(NumberFormat::Npy),
            Some(Input::F64) => Some(NumberFormat::Raw),
            Some(Input::F32) => Some(NumberFormat::RawSingle),
            None if is_pipe => None,
            None => NumberFormat::of_path(file),
        };
        let place = if is_pipe { "a pipe".to_owned() } else { file.display().to_string() };
        let format =
            format.with_context(|| match file.extension().and_then(|end| end.to_str()) {
                Some("toml") if !is_pipe => {
                    format!("{place} is a case; give it by --case, and then a file of draws")
                }
                _ => format!(
                    "the name of {place} does not tell its format; add --input csv, npy, f64 or f32"
                ),
            })?;
        let lookups = self.lookups.as_deref().and_then(|text| text.parse::<Column>().ok());
        match (format, lookups) {
            (NumberFormat::Csv { .. }, lookups) => Ok(NumberFormat::Csv { column: None, lookups }),
            (format, None) => Ok(format),
            _ => anyhow::bail!("only csv has a column of lookups; leave --lookups out"),
        }
    }

    /// Prints one verdict by itself, or several with a summary.
    fn show(&self, judged: &[JudgedDraws], console: &Console) -> anyhow::Result<()> {
        match self.format {
            VerdictForm::Table if console.quiet || judged.is_empty() => Ok(()),
            VerdictForm::Table => {
                let width = output::pen(console).width;
                let blocks: Vec<String> = judged
                    .iter()
                    .map(|finding| report::block(&finding.judgement, &finding.name(), width))
                    .collect();
                output::print(&(blocks.join("\n") + &self.together(judged)))
            }
            VerdictForm::Json if judged.is_empty() => Ok(()),
            VerdictForm::Json => output::print(&(self.json(judged)? + "\n")),
        }
    }

    /// Returns the channels of each file.
    fn by_file(judged: &[JudgedDraws]) -> Vec<&[JudgedDraws]> {
        judged
            .chunk_by(|a, b| a.file == b.file && !b.channel.is_empty() && a.channel != b.channel)
            .collect()
    }

    /// Returns the summary of several verdicts.
    fn together(&self, judged: &[JudgedDraws]) -> String {
        let verdicts = judged.iter().map(|finding| &finding.judgement);
        let files = Self::by_file(judged);
        let of = match (&files[..], self.files.len()) {
            ([[_]], 1) => return String::new(),
            ([channels], 1) => {
                let names: Vec<&str> = channels.iter().map(|finding| &*finding.channel).collect();
                format!(
                    "of {} channels of {} ({})",
                    names.len(),
                    channels[0].file,
                    names.join(", ")
                )
            }
            _ if judged.len() == files.len() => format!("of {} files", judged.len()),
            _ => format!("of {} channels of {} files", judged.len(), files.len()),
        };
        report::together(&verdicts, &of, worst(&verdicts), self.alpha)
    }

    /// Returns all verdicts as JSON.
    fn json(&self, judged: &[JudgedDraws]) -> serde_json::Result<String> {
        match (judged, self.files.len()) {
            ([one], 1) if one.channel.is_empty() => json::pretty(&one.judgement),
            _ => json::pretty(&self.object(judged)),
        }
    }

    fn object(&self, judged: &[JudgedDraws]) -> serde_json::Value {
        let of_file = |channels: &[JudgedDraws]| match channels {
            [one] if one.channel.is_empty() => serde_json::json!({ "judgement": one.judgement }),
            _ => {
                let verdict = worst(&channels.iter().map(|finding| &finding.judgement));
                let channels = channels.iter().map(|finding| {
                    serde_json::json!({ "channel": finding.channel, "judgement": finding.judgement })
                });
                let channels: Vec<serde_json::Value> = channels.collect();
                serde_json::json!({ "verdict": verdict, "channels": channels })
            }
        };
        let files = Self::by_file(judged);
        if let ([channels], 1) = (&files[..], self.files.len()) {
            return with(of_file(channels), "alpha", serde_json::json!(self.alpha));
        }
        let files: Vec<serde_json::Value> = files
            .into_iter()
            .map(|channels| with(of_file(channels), "file", serde_json::json!(channels[0].file)))
            .collect();
        let verdict = worst(&judged.iter().map(|finding| &finding.judgement));
        serde_json::json!({ "verdict": verdict, "alpha": self.alpha, "files": files })
    }
}

/// Returns the object with one more entry.
fn with(mut object: serde_json::Value, key: &str, value: serde_json::Value) -> serde_json::Value {
    object[key] = value;
    object
}
