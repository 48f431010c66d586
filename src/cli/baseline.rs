//! Options of commands that draw: store a run, compare with a stored one.

use std::path::PathBuf;

use anyhow::anyhow;
use clap::Args;
use trueflight::harness::baseline::{Baseline, fingerprint};
use trueflight::harness::baseline::{Comparison, Rules, compare};
use trueflight::harness::record::Verdict;
use trueflight::harness::{Case, Record};
use trueflight::report::diff;

/// Options that all commands which draw share.
#[derive(Debug, Clone, Args)]
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
    /// How much more processor time per draw is no regression, as a share; `inf` for any. Given, it is
    /// an error that no time can be compared [default: 0.25]
    #[arg(long, value_name = "R", value_parser = share)]
    #[arg(allow_hyphen_values = true)]
    time_tolerance: Option<f64>,
}

/// The tolerance of times where none is given.
const TIME_TOLERANCE: f64 = 0.25;

/// What the drawing must be compared with, and where it is stored; known before the first draw.
pub struct Baselines {
    stored: Option<(String, PathBuf, Baseline)>,
    save: Option<(String, PathBuf)>,
    executable: String,
    time_tolerance: Option<f64>,
}

impl BaselineArguments {
    /// Whether a run is stored or compared.
    pub fn is_used(&self) -> bool {
        self.baseline.is_some() || self.save_baseline.is_some()
    }

    /// Reads the baseline and tries the folder, before anything is drawn.
    pub fn open(&self) -> anyhow::Result<Baselines> {
        let stored = self.baseline.as_ref().map(|name| -> anyhow::Result<_> {
            let path = Baseline::path(&self.baselines, name)?;
            let stored = Baseline::read(&path)?;
            Ok((name.clone(), path, stored))
        });
        let save = self.save_baseline.as_ref().map(|name| -> anyhow::Result<_> {
            let path = Baseline::path(&self.baselines, name)?;
            Baseline::writable(&path)?;
            Ok((name.clone(), path))
        });
        let (stored, save) = (stored.transpose()?, save.transpose()?);
        let executable = if self.is_used() { fingerprint()? } else { String::new() };
        Ok(Baselines { stored, save, executable, time_tolerance: self.time_tolerance })
    }
}

impl Baselines {
    /// Compares a run with the stored one, if there is one; answers what to store.
    pub fn compare(&self, mut record: Record, cases: &[Case]) -> (Record, Option<Baseline>) {
        if self.stored.is_none() && self.save.is_none() {
            return (record, None);
        }
        let mut run = Baseline::of(&record, cases, &self.executable);
        if let Some((name, _, stored)) = &self.stored {
            let time_tolerance = self.time_tolerance.unwrap_or(TIME_TOLERANCE);
            let rules = Rules { alpha: record.results.alpha, time_tolerance };
            let (comparison, next) = compare(name, stored, &run, &rules);
            record.comparison = Some(comparison);
            if self.save.as_ref().is_some_and(|(save, _)| save == name) {
                run = next;
            }
        }
        (record, Some(run))
    }

    /// What is wrong with a comparison that was asked for and says nothing.
    pub fn complaint(&self, record: &Record) -> Option<anyhow::Error> {
        let (comparison, (_, path, _)) = record.comparison.as_ref().zip(self.stored.as_ref())?;
        if let Some(nothing) = diff::nothing(comparison) {
            return Some(anyhow!(
                "{}: {nothing}; run the cases of the baseline, or make it anew with --save-baseline",
                path.display()
            ));
        }
        let wanted = self.time_tolerance.filter(|_| comparison.rules.asks_for_times())?;
        let no_times = diff::no_times(comparison)?;
        Some(anyhow!(
            "--time-tolerance {wanted}: {no_times}; draw more with --draws --fixed-draws, or leave the \
             option out"
        ))
    }

    /// Stores a run where that is wished; what fails or became worse is not stored. Answers what to
    /// print.
    pub fn store(&self, record: &Record, run: Option<&Baseline>) -> anyhow::Result<String> {
        let (Some((name, path)), Some(run)) = (&self.save, run) else { return Ok(String::new()) };
        if record.comparison.as_ref().is_some_and(Comparison::fails) {
            return Ok(format!("baseline {name} not stored: something became worse\n"));
        }
        if record.comparison.as_ref().is_some_and(Comparison::is_empty) {
            return Ok(format!("baseline {name} not stored: nothing was compared\n"));
        }
        if run.entries.is_empty() {
            return Ok(format!("baseline {name} not stored: nothing was drawn\n"));
        }
        let mut rows = record.results.cases.iter().flat_map(|case| &case.rows);
        if rows.any(|row| row.verdict == Some(Verdict::Fail)) {
            return Ok(format!("baseline {name} not stored: something fails\n"));
        }
        run.write(path)?;
        Ok(format!("baseline {name} stored in {}\n", path.display()))
    }
}

/// Reads a share of 0 or more.
pub fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if share >= 0.0 => Ok(share),
        _ => Err("it takes a share of 0 or more, such as 0.25, or inf".into()),
    }
}
