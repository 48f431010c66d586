//! Stored runs, with which later runs are compared.
//!
//! A baseline is a file `NAME.json` with one entry per experiment and channel. A later run is compared with it
//! ([`compare`](fn@compare)): has the variance, the number of lookups or the time grown? On unchanged code and cases
//! the e-values of runs with different seeds multiply: a bias too small for one night is detected over many.
//!
//! A baseline that is missing, broken or of another version is an error; a file is written under a temporary name and
//! renamed.

mod compare;

use std::fmt::{self, Display, Formatter};
use std::io;
use std::path::{Path, PathBuf};

use gate::CheckId;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::json;
use crate::plan::ExperimentId;
use crate::record::{Record, Row};
use media::files;

pub(crate) use compare::Matches;
pub use compare::{
    Change, ComparedQuantity, Comparison, ComparisonLevels, Drift, LeftOut, MeasuredValue, Sequel,
    compare,
};

/// Version of the file's format.
pub const SCHEMA: u32 = 1;

/// A stored run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// Version of the format, [`SCHEMA`].
    pub schema: u32,
    /// The version of the tool.
    pub version: String,
    /// A hash of the program that drew.
    pub executable: String,
    /// Largest ln E at which a scalar fails, of all joined runs.
    pub ln_e_limit: f64,
    /// Seeds of the e-values that are multiplied into the entries.
    pub seeds: Vec<u64>,
    /// The experiments.
    pub entries: Vec<BaselineEntry>,
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
pub struct BaselineEntry {
    /// Identity of experiment and channel.
    pub id: ChannelId,
    /// A hash of the case's text.
    pub case: String,
    /// Seed of the numbers below.
    pub seed: u64,
    /// True if its σ̂ depends on the seed.
    pub learns: bool,
    /// Number of draws of the mean, the variance and the lookups.
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
    /// Number of draws that took this time.
    pub drawn: u64,
    /// ln E of each check, all seeds together.
    pub checks: Vec<CheckEvidence>,
    /// Command that repeats it.
    pub command: String,
}

/// The evidence of one check against the experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CheckEvidence {
    /// The check.
    pub check: CheckId,
    /// The quantity, as in `the mean`.
    pub what: String,
    /// ln E.
    pub ln_e: f64,
}

impl Baseline {
    /// Takes the results of a run for storing; `cases` are those of its plan.
    pub fn of(record: &Record, cases: &[Case], executable: &str) -> Self {
        let results = &record.results;
        let mut entries = Vec::new();
        for case in &results.cases {
            let own = cases.iter().find(|own| own.name == case.name);
            let drawn = case.rows().filter(|row| row.experiment.drawn.is_some());
            entries.extend(drawn.map(|row| BaselineEntry::of(&row, results.seed, own)));
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

    /// Returns the path of a baseline.
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
    /// The file does not exist, or is not a baseline.
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        let stored: Self = read(path, SCHEMA, "entries")?;
        match stored.entries.iter().find(|entry| !entry.makes_sense()) {
            Some(entry) => {
                Err(BaselineError::Nonsense { path: path.to_owned(), id: entry.id.to_string() })
            }
            None => Ok(stored),
        }
    }

    /// Validates, before the drawing, that a file can be written.
    ///
    /// # Errors
    ///
    /// Its folder cannot be made or written to.
    pub fn writable(path: &Path) -> Result<(), BaselineError> {
        writable(path)
    }

    /// Writes the file under a temporary name, then renames it.
    ///
    /// # Errors
    ///
    /// The system refuses.
    pub fn write(&self, path: &Path) -> Result<(), BaselineError> {
        write(self, path)
    }
}

/// Returns a hash of the running program: FNV-1a over words of 8 bytes.
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

impl BaselineEntry {
    /// Returns whether its numbers can be those of a run.
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

