//! `trueflight advise`: rows that theory confirms, lines that reproduce them, rays, costs that are kept, and the command.

mod map;
mod profile;
mod promise;

use std::path::PathBuf;

use crate::common::place::{Place, assert_says};
use crate::common::{case, differs, failing, none, rows, source};
use trueflight::advise::{Advice, AdviceRequest, CURVES, Costs, Group, Row, Target, advise};
use trueflight::case::Spec;
use trueflight::case::sweep::SweptQuantity;
use trueflight::catalogue::own_pages;
use trueflight::theory::prediction::search::PlaceKind;

const LINE: &str = "title = \"a line\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\nspan = [0, 4]\n";
pub(super) const SINES: &str = "title = \"waves\"\n[problem.transmittance]\n\
    medium.sines = { base = 1.0, amplitudes = [0.7], frequencies = [3] }\nspan = [0, 4]\n";
const GRID: &str = "title = \"a grid\"\n[problem.transmittance]\nvolume.grid = { random = { size = [8, 8, 8] }, \
    bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }\n";
pub(super) const ANY: &str = "estimators = [\"ratio\"]\nsampling = 1\n";

pub(super) fn asked(text: &str, request: &AdviceRequest) -> Advice {
    let spec = Spec::parse(&source("advised", text), &own_pages::NONE).expect("TOML");
    advise(&spec, request).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

pub(super) fn request(costs: Costs) -> AdviceRequest {
    AdviceRequest {
        target: Target::Error(0.01),
        costs,
        rays: None,
        seed: 1,
        looseness: 1.0,
        curves: true,
    }
}

fn row<'a>(advice: &'a Advice, estimator: &str) -> &'a Row {
    let row = advice
        .rows
        .iter()
        .find(|row| row.estimator.starts_with(estimator) && row.constant.is_some());
    row.unwrap_or_else(|| panic!("no {estimator}"))
}

#[test]
fn a_homogeneous_line_has_the_best_rows_of_closed_forms() {
    let advice = asked(&format!("{LINE}{ANY}"), &request(Costs::Lookups));
    let t = (-2f64).exp();
    // Woodcock tracking at σ̂ = σ_t: V = T(1 − T), and a walk looks up once unless it escapes.
    let woodcock = row(&advice, "woodcock");
    let work = (1.0 - t) / t * (1.0 - t) * 1e4;
    none(&differs("woodcock", woodcock.time, work, 1e-9).into_iter().collect::<Vec<_>>());
    assert_eq!((woodcock.constant, woodcock.minimum.map(|x| x > 0.49)), (Some(0.5), Some(true)));
    // Ratio tracking falls towards τ² for each lookup.
    let ratio = row(&advice, "ratio");
    assert_eq!(ratio.kind, PlaceKind::NearLimit);
    let over = ratio.time / (4.0 * 1e4);
    assert!((1.049..1.0501).contains(&over), "{over}");
    assert_eq!(ratio.minimum, Some(0.0));
    // Regular tracking is exact with one lookup; the closed form needs τ.
    let regular = advice.rows.iter().find(|row| row.estimator == "regular").expect("a row");
    assert_eq!((regular.group, regular.time, regular.score.deviation()), (Group::Ranked, 1.0, 0.0));
    let closed = advice.rows.iter().find(|row| row.estimator == "closed-form").expect("a row");
    assert_eq!((closed.group, &*closed.needs), (Group::Informed, "τ"));
    // The best σ̂(t) of a homogeneous medium is constant where every collision has a weight.
    let profile = &advice.profiles[0];
    assert!((profile.over_constant - 1.0).abs() < 2e-3, "{}", profile.over_constant);
    assert!(profile.values.iter().all(|&value| value == profile.values[0]));
}

