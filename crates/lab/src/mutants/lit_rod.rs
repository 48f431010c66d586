//! Wrong ways to look for an emitter at the end of a rod.
//!
//! ```text
//! X = [reached unscattered] + Σ p t̂ w_nee(ρ) + [hit after y] w_uni(ρ),   ρ = p_uni/p_nee = p Π (1 − r)
//! ```
//!
//! Several are errors of Algorithms 1 and 2 of B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral
//! formulation of light transport*, ACM Transactions on Graphics 38 (2019), as printed, or ways to read them.

use super::target::{LIT_DIRECTIONAL, LIT_FULL, LIT_NEXT_EVENT, LIT_NEXT_EVENT_DELTA};
use super::{About, Mutant, Target, with};
use estimators::lit_rod::walk::{self, draw};
use media::Cursor;
use theory::lit_rod::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitRod;

/// The steps of a walk, of which a mutant has one wrong.
#[derive(Clone, Copy)]
pub(super) struct Steps {
    pub(super) techniques: Techniques,
    /// The weight of a hit that was never scattered, from that of a hit with ρ = 1.
    pub(super) unscattered: fn(f64) -> f64,
    /// The weight of a hit, from what is right.
    pub(super) hit: fn(f64) -> f64,
    /// What a shadow ray scores, from what is right, p, t̂ and the albedo.
    pub(super) connected: fn(f64, [f64; 3]) -> f64,
    /// ρ after a null collision, from what is right and what it was.
    pub(super) after_null: fn(f64, f64) -> f64,
    /// ρ after a scattering, from what is right and what it was.
    pub(super) after_scattering: fn(f64, f64) -> f64,
    /// The probability that light which comes forward goes on to the emitter, and that of light which comes backward.
    pub(super) phase: fn(f64) -> [f64; 2],
    /// The chance that a delta-tracked shadow ray ends, from r and the albedo.
    pub(super) stops: fn(f64, f64) -> f64,
    /// The factor of a shadow ray that arrives, from the optical depth of its last segment through σ̂.
    pub(super) last: fn(f64) -> f64,
    /// Where the walk goes on, from where a shadow ray was cast and where it ended.
    pub(super) goes_on: fn(Cursor, Cursor) -> Cursor,
}

/// The right steps.
pub(super) fn right(techniques: Techniques) -> Steps {
    Steps {
        techniques,
        unscattered: |_| 1.0,
        hit: |right| right,
        connected: |right, _| right,
        after_null: |right, _| right,
        after_scattering: |right, _| right,
        phase: |forward| [forward, 1.0 - forward],
        stops: |ratio, _| ratio,
        last: |_| 1.0,
        goes_on: |vertex, _| vertex,
    }
}

impl walk::Steps for Steps {
    fn techniques(&self) -> Techniques {
        self.techniques
    }

    fn unscattered(&self) -> f64 {
        (self.unscattered)(self.techniques.of_hit(1.0))
    }

    fn hit(&self, ratio: f64) -> f64 {
        (self.hit)(self.techniques.of_hit(ratio))
    }

    fn connected(&self, phase: f64, transmittance: f64, albedo: f64) -> f64 {
        let right = self.techniques.of_shadow_ray(phase, transmittance);
        (self.connected)(right, [phase, transmittance, albedo])
    }

    fn after_null(&self, ratio: f64, null: f64) -> f64 {
        (self.after_null)(walk::Steps::after_null(&self.techniques, ratio, null), ratio)
    }

    fn after_scattering(&self, before: Option<f64>, right: f64) -> f64 {
        (self.after_scattering)(right, before.unwrap_or(1.0))
    }

    fn phase(&self, forward: f64, is_forward: bool) -> f64 {
        (self.phase)(forward)[usize::from(!is_forward)]
    }

    fn stops(&self, number: f64, ratio: f64, albedo: f64) -> bool {
        number < (self.stops)(ratio, albedo)
    }

    fn arrived(&self, transmittance: f64, last: impl Fn() -> f64) -> f64 {
        transmittance * (self.last)(last())
    }

