//! Options that take numbers say which.

use assert_cmd::Command;

#[test]
fn numbers_that_no_option_takes_are_told_what_it_takes() {
    for (arguments, takes) in [
        ("run --threads -1", "'--threads <N>': it takes a whole number from 1 to 1024"),
        ("run --seed 1.5", "'--seed <N>': it takes a whole number from 0 to 18446744073709551615"),
        ("run --blocks-per-look 0", "'--blocks-per-look <K>': it takes a whole number from 1 to"),
        ("bench --rounds many", "'--rounds <N>': it takes a whole number from 1 to 10000"),
        ("judge --truth half", "'--truth <T>': it takes a number, such as"),
    ] {
        let mut command = Command::cargo_bin("trueflight").expect("the program");
        let output = command.args(arguments.split_whitespace()).output().expect("it runs");
        let said = String::from_utf8(output.stderr).expect("text");
        assert_eq!(output.status.code(), Some(2), "trueflight {arguments}: {said}");
        assert!(said.contains(takes), "trueflight {arguments}: {said}");
    }
}
