//! Attenuation-driven with sampling importance resampling: one shadow ray for a whole walk.
//!
//! Unbiased for: every σ̂ > 0 where σ_t or the residual is not 0.
//!
//! ```text
//! X = (Σᵢ |yᵢ|) sgn(y_J) T̂_shadow(t_J),  yᵢ = T̂(tᵢ) σ_t(tᵢ) S(tᵢ)/σ̂(tᵢ),  P(J = i) = |yᵢ|/Σ|y|
//! ```
//!
//! Settings and domain are those of `attenuation-driven`. The chosen point is kept while the walk goes
//! on (reservoir sampling), with one random number for each interaction point.
//!
//! The variance is never below that of `attenuation-driven`; what is saved are shadow rays. Lookups
//! are predicted where shadow rays have none: which point is chosen depends on all of them.
//!
//! Source: J. Talbot, D. Cline, P. Egbert, *Importance resampling for global illumination*,
//! Eurographics Symposium on Rendering (2005); Szirmay-Kalos et al. 2017, section 4.3.

use super::attenuation_driven::{interactions, require, scene};
use super::connection;
use super::in_packets;
use super::technique::Kind;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SingleScattering;
use theory::single::{Tracking, walks};

/// Attenuation-driven scattering, resampled.
#[derive(Debug, Clone)]
pub struct AttenuationResampled {
    shadow: Tracking,
}

impl Estimator<SingleScattering> for AttenuationResampled {
    const INPUTS: Inputs = Inputs::BOTH;
    in_packets!(self => (Kind::Resampled, self.shadow));

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
        let is_free = self.shadow == Tracking::Exact;
        walks::resampled(&scene(setup, self.shadow), is_free).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let (mut sum, mut chosen) = (0.0, (0.0, 0.0));
        let walked = interactions(setup, medium, rng, |t, weight, rng| {
            sum += weight.abs();
            if rng.uniform() * sum < weight.abs() {
                chosen = (t, weight);
            }
        });
        if sum == 0.0 {
            return Draw::free([0.0], walked);
        }
        let (t, weight) = chosen;
        let (lit, cast) = connection::shadow(&setup.problem, self.shadow, t, rng);
        Draw::free([sum.copysign(weight) * lit], walked + cast)
    }
}
