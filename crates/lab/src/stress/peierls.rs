//! Slabs of isotropic scattering with rates that vary, by Peierls' equation on panels of depth.
//!
//! What light scattered at x is worth that leaves on top is ½E₂ of the optical depth above it, or scatters
//! again; below likewise. Between the nodes of a panel it is a polynomial; next to the logarithm of E₁ the
//! quadrature is finer by the fourth power.
//!
//! ```text
//! W(x) = ½E₂(u(x)) + ½ ∫ E₁(|u(x) − u(x')|) s(x') W(x') dx',   u = ∫ l dx,  l = σ̂(1 − Q),  s = σ̂ S
//! R(μ₀) = ∫ e^{−u/μ₀} s W dx/μ₀,   of light from all sides with 2E₂(u) in place of e^{−u/μ₀}/μ₀
//! ```

use super::prelude::*;
use super::series::solved;
use numeric::exponential_integrals as exponentials;
use theory::problems::slab::Light;

/// Nodes of a panel.
const NODES: usize = 7;
/// Panels are optically no thicker.
const THICKEST: f64 = 1.0;
/// Number of times that panels shrink to a quarter towards both ends, where W is like `u ln u`.
const SHRINKS: i32 = 7;

/// l and s of a slab from 0 to 1.
pub type Rates<'a> = dyn Fn(f64) -> [f64; 2] + 'a;

struct Panel {
    x: Span,
    /// u at its beginning.
    depth: f64,
    /// Growth of u.
    width: f64,
}

/// A slab cut into panels.
pub struct Peierls<'a> {
    rates: &'a Rates<'a>,
    panels: Vec<Panel>,
    rule: GaussLegendre,
    finer: GaussLegendre,
    /// One over the products of a node's distances from the others.
    barycentric: Vec<f64>,
    depth: f64,
}

impl<'a> Peierls<'a> {
    /// Cut at the given places inside.
    pub fn new(rates: &'a Rates<'a>, breaks: &[f64]) -> Self {
        let (rule, finer) = (GaussLegendre::new(NODES), GaussLegendre::new(24));
        let mut ends = vec![0.0, 0.5, 1.0];
        ends.extend(breaks);
        for shrink in 1..=SHRINKS {
            let near = 0.25f64.powi(shrink);
            ends.extend([near, 1.0 - near]);
        }
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let over = |from: f64, to: f64| finer.integrate(from, to, |x| rates(x)[0]);
        let mut panels = Vec::new();
        let mut depth = 0.0;
        for pair in ends.windows(2) {
            let parts = (over(pair[0], pair[1]) / THICKEST).ceil().max(1.0);
            let step = (pair[1] - pair[0]) / parts;
            let mut part = 0.0;
            while part < parts {
                let x = Span::new(pair[0] + step * part, pair[0] + step * (part + 1.0));
                let width = over(x.from, x.to);
                panels.push(Panel { x, depth, width });
                depth += width;
                part += 1.0;
            }
        }
        let nodes = &rule.nodes;
        let apart = |j: usize| -> f64 {
            (0..NODES).filter(|&i| i != j).map(|i| nodes[j] - nodes[i]).product()
        };
        let barycentric = (0..NODES).map(|j| 1.0 / apart(j)).collect();
        Self { rates, panels, rule, finer, barycentric, depth }
    }

    /// u at a place of a panel.
    fn depth_at(&self, panel: &Panel, x: f64) -> f64 {
        panel.depth + self.rule.integrate(panel.x.from, x, |x| (self.rates)(x)[0])
    }

    /// The polynomials that are 1 at one node of a panel and 0 at the others.
    fn basis(&self, panel: &Panel, x: f64) -> [f64; NODES] {
        let at = (x - panel.x.from) / panel.x.length();
        let away: Vec<f64> = self.rule.nodes.iter().map(|node| at - node).collect();
        if let Some(hit) = away.iter().position(|&away| away == 0.0) {
            return std::array::from_fn(|j| f64::from(u8::from(j == hit)));
        }
        let whole: f64 = away.iter().product();
        std::array::from_fn(|j| whole * self.barycentric[j] / away[j])
    }

