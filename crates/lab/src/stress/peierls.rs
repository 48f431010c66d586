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

use super::equations::solved;
use super::prelude::*;
use numeric::exponential_integrals as exponentials;
use theory::problems::slab::IncidentLight;

/// Nodes of a panel.
const NODES: usize = 7;
/// Panels are optically no thicker.
const THICKEST: f64 = 1.0;
/// Number of times that panels shrink to a quarter towards both ends, where W is like `u ln u`.
const SHRINKS: i32 = 7;

/// l and s of a slab from 0 to 1.
pub type SlabRates<'a> = dyn Fn(f64) -> [f64; 2] + 'a;

/// A part of a slab between two depths u.
struct SlabPanel {
    x: Span,
    u: Span,
}

/// A slab cut into panels.
pub struct Peierls<'a> {
    rates: &'a SlabRates<'a>,
    panels: Vec<SlabPanel>,
    /// x, u, and `½ s dx` of every node.
    nodes: Vec<[f64; 3]>,
    rule: GaussLegendre,
    finer: GaussLegendre,
    depth: f64,
}

impl<'a> Peierls<'a> {
    /// Cut at the given places inside.
    pub fn new(rates: &'a SlabRates<'a>, breaks: &[f64]) -> Self {
        let (rule, finer) = (GaussLegendre::new(NODES), GaussLegendre::new(24));
        let mut ends = vec![0.0, 0.5, 1.0];
        ends.extend(breaks);
        for shrink in 1..=SHRINKS {
            let near = 0.25f64.powi(shrink);
            ends.extend([near, 1.0 - near]);
        }
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        let over = |x: Span| finer.integrate(x.from, x.to, |x| rates(x)[0]);
        let (mut panels, mut depth) = (Vec::new(), 0.0);
        for stretch in Span::between(&ends) {
            let parts = (over(stretch) / THICKEST).ceil().max(1.0);
            let end = |part: f64| stretch.from + stretch.length() / parts * part;
            for part in (0..).map(f64::from).take_while(|&part| part < parts) {
                let x = Span::new(end(part), end(part + 1.0));
                let u = Span::new(depth, depth + over(x));
                depth = u.to;
                panels.push(SlabPanel { x, u });
            }
        }
        let mut slab = Self { rates, panels, nodes: Vec::new(), rule, finer, depth };
        let node = |panel, (x, dx)| [x, slab.depth_at(panel, x), 0.5 * rates(x)[1] * dx];
        let panels = slab.panels.iter();
        slab.nodes =
            panels.flat_map(|panel| slab.rule.on(panel.x).map(move |at| node(panel, at))).collect();
        slab
    }

    /// u at a place of a panel.
    fn depth_at(&self, panel: &SlabPanel, x: f64) -> f64 {
        panel.u.from + self.rule.integrate(panel.x.from, x, |x| (self.rates)(x)[0])
    }

    /// Factors of a panel's nodes in the polynomial through them.
    fn polynomial(&self, panel: &SlabPanel, x: f64) -> Vec<f64> {
        self.rule.weights_at((x - panel.x.from) / panel.x.length())
    }

    /// `½ ∫ E₁(|u − u'|) s ℓ dx'` over a panel, of all its polynomials.
    fn coupled(&self, [at, depth, _]: [f64; 3], panel: &SlabPanel, nodes: &[[f64; 3]]) -> Vec<f64> {
        let first = |u: f64| exponentials((u - depth).abs())[0];
        if (panel.u.from - depth).max(depth - panel.u.to) > panel.u.length() {
            return nodes.iter().map(|&[_, u, share]| share * first(u)).collect();
        }
        let mut sums = vec![0.0; NODES];
        let nearest = at.clamp(panel.x.from, panel.x.to);
        for length in [panel.x.from - nearest, panel.x.to - nearest] {
            for (v, weight) in self.finer.on(Span::new(0.0, 1.0)).filter(|_| length != 0.0) {
                let x = nearest + length * v.powi(4);
                let share = 2.0 * weight * length.abs() * v.powi(3) * (self.rates)(x)[1];
                let share = share * first(self.depth_at(panel, x));
                let polynomial = self.polynomial(panel, x);
                sums.iter_mut().zip(polynomial).for_each(|(sum, factor)| *sum += share * factor);
            }
        }
        sums
    }

    /// R and T of several lights; `None` where the equations have no solution, or a negative one: then
    /// more than one particle follows each.
    pub fn leaving(&self, lights: &[IncidentLight]) -> Option<Vec<[f64; 2]>> {
        let row = |(i, &node): (usize, &[f64; 3])| {
            let panels = self.panels.iter().zip(self.nodes.chunks(NODES));
            let coupled = panels.flat_map(|(panel, nodes)| self.coupled(node, panel, nodes));
            let mut row: Vec<f64> = coupled.map(|k| -k).collect();
            row[i] += 1.0;
            row.extend([node[1], self.depth - node[1]].map(|u| 0.5 * exponentials(u)[1]));
            row
        };
        // The diagonal prevails: 1 less what comes back.
        let rows = self.nodes.iter().enumerate().map(row).collect();
        let worth: Vec<[f64; 2]> = solved(rows, |x: f64| x, false)?;
        if worth.iter().flatten().any(|&worth| worth <= 0.0) {
            return None;
        }
        let straight = |light: &IncidentLight| match *light {
            IncidentLight::Collimated(cosine) => [0.0, (-self.depth / cosine).exp()],
            // 2E₃
            IncidentLight::Diffuse => {
                [0.0, (-self.depth).exp() - self.depth * exponentials(self.depth)[1]]
            }
        };
        let mut computed: Vec<[f64; 2]> = lights.iter().map(straight).collect();
        for (panel, worth) in self.panels.iter().zip(worth.chunks(NODES)) {
            let quarters = (0..=4).map(|i| panel.x.from + 0.25 * panel.x.length() * f64::from(i));
            for (x, dx) in
                Span::between(&quarters.collect::<Vec<_>>()).flat_map(|x| self.finer.on(x))
            {
                let (u, polynomial) = (self.depth_at(panel, x), self.polynomial(panel, x));
                let share = dx * (self.rates)(x)[1];
                let worth = [0, 1].map(|side| -> f64 {
                    polynomial.iter().zip(worth).map(|(factor, worth)| factor * worth[side]).sum()
                });
                for (light, computed) in lights.iter().zip(&mut computed) {
                    let kernel = match *light {
                        IncidentLight::Collimated(cosine) => (-u / cosine).exp() / cosine,
                        IncidentLight::Diffuse => 2.0 * exponentials(u)[1],
                    };
                    computed.iter_mut().zip(worth).for_each(|(sum, w)| *sum += share * kernel * w);
                }
            }
        }
        Some(computed)
    }
}
