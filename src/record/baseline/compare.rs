//! Comparison of a run with a stored one.
//!
//! ```text
//! variance  ρ = s²/s₀²,  Var[ln ρ] = v(κ, n) + v(κ₀, n₀),  v = (κ − (n − 3)/(n − 1))/n
//! lookups   ρ = N/N₀,    Var[ln ρ] = Var N/(n N²) + Var N₀/(n₀ N₀²)
//! interval  ρ exp(±z √Var),  z of α over all comparisons, by Bonferroni
//! time      ρ = t/t₀, t processor time per draw, where both took 0.1 s or more
//! drift     ln E = stored + new, against the limit of the run
//! ```
//!
//! κ and Var N are those of theory, on both sides: each side's own uncertainty counts. A variance is not compared if
//! one of these holds on either side: its relative standard error is above 10 %; its distribution is not near normal
//! (`E[X⁸]/E[X⁴]²` > n/100, or fewer draws than ten times the rare-event size); it hardly varies (κ − 1 < 100/n).
//! Quantities that are not compared are listed ([`LeftOut`]).
//!
//! An interval that lies above 1 is a regression; one below is an improvement, which is reported and does not fail. The
//! error of a time is not known from one figure: it fails beyond a factor that the caller chooses.
//!
//! The product of e-values of independent runs is an e-value: the probability that it reaches the limit is at most that
//! of a single one. It is taken only if the program and the text of the case are the same and the seed is new. The
//! limit is the highest of the joined runs, since a later run selects by results of an earlier one. Entries that the
//! later run has not drawn are kept.

use std::collections::{BTreeMap, BTreeSet};

use gate::CheckId;
use serde::{Deserialize, Serialize};

use super::{Baseline, BaselineEntry, ChannelId, CheckEvidence};
use checks::normality::{Tails, variance_error};
use gate::stats::normal;

/// Levels of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ComparisonLevels {
    /// Probability that equal code shows any regression of a variance or of lookups.
    pub alpha: f64,
    /// Relative increase of the time per draw that is no regression; `None` if times are not compared.
    pub time_tolerance: Option<f64>,
}

/// Comparison of two runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// Name of the stored run.
    pub name: String,
    /// The levels.
    pub rules: ComparisonLevels,
    /// Number of runs with multiplied e-values, or the reason why they were not multiplied.
    pub sequel: Sequel,
    /// Number of variances and lookups that were compared and share α.
    pub compared: usize,
    /// Number of times per draw that were compared.
    pub times: usize,
    /// Number of e-values that were multiplied with stored ones.
    pub multiplied: usize,
    /// Number of variances that were too uncertain to compare.
    pub blunt: usize,
    /// Quantities of common experiments that were not compared.
    pub left_out: LeftOut,
    /// Quantities that grew or shrank.
    pub changes: Vec<Change>,
    /// Checks that fail over all runs together.
    pub drifts: Vec<Drift>,
    /// Experiments of this run that are not in the baseline.
    pub added: Vec<ChannelId>,
    /// Experiments of the baseline that are not in this run.
    pub missing: Vec<ChannelId>,
    /// Experiments of a case with another text than in the baseline.
    pub rewritten: Vec<ChannelId>,
}

/// Outcome of the multiplication of e-values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sequel {
    /// They multiply: number of runs together.
    Run(usize),
    /// The seed is among those stored: its draws are not new evidence.
    SameSeed,
    /// Another program made the draws.
    OtherProgram,
}

/// Quantity that is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ComparedQuantity {
    /// Sample variance of one draw.
    Variance,
    /// Lookups per draw.
    Lookups,
    /// Processor nanoseconds per draw.
    Time,
}

/// Value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MeasuredValue {
    /// The value.
    #[serde(with = "gate::extended")]
    pub value: f64,
    /// Standard error; `None` for times, for one figure has none.
    #[serde(with = "gate::extended")]
    pub error: Option<f64>,
}

/// Quantity that differs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Change {
    /// The experiment.
    pub id: ChannelId,
    /// The quantity.
    pub quantity: ComparedQuantity,
    /// Its stored value.
    pub before: MeasuredValue,
    /// Its value now.
    pub now: MeasuredValue,
    /// now/before.
    #[serde(with = "gate::extended")]
    pub ratio: f64,
    /// Interval of the true ratio; `None` for times.
    #[serde(with = "gate::extended")]
    pub interval: Option<[f64; 2]>,
    /// True if it became worse.
    pub is_regression: bool,
    /// The command that repeats the experiment.
    pub command: String,
}

