//! A point source in a homogeneous medium without end, isotropic scattering.
//!
//! ```text
//! in units of 1/σ_t, c the albedo, κ the root of 1 = c artanh(κ)/κ:
//! φ(r) = κ²(1 − κ²)/(2π r c (c − 1 + κ²)) e^{−κ r} + 1/(4π r) ∫₀¹ g(ν) e^{−r/ν} dν/ν²
//! g(ν) = 1/((1 − c ν artanh ν)² + (π c ν/2)²)
//! collisions within R = ∫₀^R φ 4π r² dr
//!   = 2(1 − κ²)/(c (c − 1 + κ²)) (1 − (1 + κR) e^{−κR}) + ∫₀¹ g(ν) (1 − (1 + R/ν) e^{−R/ν}) dν
//! ```
//!
//! With ν = tanh y the integrands decay as cosh⁻²y and have no singularity; a trapezoidal or Gauss rule in
//! panels of y reaches rounding. Energy: R → ∞ leaves 1/(1 − c).
//!
//! Source: K. M. Case, P. F. Zweifel, *Linear Transport Theory* (Addison–Wesley, 1967), section 2.5 and
//! chapter 5; B. Davison, *Neutron Transport Theory* (Oxford, 1957), section 5.2.

use std::f64::consts::PI;

use numeric::quadrature::GaussLegendre;
use numeric::sum::Sum;
use numeric::{Known, roots};

/// End of y: beyond it the integrand is below rounding.
const FARTHEST: f64 = 22.0;
/// The width of the panels of y, but for the first: e^{−r/ν} rises where ν is about r.
const WIDTH: f64 = 0.25;
/// Ratio of the widths of adjacent panels below the full width, from the smallest on.
const GROWTH: f64 = 1.25;
const SMALLEST: f64 = 1e-12;
/// Minimum optical distance that the panels resolve.
const NEAREST: f64 = 1e-8;
/// The relative error of a sum over the panels, of closed forms, and of `c − (1 − κ²)` in units of `1/(1 − c)`.
pub const ROUNDING: f64 = 1e-14;
/// Below this albedo the pole is at κ = 1 to all digits, with a residue of 0.
const FAINT: f64 = 0.03;

/// The pole: κ, and `1 − κ²` with all its digits. For c in (0, 1).
fn pole(albedo: f64) -> (f64, f64) {
    // κ = tanh y with y coth y = 1/c, which lies between 1/c − 1 and 1/c or below √(3(1/c − 1)).
    let f = |y: f64| y / y.tanh() - 1.0 / albedo;
    let slope = |y: f64| 1.0 / y.tanh() - y / y.sinh().powi(2);
    let y = roots::rising(1e-9, 1.0 / albedo + 1.0, |y| (f(y), slope(y)));
    (y.tanh(), y.cosh().powi(-2))
}

/// `∫₀¹ g(ν) h(ν) dν`.
fn cut(albedo: f64, h: impl Fn(f64) -> f64) -> f64 {
    let rule = GaussLegendre::new(12);
    let mut sum = Sum::default();
    let (mut from, mut to) = (0.0, SMALLEST);
    while from < FARTHEST {
        sum.add(rule.integrate(from, to, |y: f64| {
            let nu = y.tanh();
            let [a, b] = [1.0 - albedo * nu * y, 0.5 * PI * albedo * nu];
            h(nu) * y.cosh().powi(-2) / (a * a + b * b)
        }));
        (from, to) = (to, (GROWTH * to).min(to + WIDTH));
    }
    sum.value()
}

/// `1 − (1 + x)e^{−x}`, by its series `Σ (−x)ᵏ (k − 1)/k!` where it cancels.
fn share(x: f64) -> f64 {
    if x >= 1.0 {
        return 1.0 - (1.0 + x) * (-x).exp();
    }
    let (mut sum, mut power) = (0.0, -x);
    for k in 2..=20 {
        let k = f64::from(k);
        power *= -x / k;
        sum += power * (k - 1.0);
    }
    sum
}

