//! Equiangular points and delta tracking together, weighted by multiple importance sampling.
//!
//! Unbiased for: σ̂ ≥ σ_t; refused elsewhere.
//!
//! ```text
//! p₁ = D/(Δθ r²),   p₂ = c σ_t x,   f = σ_t S x T̂_shadow
//! both   X = Σ_{i=1,2} f(sᵢ) w_i/p_i,   w_i = p_i^β/(p₁^β + p₂^β),   0 where there is no s₂
//! one    X = 2 f(sᵢ) w_i/p_i,   i = 1 or 2 with chances of ½
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `sampling` | σ̄ ≥ σ_t on the ray | required here or in the case |
//! | `camera` | what x is: `"exact"`, the transmittance T in closed form, or `"ratio"`, `Π (1 − σ_t/σ̄)` over the null collisions of the path, by ratio tracking where the point is from the light | `"exact"` |
//! | `absorption` | `"weight"`: c = 1; `"analog"`: the albedo c is the chance of a real collision to scatter | `"weight"` |
//! | `samples` | `"both"` techniques in a draw, or `"one"` of them | `"both"` |
//! | `heuristic` | β: `"balance"` (1) or `"power"` (2) | `"balance"` |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }` | `"exact"` |
//!
//! With a tracked camera the weights are those of the null-scattering path: both densities hold the same majorant
//! transmittances, which cancel, and so do all of the shadow ray. A shadow ray is cast even where x is 0.
//!
//! The variance stays bounded however near the light is.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*,
//! SIGGRAPH 1995, section 3; C. Kulla, M. Fajardo, *Importance Sampling Techniques for Path Tracing
//! in Participating Media*, Computer Graphics Forum 31 (2012); B. Miller, I. Georgiev, W. Jarosz, *A null-scattering
//! path integral formulation of light transport*, ACM Transactions on Graphics 38 (2019), section 5.

use super::Connection;
use super::connection::{self, camera, require_shadow};
use super::delta_tracking::{Walked, collide};
use super::in_packets;
use super::technique::{Absorption, Kind, Sharing, point};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::catalogue::Settings;
use media::{Extinction, Lookups};
use numeric::rng::Stream;
use theory::problems::SingleScattering;
use theory::single::{CameraTracking, Mis, NullPaths};
use theory::{Heuristic, Prediction};

/// Equiangular points and delta tracking.
#[derive(Debug, Clone)]
pub struct SourceDeltaMis {
    connection: Connection,
    sharing: Sharing,
}

impl Estimator<SingleScattering> for SourceDeltaMis {
    const INPUTS: Inputs = Inputs::SAMPLING;
    in_packets!(self => (Kind::SourceAndCollision(self.sharing), self.connection.shadow));

    fn read(settings: &Settings) -> Option<Self> {
        let connection = Connection::read(settings, &["exact", "ratio"]);
        let absorption = Absorption::read(settings);
        let samples = settings.word_or("samples", &["both", "one"], "both");
        let heuristic = Heuristic::read(settings);
        let connection = connection?;
        let sharing = Sharing {
            camera: connection.camera,
            absorption: absorption?,
            is_one: samples? == "one",
            heuristic: heuristic?,
        };
        Some(Self { connection, sharing })
    }

    fn label(&self, _: bool) -> String {
        let Sharing { camera, absorption, is_one, heuristic } = self.sharing;
        let said = [
            (camera == CameraTracking::Ratio, "null paths, "),
            (absorption == Absorption::Analog, "analog, "),
            (is_one, "one sample, "),
            (heuristic == Heuristic::Power, "power, "),
        ];
        let said: String = said.iter().filter(|(is, _)| *is).map(|(_, word)| *word).collect();
        said + &connection::shadow_label(self.connection.shadow)
    }

    fn needs(&self) -> Option<&'static str> {
        self.connection.needs()
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        setup.require_ratio_at_most(1.0, "σ̂ ≥ σ_t everywhere")?;
        require_shadow(setup, self.connection.shadow)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let Sharing { camera, absorption, heuristic, .. } = self.sharing;
        let nulls = (camera == CameraTracking::Ratio)
            .then(|| NullPaths::new(&setup.mesh, &setup.sampling, heuristic));
        let scene = &self.connection.scene(setup, setup.sampling.knots().to_vec());
        let mis = Mis { scene, collisions: absorption.collisions(setup), heuristic, nulls };
        let [first, second] = mis.points();
        let found = if self.sharing.is_one { first.either(&second) } else { first.plus(&second) };
        found.prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let Sharing { camera: along, absorption, is_one, .. } = self.sharing;
        let mut draw = Draw::free([0.0], 0);
        let from_light = !is_one || rng.uniform() < 0.5;
        if from_light {
            let s = point(&setup.problem, rng.uniform());
            let extinction = medium.extinction(s);
            draw.lookups += 1;
            if extinction > 0.0 {
                let (kept, walked) = camera(setup, medium, along, s, rng);
                draw.lookups += walked;
                self.add(setup, [s, extinction, kept], true, rng, &mut draw);
            }
        }
        if !(is_one && from_light) {
            let scatters = absorption.scatters(setup.problem.albedo());
            let Walked { scattering, nulls, lookups } = collide(setup, medium, scatters, rng);
            draw.lookups += lookups;
            if let Some([s, extinction]) = scattering {
                let kept = match along {
                    CameraTracking::Exact => camera(setup, medium, along, s, rng).0,
                    _ => nulls,
                };
                self.add(setup, [s, extinction, kept], false, rng, &mut draw);
            }
        }
        draw
    }
}

impl SourceDeltaMis {
    /// Adds what a point gives: where it is, σ_t there and x.
    #[inline(always)]
    fn add(
        &self,
        setup: &Setup<SingleScattering>,
        [s, extinction, kept]: [f64; 3],
        from_light: bool,
        rng: &mut Stream,
        draw: &mut Draw<[f64; 1]>,
    ) {
        let problem = &setup.problem;
        let scatters = self.sharing.absorption.scatters(problem.albedo());
        let (lit, cast) = connection::shadow(problem, self.connection.shadow, s, rng);
        let collision = extinction * scatters * kept;
        let point = problem.equiangular_density(s);
        let (own, other) = if from_light { (point, collision) } else { (collision, point) };
        let density = self.sharing.heuristic.shared(own, other);
        let times = if self.sharing.is_one { 2.0 } else { 1.0 };
        draw.value[0] += times * (collision * (problem.source(s) / scatters) * lit / density);
        draw.lookups += cast;
    }
}
