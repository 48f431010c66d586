//! Whole distributions and channels of a case, from C.
#![cfg(feature = "theory")]

use crate::build::{Link, Program, here};

#[test]
fn flights_and_channels_are_judged_by_a_case() {
    let program = Program::new("tests/programs/distributions.c", Link::Shared, &[]);
    let field = here().join("../../tests/data/field").display().to_string();
    let (code, text) = program.run_with(&[&field]);
    assert_eq!(code, Some(0), "{text}");
    for left in ["length", "beyond", "inf", "minus one"] {
        assert!(text.contains(&format!("{left}: 0 \n")), "{left}: {text}");
    }
    for (what, words) in [
        ("zero", "1 flights that leave: there are none, although 8.21 % should leave"),
        ("two lengths", "1 the distribution of the distances differs from theory"),
        ("channels", "0, 3 values, 4 draws"),
        ("no values", "3 check `no values`: values = 0 is not a whole number from 1 to 65536"),
        (
            "two",
            "check `two`: a draw has 2 values, but the case has 4 channels (channel 1, channel 2",
        ),
    ] {
        assert!(text.contains(&format!("\n{what}: {words}")), "{what}: {text}");
    }
}
