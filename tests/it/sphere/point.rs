//! A point source at the centre of a ball, order by order of scattering, by the integrals that solve other lights.
//!
//! ```text
//! J₀(r) = P e^{−τ(0, r)}/(4πr)²,   Jₙ = K a Jₙ₋₁,   radiance of order n: ∫ σ_t a Jₙ₋₁ e^{−τ} dt
//! ```
//!
//! K is the operator of Peierls' equation. `J₀` is integrated as a function: no polynomial approximates `1/r²` up to
//! the centre. `J₁`, which goes like `1/r`, and all others are polynomials of `r²` in shells that are halved towards
//! the centre and the surface. The medium is `σ_t = c₀ − c₁ r²`.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use trueflight::numeric::Span;
use trueflight::numeric::matrix::Matrix;
use trueflight::numeric::quadrature::GaussLegendre;
use trueflight::theory::space::sphere::ball::{Ball, Chord};
use trueflight::theory::space::sphere::shells::{Centre, FunctionalRow, GaussRules, Shell, Shells};

use super::{RADIUS, Reference, references};

/// Nodes of a shell that is not near the centre or the surface, and between two edges of directions.
const NODES: usize = 12;
/// Halvings of shells towards the centre and towards the surface, and of directions towards the centre.
const HALVINGS: [usize; 3] = [30, 15, 15];

/// Coefficients `c₀` and `c₁`.
type Medium = [f64; 2];

/// `0, scale, 2 scale, 4 scale, …, end`.
fn doubling(scale: f64, end: f64) -> Vec<f64> {
    let edges = std::iter::successors(Some(scale), |edge| Some(2.0 * edge));
    let edges = edges.take_while(|&edge| edge < 0.75 * end);
    std::iter::once(0.0).chain(edges).chain([end]).collect()
}

/// Optical depth from the foot of a line of sight, at the squared distance `offset2` from the centre, to the distance t.
fn depth([c0, c1]: Medium, offset2: f64, t: f64) -> f64 {
    t * (c0 - c1 * (offset2 + t * t / 3.0))
}

/// Shells that are thin compared with a mean free path; those next to the ends have the fewest nodes.
fn shells() -> Shells {
    let (outer, [inwards, outwards, _]) = (RADIUS * RADIUS, HALVINGS);
    let part = |level: usize| 0.5 * outer * 0.5f64.powi(i32::try_from(level).expect("small"));
    let edges = std::iter::once(0.0)
        .chain((0..=inwards).rev().map(part))
        .chain((1..=outwards).map(|level| outer - part(level)))
        .chain([outer]);
    let edges: Vec<f64> = edges.collect();
    let nodes = |shell: usize| match shell.checked_sub(inwards + 1) {
        Some(level) => NODES - 2 * level / 3,
        None => NODES - (inwards - shell.min(inwards)) / 3,
    };
    let mut found = Shells { shells: Vec::new(), count: 0 };
    for (shell, span) in Span::between(&edges).enumerate() {
        let (nodes, first) = (nodes(shell).max(4), found.count);
        found.shells.push(Shell { from: span.from, to: span.to, nodes, first });
        found.count += nodes;
    }
    found
}

/// `∫ σ_t J₀ e^{−τ} dt` along a line of sight that does not pass through the centre, for a source of power 1.
fn unscattered(medium: Medium, chord: &Chord) -> f64 {
    let rule = GaussLegendre::new(NODES + 4);
    let Chord { offset2, from, to, .. } = *chord;
    let edges = doubling(0.5 * offset2.sqrt(), 4.0 * RADIUS);
    let all: Vec<f64> = edges.iter().rev().map(|edge| -edge).chain(edges[1..].to_vec()).collect();
    let score = |t: f64| {
        let r2 = offset2 + t * t;
        let passed = depth(medium, offset2, t) - depth(medium, offset2, from);
        let emitted = depth(medium, 0.0, r2.sqrt());
        (medium[0] - medium[1] * r2) * (-passed - emitted).exp() / (16.0 * PI * PI * r2)
    };
    let parts = Span::between(&all).map(|span| span.intersect(Span::new(from, to)));
    parts
        .filter(|part| !part.is_empty())
        .map(|part| rule.integrate(part.from, part.to, score))
        .sum()
}

