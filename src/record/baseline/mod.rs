//! Stored runs, which later runs are compared with.
//!
//! A baseline is a file `NAME.json` with one entry per experiment and channel. A later run is compared
//! with it ([`compare`](fn@compare)): has the variance, the number of lookups or the time grown? And on unchanged
//! code and cases the e-values of runs with different seeds multiply: a bias too small for one night
//! is found over many.
//!
//! A baseline that is missing, broken or of another form is an error; a file is written under a
//! temporary name and renamed.

pub mod compare;
pub mod comparison;
pub mod file;

use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::plan::ExperimentId;
use crate::record::{Record, Row};

pub use compare::compare;
pub use comparison::{Change, Comparison, Drift, LeftOut, Measured, Quantity, Rules, Sequel};
pub use file::BaselineError;

/// The version of the file's form.
pub const SCHEMA: u32 = 2;

/// A stored run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// The version of the form, [`SCHEMA`].
    pub schema: u32,
    /// The version of the tool.
    pub version: String,
    /// A hash of the program that drew.
    pub executable: String,
    /// The largest ln E at which a scalar fails, of all runs that are joined here.
    pub ln_e_limit: f64,
    /// The seeds whose e-values are multiplied into the entries.
    pub seeds: Vec<u64>,
    /// The experiments.
    pub entries: Vec<Entry>,
}

/// Identity of a channel of an experiment.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct ChannelId {
    /// The experiment.
    pub experiment: ExperimentId,
    /// The channel's name; empty if a draw is one value.
    pub channel: String,
}

impl Display for ChannelId {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let comma = if self.channel.is_empty() { "" } else { ", " };
        write!(f, "{}{comma}{}", self.experiment, self.channel)
    }
}

/// One experiment, one channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Identity of experiment and channel.
    pub id: ChannelId,
    /// A hash of the case's text.
    pub case: String,
    /// The seed of the numbers below.
    pub seed: u64,
    /// Whether its σ̂ depends on the seed.
    pub learns: bool,
    /// How many draws the mean, the variance and the lookups are of.
    pub draws: u64,
    /// The mean.
    pub mean: Option<f64>,
    /// The sample variance.
    pub variance: Option<f64>,
    /// The kurtosis in theory.
    pub kurtosis: Option<f64>,
    /// `E[X⁸]/E[X⁴]²` in theory.
    pub eighth_moment_ratio: Option<f64>,
    /// The rare-event size in theory.
    pub rare_event_size: Option<f64>,
    /// Lookups of σ_t per draw; given once per experiment.
    pub lookups: Option<f64>,
    /// Their variance in theory.
    pub lookups_variance: Option<f64>,
    /// Processor seconds of all draws; given once per experiment.
    pub seconds: Option<f64>,
    /// How many draws took them.
    pub drawn: u64,
    /// ln E of each check, all seeds together.
    pub checks: Vec<Evidence>,
    /// The command that repeats it.
    pub command: String,
}

/// The evidence of one check against the experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// The check with what it asked about.
    pub check: String,
    /// ln E.
    pub ln_e: f64,
}

impl Baseline {
    /// What a run found, to be stored; `cases` are those of its plan.
    pub fn of(record: &Record, cases: &[Case], executable: &str) -> Self {
        let results = &record.results;
        let digest = |name: &str| cases.iter().find(|case| case.name == name).map(|c| c.digest);
        let mut entries = Vec::new();
        for case in &results.cases {
            let digest = format!("{:016x}", digest(&case.name).unwrap_or(0));
            let drawn = case.rows().filter(|row| row.experiment.drawn.is_some());
            entries.extend(drawn.map(|row| Entry::of(&row, results.seed, &digest)));
        }
        Self {
            schema: SCHEMA,
            version: results.version.clone(),
            executable: executable.to_owned(),
            ln_e_limit: results.gate.ln_e_limit,
            seeds: vec![results.seed],
            entries,
        }
    }

    /// The file of a baseline.
    ///
    /// # Errors
    ///
    /// The name is not a plain word.
    pub fn path(folder: &Path, name: &str) -> Result<PathBuf, BaselineError> {
        let plain = |c: char| c.is_ascii_alphanumeric() || ".-_".contains(c);
        if name.is_empty() || name.starts_with('.') || !name.chars().all(plain) {
            return Err(BaselineError::Name(name.to_owned()));
        }
        Ok(folder.join(format!("{name}.json")))
    }