/// Check that fails over several runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// The experiment.
    pub id: ChannelId,
    /// The check.
    pub check: CheckId,
    /// The quantity, as in `the mean`.
    pub what: String,
    /// ln E of all runs together.
    pub ln_e: f64,
    /// The limit.
    pub limit: f64,
    /// The command that repeats the experiment.
    pub command: String,
}

impl Comparison {
    /// Returns whether anything became worse.
    pub fn fails(&self) -> bool {
        !self.drifts.is_empty() || self.changes.iter().any(|change| change.is_regression)
    }

    /// Returns whether nothing of the run was compared.
    pub fn is_empty(&self) -> bool {
        self.compared == 0 && self.times == 0 && self.multiplied == 0
    }
}

/// Common experiments with a quantity that was not compared, by the reason.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// σ̂ was learned from other pilot rays: variance and lookups belong to another estimator.
    pub relearned: Vec<ChannelId>,
    /// The variance is too uncertain.
    pub blunt: Vec<ChannelId>,
    /// Theory has no kurtosis: the error of the variance is unknown.
    pub unpredicted: Vec<ChannelId>,
    /// Theory has no variance of the number of lookups.
    pub uncounted: Vec<ChannelId>,
    /// The draws took less than 0.1 s, then or now.
    pub brief: Vec<ChannelId>,
}

/// Entries of a stored result and of a later one, joined by their identity.
pub struct Matches<'e, T, I> {
    /// Entries that both have, stored and now.
    pub pairs: Vec<[&'e T; 2]>,
    /// Entries that only the later one has.
    pub added: Vec<I>,
    /// Entries that only the stored one has.
    pub missing: Vec<I>,
    /// Entries of a case with another text.
    pub rewritten: Vec<I>,
}

impl<'e, T, I: Ord> Matches<'e, T, I> {
    /// Joins entries by a function that returns their identity, and a hash of the text of their case.
    pub fn of(stored: &'e [T], now: &'e [T], key: impl Fn(&T) -> (I, String)) -> Self {
        let (mut pairs, mut added, mut rewritten) = (Vec::new(), Vec::new(), Vec::new());
        let keyed = stored.iter().map(|entry| (key(entry), entry));
        let mut before: BTreeMap<I, (String, &T)> =
            keyed.map(|((id, text), entry)| (id, (text, entry))).collect();
        for entry in now {
            let (id, text) = key(entry);
            match before.remove(&id) {
                None => added.push(id),
                Some((stored, _)) if stored != text => rewritten.push(id),
                Some((_, stored)) => pairs.push([stored, entry]),
            }
        }
        let is_missing = |id: &I| before.contains_key(id);
        let missing = stored.iter().map(|entry| key(entry).0).filter(is_missing).collect();
        Self { pairs, added, missing, rewritten }
    }
}

/// Largest relative difference of two numbers of lookups without spread that count as equal.
const ROUNDING: f64 = 1e-9;

/// Compares a run with a stored one. Returns also the run to store next, with the e-values of both if they multiply.
pub fn compare(
    name: &str,
    stored: &Baseline,
    run: &Baseline,
    rules: &ComparisonLevels,
) -> (Comparison, Baseline) {
    let place = |entry: &BaselineEntry| (entry.id.clone(), entry.case.clone());
    let Matches { pairs, added, missing, rewritten } =
        Matches::of(&stored.entries, &run.entries, place);
    let questions: Vec<_> = pairs.iter().flat_map(|[before, now]| questions(before, now)).collect();
    let left_out = left_out(&pairs, rules);
    let z = normal::two_sided(rules.alpha / questions.len().max(1) as f64);
    let mut changes: Vec<Change> =
        questions.iter().filter_map(|question| answer(question, z)).collect();
    let mut times = 0;
    if let Some(tolerance) = rules.time_tolerance {
        for [before, now] in &pairs {
            if let Some(both) = before.nanoseconds().zip(now.nanoseconds()) {
                times += 1;
                changes.extend(time_change(now, both.into(), tolerance));
            }
        }
    }
    let mut comparison = Comparison {
        name: name.to_owned(),
        rules: *rules,
        sequel: sequel(stored, run),
        compared: questions.len(),
        times,
        multiplied: 0,
        blunt: left_out.blunt.len(),
        left_out,
        changes,
        drifts: Vec::new(),
        added,
        missing,
        rewritten,
    };
    let before: BTreeMap<&ChannelId, &BaselineEntry> =
        stored.entries.iter().map(|entry| (&entry.id, entry)).collect();
    let mut next = run.clone();
    if comparison.sequel != Sequel::OtherProgram {
        next.ln_e_limit = next.ln_e_limit.max(stored.ln_e_limit);
        next.entries.extend(not_drawn(stored, run));
    }
    if let Sequel::Run(_) = comparison.sequel {
        (comparison.drifts, comparison.multiplied) = multiply(&mut next, &before, run);
        next.seeds = [&stored.seeds[..], &run.seeds[..]].concat();
    } else if comparison.sequel == Sequel::SameSeed {
        for entry in next.entries.iter_mut().take(run.entries.len()) {
            let stored = before.get(&entry.id);
            if let Some(stored) = stored.filter(|stored| stored.case == entry.case) {
                entry.checks.clone_from(&stored.checks);
            }
        }
        next.seeds.clone_from(&stored.seeds);
    }
    (comparison, next)
}

