//! Reflectance and transmittance of a rod with one albedo and one probability to scatter forward.
//!
//! ```text
//! α = 1 − a p_f,  β = a(1 − p_f),  κ² = (1 − a)(1 − a(2p_f − 1)),  E = e^{−2κτ},  s = (1 − E)/κ
//! R = βs/(1 + E + αs),  T = 2e^{−κτ}/(1 + E + αs);   a = 1:  R = βτ/(1 + βτ), T = 1/(1 + βτ)
//! ```
//!
//! They depend on the optical depth only. At a = 1 the formulas have their limit s = 2τ.

use numeric::Known;

/// R and T.
pub fn leaving(depth: Known, albedo: f64, forward: f64) -> [Known; 2] {
    let tau = depth.value;
    // 1 − a p_f without the cancellation at a white, forward rod.
    let lost = (1.0 - albedo) + albedo * (1.0 - forward);
    let turned = albedo * (1.0 - forward);
    let kappa = ((1.0 - albedo) * (lost + turned)).sqrt();
    let x = 2.0 * kappa * tau;
    // −expm1(−x)/κ, 2τ in the limit.
    let s = if kappa > 0.0 { -(-x).exp_m1() / kappa } else { 2.0 * tau };
    let below = 1.0 + (-x).exp() + lost * s;
    let values = [turned * s / below, 2.0 * (-kappa * tau).exp() / below];
    // dR/dτ ≤ β and −dT/dτ ≤ 1 − a p_f, 1 at most; after τ there are a few roundings, and those of κτ.
    let rounding = (8.0 + kappa * tau) * f64::EPSILON;
    let slopes = [turned, lost];
    std::array::from_fn(|i| {
        let error = slopes[i] * depth.error.min(1.0) + rounding * values[i];
        Known { value: values[i], error, ..depth }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_white_rod_divides_by_its_depth() {
        let [r, t] = leaving(Known::exact(2.0), 1.0, 0.75);
        assert!((r.value - 1.0 / 3.0).abs() < 1e-15 && (t.value - 2.0 / 3.0).abs() < 1e-15);
        // Just below a = 1 nothing jumps.
        let [near, _] = leaving(Known::exact(2.0), 1.0 - 1e-12, 0.75);
        assert!((near.value - r.value).abs() < 1e-11);
    }

    #[test]
    fn without_albedo_nothing_comes_back() {
        let [r, t] = leaving(Known::exact(1.5), 0.0, 0.3);
        assert_eq!(r.value, 0.0);
        assert!((t.value - (-1.5f64).exp()).abs() < 1e-16);
    }
}
