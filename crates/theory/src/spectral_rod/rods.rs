//! Rods of coloured scatterers, as closed forms.
//!
//! ```text
//! α = 1 − a p_f,  β = a(1 − p_f),  κ² = α² − β²
//! T = 1/(cosh κτ + (α/κ) sinh κτ),  R = (β/κ) sinh κτ · T
//! ```
//!
//! For a > 1 there is a critical length from which on the moment is infinite: the first τ at
//! which the denominator of T is 0. `T_r`, the probability to leave after r scatterings that never absorb, are the
//! coefficients of T(a), found on the circle |a| = 1.
//!
//! Source: derived from the two-stream equations of R. Bellman, R. Kalaba, G. M. Wing, *Invariant Imbedding and
//! Mathematical Physics*, Journal of Mathematical Physics 1 (1960).

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::{Body, Orders, ROUNDING};
use crate::particle::ParticleRule;
use crate::problems::rod::channels;
use crate::problems::{Problem, Rod, SpectralRod};
use crate::{CountLaw, Mesh, rod};
use media::Piecewise;
use numeric::Known;
use numeric::digits::rounded;

/// Orders of scattering that are rarer than this do not count.
const RARE: f64 = 1e-17;
/// The most orders of scattering.
const MOST_ORDERS: usize = 8192;
/// Larger albedos are not looked at.
const LARGEST: f64 = 1e6;

/// A rod with what its walks fly through.
pub struct Rods<'a> {
    rod: &'a SpectralRod,
    mesh: &'a Mesh,
    sampling: &'a Piecewise,
    depth: Known,
}

impl<'a> Rods<'a> {
    /// Joins the parts.
    pub fn new(rod: &'a SpectralRod, mesh: &'a Mesh, sampling: &'a Piecewise) -> Self {
        let depth = rod.medium().optical_depth(rod.medium().support());
        Self { rod, mesh, sampling, depth }
    }
}

impl Body for Rods<'_> {
    fn leaving(&self, albedo: f64) -> Option<[Known; 2]> {
        let values = leaving(self.depth.value, albedo, self.rod.forward)?;
        // Neither changes faster than τ.
        Some(values.map(|value| Known::new(value, self.depth.error + ROUNDING * value)))
    }

    fn beyond(&self, albedo: f64) -> Option<String> {
        let critical = critical(albedo, self.rod.forward);
        if self.depth.value >= critical {
            return Some(format!("from optical length {} on", rounded(critical)));
        }
        let is_above = self.leaving(albedo).is_none();
        is_above.then(|| "for a double: it is above 1.8e308".into())
    }

    fn orders(&self) -> Option<Orders> {
        let found = orders(self.depth.value, self.rod.forward)?;
        Some(Orders { found, error: ROUNDING, blur: self.depth.error })
    }

    fn lookups(&self, heroes: &[(f64, f64)]) -> Option<CountLaw> {
        let of = |albedo: f64| {
            let [albedo, forward] =
                [albedo, self.rod.forward].map(|x| Piecewise::constant(x, self.mesh.support()));
            let medium = self.rod.medium().clone();
            let rod = Rod::new(medium, &albedo, &forward, channels(0, false, None));
            rod::factorial_lookups(self.mesh, &rod, self.sampling, ParticleRule::Analog)
        };
        let mut mixed = [[0.0; 2]; 4];
        for &(weight, albedo) in heroes {
            for (sum, [value, error]) in mixed.iter_mut().zip(of(albedo)?) {
                *sum = [sum[0] + weight * value, sum[1] + weight * error];
            }
        }
        let [mean, error] = mixed[0];
        let law = CountLaw::of_factorial_moments(mixed.map(|[value, _]| value));
        Some(CountLaw { error: if mean > 0.0 { error / mean } else { 0.0 }, ..law })
    }
}

/// Reflectance and transmittance of a rod; `None` from its critical length on.
pub fn leaving(depth: f64, albedo: f64, forward: f64) -> Option<[f64; 2]> {
    if depth >= critical(albedo, forward) {
        return None;
    }
    let found = continued(depth, Complex64::from(albedo), forward).map(|x| x.re);
    // Beyond the largest number, too.
    found.iter().all(|value| value.is_finite()).then_some(found)
}

