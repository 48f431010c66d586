//! `trueflight report`, and the page that `run` and `check` write.

use std::fs;
use std::path::Path;

use assert_cmd::Command;

fn trueflight(arguments: &[&str], folder: &Path) -> (Option<i32>, String, String) {
    let mut command = Command::cargo_bin("trueflight").expect("built");
    let output = command.args(arguments).arg(folder).output().expect("runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn run_and_check_write_the_page_and_report_writes_it_again() {
    let case = "transmittance/ratio-exactly-one";
    for arguments in [
        &["run", case, "--draws", "40000", "--out"][..],
        &["check", case, "--draws", "40000", "--inconclusive", "pass", "--out"],
    ] {
        let out = tempfile::tempdir().expect("a folder");
        let (code, _, error) = trueflight(arguments, out.path());
        assert!(code == Some(0) || code == Some(3), "{error}");
        let path = out.path().join("report.html");
        let page = fs::read(&path).expect("a page");
        fs::remove_file(&path).expect("goes");
        let (code, said, error) = trueflight(&["report"], out.path());
        assert_eq!((code, said.trim()), (Some(0), &*path.display().to_string()), "{error}");
        assert!(fs::read(&path).expect("a page") == page, "another page than that of the run");
    }
}

#[test]
fn what_is_no_record_is_named_with_its_cure() {
    let out = tempfile::tempdir().expect("a folder");
    let path = out.path().join("record.json");
    let refused = |words: &str| {
        let (code, said, error) = trueflight(&["report"], out.path());
        assert_eq!((code, said.as_str()), (Some(2), ""));
        for word in ["record.json", "run --out DIR", words] {
            assert!(error.contains(word), "{error}");
        }
        assert!(!out.path().join("report.html").exists());
    };
    refused("cannot read");
    for (text, words) in [
        ("", "not a record, or a broken one"),
        ("{\"schema\": 1, \"results\": {", "not a record, or a broken one"),
        ("{\"schema\": 1}", "missing field `results`"),
        ("{\"schema\": 99, \"results\": 3}", "a record of form 99, this program reads 1"),
    ] {
        fs::write(&path, text).expect("writes");
        refused(words);
    }
}
