//! Cases with mistakes, or with requests that no estimator can fulfil, and the messages: the sheets of `tests/wrong/`.
//!
//! A sheet has correct cases, as text or as a file of the repository, each with lists of changes to it. A line of a
//! list has changes, `from => to`, and words of the message. Changes of `mistakes` must be refused when the case is
//! read, those of `refused` when an experiment is planned.

use std::path::Path;

use serde::Deserialize;
use trueflight::record::{Row, Verdict};

use crate::common::{mistakes, none, predicted};

#[derive(Deserialize)]
struct Sheet {
    case: Vec<Right>,
}

/// Case without mistakes, and lists of changes to it.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
#[derive(Default)]
struct Right {
    text: String,
    file: String,
    /// True if each of the changes makes exactly one mistake.
    is_one_each: bool,
    mistakes: Vec<Vec<String>>,
    refused: Vec<Vec<String>>,
}

/// Returns the case with the changes of a line, and the words of the line.
fn changed<'a>(text: &str, line: &'a [String]) -> (String, Vec<&'a str>) {
    let (mut text, mut words) = (text.to_owned(), Vec::new());
    for part in line {
        let Some((from, to)) = part.split_once("=>") else {
            words.push(part.as_str());
            continue;
        };
        let (from, to) = (from.trim(), to.trim());
        assert!(text.contains(from), "`{from}` is not in:\n{text}");
        text = text.replacen(from, to, 1);
    }
    assert!(!words.is_empty(), "no words: {line:?}");
    (text, words)
}

/// Returns whether a text has the words of a line, and none of those after `!`.
fn says(text: &str, words: &[&str]) -> bool {
    words.iter().all(|word| {
        let forbidden = word.strip_prefix('!');
        forbidden.map_or_else(|| text.contains(word), |word| !text.contains(word))
    })
}

/// Lists the differences from a sheet, and returns the number of lines in it.
fn wrong(sheet: &Path) -> (Vec<String>, usize) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |path: &Path| std::fs::read_to_string(path).expect("a file");
    let Sheet { case } =
        toml::from_str(&read(sheet)).unwrap_or_else(|error| panic!("{}: {error}", sheet.display()));
    let (mut wrong, mut count) = (Vec::new(), 0);
    for right in case {
        let file = (!right.file.is_empty()).then(|| read(&root.join(&right.file)));
        let whole = file.unwrap_or(right.text);
        if let Some(error) = mistakes(&whole) {
            wrong.push(format!("{}\n{whole}", error.render(false)));
        }
        if !right.refused.is_empty() {
            let is_refused = |row: &Row| row.verdict == Some(Verdict::Refused);
            let refused = predicted(&whole).into_iter().filter(is_refused);
            wrong.extend(refused.map(|row| format!("{}: {}\n{whole}", row.name(), row.reason())));
        }
        count += right.mistakes.len() + right.refused.len();
        for line in &right.mistakes {
            let (text, words) = changed(&whole, line);
            let error = mistakes(&text);
            let said = error.as_ref().map_or_else(String::new, |error| error.render(false));
            let is_one = error.as_ref().is_some_and(|error| error.mistakes() == 1);
            if error.is_none() || !says(&said, &words) || right.is_one_each && !is_one {
                wrong.push(format!("{line:?}: {said}"));
            }
        }
        for line in &right.refused {
            let (text, words) = changed(&whole, line);
            let rows = predicted(&text);
            let refused = rows.iter().filter(|row| row.verdict == Some(Verdict::Refused));
            let reasons: Vec<String> = refused.map(Row::reason).collect();
            if !reasons.iter().any(|reason| says(reason, &words)) {
                wrong.push(format!("{line:?}: {reasons:?}"));
            }
        }
    }
    (wrong, count)
}

#[test]
fn every_sheet_says_what_is_said() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong");
    let (mut all, mut lines) = (Vec::new(), 0);
    for entry in std::fs::read_dir(folder).expect("the sheets") {
        let (wrong, count) = wrong(&entry.expect("a sheet").path());
        all.extend(wrong);
        lines += count;
    }
    none(&all);
    assert!(lines > 150, "only {lines} lines");
}
