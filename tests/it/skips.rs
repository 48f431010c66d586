//! Work that a scene does not need is skipped, and no number changes by it.

use std::path::{Path, PathBuf};

use crate::common::{case, options};
use trueflight::case::Case;
use trueflight::draw::block;
use trueflight::draw::run;
use trueflight::draw::store::{Header, Store};
use trueflight::estimators::DrawBuffer;
use trueflight::plan::Plan;
use trueflight::record::Verdict;
use trueflight::record::build;

/// Returns the first draws of the first experiment of a case, from the same streams for any name.
fn first_draws(text: &str) -> (DrawBuffer, f64) {
    let cases = [case("skips", text)];
    let plan = Plan::new(&cases, &options(1, 4096));
    let planned = &plan.cases[0].experiments[0];
    let ready = planned.outcome.as_ref().expect("not refused");
    let streams = plan.cases[0].experiments[0].address;
    let mut streams = trueflight::rng::Address { experiment: 7, ..streams }.streams();
    let mut buffer = DrawBuffer::new(1);
    ready.experiment.fill(&mut streams, 4096, &mut buffer);
    (buffer, ready.experiment.skipped())
}

fn assert_same(a: &DrawBuffer, b: &DrawBuffer) {
    assert_eq!(a.values, b.values);
    assert_eq!(a.lookups, b.lookups);
}

const GAP: &str = "medium.piecewise-constant = { breaks = [0, 1, 3, 4], values = [0.5, 0, 1.5] }
    span = [0, 4]";

fn problem(medium: &str, estimator: &str) -> String {
    format!("title = \"t\"\n[problem.transmittance]\n{medium}\nestimators = [{estimator}]\n")
}

#[test]
fn a_gap_is_flown_over_as_if_sampling_were_zero_there() {
    for (name, settings) in [("ratio", ""), ("woodcock", ""), ("single", "rule = \"clamped\", ")] {
        let entry = |sampling: &str| format!("{{ {name} = {{ {settings}{sampling} }} }}");
        let constant = entry("sampling.constant = { value = 2 }");
        let zero =
            entry("sampling.piecewise-constant = { breaks = [0, 1, 3, 4], values = [2, 0, 2] }");
        let (skipping, skipped) = first_draws(&problem(GAP, &constant));
        let (explicit, nothing) = first_draws(&problem(GAP, &zero));
        assert_eq!((skipped, nothing), (0.5, 0.0), "{name}");
        assert_same(&skipping, &explicit);
    }
}

#[test]
fn a_ray_is_clipped_to_where_the_field_begins_and_ends() {
    let wide = "medium.piecewise-linear = { knots = [0, 2, 2.5, 3, 9], values = [0, 0, 1, 0, 0] }
        span = [0, 9]";
    let narrow = "medium.piecewise-linear = { knots = [2, 2.5, 3], values = [0, 1, 0] }
        span = [2, 3]";
    let ratio = "{ ratio = { sampling.constant = { value = 1.5 } } }";
    let (clipped, skipped) = first_draws(&problem(wide, ratio));
    let (whole, nothing) = first_draws(&problem(narrow, ratio));
    assert!((skipped - 8.0 / 9.0).abs() < 1e-15 && nothing == 0.0);
    assert_same(&clipped, &whole);
}

#[test]
fn a_short_gap_is_not_worth_a_piece() {
    let medium = "medium.piecewise-constant = { breaks = [0, 1, 1.01, 4], values = [0.5, 0, 1.5] }
        span = [0, 4]";
    let ratio = "{ ratio = { sampling.constant = { value = 2 } } }";
    assert_eq!(first_draws(&problem(medium, ratio)).1, 0.0);
}

#[test]
fn estimators_that_use_sampling_for_more_than_collisions_keep_it() {
    let next_flight = "{ next-flight = { sampling.constant = { value = 2 } } }";
    assert_eq!(first_draws(&problem(GAP, next_flight)).1, 0.0);
}

