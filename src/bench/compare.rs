//! A bench against a stored one.
//!
//! A time per draw has changed if the rounds of both sides do not overlap and the ratio of the
//! medians is beyond the tolerance. Two benches were timed apart, and what else the machine did
//! differs; the speedup over the plain loop, timed in turn with it, is told beside the time: where
//! it stayed, the plain loop became slower as well.

use std::collections::{BTreeMap, BTreeSet};

use super::comparison::{Change, Comparison};
use super::stored::{Stored, Timed};

/// Compares a bench with the stored one called `name`.
pub fn compare(name: &str, stored: &Stored, now: &Stored, tolerance: f64) -> Comparison {
    let before: BTreeMap<&str, &Timed> =
        stored.timed.iter().map(|timed| (timed.id.as_str(), timed)).collect();
    let ids: BTreeSet<&str> = now.timed.iter().map(|timed| timed.id.as_str()).collect();
    let mut found = Comparison {
        name: name.to_owned(),
        tolerance,
        compared: 0,
        changes: Vec::new(),
        added: Vec::new(),
        missing: Vec::new(),
        rewritten: Vec::new(),
        levels: (stored.level != now.level).then(|| [stored.level.clone(), now.level.clone()]),
    };
    for timed in &now.timed {
        match before.get(timed.id.as_str()) {
            None => found.added.push(timed.id.clone()),
            Some(stored) if stored.case != timed.case => found.rewritten.push(timed.id.clone()),
            Some(stored) => {
                found.compared += 1;
                found.changes.extend(change(stored, timed, tolerance));
            }
        }
    }
    let missing = stored.timed.iter().filter(|timed| !ids.contains(timed.id.as_str()));
    found.missing = missing.map(|timed| timed.id.clone()).collect();
    found
}

/// A change beyond both sides' rounds and the tolerance.
fn change(stored: &Timed, now: &Timed, tolerance: f64) -> Option<Change> {
    let (before, after) = (stored.ns_per_draw, now.ns_per_draw);
    let ratio = after.median / before.median;
    let is_regression = after.least > before.most && ratio > 1.0 + tolerance;
    let is_improvement = after.most < before.least && ratio * (1.0 + tolerance) < 1.0;
    (is_regression || is_improvement).then(|| Change {
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
    use crate::bench::clock::Clock;
    use crate::bench::spread::Spread;

    fn stored(times: &[(&str, [f64; 3])]) -> Stored {
        let timed = times.iter().map(|&(id, rounds)| Timed {
            id: id.to_owned(),
            case: "text".to_owned(),
            ns_per_draw: Spread::of(rounds).expect("rounds"),
            speedup: Spread::of([4.0]).expect("rounds"),
        });
        Stored {
            schema: 1,
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
        let found = compare("main", &before, &later, 0.25);
        assert!(found.fails());
        let told: Vec<_> = found.changes.iter().map(|c| (c.ratio, c.is_regression)).collect();
        assert_eq!(told, [(2.0, true), (0.5, false)]);
        assert_eq!((found.added, found.missing), (vec!["new".to_owned()], vec!["old".to_owned()]));
        "another".clone_into(&mut later.timed[0].case);
        let found = compare("main", &before, &later, 0.25);
        assert!(!found.fails() && found.rewritten == ["a"] && !found.is_empty());
        let other = stored(&[("other", [1.0; 3])]);
        assert!(compare("main", &before, &other, 0.25).is_empty());
    }
}