#[test]
fn lines_for_a_case_reproduce_the_rows_and_their_draws_pass() {
    let advice =
        asked(&format!("{SINES}{ANY}"), &request(Costs::Given { draw: 5e-8, lookup: 1e-8 }));
    assert!(advice.rows.len() > 15, "{} rows", advice.rows.len());
    let mut wrong = Vec::new();
    // Pilot rays of a case have other random numbers.
    let is_random = |row: &&Row| row.needs == "pilot rays";
    assert_eq!(advice.rows.iter().filter(is_random).count(), 3);
    for row in advice.rows.iter().filter(|row| !is_random(row)) {
        let found = crate::common::predicted(&format!("{SINES}{}", row.lines));
        let [found] = &found[..] else { panic!("one row of {}", row.lines) };
        let truth = found.truth.expect("a truth");
        let deviation = found.predicted_variance.expect("a variance").sqrt() / truth;
        let lookups = found.experiment.predicted_lookups.expect("lookups");
        wrong.extend(differs(&row.lines, row.score.deviation(), deviation, 1e-9));
        wrong.extend(differs(&row.lines, row.score.lookups, lookups, 1e-9));
        let cost = 5e-8 + 1e-8 * (lookups + row.score.setup_lookups);
        wrong.extend(differs(&row.lines, row.score.cost, cost, 1e-9));
        wrong.extend(differs(
            &row.lines,
            row.time,
            (deviation / 0.01).powi(2).max(1.0) * cost,
            1e-9,
        ));
    }
    none(&wrong);
    let best = advice.best().expect("advice");
    none(&failing(&rows(&format!("{SINES}{}", best.lines), 400_000)));
    // No other σ̂ is better, or by 5 % where V·cost falls towards a limit.
    let shown: Vec<&Row> = advice.rows.iter().filter(|row| !row.curve.is_empty()).collect();
    assert_eq!(shown.len(), CURVES);
    for row in shown {
        let least = row.curve.iter().map(|[_, y]| *y).fold(f64::INFINITY, f64::min);
        let above = if row.kind == PlaceKind::NearLimit { 1.0501 } else { 1.001 };
        assert!(row.time <= least * above, "{} {} {least}", row.lines, row.time);
    }
}

#[test]
fn estimates_in_a_medium_of_many_pieces_are_about_predictions() {
    let list = "\"ratio\", \"woodcock\", \"next-flight\", \"unidirectional-mis\", { single.rule = \"clamped\" }, \
        { single.rule = \"terminating\" }, { single = { rule = \"adaptive\", albedo = 0.3 } }, \
        { double.control.explorers.points = 16 }";
    let noise = "volume.noise = { extinction = 2, octaves = 9, seed = 3, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }\n\
        ray = { origin = [-2, 0.3, 0.1], direction = [1, 0, 0], length = 4 }";
    let text = format!(
        "title = \"noise\"\n[problem.transmittance]\n{noise}\nsampling = 1\nestimators = [{list}]\n"
    );
    let case = case("noise", &text);
    let mut wrong = Vec::new();
    for (estimator, sampling) in (0..8).flat_map(|i| [1.1, 2.5, 9.0].map(|sampling| (i, sampling)))
    {
        let at = case.at(Some((SweptQuantity::Sampling, sampling))).expect("a place");
        let pilots = case.pilots(1, estimator);
        let found = [at.predict(estimator, None, pilots), at.estimate(estimator, pilots)];
        let found = found.map(|found| {
            let found = found?;
            Some([found.channels[0].moments?.variance(), found.lookups?.mean])
        });
        assert_eq!(found[0].is_some(), found[1].is_some(), "{estimator} at {sampling}");
        let [exact, found] = found.map(Option::unwrap_or_default);
        for (name, i) in [("variance", 0), ("lookups", 1)] {
            let name = format!("{name} of {estimator} at {sampling}");
            // The small residual of a control has a larger relative error, the same at every σ̂.
            let tolerance = if estimator == 7 { 2e-3 } else { 1e-3 };
            wrong.extend(differs(&name, found[i], exact[i], tolerance));
        }
    }
    none(&wrong);
}

#[test]
fn costs_decide_the_ranking() {
    let text = format!("{SINES}{ANY}");
    let cheap = asked(&text, &request(Costs::Given { draw: 1e-6, lookup: 1e-9 }));
    let dear = asked(&text, &request(Costs::Given { draw: 0.0, lookup: 1e-6 }));
    let ratio = |advice| row(advice, "ratio").constant.expect("a constant");
    // Where lookups cost little, many of them are worth their price.
    assert!(ratio(&cheap) > 2.0 * ratio(&dear), "{} {}", ratio(&cheap), ratio(&dear));
    let budget = AdviceRequest { target: Target::Budget(1e6), ..request(Costs::Lookups) };
    let found = asked(&text, &budget);
    let best = found.best().expect("advice");
    let again = asked(
        &text,
        &AdviceRequest { target: Target::Error(best.error), ..request(Costs::Lookups) },
    );
    // Settings are searched to a thousandth.
    let cost = again.best().expect("advice").time;
    none(&differs("budget", cost, 1e6, 1e-3).into_iter().collect::<Vec<_>>());
}

