//! A point source at the centre of a ball, order by order of scattering.
//!
//! ```text
//! J₀(r) = P e^{−τ(0, r)}/(4πr)²,   Jₙ = K a Jₙ₋₁,   radiance of order n: ∫ σ_t a Jₙ₋₁ e^{−τ} dt
//! ```
//!
//! K is the operator of [`super`]. `J₀` is integrated as a function: no polynomial approximates `1/r²` up to the
//! centre. `J₁`, which goes like `1/r`, and all others are polynomials of `r²` in shells that are halved towards
//! the centre.

use std::f64::consts::PI;

use super::ball::{Ball, Chord};
use super::shells::{Centre, Resolution, Row, Rules};
use super::{Lights, Solved, product};
use numeric::Known;

/// The radiance of light that was scattered once, twice, …, and in all, along each line of sight that passes the
/// centre at a distance.
fn radiances(
    ball: &Ball,
    albedo: f64,
    offsets: &[f64],
    orders: usize,
    resolution: Resolution,
) -> Option<Vec<Vec<f64>>> {
    let ball = &Ball { centre: Centre::Point, ..*ball };
    let dark = Lights { environment: 0.0, core: 0.0 };
    let solved = Solved::new(ball, albedo, dark, resolution)?;
    let of = |offset: &f64| {
        let chord = ball.chord(offset * offset, f64::NEG_INFINITY);
        let mut row = Row::new(solved.shells.count);
        ball.collect(&chord, &solved.shells, &solved.rules, albedo, &mut row);
        let weights = row.weights(&solved.shells, &solved.rules);
        let through = |j: &[f64]| product(&weights, j);
        let single = albedo * unscattered(ball, &chord, resolution, &solved.rules);
        let mut found = vec![single];
        let mut intensity: Vec<f64> = solved.direct.iter().map(|direct| albedo * direct).collect();
        for _ in 1..orders {
            found.push(through(&intensity));
            intensity = solved.matrix.applied(&intensity);
        }
        found.push(single + through(&solved.source));
        found
    };
    Some(offsets.iter().map(of).collect())
}

/// `∫ σ_t J₀ e^{−τ} dt` along a line of sight that does not pass through the centre, for a source of power 1.
pub(super) fn unscattered(
    ball: &Ball,
    chord: &Chord,
    resolution: Resolution,
    rules: &Rules,
) -> f64 {
    let offset = chord.offset2.sqrt();
    // Panels are chosen by the distance from the centre.
    let mut edges = vec![0.0];
    let mut edge = 0.5 * offset;
    while edge < 2.0 * ball.radius {
        edges.push(edge);
        edge *= 2.0;
    }
    edges.push(2.0 * ball.radius);
    let inwards = edges.windows(2).rev().map(|edge| (-edge[1], -edge[0]));
    let outwards = edges.windows(2).map(|edge| (edge[0], edge[1]));
    let radial = rules.of(resolution.nodes);
    let (mut sum, mut depth) = (0.0, 0.0);
    for (from, to) in inwards.chain(outwards) {
        let (from, to) = (from.max(chord.from), to.min(chord.to));
        if from < to {
            let part = Chord { from, to, ..*chord };
            let rule = rules.of(resolution.nodes + 4);
            ball.panel(&part, rule, &mut depth, |places, shares| {
                for (r2, share) in places.iter().zip(shares) {
                    let depth = radial.integrate(0.0, r2.sqrt(), |r| (ball.extinction)(r * r));
                    sum += *share * (-depth).exp() / (16.0 * PI * PI * r2);
                }
            });
        }
    }
    sum
}

/// The radiance of a point source of power 1 at the centre along lines of sight: after one scattering, after two,
/// …, and in all, with their errors. `distances` of the lines from the centre are above 0. `None` where the ball's
/// medium is invalid, or does not extend to its centre.
pub fn orders(
    ball: &Ball,
    albedo: f64,
    offsets: &[f64],
    orders: usize,
    resolution: Resolution,
) -> Option<Vec<Vec<Known>>> {
    if ball.centre != Centre::Medium || offsets.iter().any(|&offset| offset <= 0.0) {
        return None;
    }
    let solve = |resolution| radiances(ball, albedo, offsets, orders, resolution);
    let [fine, coarse, coarsest] = resolution.all().map(solve);
    let all = [fine?, coarse?, coarsest?];
    let known = |ray: usize, order: usize| {
        let found = resolution.known(all.each_ref().map(|a| a[ray][order]));
        // Next to the source all three may have similar errors: measured.
        let near = (ball.radius / offsets[ray]).powi(2);
        found.blurred(resolution.chance * near * found.value.abs())
    };
    let of_ray = |ray: usize| (0..all[0][ray].len()).map(|order| known(ray, order)).collect();
    Some((0..offsets.len()).map(of_ray).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_scattering_in_a_thin_ball_is_a_hand_value() {
        // σ → 0: ∫ σ a dt/(16π²(p² + t²)) = (σa/16π²) (2/p) arctan(h/p), h half the chord.
        let ball = Ball { radius: 1.0, centre: Centre::Medium, extinction: &|_| 1e-9 };
        let found = orders(&ball, 0.5, &[0.6], 2, Resolution::COARSE).expect("a medium");
        let exact = 0.5e-9 / (16.0 * PI * PI) * (2.0 / 0.6) * (0.8f64 / 0.6).atan();
        assert!((found[0][0].value - exact).abs() < 1e-7 * exact);
        assert!(found[0][1].value < 1e-8 * exact);
        assert!(orders(&ball, 0.5, &[0.0], 2, Resolution::COARSE).is_none());
    }
}
