//! Numbers of scatterings after which light leaves a slab of isotropic scattering that absorbs nothing.
//!
//! ```text
//! C_1(u) = e^{−u/μ₀}/μ₀, or 2E₂(u) of light from all sides;   C_{r+1}(u) = ½ ∫₀^τ E₁(|u − u'|) C_r(u') du'
//! R_r = ½ ∫ E₂(u) C_r du,   T_r = ½ ∫ E₂(τ − u) C_r du,   T_0 = e^{−τ/μ₀}, or 2E₃(τ)
//! ```
//!
//! `C_r` is the density of r-th collisions. Panels shrink towards both ends, where C is like `u ln u`. Between the
//! nodes of a panel it is a polynomial, and next to the logarithm of E₁ the quadrature is finer by the fourth
//! power. Errors are 1e-12 and a few 1e-15 for each order. The sum over all orders shows them: everything leaves.
//!
//! Source: R. E. Peierls, *Critical conditions in neutron multiplication*, Mathematical Proceedings of the Cambridge
//! Philosophical Society 35 (1939); K. M. Case, P. F. Zweifel, *Linear Transport Theory* (1967).

use super::IncidentLight;
use numeric::quadrature::GaussLegendre;
use numeric::{Span, exponential_integrals, order};

/// Nodes of a panel.
const NODES: usize = 16;
/// Maximum thickness of a panel.
const THICKEST: f64 = 0.5;
/// Number of panels towards both ends, each a quarter of the one before.
const SHRINKS: i32 = 12;
/// Maximum depth: thicker slabs have too many orders.
const DEEPEST: f64 = 8.0;
/// Orders of scattering that are rarer than this do not count.
const RARE: f64 = 1e-17;
/// Maximum number of orders of scattering.
const MAX_ORDERS: usize = 4096;

/// A slab cut into panels.
struct Panels {
    depth: f64,
    cut: Vec<Span>,
    rule: GaussLegendre,
    finer: GaussLegendre,
}

impl Panels {
    fn new(depth: f64) -> Self {
        let (rule, finer) = (GaussLegendre::new(NODES), GaussLegendre::new(40));
        let scale = THICKEST.min(0.5 * depth);
        let mut ends = vec![0.0, depth];
        for shrink in 0..=SHRINKS {
            let near = scale * 0.25f64.powi(shrink);
            ends.extend([near, depth - near]);
        }
        let between = depth - 2.0 * scale;
        let parts = (between / THICKEST).ceil();
        let cuts = std::iter::successors(Some(1.0), |part| Some(part + 1.0));
        ends.extend(
            cuts.take_while(|&part| part < parts).map(|part| scale + between * part / parts),
        );
        order::ascend(&mut ends);
        ends.dedup_by(|a, b| *a - *b < 1e-14 * depth);
        Self { depth, cut: Span::between(&ends).collect(), rule, finer }
    }

    /// Depths and weights of all nodes.
    fn nodes(&self) -> Vec<(f64, f64)> {
        self.cut.iter().flat_map(|&panel| self.rule.on(panel)).collect()
    }

    /// `½ ∫ E₁(|u − u'|) ℓ du'` over a panel, of all its polynomials.
    fn coupled(&self, depth: f64, panel: Span) -> [f64; NODES] {
        let mut sums = [0.0; NODES];
        let away = (panel.from - depth).max(depth - panel.to);
        if away > panel.length() {
            for (sum, (node, weight)) in sums.iter_mut().zip(self.rule.on(panel)) {
                *sum = 0.5 * weight * exponential_integrals((node - depth).abs())[0];
            }
            return sums;
        }
        let nearest = depth.clamp(panel.from, panel.to);
        for end in [panel.from, panel.to] {
            let length = end - nearest;
            for (v, weight) in self.finer.nodes.iter().zip(&self.finer.weights) {
                let off = length * v.powi(4);
                let [first, _] = exponential_integrals((nearest - depth + off).abs());
                let share = 2.0 * weight * length.abs() * v.powi(3) * first;
                let basis = self.rule.weights_at((nearest + off - panel.from) / panel.length());
                for (sum, basis) in sums.iter_mut().zip(basis) {
                    *sum += share * basis;
                }
            }
        }
        sums
    }
}

/// The probabilities to leave a slab of an optical depth without absorption after r scatterings, reflected and
/// transmitted; `None` where there are too many.
pub fn orders(light: IncidentLight, depth: f64) -> Option<Vec<[f64; 2]>> {
    if depth <= 0.0 || depth > DEEPEST {
        return None;
    }
    let slab = Panels::new(depth);
    let nodes = slab.nodes();
    let kernel: Vec<f64> = nodes
        .iter()
        .flat_map(|&(u, _)| slab.cut.iter().map(move |&panel| (u, panel)))
        .flat_map(|(u, panel)| slab.coupled(u, panel))
        .collect();
    let escape: Vec<[f64; 2]> = nodes
        .iter()
        .map(|&(u, weight)| [u, slab.depth - u].map(|u| 0.5 * weight * exponential_integrals(u)[1]))
        .collect();
    let (unscattered, first): (f64, &dyn Fn(f64) -> f64) = match light {
        IncidentLight::Collimated(cosine) => {
            ((-depth / cosine).exp(), &move |u: f64| (-u / cosine).exp() / cosine)
        }
        // 2E₃ = e^{−τ} − τ E₂.
        IncidentLight::Diffuse => {
            let passed = (-depth).exp() - depth * exponential_integrals(depth)[1];
            (passed, &|u: f64| 2.0 * exponential_integrals(u)[1])
        }
    };
    let mut collisions: Vec<f64> = nodes.iter().map(|&(u, _)| first(u)).collect();
    let mut result = vec![[0.0, unscattered]];
    while result.len() < MAX_ORDERS {
        let leaves = |end: usize| -> f64 {
            collisions.iter().zip(&escape).map(|(c, escape)| c * escape[end]).sum()
        };
        let order = [leaves(0), leaves(1)];
        result.push(order);
        if order[0] + order[1] < RARE {
            return Some(result);
        }
        let again = kernel.chunks(nodes.len());
        collisions =
            again.map(|row| row.iter().zip(&collisions).map(|(k, c)| k * c).sum()).collect();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slab::answers;
    use media::phase::Phase;
    use media::phase::isotropic::Isotropic;
    use numeric::Known;

    #[test]
    fn orders_sum_to_what_adding_and_doubling_says() {
        let phase = Phase::Isotropic(Isotropic);
        for light in
            [IncidentLight::Collimated(0.5), IncidentLight::Collimated(1.0), IncidentLight::Diffuse]
        {
            for depth in [0.05, 1.45, 6.0] {
                let orders = orders(light, depth).expect("few");
                let all: f64 = orders.iter().flatten().sum();
                assert!((all - 1.0).abs() < 1e-11, "{light:?}, {depth}: {:e}", all - 1.0);
                for albedo in [0.3, 0.9] {
                    let sum = |end: usize| {
                        orders.iter().rev().fold(0.0, |sum, order| sum * albedo + order[end])
                    };
                    let known = Known::exact(depth);
                    let answer = answers(&phase, &[light], known, albedo).expect("finite")[0];
                    for (end, exact) in [answer.reflected, answer.transmitted].iter().enumerate() {
                        let off = (sum(end) - exact.value).abs();
                        assert!(off < 1e-11 + exact.error, "{light:?}, {depth}, {albedo}: {off:e}");
                    }
                }
            }
        }
    }
}
