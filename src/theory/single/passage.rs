//! An estimated transmittance of one segment: moments of its value and of its lookups.

use crate::media::Medium;
use crate::numeric::Span;
use crate::numeric::quadrature::GaussLegendre;

/// How the transmittance of a shadow ray is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tracking {
    /// In closed form.
    Exact,
    /// By ratio tracking through a constant σ̂, with a constant control.
    Ratio {
        /// σ̂ > 0, 1/length.
        sampling: f64,
        /// σ_c, 1/length.
        control: f64,
    },
    /// By delta tracking through a constant majorant.
    Delta {
        /// σ̄, 1/length.
        sampling: f64,
    },
}

/// The powers of a value that are asked for.
pub const POWERS: [i32; 5] = [1, 2, 3, 4, 8];

/// The moments of an estimated transmittance X and of its lookups N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// `E[X^k]` for k = 0 … 4.
    pub powers: [f64; 5],
    /// `E[X⁸]`.
    pub eighth: f64,
    /// `E[N^k]` for k = 0 … 4.
    pub lookups: [f64; 5],
    /// `E[N^k; the walk came through]` for k = 0 … 4.
    pub through: [f64; 5],
}

impl Passage {
    /// A transmittance that is known.
    #[must_use]
    pub fn exact(depth: f64) -> Self {
        let power = |k: f64| (-k * depth).exp();
        let powers = [1.0, power(1.0), power(2.0), power(3.0), power(4.0)];
        let none = [1.0, 0.0, 0.0, 0.0, 0.0];
        Self { powers, eighth: power(8.0), lookups: none, through: none }
    }

    /// A product of Poisson factors with the given exponents, in the order of [`POWERS`], and the
    /// given mean number of collisions. It always comes through.
    #[must_use]
    pub fn product(exponents: [f64; 5], collisions: f64) -> Self {
        let [a, b, c, d, eighth] = exponents.map(|x| (-x).exp());
        let lookups = poisson(collisions);
        Self { powers: [1.0, a, b, c, d], eighth, lookups, through: lookups }
    }

    /// 1 with chance `e^{−τ}`, else 0, by delta tracking through `∫σ̄ = flown`; `factorial[k − 1]` is
    /// `E[N (N − 1) … (N − k + 1)]`.
    ///
    /// ```text
    /// E[N (N − 1) … (N − k + 1)] = k ∫ σ̄ e^{−τ(t)} (∫₀ᵗ σ̄ − τ(t))^{k−1} dt
    /// ```
    #[must_use]
    pub fn decided(depth: f64, flown: f64, factorial: [f64; 4]) -> Self {
        let chance = (-depth).exp();
        let [f1, f2, f3, f4] = factorial;
        let lookups = [1.0, f1, f2 + f1, f3 + 3.0 * f2 + f1, f4 + 6.0 * f3 + 7.0 * f2 + f1];
        // What does not end a walk is a Poisson number of null collisions.
        let through = poisson(flown - depth).map(|moment| chance * moment);
        Self { powers: [1.0, chance, chance, chance, chance], eighth: chance, lookups, through }
    }

    /// Of a shadow ray.
    #[must_use]
    pub fn of_shadow(tracking: Tracking, medium: Option<&Medium>, rule: &GaussLegendre) -> Self {
        let Some(medium) = medium else { return Self::exact(0.0) };
        let support = medium.support();
        let depth = medium.optical_depth(support).value;
        match tracking {
            Tracking::Exact => Self::exact(depth),
            Tracking::Ratio { sampling, control } => {
                let loss = |_: f64, sigma: f64| {
                    let weight = 1.0 - (sigma - control) / sampling;
                    POWERS.map(|k| f64::from(k) * control + sampling * (1.0 - weight.powi(k)))
                };
                let mut exponents = along(medium, rule, loss);
                exponents[0] = depth;
                Self::product(exponents, sampling * support.length())
            }
            Tracking::Delta { sampling } => {
                let factorial = along(medium, rule, |t, _| {
                    let depth = medium.optical_depth(Span::new(support.from, t)).value;
                    let nulls = sampling * (t - support.from) - depth;
                    let alive = sampling * (-depth).exp();
                    [1, 2, 3, 4].map(|k| f64::from(k) * alive * nulls.powi(k - 1))
                });
                Self::decided(depth, sampling * support.length(), factorial)
            }
        }
    }
}

