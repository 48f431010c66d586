//! Scattering at the first real collision of delta tracking.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! s the first tᵢ with uᵢ < σ_t(tᵢ)/σ̄(tᵢ),  p(s) = σ_t T;   X = S(s) T̂_shadow, 0 if there is none
//! analog: scattered if uᵢ < a σ_t/σ̄, else absorbed,  p(s) = a σ_t T;   X = (S/a) T̂_shadow, 0 if absorbed
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̄ ≥ σ_t on the ray | required here or in the case |
//! | `absorption` | `"weight"`: the albedo is a factor of S; `"analog"`: it is the chance of a real collision to scatter | `"weight"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }` | `"exact"` |
//!
//! The density knows nothing of the light: the variance
//! grows as `1/D³` when the light comes near the ray.
//!
//! Source: E. R. Woodcock, T. Murphy, P. Hemmings, T. Longworth, *Techniques used in the GEM code
//! for Monte Carlo neutronics calculations*, ANL-7050 (1965); Szirmay-Kalos et al. 2017, section 4.3.

use super::Connection;
use super::connection::{self, require_shadow};
use super::in_packets;
pub use super::technique::Absorption;
use super::technique::Kind;
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::catalogue::Settings;
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::Prediction;
use theory::problems::SingleScattering;
use theory::single::{CameraTracking, Points, Technique, Tracking};

/// Scattering at the first real collision.
#[derive(Debug, Clone)]
pub struct DeltaTracking {
    /// What absorption does.
    pub absorption: Absorption,
    /// How shadow rays are tracked.
    pub shadow: Tracking,
}

/// The end of a walk.
pub struct Walked {
    /// Where it scatters, if it does, and σ_t there.
    pub scattering: Option<[f64; 2]>,
    /// `Π (1 − σ_t/σ̄)` over its null collisions.
    pub nulls: f64,
    /// Its lookups.
    pub lookups: u32,
}

/// The first real collision, if there is one and it scatters, with the given chance.
#[inline(always)]
pub fn collide(
    setup: &Setup<SingleScattering>,
    medium: &Lookups,
    scatters: f64,
    rng: &mut Stream,
) -> Walked {
    let mut cursor = setup.sampling.begin();
    let mut walked = Walked { scattering: None, nulls: 1.0, lookups: 0 };
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        let Some(sampling) = setup.sampling.fly(&mut cursor, depth) else { return walked };
        walked.lookups += 1;
        let extinction = medium.extinction(cursor.t);
        if number * sampling < extinction {
            if number * sampling < extinction * scatters {
                walked.scattering = Some([cursor.t, extinction]);
            }
            return walked;
        }
        walked.nulls *= 1.0 - extinction / sampling;
    }
}

impl DeltaTracking {
    /// The moments of its draws.
    pub fn points(&self, setup: &Setup<SingleScattering>) -> Points {
        let collisions = self.absorption.collisions(setup);
        let technique = Technique {
            density: &|node| collisions.density(node),
            gain: &|node| collisions.worth(node),
            blur: &|node| node.error[1],
            found: Some(&collisions),
            weighted: None,
        };
        let connection = Connection { camera: CameraTracking::Exact, shadow: self.shadow };
        Points::of(&connection.scene(setup, setup.sampling.knots().to_vec()), &technique)
    }
}

impl Estimator<SingleScattering> for DeltaTracking {
    const INPUTS: Inputs = Inputs::SAMPLING;
    in_packets!(self => (Kind::Collision(self.absorption), self.shadow));

    fn read(settings: &Settings) -> Option<Self> {
        let absorption = Absorption::read(settings);
        let shadow = connection::read_shadow(settings);
        Some(Self { absorption: absorption?, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        let shadow = connection::shadow_label(self.shadow);
        if self.absorption == Absorption::Analog { format!("analog, {shadow}") } else { shadow }
    }

    fn needs(&self) -> Option<&'static str> {
        connection::shadow_needs(self.shadow)
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        require_shadow(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        self.points(setup).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let scatters = self.absorption.scatters(setup.problem.albedo());
        let Walked { scattering, lookups, .. } = collide(setup, medium, scatters, rng);
        let Some([s, _]) = scattering else { return Draw::free([0.0], lookups) };
        let (lit, cast) = connection::shadow(&setup.problem, self.shadow, s, rng);
        Draw::free([setup.problem.source(s) / scatters * lit], lookups + cast)
    }
}
