//! The ball: isotropic scattering in a radially symmetric medium, by Peierls' integral equation.
//!
//! ```text
//! J(r) = ½ ∫₋₁¹ I(r, ν) dν,   I(r, ν) = L e^{−τ(0, s)} + ∫₀ˢ σ_t a J e^{−τ(0, t)} dt
//! ```
//!
//! J is the mean intensity, `I(r, ν)` the radiance that arrives at a point at the distance r from the centre, seen
//! in a direction of the cosine ν with the outward one. The line of sight ends after the length s, at the surface
//! or at a black sphere, where the radiance is L. J is a polynomial of `r²` in each of many shells ([`shells`]).
//! The equation is satisfied at their Gauss nodes, with the integrals along lines of sight cut at the shells'
//! surfaces ([`ball`]) and graded over directions ([`views`]). Any answer is computed three times, with fewer nodes
//! and a coarser grading the second and the third time, and the differences give its error: two may agree by
//! accident.
//!
//! By reciprocity, a particle that starts at a point in a uniformly distributed direction escapes with the
//! probability `J(r)` under an environment of radiance 1. Seen from the centre a distant light looks like an
//! environment of the same fluence, from other places it does not.
//!
//! Source: R. Peierls, *Critical conditions in neutron multiplication*, Mathematical Proceedings of the
//! Cambridge Philosophical Society 35 (1939); G. I. Bell, S. Glasstone, *Nuclear Reactor Theory* (Van
//! Nostrand Reinhold, 1970), section 1.2.

pub mod ball;
pub mod predict;
pub mod shells;
pub mod spread;
pub mod views;

use numeric::Known;
use numeric::matrix::Matrix;

use ball::Ball;
use shells::{BallResolution, Centre, FunctionalRow, GaussRules, Shells};
use spread::VertexBound;

pub use spread::{Spread, Spreads, Techniques};

/// The radiances at the ends of lines of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lights {
    /// Radiance of the environment of the ball.
    pub environment: f64,
    /// Radiance of the black sphere at the centre.
    pub core: f64,
}

/// Observable quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observable {
    /// The mean intensity at a distance from the centre.
    Mean(f64),
    /// The radiance that arrives along a line of sight.
    Radiance {
        /// Distance of the line from the centre.
        offset: f64,
        /// Begin of the line of sight, from its foot; −∞ for a begin outside the ball.
        from: f64,
    },
}

/// A ball in which the equation of one albedo and one light is solved.
pub struct SolvedBall<'a> {
    ball: &'a Ball<'a>,
    lights: Lights,
    resolution: BallResolution,
    shells: Shells,
    rules: GaussRules,
    albedo: f64,
    /// `r²` of the nodes.
    nodes: Vec<f64>,
    /// Contributions of `aJ` at the nodes to `aJ` at the nodes.
    matrix: Matrix,
    /// Unscattered light at the nodes, `J₀`.
    direct: Vec<f64>,
    /// `aJ` at the nodes.
    source: Vec<f64>,
}

/// Light that arrives unscattered, and the weights of aJ at the nodes in the light that is scattered.
type Arriving = (f64, Vec<f64>);

fn product(weights: &[f64], values: &[f64]) -> f64 {
    weights.iter().zip(values).map(|(w, x)| w * x).sum()
}

impl<'a> SolvedBall<'a> {
    /// Solves the equation; `None` where the medium is invalid: σ_t or a negative, or a above 1.
    pub fn new(
        ball: &'a Ball<'a>,
        albedo: f64,
        lights: Lights,
        resolution: BallResolution,
    ) -> Option<Self> {
        let shells = Shells::new(ball.radius, ball.centre, ball.extinction, resolution);
        let rules = GaussRules::new(resolution.nodes + 8);
        let nodes = shells.nodes(&rules);
        let (direct, source) = (Vec::new(), Vec::new());
        let matrix = Matrix::new(1, 1, |_, _| 0.0);
        let mut solved =
            Self { ball, lights, resolution, shells, rules, albedo, nodes, matrix, direct, source };
        let rows: Vec<Arriving> =
            solved.nodes.iter().map(|r2| solved.mean_row(r2.sqrt())).collect();
        let count = rows.len();
        solved.matrix = Matrix::new(count, count, |i, j| albedo * rows[i].1[j]);
        solved.direct = rows.into_iter().map(|row| row.0).collect();
        solved.source = solved.gathered(&solved.direct)?;
        Some(solved)
    }

    /// Total of scores g at each scattering, a function of the place given at the nodes: `aY` of `Y = g + K aY`.
    fn gathered(&self, score: &[f64]) -> Option<Vec<f64>> {
        let scattered: Vec<f64> = score.iter().map(|g| self.albedo * g).collect();
        self.matrix.series(&scattered).filter(|result| result.iter().all(|x| x.is_finite()))
    }

    /// Adds the light along one line of sight to a row; returns the unscattered part.
    fn view(&self, offset2: f64, from: f64, weight: f64, row: &mut FunctionalRow) -> f64 {
        let chord = self.ball.chord(offset2, from);
        let left = self.ball.collect(&chord, &self.shells, &self.rules, weight, row);
        weight * left * if chord.hits { self.lights.core } else { self.lights.environment }
    }

