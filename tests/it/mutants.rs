//! Every known bug is caught by the check it names, on the experiment of the built-in suite that it names, at the
//! suite's levels and within its draws. Its control makes the estimator's own draws and passes. Every check of the
//! catalogue catches at least one bug.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::none;
use lab::mutants::{self, About, streams};
use lab::self_test::mutation;
use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::gate::CheckId;

/// Lists the faults of the mutants of some names.
fn escaped(is_wanted: &dyn Fn(&str) -> bool) -> Vec<String> {
    let mut wrong = Vec::new();
    for mutant in mutation::of(1, is_wanted).expect("the built-in cases can be read") {
        if mutant.draws.is_none() {
            let others = &mutant.failed;
            wrong.push(format!("{} escapes {}; failed: {others:?}", mutant.name, mutant.check));
        }
        if !mutant.twin_passes {
            wrong.push(format!("{}: the twin does not pass", mutant.name));
        }
    }
    wrong
}

#[test]
#[ignore = "long: 100 mutants and their twins, 40 s of two cores"]
fn every_mutant_is_caught_and_its_twin_passes() {
    none(&escaped(&|_| true));
}

#[test]
fn a_mutant_of_every_check_is_caught_and_its_twin_passes() {
    let estimators = mutants::all().into_iter().map(|about| (about.check, about.name));
    let of_streams = streams::MUTANTS.iter().map(|mutant| (mutant.check, mutant.name));
    let mut one_of_each = BTreeMap::new();
    for (check, name) in estimators.chain(of_streams) {
        one_of_each.entry(check).or_insert(name);
    }
    none(&escaped(&|name| one_of_each.values().any(|chosen| *chosen == name)));
}

#[test]
fn every_check_has_a_mutant_that_it_catches() {
    assert_eq!(mutants::named_checks(), CheckId::ALL);
}

#[test]
fn no_two_mutants_share_a_name() {
    let mut names: Vec<&str> = mutants::all().iter().map(|about| about.name).collect();
    names.extend(streams::MUTANTS.iter().map(|mutant| mutant.name));
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
    assert!(mutants::all().len() >= 45 && streams::MUTANTS.len() >= 5);
}

#[test]
fn mutants_stand_where_they_say() {
    let mut by_case: BTreeMap<&str, Vec<About>> = BTreeMap::new();
    for about in mutants::all() {
        by_case.entry(about.target.case).or_default().push(about);
    }
    for (case, abouts) in by_case {
        let source = suite::find(case).expect("a built-in case");
        let case = Case::read(&source).expect("a case");
        for About { name, target, .. } in abouts {
            let variation = target.swept.map(|value| {
                let axis = case.sweep.as_ref().expect("a sweep");
                assert!(axis.values.contains(&value), "{name}: {value} is not swept");
                (axis.what, value)
            });
            assert_eq!(case.id(target.index, variation).case, target.case, "{name}");
        }
    }
}
