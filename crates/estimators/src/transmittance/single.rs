//! The single particle model: at a collision the transmitted particle goes on with probability q_tran.
//!
//! Unbiased for: 0 ≤ r ≤ 2 by the rule `terminating`, refused elsewhere; every r by the other rules.
//!
//! ```text
//! W = (1 − r)/q_tran with probability q_tran, else 0;  X = T_c ∏ᵢ W(tᵢ),  r = (σ_t − σ_c)/σ̂
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule` | `terminating`, `clamped`, `non-terminating` or `adaptive` | required |
//! | `albedo` | a in [0, 1], for the last two rules | required for them |
//!
//! | rule | q_tran | unbiased for |
//! |---|---|---|
//! | terminating | abs(1 − r) | 0 ≤ r ≤ 2, else refused |
//! | clamped (not in the paper) | min(1, abs(1 − r)) | every r |
//! | non-terminating | abs(1 − r)/D, D = a abs(r) + abs(1 − r) | every r |
//! | adaptive | terminating where r ≥ 1 and a r + abs(1 − r) ≤ 1, else non-terminating | every r |
//!
//! ```text
//! J_k = ∫ σ̂ [(1 − q) + q(1 − (1 − r)/q)^k]
//! w = σ_r (2 − 1/r + (1 − r)²/(r q)) (Eqs. 18–20),  E[lookups] = ∫ σ̂ exp(−∫₀ᵗ σ̂ (1 − q)) dt
//! ```
//!
//! Scattered particles are lost, as they must be for transmittance: a draw that scatters is 0.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! Eqs. 9, 12, 18–20 and `SimulateParticle`.
//!
//! ```toml
//! title = "An example of single"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 1.2
//! estimators = [{ single.rule = "terminating" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use crate::{Estimator, Inputs, Refusal, Setup, Traits, product_draws};
use media::catalogue::{Domain, Settings};
use theory::Prediction;
use theory::collisions::Collisions;
use theory::collisions::rules::Single;
use theory::problems::Transmittance;

const RULES: [&str; 4] = ["terminating", "clamped", "non-terminating", "adaptive"];

/// The single particle model; σ̂ and any control are its inputs.
#[derive(Debug, Clone)]
pub struct SingleParticle {
    rule: Single,
}

/// Checks that the terminating rule is realisable: `0 ≤ r ≤ 2`.
fn terminating_exists(setup: &Setup<Transmittance>) -> Result<(), Refusal> {
    setup.residual().require_not_negative("r ≥ 0 (q_tran = |1 − r| ≤ 1)")?;
    setup.residual().require_ratio_at_most(2.0, "r ≤ 2 (q_tran = |1 − r| ≤ 1)")
}

impl Estimator<Transmittance> for SingleParticle {
    const INPUTS: Inputs = Inputs::BOTH;

    fn read(settings: &Settings) -> Option<Self> {
        let rule = settings.word("rule", &RULES);
        let takes_albedo = matches!(rule, Some("non-terminating" | "adaptive"));
        let albedo = if takes_albedo || (rule.is_none() && settings.has("albedo")) {
            settings.number("albedo", Domain::Unit)
        } else {
            Some(0.0)
        };
        let albedo = albedo?;
        let rule = match rule? {
            "terminating" => Single::Terminating,
            "clamped" => Single::Clamped,
            "non-terminating" => Single::NonTerminating { albedo },
            _ => Single::Adaptive { albedo },
        };
        Some(Self { rule })
    }

    fn traits(&self) -> Traits {
        let (rule, albedo) = match self.rule {
            Single::Terminating => ("terminating", None),
            Single::Clamped => ("clamped", None),
            Single::NonTerminating { albedo } => ("non-terminating", Some(albedo)),
            Single::Adaptive { albedo } => ("adaptive", Some(albedo)),
        };
        let collisions = Some(Collisions::Single(self.rule));
        Traits { settings: rule.into(), albedo, collisions, ..Traits::product(Self::INPUTS) }
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        let rule = match self.rule {
            Single::NonTerminating { .. } => Single::NonTerminating { albedo },
            Single::Adaptive { .. } => Single::Adaptive { albedo },
            Single::Terminating | Single::Clamped => return None,
        };
        Some(Self { rule })
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.residual().require_coverage()?;
        setup.fields.require_finite_weights(&self.rule)?;
        if self.rule == Single::Terminating { terminating_exists(setup) } else { Ok(()) }
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        setup.product(&self.rule).predict()
    }

    product_draws!(self => self.rule);
}
