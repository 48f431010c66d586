//! The plan lists rows with too few draws; the command that an inconclusive row names decides it.

use super::commands;
use crate::common::place::Place;
use crate::common::{self, none};
use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::draw::run;
use trueflight::gate::session::Reason;
use trueflight::numeric::digits::enough;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::record::Verdict;
use trueflight::record::build;

/// Case with means and variances that need different numbers of draws at each σ̂; its names have spaces and
/// parentheses.
const SWEPT: &str = "title = \"too few draws\"
[problem.transmittance]
volume.eq21 = {}
ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20.0 }
sweep.sampling.values = [0.6, 1, 2]
estimators = [{ ratio = {} }, { single = { rule = \"non-terminating\", albedo = 0.7 } }, { woodcock = {} }]
";

/// Case with tolerances of its own: more draws do not narrow them.
const TOLERANT: &str = "title = \"tolerances\"
[problem.transmittance]
medium.constant.extinction = 2
span = [0, 2]
sampling.constant.value = 2.5
estimators = [{ woodcock = {} }, { ratio = {} }, { residual-ratio = { control.constant.value = 0.5 } }]
[tolerance]
mean = 1e-2
";

/// Case with several channels, and an estimator listed twice.
const CHANNELS: &str = "title = \"channels\"
[problem.rod]
medium.constant.extinction = 3
span = [0, 2]
albedo = 0.5
forward = 0.5
sampling.constant.value = 3.5
estimators = [{ analog = {} }, { weighted = {} }]
";

/// Cases with too few draws.
const OPEN: [(&str, &str, &str); 4] = [
    ("swept", SWEPT, "2e4"),
    ("tolerant", TOLERANT, "5e4"),
    ("channels", CHANNELS, "3000"),
    ("few", TOLERANT, "5"),
];

#[test]
fn the_command_of_an_inconclusive_row_decides_it() {
    for (name, text, draws) in OPEN {
        let file = format!("{name}.toml");
        let place = Place::new(&[(&file, text)]);
        let said = place.says(3, &format!("run {file} --draws {draws}"));
        let decisive = commands(&said, ": ");
        assert!(!decisive.is_empty(), "{said}");
        for command in decisive {
            assert!(command.starts_with("check ") && command.contains(" --draws "), "{command}");
            assert!(!command.contains(&format!("--draws {draws} ")), "{command}");
            place.says(0, &command);
        }
    }
}

#[test]
fn the_plan_names_the_rows_and_the_command_for_all_of_them() {
    for (name, text, draws) in OPEN {
        let file = format!("{name}.toml");
        let place = Place::new(&[(&file, text)]);
        let said = place.says(0, &format!("plan {file} --draws {draws}"));
        for word in ["needed", "inconclusive", "needs", "draws are too few"] {
            assert!(said.contains(word), "no {word} in\n{said}");
        }
        let decisive = commands(&said, "decide: ");
        assert_eq!(decisive.len(), 1, "{said}");
        assert!(decisive[0].starts_with(&format!("run {file} --draws ")), "{said}");
        let said = place.says(0, &decisive[0]);
        assert!(said.contains("pass: nothing of "), "{said}");
    }
}

/// The number in the plan is 27 V/ε², with the variance of a draw that is 0 or 1 and ε = 5 %: (1 − T)/T/0.0025 times
/// 27.
#[test]
fn the_draws_that_are_needed_follow_from_the_variance() {
    let transmittance = (-4.0_f64).exp();
    let needed = 27.0 * (1.0 - transmittance) / transmittance / (0.05 * 0.05);
    let case = TOLERANT.split("[tolerance]").next().expect("a case");
    let place = Place::new(&[("case.toml", case)]);
    let said = place.says(0, "plan case.toml --draws 5e4");
    let row = said.lines().find(|line| line.starts_with("woodcock")).expect("the row");
    assert!(row.contains(&enough(needed)), "{} is not in {row}", enough(needed));
    assert!(enough(needed).parse::<f64>().expect("a number") >= needed);
}

#[test]
fn every_report_gives_the_command_that_decides() {
    let place = Place::new(&[("swept.toml", SWEPT)]);
    let reports = "--junit j.xml --markdown s.md --record r.json --out out";
    let said = place.says(3, &format!("check swept.toml --draws 2e4 {reports}"));
    let decisive = commands(&said, ": ");
    let [one, ..] = &decisive[..] else { panic!("no command in\n{said}") };
    let draws = one.split("--draws ").nth(1).and_then(|rest| rest.split(' ').next());
    let draws = format!("--draws {}", draws.expect("a number of draws"));
    let escaped = |text: String| text.replace("&#39;", "'").replace("&apos;", "'");
    for file in ["j.xml", "s.md", "r.json", "out/report.html", "out/record.json"] {
        let text = escaped(std::fs::read_to_string(place.path().join(file)).expect("a report"));
        assert!(text.contains(&draws), "no {draws} in {file}");
        assert!(text.contains("decide"), "no command to decide in {file}");
        // The page has both below each row.
        let repeats = text.contains("repeat: trueflight") && !file.ends_with("html");
        assert!(!repeats, "{file} repeats what is inconclusive");
    }
}

/// A run that was cut is decided by its draws without the limit.
#[test]
fn what_a_budget_cuts_is_decided_without_it() {
    let place = Place::new(&[("case.toml", TOLERANT)]);
    let said = place.says(3, "check case.toml --budget 16384 --draws 4e6");
    for command in commands(&said, ": ") {
        assert!(!command.contains("--budget"), "{command}");
        place.says(0, &command);
    }
}

/// For every built-in case, the plan and a run of few draws agree row by row: no row is inconclusive or underpowered
/// that the plan called sufficient. Whole distributions are exempt, since only draws can show their power.
#[test]
fn the_plan_foresees_what_a_run_finds() {
    let sources = suite::suite();
    let cases: Vec<Case> =
        sources.iter().map(|source| Case::read(source).expect("a built-in case")).collect();
    let plan = Plan::new(&cases, &common::options(1, 20_000));
    let planned = build::planned(&plan);
    let drawn = build::judged(&plan, &run::draw(&plan, &|_| {}), 0.0);
    let (mut wrong, mut open) = (Vec::new(), 0);
    let pairs = planned.results.cases.iter().zip(&drawn.results.cases);
    for (before, after) in pairs.flat_map(|(a, b)| a.rows().zip(b.rows())) {
        let is_weak =
            |verdict| matches!(verdict, Some(Verdict::Inconclusive | Verdict::Underpowered));
        if before.foresees(Verdict::Inconclusive) {
            open += 1;
            // It may fail, never pass.
            if !matches!(after.verdict, Some(Verdict::Inconclusive | Verdict::Fail)) {
                wrong
                    .push(format!("{}: foreseen, but {:?}", after.experiment.label, after.verdict));
            }
        } else if is_weak(after.verdict) && before.foreseen.is_none() {
            let mut findings =
                after.findings().filter(|found| Some(found.verdict) == after.verdict);
            if findings.any(|found| !matches!(found.reason, Some(Reason::TooFew(_)))) {
                wrong.push(format!("{}: not foreseen: {}", after.experiment.label, after.reason()));
            }
        }
    }
    none(&wrong);
    assert!(open > 20, "{open}");
}

/// The first command that README gives for a CI, `trueflight check cases/`, in a checkout.
#[test]
#[ignore = "long: plans all cases of the repository, a minute of two cores"]
fn the_cases_of_the_repository_have_enough_draws_for_a_ci() {
    let cases = common::shipped();
    let options = Options { draws: Amount::CaseOr(400_000), ..Options::default() };
    let planned = build::planned(&Plan::new(&cases, &options));
    let mut wrong = Vec::new();
    for case in &planned.results.cases {
        let open = case.rows().filter(|row| row.foresees(Verdict::Inconclusive));
        wrong.extend(
            open.map(|row| format!("{}: {}: {}", case.name, row.experiment.label, row.reason())),
        );
    }
    none(&wrong);
}
