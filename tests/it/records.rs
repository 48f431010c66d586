//! Identities of experiments, and records in files.

use std::collections::BTreeSet;

use crate::common::{case, judged, none, options, shipped_plan};
use trueflight::record::{Record, build};
use trueflight::report::run::{record_json, summary_csv};

#[test]
fn identities_texts_and_names_of_experiments_are_distinct() {
    let record = build::predicted(shipped_plan());
    let (mut ids, mut texts) = (BTreeSet::new(), BTreeSet::new());
    let mut wrong = Vec::new();
    for case in &record.results.cases {
        let mut names = BTreeSet::new();
        for experiment in &case.experiments {
            let (id, name) = (&experiment.id, &experiment.name);
            if !ids.insert(id) || !texts.insert(id.to_string()) || !names.insert(name) {
                wrong.push(format!("{id}, named {name}"));
            }
        }
    }
    assert!(ids.len() > 1000, "{}", ids.len());
    none(&wrong);
}

/// Asserts that a record is the same after it is written and read.
fn assert_comes_back(record: &Record) {
    let text = record_json::text(record).expect("JSON");
    let read = record_json::read(text.as_bytes()).expect("a record");
    assert!(record_json::text(&read).expect("JSON") == text, "it came back otherwise");
    let table = |record| summary_csv::csv(record).expect("a table");
    assert_eq!(table(&read), table(record));
}

#[test]
fn records_come_back_from_their_files() {
    let text = "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 1\nspan = [0, 2]\n\
                sweep.sampling = [0.4, 4]\nestimators = [{ ratio = {} }, { woodcock = {} }]";
    let record = judged(&[case("test", text)], &options(1, 40_000));
    assert_comes_back(&record);
    let later =
        record_json::text(&record).expect("JSON").replacen("\"schema\":1", "\"schema\":2", 1);
    let error = record_json::read(later.as_bytes()).expect_err("another form").to_string();
    assert_eq!(error, "a record of form 2, this program reads 1");
}
