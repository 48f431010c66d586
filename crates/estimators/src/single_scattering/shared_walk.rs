//! Several equiangular points with the continuous transmittance of one walk.
//!
//! Unbiased for: every σ̂ > 0 where the residual is not 0.
//!
//! ```text
//! X = (1/n) Σⱼ T̂(sⱼ) σ_t(sⱼ) S(sⱼ) T̂_shadow(sⱼ) / p(sⱼ),   p(s) = D/(Δθ r²)
//! T̂(s) = T_c(s) ∏_{tᵢ<s} (1 − rᵢ),  one walk for all s
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `points` | n, from 1 to 16 | 4 |
//! | `sampling` | σ̂ > 0 wherever the residual is not zero | required here or in the case |
//! | `control` | σ_c | none |
//! | `shadow` | `"exact"`, `ratio = { sampling, control }` or `delta = { sampling }`, for each point | `"exact"` |
//!
//! Between interaction points `T̂` falls off exponentially with the control, so that one walk over
//! the whole ray serves every point. Unbiased as each point is; the points are not independent, and
//! the four moments take their joint law into account.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3.

use super::Connection;
use super::connection::{self, require_shadow};
use super::in_packets;
use super::technique::{Kind, MOST, point};
use crate::{Draw, Estimator, Inputs, Refusal, Setup};
use media::catalogue::Settings;
use media::{Control, Extinction, Lookups};
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::Prediction;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Node, Tracking, walks};

/// Points that share a walk.
#[derive(Debug, Clone)]
pub struct SharedWalk {
    points: usize,
    shadow: Tracking,
}

impl Estimator<SingleScattering> for SharedWalk {
    const INPUTS: Inputs = Inputs::BOTH;
    in_packets!(self => (Kind::Shared(self.points), self.shadow));

    fn read(settings: &Settings) -> Option<Self> {
        let points = settings.count_or("points", 1..=MOST as u64, 4);
        let shadow = connection::read_shadow(settings);
        Some(Self { points: usize::try_from(points?).ok()?, shadow: shadow? })
    }

    fn label(&self, _: bool) -> String {
        format!("{} points, {}", self.points, connection::shadow_label(self.shadow))
    }

    fn needs(&self) -> Option<&'static str> {
        connection::shadow_needs(self.shadow)
    }

    fn domain(&self, setup: &Setup<SingleScattering>) -> Result<(), Refusal> {
        setup.require_coverage()?;
        require_shadow(setup, self.shadow)
    }

    fn predict(&self, setup: &Setup<SingleScattering>) -> Prediction {
        let scene = Connection { camera: CameraTracking::Ratio, shadow: self.shadow }
            .scene(setup, Vec::new());
        let density = |node: &Node| setup.problem.equiangular_density_beyond(node.along);
        walks::at_points(&scene, self.points, &density).prediction()
    }

    #[inline(always)]
    fn draw(
        &self,
        setup: &Setup<SingleScattering>,
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Draw<[f64; 1]> {
        let problem = &setup.problem;
        let support = problem.medium().support();
        let mut at = [0.0; MOST];
        let at = &mut at[..self.points];
        at.fill_with(|| point(problem, rng.uniform()));
        at.sort_unstable_by(f64::total_cmp);
        let share = 1.0 / self.points as f64;
        let mut draw = Draw::free([0.0], 0);
        let mut cursor = setup.sampling.begin();
        let (mut weight, mut next) = (1.0, 0);
        loop {
            let collision = setup.sampling.fly(&mut cursor, -rng.ln_uniform());
            let reached = if collision.is_some() { cursor.t } else { f64::INFINITY };
            while next < at.len() && at[next] <= reached {
                let s = at[next];
                next += 1;
                let extinction = medium.extinction(s);
                draw.lookups += 1;
                if extinction <= 0.0 {
                    continue;
                }
                let controlled = match &setup.control {
                    Control::None => 1.0,
                    control => Lane::exp(-control.optical_depth(Span::new(support.from, s)).value),
                };
                let (lit, cast) = connection::shadow(problem, self.shadow, s, rng);
                let source = extinction * problem.source(s) / problem.equiangular_density(s);
                draw.value[0] += share * weight * controlled * source * lit;
                draw.lookups += cast;
            }
            let Some(sampling) = collision else { return draw };
            draw.lookups += 1;
            let extinction = medium.extinction(cursor.t);
            weight *= 1.0 - (extinction - setup.control.extinction(cursor.t)) / sampling;
        }
    }
}
