//! Output on the console: results on stdout, the rest on stderr.

use std::io::{ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::Context;
use clap::ValueEnum;

use super::progress::Bar;
use super::{Console, USAGE};
use crate::case::CaseError;
use crate::record::Record;
use crate::record::repeat::quoted;
use crate::report::layout::Pen;
use crate::report::run::console::{self, TableView};
use crate::report::run::summary_csv;
use crate::report::{self, Artifact, ReportError};
use numeric::digits::counted;

/// Condition for colours.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum When {
    /// On a terminal, unless `NO_COLOR` is set
    #[default]
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

impl When {
    /// Returns whether a stream gets colours.
    pub fn colours(self, terminal: bool) -> bool {
        let wished = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
        match self {
            Self::Auto => terminal && wished,
            Self::Always => true,
            Self::Never => false,
        }
    }
}

/// Form of rows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum RowFormat {
    /// A table for people
    #[default]
    Table,
    /// The columns of the CSV file of all rows
    Csv,
    /// An array of objects with the same columns
    Json,
}

/// Prints a record's rows to stdout.
pub fn print_record(
    record: &Record,
    view: TableView,
    format: RowFormat,
    options: &Console,
) -> anyhow::Result<()> {
    let text = match format {
        RowFormat::Table if options.quiet => return Ok(()),
        RowFormat::Table => console::table(record, view, pen(options)),
        RowFormat::Csv => summary_csv::csv(record)?,
        RowFormat::Json => summary_csv::json(record)?,
    };
    print(&text)
}

/// Prints the results of a run to stdout: rows that do not pass and a line for each case, or every row.
pub fn print_run(
    record: &Record,
    format: RowFormat,
    is_verbose: bool,
    options: &Console,
) -> anyhow::Result<()> {
    if format != RowFormat::Table || is_verbose || options.quiet {
        return print_record(record, TableView::Run, format, options);
    }
    print(&console::brief(record, pen(options)))
}

/// Returns the last line of a command that wrote a page: the page's place.
pub fn report_in(out: &Path) -> String {
    format!("report: {}\n", out.join("report.html").display())
}

/// Writes to stdout. A reader that closes early (`| head`) is not an error.
pub fn print(text: &str) -> anyhow::Result<()> {
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.context("cannot write to stdout"),
    }
}

/// Writes an error to stderr.
pub fn complain(error: &anyhow::Error) {
    // Without stderr there is no place to report to.
    let _ = writeln!(std::io::stderr(), "error: {error:#}");
}

/// Errors beside the verdicts; all other output is still written.
#[derive(Debug, Default)]
pub struct Errors(Vec<anyhow::Error>);

impl Errors {
    /// Keeps an error, and returns a default value in its place.
    pub fn keep<T: Default, E: Into<anyhow::Error>>(&mut self, result: Result<T, E>) -> T {
        result.unwrap_or_else(|error| {
            self.extend([error]);
            T::default()
        })
    }

    /// Keeps errors.
    pub fn extend<E: Into<anyhow::Error>>(&mut self, errors: impl IntoIterator<Item = E>) {
        self.0.extend(errors.into_iter().map(Into::into));
    }

    /// Returns whether there is no error so far.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Writes files below a folder. Returns the number of written files; `None` if they could not be rendered.
    pub fn write(
        &mut self,
        artifacts: Result<Vec<Artifact>, ReportError>,
        out: &Path,
    ) -> Option<usize> {
        let artifacts = self.keep(artifacts.map(Some))?;
        let failed = report::write(&artifacts, out);
        let written = artifacts.len() - failed.len();
        self.extend(failed);
        Some(written)
    }

    /// Prints all errors on stderr; returns the exit code.
    pub fn close(&self, code: u8) -> u8 {
        self.0.iter().for_each(complain);
        if self.0.is_empty() { code } else { USAGE }
    }
}

/// Writes files below a folder; returns the first error.
pub fn write(artifacts: &[Artifact], out: &Path) -> anyhow::Result<()> {
    report::write(artifacts, out).into_iter().next().map_or(Ok(()), |error| Err(error.into()))
}

