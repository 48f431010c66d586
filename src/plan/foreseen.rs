//! Verdicts that are known before the first draw: checks with too few draws to pass.

use crate::checks::Question;
use crate::plan::{Plan, Planned, PlannedCase};
use gate::stats::verdict::Verdict;

/// The best verdict that the planned draws allow, and the draws that allow a better one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Foreseen {
    /// `inconclusive` or `underpowered`; `None` where the planned draws suffice for a pass.
    pub verdict: Option<Verdict>,
    /// The draws that the checks of that verdict need; `None` where no number of draws is enough.
    pub needed: Option<f64>,
    /// Why, with the numbers of draws; empty without a verdict.
    pub reason: String,
}

impl Foreseen {
    /// The best verdict on one channel of an experiment.
    pub fn of(plan: &Plan, case: &PlannedCase, planned: &Planned, channel: usize) -> Self {
        let about = |question: &&Question| question.channel.is_none_or(|about| about == channel);
        let weak: Vec<Weak> = planned
            .questions
            .iter()
            .filter(about)
            .filter_map(|question| Weak::of(plan, case, question))
            .collect();
        let worst = || Verdict::worst(weak.iter().map(|one| one.verdict));
        let verdict = (!weak.is_empty()).then(worst);
        let those = || weak.iter().filter(|one| Some(one.verdict) == verdict);
        let needed = those().map(|one| one.needed).fold(0.0, f64::max);
        let mut reasons: Vec<&str> = Vec::new();
        // Those of the verdict first.
        let others = weak.iter().filter(|one| Some(one.verdict) != verdict);
        for one in those().chain(others).filter(|one| !one.reason.is_empty()) {
            if !reasons.contains(&one.reason.as_str()) {
                reasons.push(&one.reason);
            }
        }
        let needed = verdict.map(|_| needed).filter(|needed| needed.is_finite());
        Self { verdict, needed, reason: reasons.join("; ") }
    }
}

/// A check that cannot pass with the planned draws.
struct Weak {
    verdict: Verdict,
    /// The draws that it needs, infinite where no number is enough.
    needed: f64,
    reason: String,
}

impl Weak {
    fn of(plan: &Plan, case: &PlannedCase, question: &Question) -> Option<Self> {
        // A bias that must be shown needs no promise of a pass.
        let is_promise = !question.expects_bias || question.answer.scalar().is_none();
        let (reason, needed) = question.answer.too_weak(&question.what).filter(|_| is_promise)?;
        Some(Self { verdict: too_weak(plan, case, question), needed, reason: reason.to_string() })
    }
}

/// The verdict on a question that was never promised to pass.
pub fn too_weak(plan: &Plan, case: &PlannedCase, question: &Question) -> Verdict {
    let counts = question.check == "mean" && !case.case.allow_underpowered;
    if counts || plan.options.strict { Verdict::Inconclusive } else { Verdict::Underpowered }
}
