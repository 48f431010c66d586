//! The radiance of a ray by a fast quadrature that does not aim at the last digit.

use crate::problems::{Problem, SingleScattering};
use numeric::quadrature::GaussLegendre;
use numeric::{Known, Span};

/// Nodes of a panel.
const NODES: usize = 16;

/// L by panels of equal angle as seen from the light, in which `1/r²` is constant; the optical depths are exact.
/// The error is the difference to half as many panels: nearly always far larger than the true error, but no bound.
pub fn radiance(problem: &SingleScattering, panels: usize) -> Known {
    if problem.medium().support().is_empty() {
        return Known::exact(0.0);
    }
    let rule = GaussLegendre::new(NODES);
    let [fine, coarse] = [2 * panels, panels].map(|panels| over(problem, &rule, panels));
    Known::of_resolutions(fine, coarse)
}

fn over(problem: &SingleScattering, rule: &GaussLegendre, panels: usize) -> f64 {
    let medium = problem.medium();
    let from = medium.support().from;
    let angles = problem.angles();
    let gathered = |angle: f64| {
        let s = problem.at_angle(angle);
        let before = medium.optical_depth(Span::new(from, s)).value;
        let beyond = problem.shadow_medium(s);
        let beyond = beyond.map_or(0.0, |m| m.optical_depth(m.support()).value);
        // ds/dθ = r²/D.
        let stretch = 1.0 / (problem.equiangular_density(s) * angles.length());
        medium.extinction(s) * problem.source(s) * stretch * (-(before + beyond)).exp()
    };
    let width = angles.length() / panels as f64;
    let panel = |i: usize| {
        let begin = angles.from + width * i as f64;
        rule.integrate(begin, begin + width, gathered)
    };
    (0..panels).map(panel).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::problems::single_scattering::Lamp;
    use media::eq21::Eq21;
    use media::phase::{Phase, rayleigh::Rayleigh};
    use numeric::geometry::{Point, Ray};

    fn problem() -> SingleScattering {
        let (origin, direction) = (Point([0.0, 0.0, -5.0]), Point([0.0, 0.0, 1.0]));
        let ray = Ray::new(origin, direction, 30.0).expect("a direction");
        let lamp = Lamp { position: Point([1.2, -0.8, 9.3]), power: 1.0 };
        let (volume, phase) = (Arc::new(Eq21), Phase::Rayleigh(Rayleigh));
        SingleScattering::new(volume, ray, lamp, 0.7, phase).expect("off the line")
    }

    #[test]
    fn a_quick_quadrature_is_near_and_says_how_near() {
        // 30-digit arithmetic.
        let exact = 1.715_523_536_208_36e-4;
        for panels in [8, 16, 32] {
            let result = radiance(&problem(), panels);
            let off = (result.value - exact).abs();
            assert!(panels < 32 || off <= 1e-12 * exact, "{off:e}");
            assert!(off <= result.error + 1e-13 * exact, "{off:e} and {:e}", result.error);
        }
    }

    #[test]
    fn a_ray_that_misses_gathers_nothing() {
        let (origin, direction) = (Point([0.0, 30.0, -5.0]), Point([0.0, 0.0, 1.0]));
        let ray = Ray::new(origin, direction, 30.0).expect("a direction");
        let lamp = Lamp { position: Point([1.2, -0.8, 9.3]), power: 1.0 };
        let (volume, phase) = (Arc::new(Eq21), Phase::Rayleigh(Rayleigh));
        let problem = SingleScattering::new(volume, ray, lamp, 0.7, phase).expect("off the line");
        assert_eq!(radiance(&problem, 4).value, 0.0);
    }
}
