//! `trueflight check`: the gate in a CI.
//!
//! All reports are written before the process ends, whatever the verdict; that they can be is known
//! before the first draw.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::baseline::BaselineArguments;
use super::numbers::Budget;
use super::output::{Errors, Format};
use super::selection::{Looks, Selection};
use super::verdict::{self, Inconclusive};
use super::{Console, drawing, numbers, output};
use crate::case::Case;
use crate::case::Catalogue;
use crate::draw::store::Store;
use crate::plan::Options;
use crate::record::Record;
use crate::report::{Report, annotations, html, junit, markdown, record_json, summary_csv};
use media::files;

/// So many draws per experiment where neither an argument nor the case says.
const DRAWS: u64 = 400_000;

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    selection: Selection,
    /// Stop after a time (30s, 5m; results then depend on the machine) or a number of draws of all experiments
    /// together (1e8, at least one block of 16384)
    #[arg(long, value_name = "B", value_parser = numbers::budget, allow_negative_numbers = true)]
    budget: Option<Budget>,
    /// What an inconclusive experiment counts as [default: exit code 3]
    #[arg(long, value_enum, value_name = "AS")]
    inconclusive: Option<Inconclusive>,
    /// Write a JUnit report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write the whole record as JSON
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a summary in Markdown
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Folder for summary.csv, record.json and report.html [default: none is written]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    looks: Looks,
    #[command(flatten)]
    baseline: BaselineArguments,
    /// Print every row, not only those that do not pass
    #[arg(long, short)]
    verbose: bool,
}

/// Draws, judges, prints, writes.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let selection = &arguments.selection;
    let cases = selection.read(catalogue, console)?;
    let (seconds, budget) = match arguments.budget {
        Some(Budget::Seconds(seconds)) => (Some(seconds), None),
        Some(Budget::Draws(draws)) => (None, Some(draws)),
        None => (None, None),
    };
    let options = Options { seconds, budget, ..selection.options(DRAWS)? };
    let options = arguments.looks.of(options);
    arguments.writable(&cases)?;
    let baselines = arguments.baseline.open()?;
    let record = selection
        .with_plan(&cases, &options, console, |plan| {
            drawing::judged(plan, &Store::default(), console)
        })?
        .0;
    let (record, run) = baselines.compare(record, &cases);
    let mut errors = Errors::default();
    arguments.write(&record, &mut errors);
    errors.keep(output::print_run(&record, Format::Table, arguments.verbose, console));
    errors.extend(baselines.complaint(&record));
    let stored = errors.keep(baselines.store(&record, run.as_ref()));
    if !console.quiet {
        let page = arguments.out.as_deref().map_or(String::new(), output::report_in);
        errors.keep(output::print(&(stored + &page)));
    }
    if std::env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
        errors.keep(output::print(&annotations::text(&record)));
        summarise(&record);
    }
    Ok(verdict::close(&record, arguments.inconclusive, &errors))
}

impl Arguments {
    /// The files that are asked for, each with its option.
    fn files(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let files =
            [("--junit", &self.junit), ("--json", &self.json), ("--markdown", &self.markdown)];
        files.into_iter().filter_map(|(flag, path)| Some((flag, path.as_deref()?)))
    }

    /// Better to learn now than after the drawing that something cannot be written, or would be
    /// written over the cases or over another report.
    fn writable(&self, cases: &[Case]) -> anyhow::Result<()> {
        let mut taken: Vec<PathBuf> =
            cases.iter().filter_map(|case| case.path.canonicalize().ok()).collect();
        for (flag, path) in self.files() {
            let wrong =
                || format!("cannot write {}; give another file with {flag}", path.display());
            files::writable(path).with_context(wrong)?;
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            let folder = folder.unwrap_or(Path::new(".")).canonicalize().with_context(wrong)?;
            let place = path.canonicalize().ok();
            let place = place.unwrap_or_else(|| folder.join(path.file_name().unwrap_or_default()));
            let is_plain = !place.exists() || place.is_file();
            if is_plain && taken.contains(&place) {
                let why = anyhow::anyhow!("it is a case or another report");
                return Err(why.context(wrong()));
            }
            taken.push(place);
        }
        self.out.as_deref().map_or(Ok(()), output::writable)
    }

    /// Writes all that can be written.
    fn write(&self, record: &Record, errors: &mut Errors) {
        for (flag, path) in self.files() {
            let text = match flag {
                "--junit" => junit::text(record, Inconclusive::in_junit(self.inconclusive)),
                "--json" => record_json::text(record),
                _ => Ok(markdown::text(record)),
            };
            let written = text
                .map_err(anyhow::Error::from)
                .and_then(|text| Ok(files::replace(path, text.as_bytes())?))
                .with_context(|| format!("cannot write {} ({flag})", path.display()));
            errors.keep(written);
        }
        if let Some(out) = &self.out {
            let pages: [Report; 3] = [summary_csv::render, record_json::render, html::render];
            let files: Result<Vec<_>, _> = pages.iter().map(|render| render(record)).collect();
            errors.write(files.map(|files| files.concat()), out);
        }
    }
}

/// Adds the summary to the page of the job. Without it the verdict is still the verdict.
fn summarise(record: &Record) {
    let Some(path) = std::env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()) else {
        return;
    };
    let file = OpenOptions::new().append(true).create(true).open(&path);
    let text = markdown::text(record) + "\n";
    if let Err(error) = file.and_then(|mut file| file.write_all(text.as_bytes())) {
        let path = Path::new(&path).display();
        output::warn(&format!("cannot add the summary to {path}: {error}"));
    }
}
