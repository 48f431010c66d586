//! Verdicts on foreign draws as JUnit XML: one test suite, a test for each file.
//!
//! A fail is a `failure`; what is inconclusive is an `error`, a `failure` or `skipped`, as asked for. A file
//! that could not be read is an `error`.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use crate::catalogue::digits::exact;
use crate::harness::record::Verdict;
use crate::judge::judgement::Judgement;
use crate::report::ReportError;
use crate::report::junit::Inconclusive;

/// The verdicts on files of these names, at the level `alpha` together; `unread` are files that could not be
/// read, each with the reason.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn text(
    judgements: &[(String, Judgement)],
    unread: &[(String, String)],
    alpha: f64,
    inconclusive: Inconclusive,
) -> Result<String, ReportError> {
    let mut report = Report::new("trueflight");
    let mut suite = TestSuite::new("judge");
    suite.add_property(("alpha", &*exact(alpha)));
    for (name, judgement) in judgements {
        suite.add_test_case(test(name, judgement, inconclusive));
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

fn test(name: &str, judgement: &Judgement, inconclusive: Inconclusive) -> TestCase {
    let mut status = match (judgement.verdict, inconclusive) {
        (Verdict::Pass, _) => TestCaseStatus::success(),
        (Verdict::Fail, _) | (_, Inconclusive::Failure) => {
            TestCaseStatus::non_success(NonSuccessKind::Failure)
        }
        (_, Inconclusive::Error) => TestCaseStatus::non_success(NonSuccessKind::Error),
        (_, Inconclusive::Skipped) => TestCaseStatus::skipped(),
    };
    if judgement.verdict != Verdict::Pass {
        status.set_type(judgement.verdict.word());
        status.set_message(&*judgement.reason);
    }
    if matches!(judgement.verdict, Verdict::Fail | Verdict::Inconclusive) {
        let numbers = [
            ("draws", Some(judgement.draws as f64)),
            ("mean", judgement.mean),
            ("truth", Some(judgement.truth)),
            ("z", judgement.z),
            ("variance", judgement.variance),
            ("predicted variance", judgement.predicted_variance),
        ];
        let known = numbers.iter().filter_map(|(what, x)| Some(format!("{what} {}", exact((*x)?))));
        let lines: Vec<String> = known.chain(judgement.guarantees.iter().cloned()).collect();
        status.set_description(lines.join("\n"));
    }
    let mut test = TestCase::new(name, status);
    test.set_classname("judge");
    test
}
