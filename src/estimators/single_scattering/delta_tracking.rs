//! Scattering at the first real collision of delta tracking.
//!
//! ```text
//! s the first tᵢ with uᵢ < σ_t(tᵢ)/σ̄(tᵢ),  p(s) = σ_t T;   X = S(s) T̂_shadow, 0 if there is none
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̄ ≥ σ_t on the ray | required here or in the case |
//! | `shadow` | `exact = {}`, `ratio = { sampling, control }` or `delta = { sampling }` | `exact = {}` |
//!
//! Unbiased for `σ̄ ≥ σ_t`; refused elsewhere. The density knows nothing of the light: the variance
//! grows as `1/D³` when the light comes near the ray.
//!
//! Source: E. R. Woodcock, T. Murphy, P. Hemmings, T. Longworth, *Techniques used in the GEM code
//! for Monte Carlo neutronics calculations*, ANL-7050 (1965); Szirmay-Kalos et al. 2017, section 4.3.

use super::Connection;
use super::connection::{self, require_shadow};
use super::in_packets;
use super::packet::Kind;
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::{Extinction, Lookups, OpticalDepth};
use crate::numeric::Span;
use crate::problems::{Problem, SingleScattering};
use crate::rng::Stream;
use crate::theory::Prediction;
use crate::theory::raw::{added, poisson};
use crate::theory::single::predict::Found;
use crate::theory::single::{CameraTracking, Node, Points, Technique, Tracking};

/// Scattering at the first real collision.
#[derive(Debug, Clone)]
pub struct DeltaTracking {
    shadow: Tracking,
}

/// The first real collision, if there is one, and the lookups of the walk.
#[inline(always)]
pub(super) fn collide(
    setup: &Setup<SingleScattering>,
    medium: &Lookups,
    rng: &mut Stream,
) -> (Option<f64>, u32) {
    let mut cursor = setup.sampling.begin();
    let mut lookups = 0;
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else { return (None, lookups) };
        lookups += 1;
        if number * sampling < medium.extinction(cursor.t) {
            return (Some(cursor.t), lookups);
        }
    }
}

/// The mean number of null collisions up to a point: `∫σ̄ − τ`.
fn nulls(setup: &Setup<SingleScattering>, s: f64) -> f64 {
    let medium = setup.problem.medium();
    let before = Span::new(medium.support().from, s);
    setup.sampling.optical_depth(before).value - medium.optical_depth(before).value
}

/// `E[N^k]` of a walk that collides at a node, with its shadow ray.
pub(super) fn lookups_at(setup: &Setup<SingleScattering>, node: &Node) -> [f64; 5] {
    added(added([1.0; 5], poisson(nulls(setup, node.s))), node.shadow.lookups)
}

/// `E[N^k; no collision]`.
pub(super) fn lookups_of_escape(setup: &Setup<SingleScattering>) -> [f64; 5] {
    let nulls = nulls(setup, setup.problem.medium().support().to);
    poisson(nulls).map(|moment| setup.transmittance * moment)
}

impl Estimator<SingleScattering> for DeltaTracking {
    const INPUTS: Inputs = Inputs::SAMPLING;
    in_packets!(self => (Kind::Collision, self.shadow));

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { shadow: connection::read_shadow(settings)? })
    }

    fn label(&self, _: bool) -> String {
        connection::shadow_label(self.shadow)
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        require_shadow(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let technique = Technique {
            density: &|node| node.extinction * node.transmittance,
            gain: &|node| node.source,
            blur: &|node| node.error[1],
            found: Some(Found {
                at: &|node| lookups_at(setup, node),
                none: lookups_of_escape(setup),
            }),
        };
        let connection = Connection { camera: CameraTracking::Exact, shadow: self.shadow };
        let scene = connection.scene(setup, setup.sampling.knots().to_vec());
        Points::of(&scene, &technique).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let (collision, walked) = collide(setup, medium, rng);
        let Some(s) = collision else { return Draw::free([0.0], walked) };
        let (lit, cast) = connection::shadow(&setup.problem, self.shadow, s, rng);
        Draw::free([setup.problem.source(s) * lit], walked + cast)
    }
}
