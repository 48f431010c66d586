//! Costs of draws: seconds of a draw and of a lookup, measured on this machine or given for code of the user's own.
//!
//! ```text
//! cost of a draw = draw + lookup · E[lookups] + setup lookup · setup lookups/draws per ray
//! ```
//!
//! `draw` and `lookup` of a candidate are measured in the medium itself, with draws at two σ̂, by processor time. Those of
//! the first rows are corrected by draws at the advised σ̂, in turn. A lookup of a setup costs the median of all candidates. Costs
//! are kept in a file for each medium and machine, and measured again on demand.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use cpu_time::ThreadTime;
use fearless_simd::Level;
use serde::{Deserialize, Serialize};

use super::options::TIMES;
use crate::case::sweep::Variation;
use crate::case::{Case, Spec};
use crate::json;
use estimators::{DrawBuffer, Experiment};
use media::catalogue::{Entry, Value};
use media::files;
use numeric::pack;
use numeric::rng::{Streams, name_hash};

/// Rounds of a measurement at two σ̂, and of a correction.
const ROUNDS: [usize; 2] = [24, 48];
/// Shortest time of a round, seconds.
const MIN_SECONDS: f64 = 1e-4;
/// Time of all rounds from which on no further round is needed, seconds.
const ENOUGH: f64 = 1e-2;
/// Draws at a time: the kernels fill their lanes.
const DRAWS: usize = 2048;
/// Ratio of the lookups at two σ̂ above which they tell a lookup from a draw.
const APART: f64 = 1.3;

/// Costs of draws.
#[derive(Debug, Clone, PartialEq)]
pub enum Costs {
    /// A lookup costs 1, all else nothing.
    Lookups,
    /// Equal costs for all candidates, in seconds.
    Given {
        /// Fixed cost of a draw.
        draw: f64,
        /// Cost of a lookup.
        lookup: f64,
    },
    /// Measured on this machine.
    Measured {
        /// Folder in which they are kept; `None`: they are not kept.
        folder: Option<PathBuf>,
        /// True if they are measured again.
        anew: bool,
    },
}

impl Costs {
    /// Returns costs that are measured, unless the user's cache folder has them.
    pub fn of_this_machine(anew: bool) -> Self {
        let folder = |name: &str| {
            std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute())
        };
        let home = || Some(folder("HOME")?.join(".cache"));
        let cache = folder("XDG_CACHE_HOME").or_else(|| folder("LOCALAPPDATA")).or_else(home);
        Self::Measured { folder: cache.map(|cache| cache.join("trueflight")), anew }
    }

    /// Returns the unit: `s` or `lookups`.
    pub fn unit(&self) -> &'static str {
        if *self == Self::Lookups { "lookups" } else { "s" }
    }
}

/// Cost of the draws of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Price {
    /// Fixed cost of a draw.
    pub draw: f64,
    /// Cost of a lookup.
    pub lookup: f64,
    /// Relative error; 0 for given costs.
    pub error: f64,
}

/// Measured prices of the candidates of a medium, and the file in which they are kept.
pub struct Prices {
    known: BTreeMap<String, Price>,
    path: Option<PathBuf>,
    given: Option<Price>,
}

impl Prices {
    /// Reads the prices of a medium, as far as they are kept.
    pub fn open(costs: &Costs, spec: &Spec) -> Self {
        let given = |draw, lookup| Some(Price { draw, lookup, error: 0.0 });
        let mut prices = Self { known: BTreeMap::new(), path: None, given: None };
        match costs {
            Costs::Lookups => prices.given = given(0.0, 1.0),
            &Costs::Given { draw, lookup } => prices.given = given(draw, lookup),
            Costs::Measured { folder, anew } => {
                prices.path = folder.as_deref().map(|folder| file(folder, spec));
                let path = prices.path.as_deref().filter(|_| !anew);
                let kept = path.and_then(|path| std::fs::read(path).ok());
                // A file that cannot be read is written anew, and so are costs that cannot be.
                let kept = kept.and_then(|bytes| json::read(&bytes).ok());
                let is_cost = |cost: f64| (0.0..=*TIMES.end()).contains(&cost);
                prices.known = kept.unwrap_or_default();
                prices.known.retain(|_, Price { draw, lookup, error }| {
                    [*draw, *lookup, *error].into_iter().all(is_cost)
                });
            }
        }
        prices
    }

    /// Returns the price of a candidate, measured at two places if it is not known; `None` where it cannot be drawn.
    pub fn of(&mut self, key: String, case: &Case, at: (usize, [Variation; 2])) -> Option<Price> {
        let known = self.given.or_else(|| self.known.get(&key).copied());
        known.or_else(|| {
            let price = measured(case, at)?;
            self.known.insert(key, price);
            Some(price)
        })
    }

    /// Returns the prices of candidates of a case, each corrected by draws at one setting; `None` for given costs, and
    /// where a candidate cannot be drawn.
    ///
    /// Candidates are timed in turn, round by round: other work on the machine slows all of them.
    pub fn corrected(&mut self, case: &Case, expected: &[Wanted]) -> Vec<Option<Price>> {
        if self.given.is_some() {
            return vec![None; expected.len()];
        }
        let key = |(line, (_, at), _): &Wanted| format!("{line} at {:?}", at.map(|(_, x)| x));
        let timer = |expected: &Wanted| {
            let is_known = self.known.contains_key(&key(expected));
            (!is_known).then(|| Timer::new(case, expected.1, ROUNDS[1]))?
        };
        let mut timers: Vec<Option<Timer>> = expected.iter().map(timer).collect();
        while timers.iter_mut().flatten().fold(false, |any, timer| timer.round() | any) {}
        for (expected, timer) in expected.iter().zip(timers) {
            let (Some(Timer { seconds, lookups, .. }), old) = (timer, expected.2) else { continue };
            let (seconds, error) = fast(seconds);
            let factor = seconds / (old.draw + old.lookup * lookups);
            let price = Price { draw: old.draw * factor, lookup: old.lookup * factor, error };
            self.known.insert(key(expected), price);
        }
        expected.iter().map(|expected| self.known.get(&key(expected)).copied()).collect()
    }

