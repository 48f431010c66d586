//! Every case file of the repository can be read, planned and drawn, and its experiments do not fail.

use std::collections::BTreeSet;

use crate::common::{judged, none, options, shipped, shipped_plan, shipped_record};
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::case::suite;
use trueflight::record::Record;
use trueflight::record::Verdict;

#[test]
fn every_case_draws_and_none_is_refuted() {
    // A case that declares some experiment biased needs draws to show the bias.
    let biased = shipped_plan().experiments().filter(|(_, planned)| planned.expect_biased);
    let biased: BTreeSet<&str> = biased.map(|(case, _)| case.case.name.as_str()).collect();
    let (biased, fair): (Vec<Case>, Vec<Case>) =
        shipped().into_iter().partition(|case| biased.contains(case.name.as_str()));
    assert!(!fair.is_empty() && !biased.is_empty());
    let is_fair = |name: &str| fair.iter().any(|case| case.name == name);
    let mut wrong = refuted(shipped_record(), is_fair);
    // A bias that a case declares must show.
    wrong.extend(refuted(&judged(&biased, &options(1, 3_000_000)), |_| true));
    none(&wrong);
}

/// Returns the failures in cases of some names, and the experiments that were neither drawn nor refused.
fn refuted(record: &Record, is_wanted: impl Fn(&str) -> bool) -> Vec<String> {
    let mut wrong = Vec::new();
    for case in record.results.cases.iter().filter(|case| is_wanted(&case.name)) {
        for row in case.rows() {
            let drawn = row.mean.is_some_and(f64::is_finite);
            match row.verdict {
                Some(Verdict::Fail) => {
                    wrong.push(format!(
                        "{}, {}: {}",
                        case.name,
                        row.experiment.label,
                        row.reason()
                    ));
                }
                Some(Verdict::Refused) if !row.reason().is_empty() => {}
                Some(_) if drawn => {}
                other => wrong.push(format!("{}, {}: {other:?}", case.name, row.experiment.label)),
            }
        }
        let refused = case.rows().all(|row| row.verdict == Some(Verdict::Refused));
        if refused {
            wrong.push(format!("{}: every experiment is refused", case.name));
        }
    }
    wrong
}

#[test]
fn no_two_cases_or_experiments_share_a_name() {
    let cases = shipped();
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len(), "two case files have one name");
    let titles: BTreeSet<&str> = cases.iter().map(|case| case.title.as_str()).collect();
    assert_eq!(titles.len(), cases.len(), "two case files have one title");
    let mut addresses = BTreeSet::new();
    for (case, planned) in shipped_plan().experiments() {
        let is_new = addresses.insert(planned.address.experiment);
        assert!(is_new, "{}: two experiments share their random numbers", case.case.name);
    }
}

#[test]
fn the_built_in_suite_is_a_choice_of_the_case_files() {
    let files: BTreeSet<String> = shipped().into_iter().map(|case| case.name).collect();
    let built_in: BTreeSet<String> = suite::suite().into_iter().map(|source| source.name).collect();
    assert!(!built_in.is_empty());
    assert!(built_in.is_subset(&files), "{:?}", built_in.difference(&files));
}

#[test]
fn a_spec_is_written_as_the_case_that_it_was_read_from() {
    for case in shipped() {
        let text = toml::to_string(&case.spec).expect("TOML");
        let again = CaseText { text, ..case.spec.source().clone() };
        let again = Case::read(&again).unwrap_or_else(|error| panic!("{}", error.in_full()));
        let tree = |case: &Case| serde_json::to_value(&case.spec).expect("JSON");
        assert_eq!(tree(&again), tree(&case), "{}", case.name);
        assert_eq!(again.scenario.estimators(), case.scenario.estimators(), "{}", case.name);
    }
}