/// `E[N^k]`, k = 0 … 4, of a Poisson number.
#[must_use]
pub fn poisson(m: f64) -> [f64; 5] {
    [1.0, m, m * (1.0 + m), m * (1.0 + m * (3.0 + m)), m * (1.0 + m * (7.0 + m * (6.0 + m)))]
}

/// `E[(M + N)^k]`, k = 0 … 4, of independent numbers.
#[must_use]
pub fn added(a: [f64; 5], b: [f64; 5]) -> [f64; 5] {
    const PASCAL: [[f64; 5]; 5] = [
        [1.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 1.0, 0.0, 0.0, 0.0],
        [1.0, 2.0, 1.0, 0.0, 0.0],
        [1.0, 3.0, 3.0, 1.0, 0.0],
        [1.0, 4.0, 6.0, 4.0, 1.0],
    ];
    std::array::from_fn(|k| (0..=k).map(|j| PASCAL[k][j] * a[k - j] * b[j]).sum())
}

/// Halvings of the panels at most.
const HALVINGS: u32 = 6;
/// Two resolutions that agree to this are enough: halving a panel of 16 nodes divides the error by
/// 2³², so that the finer one is then good to rounding.
const AGREED: f64 = 1e-11;

/// `∫ f(t, σ_t)` over the support of a medium: Gauss panels between its breaks, halved together until
/// two resolutions agree.
fn along<const N: usize>(
    medium: &Medium,
    rule: &GaussLegendre,
    f: impl Fn(f64, f64) -> [f64; N],
) -> [f64; N] {
    let support = medium.support();
    let mut ends = medium.breaks();
    ends.retain(|&t| support.contains_inside(t));
    ends.extend([support.from, support.to]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let at = |parts: u32| {
        let mut sum = [0.0; N];
        let mut nodes = Vec::with_capacity(rule.nodes.len());
        for pair in ends.windows(2) {
            let step = (pair[1] - pair[0]) / f64::from(parts);
            for part in 0..parts {
                let from = pair[0] + f64::from(part) * step;
                nodes.clear();
                nodes.extend(rule.nodes.iter().map(|x| from + x * step));
                let sigma = medium.extinctions(&nodes);
                for ((&t, &sigma), &weight) in nodes.iter().zip(&sigma).zip(&rule.weights) {
                    let values = f(t, sigma);
                    sum.iter_mut().zip(values).for_each(|(sum, x)| *sum += weight * step * x);
                }
            }
        }
        sum
    };
    let mut coarse = at(1);
    for halving in 1..=HALVINGS {
        let fine = at(1 << halving);
        let agree = |(a, b): (&f64, &f64)| (a - b).abs() <= AGREED * b.abs().max(1.0);
        if coarse.iter().zip(&fine).all(agree) {
            return fine;
        }
        coarse = fine;
    }
    coarse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_a_poisson_number_add_like_means() {
        let sum = added(poisson(0.7), poisson(1.9));
        for (a, b) in sum.iter().zip(poisson(2.6)) {
            assert!((a - b).abs() < 1e-13 * b);
        }
    }

    #[test]
    fn delta_tracking_of_a_homogeneous_segment() {
        // σ = σ̄ = 1: the first collision ends every walk, so N is 1 with chance 1 − e^{−τ}.
        let length: f64 = 1.5;
        let first = 1.0 - (-length).exp();
        let passage = Passage::decided(length, length, [first, 0.0, 0.0, 0.0]);
        assert_eq!(passage.lookups, [1.0, first, first, first, first]);
        assert_eq!(passage.through[1..], [0.0; 4]);
        assert_eq!(passage.through[0], passage.powers[1]);
    }
}
