//! What of two entries can be compared, and what is left out.

use super::stored::Entry;
use crate::checks::normality::{Tails, variance_error};
use crate::record::comparison::{LeftOut, Rules};

/// Times below this are noise.
const SHORTEST: f64 = 0.1;
/// A value with its standard error, relative to it.
pub(super) type Measured = (f64, f64);

impl Entry {
    pub(super) fn variance(&self) -> Option<Measured> {
        let (n, kurtosis) = (self.draws as f64, self.kurtosis?);
        let variance = self.variance.filter(|&variance| variance > 0.0)?;
        Some((variance, variance_error(kurtosis, n)))
    }

    /// Whether the sample variance has a law that can be compared.
    pub(super) fn is_sharp(&self) -> bool {
        self.variance().is_some()
            && Tails {
                kurtosis: self.kurtosis,
                eighth_moment_ratio: self.eighth_moment_ratio,
                rare_event_size: self.rare_event_size,
            }
            .has_normal_variance(self.draws as f64)
    }

    pub(super) fn lookups(&self) -> Option<Measured> {
        let lookups = self.lookups.filter(|&lookups| lookups > 0.0)?;
        Some((lookups, (self.lookups_variance? / self.draws as f64).sqrt() / lookups))
    }

    pub(super) fn nanoseconds(&self) -> Option<f64> {
        let seconds = self.seconds.filter(|&seconds| seconds >= SHORTEST)?;
        Some(1e9 * seconds / self.drawn as f64)
    }
}

/// Whether both are of the same σ̂: not where it was learned from other pilot rays.
pub(super) fn is_comparable(before: &Entry, now: &Entry) -> bool {
    !now.learns || before.seed == now.seed
}

/// What is left out of the experiments that both runs have, each stored and now.
pub(super) fn left_out(pairs: &[(&Entry, &Entry)], rules: &Rules) -> LeftOut {
    let list = |is_out: &dyn Fn(&Entry, &Entry) -> bool| -> Vec<String> {
        let out = pairs.iter().filter(|(before, now)| is_out(before, now));
        out.map(|(_, now)| now.id.clone()).collect()
    };
    let of_one = |is_out: &dyn Fn(&Entry, &Entry) -> bool| {
        list(&|before, now| is_comparable(before, now) && is_out(before, now))
    };
    let timed = |is_out: &dyn Fn(&Entry, &Entry) -> bool| {
        list(&|before, now| rules.asks_for_times() && is_out(before, now))
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
