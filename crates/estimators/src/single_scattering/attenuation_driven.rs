//! Attenuation-driven: the interaction points of one transmittance walk are the scattering points.
//!
//! Unbiased for: every σ̂ > 0 where σ_t or the residual is not 0.
//!
//! ```text
//! X = Σᵢ T̂(tᵢ) σ_t(tᵢ) S(tᵢ) T̂_shadow(tᵢ) / σ̂(tᵢ),   tᵢ a Poisson process of rate σ̂
//! T̂(tᵢ) = T_c(tᵢ) ∏_{j<i} (1 − rⱼ),  rⱼ = (σ_t − σ_c)/σ̂
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̂ > 0 wherever the residual is not zero, and wherever σ_t is not | required here or in the case |
//! | `control` | σ_c | none |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, for each point | `"exact"` |
//!
//! Unbiased there, by Campbell's theorem: interaction points have the density σ̂. It mimics none of
//! the factors of the integrand, and the variance grows as `1/D³` when the light comes near the ray.
//!
//! All four moments are known: those of the rest of a walk obey a chain of linear equations.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3.

use super::Connection;
use super::connection::{self, require_shadow};
use super::in_packets;
use super::technique::Kind;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::catalogue::Settings;
use media::{Control, Extinction, Lookups};
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::Prediction;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Scene, Tracking, walks};

/// Attenuation-driven scattering.
#[derive(Debug, Clone)]
pub struct AttenuationDriven {
    shadow: Tracking,
}

/// σ̂ must reach wherever the residual is not zero, and wherever there is anything to scatter.
pub(super) fn require(setup: &Setup<SingleScattering>, shadow: Tracking) -> Result<(), Refusal> {
    setup.require_coverage()?;
    if !setup.control.is_none() {
        let sampling = Some(setup.sampling.clone());
        let (problem, mesh) = (setup.problem.clone(), setup.mesh.clone());
        Setup::new(problem, mesh, sampling, Control::None).require_coverage()?;
    }
    require_shadow(setup, shadow)
}

/// For theory.
pub(super) fn scene(setup: &Setup<SingleScattering>, shadow: Tracking) -> Scene<'_> {
    Connection { camera: CameraTracking::Ratio, shadow }.scene(setup, Vec::new())
}

/// Walks to the end and tells of every interaction point: where it is, `T̂ σ_t S/σ̂` and σ_t there.
/// Answers the lookups.
#[inline(always)]
pub(super) fn interactions(
    setup: &Setup<SingleScattering>,
    medium: &Lookups,
    rng: &mut Stream,
    mut tell: impl FnMut(f64, f64, &mut Stream),
) -> u32 {
    let from = setup.problem.medium().support().from;
    let mut cursor = setup.sampling.begin();
    let (mut weight, mut lookups) = (1.0, 0);
    while let Some(sampling) = setup.sampling.fly(&mut cursor, -rng.ln_uniform()) {
        let t = cursor.t;
        let extinction = medium.extinction(t);
        lookups += 1;
        if extinction > 0.0 {
            let controlled = match &setup.control {
                Control::None => 1.0,
                control => Lane::exp(-control.optical_depth(Span::new(from, t)).value),
            };
            let source = extinction * setup.problem.source(t) / sampling;
            tell(t, weight * controlled * source, rng);
        }
        weight *= 1.0 - (extinction - setup.control.extinction(t)) / sampling;
    }
    lookups
}

impl Estimator<SingleScattering> for AttenuationDriven {
    const INPUTS: Inputs = Inputs::BOTH;
    in_packets!(self => (Kind::Interactions, self.shadow));

    fn read(settings: &Settings) -> Option<Self> {
        Some(Self { shadow: connection::read_shadow(settings)? })
    }

    fn label(&self, _: bool) -> String {
        connection::shadow_label(self.shadow)
    }

    fn needs(&self) -> Option<&'static str> {
        connection::shadow_needs(self.shadow)
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        require(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        walks::at_collisions(&scene(setup, self.shadow)).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let mut draw = Draw::free([0.0], 0);
        let mut cast = 0;
        let walked = interactions(setup, medium, rng, |t, weight, rng| {
            let (lit, lookups) = connection::shadow(&setup.problem, self.shadow, t, rng);
            draw.value[0] += weight * lit;
            cast += lookups;
        });
        draw.lookups = walked + cast;
        draw
    }
}
