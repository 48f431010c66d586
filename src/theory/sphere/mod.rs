//! The ball: isotropic scattering in a radially symmetric medium, by Peierls' integral equation.
//!
//! ```text
//! J(r) = ½ ∫₋₁¹ I(r, ν) dν,   I(r, ν) = L e^{−τ(0, s)} + ∫₀ˢ σ_t a J e^{−τ(0, t)} dt
//! ```
//!
//! J is the mean intensity, `I(r, ν)` the radiance that arrives at a point at the distance r from the
//! centre, seen in a direction of the cosine ν with the outward one; the line of sight ends after the
//! length s, at the surface or at a black sphere, where the radiance is L. J is a polynomial of `r²` in
//! each of many shells ([`shells`]); the equation is met at their Gauss nodes, with the integrals along
//! lines of sight cut at the shells' surfaces ([`ball`]) and graded over directions ([`directions`]).
//! Any answer is computed twice, with fewer nodes and a coarser grading the second time, and the
//! difference is stated as its error.
//!
//! What starts at a point in a direction of any odds alike escapes with the probability `J(r)` under an
//! environment of radiance 1: by reciprocity. A distant light looks from the centre like an
//! environment of the same fluence, from other places it does not.
//!
//! Source: R. Peierls, *Critical conditions in neutron multiplication*, Mathematical Proceedings of the
//! Cambridge Philosophical Society 35 (1939); G. I. Bell, S. Glasstone, *Nuclear Reactor Theory* (Van
//! Nostrand Reinhold, 1970), section 1.2.

pub mod ball;
pub mod cache;
pub mod directions;
pub mod point;
pub mod shells;

use crate::numeric::Known;
use crate::numeric::matrix::Matrix;

use ball::Ball;
use shells::{Centre, Resolution, Row, Rules, Shells};

pub use cache::{Scene, cached};

/// The radiances at the ends of lines of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lights {
    /// Around the ball.
    pub environment: f64,
    /// Of the black sphere at the centre.
    pub core: f64,
}

/// What is asked about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Asked {
    /// The mean intensity at a distance from the centre.
    Mean(f64),
    /// The radiance that arrives along a line of sight.
    Radiance {
        /// Its distance from the centre.
        offset: f64,
        /// Where it begins, from its foot; before the ball for −∞.
        from: f64,
    },
}

/// A ball in which the equation of one albedo and one light is solved.
pub struct Solved<'a> {
    ball: &'a Ball<'a>,
    lights: Lights,
    resolution: Resolution,
    shells: Shells,
    rules: Rules,
    /// aJ at the nodes.
    source: Vec<f64>,
}

/// Light that arrives unscattered, and the weights of aJ at the nodes in the light that is scattered.
type Arriving = (f64, Vec<f64>);

impl<'a> Solved<'a> {
    /// Solves the equation; `None` where the medium is no medium: σ_t or a negative, or a above 1.
    #[must_use]
    pub fn new(
        ball: &'a Ball<'a>,
        albedo: f64,
        lights: Lights,
        resolution: Resolution,
    ) -> Option<Self> {
        let shells = Shells::new(ball.radius, ball.centre, ball.extinction, resolution);
        let rules = Rules::new(resolution.nodes + 8);
        let mut solved = Self { ball, lights, resolution, shells, rules, source: Vec::new() };
        let nodes = solved.shells.nodes(&solved.rules);
        let rows: Vec<Arriving> = nodes.iter().map(|r2| solved.mean_row(r2.sqrt())).collect();
        let matrix = Matrix::new(nodes.len(), nodes.len(), |i, j| albedo * rows[i].1[j]);
        let direct = Matrix::new(nodes.len(), 1, |i, _| albedo * rows[i].0);
        let found = matrix.series_times(&direct)?;
        solved.source = (0..nodes.len()).map(|i| found.at(i, 0)).collect();
        solved.source.iter().all(|x| x.is_finite()).then_some(solved)
    }

    /// Adds what arrives along one line of sight to a row; answers the unscattered part.
    fn sight(&self, offset2: f64, from: f64, weight: f64, row: &mut Row) -> f64 {
        let passage = self.ball.passage(offset2, from);
        let left = self.ball.collect(&passage, &self.shells, &self.rules, weight, row);
        weight * left * if passage.hits { self.lights.core } else { self.lights.environment }
    }

    fn mean_row(&self, r: f64) -> Arriving {
        let mut row = Row::new(self.shells.count);
        let ball = self.ball;
        let sights =
            directions::from_point(r, ball.radius, ball.centre, self.resolution, &self.rules);
        let direct: f64 = sights
            .iter()
            .map(|sight| self.sight(sight.offset2, sight.from, sight.weight, &mut row))
            .sum();
        (direct, row.weights(&self.shells, &self.rules))
    }

