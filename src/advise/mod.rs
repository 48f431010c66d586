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

use crate::case::sweep::What;
use crate::case::{Case, CaseError, Spec};
use candidates::Collisions;
use media::Body;
use media::catalogue::{Page, PageList};
use numeric::digits::number;
use search::Kind;
use study::{Best, Study};
use theory::parallel;

/// Difference of two times that is a tie, with exact costs: settings are searched to this accuracy.
const TIE: f64 = 1e-3;

/// Standard error of a sample variance that can be trusted.
const TRUST: f64 = 0.1;
/// Number of points of a curve on each side of the best σ̂.
const CURVE: i32 = 12;
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Exact variance, and nothing that is as hard to know as the answer.
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
#[derive(Debug, Clone)]
pub struct Row {
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
    /// Relative standard deviation of a draw, root mean square over the rays.
    pub deviation: f64,
    /// Expected lookups of a draw.
    pub lookups: f64,
    /// Setup lookups of a ray.
    pub setup_lookups: f64,
    /// Cost of a draw with its share of the setup.
    pub cost: f64,
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
    /// Largest kurtosis of a draw on a ray.
    pub kurtosis: Option<f64>,
    /// Draws until the sample variance, and so the estimated error, has a standard error of 10 %.
    pub trusted: Option<f64>,
    /// Constant σ̂ and the cost to the target error, or the error within the budget; empty where σ̂ is not constant.
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
    let study = Study::new(&base, &rays, texts, request)?;
    let found = study.best_of_families();
    let rows = parallel::map(&found, |best| row(&study, best, request.target));
    let mut rows: Vec<Row> = rows.into_iter().flatten().collect();
    let mut profiles = Vec::new();
    for (profile, row) in profiles_of(&study, &found, (&base, &rays), request)? {
        profiles.push(profile);
        rows.push(row);
    }
    rank(&mut rows, request.target);
    Ok(Advice {
        case: base.name.clone(),
        title: base.title.clone(),
        problem: base.problem.clone(),
        medium: base.scenario.medium().to_owned(),
        rays: rays.len(),
        target: request.target,
        costs: request.costs.clone(),
        rows,
        profiles,
        refused: refused(&study, &found),
        seconds: begin.elapsed().as_secs_f64(),
    })
}

/// Returns the row of a setting, evaluated on all rays; `None` if it is refused on one.
fn row(study: &Study, best: &Best, target: Target) -> Option<Row> {
    let (Best { candidate, setting, kind, .. }, score) = study.on_all(best)?;
    let at = study.cases[0].at(setting).ok()?;
    let (id, text) = (at.id(candidate), &study.texts[candidate]);
    let is_profile = text.contains(profile::RECIPE);
    let needs =
        if is_profile { "|σ_t − σ_c| along the ray".to_owned() } else { at.needs(candidate) };
    let is_free = |what| setting.filter(|setting| setting.0 == what).map(|setting| setting.1);
    let (constant, factor) = (is_free(What::Sampling), is_free(What::SamplingScale));
    let goal = score.goal(target);
    let (time, error) = match target {
        Target::Error(_) if goal == 0.0 => (0.0, 0.0),
        Target::Error(_) => (goal, (score.work / goal).sqrt()),
        Target::Budget(budget) => (budget, goal.sqrt()),
    };
    let times = score.works.iter().map(|work| match target {
        Target::Error(error) => work / (error * error),
        Target::Budget(budget) => (work / budget).sqrt(),
    });
    let times = times.fold([f64::INFINITY, 0.0], |[low, high], t| [low.min(t), high.max(t)]);
    let group = match () {
        () if is_profile || needs.contains('τ') => Group::Informed,
        () if score.is_bound => Group::Bounded,
        () => Group::Ranked,
    };
    let what = setting.map(|(what, _)| what);
    let (f, x) = (study.goal(candidate, what), setting.map(|(_, x)| x));
    let exists = |x: f64| study.exists(candidate, what.map(|what| (what, x)));
    let shown = |y: f64| if let Target::Error(_) = target { y } else { y.sqrt() };
    let steps = (-CURVE..=CURVE).map(|i| WIDTH.powf(f64::from(i) / f64::from(CURVE)));
    let curve = constant.into_iter().flat_map(|x| steps.clone().map(move |step| x * step));
    let curve = curve.map(|x| [x, shown(f(x))]).filter(|[_, y]| y.is_finite());
    Some(Row {
        group,
        rank: 0,
        is_tie: false,
        estimator: id.estimator.to_string(),
        sampling: kind_of_sampling(&id.sampling.kind, factor),
        constant,
        factor: factor.filter(|&factor| factor != 1.0),
        control: id.control.clone(),
        kind,
        deviation: score.variance.sqrt(),
        lookups: score.lookups,
        setup_lookups: score.setup_lookups,
        cost: score.cost,
        draws: if score.cost > 0.0 { (time / score.cost).ceil() } else { 1.0 },
        time,
        error,
        times,
        cost_error: study.prices[candidate]?.error,
        margins: x.map(|x| search::margins(x, f(x), &f)),
        least: x.map(|x| search::least(x, &exists)),
        kurtosis: score.kurtosis,
        trusted: score.kurtosis.map(|kurtosis| (kurtosis - 1.0).max(1.0) / (TRUST * TRUST)),
        curve: curve.collect(),
        needs,
        lines: lines(text, constant, factor),
    })
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
fn refused(study: &Study, found: &[Best]) -> Vec<Refused> {
    let name = |candidate: usize| study.texts[candidate].split(" = ").next().unwrap_or_default();
    let has_row = |one: &str| found.iter().any(|best| name(best.candidate) == one);
    let mut refused: Vec<Refused> = Vec::new();
    for candidate in 0..study.texts.len() {
        let estimator = name(candidate);
        if has_row(estimator) || refused.iter().any(|other| other.estimator == estimator) {
            continue;
        }
        let unknown = "theory does not know its variance or its cost, or it is biased";
        let reason =
            study.refusal(candidate).map_or(unknown.to_owned(), |refusal| refusal.to_string());
        refused.push(Refused { estimator: estimator.to_owned(), reason });
    }
    refused
}

/// Returns the best σ̂ along the ray of the best estimator with weights and of the best particle, with their rows.
fn profiles_of(
    study: &Study,
    found: &[Best],
    (base, rays): (&Case, &[Body]),
    request: &Request,
) -> Result<Vec<(Profile, Row)>, CaseError> {
    let [ray] = rays else { return Ok(Vec::new()) };
    let mut profiles = Vec::new();
    for is_weight in [true, false] {
        let rule = |best: &Best| candidates::rule(&study.texts[best.candidate]);
        let is_asked =
            |best: &&Best| rule(best).is_some_and(|rule| (rule == Collisions::Weight) == is_weight);
        let asked = found.iter().filter(is_asked).min_by(|a, b| a.goal.total_cmp(&b.goal));
        let Some((best, rule)) = asked.and_then(|best| Some((best, rule(best)?))) else { continue };
        let Some((profile, text)) = profile::of(study, found, best, rule) else { continue };
        let own = Study::new(base, std::slice::from_ref(ray), vec![text], request)?;
        let Some(row) = own.best(0).and_then(|best| row(&own, &best, request.target)) else {
            continue;
        };
        profiles.push((profile, row));
    }
    Ok(profiles)
}