    fn of(row: &Row, seed: u64, case: Option<&Case>) -> Self {
        let (experiment, is_first) = (row.experiment, row.is_first());
        let learns = |case: &Case| case.scenario.learns(experiment.listed);
        let draws = experiment.draws.unwrap_or(0);
        // A predicted number of lookups without spread has deviation 0.
        let spread =
            experiment.lookups_deviation.map(|deviation| deviation * deviation * draws as f64);
        let checks = row.own_findings().filter(|finding| !finding.expects_bias);
        let checks = checks.filter_map(|finding| {
            let ln_e = finding.gate?.ln_e;
            let (check, what) = (finding.check, finding.what.clone());
            ln_e.is_finite().then_some(CheckEvidence { check, what, ln_e })
        });
        Self {
            id: ChannelId { experiment: experiment.id.clone(), channel: row.channel.clone() },
            case: format!("{:016x}", case.map_or(0, |case| case.digest)),
            seed,
            learns: experiment.id.sampling.constant.is_none() && case.is_some_and(learns),
            draws,
            mean: row.mean,
            variance: row.variance,
            kurtosis: row.predicted_kurtosis,
            eighth_moment_ratio: row.eighth_moment_ratio,
            rare_event_size: row.rare_event_size,
            lookups: experiment.lookups_per_draw.filter(|_| is_first),
            lookups_variance: spread.or(experiment.predicted_lookups.map(|_| 0.0)),
            seconds: experiment.spent.seconds.filter(|_| is_first),
            drawn: experiment.drawn.unwrap_or(0),
            checks: checks.collect(),
            command: experiment.command.clone(),
        }
    }
}

/// Reason why a baseline could not be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BaselineError {
    /// Not a plain word.
    #[error("`{0}` is no name for a baseline; use letters, digits, `.`, `-` and `_`")]
    Name(String),
    /// There is no such file.
    #[error("{}: no such baseline; make it with --save-baseline, or name its folder with --baselines", .0.display())]
    Missing(PathBuf),
    /// The system refused to read it.
    #[error("{}: {cause}; make the file readable", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        cause: io::Error,
    },
    /// The file is not a baseline.
    #[error("{}: not a baseline, or a broken one ({cause}); make it anew with --save-baseline", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Error of the decoder.
        cause: serde_json::Error,
    },
    /// The file is of another kind of this program.
    #[error("{}: {actual}, not a baseline of this command; make one with --save-baseline", path.display())]
    OtherKind {
        /// The file.
        path: PathBuf,
        /// Kind of the file.
        actual: &'static str,
    },
    /// A number that no run can have.
    #[error("{}: the numbers of {id} are those of no run; make it anew with --save-baseline", path.display())]
    Nonsense {
        /// The file.
        path: PathBuf,
        /// The entry.
        id: String,
    },
    /// Another version of the format.
    #[error(
        "{}: a baseline of form {actual}, this program reads {expected}; \
         make it anew with --save-baseline", path.display()
    )]
    Schema {
        /// The file.
        path: PathBuf,
        /// Version of the file.
        actual: u64,
        /// Version that the program reads.
        expected: u32,
    },
    /// The file cannot be written.
    #[error("{}: cannot be written: {cause}; give another folder with --baselines", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        cause: io::Error,
    },
    /// The program's own file cannot be read.
    #[error("the program cannot read its own file: {0}; make it readable")]
    Executable(io::Error),
}

/// Reads a file of this version of its format, with its content in the given list.
pub(crate) fn read<T: DeserializeOwned>(
    path: &Path,
    expected: u32,
    list: &str,
) -> Result<T, BaselineError> {
    let path = path.to_owned();
    let text = match std::fs::read(&path) {
        Ok(text) => text,
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => {
            return Err(BaselineError::Missing(path));
        }
        Err(cause) => return Err(BaselineError::Unreadable { path, cause }),
    };
    let tree: serde_json::Value = match serde_json::from_slice(&text) {
        Ok(tree) => tree,
        Err(cause) => return Err(BaselineError::Broken { path, cause }),
    };
    if let Some(actual) = other_kind(&tree, list) {
        return Err(BaselineError::OtherKind { path, actual });
    }
    // The version is read first: everything else depends on it.
    if let Some(actual) = tree.get("schema").and_then(serde_json::Value::as_u64)
        && actual != u64::from(expected)
    {
        return Err(BaselineError::Schema { path, actual, expected });
    }
    serde_json::from_value(tree).map_err(|cause| BaselineError::Broken { path, cause })
}

/// Returns the kind of a file of this program that lacks the expected list.
fn other_kind(tree: &serde_json::Value, list: &str) -> Option<&'static str> {
    let kinds = [
        ("entries", "a stored run"),
        ("timed", "a stored bench"),
        ("results", "the record of a run"),
        ("cases", "the record of a bench"),
    ];
    let has = |key: &str| tree.get(key).is_some();
    let other = kinds.into_iter().find(|(key, _)| has(key)).filter(|_| !has(list));
    other.map(|(_, kind)| kind)
}

/// Validates that a file can be written; makes its folder.
pub(crate) fn writable(path: &Path) -> Result<(), BaselineError> {
    folder_of(path).and_then(|()| files::writable(path)).map_err(|cause| unwritable(path, cause))
}

/// Writes a file completely or not at all.
pub(crate) fn write<T: Serialize>(value: &T, path: &Path) -> Result<(), BaselineError> {
    let write = || -> io::Result<()> {
        let text = json::pretty(value).map_err(io::Error::other)?;
        folder_of(path)?;
        files::replace(path, (text + "\n").as_bytes())
    };
    write().map_err(|cause| unwritable(path, cause))
}

/// Makes the folder of a file.
fn folder_of(path: &Path) -> io::Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))
}

fn unwritable(path: &Path, cause: io::Error) -> BaselineError {
    BaselineError::Unwritable { path: path.to_owned(), cause }
}
