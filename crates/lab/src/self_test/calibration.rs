//! Correct experiments, run many times: how often does a run fail, and how often does a bias of ε
//! pass?
//!
//! ```text
//! false alarms   runs with any failure, promised ≤ α, and scalars failed, promised ≤ 0.8 α/K each
//! false passes   scalars with a bias of ±ε that pass, promised ≤ β each
//! p-values       uniform: the share below 1e-1, 1e-2 and 1e-3, and Anderson–Darling over all
//! ```
//!
//! Rates come with their Clopper–Pearson limits at 99 %. A promise is broken when the lower limit
//! is above it. At 99 % each, one of a hundred kept promises would look broken, so the verdict uses limits
//! at 1 − 1e-6.

use gate::CheckId;
use std::collections::BTreeMap;

use gate::stats::verdict::{MISS, Verdict};
use gate::stats::{anderson_darling, binomial};
use theory::parallel;
use trueflight::case::{Case, CaseError, suite};
use trueflight::checks;
use trueflight::draw::run;
use trueflight::plan::Plan;
use trueflight::plan::options::Options;
use trueflight::record::evaluate;

/// The run-level α of the calibration.
pub const ALPHA: f64 = 1e-2;
/// The level of the limits shown.
const SHOWN: f64 = 0.99;
/// The level at which a promise counts as broken.
const CERTAIN: f64 = 1.0 - 1e-6;
/// P-values that are uniform look otherwise once in a million times.
const NOT_UNIFORM: f64 = 1e-6;

/// Number of runs that share one plan.
const CHUNK: u64 = 50;

/// A rate against a promise.
#[derive(Debug, Clone, PartialEq)]
pub struct Rate {
    /// Event that is counted.
    pub what: String,
    /// Number of trials with the event.
    pub count: u64,
    /// Number of trials.
    pub trials: u64,
    /// Largest rate that the promise allows.
    pub promise: f64,
    /// The limits of the rate at 99 %.
    pub limits: [f64; 2],
    /// True if the counts do not refute the promise.
    pub is_kept: bool,
}

impl Rate {
    fn new(what: impl Into<String>, count: u64, trials: u64, promise: f64) -> Self {
        let (low, high) = binomial::interval(count, trials, SHOWN);
        let is_kept = binomial::interval(count, trials, CERTAIN).0 <= promise;
        Self { what: what.into(), count, trials, promise, limits: [low, high], is_kept }
    }
}

/// The p-values of one check over all runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Uniformity {
    /// The check.
    pub check: CheckId,
    /// The rates below 0.1, 0.01 and 0.001.
    pub below: Vec<Rate>,
    /// The p-value of the hypothesis that they are uniform, by Anderson–Darling; `None` for checks
    /// that only promise not to be small too often.
    pub p: Option<f64>,
}

/// Result of the calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Number of independent runs.
    pub runs: u64,
    /// Scalars in each run.
    pub scalars: usize,
    /// P-values in each run.
    pub laws: usize,
    /// Draws of all runs.
    pub draws: u64,
    /// False alarms and false passes.
    pub rates: Vec<Rate>,
    /// The checks with p-values.
    pub uniformity: Vec<Uniformity>,
}

impl Calibration {
    /// Returns whether no promise is refuted.
    pub fn holds(&self) -> bool {
        let shares = self.uniformity.iter().flat_map(|check| &check.below);
        let are_uniform =
            self.uniformity.iter().filter_map(|check| check.p).all(|p| p > NOT_UNIFORM);
        self.rates.iter().chain(shares).all(|rate| rate.is_kept) && are_uniform
    }
}

/// Counts over runs.
#[derive(Debug, Clone, Default)]
pub struct Counts {
    runs: u64,
    failed_runs: u64,
    draws: u64,
    /// Per check: scalars, those that failed, those that passed with a bias.
    scalars: BTreeMap<CheckId, [u64; 2]>,
    biased: BTreeMap<CheckId, [u64; 2]>,
    p: BTreeMap<CheckId, Vec<f64>>,
}

