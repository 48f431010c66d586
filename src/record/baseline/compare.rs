//! A run against a stored one.
//!
//! ```text
//! variance  ρ = s²/s₀²,  Var[ln ρ] = v(κ, n) + v(κ₀, n₀),  v = (κ − (n − 3)/(n − 1))/n
//! lookups   ρ = N/N₀,    Var[ln ρ] = Var N/(n N²) + Var N₀/(n₀ N₀²)
//! interval  ρ exp(±z √Var),  z of α over all comparisons, by Bonferroni
//! time      ρ = t/t₀, t processor time per draw, where both took 0.1 s or more
//! drift     ln E = stored + new, against the limit of the run
//! ```
//!
//! κ and Var N are those of theory, on both sides: each side's own uncertainty counts. A variance is
//! not compared where, on either side, its relative standard error is above 10 %, its law is not near
//! normal (`E[X⁸]/E[X⁴]²` > n/100, or fewer draws than ten times the rare-event size), or hardly anything
//! of it is left to chance (κ − 1 < 100/n). What is left out is listed ([`LeftOut`]), and a
//! comparison of nothing is none. A regression is an
//! interval that lies above 1; an improvement, one below, is told and does not fail. The error of a
//! time is not known from one figure: it fails beyond a factor that the caller chooses.
//!
//! The product of e-values of independent runs is an e-value: its chance to reach the limit is at most
//! that of one. It is taken only where the program and the text of the case are the same and the seed
//! is new. The limit is the highest of the runs that are joined, since what a later run selects is
//! selected by what an earlier one showed; entries that the later run has not drawn are kept.

use std::collections::{BTreeMap, BTreeSet};

use super::comparison::{Change, Comparison, Drift, LeftOut, Measured, Quantity, Rules, Sequel};
use super::{Baseline, ChannelId, Entry, Evidence};
use crate::checks::normality::{Tails, variance_error};
use gate::stats::normal;

/// Two numbers of lookups without spread are the same if they are this near.
const ROUNDING: f64 = 1e-9;

/// Compares a run with a stored one; answers also what to store next: the run, with the e-values of
/// both where they multiply.
pub fn compare(
    name: &str,
    stored: &Baseline,
    run: &Baseline,
    rules: &Rules,
) -> (Comparison, Baseline) {
    let before: BTreeMap<&ChannelId, &Entry> =
        stored.entries.iter().map(|entry| (&entry.id, entry)).collect();
    let ids: BTreeSet<&ChannelId> = run.entries.iter().map(|entry| &entry.id).collect();
    let mut comparison = Comparison::new(name, rules, sequel(stored, run));
    let missing = stored.entries.iter().filter(|entry| !ids.contains(&entry.id));
    comparison.missing = missing.map(|entry| entry.id.clone()).collect();
    let mut pairs = Vec::new();
    for now in &run.entries {
        match before.get(&now.id) {
            None => comparison.added.push(now.id.clone()),
            Some(before) if before.case != now.case => comparison.rewritten.push(now.id.clone()),
            Some(before) => pairs.push((*before, now)),
        }
    }
    let questions: Vec<_> = pairs.iter().flat_map(|(before, now)| questions(before, now)).collect();
    comparison.compared = questions.len();
    comparison.left_out = left_out(&pairs, rules);
    comparison.blunt = comparison.left_out.blunt.len();
    let z = normal::two_sided(rules.alpha / questions.len().max(1) as f64);
    comparison.changes = questions.iter().filter_map(|question| answer(question, z)).collect();
    if let Some(tolerance) = rules.time_tolerance {
        let timed =
            |(before, now): &(&Entry, &Entry)| Some((before.nanoseconds()?, now.nanoseconds()?));
        for (pair, (earlier, later)) in pairs.iter().filter_map(|pair| Some((pair, timed(pair)?))) {
            comparison.times += 1;
            comparison.changes.extend(time_change(pair.1, [earlier, later], tolerance));
        }
    }
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

/// Adds the stored ln E to those of the run; answers those that reach the limit, and how many there were.
fn multiply(
    next: &mut Baseline,
    before: &BTreeMap<&ChannelId, &Entry>,
    run: &Baseline,
) -> (Vec<Drift>, usize) {
    let (mut drifts, mut multiplied) = (Vec::new(), 0);
    let limit = next.ln_e_limit;
    for entry in next.entries.iter_mut().take(run.entries.len()) {
        let stored = before.get(&entry.id).filter(|stored| stored.case == entry.case);
        let Some(stored) = stored else { continue };
        for Evidence { check, ln_e } in &mut entry.checks {
            let Some(earlier) = stored.checks.iter().find(|earlier| earlier.check == *check) else {
                continue;
            };
            *ln_e += earlier.ln_e;
            multiplied += 1;
            if *ln_e >= limit {
                let (id, command) = (entry.id.clone(), entry.command.clone());
                drifts.push(Drift { id, check: check.clone(), ln_e: *ln_e, limit, command });
            }
        }
    }
    (drifts, multiplied)
}

/// The stored entries that the run has not drawn, of cases that it has not with another text.
fn not_drawn(stored: &Baseline, run: &Baseline) -> Vec<Entry> {
    let texts: BTreeMap<&str, &str> =
        run.entries.iter().map(|entry| (entry.id.experiment.case.as_str(), &*entry.case)).collect();
    let drawn: BTreeSet<&ChannelId> = run.entries.iter().map(|entry| &entry.id).collect();
    let kept = stored.entries.iter().filter(|entry| {
        let text = texts.get(entry.id.experiment.case.as_str());
        !drawn.contains(&entry.id) && text.is_none_or(|text| *text == entry.case)
    });
    kept.cloned().collect()
}

/// What of two entries can be compared: the quantity, then and now.
fn questions<'e>(before: &Entry, now: &'e Entry) -> Vec<Question<'e>> {
    if !is_comparable(before, now) {
        return Vec::new();
    }
    let is_sharp = before.is_sharp() && now.is_sharp();
    let variance = before.variance().zip(now.variance()).filter(|_| is_sharp);
    let lookups = before.lookups().zip(now.lookups());
    let both = [(Quantity::Variance, variance), (Quantity::Lookups, lookups)];
    both.into_iter().filter_map(|(quantity, both)| Some((now, quantity, both?))).collect()
}

