//! Slabs of isotropic scattering by discrete ordinates in 32 digits.
//!
//! The equations of N directions have solutions that fall and grow like `e^{±kt}`, one to each root k of a
//! secular equation: depth enters exactly, and nothing is added or doubled. Beyond an albedo of 1, as of
//! moments of walks, the slowest of them swings.
//!
//! ```text
//! a Σ wᵢ/(1 − k²μᵢ²) = 1,   J(t) = Σⱼ αⱼ e^{−kⱼt} + βⱼ e^{−kⱼ(τ−t)},   I = 1 above, I = 0 below
//! a > 1:  a Σ wᵢ/(1 + ν²μᵢ²) = 1,   ½A cos(ν(τ/2 − t)) + ½B sin(ν(τ/2 − t)) in place of k₁
//! R(μ₀) = ∫ J(t) e^{−t/μ₀} dt/μ₀,   T(μ₀) = e^{−τ/μ₀} + ∫ J(t) e^{−(τ−t)/μ₀} dt/μ₀
//! ```
//!
//! Light from all sides (I = 1) answers for a ray from μ₀, because paths can be turned round. The roots
//! lie between `1/μ` of neighbours and are bisected in 32 digits, in which the linear equations are
//! solved, too.
//!
//! Source: S. Chandrasekhar, *Radiative Transfer* (Oxford University Press, 1950), chapters 2, 3 and 7.

use crate::numeric::Wide;
use crate::numeric::quadrature::GaussLegendre;
use crate::problems::slab::Light;

/// Directions and the solutions in them.
pub struct Ordinates {
    depth: Wide,
    cosines: Vec<Wide>,
    weights: Vec<Wide>,
    /// ν, A and B.
    swing: Option<[Wide; 3]>,
    /// k, α and β.
    parts: Vec<[Wide; 3]>,
}

/// The sine and the cosine of half a slab's swing, and ν.
fn half_way(nu: Wide, depth: Wide) -> [Wide; 2] {
    (nu * depth).scaled(-1).sin_cos()
}

impl Ordinates {
    /// `None` where the linear equations have no solution.
    pub fn new(depth: Wide, albedo: Wide, count: usize) -> Option<Self> {
        let (cosines, weights) = directions(count);
        let mut roots = roots(albedo, &cosines, &weights);
        let nu = (albedo.high > 1.0).then(|| {
            roots.remove(0);
            swing(albedo, &cosines, &weights)
        });
        // Light from both sides alike, and of opposite signs: their halves add up to that from above.
        let solutions = [Wide::ONE, -Wide::ONE].map(|sign| {
            let entry = |mu: Wide, k: Wide| {
                let far = (-(k * depth)).exp() / (Wide::ONE + k * mu);
                Wide::ONE / (Wide::ONE - k * mu) + sign * far
            };
            let swinging = |mu: Wide, nu: Wide| {
                let ([sine, cosine], x) = (half_way(nu, depth), nu * mu);
                let size = Wide::ONE + x * x;
                if sign.high > 0.0 {
                    (cosine - x * sine) / size
                } else {
                    (sine + x * cosine) / size
                }
            };
            let row = |&mu: &Wide| {
                let first = nu.iter().map(|&nu| swinging(mu, nu));
                let entries = roots.iter().map(|&k| entry(mu, k));
                first.chain(entries).chain([Wide::ONE]).collect()
            };
            solved(cosines.iter().map(row).collect())
        });
        let [same, opposite] = solutions;
        let (mut same, mut opposite) = (same?, opposite?);
        let swing = nu.map(|nu| [nu, same.remove(0), opposite.remove(0)]);
        let parts = roots.iter().zip(same).zip(opposite);
        let parts = parts.map(|((&k, a), b)| [k, (a + b).scaled(-1), (a - b).scaled(-1)]).collect();
        Some(Self { depth, cosines, weights, swing, parts })
    }

    /// Whether more than one particle follows each, unless the slab is thin.
    pub fn swings(&self) -> bool {
        self.swing.is_some()
    }

    /// Whether J is positive: it is not where more than one particle follows each.
    pub fn is_positive(&self) -> bool {
        const PLACES: u32 = 64;
        (0..=PLACES).all(|i| {
            let t = self.depth * Wide::from(f64::from(i) / f64::from(PLACES));
            let rest = self.depth - t;
            let swinging = self.swing.map(|[nu, a, b]| {
                let [sine, cosine] = (nu * (rest - t)).scaled(-1).sin_cos();
                (a * cosine + b * sine).scaled(-1)
            });
            let part = |&[k, alpha, beta]: &[Wide; 3]| {
                alpha * (-(k * t)).exp() + beta * (-(k * rest)).exp()
            };
            let sum: Wide = self.parts.iter().map(part).chain(swinging).sum();
            sum.high > 0.0
        })
    }

