//! Moments of sums along one walk: a chain of linear equations, see [`numeric::quadrature::GaussLegendre::backward`].
//!
//! The rest of a walk that stands at s with weight 1 has functionals U. From the ray's end backwards they obey
//! `−U' = f − A' U` with `U(end) = 0`, where f contains functionals that are already known.

use super::camera::Losses;
use super::scene::{RayNode, RayScene};
use super::shadows::Among;
use numeric::Span;

/// The nodes of all panels.
pub struct Chain<'a> {
    scene: &'a RayScene<'a>,
    panels: Vec<ChainPanel>,
}

struct ChainPanel {
    x: Span,
    nodes: Vec<At>,
    from: Losses,
    to: Losses,
}

/// A node of the chain.
pub struct At {
    /// Quantities of the point.
    pub node: RayNode,
    /// `A` there.
    pub losses: Losses,
    /// σ̂ and `w = 1 − r` there; without meaning where σ̂ is zero.
    pub collision: [f64; 2],
    stretch: f64,
}

/// A functional at every node, panel by panel, and at the beginning of the ray.
pub struct SolvedChain {
    /// Values at the nodes, by panel.
    pub at: Vec<Vec<f64>>,
    /// Value at the beginning.
    pub begin: f64,
}

impl<'a> Chain<'a> {
    /// The chain on the given panels of the stretched variable, by all or half of the interpolated shadow rays.
    pub fn new(scene: &'a RayScene<'a>, panels: &[Span], among: Among) -> Self {
        let losses = |x: f64| scene.camera.losses(scene.stretched(x).s);
        let panel = |&x: &Span| {
            let node = |&at: &f64| {
                let place = scene.stretched(x.from + at * x.length());
                let node = scene.node_among(place, among);
                let collision = scene.camera.collision(place.s, node.extinction);
                let losses = scene.camera.losses(place.s);
                At { node, losses, collision, stretch: place.stretch }
            };
            let nodes = scene.rule().nodes.iter().map(node).collect();
            ChainPanel { x, nodes, from: losses(x.from), to: losses(x.to) }
        };
        Self { scene, panels: panels.iter().map(panel).collect() }
    }

    /// Returns whether a weight changes its sign somewhere.
    pub fn is_signed(&self) -> bool {
        let mut nodes = self.panels.iter().flat_map(|panel| &panel.nodes);
        nodes.any(|at| at.collision[0] > 0.0 && at.collision[1] < 0.0)
    }

    /// Solves for one functional: `loss` picks its A, and `f` is called for each node with its panel's index and
    /// its index in the panel.
    pub fn solve(
        &self,
        loss: &dyn Fn(&Losses) -> f64,
        f: &dyn Fn(&At, usize, usize) -> f64,
    ) -> SolvedChain {
        let rule = self.scene.rule();
        let mut at = vec![Vec::new(); self.panels.len()];
        let mut beyond = 0.0;
        for (p, panel) in self.panels.iter().enumerate().rev() {
            let from = loss(&panel.from);
            let losses: Vec<f64> =
                panel.nodes.iter().map(|node| loss(&node.losses) - from).collect();
            let source = |(i, node): (usize, &At)| f(node, p, i) * node.stretch * panel.x.length();
            let sources: Vec<f64> = panel.nodes.iter().enumerate().map(source).collect();
            (at[p], beyond) = rule.backward(&losses, loss(&panel.to) - from, &sources, beyond);
        }
        SolvedChain { at, begin: beyond }
    }
}