/// Shows mistakes in files in place. Returns the error with the number of mistakes and files.
pub fn mistakes(
    errors: &[CaseError],
    console: &Console,
    [kind, effect]: [&str; 2],
) -> anyhow::Error {
    let colour = console.color.colours(std::io::stderr().is_terminal());
    let shown: Vec<String> = errors.iter().map(|error| error.render(colour)).collect();
    // Without stderr there is no place to report to.
    let _ = writeln!(std::io::stderr(), "{}\n", shown.join("\n\n"));
    let mistakes: usize = errors.iter().map(CaseError::mistakes).sum();
    let [mistakes, files] =
        [(mistakes, "mistake"), (errors.len(), kind)].map(|(n, what)| counted(n as u64, what));
    anyhow::anyhow!("{mistakes} in {files}; {effect}")
}

/// Returns the name of this program.
pub fn program() -> String {
    let name = std::env::args_os().next().map(PathBuf::from);
    let stem = name.as_deref().and_then(Path::file_stem);
    stem.map_or("trueflight".into(), |stem| stem.to_string_lossy().into_owned())
}

/// Returns the command line, quoted for a shell.
pub fn command_line() -> String {
    let words = std::env::args_os().skip(1).map(|word| quoted(&word.to_string_lossy()));
    [program()].into_iter().chain(words).collect::<Vec<_>>().join(" ")
}

/// Returns date and time, as in `2026-11-27 11:27 UTC`.
pub fn date() -> String {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    date_of(now.as_secs())
}

/// Returns the date of a number of seconds since 1970 (H. Hinnant, "chrono-compatible low-level date algorithms", 2013).
fn date_of(seconds: u64) -> String {
    let (days, minutes) = (seconds / 86_400 + 719_468, seconds % 86_400 / 60);
    let (era, of_era) = (days / 146_097, days % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let day = of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year + 400 * era + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02} {:02}:{:02} UTC", minutes / 60, minutes % 60)
}

/// Writes a warning to stderr.
pub fn warn(text: &str) {
    tell("warning", text);
}

/// Writes a note to stderr.
pub fn note(text: &str) {
    tell("note", text);
}

fn tell(kind: &str, text: &str) {
    // Without stderr there is no place to report to.
    let _ = writeln!(std::io::stderr(), "{kind}: {text}");
}

/// Returns a bar on the terminal's stderr; hidden if stderr is not a terminal.
pub fn progress(doing: &str, things: &str, length: u64, options: &Console) -> Bar {
    progress_until(doing, things, length, None, options)
}

/// Returns a bar of work that ends after `seconds` at the latest, if there is a limit.
pub fn progress_until(
    doing: &str,
    things: &str,
    length: u64,
    seconds: Option<f64>,
    options: &Console,
) -> Bar {
    let is_shown = !options.quiet && std::io::stderr().is_terminal();
    Bar::new([doing, things], length, seconds, is_shown)
}

/// Makes the folder of a run, which keeps draws in it from the first on; fails if it cannot be written to.
pub fn writable(out: &Path) -> anyhow::Result<()> {
    let cure = || format!("cannot write into {}; give another folder with --out", out.display());
    std::fs::create_dir_all(out).with_context(cure)?;
    tempfile::NamedTempFile::new_in(out).with_context(cure)?;
    Ok(())
}

/// Fails if files cannot be written into a folder, which need not exist; it is not made before there is something to write.
pub fn can_write(out: &Path) -> anyhow::Result<()> {
    let known = out.ancestors().find(|folder| folder.exists()).unwrap_or(Path::new("."));
    let cure = || format!("cannot write into {}; give another folder with --out", out.display());
    tempfile::tempfile_in(known).map(drop).with_context(cure)
}

/// Returns the width and the colours of stdout; the width is at least 40 columns.
pub fn pen(options: &Console) -> Pen {
    let colour = options.color.colours(std::io::stdout().is_terminal());
    Pen { width: width().max(40), colour }
}

/// Returns the width of the terminal, or `COLUMNS`, or 120.
fn width() -> usize {
    let terminal = terminal_size::terminal_size().map(|(width, _)| usize::from(width.0));
    let wished = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    terminal.or(wished).unwrap_or(120)
}

#[cfg(test)]
mod tests {
    use super::date_of;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (seconds, date) in [
            (0, "1970-01-01 00:00 UTC"),
            (951_782_399, "2000-02-28 23:59 UTC"),
            (951_782_400, "2000-02-29 00:00 UTC"),
            (4_107_542_400, "2100-03-01 00:00 UTC"),
        ] {
            assert_eq!(date_of(seconds), date);
        }
    }
}
