//! Estimators of the light of an emitter at the end of a rod.

pub mod directional_mis;
pub mod full_mis;
pub mod next_event;
pub mod shadow;
pub mod unidirectional;
pub mod walk;

use crate::recipes::inequality;
use crate::{Estimated, Kernel, Refusal, Request, Setup, estimators};
use media::catalogue::Settings;
use theory::light::{Heuristic, Shadow, Techniques};
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

/// Settings in words, such as `ratio shadow, power heuristic`.
fn label(shadow: Shadow, heuristic: Heuristic) -> String {
    let shadow = match shadow {
        Shadow::Exact => "exact shadow",
        Shadow::Delta => "delta shadow",
        Shadow::Ratio => "ratio shadow",
    };
    match heuristic {
        Heuristic::Balance => shadow.to_owned(),
        Heuristic::Power => format!("{shadow}, power heuristic"),
    }
}

/// Implements the trait of estimators for a page by its techniques, as in `lit!(self => self.techniques())`.
macro_rules! lit {
    ($this:ident => $techniques:expr) => {
        const INPUTS: $crate::Inputs = $crate::Inputs::SAMPLING;

        fn needs(&$this) -> Option<&'static str> {
            let is_exact = $techniques.shadow == Some(theory::light::Shadow::Exact);
            is_exact.then_some("τ")
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
