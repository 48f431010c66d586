//! Slabs so thin that the directions of adding and doubling do not resolve grazing light.
//!
//! ```text
//! isotropic scattering   R = Σ_r a^r R_r,  T = Σ_r a^r T_r   by orders of scattering
//! any other              R = S c (β ± q),  c the collided light, β the share of it that is scattered back,
//!                        q ≤ p̂ τ (1 + ln 1/τ) the share that collides again, p̂ = 4π times the largest p
//! ```
//!
//! Light at the cosine μ collides again with a probability of at most `min(1, τ/μ)`, the integral of which over μ is
//! `τ (1 + ln 1/τ)`. Of diffuse light, which has the directions of the answer, the same share of what collides is missing
//! from 2τ. Both the exact answer and that of few directions lie within these bounds.
//!
//! Source: derived.

use std::f64::consts::PI;

use super::{EnergyBounds, IncidentLight, orders};
use crate::Kernel;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::{Known, exponential_integrals};

/// Depth of a thin slab: in thinner ones light grazes between the directions of all answers. Differences get the
/// further factor of this over the depth: of 4600 answers some exceeded them, by three times, from 5e-3 down.
pub const THIN: f64 = 1e-2;
/// Maximum bound on the share of scattered light that collides again, for which it is used.
const FEW: f64 = 0.1;
/// Relative error of the light that is scattered in all orders, beyond that which their sum shows.
const OF_ORDERS: f64 = 2e-12;
/// Relative rounding error of exponential integrals.
const OF_INTEGRALS: f64 = 4e-15;

/// Factor of differences between resolutions in a slab of an optical depth.
pub fn factor(depth: f64) -> f64 {
    if depth > 0.0 { (THIN / depth).max(1.0) } else { 1.0 }
}

/// Bounds on the difference of the shares of two resolutions beyond that of the light that is scattered once.
#[derive(Debug, Clone, Copy)]
pub struct Grazing {
    /// Scattered light that collides again.
    again: f64,
    /// Share of the collided light that directions of diffuse light miss.
    missed: f64,
    /// Collided light.
    collided: f64,
}

impl Grazing {
    /// Nothing is known.
    pub const UNKNOWN: Self = Self { again: f64::INFINITY, missed: 0.0, collided: 0.0 };

    /// Bound for a share: it is of the collided light, or all but that.
    pub fn bound(self, share: f64) -> f64 {
        self.again + self.missed * share.abs().min(self.collided)
    }
}

/// Returns the bounds of a stack; unknown where light is scattered more than once by a thick slab.
pub fn grazing(phase: &Phase, light: IncidentLight, slices: &[Kernel]) -> Grazing {
    let sum =
        |of: fn(&Kernel) -> f64| -> f64 { slices.iter().map(|slice| slice.rate * of(slice)).sum() };
    let scattered = sum(|slice| slice.scattered.abs());
    let depth = scattered.max(sum(|slice| slice.lost().abs()));
    // Every phase function is largest straight on or straight back.
    let largest = [-1.0, 1.0].map(|cosine| phase.value(cosine)).into_iter().fold(0.0, f64::max);
    let missed = depth * (1.0 - depth.min(1.0).ln());
    let again = 4.0 * PI * largest * missed;
    // NaN without a depth.
    let is_thin = again <= FEW;
    if !is_thin {
        return Grazing::UNKNOWN;
    }
    let of_depth = light.cosine().map_or(2.0, f64::recip);
    Grazing {
        // Both answers, and what collides a third time.
        again: 3.0 * of_depth * scattered * again,
        missed: if light == IncidentLight::Diffuse { missed } else { 0.0 },
        collided: of_depth * depth,
    }
}

/// Share of light that collides in a slab, without cancellation.
fn collided(light: IncidentLight, depth: f64) -> f64 {
    match light {
        IncidentLight::Collimated(cosine) => -(-depth / cosine).exp_m1(),
        // 1 − 2E₃.
        IncidentLight::Diffuse => -(-depth).exp_m1() + depth * exponential_integrals(depth)[1],
    }
}