    /// Keeps the prices. Returns a warning if they cannot be kept: the next advice measures them again.
    pub fn keep(&self) -> Option<String> {
        let path = self.path.as_deref()?;
        let kept = path.parent().map_or(Ok(()), std::fs::create_dir_all);
        let kept = kept.and_then(|()| files::replace(path, &serde_json::to_vec(&self.known)?));
        let error = kept.err()?;
        let place = path.parent().unwrap_or(path).display();
        Some(format!(
            "costs are measured again next time: cannot write into {place} ({error}); set XDG_CACHE_HOME to another folder"
        ))
    }
}

/// Returns the file of a medium on this machine.
fn file(folder: &Path, spec: &Spec) -> PathBuf {
    let (problem, settings) = spec.problem().unwrap_or(("", &[]));
    let is_of_medium =
        |entry: &&Entry| matches!(&*entry.key, "medium" | "volume" | "span" | "ray" | "rays");
    let medium = Value::Table(settings.iter().filter(is_of_medium).cloned().collect());
    let text = toml::to_string(&medium).unwrap_or_default();
    let level = pack::word(Level::new());
    let name = format!("{}|{level}|{problem}|{text}", env!("CARGO_PKG_VERSION"));
    folder.join(format!("{:016x}.json", name_hash(&name)))
}

/// Line of a candidate, its index with a setting, and its price by draws at others.
pub type Wanted = (String, (usize, Variation), Price);

/// Measures a candidate at two places.
fn measured(case: &Case, (estimator, places): (usize, [Variation; 2])) -> Option<Price> {
    let timed = |place| {
        let mut timer = Timer::new(case, (estimator, place), ROUNDS[0])?;
        while timer.round() {}
        Some((timer.lookups, fast(timer.seconds)))
    };
    let timings: Vec<_> = places.into_iter().filter_map(timed).collect();
    let error = timings.iter().map(|(_, (_, error))| *error).fold(0.0, f64::max);
    let &(lookups, (seconds, _)) = timings.first()?;
    let each = seconds / lookups;
    let lookup = match timings[1..] {
        [(many, (longer, _))] if many > APART * lookups => {
            ((longer - seconds) / (many - lookups)).clamp(0.0, each)
        }
        _ if lookups > 0.0 => each,
        _ => 0.0,
    };
    Some(Price { draw: (seconds - lookup * lookups).max(0.0), lookup, error })
}

/// A candidate at one place that is timed in rounds.
struct Timer {
    experiment: Box<dyn Experiment>,
    streams: Streams,
    buffer: DrawBuffer,
    /// Times that the buffer is filled in a round.
    fills: u32,
    /// Maximum number of rounds.
    rounds: usize,
    /// Seconds of a draw in each round.
    seconds: Vec<f64>,
    /// Lookups of a draw in theory.
    lookups: f64,
}

impl Timer {
    /// Prepares a candidate; `None` where it cannot be drawn.
    fn new(case: &Case, (estimator, place): (usize, Variation), rounds: usize) -> Option<Self> {
        let (at, pilots) = (case.at(place).ok()?, case.pilots(1, estimator));
        let prediction = at.predict(estimator, None, pilots)?;
        let mut timer = Self {
            experiment: at.join(estimator, pilots).ok()?,
            streams: case.address(1, estimator, place).streams(),
            buffer: DrawBuffer::new(prediction.channels.len()),
            fills: 1,
            rounds: 2,
            seconds: Vec::new(),
            lookups: prediction.lookups.as_ref()?.mean,
        };
        // The first buffer maps memory.
        while timer.round() {}
        let seconds = timer.seconds[1].max(1e-12) * DRAWS as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 1 to 1024
        let fills = (MIN_SECONDS / seconds).ceil().clamp(1.0, 1024.0) as u32;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 3 to 64
        let enough = (ENOUGH / seconds).clamp(3.0, 64.0) as usize;
        Some(Self { fills, rounds: rounds.min(enough), seconds: Vec::new(), ..timer })
    }

    /// Times another round, unless there were enough.
    fn round(&mut self) -> bool {
        if self.seconds.len() >= self.rounds {
            return false;
        }
        let begin = ThreadTime::now();
        for _ in 0..self.fills {
            self.experiment.fill(&mut self.streams, DRAWS, &mut self.buffer);
        }
        let draws = f64::from(self.fills) * DRAWS as f64;
        self.seconds.push(begin.elapsed().as_secs_f64() / draws);
        true
    }
}

/// Returns the lower quartile of the times of rounds, and its relative error: other work only adds time.
pub fn fast(mut rounds: Vec<f64>) -> (f64, f64) {
    rounds.sort_by(f64::total_cmp);
    let [low, middle] = [4, 2].map(|part| rounds[rounds.len() / part].max(1e-12));
    (low, (middle / low - 1.0) / (rounds.len() as f64).sqrt())
}
