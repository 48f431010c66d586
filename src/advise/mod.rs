//! Advice: the estimators of a problem with their best settings, ranked by the predicted time to an error.
//!
//! ```text
//! time to ε = V/(ε²T²) · cost,   cost = draw + lookup · (E[lookups] + setup lookups/draws per ray)
//! ```
//!
//! V and the lookups are those of exact theory; nothing is drawn but to measure the two costs. The free settings of each
//! estimator are a constant σ̂ or a factor on local majorants, numbers of segments, cells, explorers and octaves, rules
//! and albedos. Estimators that need the exact τ are ranked apart, and so are those with a variance that theory only
//! bounds.
//!
//! In the place of `ray` a case may have `rays`, which `advise` alone takes. V·cost is then the mean over the rays, and
//! errors are relative to their mean transmittance:
//!
//! | key | meaning | default |
//! |---|---|---|
//! | `rays = { random }` | this number of lines through the volume, uniform and isotropic | |
//! | `rays = { random, camera }` | rays of this number of pixels of a `camera`, as in a picture | |
//! | `rays = [{ origin, direction, length }, …]` | these | `length`: through the whole volume |
//!
//! `docs/advise.md` explains the table and derives the best σ̂ along a ray.

pub mod candidates;
pub mod costs;
pub mod options;
pub mod profile;
pub mod rays;
pub mod search;
pub mod study;

pub use costs::Costs;

/// The manual of advice.
pub const CATALOGUE: PageList = PageList {
    name: "advice",
    pages: &[Page { module: "advise", source: include_str!("mod.rs") }],
};

use std::time::Instant;

use crate::case::sweep::{Variation, What};
use crate::case::{Case, CaseError, Spec};
use candidates::Collisions;
use costs::Prices;
use media::Body;
use media::catalogue::{Page, PageList};
use numeric::digits::number;
use search::{BEYOND, Kind, MAX_FACTOR, UNKNOWN};
use study::{Best, Score, Study};
use theory::parallel;

/// Difference of two times that is a tie, with exact costs: settings are searched to this accuracy.
const TIE: f64 = 1e-3;

/// Standard error of a sample variance that can be trusted.
const TRUST: f64 = 0.1;
/// Factor on the least σ̂ at which the inequality that it must satisfy is violated.
const BELOW: f64 = 0.99;
/// Number of rows with a price that is corrected by draws at the advised σ̂.
const CORRECTED: usize = 8;
/// Number of curves: of the first rows with a constant σ̂.
pub const CURVES: usize = 5;
/// Number of points of a curve on each side of the best σ̂.
const POINTS: i32 = 8;
/// Range of σ̂ of a curve on each side, as a factor.
const WIDTH: f64 = 10.0;

/// Goal of the draws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// A standard error relative to the transmittance; over several rays, relative to its mean.
    Error(f64),
    /// A cost, in the unit of the costs: the error is what is left.
    Budget(f64),
}

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// Goal of the draws.
    pub target: Target,
    /// Costs of draws.
    pub costs: Costs,
    /// Number of random rays in place of the case's own.
    pub rays: Option<u64>,
    /// Seed of random rays.
    pub seed: u64,
    /// Factor by which majorants exceed the maximum, 1 or more.
    pub looseness: f64,
}

/// Group of rows that are ranked together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Exact variance, and nothing that is as hard to know as the answer.
    #[default]
    Ranked,
    /// Theory only bounds the variance: the time is a bound.
    Bounded,
    /// Needs τ, which is the answer itself.
    Informed,
}

impl Group {
    /// The word in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Ranked => "ranked",
            Self::Bounded => "bounded",
            Self::Informed => "informed",
        }
    }
}

