//! `trueflight-lab stress`: the short form holds, has the same numbers on any number of threads, and fails if a bound is
//! broken.

use std::path::Path;

use lab::report::stress as page;
use lab::stress::{Effort, Measure, PAGES, Run, Stress, TrialRow, narrow};
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::report::layout::Pen;

/// Runs the short form on a number of threads.
fn short_form(threads: usize) -> Stress {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let run = Run { effort: Effort::Quick, seed: 1 };
    pool.install(|| lab::stress::all(run, &|_| {}))
}

/// Returns the bytes of a file of the result.
fn file(found: &Stress, name: &str) -> Vec<u8> {
    let mut files = page::artifacts(found).expect("renders").into_iter();
    let file = files.find(|file| file.path == Path::new("stress").join(name));
    file.unwrap_or_else(|| panic!("no {name}")).bytes
}

#[test]
fn every_bound_holds_in_the_short_form() {
    let found = short_form(3);
    let text = page::table(&found, Pen { width: 160, colour: false });
    assert!(found.holds() && text.contains("bounds hold"), "{text}");
    let [csv, json, ..] = FILES.map(|name| file(&found, name));
    let csv = String::from_utf8(csv).expect("text");
    assert!(csv.lines().count() > 3 * PAGES.values.len(), "{csv}");
    let json: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
    assert_eq!(json["holds"], true);
}

/// Files that the command writes.
const FILES: [&str; 4] =
    ["stress.csv", "stress.json", "single-precision.csv", "single-precision.svg"];

#[test]
fn numbers_do_not_depend_on_the_threads() {
    let found = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let few = PAGES
            .entries()
            .filter(|(page, _)| ["accumulators", "moments", "rods"].contains(&page.module));
        let run = Run { effort: Effort::Quick, seed: 1 };
        pool.install(|| few.map(|(_, rows)| rows(run)).collect::<Vec<_>>())
    };
    let one = found(1);
    assert_eq!(one.len(), 3);
    assert!(one == found(3));
}

#[test]
#[ignore = "long: the short form on one thread and on three, 60 s of a core"]
fn no_file_depends_on_the_threads() {
    let [one, three] = [1, 3].map(short_form);
    for name in FILES {
        assert!(file(&one, name) == file(&three, name), "{name} depends on the threads");
    }
    // The page has times, too.
    assert!(String::from_utf8_lossy(&file(&one, "report.html")).contains("bounds hold</h1>"));
}

#[test]
fn a_broken_bound_is_told_with_its_place() {
    let row = TrialRow::new("ln", "1 … 2", Measure::Relative, 1e-16);
    let row = TrialRow { trials: 1, worst: 3e-16, place: "x = 1.25".into(), ..row };
    let narrow = narrow::Narrow { curves: Vec::new() };
    let broken = Stress { rows: vec![row], narrow, seconds: 0.0 };
    assert!(!broken.holds());
    let text = page::table(&broken, Pen { width: 100, colour: false });
    assert!(text.contains("NO") && text.contains("x = 1.25") && text.contains("1 of 1"), "{text}");
}

#[test]
fn what_is_mostly_skipped_is_broken_and_says_where() {
    let row = TrialRow::new("ln", "1 … 2", Measure::Relative, 1e-16);
    let row = TrialRow { trials: 1, skipped: 2, first_skipped: "x = 1.5".into(), ..row };
    let narrow = narrow::Narrow { curves: Vec::new() };
    let broken = Stress { rows: vec![row], narrow, seconds: 0.0 };
    let text = page::table(&broken, Pen { width: 100, colour: false });
    assert!(!broken.holds() && text.contains("2 skipped, 1 compared"), "{text}");
    assert!(text.contains("x = 1.5"), "{text}");
}

#[test]
#[ignore = "long: thousands of parameters, 10 s of a core"]
fn rods_and_collision_sums_keep_their_stated_errors_over_thousands_of_parameters() {
    let long = PAGES.entries().filter(|(page, _)| ["rods", "collided"].contains(&page.module));
    let run = Run { effort: Effort::Full, seed: 3 };
    let rows: Vec<TrialRow> = long.flat_map(|(_, rows)| rows(run)).collect();
    let broken: Vec<&TrialRow> = rows.iter().filter(|row| !row.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    let solved = rows.iter().find(|row| row.quantity == "rod, two-stream equations");
    assert!(solved.expect("a row").trials > 4000, "{rows:#?}");
}

#[test]
fn weights_that_would_overflow_are_refused() {
    // r = 1000 in units of e^−690: three collisions pass 1e308.
    let text = "title = \"t\"\n[problem.transmittance]\nmedium.constant.extinction = 690\n\
                span = [0, 1]\nsampling.constant.value = 0.69\n\
                estimators = [{ ratio = {} }, { single.rule = \"clamped\" }, { weighted-delta = {} }]";
    let source = CaseText { name: "t".into(), path: "t.toml".into(), text: text.into() };
    let case = Case::read(&source).expect("read");
    let options = Options { draws: Amount::Exactly(1000), ..Options::default() };
    let plan = Plan::new(std::slice::from_ref(&case), &options);
    for (_, planned) in plan.experiments() {
        let refusal = planned.outcome.as_ref().err().expect("refused").to_string();
        assert!(refusal.contains("weights that stay below 1e304"), "{refusal}");
    }
}

#[test]
#[ignore = "long: the short form again, 30 s of a core"]
fn another_seed_holds_too() {
    let run = Run { effort: Effort::Quick, seed: 2 };
    let rows: Vec<TrialRow> = PAGES.values.iter().flat_map(|rows| rows(run)).collect();
    let broken: Vec<&TrialRow> = rows.iter().filter(|row| !row.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
}
