//! The analytic medium of Szirmay-Kalos et al. 2017, Eq. 21, in its sphere.
//!
//! ```text
//! σ_t(x, y, z) = ((cos(1.5(x + y + z)) + 1)/2)⁵ · (sin(z/2) + 2)/3   within the sphere
//! ```
//!
//! The sphere has its centre at (0, 0, 10) and the radius 10. This is a benchmark: 3-D only, and
//! without settings, `volume.eq21 = {}`. Its largest extinction is 1 per length.
//!
//! Lookups use `((1 + cos u)/2)⁵ = cos¹⁰(u/2)` and `(2 + sin v)/3 = (1 + 2 cos²(v/2 − π/4))/3`,
//! products of squares that cost two cosines without their signs, of angles in half turns. The optical depth is a Fourier sum of 17 terms,
//! with u = 1.5(x + y + z), v = z/2 and c = (252, 420, 240, 90, 20, 2)/1024,
//!
//! ```text
//! σ_t = Σₖ ⅔cₖ cos ku + ⅓c₀ sin v + Σₖ≥₁ ⅙cₖ [sin(v + ku) + sin(v − ku)]
//! ∫ cos(φ + ωs) ds = L cos(φ_middle) · sinc(ωL/2)
//! ```
//!
//! where the sines and cosines of multiples are products of those of u and ωL/2. Its error is that of the
//! arguments, below 1.2e-15 for rays from near the sphere; the bound grows with the distance of the
//! origin. The free flight is a bracketed root.
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36(2),
//! 2017, Eq. 21.
//!
//! ```toml
//! title = "An example of eq21"
//!
//! [problem.transmittance]
//! volume.eq21 = {}
//! ray = { origin = [11, 0, 0], direction = [0, 0, 1], length = 20 }
//! sampling = 1
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};
use std::sync::Arc;

use super::sines::{highest_sine, sinc};
use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span, sum::Sum};

/// The medium in its sphere.
pub struct Eq21;

/// `cos¹⁰(u/2) = Σ cₖ cos ku`.
const FOURIER: [f64; 6] = [252.0, 420.0, 240.0, 90.0, 20.0, 2.0];
const FOURIER_UNIT: f64 = 1.0 / 1024.0;

/// The normal of the planes of equal `u`.
const U: Point = Point([1.5, 1.5, 1.5]);
/// The normal of the planes of equal `v`.
const V: Point = Point([0.0, 0.0, 0.5]);

/// The medium along a ray: both arguments are straight lines, `u = u₀ + u₁t` and `v = v₀ + v₁t`.
pub struct Eq21Ray {
    u: (f64, f64),
    v: (f64, f64),
    /// `u/2π` and `v/2π − 1/4`, the half angles in half turns.
    half_u: (f64, f64),
    turned_v: (f64, f64),
}

/// `σ_t` from `u/2π` and `v/2π − 1/4`, in half turns.
#[inline(always)]
fn shape<L: Lane>(half_u: L, turned_v: L) -> L {
    let (a, b) = (half_u.cos_pi_size(), turned_v.cos_pi_size());
    let squared = a * a;
    let fourth = squared * squared;
    let slow = (b * b).times_plus(b.each(2.0 / 3.0), b.each(1.0 / 3.0));
    (fourth * fourth) * (squared * slow)
}

/// Factor from an angle to its half in half turns.
const HALF_TURNS: f64 = 0.5 * FRAC_1_PI;

impl Extinction for Eq21Ray {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        let (u, v) = (self.half_u, self.turned_v);
        shape(t.times_plus(t.each(u.1), t.each(u.0)), t.times_plus(t.each(v.1), t.each(v.0)))
    }

    fn facts(&self) -> Facts<'_> {
        Facts { panel_nodes: Some(16), ..Facts::default() }
    }
}

/// Cosine and sine of an angle; those of its multiples are products.
#[derive(Clone, Copy)]
struct Turn {
    cos: f64,
    sin: f64,
}

impl Turn {
    const NONE: Self = Self { cos: 1.0, sin: 0.0 };

    fn by(angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { cos, sin }
    }