    /// `½ ∫ E₁(|u − u'|) s ℓ dx'` over a panel, of all its polynomials.
    fn coupled(&self, (at, depth): (f64, f64), panel: &Panel) -> [f64; NODES] {
        let mut sums = [0.0; NODES];
        let away = (panel.depth - depth).max(depth - panel.depth - panel.width);
        if away > panel.width {
            let weights = self.rule.nodes.iter().zip(&self.rule.weights);
            for (sum, (node, weight)) in sums.iter_mut().zip(weights) {
                let x = panel.x.from + node * panel.x.length();
                let [first, _] = exponentials((self.depth_at(panel, x) - depth).abs());
                *sum = 0.5 * weight * panel.x.length() * first * (self.rates)(x)[1];
            }
            return sums;
        }
        let nearest = at.clamp(panel.x.from, panel.x.to);
        for end in [panel.x.from, panel.x.to] {
            let length = end - nearest;
            for (v, weight) in self.finer.nodes.iter().zip(&self.finer.weights) {
                let x = nearest + length * v.powi(4);
                let [first, _] = exponentials((self.depth_at(panel, x) - depth).abs());
                let share = 2.0 * weight * length.abs() * v.powi(3) * first * (self.rates)(x)[1];
                for (sum, basis) in sums.iter_mut().zip(self.basis(panel, x)) {
                    *sum += share * basis;
                }
            }
        }
        sums
    }

    /// R and T of several lights; `None` where the equations have no solution, or a negative one: then
    /// more than one particle follows each.
    pub fn leaving(&self, lights: &[Light]) -> Option<Vec<[f64; 2]>> {
        let mut nodes = Vec::new();
        for panel in &self.panels {
            let at = |node: &f64| {
                let x = panel.x.from + node * panel.x.length();
                (x, self.depth_at(panel, x))
            };
            nodes.extend(self.rule.nodes.iter().map(at));
        }
        let row = |(i, &node): (usize, &(f64, f64))| {
            let mut row: Vec<f64> = self
                .panels
                .iter()
                .flat_map(|panel| self.coupled(node, panel))
                .map(|k| -k)
                .collect();
            row[i] += 1.0;
            let [above, below] = [node.1, self.depth - node.1].map(|u| 0.5 * exponentials(u)[1]);
            row.extend([above, below]);
            row
        };
        // The diagonal prevails: 1 less what comes back.
        let rows = nodes.iter().enumerate().map(row).collect();
        let worth: Vec<[f64; 2]> = solved(rows, |x: f64| x, false)?;
        if worth.iter().flatten().any(|&worth| worth <= 0.0) {
            return None;
        }
        let mut found: Vec<[f64; 2]> = lights
            .iter()
            .map(|light| match *light {
                Light::Collimated(cosine) => [0.0, (-self.depth / cosine).exp()],
                // 2E₃
                Light::Diffuse => {
                    let [_, second] = exponentials(self.depth);
                    [0.0, (-self.depth).exp() - self.depth * second]
                }
            })
            .collect();
        for (panel, worth) in self.panels.iter().zip(worth.chunks(NODES)) {
            let quarter = 0.25 * panel.x.length();
            for part in 0..4 {
                let from = panel.x.from + quarter * f64::from(part);
                for (node, weight) in self.finer.nodes.iter().zip(&self.finer.weights) {
                    let x = from + quarter * node;
                    let (depth, basis) = (self.depth_at(panel, x), self.basis(panel, x));
                    let share = weight * quarter * (self.rates)(x)[1];
                    for (light, found) in lights.iter().zip(&mut found) {
                        let kernel = match *light {
                            Light::Collimated(cosine) => (-depth / cosine).exp() / cosine,
                            Light::Diffuse => 2.0 * exponentials(depth)[1],
                        };
                        for (worth, basis) in worth.iter().zip(basis) {
                            found[0] += share * kernel * basis * worth[0];
                            found[1] += share * kernel * basis * worth[1];
                        }
                    }
                }
            }
        }
        Some(found)
    }
}
