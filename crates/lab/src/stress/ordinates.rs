//! Slabs of isotropic scattering by discrete ordinates in 32 digits.
//!
//! The equations of N directions have solutions that fall and grow like `e^{±kt}`, one to each root k of a
//! secular equation: depth enters exactly, and nothing is added or doubled. Beyond an albedo of 1, as of
//! moments of walks, the slowest of them oscillates in depth.
//!
//! ```text
//! a Σ wᵢ/(1 − k²μᵢ²) = 1,   J(t) = Σⱼ αⱼ e^{−kⱼt} + βⱼ e^{−kⱼ(τ−t)},   I = 1 above, I = 0 below
//! a > 1:  a Σ wᵢ/(1 + ν²μᵢ²) = 1,   ½A cos(ν(τ/2 − t)) + ½B sin(ν(τ/2 − t)) in place of k₁
//! R(μ₀) = ∫ J(t) e^{−t/μ₀} dt/μ₀,   T(μ₀) = e^{−τ/μ₀} + ∫ J(t) e^{−(τ−t)/μ₀} dt/μ₀
//! ```
//!
//! By reciprocity, light from all sides (I = 1) gives R and T of a ray from μ₀. Each root lies between the `1/μ` of two
//! consecutive ordinates and is found by bisection. Roots and linear equations are computed in 32 digits.
//!
//! Source: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), chapters 2, 3 and 7.

use super::equations::solved;
use super::prelude::*;
use theory::problems::slab::IncidentLight;

/// Directions and the solutions in them.
pub struct Ordinates {
    depth: DoubleDouble,
    cosines: Vec<DoubleDouble>,
    weights: Vec<DoubleDouble>,
    swing: Option<Swing>,
    /// k, α, β and `e^{−kτ}`.
    parts: Vec<[DoubleDouble; 4]>,
}

/// The solution that oscillates in depth, for an albedo above 1.
struct Swing {
    /// ν.
    rate: DoubleDouble,
    /// The sine and the cosine of ντ/2.
    half_way: [DoubleDouble; 2],
    /// A and B.
    sizes: [DoubleDouble; 2],
}

impl Ordinates {
    /// `None` where the linear equations have no solution.
    pub fn new(depth: DoubleDouble, albedo: DoubleDouble, count: usize) -> Option<Self> {
        let (cosines, weights) = directions(count);
        let mut roots = roots(albedo, &cosines, &weights);
        let nu = (albedo.high > 1.0).then(|| {
            roots.remove(0);
            swing(albedo, &cosines, &weights)
        });
        let faint: Vec<DoubleDouble> = roots.iter().map(|&k| (-(k * depth)).exp()).collect();
        let half_way = nu.map(|nu| (nu * depth).scaled(-1).sin_cos());
        // Light from both sides alike, and of opposite signs: their halves add up to that from above.
        let solutions = [DoubleDouble::ONE, -DoubleDouble::ONE].map(|sign| {
            let entry = |mu: DoubleDouble, k: DoubleDouble, faint: DoubleDouble| {
                let far = faint / (1.0 + k * mu);
                1.0 / (1.0 - k * mu) + sign * far
            };
            let swinging =
                |mu: DoubleDouble, nu: DoubleDouble, [sine, cosine]: [DoubleDouble; 2]| {
                    let x = nu * mu;
                    let size = 1.0 + x * x;
                    let turned = [cosine - x * sine, sine + x * cosine];
                    turned[usize::from(sign.high < 0.0)] / size
                };
            let row = |&mu: &DoubleDouble| {
                let first = nu.zip(half_way).map(|(nu, half_way)| swinging(mu, nu, half_way));
                let entries = roots.iter().zip(&faint).map(|(&k, &faint)| entry(mu, k, faint));
                first.into_iter().chain(entries).chain([DoubleDouble::ONE]).collect()
            };
            solved_pivoted(cosines.iter().map(row).collect())
        });
        let [same, opposite] = solutions;
        let (mut same, mut opposite) = (same?, opposite?);
        let swing = nu.zip(half_way).map(|(nu, half_way)| Swing {
            rate: nu,
            half_way,
            sizes: [same.remove(0), opposite.remove(0)],
        });
        let parts = roots.iter().zip(faint).zip(same.into_iter().zip(opposite));
        let part = |((&k, faint), (a, b)): (
            (&DoubleDouble, DoubleDouble),
            (DoubleDouble, DoubleDouble),
        )| { [k, (a + b).scaled(-1), (a - b).scaled(-1), faint] };
        let parts = parts.map(part).collect();
        Some(Self { depth, cosines, weights, swing, parts })
    }

    /// Returns whether the albedo exceeds 1: one solution oscillates in depth.
    pub fn swings(&self) -> bool {
        self.swing.is_some()
    }

    /// Returns whether J is positive everywhere. If the albedo exceeds 1 it may not be, unless the slab is thin.
    pub fn is_positive(&self) -> bool {
        const PLACES: u32 = 64;
        (0..=PLACES).all(|i| {
            let t = self.depth * (f64::from(i) / f64::from(PLACES));
            let rest = self.depth - t;
            let swinging = self.swing.as_ref().map(|swing| {
                let [a, b] = swing.sizes;
                let [sine, cosine] = (swing.rate * (rest - t)).scaled(-1).sin_cos();
                (a * cosine + b * sine).scaled(-1)
            });
            let part = |&[k, alpha, beta, _]: &[DoubleDouble; 4]| {
                alpha * (-(k * t)).exp() + beta * (-(k * rest)).exp()
            };
            let sum: DoubleDouble = self.parts.iter().map(part).chain(swinging).sum();
            sum.high > 0.0
        })
    }

