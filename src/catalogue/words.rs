//! How messages put things: ranges, lists of names, and the name that was probably meant.

use std::ops::RangeInclusive;

/// A range of counts in words.
pub fn whole(range: &RangeInclusive<u64>) -> String {
    format!("a whole number from {} to {}", range.start(), range.end())
}

/// Words in back ticks, with commas between them.
pub fn quoted<S: AsRef<str>>(words: &[S]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("`{}`", word.as_ref())).collect();
    words.join(", ")
}

/// "did you mean" where a known word is near, the whole list where none is.
pub fn suggestion(written: &str, words: &[&str], otherwise: &str) -> String {
    let near = words.iter().map(|word| (distance(written, word), word)).min();
    match near {
        Some((edits, word)) if edits <= 1 + written.len() / 4 => {
            format!("did you mean `{word}`? ({otherwise})")
        }
        _ => otherwise.to_owned(),
    }
}

/// The number of letters to insert, delete or replace (V. Levenshtein, 1966).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replace = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replace.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
