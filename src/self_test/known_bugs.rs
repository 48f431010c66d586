//! Known bugs in the place of correct estimators, on the experiments of a case.

use crate::case::Case;
use crate::plan::{Plan, Planned};
use estimators::{Experiment, Refusal};
use lab::mutants::{self, About, Target};

pub use lab::mutants::Walk;

/// Finds a mutant's experiment in a plan that has its case.
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

/// A mutant's experiment, prepared as the plan prepared the correct one; `None` if the case's problem
/// has no mutant of that name.
pub fn experiment(
    about: &About,
    walk: Walk,
    case: &Case,
    planned: &Planned,
    seed: u64,
) -> Option<Result<Box<dyn Experiment>, Refusal>> {
    let pilots = case.pilots(seed, planned.estimator);
    match case.at(planned.variation).and_then(|at| at.setup(planned.estimator, pilots)) {
        Ok(setup) => mutants::experiment(about.name, walk, setup).map(Ok),
        Err(refusal) => Some(Err(refusal)),
    }
}