/// Lines of sight from a point at the distance r from the centre: squared offset, begin from the foot, and share.
fn views(r: f64, rule: &GaussLegendre) -> Vec<[f64; 3]> {
    let half = r * FRAC_1_SQRT_2;
    let along = ((RADIUS - r) * (RADIUS + r)).max(0.0).sqrt().max(1e-9 * RADIUS).min(0.5 * r);
    let nodes = |edges: &[f64]| -> Vec<(f64, f64)> {
        Span::between(edges).flat_map(|span| rule.on(span).collect::<Vec<_>>()).collect()
    };
    let away = nodes(&doubling(along, r)).into_iter();
    let away = away.map(|(t, dt)| [(r * r - t * t).max(0.0), t, 0.5 * dt / r]);
    let back = nodes(&doubling(along.min(half), half)).into_iter();
    let back = back.map(|(t, dt)| [r * r - t * t, -t, 0.5 * dt / r]);
    let finest = half * 0.5f64.powi(i32::try_from(HALVINGS[2]).expect("small"));
    let past = nodes(&doubling(finest, half)).into_iter().map(|(p, dp)| {
        let from = ((r - p) * (r + p)).sqrt();
        [p * p, -from, 0.5 * p * dp / (r * from)]
    });
    away.chain(back).chain(past).collect()
}

/// Radiance of light that was scattered once, twice and three times, and in all, along lines of sight at distances from
/// the centre.
fn radiances(medium: Medium, albedo: f64, offsets: &[f64]) -> Vec<Vec<f64>> {
    let extinction = |r2: f64| medium[0] - medium[1] * r2;
    let ball = Ball { radius: RADIUS, centre: Centre::Medium, extinction: &extinction };
    let (shells, rules) = (shells(), GaussRules::new(NODES + 8));
    let collected = |views: &[[f64; 3]]| {
        let (mut row, mut direct) = (FunctionalRow::new(shells.count), 0.0);
        for &[offset2, from, weight] in views {
            let chord = ball.chord(offset2, from);
            ball.collect(&chord, &shells, &rules, weight, &mut row);
            direct += weight * unscattered(medium, &chord);
        }
        (direct, row.weights(&shells, &rules))
    };
    let nodes = shells.nodes(&rules).into_iter();
    let rows: Vec<(f64, Vec<f64>)> =
        nodes.map(|r2| collected(&views(r2.sqrt(), rules.of(NODES)))).collect();
    let matrix = Matrix::new(rows.len(), rows.len(), |i, j| albedo * rows[i].1[j]);
    let first: Vec<f64> = rows.iter().map(|(direct, _)| albedo * direct).collect();
    let all = matrix.series(&first).expect("finite");
    let second = matrix.applied(&first);
    let of = |&offset: &f64| {
        let (direct, weights) = collected(&[[offset * offset, f64::NEG_INFINITY, 1.0]]);
        let scattered = |intensity: &[f64]| {
            albedo * weights.iter().zip(intensity).map(|(w, x)| w * x).sum::<f64>()
        };
        let once = albedo * direct;
        vec![once, scattered(&first), scattered(&second), once + scattered(&all)]
    };
    offsets.iter().map(of).collect()
}

#[test]
fn a_point_source_is_that_of_the_references_order_by_order() {
    for (ball, medium) in [("S1", [1.0, 0.0]), ("S2", [2.0, 2.0 / (RADIUS * RADIUS)])] {
        let mut references: Vec<Reference> = references("point");
        references.retain(|reference| reference.ball == ball);
        assert_eq!(references.len(), 3);
        let offsets: Vec<f64> = references.iter().map(|reference| reference.at[0]).collect();
        let found = radiances(medium, references[0].a, &offsets);
        for (found, reference) in found.iter().zip(&references) {
            assert_eq!(found.len(), reference.value.len());
            for (known, exact) in found.iter().zip(&reference.value) {
                let off = (known - exact).abs();
                assert!(off < 3e-12, "{ball}: off by {off:e}");
            }
        }
    }
}

#[test]
fn single_scattering_of_a_point_source_in_a_thin_ball_is_a_hand_value() {
    // σ → 0: ∫ σ dt/(16π²(p² + t²)) = (σ/16π²) (2/p) arctan(h/p), h half the chord.
    let half = (RADIUS * RADIUS - 0.36).sqrt();
    let chord = Chord { offset2: 0.36, from: -half, to: half, hits: false };
    let exact = 1e-9 / (16.0 * PI * PI) * (2.0 / 0.6) * (half / 0.6).atan();
    assert!((unscattered([1e-9, 0.0], &chord) - exact).abs() < 1e-7 * exact);
}