fn sequel(stored: &Baseline, run: &Baseline) -> Sequel {
    if stored.executable != run.executable {
        Sequel::OtherProgram
    } else if run.seeds.iter().any(|seed| stored.seeds.contains(seed)) {
        Sequel::SameSeed
    } else {
        Sequel::Run(stored.seeds.len() + run.seeds.len())
    }
}

/// Adds the stored ln E to those of the run; returns those that reach the limit, and the number of all.
fn multiply(
    next: &mut Baseline,
    before: &BTreeMap<&ChannelId, &BaselineEntry>,
    run: &Baseline,
) -> (Vec<Drift>, usize) {
    let (mut drifts, mut multiplied) = (Vec::new(), 0);
    let limit = next.ln_e_limit;
    for entry in next.entries.iter_mut().take(run.entries.len()) {
        let stored = before.get(&entry.id).filter(|stored| stored.case == entry.case);
        let Some(stored) = stored else { continue };
        for CheckEvidence { check, what, ln_e } in &mut entry.checks {
            let is_same =
                |earlier: &&CheckEvidence| earlier.check == *check && earlier.what == *what;
            let Some(earlier) = stored.checks.iter().find(is_same) else { continue };
            *ln_e += earlier.ln_e;
            multiplied += 1;
            if *ln_e >= limit {
                let (id, command) = (entry.id.clone(), entry.command.clone());
                let (check, what) = (*check, what.clone());
                drifts.push(Drift { id, check, what, ln_e: *ln_e, limit, command });
            }
        }
    }
    (drifts, multiplied)
}

/// Returns the stored entries that the run has not drawn, unless the text of their case has changed.
fn not_drawn(stored: &Baseline, run: &Baseline) -> Vec<BaselineEntry> {
    let texts: BTreeMap<&str, &str> =
        run.entries.iter().map(|entry| (entry.id.experiment.case.as_str(), &*entry.case)).collect();
    let drawn: BTreeSet<&ChannelId> = run.entries.iter().map(|entry| &entry.id).collect();
    let kept = stored.entries.iter().filter(|entry| {
        let text = texts.get(entry.id.experiment.case.as_str());
        !drawn.contains(&entry.id) && text.is_none_or(|text| *text == entry.case)
    });
    kept.cloned().collect()
}

/// Returns the quantities of two entries that can be compared, before and now.
fn questions<'e>(before: &BaselineEntry, now: &'e BaselineEntry) -> Vec<ComparedEntry<'e>> {
    if !is_comparable(before, now) {
        return Vec::new();
    }
    let is_sharp = before.is_sharp() && now.is_sharp();
    let variance = before.variance().zip(now.variance()).filter(|_| is_sharp);
    let lookups = before.lookups().zip(now.lookups());
    let both = [(ComparedQuantity::Variance, variance), (ComparedQuantity::Lookups, lookups)];
    both.into_iter().filter_map(|(quantity, both)| Some((now, quantity, both?))).collect()
}

/// Entry, compared quantity, and its values before and now.
type ComparedEntry<'e> = (&'e BaselineEntry, ComparedQuantity, (Relative, Relative));

