//! Options of commands that draw: store a run, compare with a stored one.

use std::path::{Path, PathBuf};

use anyhow::anyhow;
use clap::Args;

use super::numbers;
use crate::case::Case;
use crate::record::baseline::{
    Baseline, BaselineError, Comparison, ComparisonLevels, compare, fingerprint,
};
use crate::record::{Record, Verdict};
use crate::report::run::diff;

/// Options that all commands which draw share.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Baselines")]
pub struct BaselineArguments {
    /// Store the run as a baseline, to compare later runs with
    #[arg(long, value_name = "NAME")]
    save_baseline: Option<String>,
    /// Compare with a stored run: fail where variance, lookups or time have grown, or where the
    /// evidence of several runs on unchanged code does
    #[arg(long, value_name = "NAME")]
    baseline: Option<String>,
    /// Folder of the baselines
    #[arg(long, value_name = "DIR", default_value = "baselines")]
    baselines: PathBuf,
    /// Increase of the processor time per draw that is no regression, as a share; `inf` for any. With this option it is an
    /// error if no time can be compared [default: 0.25]
    #[arg(long, value_name = "R", value_parser = numbers::share)]
    #[arg(allow_hyphen_values = true)]
    time_tolerance: Option<f64>,
}

/// Tolerance of times if no option gives it.
const TIME_TOLERANCE: f64 = 0.25;

/// Stored result to compare with, and place to store the new one: names and files.
pub struct Files<T> {
    /// Name, file and content of the stored result.
    pub stored: Option<(String, PathBuf, T)>,
    /// Name and file of the new one.
    pub save: Option<(String, PathBuf)>,
}

impl<T> Files<T> {
    /// Reads the stored result and checks that the new one can be written, if they are named.
    pub fn open(
        [stored, save]: [Option<&String>; 2],
        path: impl Fn(&str) -> Result<PathBuf, BaselineError>,
        read: impl Fn(&str, &Path) -> anyhow::Result<T>,
    ) -> anyhow::Result<Self> {
        let stored = stored.map(|name| -> anyhow::Result<_> {
            let path = path(name)?;
            let stored = read(name, &path)?;
            Ok((name.clone(), path, stored))
        });
        let save = save.map(|name| -> anyhow::Result<_> {
            let path = path(name)?;
            Baseline::writable(&path)?;
            Ok((name.clone(), path))
        });
        Ok(Self { stored: stored.transpose()?, save: save.transpose()? })
    }

    /// Returns the error of a comparison that compared nothing: the reason, and the cure.
    pub fn complaint(&self, nothing: &str, cure: &str) -> Option<anyhow::Error> {
        let (_, path, _) = self.stored.as_ref()?;
        let path = path.display();
        Some(anyhow!("{path}: {nothing}; {cure}, or make it anew with --save-baseline"))
    }

    /// Stores the result if an option asks for it, unless there is a reason not to. Returns the text to print.
    pub fn store(
        &self,
        why_not: Option<&str>,
        write: impl FnOnce(&Path) -> Result<(), BaselineError>,
    ) -> anyhow::Result<String> {
        let Some((name, path)) = &self.save else { return Ok(String::new()) };
        if let Some(why) = why_not {
            return Ok(format!("baseline {name} not stored: {why}\n"));
        }
        write(path)?;
        Ok(format!("baseline {name} stored in {}\n", path.display()))
    }
}

/// Baseline to compare with and place to store the run, both checked before the first draw.
pub struct Baselines {
    files: Files<Baseline>,
    executable: String,
    time_tolerance: Option<f64>,
}

impl BaselineArguments {
    /// Returns whether a run is stored or compared.
    pub fn is_used(&self) -> bool {
        self.baseline.is_some() || self.save_baseline.is_some()
    }

    /// Reads the baseline and checks the folder, before the first draw.
    pub fn open(&self) -> anyhow::Result<Baselines> {
        let files = Files::open(
            [self.baseline.as_ref(), self.save_baseline.as_ref()],
            |name| Baseline::path(&self.baselines, name),
            |_, path| Ok(Baseline::read(path)?),
        )?;
        let executable = if self.is_used() { fingerprint()? } else { String::new() };
        Ok(Baselines { files, executable, time_tolerance: self.time_tolerance })
    }
}

impl Baselines {
    /// Compares a run with the baseline, if there is one; returns the baseline to store as well.
    pub fn compare(&self, mut record: Record, cases: &[Case]) -> (Record, Option<Baseline>) {
        let Files { stored, save } = &self.files;
        if stored.is_none() && save.is_none() {
            return (record, None);
        }
        let mut run = Baseline::of(&record, cases, &self.executable);
        if let Some((name, _, stored)) = stored {
            let time_tolerance = self.time_tolerance.unwrap_or(TIME_TOLERANCE);
            let time_tolerance = Some(time_tolerance).filter(|tolerance| tolerance.is_finite());
            let rules = ComparisonLevels { alpha: record.results.alpha, time_tolerance };
            let (comparison, next) = compare(name, stored, &run, &rules);
            record.comparison = Some(comparison);
            if save.as_ref().is_some_and(|(save, _)| save == name) {
                run = next;
            }
        }
        (record, Some(run))
    }

    /// Returns the error of a comparison that was asked for and compared nothing.
    pub fn complaint(&self, record: &Record) -> Option<anyhow::Error> {
        let comparison = record.comparison.as_ref()?;
        if let Some(nothing) = diff::nothing(comparison) {
            return self.files.complaint(&nothing, "run the cases of the baseline");
        }
        let expected = self.time_tolerance.filter(|_| comparison.rules.time_tolerance.is_some())?;
        let no_times = diff::no_times(comparison)?;
        Some(anyhow!(
            "--time-tolerance {expected}: {no_times}; draw more with --draws --fixed-draws, or leave the \
             option out"
        ))
    }

    /// Stores a run if an option asks for it; a run that fails or became worse is not stored. Returns the text to
    /// print.
    pub fn store(&self, record: &Record, run: Option<&Baseline>) -> anyhow::Result<String> {
        let Some(run) = run else { return Ok(String::new()) };
        let comparison = record.comparison.as_ref();
        let mut rows = record.results.rows();
        let reasons = [
            (comparison.is_some_and(Comparison::fails), "something became worse"),
            (comparison.is_some_and(Comparison::is_empty), "nothing was compared"),
            (run.entries.is_empty(), "nothing was drawn"),
            (rows.any(|row| row.verdict == Some(Verdict::Fail)), "something fails"),
        ];
        let why_not = reasons.into_iter().find(|reason| reason.0).map(|reason| reason.1);
        self.files.store(why_not, |path| run.write(path))
    }
}