/// `∫₀¹ g(ν) h(ν) dν` plus the contribution of the pole: `discrete` returns the two factors beside
/// `1/(c(c − 1 + κ²))`.
fn both(albedo: f64, h: impl Fn(f64) -> f64, discrete: impl Fn(f64, f64) -> [f64; 2]) -> f64 {
    let scattered = cut(albedo, h);
    let settled = if albedo < FAINT {
        0.0
    } else {
        let (kappa, rest) = pole(albedo);
        let [weight, decay] = discrete(kappa, rest);
        weight / (albedo * (albedo - rest)) * decay
    };
    scattered + settled
}

/// A value with its relative error. Nearer than [`NEAREST`] the panels of ν are too wide for a function that rises
/// where ν is the distance.
fn known(value: f64, rounding: f64, albedo: f64, distance: f64) -> Known {
    let error = if distance < NEAREST { 1.0 } else { rounding / (1.0 - albedo) };
    Known::estimated(value, error * value)
}

/// The expected number of collisions within an optical distance of the source, for an albedo in `[0, 1)`.
pub fn collisions_within(albedo: f64, distance: f64) -> Known {
    let pole = |kappa: f64, rest: f64| [2.0 * rest, share(kappa * distance)];
    known(both(albedo, |nu| share(distance / nu), pole), ROUNDING, albedo, distance)
}

/// The fluence at an optical distance from a source of power 1, in units of `σ_t²`; for an albedo in
/// `[0, 1)`.
pub fn fluence(albedo: f64, distance: f64) -> Known {
    let decay = |nu: f64| (-distance / nu).exp() / (nu * nu);
    let pole = |kappa: f64, rest: f64| [2.0 * kappa * kappa * rest, (-kappa * distance).exp()];
    let value = both(albedo, decay, pole) / (4.0 * PI * distance);
    // Exponents are rounded: far away this is a relative error of the exponential.
    known(value, ROUNDING + 2.0 * f64::EPSILON * distance, albedo, distance)
}

/// `E[r²]` at absorption, in units of `1/σ_t²`, for any phase function of mean cosine g.
pub fn square_at_absorption(albedo: f64, mean_cosine: f64) -> f64 {
    // 1 − a g without the cancellation where both are nearly one.
    let lost = (1.0 - albedo) + albedo * (1.0 - mean_cosine);
    2.0 / ((1.0 - albedo) * lost)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_scattering_there_is_one_collision() {
        // φ = e^{−r}/(4π r²), and 1 − e^{−R} of all particles collide within R.
        for distance in [0.1, 1.0, 5.0] {
            let collisions = collisions_within(0.0, distance);
            let exact = -(-distance).exp_m1();
            assert!((collisions.value / exact - 1.0).abs() < 1e-13, "{collisions:?} {exact}");
            let exact = (-distance).exp() / (4.0 * PI * distance * distance);
            assert!((fluence(0.0, distance).value / exact - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn the_share_of_a_thin_shell_keeps_its_digits() {
        assert!((share(1e-6) / 5e-13 - 1.0).abs() < 1e-6);
        for x in [0.5, 0.999_999] {
            assert!((share(x) / (1.0 - (1.0 + x) * f64::exp(-x)) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn all_collisions_lie_within_a_great_distance() {
        for albedo in [0.01, 0.029, 0.031, 0.3, 0.9, 0.99] {
            let all = collisions_within(albedo, 2e3).value;
            assert!((all * (1.0 - albedo) - 1.0).abs() < 1e-12, "{albedo}: {all}");
        }
    }

    #[test]
    fn particles_are_absorbed_farther_out_the_more_they_scatter_forward() {
        // One flight of mean square 2; scattered straight on it is one flight through 1 − a.
        assert_eq!(square_at_absorption(0.0, 0.3), 2.0);
        assert!((square_at_absorption(0.75, 1.0) - 32.0).abs() < 1e-12);
    }
}
