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
//! `docs/advise.md` explains the table; `docs/variance.md` derives the best σ̂ along a ray.

pub mod candidates;
pub mod costs;
pub mod options;
pub mod profile;
pub mod rays;
pub mod row;
pub mod score;
pub mod study;

pub use costs::Costs;
pub use row::{Group, Row};

/// The manual of advice.
pub const CATALOGUE: &[Page] = &[Page { module: "advise", source: include_str!("mod.rs") }];

use crate::case::{CaseError, Spec};
use costs::Prices;
use media::catalogue::Page;
use profile::SamplingProfile;
use study::Study;
use theory::collisions::Collisions;
use theory::parallel;

/// Number of rows with a price that is corrected by draws at the advised σ̂.
const CORRECTED: usize = 8;
/// Number of curves: of the first rows with a constant σ̂.
pub const CURVES: usize = 5;

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
pub struct AdviceRequest {
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
    /// True if the first rows have curves, for a figure.
    pub curves: bool,
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
    pub profiles: Vec<SamplingProfile>,
    /// Estimators that cannot be advised.
    pub refused: Vec<Refused>,
    /// Warning that the costs cannot be kept.
    pub warning: Option<String>,
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
pub fn advise(spec: &Spec, request: &AdviceRequest) -> Result<Advice, CaseError> {
    let (base, rays) = rays::read(spec, request.rays, request.seed)?;
    let listed = candidates::listed(&base, &rays)?;
    let mut prices = Prices::open(&request.costs, &base.spec);
    let mut study = Study::new(&base, &rays, listed, request, &mut prices)?;
    let result = parallel::map(&study.families(), |family| Row::new(&study, &study.best(family)?));
    let mut rows: Vec<Row> = result.into_iter().flatten().collect();
    row::rank(&mut rows);
    let first = rows.len().min(CORRECTED);
    row::correct(&mut rows[..first], &mut study, &mut prices);
    let mut profiles = Vec::new();
    // Over several rays, the best σ̂ at a place differs from ray to ray.
    for is_weight in [true, false].into_iter().filter(|_| rays.len() == 1) {
        let rule = |row: &Row| study.rule(row.candidate);
        let requested = rows.iter().filter_map(|row| Some((row, rule(row)?)));
        let requested = requested.filter(|(_, rule)| (*rule == Collisions::Weight) == is_weight);
        // A σ̂ cannot gain where draws are exact.
        let requested = requested.filter(|(row, _)| row.score.variance > 0.0);
        let requested = requested.min_by(|a, b| a.0.goal.total_cmp(&b.0.goal));
        let Some((best, rule)) = requested else { continue };
        let Some((profile, candidate)) = profile::of(&study, &rows, best, rule) else { continue };
        let own = Study::new(&base, &rays, vec![candidate], request, &mut prices)?;
        let row = own.best(&[0]).and_then(|best| Row::new(&own, &best));
        profiles.extend(row.map(|row| (profile, Row { candidate: best.candidate, ..row })));
    }
    let warning = prices.keep();
    let (profiles, of_profiles): (Vec<_>, Vec<_>) = profiles.into_iter().unzip();
    rows.extend(of_profiles);
    row::rank(&mut rows);
    let shown = rows.iter_mut().filter(|row| request.curves && row.constant.is_some());
    let shown = shown.take(CURVES);
    parallel::change(&mut shown.collect::<Vec<_>>(), |row| row.draw(&study));
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
        warning,
    })
}

/// Returns the estimators without a row, with the reasons.
fn refused(study: &Study, rows: &[Row]) -> Vec<Refused> {
    let name = |candidate: usize| study.candidates[candidate].name.as_str();
    let has_row = |one: &str| rows.iter().any(|row| name(row.candidate) == one);
    let mut refused: Vec<Refused> = Vec::new();
    for candidate in 0..study.candidates.len() {
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
