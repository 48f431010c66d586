//! Verdicts on foreign draws as JUnit XML: one test suite, and one test per file or stack of images.
//!
//! A fail is a `failure`; an inconclusive verdict is an `error`, a `failure` or `skipped`, as asked for. A file that
//! could not be read is an `error`.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use crate::judge::{Judgement, images};
use crate::record::Verdict;
use crate::report::ReportError;
use crate::report::run::junit::Inconclusive;
use numeric::digits::exact;

/// Verdict on a file or a stack of images.
#[derive(Debug, Clone)]
pub struct Told {
    name: String,
    verdict: Verdict,
    reason: String,
    /// Numbers and promises.
    lines: Vec<String>,
}

impl Told {
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
        let known = numbers.iter().filter_map(|(what, x)| Some(format!("{what} {}", exact((*x)?))));
        Self {
            name: name.to_owned(),
            verdict: judgement.verdict,
            reason: judgement.reason.clone(),
            lines: known
                .chain(judgement.guarantees.iter().cloned())
                .chain(judgement.pattern().lines())
                .collect(),
        }
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
        let numbers = numbers.iter().map(|(what, count)| format!("{what} {count}"));
        Self {
            name: name.to_owned(),
            verdict: judgement.verdict,
            reason: judgement.reason.clone(),
            lines: numbers
                .chain(judgement.guarantees.iter().cloned())
                .chain(judgement.pattern().lines())
                .collect(),
        }
    }
}

/// Returns the verdicts, at the level `alpha` together; `unread` are files that could not be read, each with the
/// reason.
///
/// # Errors
///
/// The encoder fails.
pub fn text(
    told: &[Told],
    unread: &[(String, String)],
    alpha: f64,
    inconclusive: Inconclusive,
) -> Result<String, ReportError> {
    let mut report = Report::new("trueflight");
    let mut suite = TestSuite::new("judge");
    suite.add_property(("alpha", &*exact(alpha)));
    for told in told {
        suite.add_test_case(test(told, inconclusive));
    }
    for (name, reason) in unread {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_type("unreadable").set_message(&**reason);
        let mut test = TestCase::new(&**name, status);
        test.set_classname("judge");
        suite.add_test_case(test);
    }
    report.add_test_suite(suite);
    // The schema has no count of skipped tests at the root; the suite has it.
    let skipped = format!(" skipped=\"{}\"", report.skipped);
    Ok(report.to_string()?.replacen(&skipped, "", 1))
}

fn test(told: &Told, inconclusive: Inconclusive) -> TestCase {
    let mut status = match (told.verdict, inconclusive) {
        (Verdict::Pass, _) => TestCaseStatus::success(),
        (Verdict::Fail, _) | (_, Inconclusive::Failure) => {
            TestCaseStatus::non_success(NonSuccessKind::Failure)
        }
        (_, Inconclusive::Error) => TestCaseStatus::non_success(NonSuccessKind::Error),
        (_, Inconclusive::Skipped) => TestCaseStatus::skipped(),
    };
    if told.verdict != Verdict::Pass {
        status.set_type(told.verdict.word());
        status.set_message(&*told.reason);
    }
    if matches!(told.verdict, Verdict::Fail | Verdict::Inconclusive) {
        status.set_description(told.lines.join("\n"));
    }
    let mut test = TestCase::new(&*told.name, status);
    if told.verdict == Verdict::Pass && !told.reason.is_empty() {
        test.set_system_out(format!("pass: {}", told.reason));
    }
    test.set_classname("judge");
    test
}