    /// The sum of both angles.
    fn and(self, more: Self) -> Self {
        let cos = self.cos * more.cos - self.sin * more.sin;
        Self { cos, sin: self.cos * more.sin + self.sin * more.cos }
    }

    /// The difference of both angles.
    fn less(self, other: Self) -> Self {
        self.and(Self { sin: -other.sin, ..other })
    }

    /// `sin x / x`, x the angle; near 0 the sine of a difference is not accurate enough.
    fn sinc(self, angle: f64) -> f64 {
        if angle.abs() < 1.0 { sinc(angle) } else { self.sin / angle }
    }
}

impl OpticalDepth for Eq21Ray {
    fn optical_depth(&self, span: Span) -> Known {
        let (length, middle) = (span.length(), span.middle());
        let (u, v) = (self.u.0 + self.u.1 * middle, self.v.0 + self.v.1 * middle);
        let (across_u, across_v) = (0.5 * self.u.1 * length, 0.5 * self.v.1 * length);
        let [by_u, by_v, by_across_u, by_across_v] = [u, v, across_u, across_v].map(Turn::by);
        let (mut by_ku, mut by_k_across) = (Turn::NONE, Turn::NONE);
        let mut mean = Sum::default();
        for (c, k) in FOURIER.iter().zip([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]) {
            let c = c * FOURIER_UNIT;
            mean.add(c * 2.0 / 3.0 * by_ku.cos * by_k_across.sinc(k * across_u));
            let both = by_across_v.and(by_k_across).sinc(across_v + k * across_u);
            let sums = by_v.and(by_ku).sin * both;
            let between = by_across_v.less(by_k_across).sinc(across_v - k * across_u);
            let differences = by_v.less(by_ku).sin * between;
            mean.add(c / 6.0 * (sums + differences));
            (by_ku, by_k_across) = (by_ku.and(by_u), by_k_across.and(by_across_u));
        }
        // |∂σ/∂u| ≤ 1.1 and |∂σ/∂v| ≤ ⅓ turn errors of the arguments into errors of the mean.
        let u_size = self.u.0.abs() + (self.u.1 * middle).abs();
        let v_size = self.v.0.abs() + (self.v.1 * middle).abs();
        let error = length * f64::EPSILON * (4.0 + 2.0 * u_size + v_size);
        Known::new(length * mean.value(), error)
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        // Half a unit of length turns the fastest term of σ_t², cos 10u, by 13 radians at most.
        span.even_cuts((2.0 * span.length()).ceil())
    }
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::new(&[]).volume(|_| Some(Eq21))
}

impl Field for Eq21 {
    fn bounds(&self) -> Bounds {
        Bounds::Sphere { centre: Point([0.0, 0.0, 10.0]), radius: 10.0 }
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        shape(U.along(p) * HALF_TURNS, V.along(p) * HALF_TURNS - 0.25)
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        let (u, v) = (within.reach(U), within.reach(V));
        let cosine = highest_sine(Span::new(u.from + FRAC_PI_2, u.to + FRAC_PI_2));
        let highest = (0.5 * (1.0 + cosine)).powi(5) * (highest_sine(v) + 2.0) / 3.0;
        // The arguments of the lookups are rounded, too; their squares never exceed 1.
        (highest + 1e-13).min(1.0)
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let [u, v] = [U, V].map(|normal| (ray.origin.dot(normal), ray.direction.dot(normal)));
        let half_u = (u.0 * HALF_TURNS, u.1 * HALF_TURNS);
        let turned_v = (v.0 * HALF_TURNS - 0.25, v.1 * HALF_TURNS);
        Arc::new(Eq21Ray { u, v, half_u, turned_v })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_between_the_crests_has_a_low_majorant() {
        // u/1.5 from 1.5 to 2.7 holds the trough at 2.09 and no crest.
        let within = Aabb { low: Point([0.0, 0.0, 1.5]), high: Point([0.0, 0.0, 2.7]) };
        let highest = Eq21.majorant(&within);
        assert!(highest < 0.02 && highest >= Eq21.value([0.0, 0.0, 1.5]));
    }
}
