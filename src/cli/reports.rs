//! Options on reports, for all commands that judge experiments: their places, and the printed rows; and the exit codes
//! of verdicts.
//!
//! All reports are written before the process ends, whatever the verdict. Before the first draw it is checked that they
//! can be written.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Args, ValueEnum};

use super::USAGE;
use super::output::{self, Errors, RowFormat};
use crate::case::Case;
use crate::record::baseline::Comparison;
use crate::record::{Record, Verdict};
use crate::report::run::{
    self, Report, annotations, html, junit, markdown, record_json, summary_csv,
};
use media::files;

/// Reports of a run.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Reports")]
pub struct Reports {
    /// Form of the rows on stdout; csv and json have all of them
    #[arg(long, value_enum, default_value_t)]
    pub format: RowFormat,
    /// Meaning of an inconclusive experiment for the exit code [default: exit code 3]
    #[arg(long, value_enum, value_name = "AS")]
    pub inconclusive: Option<Inconclusive>,
    /// Write a JUnit report
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write a summary in Markdown
    #[arg(long, value_name = "FILE")]
    markdown: Option<PathBuf>,
    /// Folder for report.html, summary.csv and record.json; `run` and `merge` also write checks.csv, the cases' CSV files
    /// and the plots [default: results; check: none]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write the whole record as JSON
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Print every row, not only those that do not pass
    #[arg(long, short)]
    pub verbose: bool,
}

impl Reports {
    /// Returns whether the rows are printed for people.
    pub fn is_table(&self) -> bool {
        self.format == RowFormat::Table
    }

    /// Returns the files that are asked for, each with its option.
    fn files(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let files =
            [("--junit", &self.junit), ("--record", &self.record), ("--markdown", &self.markdown)];
        files.into_iter().filter_map(|(flag, path)| Some((flag, path.as_deref()?)))
    }

    /// Fails if a report cannot be written, or would overwrite a case or another report.
    pub fn writable(&self, out: Option<&Path>, cases: &[Case]) -> anyhow::Result<()> {
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
        out.map_or(Ok(()), output::writable)
    }

    /// Writes all that can be written; returns the number of files in the folder.
    pub fn write(
        &self,
        record: &Record,
        out: Option<&Path>,
        is_whole: bool,
        errors: &mut Errors,
    ) -> Option<usize> {
        for (flag, path) in self.files() {
            let text = match flag {
                "--junit" => Ok(junit::text(record, Inconclusive::in_junit(self.inconclusive))),
                "--record" => record_json::text(record),
                _ => Ok(markdown::text(record)),
            };
            let written = text
                .map_err(anyhow::Error::from)
                .and_then(|text| Ok(files::replace(path, text.as_bytes())?))
                .with_context(|| format!("cannot write {} ({flag})", path.display()));
            errors.keep(written);
        }
        let brief: [Report; 3] = [summary_csv::render, record_json::render, html::render];
        let files = || -> Result<Vec<_>, _> {
            if is_whole {
                return run::render(record);
            }
            let files: Result<Vec<_>, _> = brief.iter().map(|render| render(record)).collect();
            files.map(|files| files.concat())
        };
        out.and_then(|out| errors.write(files(), out))
    }

    /// Annotates the job of GitHub Actions, and adds the summary to its page.
    pub fn annotate(&self, record: &Record, errors: &mut Errors) {
        if !self.is_table() || std::env::var_os("GITHUB_ACTIONS").is_none_or(|it| it != "true") {
            return;
        }
        errors.keep(output::print(&annotations::text(record)));
        let path = std::env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty());
        let Some(path) = path.map(PathBuf::from) else { return };
        let file = OpenOptions::new().append(true).create(true).open(&path);
        let text = markdown::text(record) + "\n";
        // A failed summary does not change the verdict.
        if let Err(error) = file.and_then(|mut file| file.write_all(text.as_bytes())) {
            output::warn(&format!("cannot add the summary to {}: {error}", path.display()));
        }
    }
}

/// Nothing fails, but something is not decided.
pub const UNDECIDED: u8 = 3;

/// Effect of an inconclusive experiment on the exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Inconclusive {
    /// It counts as failing: exit code 1
    Fail,
    /// It counts as passing: exit code 0
    Pass,
}

impl Inconclusive {
    /// Returns the result of an inconclusive experiment in a JUnit report.
    pub fn in_junit(wish: Option<Self>) -> junit::Inconclusive {
        match wish {
            None => junit::Inconclusive::Error,
            Some(Self::Fail) => junit::Inconclusive::Failure,
            Some(Self::Pass) => junit::Inconclusive::Skipped,
        }
    }
}

/// Returns the exit code at the end of a command, given the errors beside the verdicts.
pub fn close(record: &Record, inconclusive: Option<Inconclusive>, errors: &Errors) -> u8 {
    let errors_first = errors.close(0);
    let code = exit_code(record, inconclusive);
    if errors_first == 0 { code } else { errors_first }
}

/// Returns the exit code. Fail, or worse than a stored run, precedes refused cases, then inconclusive, then pass.
fn exit_code(record: &Record, inconclusive: Option<Inconclusive>) -> u8 {
    let any = |verdict| record.results.rows().any(|row| row.verdict == Some(verdict));
    let is_worse = record.comparison.as_ref().is_some_and(Comparison::fails);
    if is_worse || any(Verdict::Fail) {
        return 1;
    }
    let refused = record
        .results
        .cases
        .iter()
        .find(|case| case.rows().all(|row| row.verdict == Some(Verdict::Refused)));
    if let Some(case) = refused {
        output::complain(&anyhow::anyhow!(
            "every experiment of {} is refused, so nothing was tested; \
             `trueflight plan` says why",
            case.name
        ));
        return USAGE;
    }
    match inconclusive {
        _ if !any(Verdict::Inconclusive) => 0,
        None => UNDECIDED,
        Some(Inconclusive::Fail) => 1,
        Some(Inconclusive::Pass) => 0,
    }
}