    /// R and T of a ray.
    fn leaving(&self, cosine: Wide) -> [Wide; 2] {
        let straight = (-(self.depth / cosine)).exp();
        let mut leaving = [Wide::default(), straight];
        if let Some([nu, a, b]) = self.swing {
            let ([sine, swung], x) = (half_way(nu, self.depth), nu * cosine);
            let size = (Wide::ONE + x * x).scaled(1);
            let (less, more) = (Wide::ONE - straight, Wide::ONE + straight);
            let even = a * (swung * less + x * sine * more) / size;
            let odd = b * (sine * more - x * swung * less) / size;
            leaving[0] += even + odd;
            leaving[1] += even - odd;
        }
        for &[k, alpha, beta] in &self.parts {
            let faint = (-(k * self.depth)).exp();
            let near = (Wide::ONE - faint * straight) / (Wide::ONE + k * cosine);
            let away = Wide::ONE - k * cosine;
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
    pub fn energy(&self, light: Light) -> [Wide; 2] {
        if let Light::Collimated(cosine) = light {
            return self.leaving(Wide::from(cosine));
        }
        let mut sums = [Wide::default(); 3];
        for (&mu, &weight) in self.cosines.iter().zip(&self.weights) {
            let [r, t] = self.leaving(mu);
            for (sum, x) in sums.iter_mut().zip([r, t, Wide::ONE]) {
                *sum += mu * weight * x;
            }
        }
        [sums[0] / sums[2], sums[1] / sums[2]]
    }
}

/// ν of an albedo above 1.
fn swing(albedo: Wide, cosines: &[Wide], weights: &[Wide]) -> Wide {
    let left = |nu: Wide| {
        let term = |(&mu, &w): (&Wide, &Wide)| w / (Wide::ONE + (nu * mu).powi(2));
        Wide::ONE - albedo * cosines.iter().zip(weights).map(term).sum::<Wide>()
    };
    let (mut low, mut high) = (Wide::default(), Wide::ONE);
    while left(high).high < 0.0 {
        high = high.scaled(1);
    }
    for _ in 0..110 {
        let middle = (low + high).scaled(-1);
        if left(middle).high < 0.0 { low = middle } else { high = middle }
    }
    (low + high).scaled(-1)
}

/// `μ = x³` of Gauss' nodes, dense where light grazes, from the steepest to the most grazing, and weights.
pub(super) fn directions(count: usize) -> (Vec<Wide>, Vec<Wide>) {
    let rule = GaussLegendre::new(count);
    let nodes = rule.nodes.iter().zip(&rule.weights).rev();
    let (cosines, weights): (Vec<Wide>, Vec<Wide>) = nodes
        .map(|(&x, &w)| (Wide::from(x).powi(3), Wide::from(3.0 * w) * Wide::from(x).powi(2)))
        .unzip();
    let whole: Wide = weights.iter().copied().sum();
    (cosines, weights.into_iter().map(|w| w / whole).collect())
}

/// One k between 0 and the first `1/μ`, and one between each two.
pub(super) fn roots(albedo: Wide, cosines: &[Wide], weights: &[Wide]) -> Vec<Wide> {
    let left = |k: Wide| {
        let term = |(&mu, &w): (&Wide, &Wide)| w / (Wide::ONE - (k * mu).powi(2));
        Wide::ONE - albedo * cosines.iter().zip(weights).map(term).sum::<Wide>()
    };
    let mut from = Wide::default();
    let between = cosines.iter().map(|&mu| {
        let (mut low, mut high) = (from, Wide::ONE / mu);
        from = high;
        for _ in 0..110 {
            let middle = (low + high).scaled(-1);
            if left(middle).high > 0.0 { low = middle } else { high = middle }
        }
        (low + high).scaled(-1)
    });
    between.collect()
}

/// The solution of equations whose rows end with their right sides, by elimination with the largest pivot
/// of a column.
pub(super) fn solved(mut rows: Vec<Vec<Wide>>) -> Option<Vec<Wide>> {
    let n = rows.len();
    for column in 0..n {
        let size = |i: &usize| rows[*i][column].high.abs();
        let pivot = (column..n).max_by(|i, j| size(i).total_cmp(&size(j)))?;
        rows.swap(column, pivot);
        let (done, below) = rows.split_at_mut(column + 1);
        let first = &done[column];
        if first[column].high == 0.0 {
            return None;
        }
        for row in below {
            let factor = row[column] / first[column];
            for (x, &y) in row.iter_mut().zip(first).skip(column) {
                *x = *x - factor * y;
            }
        }
    }
    let mut solution = vec![Wide::default(); n];
    for i in (0..n).rev() {
        let known: Wide = (i + 1..n).map(|j| rows[i][j] * solution[j]).sum();
        solution[i] = (rows[i][n] - known) / rows[i][i];
    }
    Some(solution)
}