#[test]
fn a_loose_majorant_costs_those_that_need_it() {
    let text = format!("{SINES}{ANY}");
    let costs = || request(Costs::Given { draw: 5e-8, lookup: 1e-8 });
    let [tight, loose] =
        [1.0, 2.0].map(|looseness| asked(&text, &AdviceRequest { looseness, ..costs() }));
    let [one, two] = [&tight, &loose].map(|advice| row(advice, "woodcock"));
    assert_eq!(two.constant, one.constant.map(|x| 2.0 * x));
    none(
        &differs("lookups", two.score.lookups, 2.0 * one.score.lookups, 1e-9)
            .into_iter()
            .collect::<Vec<_>>(),
    );
    assert_eq!(row(&tight, "ratio").time, row(&loose, "ratio").time);
}

#[test]
fn measured_costs_are_kept_for_each_medium() {
    let folder = tempfile::tempdir().expect("a folder");
    let costs = |anew| Costs::Measured { folder: Some(PathBuf::from(folder.path())), anew };
    let times = |anew| {
        let advice = asked(&format!("{SINES}{ANY}"), &request(costs(anew)));
        let mut times: Vec<_> =
            advice.rows.iter().map(|row| (row.lines.clone(), row.score.cost)).collect();
        times.sort_by(|a, b| a.0.cmp(&b.0));
        times
    };
    let first = times(false);
    assert!(first.iter().all(|(_, cost)| *cost > 1e-10 && *cost < 1e-3), "{first:?}");
    assert_eq!(first, times(false));
    assert_eq!(std::fs::read_dir(folder.path()).expect("lists").count(), 1);
    assert_ne!(first, times(true));
    // Costs that cannot be are measured again.
    let file =
        std::fs::read_dir(folder.path()).expect("a list").next().expect("one").expect("a file");
    let text = std::fs::read_to_string(file.path()).expect("costs");
    std::fs::write(file.path(), text.replace("\"lookup\":", "\"lookup\":-")).expect("written");
    assert!(times(false).iter().all(|(_, cost)| *cost > 1e-10));
    // A folder that cannot be made only costs the time of the next measurement.
    let costs = Costs::Measured { folder: Some(file.path().join("below a file")), anew: false };
    let advice = asked(&format!("{SINES}{ANY}"), &request(costs));
    let warning = advice.warning.expect("a warning");
    assert_says(&warning, &["measured again", "below a file", "set XDG_CACHE_HOME"]);
}

#[test]
fn rays_are_random_listed_or_those_of_a_camera() {
    let many = |rays: &str| asked(&format!("{GRID}{rays}\n{ANY}"), &request(Costs::Lookups));
    let random = many("rays = { random = 12 }");
    assert_eq!(random.rays, 12);
    let best = row(&random, "woodcock");
    assert!(best.of_rays[0] < best.time && best.time < best.of_rays[1], "{:?}", best.of_rays);
    // A majorant of each ray is at most that of all.
    let [own, all] = ["local majorants, 1 segments", "constant"].map(|kind| {
        let of = |row: &&Row| row.estimator == "woodcock" && row.sampling == kind;
        random.rows.iter().find(of).map(|row| row.time)
    });
    assert!(own.is_none_or(|own| own <= all.expect("a constant")), "{own:?} {all:?}");
    let one = "{ origin = [-1, 2, 2.1], direction = [1, 0.1, 0] }";
    let listed = many(&format!("rays = [{one}]"));
    let alone = many("ray = { origin = [-1, 2, 2.1], direction = [1, 0.1, 0], length = 9 }");
    assert_eq!(listed.best().expect("advice").time, alone.best().expect("advice").time);
    // Nothing is to be done on a ray that misses the volume.
    let missing = many("ray = { origin = [-1, 9, 9], direction = [1, 0, 0], length = 9 }");
    assert_eq!((missing.best().expect("advice").score.variance, missing.profiles.len()), (0.0, 0));
    let camera = "rays = { random = 3, camera = { position = [9, 2, 2], target = [2, 2, 2] } }";
    assert_eq!(many(camera).rays, 3);
}

