//! Estimators of the light of an emitter at the end of a rod.

pub mod directional_mis;
pub mod full_mis;
pub mod next_event;
pub mod shadow;
pub mod unidirectional;
pub mod walk;

use crate::recipes::inequality;
use crate::{Estimated, Inputs, Kernel, Knowledge, Refusal, Request, Setup, Traits, estimators};
use media::catalogue::Settings;
use theory::light::{Combination, Heuristic, Shadow, Techniques};
use theory::problems::LitRod;
use theory::rod;
use theory::{ParticleRule, Prediction};

/// A problem with light that is found by hits and by shadow rays; its estimators have common pages.
pub trait Lit: Estimated<Value = [f64; 1]> {
    /// Checks that a walk with techniques exists and that theory covers it.
    ///
    /// # Errors
    ///
    /// The reason why not.
    fn realisable(setup: &Setup<Self>, techniques: Techniques) -> Result<(), Refusal>;

    /// Returns the prediction for a draw.
    fn predict(setup: &Setup<Self>, techniques: Techniques) -> Prediction;

    /// Makes the draws of a request: compiled once for all pages.
    fn fill(techniques: Techniques, kernel: Kernel, setup: &Setup<Self>, request: Request);
}

impl Lit for LitRod {
    fn realisable(setup: &Setup<Self>, _: Techniques) -> Result<(), Refusal> {
        let (rule, albedo) = (ParticleRule::Analog, &setup.problem.rod.albedo);
        setup.residual().require_few_collisions("∫σ̂ ≤ 1e6")?;
        let limit = |t: f64| rule.limits(albedo.value(t))[1];
        setup.residual().require_ratio_within(albedo.knots(), limit, inequality(rule.range()))?;
        if rod::lit::is_within_reach(&setup.fields.mesh, &setup.problem, &setup.fields.sampling) {
            return Ok(());
        }
        let needs = "a rod that theory can cut into 5000 panels";
        Err(Refusal::mismatch(needs, "σ̂ or σ_t is too large on it"))
    }

    fn predict(setup: &Setup<Self>, techniques: Techniques) -> Prediction {
        let (mesh, problem, sampling) =
            (&setup.fields.mesh, &setup.problem, &setup.fields.sampling);
        rod::lit::predict(mesh, problem, sampling, techniques, setup.distributions)
    }

    fn fill(techniques: Techniques, kernel: Kernel, setup: &Setup<Self>, request: Request) {
        walk::fill(techniques, kernel, setup, request);
    }
}

/// Reads `shadow`, one of `words`.
fn read_shadow(
    settings: &Settings,
    words: &[&'static str],
    default: &'static str,
) -> Option<Shadow> {
    settings.word_or("shadow", words, default).map(|word| match word {
        "exact" => Shadow::Exact,
        "delta" => Shadow::Delta,
        _ => Shadow::Ratio,
    })
}

/// Properties of an estimator of some techniques, with words such as `ratio shadow, power heuristic`.
fn traits(techniques: Techniques) -> Traits {
    let shadow = match techniques.shadow {
        None => "",
        Some(Shadow::Exact) => "exact shadow",
        Some(Shadow::Delta) => "delta shadow",
        Some(Shadow::Ratio) => "ratio shadow",
    };
    let is_power = matches!(techniques.combination, Combination::Mis(_, Heuristic::Power));
    let heuristic = if is_power { ", power heuristic" } else { "" };
    let needs = (techniques.shadow == Some(Shadow::Exact)).then_some(Knowledge::OpticalDepth);
    let settings = format!("{shadow}{heuristic}");
    Traits { settings, needs, ..Traits::of(Inputs::SAMPLING) }
}

/// Implements the trait of estimators for a page by its techniques, as in `lit!(self => self.techniques())`.
macro_rules! lit {
    ($this:ident => $techniques:expr) => {
        const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;

        fn traits(&$this) -> $crate::Traits {
            $crate::lit_rod::traits($techniques)
        }

        fn domain(
            &$this,
            setup: &$crate::Setup<P>,
        ) -> Result<(), $crate::Refusal> {
            P::realisable(setup, $techniques)
        }

        fn predict(&$this, setup: &$crate::Setup<P>) -> theory::Prediction {
            P::predict(setup, $techniques)
        }

        fn fill(
            &$this,
            kernel: $crate::Kernel,
            setup: &$crate::Setup<P>,
            request: $crate::Request,
        ) {
            P::fill($techniques, kernel, setup, request);
        }
    };
}
use lit;

estimators! {
    LitRod on Line:
    unidirectional::Unidirectional,
    next_event::NextEvent,
    directional_mis::DirectionalMis,
    full_mis::FullMis,
}