/// One estimator with its best settings.
#[derive(Debug, Clone, Default)]
pub struct Row {
    /// Number of the candidate.
    pub candidate: usize,
    /// Its constant σ̂ or factor on σ̂; `None` where it is not free.
    pub setting: Variation,
    /// Group that it is ranked in.
    pub group: Group,
    /// Rank in its group, from 1; tied rows have the same.
    pub rank: usize,
    /// True if another row of the group is within the error of the costs.
    pub is_tie: bool,
    /// Estimator with its settings, as in `single (adaptive, a=0.3)`.
    pub estimator: String,
    /// σ̂ in words: `constant`, `local majorants, 8 segments`; empty for none.
    pub sampling: String,
    /// The constant σ̂, 1/length.
    pub constant: Option<f64>,
    /// Factor on a σ̂ that is not constant.
    pub factor: Option<f64>,
    /// Control in words; empty for none.
    pub control: String,
    /// Kind of the setting.
    pub kind: Kind,
    /// Variance and cost of a draw.
    pub score: Score,
    /// Draws to the target error, or within the budget.
    pub draws: f64,
    /// Cost to the target error, or the budget.
    pub time: f64,
    /// Relative error at that cost.
    pub error: f64,
    /// Times of the rays with the least and the most, at the target error.
    pub times: [f64; 2],
    /// Relative error of the costs.
    pub cost_error: f64,
    /// Factors on σ̂ below and above which V·cost doubles, 0 and infinite for none; `None` where σ̂ is not free.
    pub margins: Option<[f64; 2]>,
    /// Least σ̂ or factor for which the estimator exists with a finite variance, 0 for any; `None` where σ̂ is not free.
    pub least: Option<f64>,
    /// Draws until the sample variance, and so the estimated error, has a standard error of 10 %.
    pub trusted: Option<f64>,
    /// Constant σ̂ and the cost to the target error, or the error within the budget, of the first rows with a constant σ̂.
    pub curve: Vec<[f64; 2]>,
    /// Knowledge of the medium that it needs beside lookups.
    pub needs: String,
    /// The lines for a case.
    pub lines: String,
}

/// The best σ̂ along a ray, in steps.
#[derive(Debug, Clone)]
pub struct Profile {
    /// Estimator.
    pub estimator: String,
    /// Ends of the steps.
    pub breaks: Vec<f64>,
    /// σ̂ in each, 1/length.
    pub values: Vec<f64>,
    /// Distances and |σ_t − σ_c| there.
    pub residual: Vec<[f64; 2]>,
    /// V·cost of the best constant σ̂ over that of the profile.
    pub over_constant: f64,
    /// V·cost of local majorants over that of the profile, if the estimator was tried with some.
    pub over_local: Option<f64>,
}

/// Estimator that cannot be advised.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// Estimator, as in a case.
    pub estimator: String,
    /// Reason.
    pub reason: String,
}

/// Advice for a medium.
#[derive(Debug, Clone)]
pub struct Advice {
    /// Name of the case.
    pub case: String,
    /// Its title.
    pub title: String,
    /// The problem's name.
    pub problem: String,
    /// The field's name in the catalogue.
    pub medium: String,
    /// Number of rays.
    pub rays: usize,
    /// Goal of the draws.
    pub target: Target,
    /// Costs of draws.
    pub costs: Costs,
    /// Rows, group by group, the best first.
    pub rows: Vec<Row>,
    /// The best σ̂ along the ray, of the best estimator with weights and of the best particle.
    pub profiles: Vec<Profile>,
    /// Estimators that cannot be advised.
    pub refused: Vec<Refused>,
    /// Seconds that the advice took.
    pub seconds: f64,
}

impl Advice {
    /// Returns the unit of the costs: `s` or `lookups`.
    pub fn unit(&self) -> &'static str {
        self.costs.unit()
    }

    /// Returns the advised row: the first, unless nothing can be ranked.
    pub fn best(&self) -> Option<&Row> {
        self.rows.first()
    }
}

/// Advises on a case.
///
/// # Errors
///
/// Mistakes in the case.
pub fn advise(spec: &Spec, request: &Request) -> Result<Advice, CaseError> {
    let begin = Instant::now();
    let (base, rays) = rays::read(spec, request.rays, request.seed)?;
    let texts = candidates::listed(&base, &rays)?;
    let mut prices = Prices::open(&request.costs, &base.spec);
    let mut study = Study::new(&base, &rays, texts, request, &mut prices)?;
    let found = parallel::map(&study.families(), |family| {
        row(&study, &study.best(family)?, request.target)
    });
    let mut rows: Vec<Row> = found.into_iter().flatten().collect();
    rank(&mut rows, request.target);
    for row in rows.iter_mut().take(CORRECTED) {
        correct(&mut study, row, request.target, &mut prices);
    }
    let mut profiles = Vec::new();
    for (profile, row) in profiles_of(&study, &rows, (&base, &rays), request, &mut prices)? {
        profiles.push(profile);
        rows.push(row);
    }
    prices.keep();
    rank(&mut rows, request.target);
    let shown = rows.iter_mut().filter(|row| row.constant.is_some()).take(CURVES);
    parallel::change(&mut shown.collect::<Vec<_>>(), |row| {
        row.curve = curve(&study, row, request.target);
    });
    Ok(Advice {
        case: base.name.clone(),
        title: base.title.clone(),
        problem: base.problem.clone(),
        medium: base.scenario.medium().to_owned(),
        rays: rays.len(),
        target: request.target,
        costs: request.costs.clone(),
        refused: refused(&study, &rows),
        rows,
        profiles,
        seconds: begin.elapsed().as_secs_f64(),
    })
}

