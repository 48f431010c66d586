//! Verdicts on draws of other programs: blocks of lines on the screen, and `JUnit`.

pub mod images;
pub mod junit;

use crate::judge::Judgement;
use crate::record::Verdict;
use crate::report::layout::wrapped;
use numeric::digits::short;
use std::fmt::Write;

/// Width of the widest word at the left.
const INDENT: usize = 10;

/// Returns the block on draws, `width` columns wide.
pub fn block(judgement: &Judgement, name: &str, width: usize) -> String {
    lines(&judgement.lines(name), width)
}

/// Returns lines, each with a word at its left, `width` columns wide.
fn lines(lines: &[(&str, String)], width: usize) -> String {
    let mut text = String::new();
    for (word, what) in lines {
        for (i, part) in wrapped(what, width.max(40) - INDENT).iter().enumerate() {
            let word = if i == 0 { word } else { "" };
            let _ = writeln!(text, "{word:INDENT$}{part}");
        }
    }
    text
}

/// Returns the summary of several verdicts; `of` names the draws in words.
pub fn together<'a>(
    judged: &(impl Iterator<Item = &'a Judgement> + Clone),
    of: &str,
    worst: Verdict,
    alpha: f64,
) -> String {
    let counted = |verdict: Verdict| {
        let count = judged.clone().filter(|judgement| judgement.verdict == verdict).count();
        (count > 0).then(|| format!("{count} {}", verdict.word()))
    };
    let counts: Vec<String> = [Verdict::Pass, Verdict::Fail, Verdict::Inconclusive]
        .into_iter()
        .filter_map(counted)
        .collect();
    let alpha = short(alpha, 3);
    format!("\n{}: {} {of}, α = {alpha} shared\n", worst.word(), counts.join(", "))
}