#[test]
fn a_residual_of_zero_is_answered_without_collisions() {
    let text = problem(
        "volume.eq21 = {}
        ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20.0 }",
        "{ double = { control.field.volume.eq21 = {}, sampling.constant = { value = 1 } } }",
    );
    let cases = [case("zero", &text)];
    let plan = Plan::new(&cases, &options(1, 1_000_000));
    let record = build::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
    let row = record.results.cases[0].rows().collect::<Vec<_>>()[0];
    assert_eq!(
        (row.experiment.skipped, row.experiment.draws, row.experiment.drawn),
        (Some(1.0), Some(8), Some(8))
    );
    assert_eq!((row.experiment.lookups_per_draw, row.variance), (Some(0.0), Some(0.0)));
    assert!((row.mean.expect("drawn") / row.truth.expect("known") - 1.0).abs() < 1e-14);
    assert_eq!(row.verdict.map(Verdict::word), Some("pass"));
}

fn cases(title: &str) -> [Case; 1] {
    let text = "[problem.transmittance]
        medium.piecewise-constant = { breaks = [0, 1, 3], values = [0.5, 1.2] }
        span = [0, 3]
        sampling.constant = { value = 1.5 }
        estimators = [{ ratio = {} }, { woodcock = {} }]";
    [case("kept", &format!("title = \"{title}\"\n{text}"))]
}

/// Returns a store of the draws of a plan by a program, with the finished experiments of a file.
fn store(plan: &Plan, program: &str, path: &Path) -> Store {
    let mut store = Store::new(Header::new(plan, program, &[], None));
    store.reuse(path, false).expect("it can be read");
    store
}

fn path() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("draws.bin");
    (folder, path)
}

#[test]
fn what_has_not_changed_is_reused_and_no_number_changes() {
    let (cases, options, (_folder, path)) = (cases("t"), options(3, 200_000), path());
    let plan = Plan::new(&cases, &options);
    let empty = store(&plan, "program", &path);
    assert_eq!(empty.reusable(&plan), [0, 2]);
    let first = run::draw_with(&plan, &empty, &|_| {});
    empty.finish(&path, &first).expect("written");
    let read = store(&plan, "program", &path);
    assert_eq!(read.reusable(&plan), [2, 2]);
    let second = run::draw_with(&plan, &read, &|step| {
        assert!(!matches!(step, run::Step::Drawn(1..)), "nothing is drawn");
    });
    assert!(second.experiments.iter().all(|one| one.drawn.is_reused));
    let json = |draws| {
        let record = build::judged(&plan, draws, 0.0);
        serde_json::to_string(&record.results).expect("encodes")
    };
    assert_eq!(json(&first), json(&second));
}

#[test]
fn what_has_changed_is_drawn_anew() {
    let (same, other, (_folder, path)) = (cases("t"), cases("another"), path());
    let options = options(3, 200_000);
    let plan = Plan::new(&same, &options);
    let kept = store(&plan, "program", &path);
    kept.finish(&path, &run::draw(&plan, &|_| {})).expect("written");
    let bytes = std::fs::read(&path).expect("a file");
    assert_eq!(store(&plan, "program", &path).reusable(&plan), [2, 2]);
    assert_eq!(store(&plan, "another program", &path).reusable(&plan), [0, 2]);
    let others = Plan::new(&other, &options);
    assert_eq!(store(&others, "program", &path).reusable(&others), [0, 2]);
    for changed in [
        trueflight::plan::Options { seed: 4, ..options.clone() },
        trueflight::plan::Options { alpha: 1e-5, ..options.clone() },
        trueflight::plan::Options { fixed: true, ..options.clone() },
        crate::common::options(3, 300_000),
    ] {
        let changed = Plan::new(&same, &changed);
        assert_eq!(store(&changed, "program", &path).reusable(&changed)[0], 0);
    }
    let mut spoilt = bytes.clone();
    spoilt[100] ^= 1;
    for damaged in [&bytes[..bytes.len() - 1], &[], &spoilt] {
        std::fs::write(&path, damaged).expect("a file");
        assert_eq!(store(&plan, "program", &path).reusable(&plan), [0, 2]);
    }
}

#[test]
fn draws_that_a_limit_cut_short_are_not_kept() {
    let (cases, options, (_folder, path)) = (cases("t"), options(3, 200_000), path());
    let plan = Plan::new(&cases, &options);
    let kept = store(&plan, "program", &path);
    let cut = block::Draws { cut_by_time: true, ..run::draw(&plan, &|_| {}) };
    kept.finish(&path, &cut).expect("written");
    assert_eq!(store(&plan, "program", &path).reusable(&plan), [0, 2]);
}