    /// R and T of a ray.
    fn leaving(&self, cosine: DoubleDouble) -> [DoubleDouble; 2] {
        let straight = (-(self.depth / cosine)).exp();
        let mut leaving = [DoubleDouble::default(), straight];
        if let Some(Swing { rate, half_way: [sine, swung], sizes: [a, b] }) = self.swing {
            let x = rate * cosine;
            let size = (1.0 + x * x).scaled(1);
            let (less, more) = (1.0 - straight, 1.0 + straight);
            let even = a * (swung * less + x * sine * more) / size;
            let odd = b * (sine * more - x * swung * less) / size;
            leaving[0] += even + odd;
            leaving[1] += even - odd;
        }
        for &[k, alpha, beta, faint] in &self.parts {
            let near = (1.0 - faint * straight) / (1.0 + k * cosine);
            let away = 1.0 - k * cosine;
            let x = away * self.depth / cosine;
            // (e^{−kτ} − e^{−τ/μ})/(1 − kμ), also where both are nearly one.
            let far = if x.high.abs() < 0.1 && x.high != 0.0 {
                straight * (self.depth / cosine) * (x.exp_m1() / x)
            } else {
                (faint - straight) / away
            };
            leaving[0] += alpha * near + beta * far;
            leaving[1] += beta * near + alpha * far;
        }
        leaving
    }

    /// R and T.
    pub fn energy(&self, light: IncidentLight) -> [DoubleDouble; 2] {
        if let IncidentLight::Collimated(cosine) = light {
            return self.leaving(DoubleDouble::from(cosine));
        }
        let mut sums = [DoubleDouble::default(); 3];
        for (&mu, &weight) in self.cosines.iter().zip(&self.weights) {
            let [r, t] = self.leaving(mu);
            for (sum, x) in sums.iter_mut().zip([r, t, DoubleDouble::ONE]) {
                *sum += mu * weight * x;
            }
        }
        [sums[0] / sums[2], sums[1] / sums[2]]
    }
}

/// ν of an albedo above 1.
fn swing(albedo: DoubleDouble, cosines: &[DoubleDouble], weights: &[DoubleDouble]) -> DoubleDouble {
    let left = |nu: DoubleDouble| {
        let term = |(&mu, &w): (&DoubleDouble, &DoubleDouble)| w / (1.0 + (nu * mu).powi(2));
        1.0 - albedo * cosines.iter().zip(weights).map(term).sum::<DoubleDouble>()
    };
    let mut high = DoubleDouble::ONE;
    while left(high).high < 0.0 {
        high = high.scaled(1);
    }
    bisected([DoubleDouble::default(), high], |nu| left(nu).high < 0.0)
}

/// Returns the place between two numbers up to which a condition holds.
fn bisected(
    [mut low, mut high]: [DoubleDouble; 2],
    holds: impl Fn(DoubleDouble) -> bool,
) -> DoubleDouble {
    for _ in 0..110 {
        let middle = (low + high).scaled(-1);
        if holds(middle) { low = middle } else { high = middle }
    }
    (low + high).scaled(-1)
}

/// `μ = x³` of Gauss' nodes, dense where light grazes, from the steepest to the most grazing, and weights.
pub(super) fn directions(count: usize) -> (Vec<DoubleDouble>, Vec<DoubleDouble>) {
    let rule = GaussLegendre::new(count);
    let nodes = rule.nodes.iter().zip(&rule.weights).rev();
    let (cosines, weights): (Vec<DoubleDouble>, Vec<DoubleDouble>) = nodes
        .map(|(&x, &w)| {
            (
                DoubleDouble::from(x).powi(3),
                DoubleDouble::from(3.0 * w) * DoubleDouble::from(x).powi(2),
            )
        })
        .unzip();
    let whole: DoubleDouble = weights.iter().copied().sum();
    (cosines, weights.into_iter().map(|w| w / whole).collect())
}

/// One k between 0 and the first `1/μ`, and one between each two, bisected in 32 digits.
pub(super) fn roots(
    albedo: DoubleDouble,
    cosines: &[DoubleDouble],
    weights: &[DoubleDouble],
) -> Vec<DoubleDouble> {
    let left = |k: DoubleDouble| {
        let term = |(&mu, &w): (&DoubleDouble, &DoubleDouble)| w / (1.0 - (k * mu).powi(2));
        1.0 - albedo * cosines.iter().zip(weights).map(term).sum::<DoubleDouble>()
    };
    let mut from = DoubleDouble::default();
    let between = cosines.iter().map(|&mu| {
        let low = std::mem::replace(&mut from, 1.0 / mu);
        bisected([low, from], |k| left(k).high > 0.0)
    });
    between.collect()
}

/// Solves equations; rows end with their right sides.
pub(super) fn solved_pivoted(rows: Vec<Vec<DoubleDouble>>) -> Option<Vec<DoubleDouble>> {
    let computed = solved(rows, |x| x.high.abs(), true)?;
    Some(computed.into_iter().map(|[x]| x).collect())
}