#[test]
fn wrong_rays_and_options_are_mistakes_with_a_cure() {
    let wrong = |text: &str| {
        let spec = Spec::parse(&source("wrong", text), &own_pages::NONE).expect("TOML");
        let error = advise(&spec, &request(Costs::Lookups)).expect_err("a mistake");
        error.render(false)
    };
    assert_says(
        &wrong(&format!("{LINE}rays = {{ random = 2 }}\n{ANY}")),
        &["a field on a line", "leave them out"],
    );
    for rays in ["[]", "[1, 2]", "3", "\"all\""] {
        let said = wrong(&format!("{GRID}rays = {rays}\n{ANY}"));
        assert_says(&said, &["`rays` has no rays", "`{ random = 64 }`, or a list"]);
        assert_eq!(said.matches("error:").count(), 1, "{said}");
    }
    let none = format!("{GRID}rays = {{ random = 0 }}\n{ANY}");
    assert_says(&wrong(&none), &["`random` is 0", "from 1 to 4096"]);
    let away = "rays = [{ origin = [-1, 2, 2], direction = [-1, 0, 0] }]";
    assert_says(&wrong(&format!("{GRID}{away}\n{ANY}")), &["misses the volume"]);
    let open = GRID.replace("grid = { random = { size = [8, 8, 8] }, bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }", "constant.extinction = 1");
    assert_says(
        &wrong(&format!("{open}rays = {{ random = 2 }}\n{ANY}")),
        &["do not end", "`bounds`"],
    );
}

#[test]
fn every_problem_is_advised_or_says_why_not() {
    let rod = "title = \"a rod\"\n[problem.rod]\nmedium.constant.extinction = 1\nspan = [0, 2]\nalbedo = 0.7\nforward = 0.6\n\
        sampling = 1\nestimators = [\"analog\"]\n";
    case("rod", rod);
    let advice = asked(rod, &request(Costs::Lookups));
    let weighted = row(&advice, "weighted");
    assert!(weighted.constant.is_some() && advice.rows.len() >= 4, "{:?}", advice.refused);
    // Below a critical σ̂ the variance of the weighted walk is infinite.
    assert!(weighted.minimum.is_some_and(|least| least < weighted.constant.expect("σ̂")));
}

#[test]
fn the_command_prints_tables_lines_and_files() {
    let place = Place::new(&[("waves.toml", &format!("{SINES}{ANY}"))]);
    let text = place.says(0, "advise waves.toml --cost lookup=2us");
    assert_says(
        &text,
        &[
            "to a standard error of 1 %",
            "woodcock",
            "advice: put into the case",
            "estimators = [{ ",
            "left out on a console this narrow: draws",
        ],
    );
    let csv =
        place.says(0, "advise waves.toml --cost draw=50ns,lookup=2us --error 0.1% --format csv");
    assert!(csv.starts_with("case,problem,medium,rays,group,rank,"), "{csv}");
    let json: serde_json::Value =
        serde_json::from_str(&place.says(0, "advise waves.toml --budget 1e6 --format json"))
            .expect("JSON");
    assert_eq!(json[0]["unit"], "lookups");
    let files = place.says(0, "advise waves.toml --cost lookup=2us --out found");
    assert_says(&files, &["report: found/report.html"]);
    assert_says(
        &place.read("found/report.html"),
        &["Estimators with their best settings", "estimators = [{ "],
    );
    assert!(place.read("found/advise.csv").lines().count() > 15);
    assert!(place.read("found/advise.svg").contains("Cost against a constant"));
    let wrong = place.run("advise waves.toml --cost 2us");
    assert_says(&crate::common::place::stderr(&wrong), &["lookup=2us or draw=50ns"]);
    place.says(2, "advise waves.toml --rays 4 --cost lookup=1us --out wrong");
    assert!(!place.path().join("wrong").exists(), "a folder of a failed command");
    let wrong = place.run("advise waves.toml --cost lookup=1us --out waves.toml/below");
    assert_says(&crate::common::place::stderr(&wrong), &["cannot write into", "another folder"]);
}
