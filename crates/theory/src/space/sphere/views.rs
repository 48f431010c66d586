//! Lines of sight from a point of a ball, each with its weight: `½∫₋₁¹ I dν`.
//!
//! ν is the cosine with the direction away from the centre. The radiance changes its character where the point
//! looks along the surface, `|ν| ≲ √(R² − r²)/r`, and along the edge of a black sphere; panels are
//! graded towards these. Rays that end on a black sphere are parametrised by `q = √(ρ² − p²)`,
//! in which their lengths are smooth, and rays that pass the centre by p.

use super::shells::{BallResolution, Centre, GaussRules, halved};
use numeric::Span;

/// A line of sight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineOfSight {
    /// The square of its distance from the centre, p².
    pub offset2: f64,
    /// Begin, from its foot: `rν`.
    pub from: f64,
    /// Share of `½∫ dν`.
    pub weight: f64,
}

/// `0, scale, 2 scale, 4 scale, …, end`.
fn doubling(scale: f64, end: f64) -> Vec<f64> {
    let mut edges = vec![0.0];
    let mut edge = scale;
    while edge < 0.75 * end {
        edges.push(edge);
        edge *= 2.0;
    }
    edges.push(end);
    edges
}

/// All views from a point at the distance r from the centre, `0 ≤ r ≤ R`.
pub fn from_point(
    r: f64,
    radius: f64,
    centre: Centre,
    resolution: BallResolution,
    rules: &GaussRules,
) -> Vec<LineOfSight> {
    if r <= 0.0 {
        return vec![LineOfSight { offset2: 0.0, from: 0.0, weight: 1.0 }];
    }
    let mut views = Vec::new();
    let rule = rules.of(resolution.directions);
    let mut on = |edges: &[f64], view: &dyn Fn(f64, f64) -> LineOfSight| {
        let nodes = Span::between(edges).flat_map(|span| rule.on(span));
        views.extend(nodes.map(|(at, weight)| view(at, weight)));
    };
    let r2 = r * r;
    let of_t = |t: f64, dt: f64| LineOfSight {
        offset2: (r2 - t * t).max(0.0),
        from: t,
        weight: 0.5 * dt / r,
    };
    let along = ((radius - r) * (radius + r)).max(0.0).sqrt().max(1e-9 * radius);
    // No panel is wider than a quarter of the range of ν.
    let surface = along.min(0.5 * r);
    on(&doubling(surface, r), &of_t);
    let mirrored = |t: f64, dt: f64| of_t(-t, dt);
    match centre {
        Centre::Medium => on(&doubling(surface, r), &mirrored),
        Centre::Black(core) => {
            let gap = ((r - core) * (r + core)).max(0.0).sqrt();
            // From the surface's directions to the middle, and on to the edge of the black sphere.
            let half = 0.5 * gap;
            on(&doubling(along.min(half), half), &mirrored);
            let finest = half * halved(resolution.core / 2);
            let from_edge = |x: f64, dx: f64| {
                let offset2 = core * core + x * (2.0 * gap - x);
                LineOfSight { offset2, from: -(gap - x), weight: 0.5 * dx / r }
            };
            on(&doubling(finest, half), &from_edge);
            let onto = |q: f64, dq: f64| {
                let from = (gap * gap + q * q).sqrt();
                LineOfSight {
                    offset2: core * core - q * q,
                    from: -from,
                    weight: 0.5 * q * dq / (r * from),
                }
            };
            let finest = gap.min(core) * halved(resolution.core / 4);
            on(&doubling(finest.max(1e-9 * core), core), &onto);
        }
    }
    views
}
