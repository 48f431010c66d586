//! Next-event estimation: every scattering casts a shadow ray to the emitter.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! X = [reached unscattered] + Σ p(ω) t̂(y, L)   over the scatterings y of a path by delta tracking
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `shadow` | t̂: `"exact"` transmittance, `"delta"` or `"ratio"` tracking through σ̂ | `"ratio"` |
//!
//! A shadow ray always finds the emitter; p(ω) is the phase function towards it, `p_f` or `1 − p_f`. Hits after a
//! scattering score nothing. No shadow ray makes the unscattered hit: it scores 1.
//!
//! It takes σ̂, which must be a majorant. A tentative collision of a shadow ray is a lookup; delta tracking stops at a
//! real one. Exact shadow rays cost none; they are theory, which uses the platform's library: the last bits of
//! their draws may differ between machines. In a rod the emitter is easy to hit, and sums over scatterings may vary
//! more than hits: next-event estimation alone may be worse than `unidirectional`.
//!
//! Source: R. R. Coveyou, V. R. Cain, K. J. Yost, *Adjoint and Importance in Monte Carlo Application*, Nuclear
//! Science and Engineering 27 (1967); J. Novák, A. Selle, W. Jarosz, *Residual Ratio Tracking for Estimating
//! Attenuation in Participating Media*, ACM Transactions on Graphics 33 (2014).
//!
//! ```toml
//! title = "An example of next-event"
//!
//! [problem.rod]
//! medium = 1
//! span = [0, 2]
//! albedo = 0.9
//! forward = 0.75
//! light = "emitter"
//! sampling = 1.6
//! estimators = [{ next-event.shadow = "delta" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::{Lit, lit, read_shadow};
use crate::Estimator;
use media::catalogue::Settings;
use theory::light::{Combination, Shadow, Techniques};

/// Shadow rays alone; σ̂ is its input.
#[derive(Debug, Clone)]
pub struct NextEvent {
    shadow: Shadow,
}

impl NextEvent {
    fn techniques(&self) -> Techniques {
        Techniques { shadow: Some(self.shadow), combination: Combination::NextEvent }
    }
}

impl<P: Lit> Estimator<P> for NextEvent {
    fn read(settings: &Settings) -> Option<Self> {
        let shadow = read_shadow(settings, &["exact", "delta", "ratio"], "ratio")?;
        Some(Self { shadow })
    }

    lit!(self => self.techniques());
}
