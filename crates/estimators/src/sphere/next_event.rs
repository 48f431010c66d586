//! Next-event estimation: a shadow ray to the light from every scattering of a walk.
//!
//! Unbiased for: σ̂ ≥ σ_t, and σ̂ and σ_c of shadow rays that are near σ_t; refused elsewhere.
//!
//! ```text
//! X = [light met before the first scattering] + Σ w Ω/4π T̂ over the scatterings
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `rule`, `roulette` | how the particle walks, see the page `particle` | `rule` required |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, each one number | `"exact"` |
//!
//! Shadow rays are delta tracked, ratio tracked, residual-ratio tracked (`control`), or taken from exact
//! optical depths. They are clipped to the ball and to the light.
//!
//! Unbiased for every σ̂ of walk and shadow rays, but for a delta-tracked shadow, which needs a majorant.
//! Needed is `σ̂ ≥ σ_t` of the walk, and a σ̂ and σ_c of shadow rays that are not far from σ_t: then theory
//! bounds the variance, sharply where weights and tracked transmittances are 0 or 1. The number of
//! lookups is not known. The exact shadow uses the platform's library: the last bits of draws with one may
//! differ between machines.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), section 5.3; J. Novák, A. Selle, W. Jarosz,
//! *Residual ratio tracking for estimating attenuation in participating media*, ACM Transactions on
//! Graphics 33 (2014). The bound is derived in `theory/sphere/spread.rs`.

use fearless_simd::Level;

use super::{Connect, Honest, Seeker};
use crate::kernels::packet::Request;
use crate::single_scattering::connection;
use crate::space::{self, Particle, Splitting, draws};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::Lookups;
use media::catalogue::Settings;
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::Sphere;
use theory::single::Tracking;
use theory::sphere::Techniques;

/// A walk with shadow rays.
#[derive(Debug, Clone)]
pub struct NextEvent {
    /// The particle.
    pub particle: Particle,
    /// The tracking of shadow rays.
    pub shadow: Tracking,
}

impl NextEvent {
    /// Makes a draw by steps.
    pub fn draw_by(
        &self,
        connect: impl Connect,
        setup: &Setup<Sphere>,
        random: &mut Stream,
    ) -> Draw {
        let Some(majorants) = setup.space.as_deref() else { return space::nothing() };
        let sphere = &*setup.problem;
        let seeker = Seeker::<_, true> { sphere, shadow: self.shadow, connect };
        let (steps, world) = ((self.particle, Splitting::None), (&sphere.scene, majorants));
        draws::draw::<_, _, false>(&seeker, steps, world, random)
    }
}

impl Estimator<Sphere> for NextEvent {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const IN_PACKETS: bool = true;

    fn read(settings: &Settings) -> Option<Self> {
        let particle = Particle::read(settings);
        let shadow = connection::read_shadow(settings);
        Some(Self { particle: particle?, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        format!("{}, {}", self.particle.label(), connection::shadow_label(self.shadow))
    }

    fn needs(&self) -> Option<&'static str> {
        connection::shadow_needs(self.shadow)
    }

    fn domain(&self, setup: &Setup<Sphere>) -> Result<(), Refusal> {
        super::connected(setup, &self.particle, self.shadow)
    }

    fn predict(&self, setup: &Setup<Sphere>) -> Prediction {
        super::predict_together(setup, Techniques::NextEvent, self.shadow)
    }

    #[inline]
    fn draw(&self, setup: &Setup<Sphere>, _: &Lookups, random: &mut Stream) -> Draw {
        self.draw_by(Honest, setup, random)
    }

    fn draw_packets<'a>(
        &self,
        level: Level,
        setup: &Setup<Sphere>,
        _: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>> {
        let Some(majorants) = setup.space.as_deref() else { return Some(request) };
        let sphere = &*setup.problem;
        let seeker = Seeker::<_, true> { sphere, shadow: self.shadow, connect: Honest };
        draws::packets(level, &seeker, &self.particle, (&sphere.scene, majorants), request)
    }
}
