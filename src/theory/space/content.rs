//! What a body holds: `∫σ_t dV`, by chords whose optical depths are exact.
//!
//! ```text
//! ball of radius R:  ∫₀^{2π} ∫₀^{π/2} τ(R sin θ, φ) R² sin θ cos θ dθ dφ,   half a chord is R cos θ
//! box:               ∫∫ τ(x, y) dx dy in n × n panels of 4 × 4 Gauss nodes
//! ```
//!
//! Chords run along z. For fields without kinks the first converges faster than any power of the number of
//! chords, and the second is exact where panels are cells of the field. Resolutions are doubled until two
//! agree twice or the chords become too many; their last differences are the error.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::geometry::{Aabb, Bounds, Point, Ray};
use crate::media::{Medium, Volume};
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::sum::Sum;
use crate::numeric::{Known, Span};

/// Two resolutions that agree so well need no third, relative to the whole.
const AGREED: f64 = 1e-13;
/// The most chords of one resolution.
const MOST_CHORDS: f64 = 3e5;
/// The most pieces that all chords of one resolution may have: those of noise are many.
const MOST_PIECES: f64 = 6e5;

/// `∫σ_t dV` over a volume; `None` for one without bounds.
#[must_use]
pub fn content(volume: &Volume) -> Option<Known> {
    let within = volume.bounds().enclosing_box()?;
    let height = within.high.0[2] - within.low.0[2];
    let chords = MOST_CHORDS.min(MOST_PIECES / (1.0 + volume.pieces(height)));
    let at = |n: usize| match volume.bounds() {
        Bounds::Sphere { centre, radius } => ball(volume, &within, centre, radius, n),
        Bounds::Box(_) | Bounds::Everywhere => cuboid(volume, &within, n),
    };
    // A resolution of n takes 32n² or 16n² chords.
    let mut n = 2;
    let mut before = at(1);
    let mut steps = Vec::new();
    loop {
        let here = at(n);
        steps.push((here - before).abs());
        // Twice, since one may be chance.
        let agree = |step: &f64| here > 0.0 && *step <= AGREED * here;
        let is_there = steps.len() >= 2 && steps.iter().rev().take(2).all(agree);
        if is_there || 128.0 * (n * n) as f64 > chords {
            let error = if is_there { steps[steps.len() - 1] } else { settled(&steps) };
            return Some(Known::new(here, error + 4.0 * f64::EPSILON * here));
        }
        (n, before) = (2 * n, here);
    }
}

/// What a sequence of resolutions is still off, by its last steps: the last one where it settles fast,
/// four times that where it settles slowly. Elsewhere, as in fields that jump across chords, two
/// resolutions may be alike by chance, and the largest of three steps says more.
fn settled(steps: &[f64]) -> f64 {
    let last = &steps[steps.len().saturating_sub(3)..];
    let shrinks =
        |factor: f64| last.len() == 3 && last.windows(2).all(|two| factor * two[1] <= two[0]);
    if shrinks(16.0) {
        last[2]
    } else if shrinks(4.0) {
        4.0 * last[2]
    } else {
        4.0 * last.iter().copied().fold(0.0, f64::max)
    }
}

fn depth(volume: &Volume, within: &Aabb, x: f64, y: f64) -> f64 {
    let origin = Point([x, y, within.low.0[2]]);
    let length = within.high.0[2] - within.low.0[2];
    let ray = Ray { origin, direction: Point([0.0, 0.0, 1.0]), length };
    let inside = volume.bounds().clip(&ray);
    if inside.is_empty() {
        return 0.0;
    }
    let profile = std::sync::Arc::new(volume.along(&ray, inside));
    Medium::new(profile, ray.span(), inside).optical_depth(inside).value
}

fn ball(volume: &Volume, within: &Aabb, centre: Point, radius: f64, n: usize) -> f64 {
    let (panels, turns) = ((n / 4).max(1), 8 * n);
    let rule = GaussLegendre::new(16);
    let width = FRAC_PI_2 / panels as f64;
    let ring = |tilt: f64| {
        let across = radius * tilt.sin();
        let mut around = Sum::default();
        for turn in 0..turns {
            // Half a step on, so that no chord runs through a plane of symmetry.
            let angle = TAU * (turn as f64 + 0.5) / turns as f64;
            let [x, y, _] = centre.0;
            let (x, y) = (x + across * angle.cos(), y + across * angle.sin());
            around.add(depth(volume, within, x, y));
        }
        TAU / turns as f64 * around.value() * across * radius * tilt.cos()
    };
    let ends = (0..panels).map(|i| (width * i as f64, width * (i + 1) as f64));
    ends.map(|(from, to)| rule.integrate(from, to, ring)).sum()
}

fn cuboid(volume: &Volume, within: &Aabb, n: usize) -> f64 {
    let rule = GaussLegendre::new(4);
    let panels = |axis: usize| {
        let (low, high) = (within.low.0[axis], within.high.0[axis]);
        let end = move |i: usize| low + (high - low) * i as f64 / n as f64;
        (0..n).map(move |i| Span::new(end(i), end(i + 1)))
    };
    let mut sum = Sum::default();
    for column in panels(0) {
        for row in panels(1) {
            sum.add(rule.integrate(column.from, column.to, |x| {
                rule.integrate(row.from, row.to, |y| depth(volume, within, x, y))
            }));
        }
    }
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::eq21::Eq21;

    #[test]
    fn the_sphere_of_equation_21_holds_what_it_holds() {
        // By 30-digit arithmetic over its Fourier sum.
        let known = content(&Volume::Eq21(Eq21)).expect("bounded");
        let off = (known.value - 709.156_283_921_427).abs();
        assert!(off < 1e-10 && off <= known.error + 1e-12, "{known:?}");
    }
}
