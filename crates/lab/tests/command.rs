//! The command `trueflight-lab`.

use std::process::{Command, Output};

use trueflight_lab::mutants;

fn lab() -> Command {
    Command::new(env!("CARGO_BIN_EXE_trueflight-lab"))
}

fn output(words: &[&str]) -> Output {
    lab().args(words).output().expect("it runs")
}

fn stdout(words: &[&str]) -> String {
    let output = output(words);
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn every_known_bug_is_listed_and_explained() {
    let listed = stdout(&["list", "--format", "json"]);
    let listed: Vec<serde_json::Value> = serde_json::from_str(&listed).expect("rows");
    let all = mutants::families().into_iter().flat_map(|(_, abouts)| abouts);
    let all: Vec<(&str, &str)> = all.map(|about| (about.name, about.bug)).collect();
    let word = |row: &'_ serde_json::Value, name: &str| row[name].as_str().map(str::to_owned);
    let shown: Vec<_> =
        listed.iter().map(|row| (word(row, "name"), word(row, "summary"))).collect();
    assert_eq!(shown.len(), all.len());
    for ((name, bug), (shown_name, shown_bug)) in all.into_iter().zip(shown) {
        assert_eq!((Some(name), Some(bug)), (shown_name.as_deref(), shown_bug.as_deref()));
    }
    let page = stdout(&["explain", "control-twice"]);
    for said in [
        "T_c is multiplied in twice",
        "`residual-ratio` of the built-in case `transmittance/known-bugs`",
        "the check `mean`",
        "T_c = exp(−∫₀^S σ_c)",
        "Mitsuba 3, issue 1387",
    ] {
        assert!(page.contains(said), "{said}: {page}");
    }
}

#[test]
fn an_unknown_bug_is_an_error_with_similar_names() {
    let output = output(&["explain", "control-twise"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(text.contains("control-twice"), "{text}");
}

#[test]
fn a_run_that_is_stopped_leaves_no_folder() {
    let place = tempfile::tempdir().expect("a folder");
    for long in [&["self-test", "--long"][..], &["stress"]] {
        let arguments = long.iter().chain(&["--out", "found", "--quiet"]);
        let mut run = lab().args(arguments).current_dir(place.path()).spawn().expect("it starts");
        std::thread::sleep(std::time::Duration::from_millis(200));
        assert!(run.try_wait().expect("a process").is_none(), "{long:?} ended by itself");
        run.kill().expect("it runs");
        run.wait().expect("it ends");
        assert!(!place.path().join("found").exists(), "{long:?}");
    }
}
