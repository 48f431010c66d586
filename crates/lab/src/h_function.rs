//! Chandrasekhar's H-function: the semi-infinite medium that scatters isotropically.
//!
//! ```text
//! H(μ) = 1 + (a/2) μ H(μ) ∫₀¹ H(μ')/(μ + μ') dμ',   R(μ₀) = 1 − H(μ₀) √(1 − a)
//! ln H(μ) = −(μ/π) ∫₀^{π/2} ln(1 − a φ cot φ) / (cos²φ + μ² sin²φ) dφ
//! ```
//!
//! The second form is integrated in panels that halve towards both ends: towards 0, where for a = 1 the
//! logarithm is that of `φ²/3`, and towards `π/2`, where for small μ the integrand has a peak of width μ.
//!
//! Source: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), chapters 4 and 5; D.
//! W. N. Stibbs, R. E. Weir, *On the H-functions for isotropic scattering*, Monthly Notices of the Royal
//! Astronomical Society 119, 512–525 (1959).

use std::f64::consts::{FRAC_PI_2, PI};

use numeric::quadrature::GaussLegendre;
use numeric::sum::Sum;

/// Relative error of the result.
pub const ERROR: f64 = 1e-14;
/// Number of halvings of the panels towards either end.
const HALVINGS: i32 = 48;
/// Nodes per panel.
const NODES: usize = 20;

/// `H(μ)` for the albedo a in `[0, 1]` and μ in `[0, 1]`, to [`ERROR`].
pub fn h_function(albedo: f64, cosine: f64) -> f64 {
    let rule = GaussLegendre::new(NODES);
    let mut sum = Sum::default();
    let half = 0.5 * FRAC_PI_2;
    let mut outer = half;
    for k in 1..=HALVINGS {
        // The last panel reaches the end.
        let inner = if k == HALVINGS { 0.0 } else { half * 0.5f64.powi(k) };
        sum.add(rule.integrate(inner, outer, |phi| near_zero(albedo, cosine, phi)));
        sum.add(rule.integrate(inner, outer, |phi| near_right_angle(albedo, cosine, phi)));
        outer = inner;
    }
    (-cosine / PI * sum.value()).exp()
}

/// The integrand at an angle φ from 0.
fn near_zero(albedo: f64, cosine: f64, phi: f64) -> f64 {
    // 1 − a φ cot φ = (1 − a) + a(1 − φ cot φ); the last difference cancels for small φ.
    let square = phi * phi;
    let bent = if phi < 0.1 {
        let terms = [1.0 / 3.0, 1.0 / 45.0, 2.0 / 945.0, 1.0 / 4725.0, 2.0 / 93555.0];
        square * terms.iter().rev().fold(0.0, |sum, term| sum * square + term)
    } else {
        1.0 - phi / phi.tan()
    };
    let (sine, along) = phi.sin_cos();
    ((1.0 - albedo) + albedo * bent).ln() / (along * along + cosine * cosine * sine * sine)
}

/// The integrand at an angle of ψ before the right angle.
fn near_right_angle(albedo: f64, cosine: f64, psi: f64) -> f64 {
    let (sine, along) = psi.sin_cos();
    (-albedo * (FRAC_PI_2 - psi) * psi.tan()).ln_1p()
        / (sine * sine + cosine * cosine * along * along)
}