    fn mean_row(&self, r: f64) -> Arriving {
        let mut row = FunctionalRow::new(self.shells.count);
        let ball = self.ball;
        let views = views::from_point(r, ball.radius, ball.centre, self.resolution, &self.rules);
        let direct: f64 = views
            .iter()
            .map(|view| self.view(view.offset2, view.from, view.weight, &mut row))
            .sum();
        (direct, row.weights(&self.shells, &self.rules))
    }

    fn arriving(&self, observable: Observable) -> Arriving {
        match observable {
            Observable::Mean(r) => self.mean_row(r),
            Observable::Radiance { offset, from } => {
                let mut row = FunctionalRow::new(self.shells.count);
                let direct = self.view(offset * offset, from, 1.0, &mut row);
                (direct, row.weights(&self.shells, &self.rules))
            }
        }
    }

    /// Value of an observable.
    pub fn answer(&self, observable: Observable) -> f64 {
        let (direct, weights) = self.arriving(observable);
        direct + product(&weights, &self.source)
    }

    /// Bounds on the second moments of techniques, see [`spread`].
    fn spreads(&self, observable: Observable, is_distant: bool) -> Option<Spreads> {
        let share = |r2: f64| match self.ball.centre {
            Centre::Black(core) => 0.5 * (1.0 - (1.0 - core * core / r2).max(0.0).sqrt()),
            Centre::Medium => 1.0,
        };
        let largest = if matches!(self.ball.centre, Centre::Black(_)) { 0.5 } else { 1.0 };
        let scores = |r2: f64, direct: f64, all: f64| -> Vec<f64> {
            let all = all.max(direct);
            let at = VertexBound { share: share(r2), largest, direct, all };
            let each = Techniques::ALL.into_iter();
            if is_distant {
                // Seen from one place it is visible or not; on average as often as a uniform environment.
                return each.flat_map(|_| [direct, 2.0 * (all - direct)]).collect();
            }
            each.flat_map(|techniques| techniques.scores(&at)).collect()
        };
        let scattered = self.matrix.applied(&self.source);
        let nodes = self.nodes.iter().zip(&self.direct).zip(&scattered);
        let mut scored = Vec::new();
        for ((&r2, &direct), &more) in nodes {
            // The matrix has the albedo in it.
            let all = if self.albedo > 0.0 { direct + more / self.albedo } else { direct };
            scored.extend(scores(r2, direct, all).iter().map(|score| self.albedo * score));
        }
        let columns = 2 * Techniques::ALL.len();
        let scored = Matrix::new(self.nodes.len(), columns, |i, j| scored[i * columns + j]);
        let gathered = self.matrix.series_times(&scored)?;
        let (direct, weights) = self.arriving(observable);
        let mut sums = vec![0.0; columns];
        for (i, weight) in weights.iter().enumerate() {
            sums.iter_mut().zip(gathered.row(i)).for_each(|(sum, x)| *sum += weight * x);
        }
        let mut unscattered = direct;
        if let Observable::Mean(r) = observable {
            // The place is a vertex.
            let all = direct + product(&weights, &self.source);
            sums.iter_mut().zip(scores(r * r, direct, all)).for_each(|(sum, x)| *sum += x);
            unscattered = 0.0;
        }
        let spread = |i: usize| Spread { unscattered, lit: sums[2 * i], rest: sums[2 * i + 1] };
        let is_finite = sums.iter().all(|sum| sum.is_finite());
        is_finite.then(|| Spreads(std::array::from_fn(spread)))
    }
}

/// The equation, solved three times; `None` where the medium of the ball is invalid.
fn solved<'a>(
    ball: &'a Ball<'a>,
    albedo: f64,
    lights: Lights,
    resolution: BallResolution,
) -> Option<[SolvedBall<'a>; 3]> {
    let solve = |resolution| SolvedBall::new(ball, albedo, lights, resolution);
    let [fine, coarse, coarsest] = resolution.all().map(solve);
    Some([fine?, coarse?, coarsest?])
}

/// Values of several observables of one ball, with their errors; `None` where its medium is invalid.
pub fn answers(
    ball: &Ball,
    albedo: f64,
    lights: Lights,
    resolution: BallResolution,
    observable: &[Observable],
) -> Option<Vec<Known>> {
    let resolution = resolution.about(ball.centre, ball.radius);
    let solved = solved(ball, albedo, lights, resolution)?;
    let known = |&observable: &Observable| {
        resolution.known(solved.each_ref().map(|s| s.answer(observable)))
    };
    Some(observable.iter().map(known).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SKY: Lights = Lights { environment: 1.0, core: 0.0 };

    #[test]
    fn the_square_of_what_a_thin_ball_scatters_is_a_hand_value() {
        // One scattering at most, h = 1 almost surely: X = 1 unscattered or scattered, never both.
        let ball = Ball { radius: 1.0, centre: Centre::Medium, extinction: &|_| 1e-6 };
        let solved = SolvedBall::new(&ball, 1.0, SKY, BallResolution::COARSE).expect("a medium");
        let through = Observable::Radiance { offset: 0.0, from: f64::NEG_INFINITY };
        let spreads = solved.spreads(through, false).expect("finite");
        let spread = spreads.of(Techniques::NextEvent);
        assert!((spread.square(1.0) - 1.0).abs() < 1e-10, "{spread:?}");
        assert!((spread.lit - 2e-6).abs() < 1e-11 && spread.rest < 1e-11);
    }
}
