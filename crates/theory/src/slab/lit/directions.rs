//! Directions to a light from a depth of the slab, for integrals over them.
//!
//! With the uniform number u by which a shadow ray chooses its direction,
//!
//! ```text
//! E[f(chosen)] = ∫₀¹ f du,   E[f(drawn); it meets the light] = ∫₀¹ f q du,   q = p/p_nee
//! ```
//!
//! Panels narrow towards the singularities of integrands: `(1 − g)²/(2g)` beyond straight on, for a phase function
//! that peaks there; at grazing directions of a cap; at the disc itself.

use crate::problems::LitSlab;
use crate::problems::lit_slab::LightBehind;
use media::phase::Phase;
use numeric::Span;
use numeric::quadrature::GaussLegendre;

/// A direction to the light.
#[derive(Debug, Clone, Copy)]
pub struct Direction {
    /// Cosine with the normal.
    pub cosine: f64,
    /// q.
    pub ratio: f64,
    /// du.
    pub weight: f64,
}

/// Resolution of directions and depths.
pub struct LitResolution {
    rule: GaussLegendre,
    /// Factor by which panels grow away from a singularity.
    pub growth: f64,
    /// Maximum optical depth of a panel, in the lowest direction.
    pub depth: f64,
}

impl LitResolution {
    /// Resolution of answers.
    pub fn fine() -> Self {
        Self { rule: GaussLegendre::new(16), growth: 2.0, depth: 1.0 }
    }

    /// Coarser resolution, for error bounds.
    pub fn coarse() -> Self {
        Self { rule: GaussLegendre::new(12), growth: 2.5, depth: 2.0 }
    }

    /// `scale (growth^k − 1)`, k = 1, 2 …, below a bound.
    pub fn away(&self, scale: f64, bound: f64) -> Vec<f64> {
        let grown = |size: &f64| Some(size * self.growth);
        let sizes = std::iter::successors(Some(scale * self.growth), grown);
        let places = sizes.map(|size| size - scale).take_while(|&place| place < bound);
        if scale > 0.0 { places.collect() } else { Vec::new() }
    }

    /// Directions from a point at the distance `before` to the end of the slab.
    pub fn directions(&self, problem: &LitSlab, before: f64) -> Vec<Direction> {
        let LitSlab { phase, light, .. } = *problem;
        let at = |number: f64, weight: f64| {
            let [cosine, spread] = light.chosen(number, before);
            Direction { cosine, ratio: phase.value(cosine) * spread, weight }
        };
        if !light.can_be_hit() {
            return vec![at(0.5, 1.0)];
        }
        let peak = peak(&phase).map_or_else(Vec::new, |scale| self.away(scale, 1.0));
        let cuts = match light {
            LightBehind::Cap(lowest) => {
                let grazing = self.away(lowest, 1.0 - lowest).into_iter();
                let beside = peak.into_iter().map(|off| 1.0 - off - lowest);
                grazing.chain(beside).map(|above| above / (1.0 - lowest)).collect()
            }
            LightBehind::Disc { distance, radius } => {
                let scale = ((before + distance) / radius).powi(2);
                let beside = peak.into_iter().map(|off| scale * ((1.0 - off).powi(-2) - 1.0));
                self.away(scale, 1.0).into_iter().chain(beside).collect()
            }
            LightBehind::Distant(_) | LightBehind::Point(_) => Vec::new(),
        };
        let ends = Span::new(0.0, 1.0).cut(cuts);
        let nodes = Span::between(&ends).flat_map(|panel| self.rule.on(panel));
        nodes.map(|(number, weight)| at(number, weight)).collect()
    }
}

/// Distance beyond straight on of the singularity of a phase function.
fn peak(phase: &Phase) -> Option<f64> {
    let Phase::HenyeyGreenstein(page) = phase else { return None };
    let g = page.g();
    (g > 0.0).then(|| (1.0 - g) * (1.0 - g) / (2.0 * g))
}
