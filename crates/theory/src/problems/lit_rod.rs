//! What a camera sees of an emitter through a rod: light that scatters forward and backward along a line.
//!
//! ```text
//! the camera stands at the beginning and looks forward; the emitter is the end of the rod, of radiance 1
//! a path from the camera collides (rate σ_t), is scattered with probability a, and then keeps its direction with
//! probability p_f; L is the chance that it reaches the emitter: the rod's transmittance
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | a field in 1-D and where it is asked about | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | a field in 3-D and a ray through it: the rod | is required |
//! | `albedo` | a in [0, 1]: a number, or a field as in `rod` | required unless swept |
//! | `forward` | `p_f` in [0, 1], the probability that scattering keeps the direction; likewise | 0.5 |
//! | `sampling` | σ̂ of every estimator without its own; a majorant | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! The emitter touches the medium: a ray that ends beyond the field's bounds, or on which nothing is
//! ever met, is a mistake.
//!
//! In a rod the emitter fills every direction in which it lies, so that a shadow ray from y finds it for certain:
//! next-event estimation has the pdf 1 for its direction, and unidirectional tracking the phase function, `p_f` or
//! `1 − p_f`.
//!
//! The answer is exact: a closed form where a and `p_f` are constant, elsewhere by two coupled equations.
//!
//! Source: the rod is that of R. Bellman, R. Kalaba, G. M. Wing, *Invariant Imbedding and Mathematical Physics*,
//! Journal of Mathematical Physics 1 (1960); what is sampled, that of B. Miller, I. Georgiev, W. Jarosz, *A
//! null-scattering path integral formulation of light transport*, ACM Transactions on Graphics 38 (2019), section 5.

use super::rod::{Quantity, Rod, share};
use super::{Problem, default_albedo};
use media::catalogue::Settings;
use media::{Body, Medium, Piecewise};
use numeric::digits::{number, rounded};

/// A support that ends so little before its ray, relative to the ray's length, ends with it.
const TOUCHES: f64 = 1e-9;

/// A rod with an emitter at its end.
pub struct LitRod {
    /// The rod; its one channel is what it transmits.
    pub rod: Rod,
}

impl LitRod {
    /// A rod with an albedo and a probability to scatter forward, both in `[0, 1]`.
    pub fn new(medium: Medium, albedo: &Piecewise, forward: &Piecewise) -> Self {
        Self { rod: Rod::new(medium, albedo, forward, vec![Quantity::Transmitted]) }
    }
}

/// The field along a rod that touches its emitter.
pub(super) fn before_emitter(body: &Body, settings: &Settings) -> Option<Medium> {
    let key = if matches!(body, Body::Volume { .. }) { "ray" } else { "medium" };
    let medium = body.medium();
    let (span, support) = (medium.span(), medium.support());
    if span.to - support.to > TOUCHES * span.length() {
        let (end, bound) = (number(span.to), rounded(support.to));
        let found = format!("the emitter, at {end}, is in a vacuum: the field ends at {bound}");
        settings.fault(key, found, "end the ray inside the bounds of the field");
        return None;
    }
    if medium.optical_depth(support).value <= 0.0 {
        let found = "the emitter is behind a vacuum: σ_t = 0 from the camera to it";
        settings.fault(key, found, "give the rod some extinction");
        return None;
    }
    Some(medium)
}

impl Problem for LitRod {
    type Value = [f64; 1];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedo = share(settings, "albedo", default_albedo(settings));
        let forward = share(settings, "forward", Some(0.5));
        let medium = before_emitter(body?, settings)?;
        Some(Self::new(medium, &albedo?, &forward?))
    }

    fn medium(&self) -> &Medium {
        self.rod.medium()
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        self.rod.with_albedo(albedo).map(|rod| Self { rod })
    }
}
