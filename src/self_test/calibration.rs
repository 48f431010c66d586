//! Calibration cases, run from many seeds as they are and with a bias of ε: the counts that [`lab::calibration`]
//! compares with the promises.

use crate::case::{Case, CaseError, suite};
use crate::checks;
use crate::draw::run;
use crate::plan::Plan;
use crate::plan::options::Options;
use crate::record::evaluate;
use lab::calibration::{ALPHA, Calibration, Checked, Counts};
use theory::parallel;

/// Number of runs that share one plan.
const CHUNK: u64 = 50;

/// Runs the calibration cases from `runs` seeds.
///
/// # Errors
///
/// A built-in case cannot be read.
pub fn calibrate(runs: u64, progress: &(dyn Fn(u64) + Sync)) -> Result<Calibration, CaseError> {
    let cases: Vec<Case> = suite::calibration().iter().map(Case::read).collect::<Result<_, _>>()?;
    let options = Options { alpha: ALPHA, ..Options::default() };
    let levels = Plan::new(&cases, &options).levels;
    let counted: Vec<Counts> = parallel::numbered(runs.div_ceil(CHUNK), |chunk| {
        let seeds = 1 + chunk * CHUNK..1 + ((chunk + 1) * CHUNK).min(runs);
        let mut counts = Counts::default();
        let mut correct = Plan::new(&cases, &options);
        let mut biased = Plan::new(&cases, &options);
        // Half of the chunks are biased upwards, half downwards.
        shift(&mut biased, if chunk % 2 == 0 { 1.0 } else { -1.0 });
        for seed in seeds {
            let (draws, checked) = draw(&mut correct, seed);
            counts.add_fair(draws, checked);
            let (draws, checked) = draw(&mut biased, seed);
            counts.add_biased(draws, checked);
            progress(1);
        }
        counts
    });
    let mut total = Counts::default();
    for counts in counted {
        total.merge(counts);
    }
    Ok(total.close(levels.scalars, levels.distributions, checks::is_uniform))
}

/// Draws a plan from another seed.
fn draw(plan: &mut Plan, seed: u64) -> (u64, Vec<Checked>) {
    plan.reseed(seed);
    let draws = run::draw(plan, &|_| {});
    let drawn = draws.experiments.iter().map(|one| one.drawn.draws).sum();
    let findings = evaluate::run(plan, &draws).into_iter().flat_map(|judged| judged.findings);
    let checked = findings.map(|finding| {
        let is_powered = finding.gate.is_some_and(|gate| gate.needed.is_none());
        let (is_scalar, p, check) = (finding.gate.is_some(), finding.p, finding.check);
        Checked { check, verdict: finding.verdict, is_scalar, is_powered, p }
    });
    (drawn, checked.collect())
}

/// Adds `sign · ε` to every scalar: a bias of exactly the tolerance.
fn shift(plan: &mut Plan, sign: f64) {
    let experiments = plan.cases.iter_mut().flat_map(|case| &mut case.experiments);
    for question in experiments.flat_map(|planned| &mut planned.questions) {
        question.answer.shift(sign);
    }
}
