//! Stored benches: the times that a later bench is compared with.
//!
//! They stand beside the stored runs, as `NAME.bench.json`, and are read and written in the same way.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::clock::Clock;
use super::record::{Bench, BenchCase, BenchRow};
use super::spread::Spread;
use crate::record::baseline::{Baseline, BaselineError, file};

/// The version of the file's form.
pub const SCHEMA: u32 = 1;

/// A stored bench.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stored {
    /// The version of the form, [`SCHEMA`].
    pub schema: u32,
    /// The version of the tool.
    pub version: String,
    /// How many threads drew at once.
    pub threads: usize,
    /// What time was.
    pub clock: Clock,
    /// The vector hardware.
    pub level: String,
    /// The experiments.
    pub timed: Vec<Timed>,
}

/// One experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// `case|estimator|sampling|control|swept`.
    pub id: String,
    /// A hash of the case's text.
    pub case: String,
    /// Nanoseconds of a draw.
    pub ns_per_draw: Spread,
    /// How many times as fast as the plain loop.
    pub speedup: Spread,
}

impl Stored {
    /// What a bench found, to be stored.
    pub fn of(bench: &Bench) -> Self {
        let timed = |case: &BenchCase, row: &BenchRow| {
            let times = row.times.as_ref()?;
            Some(Timed {
                id: id(case, row),
                case: case.digest.clone(),
                ns_per_draw: times.ns_per_draw,
                speedup: times.speedup,
            })
        };
        let conditions = &bench.conditions;
        let cases = bench.cases.iter();
        Self {
            schema: SCHEMA,
            version: bench.version.clone(),
            threads: conditions.threads,
            clock: conditions.clock,
            level: conditions.level.clone(),
            timed: cases
                .flat_map(|case| case.experiments().filter_map(move |row| timed(case, row)))
                .collect(),
        }
    }

    /// The file of a stored bench.
    ///
    /// # Errors
    ///
    /// The name is not a plain word.
    pub fn path(folder: &Path, name: &str) -> Result<PathBuf, BaselineError> {
        Baseline::path(folder, name).map(|path| path.with_file_name(format!("{name}.bench.json")))
    }

    /// Reads a stored bench.
    ///
    /// # Errors
    ///
    /// There is none, or it is not what this program writes.
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        file::read(path, SCHEMA, "timed")
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

fn id(case: &BenchCase, row: &BenchRow) -> String {
    let sampling = row.sampling.map_or_else(|| row.sampling_kind.clone(), |x| x.to_string());
    let swept = row.swept.map_or(String::new(), |x| x.to_string());
    [&case.name, &row.estimator, &sampling, &row.control, &swept].map(String::as_str).join("|")
}