/// Returns a quantity that changed by more than its error.
fn answer(&(entry, quantity, (before, now)): &ComparedEntry, z: f64) -> Option<Change> {
    let ratio = now.0 / before.0;
    let error = z * before.1.hypot(now.1) + ROUNDING;
    let measured = |(value, error): Relative| MeasuredValue { value, error: Some(value * error) };
    let interval = [ratio * (-error).exp(), ratio * error.exp()];
    (ratio.ln().abs() > error).then(|| Change {
        id: entry.id.clone(),
        quantity,
        before: measured(before),
        now: measured(now),
        ratio,
        interval: Some(interval).filter(|ends| ends[1].is_finite()),
        is_regression: ratio > 1.0,
        command: entry.command.clone(),
    })
}

/// Returns a time that changed by more than the tolerance, in either direction.
fn time_change(entry: &BaselineEntry, [before, now]: [f64; 2], tolerance: f64) -> Option<Change> {
    let ratio = now / before;
    let is_regression = ratio > 1.0 + tolerance;
    (is_regression || ratio * (1.0 + tolerance) < 1.0).then(|| Change {
        id: entry.id.clone(),
        quantity: ComparedQuantity::Time,
        before: MeasuredValue { value: before, error: None },
        now: MeasuredValue { value: now, error: None },
        ratio,
        interval: None,
        is_regression,
        command: entry.command.clone(),
    })
}

/// Shortest time, in seconds, that is compared; shorter ones are noise.
const MIN_SECONDS: f64 = 0.1;
/// Value with its standard error, relative to it.
type Relative = (f64, f64);

impl BaselineEntry {
    fn variance(&self) -> Option<Relative> {
        let (n, kurtosis) = (self.draws as f64, self.kurtosis?);
        let variance = self.variance.filter(|&variance| variance > 0.0)?;
        Some((variance, variance_error(kurtosis, n)))
    }

    /// Returns whether the sample variance is certain enough to be compared.
    fn is_sharp(&self) -> bool {
        self.variance().is_some()
            && Tails {
                kurtosis: self.kurtosis,
                eighth_moment_ratio: self.eighth_moment_ratio,
                rare_event_size: self.rare_event_size,
            }
            .has_normal_variance(self.draws as f64)
    }

    fn lookups(&self) -> Option<Relative> {
        let lookups = self.lookups.filter(|&lookups| lookups > 0.0)?;
        Some((lookups, (self.lookups_variance? / self.draws as f64).sqrt() / lookups))
    }

    fn nanoseconds(&self) -> Option<f64> {
        let seconds = self.seconds.filter(|&seconds| seconds >= MIN_SECONDS)?;
        Some(1e9 * seconds / self.drawn as f64)
    }
}

/// Returns whether both have the same σ̂: not if it was learned from other pilot rays.
fn is_comparable(before: &BaselineEntry, now: &BaselineEntry) -> bool {
    !now.learns || before.seed == now.seed
}

/// Returns the quantities of common experiments that are not compared.
fn left_out(pairs: &[[&BaselineEntry; 2]], rules: &ComparisonLevels) -> LeftOut {
    let list = |is_out: &dyn Fn(&BaselineEntry, &BaselineEntry) -> bool| -> Vec<ChannelId> {
        let out = pairs.iter().filter(|[before, now]| is_out(before, now));
        out.map(|[_, now]| now.id.clone()).collect()
    };
    let of_one = |is_out: &dyn Fn(&BaselineEntry, &BaselineEntry) -> bool| {
        list(&|before, now| is_comparable(before, now) && is_out(before, now))
    };
    let timed = |is_out: &dyn Fn(&BaselineEntry, &BaselineEntry) -> bool| {
        list(&|before, now| rules.time_tolerance.is_some() && is_out(before, now))
    };
    LeftOut {
        relearned: list(&|before, now| !is_comparable(before, now)),
        blunt: of_one(&|before, now| {
            let has_both = before.variance().is_some() && now.variance().is_some();
            has_both && !(before.is_sharp() && now.is_sharp())
        }),
        unpredicted: of_one(&|before, now| {
            let varies = |entry: &BaselineEntry| entry.variance != Some(0.0);
            let has_both = before.variance().is_some() && now.variance().is_some();
            !has_both && (varies(before) || varies(now))
        }),
        uncounted: of_one(&|before, now| {
            let looks = |entry: &BaselineEntry| entry.lookups.is_some_and(|lookups| lookups > 0.0);
            let has_both = before.lookups().is_some() && now.lookups().is_some();
            !has_both && (looks(before) || looks(now))
        }),
        brief: timed(&|before, now| {
            let has_both = before.seconds.is_some() && now.seconds.is_some();
            has_both && (before.nanoseconds().is_none() || now.nanoseconds().is_none())
        }),
    }
}
