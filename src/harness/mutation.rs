//! Known bugs in the place of honest estimators, on the experiments of a case.

use super::addresses;
use super::case::Case;
use super::plan::{Plan, Planned};
use super::scenario::Scenario;
use crate::estimators::{Experiment, Refusal, Setup};
use crate::mutants::{About, Mutable, Target};

/// Which of a mutant's two walks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Walk {
    /// The one with the bug.
    Faulty,
    /// The same code without it.
    Twin,
}

impl<P: Mutable> Scenario<P> {
    /// A mutant's experiment; `None` if the problem has no mutant of that name.
    pub(super) fn mutant(
        &self,
        name: &str,
        walk: Walk,
        setup: impl FnOnce(&Self) -> Result<Setup<P>, Refusal>,
    ) -> Option<Result<Box<dyn Experiment>, Refusal>> {
        let mutant = P::mutants().into_iter().find(|mutant| mutant.about.name == name)?;
        Some(setup(self).map(|setup| match walk {
            Walk::Faulty => mutant.experiment(setup),
            Walk::Twin => mutant.twin(setup),
        }))
    }
}

/// Finds a mutant's experiment in a plan that has its case.
#[must_use]
pub fn find<'p>(target: &Target, plan: &'p Plan) -> Option<(&'p Case, &'p Planned)> {
    let fits = |planned: &Planned| {
        let swept = planned.variation.map(|(_, value)| value);
        planned.estimator == target.index && swept == target.swept
    };
    let mut experiments = plan.experiments();
    experiments
        .find(|(case, planned)| case.case.name == target.case && fits(planned))
        .map(|(case, planned)| (case.case, planned))
}

/// A mutant's experiment, prepared as the plan prepared the honest one; `None` if the case's problem
/// has no mutant of that name.
#[must_use]
pub fn experiment(
    about: &About,
    walk: Walk,
    case: &Case,
    planned: &Planned,
    seed: u64,
) -> Option<Result<Box<dyn Experiment>, Refusal>> {
    let pilots = addresses::pilots(seed, case, planned.estimator);
    case.scenario.mutated(planned.estimator, planned.variation, pilots, about.name, walk)
}
