//! Misuse: an invalid claim, a call at the wrong time, another number of values. Each is an error, and never a write
//! beyond the buffer. The sanitizers of [`crate::ffi`] run the same programs.

use std::process::Command;

use crate::build::here;
use crate::ffi::run;

/// Compares the output of a program with the beginnings of its lines.
fn lines_begin(text: &str, expected: &[&str]) {
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), expected.len(), "{text}");
    for (line, expected) in lines.iter().zip(expected) {
        assert!(line.starts_with(expected), "{line}\n  does not begin by\n{expected}");
    }
}

#[test]
fn the_first_draws_validate_the_claim() {
    let (code, text) = run("setters.c");
    assert_eq!(code, Some(0), "{text}");
    // A message on a case has several lines.
    let lines: Vec<&str> = text.lines().filter(|line| line.contains(": ")).collect();
    let expected = [
        ("alpha", "alpha = -1 is not a probability above 0 and below 1"),
        ("alpha 1", "alpha = 1 is not a probability above 0 and below 1"),
        ("tolerance", "tolerance = 0 is not a finite number above 0"),
        ("its own", "variance tolerance = inf is not a finite number above 0"),
        ("truth", "truth = NaN is not a finite number"),
        ("truths", "truth = NaN is not a finite number"),
        (
            "no truths",
            "0 numbers for the truth, but a draw has 1 value; give one for each value, or one for all",
        ),
        ("variance", "variance = -1 is not a finite number, 0 or more"),
        ("variances", "2 numbers for the variance, but a draw has 1 value"),
        ("kurtosis", "kurtosis = 0.5 is not a finite number, 1 or more"),
        ("range", "a range of 1 to 0 is empty; give a range around the truth"),
        ("range nan", "a range of 0 to NaN is empty; give a range around the truth"),
        ("range of others", "a range of 0.6 to 1 does not have the truth 0.5 inside"),
        ("lookups", "expected lookups = 0 is not a finite number above 0"),
        ("rounding", "rounding = -1 is not a finite number, 0 or more"),
        ("no draws", "draws = 0 is not a whole number from 1 to 9007199254740992; give another"),
        ("half a draw", "draws = 0.5 is not a whole number from 1"),
        ("negative draws", "draws = -1 is not a whole number from 1"),
        ("more draws", "draws = 1e19 is not a whole number from 1"),
        ("no batch", "batch = 0 is not a whole number from 1 to 9007199254740992"),
        ("two batches", "batch takes 1 number, but was given 2 numbers"),
        ("no values", "values = 0 is not a whole number from 1 to 65536"),
        ("more values", "values = 65537 is not a whole number from 1 to 65536"),
        ("one end", "range takes 2 numbers, the lower and the upper end, but was given 1 number"),
        ("three lookups", "lookups takes 2 numbers, mean and variance, but was given 3 numbers"),
        ("more than the mean", "mean_only = 2 is not a whole number from 0 to 1"),
    ];
    for (name, said) in expected {
        let expected = format!("{name}: 3 check `{name}`: {said}");
        assert!(
            lines.iter().any(|line| line.starts_with(&expected)),
            "{text}\n  lacks\n{expected}"
        );
    }
    for (name, status, said) in [
        ("no array", 1, "the array of numbers is null"),
        ("no key", 10, "library 0.1.0 has no key 99"),
        ("case", 4, ""),
    ] {
        let expected = format!("\n{name}: {status} check `{name}`: {said}");
        assert!(text.contains(&expected), "{text}\n  lacks\n{expected}");
    }
    assert!(text.contains("\nlast: 1, 0\n"), "{text}");
}

#[test]
fn a_draw_has_as_many_values_as_the_call_says() {
    let (code, text) = run("values.c");
    assert_eq!(code, Some(0), "{text}");
    let more = "give one for each value, or one for all";
    let expected = [
        "wanted: 1",
        "one truth: 0 ",
        "values: 3, passed: 1",
        "three truths: 0 ",
        &format!(
            "two of three: 3 check `uniform`: 3 numbers for the truth, but a draw has 2 values; {more}"
        ),
        &format!(
            "one of three: 3 check `uniform`: 3 numbers for the truth, but a draw has 1 value; {more}"
        ),
        "two after one: 3 check `uniform`: the number of values was 1 in the draws before, but is 2 now",
        "none: 5 check `uniform`: a draw has no values; give 1 to 65536",
        "most: 5 check `uniform`: a draw has 18446744073709551615 values; 65536 are judged together",
        "many: 5 check `uniform`: a draw has 281474976710656 values; 65536 are judged together at",
    ];
    lines_begin(&text, &expected);
}

#[test]
fn a_lambda_says_how_many_values_a_draw_has() {
    let (code, text) = run("values.cpp");
    assert_eq!(code, Some(0), "{text}");
    let expected = [
        "one truth: 2 values, passed: 1",
        "two truths: 2 values, passed: 1",
        "three truths: 3 check `a`: 3 numbers for the truth, but a draw has 2 values; give one for each value",
        "three of one: 3 check `a`: 3 numbers for the truth, but a draw has 1 value; give one for each value",
        "two variances: 2 values, passed: 1",
        "three variances: 3 check `a`: 3 numbers for the variance, but a draw has 2 values",
        if cfg!(feature = "theory") {
            "a case: 3 check `a`: a draw has 1 value, but the case has 5 channels"
        } else {
            "a case: 4 check `a`: nothing is known of `common-ratio`"
        },
    ];
    lines_begin(&text, &expected);
}

#[test]
fn a_draw_without_values_does_not_compile() {
    let compiler = std::env::var("CXX").unwrap_or_else(|_| "c++".into());
    let mut command = Command::new(compiler);
    command.args(["-std=c++17", "-fsyntax-only", "-I"]).arg(here().join("include"));
    let output = command.arg(here().join("tests/programs/empty.cpp")).output().expect("a compiler");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && said.contains("a draw has one value at least"), "{said}");
}

#[test]
fn a_callback_must_leave_its_own_check_alone() {
    let (code, text) = run("callbacks.c");
    assert_eq!(code, Some(0), "{text}");
    let says = "check `half`: the check is drawing; a callback must not use it";
    let case = if cfg!(feature = "theory") { "nope" } else { "nothing is known of `x` of nope" };
    let (head, rest) = text.split_once("place: ").expect("the last error");
    let expected = [
        "draws: 7, 7, one block: 1, passed: 0",
        &format!("draws says: {says}"),
        "says: 7, 7, one block: 1, passed: 0",
        &format!("says says: {says}"),
        "frees: 0, 7, one block: 1, passed: 0",
        &format!("frees says: {says}"),
        "looks: 7, 0, one block: 0, passed: 1",
        "other: 0, 0, one block: 0, passed: 1",
    ];
    lines_begin(head, &expected);
    let told: Vec<&str> = rest.split("place: ").collect();
    assert_eq!(told.len(), 3, "{text}");
    for told in told {
        assert!(told.starts_with("4 check `half`: ") && told.contains(case), "{text}");
    }
    let end = text.find("\nlong: ").expect("the long one");
    // Whole characters of two bytes, behind "check `".
    let expected = ["", "long: 16383, 1", "text: `half`: pass, 0, check `half`: set th"];
    assert_eq!(text[end..].trim_end(), expected.join("\n"), "{text}");
}

#[test]
fn a_lambda_must_leave_its_own_check_alone() {
    let (code, text) = run("callbacks.cpp");
    assert_eq!(code, Some(0), "{text}");
    lines_begin(&text, &["7 check `own`: the check is drawing; a callback must not use it"; 2]);
}
