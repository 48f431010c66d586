//! Estimators of the light of an emitter at the end of a rod.

pub mod directional_mis;
pub mod full_mis;
pub mod next_event;
pub mod packet;
pub mod unidirectional;
pub mod walk;

use crate::catalogue::Settings;
use crate::estimators::{Refusal, Setup, estimators};
use crate::problems::LitRod;
use crate::theory::ParticleRule;
use crate::theory::lit_rod::{self, Heuristic, Shadow};

/// Whether a walk by delta tracking exists on a rod and theory reaches it.
fn realisable(setup: &Setup<LitRod>) -> Result<(), Refusal> {
    let (rule, albedo) = (ParticleRule::Analog, &setup.problem.rod.albedo);
    setup.require_few_collisions("∫σ̂ ≤ 1e6")?;
    let limit = |t: f64| rule.limits(albedo.value(t))[1];
    setup.require_ratio_within(albedo.knots(), limit, rule.needs())?;
    if lit_rod::is_within_reach(&setup.mesh, &setup.problem, &setup.sampling) {
        return Ok(());
    }
    let needs = "a rod that theory can cut into 1e4 steps";
    Err(Refusal::mismatch(needs, "σ̂ or σ_t is too large on it"))
}

/// Reads `shadow`, one of some words.
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

/// Settings in words, as in `ratio shadow, power heuristic`.
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

/// The plumbing of a page: all that differs are its techniques, as in `walks!(self => self.techniques())`.
macro_rules! walks {
    ($this:ident => $techniques:expr) => {
        const INPUTS: $crate::estimators::Inputs = $crate::estimators::Inputs::SAMPLING;
        const IN_PACKETS: bool = true;

        fn domain(
            &$this,
            setup: &$crate::estimators::Setup<$crate::problems::LitRod>,
        ) -> Result<(), $crate::estimators::Refusal> {
            $crate::estimators::lit_rod::realisable(setup)
        }

        fn predict(
            &$this,
            setup: &$crate::estimators::Setup<$crate::problems::LitRod>,
        ) -> $crate::theory::Prediction {
            let (mesh, problem, sampling) = (&setup.mesh, &setup.problem, &setup.sampling);
            let techniques = $techniques;
            $crate::theory::lit_rod::predict(mesh, problem, sampling, techniques, setup.laws)
        }

        #[inline(always)]
        fn draw(
            &$this,
            setup: &$crate::estimators::Setup<$crate::problems::LitRod>,
            medium: &$crate::media::Lookups,
            rng: &mut $crate::rng::Stream,
        ) -> $crate::estimators::Draw<[f64; 1]> {
            $crate::estimators::lit_rod::walk::draw(&$techniques, setup, medium, rng)
        }

        fn draw_packets<'a>(
            &$this,
            level: fearless_simd::Level,
            setup: &$crate::estimators::Setup<$crate::problems::LitRod>,
            medium: &$crate::media::Lookups,
            request: $crate::estimators::packet::Request<'a>,
        ) -> Option<$crate::estimators::packet::Request<'a>> {
            let techniques = $techniques;
            $crate::estimators::lit_rod::packet::walks(level, setup, techniques, medium, request)
        }
    };
}
use walks;

estimators! {
    LitRod:
    unidirectional::Unidirectional,
    next_event::NextEvent,
    directional_mis::DirectionalMis,
    full_mis::FullMis,
}
