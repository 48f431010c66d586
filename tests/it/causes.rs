//! What usually causes a failure: the table against the patterns of all known bugs.

use trueflight::catalogue::causes::Pattern;
use trueflight::self_test::mutation;

/// A pattern as one word of the table: mean, variance and lookups by their sign, then a letter for each other check.
fn word(pattern: &Pattern) -> String {
    let mut word: String =
        [pattern.mean, pattern.variance, pattern.lookups].map(|side| side.sign()).iter().collect();
    let others = [
        (pattern.curve, 'c'),
        (pattern.distribution, 'd'),
        (pattern.balance, 'b'),
        (pattern.number, 'n'),
        (pattern.dependence, 's'),
        (pattern.resolution, 'r'),
    ];
    word.extend(others.iter().filter(|other| other.0).map(|other| other.1));
    word
}

#[test]
#[ignore = "long: writes the patterns of all known bugs anew"]
fn write_patterns() {
    for (name, pattern) in mutation::patterns(1, 1_000_000, &|_| true).expect("cases") {
        println!("PATTERN,{name},{}", word(&pattern));
    }
}
