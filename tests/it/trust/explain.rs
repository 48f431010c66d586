//! `trueflight explain`: valid cases to copy, pages for a terminal, and suggestions for unknown names.

use trueflight::case::Case;
use trueflight::case::suite;
use trueflight::plan::Plan;

use super::{listed, stdout, trueflight};
use crate::common::{case, none, options, source};

/// Returns the blocks of a case file in a page.
fn blocks(page: &str) -> Vec<&str> {
    let blocks = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.contains("[problem.")).collect()
}

/// Returns the error of a command about an unknown name.
fn error(arguments: &[&str]) -> String {
    let output = trueflight(arguments);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}");
    String::from_utf8(output.stderr).expect("text")
}

#[test]
fn every_page_that_a_case_may_use_has_a_case_to_copy_that_is_planned() {
    let (mut wrong, mut planned) = (Vec::new(), 0);
    for row in listed() {
        let place = format!("{} ({})", row.name, row.part);
        let kind = row.part.split(' ').next().unwrap_or_default();
        let is_used =
            ["media", "phases", "sampling", "controls", "estimators", "problems"].contains(&kind);
        let Some(text) = suite::example(&row.part, &row.name) else {
            if is_used && !row.part.contains("pictures") {
                wrong.push(format!("{place}: list a case that has it in src/case/suite.rs"));
            }
            continue;
        };
        assert!(is_used, "{place} has a case");
        assert!(text.contains(&row.name), "{place}: {text}");
        match Case::read(&source("shown", &text)) {
            Err(error) => wrong.push(format!("{place}: {}", error.render(false))),
            Ok(case) => {
                let cases = [case];
                let plan = Plan::new(&cases, &options(1, 100_000));
                planned += 1;
                // The case of a problem may show a refused experiment beside others.
                let refused =
                    plan.experiments().filter(|(_, planned)| planned.outcome.is_err()).count();
                if plan.experiments().count() == refused || (refused > 0 && kind != "problems") {
                    wrong.push(format!("{place}: {refused} refused in\n{text}"));
                }
            }
        }
    }
    none(&wrong);
    assert!(planned > 114, "only {planned} cases were planned");
}

#[test]
fn a_case_that_is_shown_runs() {
    let place = tempfile::tempdir().expect("a folder");
    for name in ["eq21", "rod", "single", "pilot", "explorers"] {
        let page = stdout(&["explain", name]);
        let [text, ..] = blocks(&page)[..] else { panic!("no case in {page}") };
        case("shown", text);
        let path = place.path().join("case.toml");
        std::fs::write(&path, text).expect("writable");
        let planned = stdout(&["plan", path.to_str().expect("a path")]);
        assert!(planned.contains("An example of"), "{planned}");
    }
}

#[test]
fn a_terminal_sees_no_signs_of_markdown() {
    for name in ["woodcock", "grid", "local-majorants", "mean", "transmittance", "ball"] {
        let page = stdout(&["explain", name, "--color", "always"]);
        assert!(page.contains("\x1b[1m"), "{name}: nothing is bold");
        for sign in ["`", "\n# ", "\n| ", "|---", "\n```"] {
            assert!(!page.contains(sign), "{name}: {sign:?} in\n{page}");
        }
        let plain = stdout(&["explain", name]);
        assert!(plain.starts_with(&format!("{name} (")) && !plain.contains('\x1b'), "{plain}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn pages_are_as_wide_as_the_terminal() {
    // util-linux's `script` provides a terminal; without it, `--color always` above is the only test.
    let mut script = std::process::Command::new("script");
    let command =
        format!("stty cols 50 rows 40; {} explain woodcock", env!("CARGO_BIN_EXE_trueflight"));
    let output = script.args(["-qec", &command, "/dev/null"]).env("NO_COLOR", "1").output();
    let Some(output) = output.ok().filter(|output| output.status.success()) else { return };
    let page = String::from_utf8(output.stdout).expect("text").replace('\r', "");
    let pages = page.split("A case to copy").next().unwrap_or_default();
    let prose: Vec<&str> = pages.lines().filter(|line| !line.starts_with("    ")).collect();
    assert!(prose.len() > 10 && prose.iter().all(|line| line.chars().count() <= 50), "{pages}");
    assert!(!page.contains('`') && !page.contains('\x1b'), "{page}");
}

#[test]
fn a_wrong_name_has_a_suggestion() {
    for (written, meant) in [
        ("rato", "ratio"),
        ("woodcok", "woodcock"),
        ("eq12", "eq21"),
        ("medai", "media"),
        ("estimatrs", "estimators"),
        ("transmitance", "transmittance"),
        ("transmittance/eq21-overviw", "transmittance/eq21-overview"),
        ("figure9", "figure-9"),
    ] {
        let said = error(&["explain", written]);
        let wanted = format!("nothing is called \"{written}\"; did you mean `{meant}`?");
        assert!(said.contains(&wanted), "{said}");
    }
    assert!(error(&["explain", "xyzzy"]).contains("`trueflight list` shows the names"));
    assert!(error(&["list", "medai"]).contains("'media'"));
    assert!(error(&["list", "eq21"]).contains("`trueflight explain eq21` shows it"));
}

#[test]
fn names_and_kinds_may_be_written_as_people_write_them() {
    assert_eq!(stdout(&["explain", "residual_ratio"]), stdout(&["explain", "residual-ratio"]));
    assert_eq!(stdout(&["explain", "free", "flight"]), stdout(&["explain", "Free-Flight"]));
    for (kind, part) in [
        ("media", "media"),
        ("medium", "media"),
        ("Estimators", "estimators"),
        ("sampling", "sampling"),
    ] {
        assert_eq!(stdout(&["explain", kind]), stdout(&["list", part]));
        assert_eq!(stdout(&["list", &kind.to_lowercase()]), stdout(&["list", part]));
    }
}