/// Returns the row of a setting, evaluated on all rays; `None` if it is refused on one.
fn row(study: &Study, best: &Best, target: Target) -> Option<Row> {
    let (candidate, (setting, score)) = (best.candidate, study.on_all(best)?);
    let at = study.cases[0].at(setting).ok()?;
    let (id, text) = (at.id(candidate), &study.texts[candidate]);
    let is_profile = candidates::is_profile(text);
    let mut needs = match () {
        () if is_profile => "|σ_t − σ_c| along the ray".to_owned(),
        () if candidates::is_learned(text) => "pilot rays".to_owned(),
        () => at.needs(candidate),
    };
    let of = |what| setting.filter(|setting| setting.0 == what).map(|setting| setting.1);
    let (constant, factor) = (of(What::Sampling), of(What::SamplingScale));
    let group = match () {
        () if is_profile || needs.contains('τ') => Group::Informed,
        () if score.is_bound => Group::Bounded,
        () => Group::Ranked,
    };
    let edge = |(_, x): (What, f64), sign, level| best.goal.edge(x, sign, level, MAX_FACTOR);
    let double = |(_, x): (What, f64)| 2.0 * best.goal.of(x);
    let least = setting.map(|at| at.1 * edge(at, -1.0, UNKNOWN));
    let below = setting.zip(least).filter(|&(_, least)| least > 0.0);
    let below = below.map(|((what, _), least)| (what, BELOW * least));
    if let Some(bound) = below.and_then(|at| study.violated(candidate, Some(at))) {
        needs = if needs.is_empty() { bound.to_owned() } else { format!("{needs}, {bound}") };
    }
    let mut row = Row {
        candidate,
        setting,
        group,
        estimator: id.estimator.to_string(),
        sampling: kind_of_sampling(&id.sampling.kind, factor),
        constant,
        factor: factor.filter(|&factor| factor != 1.0),
        control: id.control.clone(),
        kind: best.kind,
        cost_error: study.prices[candidate]?.error,
        margins: setting.map(|at| [-1.0, 1.0].map(|sign| edge(at, sign, double(at)))),
        least,
        needs,
        lines: lines(text, constant, factor),
        ..Row::default()
    };
    row.weigh(score, target);
    Some(row)
}

impl Row {
    /// Sets the score, and what follows from it.
    fn weigh(&mut self, score: Score, target: Target) {
        let goal = score.goal(target);
        (self.time, self.error) = match target {
            Target::Error(_) => (goal, if goal > 0.0 { (score.work / goal).sqrt() } else { 0.0 }),
            Target::Budget(budget) => (budget, goal.sqrt()),
        };
        let times = score.works.iter().map(|work| match target {
            Target::Error(error) => work / (error * error),
            Target::Budget(budget) => (work / budget).sqrt(),
        });
        self.times = times.fold([f64::INFINITY, 0.0], |[low, high], t| [low.min(t), high.max(t)]);
        self.draws = if score.cost > 0.0 { (self.time / score.cost).ceil() } else { 1.0 };
        self.trusted = score.kurtosis.map(|kurtosis| (kurtosis - 1.0).max(1.0) / (TRUST * TRUST));
        self.score = score;
    }
}

/// Corrects the price of a row by draws at its setting, unless prices are given.
fn correct(study: &mut Study, row: &mut Row, target: Target, prices: &mut Prices) {
    let (candidate, case) = (row.candidate, &study.cases[study.cases.len() / 2]);
    let Some(old) = study.prices[candidate] else { return };
    let Some(price) = prices.at(&study.texts[candidate], case, (candidate, row.setting), old)
    else {
        return;
    };
    study.prices[candidate] = Some(price);
    let all: Vec<usize> = (0..study.cases.len()).collect();
    if let Some(score) = study.score(candidate, row.setting, &all) {
        row.cost_error = price.error;
        row.weigh(score, target);
    }
}

