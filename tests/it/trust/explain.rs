//! `trueflight explain`: valid cases to copy, pages for a terminal, and suggestions for unknown names.

use trueflight::case::Case;
use trueflight::case::catalogue::built_in;
use trueflight::catalogue::{OwnPages, Page};
use trueflight::recipes::{controls, sampling};
use trueflight::record::Verdict;
use trueflight::render::Picture;
use trueflight::{phase, problems};

use super::{stdout, trueflight};
use crate::common::{case, judged, none, options, rows_of, source};

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

/// Returns every page that a case or a picture may name, with its part of the catalogue.
fn pages() -> Vec<(String, Page)> {
    let others = [
        ("sampling", sampling::CATALOGUE.pages),
        ("controls", controls::CATALOGUE.pages),
        ("phases", phase::CATALOGUE.pages),
        ("problems", problems::CATALOGUE),
    ];
    let lists = built_in().into_iter().chain(others.map(|(part, pages)| (part.to_owned(), pages)));
    lists.flat_map(|(part, pages)| pages.iter().map(move |page| (part.clone(), *page))).collect()
}

#[test]
fn every_page_that_a_file_may_name_shows_an_example_that_passes() {
    let (mut wrong, mut cases, mut pictures) = (Vec::new(), Vec::new(), 0);
    for (part, page) in pages() {
        let name = page.name();
        let place = format!("{name} ({part})");
        let Some(text) = page.example() else {
            wrong.push(format!("{place}: end its documentation with a case in a block of TOML"));
            continue;
        };
        let is_titled = text.starts_with(&format!("title = \"An example of {name}\"\n"));
        if !is_titled || text.matches(&name).count() < 2 {
            wrong.push(format!("{place}: its example is one of another page"));
        }
        if !page.source.contains("\n#![cfg_attr(not(doctest), doc = ") {
            wrong.push(format!("{place}: no `draw_in_rust!` below its documentation"));
        }
        let source = source(&place, &text);
        if text.contains("\n[picture.") {
            pictures += 1;
            let picture = Picture::read(&source, &OwnPages::default());
            let record = picture.expect("a picture without mistakes").render(1, &|| {});
            let exposed = record.exposures.iter().map(|exposure| &exposure.outcome);
            let refused = exposed.filter_map(|outcome| outcome.as_ref().err());
            wrong.extend(refused.map(|why| format!("{place}: {why}")));
        } else {
            match Case::read(&source) {
                Ok(case) => cases.push(case),
                Err(error) => wrong.push(error.render(false)),
            }
        }
    }
    let rows = rows_of(judged(&cases, &options(1, 300_000)));
    for row in rows.iter().filter(|row| row.verdict != Some(Verdict::Pass)) {
        let (case, label, channel) = (&row.case.name, &row.experiment.label, &row.channel);
        let reason = row.reason();
        wrong.push(format!("{case}: {label} {channel}: {:?}, {reason}", row.verdict));
    }
    none(&wrong);
    assert!(cases.len() > 118 && pictures == 2, "{} cases, {pictures} pictures", cases.len());
}

/// The example of a page makes the same draws in a program as by `trueflight run`.
#[test]
fn draws_of_a_program_are_those_of_a_run() {
    for (part, name) in [
        ("estimators of rod", "analog"),
        ("estimators of transmittance with media", "hero"),
        ("sampling", "pilot"),
    ] {
        let mut pages = pages().into_iter();
        let page = pages.find(|(of, page)| of == part && page.name() == name).expect("a page");
        let cases = [case("shown", &page.1.example().expect("an example"))];
        let run = rows_of(judged(&cases, &options(7, 40_000)));
        let count = run[0].experiment.draws.expect("draws");
        let at = cases[0].at(None).expect("the case as written");
        let draws = at.draws(0, 7, usize::try_from(count).expect("few")).expect("draws");
        assert_eq!(draws.lookups.len() as u64, count);
        for (row, values) in run.iter().zip(&draws.values) {
            let mean = values.iter().sum::<f64>() / count as f64;
            let measured = row.mean.expect("a mean");
            assert!((mean / measured - 1.0).abs() < 1e-12, "{name}: {mean}, {measured}");
        }
    }
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
