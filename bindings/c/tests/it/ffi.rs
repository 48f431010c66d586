//! Foreign function interface: errors, exceptions, threads, memory; and draws, which equal those of Rust.

use std::process::Command;

use crate::build::{Link, Program};

pub fn run(source: &str) -> (Option<i32>, String) {
    Program::new(&format!("tests/programs/{source}"), Link::Shared, &[]).run()
}

#[test]
fn bad_input_gets_one_clear_error() {
    let (code, text) = run("errors.c");
    assert_eq!(code, Some(0), "{text}");
    let case = if cfg!(feature = "theory") { "no/such-case" } else { "built without theory" };
    let expected = [
        ("no name", "1 the check's name is null"),
        ("bad name", "1 the check's name is not UTF-8"),
        ("no check", "1 the check is null"),
        ("text of no check", "the check is null"),
        ("no check passes", "0"),
        ("no draws pointer", "1 check `half`: the array of draws is null"),
        ("it stays", "1 check `half`: the array of draws is null"),
        ("and is the text", "check `half`: the array of draws is null"),
        ("passed", "0, open: 0"),
        ("no callback", "1 check `half`: the callback is null"),
        ("too many", "6 check `half`: the callback returned 16385 draws, but was asked for 16384"),
        ("no draws", "5 check `half`: there are no draws; make one at least"),
        (
            "no truth",
            "3 check `nothing said`: the truth is not known; set TF_TRUTH, or call tf_check_of",
        ),
        ("range", "3 check `half`: "),
        ("no such case", "4 check `half`: "),
        ("no such case", case),
        ("ragged", "5 check `pairs`: 3 numbers are no whole number of draws of 2 values"),
        (
            "one of two",
            "3 check `pairs`: 2 numbers for the truth, but a draw has 1 value; give one for each value, or one for all",
        ),
        (
            "lookups",
            "5 check `half`: the claim has lookups; add draws by tf_check_absorb_with_lookups",
        ),
        ("too late", "7 check `half`: set the claim before the first draw"),
        ("no place", "1 check `half`: the place of the verdict is null"),
        ("no harm", "0 "),
        ("no such value", "8 check `half`: there is no value 1; the last one is value 0"),
        ("after the verdict", "7 check `half`: the verdict was given; make a new check"),
        ("nan", "1 numeric: draw 0"),
    ];
    for (what, said) in expected {
        // A message on a case has several lines.
        let start = text.find(&format!("{what}: ")).unwrap_or_else(|| panic!("no {what}: {text}"));
        let result = &text[start + what.len() + 2..];
        let end = if what == "no such case" { result.find("\nragged") } else { result.find('\n') };
        let result = &result[..end.expect("an end")];
        assert!(result.contains(said), "{what}: {result}\n  does not say\n{said}");
    }
}

#[test]
fn exceptions_come_through() {
    let (code, text) = run("exceptions.cpp");
    assert_eq!(code, Some(0), "{text}");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "no scene after 20001");
    assert!(lines[1].starts_with("3 check `no truth`: the truth is not known"), "{text}");
    assert!(lines[2].starts_with("`off`: fail: the mean is off by"), "{text}");
    assert_eq!(lines[lines.len() - 2..], ["1 1", "3"]);
}

#[test]
fn an_exception_that_leaves_a_c_callback_ends_the_process() {
    let (code, text) = run("thrown.cpp");
    assert_eq!(code, None, "{text}");
    assert!(
        text.contains("cannot catch foreign exceptions") && !text.contains("it went on"),
        "{text}"
    );
}

#[test]
fn eight_threads_agree() {
    let (code, text) = run("threads.cpp");
    assert_eq!((code, text.as_str()), (Some(0), "eight threads agree\n"));
}

#[test]
fn draws_are_those_of_rust() {
    let check = gate::check("the same draws", |rng| rng.uniform() * rng.positive_uniform());
    let check = check.truth(0.25).variance(1.0 / 9.0 - 1.0 / 16.0).seed(7).draws(100_001);
    let outcome = check.verdict().expect("a verdict");
    assert_eq!(run("same.c"), (Some(0), format!("{outcome}\n")));
}

/// Sanitizers find no write out of bounds, no use after free, no undefined behaviour, and no leak.
#[test]
fn sanitizers_find_nothing() {
    let flags = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    let probe = ["-x", "c", "-", "-o", "/dev/null", "-fsanitize=address,undefined"];
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let probed = Command::new(compiler).args(probe).output().expect("a C compiler");
    let said = String::from_utf8_lossy(&probed.stderr);
    // The input is empty: only a missing `main` may fail.
    if said.contains("cannot find") || said.contains("unrecognized") || said.contains("unsupported")
    {
        println!("skipped: this compiler has no sanitizers");
        return;
    }
    let sources = ["errors.c", "exceptions.cpp", "threads.cpp", "same.c", "setters.c", "values.c"];
    for source in sources.into_iter().chain(["values.cpp", "callbacks.c", "callbacks.cpp"]) {
        let (code, text) =
            Program::new(&format!("tests/programs/{source}"), Link::Static, &flags).run();
        assert_eq!(code, Some(0), "{source}: {text}");
    }
    // Control: the sanitizer detects a check that is not freed.
    let (code, text) = Program::new("tests/programs/leak.c", Link::Static, &flags).run();
    assert!(code != Some(0) && text.contains("LeakSanitizer"), "{text}");
}