    fn goes_on(&self, vertex: Cursor, ray: Cursor) -> Cursor {
        (self.goes_on)(vertex, ray)
    }
}

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<LitRod>> {
    let mutant = |name, bug, target: Target, honest: Steps, wrong: Steps| {
        Mutant::new(About { name, bug, target, check: "mean" }, with(wrong, draw), with(honest, draw))
    };
    let balanced = |shadow, densities| {
        let combination = Combination::Mis(densities, Heuristic::Balance);
        right(Techniques { shadow: Some(shadow), combination })
    };
    let alone = |shadow| right(Techniques { shadow: Some(shadow), combination: Combination::NextEvent });
    let full = balanced(Shadow::Ratio, Densities::Full);
    let directional = balanced(Shadow::Delta, Densities::Directional);
    let (ratio, delta) = (alone(Shadow::Ratio), alone(Shadow::Delta));
    vec![
        mutant("lit-rod-last-segment", "Algorithm 2, line 9: the last segment's transmittance is in the densities, and not in f", LIT_FULL, full, Steps { last: f64::exp, ..full }),
        mutant("lit-rod-averaged", "the samples of both techniques are added, and divided by their number", LIT_FULL, full, Steps { hit: |right| 0.5 * right, connected: |right, _| 0.5 * right, ..full }),
        mutant("lit-rod-hit-alone", "Algorithm 1 in the combination: hits are not divided by p_uni + p_nee", LIT_FULL, full, Steps { hit: |_| 1.0, ..full }),
        mutant("lit-rod-nulls-in-one", "null collisions are left out of the density of shadow rays only", LIT_FULL, full, Steps { connected: |_, [phase, found, _]| phase * found / (phase + 1.0), ..full }),
        mutant("lit-rod-nulls-missing", "null collisions are left out of the density of hits only", LIT_FULL, full, Steps { after_null: |_, before| before, ..full }),
        mutant("lit-rod-not-reset", "p_nee is not reset at a real scattering: ρ is a product over the path", LIT_FULL, full, Steps { after_scattering: |right, before| right * before, ..full }),
        mutant("lit-rod-unscattered-weighted", "the unscattered hit is weighted as if a shadow ray could find it", LIT_FULL, full, Steps { unscattered: |weight| weight, ..full }),
        mutant("lit-rod-shadow-twice", "the transmittance of a shadow ray is a weight twice", LIT_NEXT_EVENT, ratio, Steps { connected: |right, [_, found, _]| right * found, ..ratio }),
        mutant("lit-rod-found-twice", "what shadow rays find is hit, too", LIT_NEXT_EVENT, ratio, Steps { hit: |_| 1.0, ..ratio }),
        mutant("lit-rod-albedo-twice", "the albedo is the chance of a scattering and a weight of its shadow ray", LIT_NEXT_EVENT, ratio, Steps { connected: |right, [_, _, albedo]| right * albedo, ..ratio }),
        mutant("lit-rod-carried-along", "the walk goes on where its shadow ray ended", LIT_NEXT_EVENT, ratio, Steps { goes_on: |_, ray| ray, ..ratio }),
        mutant("lit-rod-through-scattering", "scattering lets a shadow ray through: only absorption stops it", LIT_NEXT_EVENT_DELTA, delta, Steps { stops: |ratio, albedo| ratio * (1.0 - albedo), ..delta }),
        mutant("lit-rod-isotropic", "shadow rays take both directions to be alike", LIT_NEXT_EVENT_DELTA, delta, Steps { phase: |_| [0.5; 2], ..delta }),
        mutant("lit-rod-reversed", "the phase function of a shadow ray is that of the reversed direction", LIT_DIRECTIONAL, directional, Steps { phase: |forward| [1.0 - forward, forward], ..directional }),
        mutant("lit-rod-squared-weights", "the power heuristic squares weights that sum to 1", LIT_DIRECTIONAL, directional, Steps { hit: |right| right * right, connected: |right, [phase, ..]| right / (phase + 1.0), ..directional }),
    ]
}
