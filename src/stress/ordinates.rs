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

/// A root that doubles find is so near, relative.
const NEAR: f64 = 1e-12;
/// The most of Newton's steps.
const STEPS: u32 = 8;

/// Directions and the solutions in them.
pub struct Ordinates {
    depth: Wide,
    cosines: Vec<Wide>,
    weights: Vec<Wide>,
    swing: Option<Swing>,
    /// k, α, β and `e^{−kτ}`.
    parts: Vec<[Wide; 4]>,
}

/// The solution that swings.
struct Swing {
    /// ν.
    rate: Wide,
    /// The sine and the cosine of ντ/2.
    half_way: [Wide; 2],
    /// A and B.
    sizes: [Wide; 2],
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
        let faint: Vec<Wide> = roots.iter().map(|&k| (-(k * depth)).exp()).collect();
        let half_way = nu.map(|nu| (nu * depth).scaled(-1).sin_cos());
        // Light from both sides alike, and of opposite signs: their halves add up to that from above.
        let solutions = [Wide::ONE, -Wide::ONE].map(|sign| {
            let entry = |mu: Wide, k: Wide, faint: Wide| {
                let far = faint / (Wide::ONE + k * mu);
                Wide::ONE / (Wide::ONE - k * mu) + sign * far
            };
            let swinging = |mu: Wide, nu: Wide, [sine, cosine]: [Wide; 2]| {
                let x = nu * mu;
                let size = Wide::ONE + x * x;
                let turned = [cosine - x * sine, sine + x * cosine];
                turned[usize::from(sign.high < 0.0)] / size
            };
            let row = |&mu: &Wide| {
                let first = nu.zip(half_way).map(|(nu, half_way)| swinging(mu, nu, half_way));
                let entries = roots.iter().zip(&faint).map(|(&k, &faint)| entry(mu, k, faint));
                first.into_iter().chain(entries).chain([Wide::ONE]).collect()
            };
            solved(cosines.iter().map(row).collect())
        });
        let [same, opposite] = solutions;
        let (mut same, mut opposite) = (same?, opposite?);
        let swing = nu.zip(half_way).map(|(nu, half_way)| Swing {
            rate: nu,
            half_way,
            sizes: [same.remove(0), opposite.remove(0)],
        });
        let parts = roots.iter().zip(faint).zip(same.into_iter().zip(opposite));
        let part = |((&k, faint), (a, b)): ((&Wide, Wide), (Wide, Wide))| {
            [k, (a + b).scaled(-1), (a - b).scaled(-1), faint]
        };
        let parts = parts.map(part).collect();
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
            let swinging = self.swing.as_ref().map(|swing| {
                let [a, b] = swing.sizes;
                let [sine, cosine] = (swing.rate * (rest - t)).scaled(-1).sin_cos();
                (a * cosine + b * sine).scaled(-1)
            });
            let part = |&[k, alpha, beta, _]: &[Wide; 4]| {
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
        if let Some(Swing { rate, half_way: [sine, swung], sizes: [a, b] }) = self.swing {
            let x = rate * cosine;
            let size = (Wide::ONE + x * x).scaled(1);
            let (less, more) = (Wide::ONE - straight, Wide::ONE + straight);
            let even = a * (swung * less + x * sine * more) / size;
            let odd = b * (sine * more - x * swung * less) / size;
            leaving[0] += even + odd;
            leaving[1] += even - odd;
        }
        for &[k, alpha, beta, faint] in &self.parts {
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

/// One k between 0 and the first `1/μ`, and one between each two: bisected in doubles and found by Newton's
/// steps from there, or bisected in 32 digits where doubles do not tell it from a `1/μ`.
pub(super) fn roots(albedo: Wide, cosines: &[Wide], weights: &[Wide]) -> Vec<Wide> {
    let left = |k: Wide| {
        let term = |(&mu, &w): (&Wide, &Wide)| w / (Wide::ONE - (k * mu).powi(2));
        Wide::ONE - albedo * cosines.iter().zip(weights).map(term).sum::<Wide>()
    };
    let rough = |k: f64| {
        let term = |(mu, w): (&Wide, &Wide)| w.high / (1.0 - (k * mu.high).powi(2));
        1.0 - albedo.high * cosines.iter().zip(weights).map(term).sum::<f64>()
    };
    let step = |k: Wide| {
        let (mut sum, mut slope) = (Wide::default(), Wide::default());
        for (&mu, &w) in cosines.iter().zip(weights) {
            let inverse = Wide::ONE / (Wide::ONE - (k * mu).powi(2));
            sum += w * inverse;
            slope += w * (inverse * mu).powi(2);
        }
        (Wide::ONE - albedo * sum) / (albedo * slope * k).scaled(1)
    };
    let mut from = Wide::default();
    let between = cosines.iter().map(|&mu| {
        let (mut low, mut high) = (from, Wide::ONE / mu);
        from = high;
        let mut ends = [low.high, high.high];
        for _ in 0..60 {
            let middle = 0.5 * (ends[0] + ends[1]);
            ends[usize::from(rough(middle) <= 0.0)] = middle;
        }
        let near = [1.0 - NEAR, 1.0 + NEAR].map(|x| Wide::from(ends[0]) * Wide::from(x));
        let is_between = near[0].high > low.high && near[1].high < high.high;
        if is_between && left(near[0]).high > 0.0 && left(near[1]).high < 0.0 {
            let mut root = Wide::from(ends[0]);
            for _ in 0..STEPS {
                let more = step(root);
                root += more;
                let is_inside = near[0].high <= root.high && root.high <= near[1].high;
                if is_inside && more.high.abs() <= 1e-24 * root.high {
                    return root;
                }
            }
        }
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
