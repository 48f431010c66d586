//! Every known bug is caught by the check it names, on the experiment of the built-in suite that it
//! names, at the suite's levels and within its draws; its honest twin makes the estimator's own
//! draws and passes; and no check of the catalogue is without a bug that it catches.

use std::collections::BTreeSet;

use crate::common::{none, options};
use trueflight::harness::checks;
use trueflight::harness::{Case, Plan, suite};
use trueflight::mutants;
use trueflight::self_test::mutation;

#[test]
fn every_mutant_is_caught_and_its_twin_passes() {
    let mut wrong = Vec::new();
    for mutant in mutation::all(1).expect("the built-in cases can be read") {
        if mutant.draws.is_none() {
            let others = mutant.failed.join(", ");
            wrong.push(format!("{} escapes {}; failed: {others}", mutant.name, mutant.check));
        }
        if !mutant.twin_passes {
            wrong.push(format!("{}: the twin does not pass", mutant.name));
        }
    }
    none(&wrong);
}

#[test]
fn every_check_has_a_mutant_that_it_catches() {
    let named: BTreeSet<String> = mutation::named_checks().into_iter().map(str::to_owned).collect();
    let checks: BTreeSet<String> =
        checks::CATALOGUE.pages.iter().map(trueflight::catalogue::Page::name).collect();
    assert_eq!(named, checks);
}

#[test]
fn mutants_stand_where_they_say() {
    let mut wrong = Vec::new();
    for about in mutants::all() {
        let target = about.target;
        let source = suite::find(target.case).expect("a built-in case");
        let case = Case::read(&source).expect("a case");
        let plan = Plan::new(std::slice::from_ref(&case), &options(1, 2));
        let found = trueflight::harness::mutation::find(&target, &plan);
        let name = found.map(|(_, planned)| planned.names.estimator.clone());
        if name.as_deref() != Some(target.estimator) {
            wrong.push(format!("{}: {name:?} is not {}", about.name, target.estimator));
        }
    }
    none(&wrong);
}