/// Result of one check in one run.
#[derive(Debug, Clone)]
pub struct Checked {
    /// The check.
    pub check: CheckId,
    /// Verdict of the check.
    pub verdict: Verdict,
    /// True if the check is a scalar, judged by the gate.
    pub is_scalar: bool,
    /// True if the draws sufficed for a pass.
    pub is_powered: bool,
    /// P-value of the check; `None` for checks without one.
    pub p: Option<f64>,
}

impl Counts {
    /// Counts a run of correct experiments.
    pub fn add_fair(&mut self, draws: u64, checked: Vec<Checked>) {
        self.runs += 1;
        self.draws += draws;
        self.failed_runs += u64::from(checked.iter().any(|one| one.verdict == Verdict::Fail));
        for Checked { check, verdict, is_scalar, p, .. } in checked {
            if is_scalar {
                let [all, some] = self.scalars.entry(check).or_default();
                *all += 1;
                *some += u64::from(verdict == Verdict::Fail);
            }
            if let Some(p) = p {
                self.p.entry(check).or_default().push(p);
            }
        }
    }

    /// Counts a run of experiments that are off by their tolerance.
    pub fn add_biased(&mut self, draws: u64, checked: Vec<Checked>) {
        self.draws += draws;
        for Checked { check, verdict, .. } in checked.into_iter().filter(|one| one.is_powered) {
            let [all, some] = self.biased.entry(check).or_default();
            *all += 1;
            *some += u64::from(verdict == Verdict::Pass);
        }
    }

    /// Adds the counts of later runs.
    pub fn merge(&mut self, later: Self) {
        self.runs += later.runs;
        self.failed_runs += later.failed_runs;
        self.draws += later.draws;
        for (ours, theirs) in [(&mut self.scalars, later.scalars), (&mut self.biased, later.biased)]
        {
            for (check, [all, some]) in theirs {
                let [total, part] = ours.entry(check).or_default();
                (*total, *part) = (*total + all, *part + some);
            }
        }
        for (check, p) in later.p {
            self.p.entry(check).or_default().extend(p);
        }
    }

    /// Compares the counts with the promises, given the numbers of scalars and p-values of a run.
    pub fn close(
        self,
        scalars: usize,
        laws: usize,
        is_uniform: impl Fn(CheckId) -> bool,
    ) -> Calibration {
        let mut rates = vec![Rate::new("a correct run fails", self.failed_runs, self.runs, ALPHA)];
        let share = 0.8 * ALPHA / scalars.max(1) as f64;
        rates.extend(by_name(self.scalars).into_iter().map(|(check, [all, failed])| {
            Rate::new(format!("a correct {check} fails"), failed, all, share)
        }));
        rates.extend(by_name(self.biased).into_iter().map(|(check, [all, passed])| {
            Rate::new(format!("a {check} off by its tolerance passes"), passed, all, MISS)
        }));
        let p = by_name(self.p).into_iter();
        let uniformity = p.map(|(check, p)| Uniformity::new(is_uniform(check), check, p));
        Calibration {
            runs: self.runs,
            scalars,
            laws,
            draws: self.draws,
            rates,
            uniformity: uniformity.collect(),
        }
    }
}

/// Returns the entries in the order of the checks' names, as in the tables.
fn by_name<T>(of: BTreeMap<CheckId, T>) -> Vec<(CheckId, T)> {
    let mut entries: Vec<_> = of.into_iter().collect();
    entries.sort_by_key(|(check, _)| check.name());
    entries
}

impl Uniformity {
    fn new(is_uniform: bool, check: CheckId, mut p: Vec<f64>) -> Self {
        p.sort_by(f64::total_cmp);
        let all = p.len() as u64;
        let below = [1e-1, 1e-2, 1e-3].map(|level| {
            let count = p.partition_point(|&p| p < level) as u64;
            Rate::new(format!("p of {check} below {level}"), count, all, level)
        });
        let p = is_uniform.then(|| anderson_darling::p_value_of_uniforms(&p));
        Self { check, below: below.to_vec(), p }
    }
}

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
