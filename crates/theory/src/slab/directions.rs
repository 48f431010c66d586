//! Directions in a slab: a quadrature for cosines, and scattering between them.

use media::phase::Phase;
use numeric::matrix::Matrix;
use numeric::quadrature::{GaussLegendre, legendre};

/// Legendre moments below this, with their factor `2l + 1`, are left out.
const FAINT: f64 = 1e-17;
/// Maximum number of Legendre moments.
const MAX_MOMENTS: usize = 4000;
/// Number of negligible Legendre moments after which no other follows.
const GAP: usize = 64;
/// Maximum number of directions: more take seconds.
const MAX_DIRECTIONS: usize = 144;

/// The cosines `μ = x²` of Gauss–Legendre nodes x, dense where light grazes the slab, and further cosines of
/// incidence, from which light may come but into which no light is scattered.
///
/// ```text
/// P±ᵢⱼ = ½ p(±μᵢ, μⱼ) wⱼ,   p(μ, μ') = Σ_l (2l + 1) χ_l P_l(μ) P_l(μ'),   Σⱼ (P⁺ᵢⱼ + P⁻ᵢⱼ) = 1
/// ```
pub struct Directions {
    /// The cosines: first those of the quadrature, then the further ones.
    pub cosines: Vec<f64>,
    /// The weights of the quadrature.
    pub weights: Vec<f64>,
    /// P⁺: scattered on through the slab.
    pub onward: Matrix,
    /// P⁻: scattered back.
    pub back: Matrix,
}

impl Directions {
    /// A quadrature of `count` cosines, and further cosines of incidence. The share `peak` of the phase function, which
    /// goes straight on, is cut off.
    pub fn new(phase: &Phase, count: usize, further: &[f64], peak: f64) -> Self {
        let rule = GaussLegendre::new(count);
        let mut cosines: Vec<f64> = rule.nodes.iter().map(|x| x * x).collect();
        let weights: Vec<f64> =
            rule.nodes.iter().zip(&rule.weights).map(|(x, weight)| 2.0 * x * weight).collect();
        cosines.extend(further);
        let mut moments = moments(phase);
        if peak > 0.0 {
            moments.truncate(2 * count);
            for (l, moment) in moments.iter_mut().enumerate() {
                *moment = (*moment - (2 * l + 1) as f64 * peak) / (1.0 - peak);
            }
        }
        let legendre: Vec<Vec<f64>> =
            cosines.iter().map(|&x| legendre(x).take(moments.len()).collect()).collect();
        // Even and odd orders apart: the sum of both is p(μ, μ'), the difference p(−μ, μ').
        let parts = |i: usize, j: usize| {
            let (mut even, mut odd) = (0.0, 0.0);
            for (l, moment) in moments.iter().enumerate().rev() {
                let term = moment * legendre[i][l] * legendre[j][l];
                if l % 2 == 0 { even += term } else { odd += term }
            }
            [0.5 * weights[j] * (even + odd), 0.5 * weights[j] * (even - odd)]
        };
        let rows: Vec<Vec<[f64; 2]>> =
            (0..cosines.len()).map(|i| (0..count).map(|j| parts(i, j)).collect()).collect();
        // The quadrature has errors where it does not resolve the phase function; conservation of energy is
        // enforced.
        let sum = |row: &Vec<[f64; 2]>| row.iter().map(|[onward, back]| onward + back).sum();
        let whole: Vec<f64> = rows.iter().map(sum).collect();
        let [onward, back] =
            [0, 1].map(|side| Matrix::new(rows.len(), count, |i, j| rows[i][j][side] / whole[i]));
        Self { cosines, weights, onward, back }
    }

    /// Number of cosines of the quadrature.
    pub fn count(&self) -> usize {
        self.weights.len()
    }
}

/// `(2l + 1) χ_l` up to the last that is not negligible: [`GAP`] negligible ones follow it.
fn moments(phase: &Phase) -> Vec<f64> {
    let (mut all, mut count) = (Vec::new(), 1);
    for l in 0..MAX_MOMENTS {
        let moment = (2 * l + 1) as f64 * phase.moment(l);
        all.push(moment);
        if moment.abs() >= FAINT {
            count = l + 1;
        } else if l > count + GAP {
            break;
        }
    }
    all.truncate(count);
    all
}

/// Number of cosines that resolve a phase function down to moments of the given size: measured errors of
/// reflectances fall like `g^{2n}`.
pub fn needed(phase: &Phase, faintest: f64) -> usize {
    let last =
        (0..2 * MAX_DIRECTIONS).rposition(|l| phase.moment(l).abs() >= faintest).unwrap_or(0);
    (last / 2 + 1).min(MAX_DIRECTIONS)
}

/// Returns whether `count` directions, and no more than the maximum, resolve a phase function.
pub fn are_enough(phase: &Phase, faintest: f64, count: usize) -> bool {
    phase.moment(2 * count.min(MAX_DIRECTIONS)).abs() < faintest
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::phase::{henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic};

    #[test]
    fn sharper_phase_functions_need_more_directions() {
        let of = |g: f64| Phase::HenyeyGreenstein(HenyeyGreenstein::new(g).expect("in range"));
        assert_eq!(needed(&Phase::Isotropic(Isotropic), 1e-12), 1);
        assert!(needed(&of(0.75), 1e-12) < needed(&of(0.9), 1e-12));
        assert_eq!(needed(&of(0.999), 1e-12), MAX_DIRECTIONS);
        assert!(
            are_enough(&of(0.9), 1e-12, MAX_DIRECTIONS)
                && !are_enough(&of(-0.95), 1e-12, MAX_DIRECTIONS)
        );
        assert!(!are_enough(&of(0.9), 1e-12, 100));
    }
}