/// Shares of isotropic scattering in a thin slab of an albedo up to 1, from orders of scattering; `None` elsewhere.
pub fn by_orders(
    phase: &Phase,
    light: IncidentLight,
    depth: f64,
    albedo: f64,
) -> Option<[Known; 2]> {
    if *phase != Phase::Isotropic(Isotropic) || depth >= THIN || albedo > 1.0 {
        return None;
    }
    let orders = orders::orders(light, depth)?;
    // Everything that collides leaves at last, if nothing is absorbed.
    let (result, all) = (orders[1..].iter().flatten().sum::<f64>(), collided(light, depth));
    let error = OF_ORDERS + (result / all - 1.0).abs();
    let scattered =
        |end: usize| orders[1..].iter().rev().fold(0.0, |sum, order| albedo * (sum + order[end]));
    Some([0, 1].map(|end| {
        let (scattered, straight) = (scattered(end), orders[0][end]);
        let error = error * scattered + 2.0 * f64::EPSILON * straight;
        Known::estimated(straight + scattered, error)
    }))
}

/// Shares of a slab that scatters nothing, in closed form.
///
/// ```text
/// T = e^{−τ/μ₀}, or 2E₃(τ) = e^{−τ} − τE₂(τ) of diffuse light;  dT/dτ = −2E₂
/// ```
pub fn black(light: IncidentLight, depth: Known) -> EnergyBounds {
    let transmitted = match light {
        IncidentLight::Collimated(cosine) => (depth * cosine.recip()).exp_neg(),
        IncidentLight::Diffuse => {
            let Known { value: depth, error, grade } = depth;
            let [_, second] = exponential_integrals(depth);
            let value = (-depth).exp() - depth * second;
            // Both integrals are differences of numbers that are τ times as large.
            let rounding = OF_INTEGRALS * (1.0 + depth).powi(2) * value;
            Known { value, error: 2.0 * second * error + rounding, grade }
        }
    };
    let score = Known { value: collided(light, depth.value), ..transmitted };
    EnergyBounds {
        reflected: Known::new(0.0, 0.0),
        transmitted,
        score: score.blurred(f64::EPSILON),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::peaked;
    use super::super::{Resolution, answers, energies, solve};
    use super::*;
    use media::phase::rayleigh::Rayleigh;
    use numeric::Span;
    use numeric::quadrature::GaussLegendre;

    const LIGHTS: [IncidentLight; 3] =
        [IncidentLight::Collimated(1.0), IncidentLight::Collimated(0.2), IncidentLight::Diffuse];

    /// In the limit a slab reflects `a c β` and lets all else pass, with c = τ/μ₀ or 2τ.
    #[test]
    fn the_thinnest_slabs_scatter_once() {
        for phase in [Phase::Isotropic(Isotropic), peaked(0.9), peaked(-0.6)] {
            for albedo in [0.9, 1.0] {
                for depth in [1e-12, 1e-20, 1e-60] {
                    let result = answers(&phase, &LIGHTS, Known::exact(depth), albedo);
                    for (light, result) in LIGHTS.iter().zip(result.expect("finite")) {
                        let back = result.reflected.value / (albedo * collided(*light, depth));
                        let context = format!("{phase:?}, {albedo}, {depth:e}, {light:?}");
                        let is_even = phase == Phase::Isotropic(Isotropic);
                        assert!(!is_even || (back - 0.5).abs() < 1e-9, "{context}: {back}");
                        assert!(back > 0.0 && back < 1.0, "{context}: {back}");
                        for known in [result.reflected, result.transmitted] {
                            assert!(known.error < 1e-4 * known.value, "{context}: {known:?}");
                        }
                    }
                }
            }
        }
    }

    /// Orders of scattering, adding and doubling at thicker slabs, and the bound on what grazes agree.
    #[test]
    fn thin_slabs_are_known_by_orders_of_scattering() {
        let phase = Phase::Isotropic(Isotropic);
        for depth in [1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 9e-3] {
            for albedo in [0.3, 0.9, 1.0] {
                let slice = Kernel { rate: depth, straight: 0.0, scattered: albedo, score: 1.0 };
                let doubled = solve(&phase, &LIGHTS, &[slice], Resolution::FINE).expect("finite");
                let result = answers(&phase, &LIGHTS, Known::exact(depth), albedo).expect("finite");
                for (result, doubled) in result.iter().zip(doubled) {
                    for (result, doubled) in [
                        (result.reflected, doubled.reflected),
                        (result.transmitted, doubled.transmitted),
                    ] {
                        let off = (result.value - doubled.value).abs();
                        let context = format!("{depth:e}, {albedo}: {result:?}, {doubled:?}");
                        assert!(off <= result.error + doubled.error, "{context}");
                        assert!(result.error < 1e-6 * result.value, "{context}");
                    }
                }
            }
        }
    }

    /// Of diffuse light, the directions of adding and doubling miss some that grazes and collides. Nearly nothing is
    /// scattered, so that a black slab is the reference.
    #[test]
    fn diffuse_light_that_grazes_is_within_the_error() {
        for depth in [1e-7, 1.507_135_228_146_274_4e-6, 1e-5, 1e-4, 1e-3, 9e-3] {
            for phase in [Phase::Isotropic(Isotropic), Phase::Rayleigh(Rayleigh), peaked(0.9)] {
                let albedo = 4.621_230_384_040_332e-10;
                let slice = Kernel { rate: depth, straight: 0.0, scattered: albedo, score: 1.0 };
                let light = IncidentLight::Diffuse;
                let result =
                    solve(&phase, &[light], &[slice], Resolution::FINE).expect("finite")[0];
                let exact = black(light, Known::exact(depth));
                let slack = 2.0 * albedo * exact.score.value;
                for (result, exact) in
                    [(result.transmitted, exact.transmitted), (result.score, exact.score)]
                {
                    let off = (result.value - exact.value).abs();
                    let context = format!("{phase:?}, {depth:e}: {off:e}, {result:?}");
                    assert!(off <= result.error + exact.error + slack, "{context}");
                }
                // As many collisions as by twice the directions.
                let directions = 72;
                let fine = Resolution {
                    faintest: 1e-14,
                    directions,
                    first_layer: 1e-14,
                    ..Resolution::FINE
                };
                let fine = energies(&phase, &[light], &[slice], fine).expect("finite")[0];
                let off = (fine.score - result.score.value).abs();
                assert!(off <= result.score.error, "{phase:?}, {depth:e}: {off:e}, {result:?}");
                let back = result.reflected;
                assert!(back.error < 1e-2 * back.value, "{phase:?}, {depth:e}: {back:?}");
            }
        }
    }

    /// Without scattering the phase function does not matter, however sharp it is.
    #[test]
    fn a_black_slab_is_known_in_closed_form() {
        for depth in [0.0, 1e-9, 0.3, 20.0, 100.0] {
            let result =
                answers(&peaked(-0.99), &LIGHTS, Known::exact(depth), 0.0).expect("finite");
            for (light, result) in LIGHTS.iter().zip(result) {
                let exact = match light {
                    IncidentLight::Collimated(cosine) => (-depth / cosine).exp(),
                    IncidentLight::Diffuse => GaussLegendre::new(64)
                        .on(Span::new(0.0, 1.0))
                        .map(|(x, weight)| 4.0 * weight * x.powi(3) * (-depth / (x * x)).exp())
                        .sum(),
                };
                let Known { value, error, .. } = result.transmitted;
                assert_eq!(result.reflected, Known::new(0.0, 0.0));
                assert!(
                    (value / exact - 1.0).abs() < 1e-9,
                    "{light:?}, {depth}: {value:e} {exact:e}"
                );
                assert!(error < 1e-10 * value, "{light:?}, {depth}: {error:e}");
                assert!((result.score.value + value - 1.0).abs() < 1e-15);
            }
        }
    }
}
