//! Case files with random mistakes in a good one, as by a typo, a script or a stray key. Shared by the property tests
//! and by the targets of `fuzz/`.

#![allow(dead_code)] // each user takes its own part

use std::path::PathBuf;

use trueflight::case::Case;
use trueflight::case::CaseError;
use trueflight::case::CaseText;

/// Values that replace a number.
const ODD: [&str; 24] = [
    "0",
    "-0.0",
    "-1",
    "1",
    "2",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "nan",
    "inf",
    "-inf",
    "1e400",
    "9223372036854775807",
    "99999999999999999999",
    "0x10",
    "1979-05-27",
    "true",
    "\"text\"",
    "[]",
    "[1, 2]",
    "{}",
    "{ a = 1 }",
    "\"\\u0000\"",
];

/// Text that is inserted at a random place.
const STRAY: [&str; 16] = [
    "=",
    ".",
    "]",
    "[",
    "}",
    "{",
    "\"",
    "'''",
    "\n",
    "#",
    ",",
    "\u{0}",
    "\u{202e}",
    "é",
    "a = 1\n",
    "[problem]\n",
];

/// Source of choices: 64 bits at a time.
pub struct Choices(pub u64);

impl Choices {
    /// Returns a number below a bound; 0 for a bound of 0.
    #[allow(clippy::cast_possible_truncation)] // below a length
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        let word = (self.0 >> 33) as usize;
        if bound == 0 { 0 } else { word % bound }
    }
}

/// Returns the text with one to four mistakes.
pub fn mutated(text: &str, seed: u64) -> String {
    let mut choices = Choices(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut text = text.to_owned();
    for _ in 0..=choices.below(4) {
        text = with_a_mistake(&text, &mut choices);
    }
    text
}

fn with_a_mistake(text: &str, choices: &mut Choices) -> String {
    match choices.below(10) {
        0..=2 => replaced(
            text,
            choices,
            |c| c.is_ascii_digit() || ".-+e".contains(c),
            |choices, _| ODD[choices.below(ODD.len())].to_owned(),
        ),
        3 => replaced(
            text,
            choices,
            |c| c.is_ascii_alphabetic() || c == '-',
            |choices, word| {
                let at = choices.below(word.len());
                format!("{}{}", &word[..at], &word[(at + 1).min(word.len())..])
            },
        ),
        4 => replaced(
            text,
            choices,
            |c| c.is_ascii_digit() || c == '.',
            |choices, _| {
                let long = [10, 1000, 3000][choices.below(3)];
                format!("[{}]", vec![ODD[choices.below(6)]; long].join(", "))
            },
        ),
        5 => replaced(
            text,
            choices,
            |c| c.is_ascii_digit() || c == '.',
            |choices, _| {
                let deep = [3, 100, 5000][choices.below(3)];
                let (open, close) = [("[", "]"), ("{ a = ", " }")][choices.below(2)];
                format!("{}1{}", open.repeat(deep), close.repeat(deep))
            },
        ),
        6 => lines(text, choices, |lines, choices| {
            let gone = choices.below(lines.len());
            lines.remove(gone);
        }),
        7 => lines(text, choices, |lines, choices| {
            let (from, to) = (choices.below(lines.len()), choices.below(lines.len()));
            lines.insert(to, lines[from]);
        }),
        8 => lines(text, choices, |lines, choices| {
            let (a, b) = (choices.below(lines.len()), choices.below(lines.len()));
            lines.swap(a, b);
        }),
        _ => {
            let mut at = choices.below(text.len() + 1);
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            format!("{}{}{}", &text[..at], STRAY[choices.below(STRAY.len())], &text[at..])
        }
    }
}

/// Replaces one of the words of these letters.
fn replaced(
    text: &str,
    choices: &mut Choices,
    letter: impl Fn(char) -> bool,
    by: impl Fn(&mut Choices, &str) -> String,
) -> String {
    let mut words = Vec::new();
    let mut begin = None;
    for (at, c) in text.char_indices().chain([(text.len(), '\n')]) {
        match (begin, letter(c)) {
            (None, true) => begin = Some(at),
            (Some(from), false) => {
                words.push(from..at);
                begin = None;
            }
            _ => {}
        }
    }
    if words.is_empty() {
        return text.to_owned();
    }
    let word = words.swap_remove(choices.below(words.len()));
    let new = by(choices, &text[word.clone()]);
    format!("{}{new}{}", &text[..word.start], &text[word.end..])
}

fn lines(
    text: &str,
    choices: &mut Choices,
    change: impl Fn(&mut Vec<&str>, &mut Choices),
) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    if !lines.is_empty() {
        change(&mut lines, choices);
    }
    lines.join("\n")
}

/// Reads a case; asserts that a broken one is refused with line, place and cure of every mistake.
pub fn reads_or_names_the_place(text: &str) -> Option<Case> {
    let path = PathBuf::from("cases/transmittance/broken.toml");
    let source = CaseText { name: "broken".into(), path, text: text.to_owned() };
    let error = match Case::read(&source) {
        Ok(case) => return Some(case),
        Err(error) => error,
    };
    assert!(error.mistakes() > 0, "an error without a mistake:\n{text}");
    let shown = error.render(false);
    let CaseError::Faulty { faults, .. } = &error else { panic!("{error}") };
    for fault in faults {
        assert!(!fault.message.is_empty() && !fault.help.is_empty(), "no words: {fault:?}\n{text}");
        let is_syntax = fault.help == "this is not TOML";
        let names_a_key = fault.message.contains('`') || !fault.path.is_empty();
        assert!(is_syntax || names_a_key, "no key: {fault:?}\n{text}");
        assert!(fault.message.len() < 2000, "too long: {}…", &fault.message[..200]);
    }
    // Each mistake has a line and a column.
    let places = shown.matches("broken.toml:").count();
    assert_eq!(places, faults.len().min(50), "{shown}\n{text}");
    None
}