/// Returns the costs to the target, or the errors, around the constant σ̂ of a row.
fn curve(study: &Study, row: &Row, target: Target) -> Vec<[f64; 2]> {
    let goal = study.goal(row.candidate, 1.0);
    let shown = |y: f64| if let Target::Error(_) = target { y } else { y.sqrt() };
    let step = |i: i32| WIDTH.powf(f64::from(i) / f64::from(POINTS));
    let places =
        row.constant.into_iter().flat_map(|x| (-POINTS..=POINTS).map(move |i| x * step(i)));
    places
        .map(|x| [x, goal.of(x)])
        .filter(|at| at[1] < BEYOND)
        .map(|[x, y]| [x, shown(y)])
        .collect()
}

/// Returns the words for σ̂, without the factor.
fn kind_of_sampling(kind: &str, factor: Option<f64>) -> String {
    let kind = factor.and_then(|_| kind.split_once(" × ")).map_or(kind, |(_, kind)| kind);
    kind.to_owned()
}

/// Returns the lines for a case: σ̂, if it is one constant, and the list of estimators.
fn lines(text: &str, constant: Option<f64>, factor: Option<f64>) -> String {
    let list = format!("estimators = [{{ {text} }}]");
    let factor = factor.filter(|&factor| factor != 1.0);
    let constant = constant.map(|value| format!("sampling = {}\n", number(value)));
    let factor = factor.map(|factor| format!("sweep.sampling-scale = [{}]\n", number(factor)));
    constant.or(factor).unwrap_or_default() + &list
}

/// Sorts rows by group and time, or by error within a budget, and marks ties.
fn rank(rows: &mut [Row], target: Target) {
    let key = |row: &Row| match target {
        Target::Error(_) => row.time,
        Target::Budget(_) => row.error * row.error,
    };
    rows.sort_by(|a, b| a.group.cmp(&b.group).then(key(a).total_cmp(&key(b))));
    for group in rows.chunk_by_mut(|a, b| a.group == b.group) {
        let mut first = 0;
        for i in 0..group.len() {
            let both = group[i].cost_error + group[first].cost_error;
            let is_tie = i > 0 && key(&group[i]) <= key(&group[first]) * (1.0 + both.max(TIE));
            if is_tie {
                group[first].is_tie = true;
            } else {
                first = i;
            }
            (group[i].rank, group[i].is_tie) = (first + 1, is_tie);
        }
    }
}

/// Returns the estimators without a row, with the reasons.
fn refused(study: &Study, rows: &[Row]) -> Vec<Refused> {
    let name = |candidate: usize| study.texts[candidate].split(" = ").next().unwrap_or_default();
    let has_row = |one: &str| rows.iter().any(|row| name(row.candidate) == one);
    let mut refused: Vec<Refused> = Vec::new();
    for candidate in 0..study.texts.len() {
        let estimator = name(candidate);
        if has_row(estimator) || refused.iter().any(|other| other.estimator == estimator) {
            continue;
        }
        let unknown =
            || "theory does not know its variance or its cost, or it is biased".to_owned();
        let reason = study.refusal_at_scale(candidate);
        let reason = reason.map_or_else(unknown, |refusal| refusal.to_string());
        refused.push(Refused { estimator: estimator.to_owned(), reason });
    }
    refused
}

/// Returns the best σ̂ along the ray of the best estimator with weights and of the best particle, with their rows.
fn profiles_of(
    study: &Study,
    rows: &[Row],
    (base, rays): (&Case, &[Body]),
    request: &Request,
    prices: &mut Prices,
) -> Result<Vec<(Profile, Row)>, CaseError> {
    let mut profiles = Vec::new();
    for is_weight in [true, false].into_iter().filter(|_| rays.len() == 1) {
        let rule = |row: &Row| candidates::rule(&study.texts[row.candidate]);
        let is_asked =
            |row: &&Row| rule(row).is_some_and(|rule| (rule == Collisions::Weight) == is_weight);
        let goal = |row: &Row| row.score.goal(request.target);
        let asked = rows.iter().filter(is_asked).min_by(|a, b| goal(a).total_cmp(&goal(b)));
        let Some((best, rule)) = asked.and_then(|best| Some((best, rule(best)?))) else { continue };
        let Some((profile, text)) = profile::of(study, rows, best, rule) else { continue };
        let own = Study::new(base, rays, vec![text], request, prices)?;
        let row = own.best(&[0]).and_then(|best| row(&own, &best, request.target));
        profiles.extend(row.map(|row| (profile, Row { candidate: best.candidate, ..row })));
    }
    Ok(profiles)
}
