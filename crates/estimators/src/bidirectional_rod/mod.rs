//! Techniques of bidirectional path tracing in a rod, alone and together.

mod batch;
pub mod directional_mis;
pub mod full_mis;
pub mod path;
pub mod subpath;
pub mod technique;
pub mod walk;

use self::path::Path;
use crate::setup::heuristic;
use crate::{
    Estimator, Inputs, Kernel, Knowledge, Refusal, Request, Setup, Traits, estimators, walks,
};
use ::theory::Prediction;
use ::theory::light::Heuristic;
use ::theory::problems::BidirectionalRod;
use ::theory::problems::bidirectional_rod::Sensor;
use ::theory::rod::bidirectional::{self, Combination, Connection, DrawRules, RodScene};
use media::catalogue::Settings;
use numeric::Lane;
use numeric::digits::rounded;

/// Settings of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Method {
    /// Technique, or combination of techniques.
    pub combination: Combination,
    /// True if the transmittances of connections are tracked.
    pub is_tracked: bool,
    /// True if all techniques share their subpaths.
    pub is_shared: bool,
}

impl Method {
    /// Values of paths; `T̂` of their connections is positive.
    #[inline(always)]
    pub fn value<L: Lane>(self, path: &Path<L>) -> L {
        path.weight(self.combination) * path.quotient(path.light)
    }
}

/// Maximum optical depth of a rod: beyond it theory's grids are too coarse.
const LONGEST: f64 = 12.0;
/// Maximum `∫σ̂` of a tracked connection: beyond it probabilities underflow.
const MAX_TRACKED: f64 = 500.0;
/// Maximum relative difference of two ratios that count as equal.
const SAME: f64 = 1e-12;

/// Kind of [`technique`].
pub const TECHNIQUE: u8 = 0;
/// Kind of [`directional_mis`].
pub const DIRECTIONAL: u8 = 1;
/// Kind of [`full_mis`].
pub const FULL: u8 = 2;

/// An estimator of a kind; σ̂ is its input.
#[derive(Debug, Clone, Copy)]
pub struct Estimate<const KIND: u8>(Method);

impl<const KIND: u8> Estimator<BidirectionalRod> for Estimate<KIND> {
    const INPUTS: Inputs = Inputs::SAMPLING;

    fn read(settings: &Settings) -> Option<Self> {
        let combination = match KIND {
            TECHNIQUE => technique::combination(settings),
            DIRECTIONAL => heuristic::read(settings).map(Combination::Directional),
            _ => heuristic::read(settings).map(Combination::Full),
        };
        let connection = settings.word_or("connection", &["exact", "ratio"], "exact");
        let subpaths = if KIND == TECHNIQUE {
            Some("independent")
        } else {
            settings.word_or("subpaths", &["independent", "shared"], "independent")
        };
        Some(Self(Method {
            combination: combination?,
            is_tracked: connection? == "ratio",
            is_shared: subpaths? == "shared",
        }))
    }

    /// The settings are words such as `power, ratio connection`.
    fn traits(&self) -> Traits {
        let Method { combination, is_tracked, is_shared } = self.0;
        let first = match combination {
            Combination::Technique(s) => format!("s={s}, "),
            Combination::Directional(Heuristic::Power) | Combination::Full(Heuristic::Power) => {
                "power, ".into()
            }
            _ => String::new(),
        };
        let connection = if is_tracked { "ratio" } else { "exact" };
        let subpaths = if is_shared { ", shared subpaths" } else { "" };
        let settings = format!("{first}{connection} connection{subpaths}");
        Traits {
            settings,
            needs: (!is_tracked).then_some(Knowledge::OpticalDepth),
            ..Traits::of(Self::INPUTS)
        }
    }

