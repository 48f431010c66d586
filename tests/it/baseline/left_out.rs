//! Quantities that a comparison leaves out, and comparisons of nothing.

use serde_json::Value;
use tempfile::TempDir;
use trueflight::record::baseline::LeftOut;
use trueflight::record::baseline::{Baseline, BaselineEntry, ChannelId};
use trueflight::record::baseline::{ComparisonLevels, compare};
use trueflight::report::run::diff;

use super::{CASE, RULES, baseline, said, usual};
use crate::common::place::Place;

/// Change that spoils an entry.
type Doctor = fn(&mut BaselineEntry);
/// List of entries that are left out for that reason.
type List = fn(&LeftOut) -> &Vec<ChannelId>;

#[test]
fn a_comparison_of_nothing_is_an_error() {
    let place = Place::new(&[("case.toml", CASE)]);
    said(&place, &usual("--save-baseline main --filter *:woodcock"), 0);
    let stored = std::fs::read(place.path().join("baselines/main.json")).expect("a file");
    let text = said(&place, &usual("--baseline main --save-baseline main --filter *:ratio"), 2);
    let place_of_file = "baselines/main.json: nothing was compared: not in the baseline (1); only in the baseline (1)";
    for words in [place_of_file, "--save-baseline", "not stored: nothing was compared"] {
        assert!(text.contains(words), "{words}: {text}");
    }
    assert!(!text.contains("no change"), "{text}");
    assert_eq!(std::fs::read(place.path().join("baselines/main.json")).expect("a file"), stored);
    let reports = "--junit junit.xml --markdown summary.md --record record.json";
    let check = "check case.toml --filter *:ratio --draws 400000 --alpha 1e-6 --baseline main";
    said(&place, &format!("{check} {reports}"), 2);
    for file in ["junit.xml", "summary.md"] {
        let text = std::fs::read_to_string(place.path().join(file)).expect("a report");
        assert!(text.contains("nothing was compared"), "{file}: {text}");
        assert!(!text.contains("nothing became worse") && !text.contains("no change"), "{text}");
    }
    let record: Value =
        serde_json::from_slice(&std::fs::read(place.path().join("record.json")).expect("a report"))
            .expect("JSON");
    let ids = |list: &str| record["comparison"][list].as_array().expect("a list").len();
    assert_eq!((ids("added"), ids("missing")), (1, 1));
    // Another text of the case.
    std::fs::write(place.path().join("case.toml"), CASE.replace("a case", "another"))
        .expect("a case");
    let text = said(&place, &usual("--baseline main --filter *:woodcock"), 2);
    assert!(
        text.contains("nothing was compared: not compared, the case was rewritten (1)"),
        "{text}"
    );
}

#[test]
fn times_that_were_asked_for_and_not_compared_are_an_error() {
    let place = Place::new(&[("case.toml", CASE)]);
    let run = "run case.toml --draws 400000 --fixed-draws --alpha 1e-6";
    said(&place, &format!("{run} --save-baseline main"), 0);
    let path = place.path().join("baselines/main.json");
    let mut tree: Value =
        serde_json::from_slice(&std::fs::read(&path).expect("a file")).expect("JSON");
    for entry in tree["entries"].as_array_mut().expect("a list") {
        entry["seconds"] = 0.01.into();
    }
    std::fs::write(&path, tree.to_string()).expect("written");
    let text = said(&place, &format!("{run} --baseline main"), 0);
    assert!(
        text.contains("time not compared, less than 0.1 s (2): case:woodcock, σ\u{302} 1"),
        "{text}"
    );
    assert!(text.contains("4 variances and lookups compared"), "{text}");
    assert!(text.contains("0 times at a tolerance of 0.25"), "{text}");
    let text = said(&place, &format!("{run} --baseline main --time-tolerance 0.5"), 2);
    assert!(
        text.contains(
            "--time-tolerance 0.5: no time was compared: time not compared, less than 0.1 s (2)"
        ),
        "{text}"
    );
}

#[test]
fn what_is_left_out_is_said_with_its_reason() {
    let (mut stored, mut run) = (baseline(1), baseline(2));
    let rules = ComparisonLevels { time_tolerance: Some(0.25), ..RULES };
    for entry in stored.entries.iter_mut().chain(&mut run.entries) {
        entry.seconds = Some(1.0);
    }
    let left = |stored: &Baseline, run: &Baseline| compare("main", stored, run, &rules).0;
    let all = left(&stored, &run);
    assert_eq!((all.compared, all.times, &all.left_out), (4, 2, &LeftOut::default()));
    assert!(all.multiplied > 0 && !all.is_empty());
    let id = stored.entries[0].id.clone();
    let doctors: [(Doctor, List, &str, [usize; 2]); 5] = [
        (|entry| entry.kurtosis = None, |out| &out.unpredicted, "no error of it", [3, 2]),
        (|entry| entry.eighth_moment_ratio = None, |out| &out.blunt, "too heavy a tail", [3, 2]),
        (|entry| entry.lookups_variance = None, |out| &out.uncounted, "no error of them", [3, 2]),
        (|entry| entry.seconds = Some(0.09), |out| &out.brief, "less than 0.1 s", [4, 1]),
        (|entry| entry.learns = true, |out| &out.relearned, "pilot draws", [2, 2]),
    ];
    for (doctor, list, words, counts) in doctors {
        let honest = run.entries[0].clone();
        doctor(&mut run.entries[0]);
        let found = left(&stored, &run);
        assert_eq!([found.compared, found.times], counts, "{words}");
        assert_eq!(list(&found.left_out), std::slice::from_ref(&id), "{words}");
        let remarks = diff::remarks(&found);
        let said =
            |remark: &String| remark.contains(words) && remark.ends_with(&format!("(1): {id}"));
        assert!(remarks.iter().any(said), "{words}: {remarks:?}");
        run.entries[0] = honest;
    }
    // Only e-values are compared.
    for entry in &mut run.entries {
        (entry.kurtosis, entry.lookups_variance, entry.seconds) = (None, None, None);
    }
    assert!(!left(&stored, &run).is_empty());
    run.executable = "another".into();
    assert!(left(&stored, &run).is_empty());
}

#[test]
fn a_file_of_another_kind_says_what_it_is() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("main.json");
    for (text, kind) in [
        ("{\"schema\": 1, \"timed\": []}", "a stored bench"),
        ("{\"schema\": 1, \"results\": {}}", "the record of a run"),
    ] {
        std::fs::write(&path, text).expect("written");
        let error = Baseline::read(&path).expect_err("an error").to_string();
        assert!(error.contains(kind) && error.contains("--save-baseline"), "{error}");
    }
}