/// The optical length from which on a rod of an albedo has no finite answer; infinite where there is none.
///
/// ```text
/// ω² = β² − α²:  atan2(ω, −α)/ω;  for κ² = −ω² > 0 and α < −κ:  artanh(−κ/α)/κ
/// ```
pub fn critical(albedo: f64, forward: f64) -> f64 {
    let (alpha, beta) = (1.0 - albedo * forward, albedo * (1.0 - forward));
    let square = beta * beta - alpha * alpha;
    if albedo <= 1.0 {
        f64::INFINITY
    } else if square > 0.0 {
        let omega = square.sqrt();
        omega.atan2(-alpha) / omega
    } else if alpha < 0.0 {
        let kappa = (-square).sqrt();
        if kappa == 0.0 { -1.0 / alpha } else { (-kappa / alpha).atanh() / kappa }
    } else {
        f64::INFINITY
    }
}

/// R and T of a complex albedo.
fn continued(depth: f64, albedo: Complex64, forward: f64) -> [Complex64; 2] {
    let (alpha, beta) = (-albedo * forward + 1.0, albedo * (1.0 - forward));
    if forward == 1.0 {
        return [Complex64::ZERO, (-alpha * depth).exp()];
    }
    // (1 − a)(1 − a(2p_f − 1)), which cancels less than α² − β².
    let one = Complex64::from(1.0);
    let kappa = ((one - albedo) * (one - albedo * (2.0 * forward - 1.0))).sqrt();
    // e^{−κτ}, and sinh κτ e^{−κτ}/κ with its limit τ; Re κ ≥ 0.
    let decay = (-kappa * depth).exp();
    let flat = kappa.norm() * depth < 1e-8;
    let sine = if flat { Complex64::from(depth) } else { (1.0 - decay * decay) * 0.5 / kappa };
    // (1 + e^{−2κτ})/2 + α sine, which cancels where α is near −κ: α + κ = −β²/(κ − α).
    let below = if alpha.re < 0.0 {
        decay * decay - beta * beta * sine / (kappa - alpha)
    } else {
        (1.0 + decay * decay) * 0.5 + alpha * sine
    };
    [beta * sine / below, decay / below]
}

/// So many orders of scattering that all above are rarer in a rod of an albedo.
///
/// ```text
/// T_r + R_r ≤ (T(b) + R(b)) b^{−r}  for every b up to the albedo that makes this length critical
/// ```
pub fn orders_above(depth: f64, albedo: f64, forward: f64, rare: f64) -> usize {
    let (mut low, mut high) = (1.0, 2.0);
    while critical(high, forward) > depth && high < LARGEST {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if critical(middle, forward) > depth { low = middle } else { high = middle }
    }
    let bounds = (1..64).filter_map(|i| {
        let larger = f64::powf(low, f64::from(i) / 64.0);
        let size: f64 = leaving(depth, larger, forward)?.iter().sum();
        size.is_finite().then(|| (size.max(1.0) / rare).ln() / (larger / albedo).ln())
    });
    let least = bounds.filter(|orders| *orders >= 0.0).fold(f64::INFINITY, f64::min);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    // beyond the largest it stays there
    let least = least.ceil() as usize;
    least.saturating_add(8)
}

/// The probabilities to leave a rod without absorption after r scatterings; `None` where there are too many.
fn orders(depth: f64, forward: f64) -> Option<Vec<[f64; 2]>> {
    let count = orders_above(depth, 1.0, forward, RARE);
    if count > MOST_ORDERS {
        return None;
    }
    let angle = |j: usize| TAU * j as f64 / count as f64;
    // T(ā) is the conjugate of T(a): half the circle is enough.
    let half: Vec<[Complex64; 2]> = (0..=count / 2)
        .map(|j| continued(depth, Complex64::from_polar(1.0, angle(j)), forward))
        .collect();
    let turn: Vec<Complex64> = (0..count).map(|j| Complex64::from_polar(1.0, -angle(j))).collect();
    let order = |r: usize| {
        let mut sum = [0.0; 2];
        for (j, values) in half.iter().enumerate() {
            let weight = if j == 0 || 2 * j == count { 1.0 } else { 2.0 };
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += weight * (value * turn[j * r % count]).re;
            }
        }
        sum.map(|sum| (sum / count as f64).max(0.0))
    };
    Some((0..count).map(order).collect())
}
