//! Verdicts on foreign draws as JUnit XML: one test suite, and one test per file or stack of images.
//!
//! A fail is a `failure`; an inconclusive verdict is an `error`, a `failure` or `skipped`, as asked for. A file that
//! could not be read is an `error`.

use crate::judge::{Judgement, images};
use crate::record::Verdict;
use crate::report::junit::{self, ResultKind, Suite, Test, Trouble};
use crate::report::run::junit::{Inconclusive, trouble_of};
use numeric::digits::number;

/// Verdict on a file or a stack of images.
#[derive(Debug, Clone)]
pub struct JUnitCase {
    name: String,
    verdict: Verdict,
    reason: String,
    /// Numbers and promises.
    lines: Vec<String>,
}

impl JUnitCase {
    /// Returns the verdict on draws of this name.
    pub fn of_draws(name: &str, judgement: &Judgement) -> Self {
        let numbers = [
            ("draws", Some(judgement.draws as f64)),
            ("mean", judgement.mean),
            ("truth", Some(judgement.truth)),
            ("z", judgement.z),
            ("variance", judgement.variance),
            ("predicted variance", judgement.predicted_variance),
        ];
        let known =
            numbers.iter().filter_map(|(what, x)| Some(format!("{what} {}", number((*x)?))));
        let mut lines: Vec<String> = known.chain(judgement.guarantees.iter().cloned()).collect();
        lines.extend(judgement.pattern().lines());
        let (verdict, reason) = (judgement.verdict, judgement.reason.clone());
        Self { name: name.to_owned(), verdict, reason, lines }
    }

    /// Returns the verdict on images of this name.
    pub fn of_images(name: &str, judgement: &images::Judgement) -> Self {
        let counts = judgement.counts;
        let numbers = [
            ("passes", judgement.passes),
            ("tiles", counts.tiles),
            ("failing tiles", counts.fail),
            ("listed tiles", counts.listed),
        ];
        let known = numbers.iter().map(|(what, count)| format!("{what} {count}"));
        let mut lines: Vec<String> = known.chain(judgement.guarantees.iter().cloned()).collect();
        lines.extend(judgement.likely());
        let (verdict, reason) = (judgement.verdict, judgement.reason.clone());
        Self { name: name.to_owned(), verdict, reason, lines }
    }
}

/// Returns the verdicts, at the level `alpha` together; `unread` are files that could not be read, each with the
/// reason.
pub fn text(
    cases: &[JUnitCase],
    unread: &[(String, String)],
    alpha: f64,
    inconclusive: Inconclusive,
) -> String {
    let unread = unread.iter().map(|(name, reason)| Test {
        name: name.clone(),
        class: Some("judge".to_owned()),
        trouble: Some(Trouble {
            kind: ResultKind::Error,
            word: "unreadable",
            message: reason.clone(),
            details: None,
        }),
        ..Test::default()
    });
    let suite = Suite {
        name: "judge".to_owned(),
        properties: vec![("alpha", number(alpha))],
        tests: cases.iter().map(|case| test(case, inconclusive)).chain(unread).collect(),
        ..Suite::default()
    };
    junit::text(&[suite], None)
}

fn test(case: &JUnitCase, inconclusive: Inconclusive) -> Test {
    let is_remarkable = case.verdict == Verdict::Pass && !case.reason.is_empty();
    Test {
        name: case.name.clone(),
        class: Some("judge".to_owned()),
        time: None,
        trouble: trouble_of(case.verdict, &case.reason, inconclusive, || case.lines.join("\n")),
        output: is_remarkable.then(|| format!("pass: {}", case.reason)),
    }
}
