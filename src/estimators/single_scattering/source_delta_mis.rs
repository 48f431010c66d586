//! Equiangular points and delta tracking together, weighted by the balance heuristic.
//!
//! ```text
//! X = Σ_{i=1,2} T σ_t S T̂_shadow / (p₁ + p₂)  at sᵢ,  sᵢ of density pᵢ,  0 where there is no s₂
//! p₁ = D/(Δθ r²),   p₂ = σ_t T
//! ```
//!
//! The weights need the value of p₂, and so the transmittance of the ray in closed form; it is used
//! for the first point as well. Settings are those of `delta-tracking`.
//!
//! Unbiased for `σ̄ ≥ σ_t`; refused elsewhere. The variance stays bounded however near the light is.
//!
//! Source: E. Veach, L. Guibas, *Optimally Combining Sampling Techniques for Monte Carlo Rendering*,
//! SIGGRAPH 1995, section 3; C. Kulla, M. Fajardo, *Importance Sampling Techniques for Path Tracing
//! in Participating Media*, Computer Graphics Forum 31 (2012).

use super::Connection;
use super::connection::{self, require_shadow};
use super::delta_tracking::{collide, lookups_at, lookups_of_escape};
use super::in_packets;
use super::packet::Kind;
use super::source_driven::point;
use crate::catalogue::Settings;
use crate::estimators::{Draw, Estimator, Inputs, Refusal, Setup};
use crate::media::{Extinction, Lookups};
use crate::numeric::{Lane, Span};
use crate::problems::{Problem, SingleScattering};
use crate::rng::Stream;
use crate::theory::Prediction;
use crate::theory::single::predict::{DENSITY, Found};
use crate::theory::single::{CameraTracking, Node, Points, Technique, Tracking};

/// Equiangular points and delta tracking.
#[derive(Debug, Clone)]
pub struct SourceDeltaMis {
    shadow: Tracking,
}

impl SourceDeltaMis {
    fn connection(&self) -> Connection {
        Connection { camera: CameraTracking::Exact, shadow: self.shadow }
    }
}

impl Estimator<SingleScattering> for SourceDeltaMis {
    const INPUTS: Inputs = Inputs::SAMPLING;
    in_packets!(self => (Kind::SourceAndCollision, self.shadow));

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
        let source = |node: &Node| setup.problem.equiangular_density_beyond(node.along);
        let collision = |node: &Node| node.extinction * node.transmittance;
        let gain = |node: &Node| node.extinction * node.source / (source(node) + collision(node));
        let walked = |node: &Node| node.transmittance * gain(node);
        let blur = |node: &Node| node.error[1] + DENSITY;
        let scene = self.connection().scene(setup, setup.sampling.knots().to_vec());
        let first = Technique { density: &source, gain: &gain, blur: &blur, found: None };
        let second = Technique {
            density: &collision,
            gain: &walked,
            blur: &blur,
            found: Some(Found {
                at: &|node| lookups_at(setup, node),
                none: lookups_of_escape(setup),
            }),
        };
        Points::of(&scene, &first).plus(&Points::of(&scene, &second)).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let problem = &setup.problem;
        let s = point(problem, rng.uniform());
        let mut draw = Draw::free([0.0], 1);
        let extinction = medium.extinction(s);
        if extinction > 0.0 {
            self.add(setup, extinction, s, rng, &mut draw);
        }
        let (collision, walked) = collide(setup, medium, rng);
        draw.lookups += walked;
        if let Some(s) = collision {
            self.add(setup, medium.extinction(s), s, rng, &mut draw);
        }
        draw
    }
}

impl SourceDeltaMis {
    /// Adds what a point gives; σ_t there has been looked up before.
    #[inline(always)]
    fn add(
        &self,
        setup: &Setup<SingleScattering>,
        extinction: f64,
        s: f64,
        rng: &mut Stream,
        draw: &mut Draw<[f64; 1]>,
    ) {
        let problem = &setup.problem;
        let before = Span::new(problem.medium().support().from, s);
        let transmittance = Lane::exp(-problem.medium().optical_depth(before).value);
        let (lit, cast) = connection::shadow(problem, self.shadow, s, rng);
        let collision = extinction * transmittance;
        let density = problem.equiangular_density(s) + collision;
        draw.value[0] += collision * problem.source(s) * lit / density;
        draw.lookups += cast;
    }
}