    /// The answer to a question.
    #[must_use]
    pub fn answer(&self, asked: Asked) -> f64 {
        let (direct, weights) = match asked {
            Asked::Mean(r) => self.mean_row(r),
            Asked::Radiance { offset, from } => {
                let mut row = Row::new(self.shells.count);
                let direct = self.sight(offset * offset, from, 1.0, &mut row);
                (direct, row.weights(&self.shells, &self.rules))
            }
        };
        direct + weights.iter().zip(&self.source).map(|(w, x)| w * x).sum::<f64>()
    }
}

/// What a thousand nodes lose in rounding, relative to the answer.
const ROUNDING: f64 = 1e-13;

/// Answers to several questions about one ball, with their errors; `None` where it is no medium.
#[must_use]
pub fn answers(
    ball: &Ball,
    albedo: f64,
    lights: Lights,
    resolution: Resolution,
    asked: &[Asked],
) -> Option<Vec<Known>> {
    let fine = Solved::new(ball, albedo, lights, resolution)?;
    let coarse = Solved::new(ball, albedo, lights, resolution.coarser())?;
    let known = |&asked: &Asked| {
        let value = fine.answer(asked);
        Known::new(value, (value - coarse.answer(asked)).abs() + ROUNDING * value.abs())
    };
    Some(asked.iter().map(known).collect())
}

/// Whether there is a black sphere that light may end on.
#[must_use]
pub fn centre_of(core: Option<f64>) -> Centre {
    core.map_or(Centre::Medium, Centre::Black)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKY: Lights = Lights { environment: 1.0, core: 0.0 };

    #[test]
    fn a_white_ball_in_a_white_environment_is_not_seen() {
        let extinction = |r2: f64| 3.0 - r2;
        let ball = Ball { radius: 1.3, centre: Centre::Medium, extinction: &extinction };
        let solved = Solved::new(&ball, 1.0, SKY, Resolution::COARSE).expect("a medium");
        for asked in [
            Asked::Mean(0.0),
            Asked::Mean(0.9),
            Asked::Mean(1.3),
            Asked::Radiance { offset: 0.4, from: f64::NEG_INFINITY },
            Asked::Radiance { offset: 0.4, from: 0.2 },
        ] {
            assert!((solved.answer(asked) - 1.0).abs() < 1e-9, "{asked:?}");
        }
    }

    #[test]
    fn a_white_ball_with_a_lamp_as_bright_as_the_sky_is_not_seen() {
        let ball = Ball { radius: 1.5, centre: Centre::Black(0.3), extinction: &|_| 1.0 };
        let lights = Lights { environment: 1.0, core: 1.0 };
        let solved = Solved::new(&ball, 1.0, lights, Resolution::COARSE).expect("a medium");
        for asked in [
            Asked::Mean(0.31),
            Asked::Mean(1.2),
            Asked::Radiance { offset: 0.1, from: f64::NEG_INFINITY },
        ] {
            assert!((solved.answer(asked) - 1.0).abs() < 1e-9, "{asked:?}");
        }
    }

    #[test]
    fn an_absorber_attenuates_and_nothing_else() {
        // From the centre all ways out are one radius long.
        let ball = Ball { radius: 2.0, centre: Centre::Medium, extinction: &|_| 0.7 };
        let solved = Solved::new(&ball, 0.0, SKY, Resolution::COARSE).expect("a medium");
        assert!((solved.answer(Asked::Mean(0.0)) - (-1.4f64).exp()).abs() < 1e-13);
        let across = Asked::Radiance { offset: 1.2, from: f64::NEG_INFINITY };
        assert!((solved.answer(across) - (-0.7f64 * 3.2).exp()).abs() < 1e-13);
    }

    #[test]
    fn a_light_and_an_eye_may_change_places() {
        // What enters from all sides and is absorbed by the black sphere, and what the sphere sends
        // out: J of the sky at its surface against the power that leaves the ball.
        let ball =
            Ball { radius: 1.5, centre: Centre::Black(0.4), extinction: &|r2| 1.5 - 0.4 * r2 };
        let solve = |lights| Solved::new(&ball, 0.8, lights, Resolution::COARSE).expect("a medium");
        let sky = solve(SKY);
        let lamp = solve(Lights { environment: 0.0, core: 1.0 });
        let rules = Rules::new(40);
        // Flux onto the black sphere from the sky: ∫ I cos over its surface; and through the ball's
        // surface from the lamp. Both counted by lines of sight: 2π ∫ I p dp.
        let out = rules.of(40);
        let flux = |solved: &Solved, from: f64, to: f64, begin: fn(f64, f64) -> f64| {
            out.integrate(from, to, |p| {
                p * solved.answer(Asked::Radiance { offset: p, from: begin(p, 0.4) })
            })
        };
        let far: fn(f64, f64) -> f64 = |_, _| f64::NEG_INFINITY;
        let near: fn(f64, f64) -> f64 = |p, core| (core * core - p * p).sqrt();
        let received = flux(&sky, 0.0, 0.4, near);
        let sent = flux(&lamp, 0.0, 0.4, far) + flux(&lamp, 0.4, 1.5, far);
        assert!((received - sent).abs() < 1e-5 * sent, "{received} {sent}");
    }
}
