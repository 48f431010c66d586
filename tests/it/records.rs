//! Identities of experiments, and records in files: of this version and of version 1.

use std::collections::BTreeSet;

use crate::common::{case, judged, none, options, shipped_plan};
use trueflight::record::{Record, build};
use trueflight::report::run::{html, record_json, summary_csv};

/// Record of version 1, and the table that the same program wrote.
const OLD: (&[u8], &str) =
    (include_bytes!("../data/record-1.json"), include_str!("../data/record-1.csv"));

fn old() -> Record {
    record_json::read(OLD.0).expect("a record of version 1 is read")
}

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

#[test]
fn a_record_of_version_1_has_the_same_table() {
    let table = summary_csv::csv(&old()).expect("a table");
    for (found, expected) in table.lines().zip(OLD.1.lines()) {
        assert_eq!(found, expected);
    }
    assert_eq!(table.lines().count(), OLD.1.lines().count());
}

#[test]
fn a_record_of_version_1_becomes_a_tree() {
    let record = old();
    let shape: Vec<Vec<usize>> = record
        .results
        .cases
        .iter()
        .map(|case| case.experiments.iter().map(|one| one.channels.len()).collect())
        .collect();
    assert_eq!(shape, [vec![1; 6], vec![2]]);
    let texts: Vec<String> = record.results.cases[0]
        .experiments
        .iter()
        .map(|experiment| experiment.id.to_string())
        .collect();
    let expected = [
        "old:woodcock, sampling 0.6",
        "old:woodcock, sampling 1.5",
        "old:ratio, σ\u{302} 1",
        "old:ratio #2, σ\u{302} 1",
        "old:residual-ratio, control constant 0.3, sampling 0.6",
        "old:residual-ratio, control constant 0.3, sampling 1.5",
    ];
    assert_eq!(texts, expected);
    // Findings about the whole experiment are stored once, those of a channel with the channel.
    let walk = &record.results.cases[1].experiments[0];
    let mut findings = BTreeSet::new();
    for found in &walk.findings {
        let key = (&found.check, &found.what, &found.channel);
        assert!(findings.insert(key), "{key:?} stands twice");
    }
    assert!(walk.findings.iter().any(|found| found.channel == "transmittance"));
    assert!(walk.spent.seconds.is_some_and(|seconds| seconds > 0.0));
    let comparison = record.comparison.as_ref().expect("a comparison");
    let timed = &comparison.left_out.brief;
    assert_eq!(timed[0].to_string(), "old:woodcock, sampling 1.5");
    assert_eq!(comparison.added[0].channel, "reflectance");
    assert!(html::text(&record).expect("a page").contains("residual-ratio"));
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
    assert_comes_back(&old());
    let text = "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 1\nspan = [0, 2]\n\
                sweep.sampling = [0.4, 4]\nestimators = [{ ratio = {} }, { woodcock = {} }]";
    let record = judged(&[case("test", text)], &options(1, 40_000));
    assert_comes_back(&record);
    let later =
        record_json::text(&record).expect("JSON").replacen("\"schema\":2", "\"schema\":3", 1);
    let error = record_json::read(later.as_bytes()).expect_err("another form").to_string();
    assert_eq!(error, "a record of form 3, this program reads 1 and 2");
}