/// An entry, the quantity that is compared, its values then and now.
type Question<'e> = (&'e Entry, Quantity, (Relative, Relative));

/// What changed by more than its error, if anything.
fn answer(&(entry, quantity, (before, now)): &Question, z: f64) -> Option<Change> {
    let ratio = now.0 / before.0;
    let error = z * before.1.hypot(now.1) + ROUNDING;
    let measured = |(value, error): Relative| Measured { value, error: Some(value * error) };
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

/// A time that changed by more than the tolerance, in either direction.
fn time_change(entry: &Entry, [before, now]: [f64; 2], tolerance: f64) -> Option<Change> {
    let ratio = now / before;
    let is_regression = ratio > 1.0 + tolerance;
    (is_regression || ratio * (1.0 + tolerance) < 1.0).then(|| Change {
        id: entry.id.clone(),
        quantity: Quantity::Time,
        before: Measured { value: before, error: None },
        now: Measured { value: now, error: None },
        ratio,
        interval: None,
        is_regression,
        command: entry.command.clone(),
    })
}

/// Times below this are noise.
const SHORTEST: f64 = 0.1;
/// A value with its standard error, relative to it.
type Relative = (f64, f64);

impl Entry {
    fn variance(&self) -> Option<Relative> {
        let (n, kurtosis) = (self.draws as f64, self.kurtosis?);
        let variance = self.variance.filter(|&variance| variance > 0.0)?;
        Some((variance, variance_error(kurtosis, n)))
    }

    /// Whether the sample variance has a law that can be compared.
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
        let seconds = self.seconds.filter(|&seconds| seconds >= SHORTEST)?;
        Some(1e9 * seconds / self.drawn as f64)
    }
}

/// Whether both are of the same σ̂: not where it was learned from other pilot rays.
fn is_comparable(before: &Entry, now: &Entry) -> bool {
    !now.learns || before.seed == now.seed
}

/// What is left out of the experiments that both runs have, each stored and now.
fn left_out(pairs: &[(&Entry, &Entry)], rules: &Rules) -> LeftOut {
    let list = |is_out: &dyn Fn(&Entry, &Entry) -> bool| -> Vec<ChannelId> {
        let out = pairs.iter().filter(|(before, now)| is_out(before, now));
        out.map(|(_, now)| now.id.clone()).collect()
    };
    let of_one = |is_out: &dyn Fn(&Entry, &Entry) -> bool| {
        list(&|before, now| is_comparable(before, now) && is_out(before, now))
    };
    let timed = |is_out: &dyn Fn(&Entry, &Entry) -> bool| {
        list(&|before, now| rules.time_tolerance.is_some() && is_out(before, now))
    };
    LeftOut {
        relearned: list(&|before, now| !is_comparable(before, now)),
        blunt: of_one(&|before, now| {
            let has_both = before.variance().is_some() && now.variance().is_some();
            has_both && !(before.is_sharp() && now.is_sharp())
        }),
        unpredicted: of_one(&|before, now| {
            let varies = |entry: &Entry| entry.variance != Some(0.0);
            let has_both = before.variance().is_some() && now.variance().is_some();
            !has_both && (varies(before) || varies(now))
        }),
        uncounted: of_one(&|before, now| {
            let looks = |entry: &Entry| entry.lookups.is_some_and(|lookups| lookups > 0.0);
            let has_both = before.lookups().is_some() && now.lookups().is_some();
            !has_both && (looks(before) || looks(now))
        }),
        brief: timed(&|before, now| {
            let has_both = before.seconds.is_some() && now.seconds.is_some();
            has_both && (before.nanoseconds().is_none() || now.nanoseconds().is_none())
        }),
        // Times and lookups stand in the first entry of an experiment only.
        shared: timed(&|before, now| {
            let is_first = before.lookups.is_some() || now.lookups.is_some();
            is_first && (before.seconds.is_none() || now.seconds.is_none())
        }),
    }
}
