//! Stored benches: the times that a later bench is compared with.
//!
//! They are stored beside the stored runs, as `NAME.bench.json`, and are read and written in the same way.
//!
//! A time per draw has changed if the rounds of both sides do not overlap and the ratio of the medians is beyond the
//! tolerance. Two benches are timed apart, under different loads of the machine. The speedup over the plain loop, timed
//! in turn with it, is therefore reported beside the time: where it stayed, the plain loop became slower as well.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::clock::Clock;
use super::record::{Bench, BenchCase, BenchRow, Spread};
use crate::case::id::ExperimentId;
use crate::record::baseline::{self, Baseline, BaselineError, Matches};

/// The version of the file's form.
pub const SCHEMA: u32 = 1;

/// A stored bench.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Stored {
    /// The version of the form, [`SCHEMA`].
    pub schema: u32,
    /// The version of the tool.
    pub version: String,
    /// Number of threads that drew at once.
    pub threads: usize,
    /// Clock of the times.
    pub clock: Clock,
    /// The vector hardware.
    pub level: String,
    /// The experiments.
    pub timed: Vec<Timed>,
}

/// One experiment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Timed {
    /// The experiment.
    pub id: ExperimentId,
    /// A hash of the case's text.
    pub case: String,
    /// Nanoseconds of a draw.
    pub ns_per_draw: Spread,
    /// Speed relative to the plain loop.
    pub speedup: Spread,
}

impl Stored {
    /// Returns the times of a bench, to be stored.
    pub fn of(bench: &Bench) -> Self {
        let timed = |case: &BenchCase, row: &BenchRow| {
            let times = row.times.as_ref()?;
            Some(Timed {
                id: row.id.clone(),
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

    /// Returns the file of a stored bench.
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
    /// The file does not exist, or is not a stored bench.
    pub fn read(path: &Path) -> Result<Self, BaselineError> {
        baseline::read(path, SCHEMA, "timed")
    }

    /// Writes the file under a temporary name, then renames it.
    ///
    /// # Errors
    ///
    /// The system refuses.
    pub fn write(&self, path: &Path) -> Result<(), BaselineError> {
        baseline::write(self, path)
    }
}

/// Comparison of two benches.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchComparison {
    /// Name of the stored bench.
    pub name: String,
    /// Relative increase of the time that is no regression.
    pub tolerance: f64,
    /// Number of experiments that were compared.
    pub compared: usize,
    /// Experiments that became slower or faster.
    pub changes: Vec<TimeChange>,
    /// Experiments of this bench that the stored one has not.
    pub added: Vec<ExperimentId>,
    /// Experiments of the stored bench that this one has not.
    pub missing: Vec<ExperimentId>,
    /// Experiments of a case with another text.
    pub rewritten: Vec<ExperimentId>,
    /// The vector hardware of both, where it differs.
    pub levels: Option<[String; 2]>,
}

/// A time per draw that changed.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeChange {
    /// The experiment.
    pub id: ExperimentId,
    /// Nanoseconds of a draw, stored and now.
    pub ns_per_draw: [Spread; 2],
    /// The speedup over the plain loop, stored and now.
    pub speedup: [Spread; 2],
    /// Now over stored, of the medians of the times.
    pub ratio: f64,
    /// True if it became slower.
    pub is_regression: bool,
}

impl BenchComparison {
    /// Returns whether anything became slower.
    pub fn fails(&self) -> bool {
        self.changes.iter().any(|change| change.is_regression)
    }

    /// Returns whether nothing was compared.
    pub fn is_empty(&self) -> bool {
        self.compared == 0
    }
}

/// Compares a bench with the stored one called `name`.
pub fn compare(name: &str, stored: &Stored, now: &Stored, tolerance: f64) -> BenchComparison {
    let place = |timed: &'_ Timed| (timed.id.clone(), timed.case.clone());
    let Matches { pairs, added, missing, rewritten } =
        Matches::of(&stored.timed, &now.timed, place);
    BenchComparison {
        name: name.to_owned(),
        tolerance,
        compared: pairs.len(),
        changes: pairs.iter().filter_map(|[before, now]| change(before, now, tolerance)).collect(),
        added,
        missing,
        rewritten,
        levels: (stored.level != now.level).then(|| [stored.level.clone(), now.level.clone()]),
    }
}

/// Returns a change beyond both sides' rounds and the tolerance.
fn change(stored: &Timed, now: &Timed, tolerance: f64) -> Option<TimeChange> {
    let (before, after) = (stored.ns_per_draw, now.ns_per_draw);
    let ratio = after.median / before.median;
    let is_regression = after.least > before.most && ratio > 1.0 + tolerance;
    let is_improvement = after.most < before.least && ratio * (1.0 + tolerance) < 1.0;
    (is_regression || is_improvement).then(|| TimeChange {
        id: now.id.clone(),
        ns_per_draw: [before, after],
        speedup: [stored.speedup, now.speedup],
        ratio,
        is_regression,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(name: &str) -> ExperimentId {
        ExperimentId { case: name.to_owned(), ..ExperimentId::default() }
    }

    fn stored(times: &[(&str, [f64; 3])]) -> Stored {
        let timed = times.iter().map(|&(id, rounds)| Timed {
            id: self::id(id),
            case: "text".to_owned(),
            ns_per_draw: Spread::of(rounds).expect("rounds"),
            speedup: Spread::of([4.0]).expect("rounds"),
        });
        Stored {
            schema: SCHEMA,
            version: String::new(),
            threads: 1,
            clock: Clock::Processor,
            level: "avx2".to_owned(),
            timed: timed.collect(),
        }
    }

    #[test]
    fn what_overlaps_or_is_within_the_tolerance_has_not_changed() {
        let before = stored(&[("a", [9.0, 10.0, 11.0]), ("b", [9.0, 10.0, 20.0])]);
        let same = compare("main", &before, &before, 0.0);
        assert!(!same.fails() && same.changes.is_empty() && same.compared == 2);
        let later = stored(&[("a", [11.5, 12.0, 12.5]), ("b", [19.0, 21.0, 22.0])]);
        assert!(compare("main", &before, &later, 0.25).changes.is_empty());
        assert!(compare("main", &before, &later, 0.1).fails(), "a is 20 % slower");
    }

    #[test]
    fn slower_fails_faster_is_told_and_others_are_listed() {
        let before =
            stored(&[("a", [9.0, 10.0, 11.0]), ("b", [9.0, 10.0, 11.0]), ("old", [1.0; 3])]);
        let mut later =
            stored(&[("a", [19.0, 20.0, 21.0]), ("b", [4.0, 5.0, 6.0]), ("new", [1.0; 3])]);
        let result = compare("main", &before, &later, 0.25);
        assert!(result.fails());
        let ratios: Vec<_> = result.changes.iter().map(|c| (c.ratio, c.is_regression)).collect();
        assert_eq!(ratios, [(2.0, true), (0.5, false)]);
        assert_eq!((result.added, result.missing), (vec![id("new")], vec![id("old")]));
        "another".clone_into(&mut later.timed[0].case);
        let result = compare("main", &before, &later, 0.25);
        assert!(!result.fails() && result.rewritten == [id("a")] && !result.is_empty());
        let other = stored(&[("other", [1.0; 3])]);
        assert!(compare("main", &before, &other, 0.25).is_empty());
    }
}