    fn domain(&self, setup: &Setup<BidirectionalRod>) -> Result<(), Refusal> {
        setup.residual().require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        let depth = setup.fields.mesh.optical_depth().value;
        if depth > LONGEST {
            let actual = format!("τ = {}", rounded(depth));
            return Err(Refusal::mismatch("τ ≤ 12, as far as theory goes", actual));
        }
        if self.0.is_tracked {
            let needs = "one number σ_t/σ̂ where connections are tracked, and ∫σ̂ ≤ 500";
            match one_ratio(setup) {
                None => return Err(Refusal::mismatch(needs, "σ_t/σ̂ varies along the rod")),
                Some(ratio) if depth > MAX_TRACKED * ratio => {
                    let actual = format!("∫σ̂ = {}", rounded(depth / ratio));
                    return Err(Refusal::mismatch(needs, actual));
                }
                Some(_) => {}
            }
        }
        let orders = &setup.problem.orders;
        if let Some(order) = orders.clone().find(|&order| is_dark(&setup.problem, order)) {
            let BidirectionalRod { albedo, forward, .. } = &*setup.problem;
            let actual = format!("a = {albedo}, p_f = {forward} leave none to r = {order}");
            return Err(Refusal::mismatch("light in every order of scattering", actual));
        }
        match self.0.combination {
            Combination::Technique(s) if s > orders.start() + 2 => {
                let needs = "at most r + 2 light vertices, r the lowest order";
                let actual = format!("s = {s} and r = {}", orders.start());
                Err(Refusal::mismatch(needs, actual))
            }
            _ => Ok(()),
        }
    }

    fn predict(&self, setup: &Setup<BidirectionalRod>) -> Prediction {
        let problem = &setup.problem;
        let scene = RodScene {
            depth: setup.fields.mesh.optical_depth(),
            albedo: problem.albedo,
            forward: problem.forward,
            is_transmitted: problem.sensor == Sensor::Transmitted,
            orders: problem.orders.clone(),
        };
        let ratio = one_ratio(setup);
        // A ratio that varies is refused, and draws that are made in spite of it have no prediction.
        let tracked = ratio.filter(|_| self.0.is_tracked).map(Connection::Ratio);
        let connection = tracked.unwrap_or(Connection::Exact);
        let Method { combination, is_shared, .. } = self.0;
        let rules =
            DrawRules { combination, connection, is_shared, has_shares: problem.has_shares };
        bidirectional::predict(&scene, &rules, ratio, setup.distributions)
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<BidirectionalRod>, request: Request) {
        fill(self.0, kernel, setup, request);
    }
}

/// Makes the draws of a request: compiled once for all pages.
fn fill(method: Method, kernel: Kernel, setup: &Setup<BidirectionalRod>, request: Request) {
    walks::by(
        kernel,
        setup,
        request,
        |level, medium, request| batch::packets(level, method, setup, medium, request),
        #[inline(always)]
        |medium, random| walk::draw(method, setup, medium, random),
    );
}

/// Returns whether no path with `order` scatterings can reach the sensor: then the shares of its techniques are not
/// defined.
fn is_dark(problem: &BidirectionalRod, order: usize) -> bool {
    let is_transmitted = problem.sensor == Sensor::Transmitted;
    let never_turns = problem.forward == 1.0 && !is_transmitted;
    let always_turns = problem.forward == 0.0 && order.is_multiple_of(2) != is_transmitted;
    order > 0 && (problem.albedo == 0.0 || never_turns || always_turns)
}

/// `σ_t/σ̂`, if it has one value wherever there is a medium.
fn one_ratio(setup: &Setup<BidirectionalRod>) -> Option<f64> {
    let cut = setup.fields.mesh.refined(setup.fields.sampling.knots(), &|_, _| Vec::new());
    let places = cut.panels().flat_map(|panel| panel.t.iter().zip(panel.extinction));
    let ratios = places.filter_map(|(&t, sigma)| {
        let sampling = setup.fields.sampling.value(t);
        (sampling > 0.0).then_some(sigma / sampling)
    });
    let [minimum, maximum] = ratios.fold([f64::INFINITY, 0.0], |[minimum, maximum], ratio: f64| {
        [minimum.min(ratio), maximum.max(ratio)]
    });
    (minimum > 0.0 && maximum - minimum <= SAME * maximum).then_some(maximum.min(1.0))
}

estimators! {
    BidirectionalRod on Line:
    technique::Technique,
    directional_mis::DirectionalMis,
    full_mis::FullMis,
}