    /// Reads a baseline.
    ///
    /// # Errors
    ///
    /// There is none, or it is not what this program writes.
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let stored: Self = file::read(path, SCHEMA, "entries")?;
        match stored.entries.iter().find(|entry| !entry.makes_sense()) {
            Some(entry) => {
                Err(BaselineError::Nonsense { path: path.to_owned(), id: entry.id.to_string() })
            }
            None => Ok(stored),
        }
    }

    /// Whether a file can be written, known before the drawing.
    ///
    /// # Errors
    ///
    /// Its folder cannot be made or written into.
    pub fn writable(path: &Path) -> Result<(), BaselineError> {
        file::writable(path)
    }

    /// Writes the file under a temporary name, then renames it.
    ///
    /// # Errors
    ///
    /// The system refuses.
    pub fn write(&self, path: &Path) -> Result<(), BaselineError> {
        file::write(self, path)
    }
}

/// A hash of the program that runs: FNV-1a over words of 8 bytes.
///
/// # Errors
///
/// The program's file cannot be read.
pub fn fingerprint() -> Result<String, BaselineError> {
    let path = std::env::current_exe().map_err(BaselineError::Executable)?;
    let bytes = std::fs::read(path).map_err(BaselineError::Executable)?;
    let (words, rest) = bytes.as_chunks::<8>();
    let add = |hash: u64, word: u64| (hash ^ word).wrapping_mul(0x0100_0000_01b3).rotate_left(29);
    let hash =
        words.iter().fold(0xcbf2_9ce4_8422_2325, |h, &word| add(h, u64::from_le_bytes(word)));
    let hash = rest.iter().fold(hash, |hash, &byte| add(hash, u64::from(byte)));
    Ok(format!("{:016x}", add(hash, bytes.len() as u64)))
}

impl Entry {
    /// Whether its numbers can be those of a run.
    fn makes_sense(&self) -> bool {
        let sizes = [self.variance, self.lookups, self.lookups_variance, self.seconds];
        let is_size = |x: &f64| *x >= 0.0 && *x < f64::MAX;
        let is_ratio = |x: &f64| *x >= 1.0;
        self.draws > 0
            && self.drawn > 0
            && sizes.iter().flatten().all(is_size)
            && self.kurtosis.iter().all(is_ratio)
            && self.mean.is_none_or(f64::is_finite)
    }

    fn of(row: &Row, seed: u64, digest: &str) -> Self {
        let (experiment, is_first) = (row.experiment, row.is_first());
        // The time of shared lookups depends on the experiments that share them.
        let is_timed = is_first && experiment.sharing.is_none();
        let draws = experiment.draws.unwrap_or(0);
        // Where the law of the lookups is known and has no spread, there is no deviation.
        let spread =
            experiment.lookups_deviation.map(|deviation| deviation * deviation * draws as f64);
        let checks = row.own_findings().filter(|found| !found.expects_bias);
        let checks = checks.filter_map(|found| {
            let ln_e = found.gate?.ln_e;
            let check = format!("{}: {}", found.check, found.what);
            ln_e.is_finite().then_some(Evidence { check, ln_e })
        });
        Self {
            id: ChannelId { experiment: experiment.id.clone(), channel: row.channel.clone() },
            case: digest.to_owned(),
            seed,
            learns: experiment.id.sampling.kind.contains("pilot"),
            draws,
            mean: row.mean,
            variance: row.variance,
            kurtosis: row.predicted_kurtosis,
            eighth_moment_ratio: row.eighth_moment_ratio,
            rare_event_size: row.rare_event_size,
            lookups: experiment.lookups_per_draw.filter(|_| is_first),
            lookups_variance: spread.or(experiment.predicted_lookups.map(|_| 0.0)),
            seconds: experiment.spent.seconds.filter(|_| is_timed),
            drawn: experiment.drawn.unwrap_or(0),
            checks: checks.collect(),
            command: experiment.command.clone(),
        }
    }
}
