//! The slab cut into panels, with all integrals from its depths to its end.
//!
//! Panels end where σ_t and σ̂ have breaks. They resolve the powers of 1 − r that are needed. They are as short as
//! a [`LitResolution`] requires for the lowest direction and before a disc.

use crate::Mesh;
use crate::problems::lit_slab::LightBehind;
use crate::problems::{LitSlab, Problem};
use crate::ray::mesh::Panel;
use media::Piecewise;

use super::directions::LitResolution;
use crate::light::contour::Contour;

/// A depth.
#[derive(Debug, Clone)]
pub struct DepthNode {
    /// Distance to the end of the slab.
    pub before: f64,
    /// dz.
    pub weight: f64,
    /// σ_t.
    pub extinction: f64,
    /// σ̂.
    pub sampling: f64,
    /// τ from the beginning.
    pub depth: f64,
    /// The mean number of null collisions from the beginning, `∫σ̂ − τ`.
    pub nulls: f64,
    /// `∫ σ̂ (1 − (1 − r)^s)` to the end, for every s of a contour.
    pub beyond: Vec<f64>,
}

/// The slab.
pub struct LitColumn {
    mesh: Mesh,
    /// The depths, panel by panel.
    pub nodes: Vec<DepthNode>,
    /// Nodes in a panel.
    pub per_panel: usize,
    /// τ of the slab, and ∫σ̂ − τ.
    pub whole: [f64; 2],
}

impl LitColumn {
    /// A column with the integrals of a contour.
    pub fn new(
        mesh: &Mesh,
        problem: &LitSlab,
        sampling: &Piecewise,
        contour: &Contour,
        resolution: &LitResolution,
    ) -> Self {
        let cut = mesh.refined(&cuts(mesh, problem, sampling, resolution), &|_, panel| {
            let left: Vec<f64> = nulls(panel, sampling).map(|[null, _]| null).collect();
            let roots = left.iter().map(|null| null.sqrt()).collect();
            if contour.has_lines() { vec![left, roots] } else { vec![left] }
        });
        let end = problem.end();
        let [mut depth, mut missed] = [0.0; 2];
        let mut nodes = Vec::new();
        for panel in cut.panels() {
            let values: Vec<[f64; 2]> = nulls(panel, sampling).collect();
            let flown: Vec<f64> = values.iter().map(|&[null, sampling]| null * sampling).collect();
            let (real, missing) =
                (cut.running(panel, panel.extinction), cut.running(panel, &flown));
            for (i, &t) in panel.t.iter().enumerate() {
                nodes.push(DepthNode {
                    before: end - t,
                    weight: panel.span.length() * cut.rule().weights[i],
                    extinction: panel.extinction[i],
                    sampling: values[i][1],
                    depth: depth + real[i],
                    nulls: missed + missing[i],
                    beyond: Vec::new(),
                });
            }
            depth += cut.integral(panel, panel.extinction);
            missed += cut.integral(panel, &flown);
        }
        let per_panel = cut.rule().nodes.len();
        let mut column = Self { mesh: cut, nodes, per_panel, whole: [depth, missed] };
        column.integrate(contour);
        column
    }

    /// Integrates from each node to the end.
    fn integrate(&mut self, contour: &Contour) {
        let rates =
            |node: &DepthNode| contour.rates(null(node.extinction, node.sampling), node.sampling);
        let rows: Vec<Vec<f64>> = self.nodes.iter().map(rates).collect();
        let lengths: Vec<f64> =
            (0..rows.len()).step_by(self.per_panel).map(|first| self.panel_length(first)).collect();
        let result = self.mesh.rule().all_to_end(&lengths, &rows);
        self.nodes.iter_mut().zip(result).for_each(|(node, beyond)| node.beyond = beyond);
    }

    /// The weights of `∫` from a node to the end of its panel, for the nodes of the panel.
    pub fn rest_of_panel(&self, node: usize) -> Vec<f64> {
        let length = self.panel_length(node);
        self.mesh.rule().to_end(node % self.per_panel).map(|weight| length * weight).collect()
    }

    fn panel_length(&self, node: usize) -> f64 {
        let first = node - node % self.per_panel;
        self.nodes[first..first + self.per_panel].iter().map(|node| node.weight).sum()
    }

    /// Bound on the relative error of integrals beyond the difference of resolutions: exponents are differences of
    /// numbers as large as ∫σ̂/μ.
    pub fn error(&self, lowest: f64) -> f64 {
        let [depth, nulls] = self.whole;
        self.mesh.relative_error() + f64::EPSILON * (depth + nulls) / lowest
    }
}

/// `1 − r`; where σ̂ = 0, so is σ_t.
fn null(extinction: f64, sampling: f64) -> f64 {
    let real = if sampling > 0.0 { extinction / sampling } else { 1.0 };
    (1.0 - real).max(0.0)
}

/// `1 − r` and σ̂ at the nodes of a panel.
fn nulls<'a>(panel: Panel<'a>, sampling: &'a Piecewise) -> impl Iterator<Item = [f64; 2]> + 'a {
    panel.t.iter().zip(panel.extinction).map(move |(&t, &extinction)| {
        let sampling = sampling.value(t);
        [null(extinction, sampling), sampling]
    })
}

/// Depths where panels end.
fn cuts(
    mesh: &Mesh,
    problem: &LitSlab,
    sampling: &Piecewise,
    resolution: &LitResolution,
) -> Vec<f64> {
    let mut cuts = sampling.knots().to_vec();
    let lowest = problem.light.lowest();
    for panel in mesh.panels() {
        let depth = mesh.integral(panel, panel.extinction) / lowest;
        cuts.extend(panel.span.even_cuts((depth / resolution.depth).ceil().max(1.0)));
    }
    if let LightBehind::Disc { distance, .. } | LightBehind::Point(distance) = problem.light {
        let (end, length) = (problem.end(), problem.medium().span().length());
        let places = resolution.away(distance, length);
        cuts.extend(places.into_iter().map(|before| end - before));
    }
    cuts
}
