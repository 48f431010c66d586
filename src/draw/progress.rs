//! Progress of a drawing: draws made, and draws expected.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::plan::{BLOCK, Plan, Planned};
use gate::stats::gate::{PLANNED, TYPICAL};

/// Event of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Draws that this drawing is expected to make in all: an estimate that becomes exact at its end.
    Expected(u64),
    /// Draws were made.
    Drawn(u64),
    /// Draws of an earlier run were read; they are no part of [`Step::Expected`].
    Kept(u64),
}

/// Listener of a drawing.
pub type Listener<'a> = dyn Fn(Step) + Sync + 'a;

/// Sum of the events so far.
pub(crate) struct Progress<'a> {
    listen: &'a Listener<'a>,
    budget: Option<u64>,
    kept: AtomicU64,
}

impl<'a> Progress<'a> {
    /// Before the first draw.
    pub(crate) fn new(plan: &Plan, listen: &'a Listener<'a>) -> Self {
        Self { listen, budget: plan.options.budget, kept: AtomicU64::new(0) }
    }

    /// Passes on a step.
    pub(crate) fn hear(&self, step: Step) {
        if let Step::Kept(draws) = step {
            self.kept.fetch_add(draws, Ordering::Relaxed);
        }
        (self.listen)(step);
    }

    /// Passes on draws of an earlier run.
    pub(crate) fn keep(&self, draws: impl Iterator<Item = u64>) {
        self.hear(Step::Kept(draws.sum()));
    }

    /// Tells how many draws are expected, from those of each experiment, kept ones with them.
    pub(crate) fn expect(&self, draws: impl Iterator<Item = u64>) {
        let new = draws.sum::<u64>().saturating_sub(self.kept.load(Ordering::Relaxed));
        (self.listen)(Step::Expected(self.budget.map_or(new, |budget| new.min(budget))));
    }
}

/// The last of k scalars passes later than one of them by this share of ln k, as measured on the built-in suite.
const LAST: f64 = 0.12;

/// The draws that an experiment is expected to make: a correct scalar passes after 17/27 of its plan, and one without
/// a promise keeps the drawing open until all planned draws are made.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count of draws
pub fn expected(planned: &Planned) -> u64 {
    if planned.horizon <= planned.draws {
        return planned.horizon;
    }
    let promised =
        planned.scalars().filter(|(_, scalar)| scalar.planned.underpowered.is_none()).count();
    let typical = TYPICAL / PLANNED * (1.0 + LAST * (promised.max(1) as f64).ln());
    let longest = planned.scalars().fold(planned.fixed, |longest, (_, scalar)| {
        let draws = match scalar.planned.underpowered {
            Some(_) => planned.draws,
            None => (scalar.planned.draws * typical).ceil() as u64,
        };
        longest.max(draws)
    });
    (longest.div_ceil(BLOCK) * BLOCK).min(planned.horizon)
}
