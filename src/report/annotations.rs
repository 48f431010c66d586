//! Annotations on GitHub: workflow commands that put failures on the page of the change.
//!
//! `::error title=…,file=…::message` for what fails, `::warning` for what is inconclusive. GitHub
//! shows ten of each per step: where there are more, the tenth and following give way to one that
//! counts them.

use std::fmt::Write;

use crate::harness::record::{Record, Verdict};
use crate::report::troubles::{Trouble, troubles};

/// How many of a kind GitHub shows.
const MOST: usize = 10;

/// The commands, one to a line; empty where all is well.
#[must_use]
pub fn text(record: &Record) -> String {
    let mut text = String::new();
    for (verdict, command) in [(Verdict::Fail, "error"), (Verdict::Inconclusive, "warning")] {
        let troubles = troubles(record, verdict);
        let shown = if troubles.len() > MOST { MOST - 1 } else { troubles.len() };
        for trouble in &troubles[..shown] {
            let _ = writeln!(text, "{}", annotation(command, verdict, trouble));
        }
        let left = troubles.len() - shown;
        if left > 0 {
            let word = verdict.word();
            let _ = writeln!(
                text,
                "::{command} title=trueflight {word}::and {left} more; the summary of the job and \
                 the reports have them all"
            );
        }
    }
    text
}

fn annotation(command: &str, verdict: Verdict, trouble: &Trouble) -> String {
    let (case, row) = (trouble.case, trouble.row);
    let title = format!("{} {}: {}", verdict.word(), case.name, trouble.experiment());
    let mut properties = format!("title={}", property(&title));
    if !case.path.is_empty() {
        let path = case.path.strip_prefix("./").unwrap_or(&case.path);
        let _ = write!(properties, ",file={}", property(path));
    }
    let mut said = format!("{} ({})", trouble.reason(), trouble.place());
    if !trouble.check().is_empty() {
        said = format!("{}: {said}", trouble.check());
    }
    if !row.command.is_empty() {
        said = format!("{said}\nrepeat: {}", row.command);
    }
    format!("::{command} {properties}::{}", message(&said))
}

fn message(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    message(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_github_takes_for_its_own_is_escaped() {
        assert_eq!(message("5 %\r\na: b, c"), "5 %25%0D%0Aa: b, c");
        assert_eq!(property("5 %\r\na: b, c"), "5 %25%0D%0Aa%3A b%2C c");
    }
}
