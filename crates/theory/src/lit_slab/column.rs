//! The slab cut into panels, with all integrals from its depths to its end.
//!
//! Panels end where σ_t and σ̂ have breaks. They resolve the powers of 1 − r that are needed. They are as short as
//! a [`Resolution`] requires for the lowest direction and before a disc.

use crate::Mesh;
use crate::mesh::Panel;
use crate::problems::lit_slab::Light;
use crate::problems::{LitSlab, Problem};
use media::Piecewise;

use super::contour::{Contour, Exponents};
use super::directions::Resolution;

/// A depth.
#[derive(Debug, Clone, Copy)]
pub struct Node {
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
    /// The number of its panel.
    pub panel: usize,
}

/// The slab.
pub struct Column {
    mesh: Mesh,
    /// The depths, panel by panel.
    pub nodes: Vec<Node>,
    /// Nodes in a panel.
    pub per_panel: usize,
    /// τ of the slab, and ∫σ̂ − τ.
    pub whole: [f64; 2],
    /// `∫ σ̂ (1 − (1 − r)^k)` from each node to the end, k = 0, 1 …
    powers: Vec<Vec<f64>>,
    /// Integrals of complex powers by nodes of the contour, real and imaginary parts, by depth.
    complex: Vec<[Vec<f64>; 2]>,
}

impl Column {
    /// A column with integrals of `count` powers, and those of a contour.
    pub fn new(
        mesh: &Mesh,
        problem: &LitSlab,
        sampling: &Piecewise,
        (powers, contour): (usize, Option<&Contour>),
        resolution: &Resolution,
    ) -> Self {
        let has_contour = contour.is_some();
        let cut = mesh.refined(&cuts(mesh, problem, sampling, resolution), &|_, panel| {
            let left: Vec<f64> = nulls(panel, sampling).map(|[null, _]| null).collect();
            let roots = left.iter().map(|null| null.sqrt()).collect();
            if has_contour { vec![left, roots] } else { vec![left] }
        });
        let end = problem.end();
        let [mut depth, mut missed] = [0.0; 2];
        let mut nodes = Vec::new();
        for (number, panel) in cut.panels().enumerate() {
            let values: Vec<[f64; 2]> = nulls(panel, sampling).collect();
            let flown: Vec<f64> = values.iter().map(|&[null, sampling]| null * sampling).collect();
            let (real, missing) =
                (cut.running(panel, panel.extinction), cut.running(panel, &flown));
            for (i, &t) in panel.t.iter().enumerate() {
                nodes.push(Node {
                    before: end - t,
                    weight: panel.span.length() * cut.weights()[i],
                    extinction: panel.extinction[i],
                    sampling: values[i][1],
                    depth: depth + real[i],
                    nulls: missed + missing[i],
                    panel: number,
                });
            }
            depth += cut.integral(panel, panel.extinction);
            missed += cut.integral(panel, &flown);
        }
        let per_panel = cut.weights().len();
        let (whole, complex) = ([depth, missed], Vec::new());
        let mut column = Self { mesh: cut, nodes, per_panel, whole, powers: Vec::new(), complex };
        column.powers = (0..=powers)
            .map(|k| {
                let k = i32::try_from(k).unwrap_or(i32::MAX);
                column.to_the_end(sampling, |null| 1.0 - null.powi(k))
            })
            .collect();
        if let Some(contour) = contour {
            let along = |&frequency: &f64| {
                // 1 − (1 − r)^s, s = 1/2 + i Im s.
                let part = |null: f64, offset: f64, part: fn(f64) -> f64| {
                    let turned = if null > 0.0 { part(frequency * null.ln()) } else { 0.0 };
                    offset - null.sqrt() * turned
                };
                [
                    column.to_the_end(sampling, |null| part(null, 1.0, f64::cos)),
                    column.to_the_end(sampling, |null| part(null, 0.0, f64::sin)),
                ]
            };
            let rows: Vec<[Vec<f64>; 2]> = contour.frequencies.iter().map(along).collect();
            let at = |node: usize| {
                [0, 1].map(|part| rows.iter().map(|row| row[part][node]).collect::<Vec<f64>>())
            };
            column.complex = (0..column.nodes.len()).map(at).collect();
        }
        column
    }

    /// `∫ σ̂ f(1 − r)` from each node to the end.
    fn to_the_end(&self, sampling: &Piecewise, f: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut found = vec![0.0; self.nodes.len()];
        let mut beyond = 0.0;
        let panels = found.chunks_mut(self.per_panel).rev().zip(self.mesh.panels().rev());
        for (row, panel) in panels {
            let values: Vec<f64> =
                nulls(panel, sampling).map(|[null, sampling]| sampling * f(null)).collect();
            let whole = self.mesh.integral(panel, &values);
            let running = self.mesh.running(panel, &values);
            for (found, before) in row.iter_mut().zip(running) {
                *found = beyond + whole - before;
            }
            beyond += whole;
        }
        found
    }

    /// `M_k` of a direction from a node to the end, for powers up to `count`.
    pub fn products(&self, node: usize, cosine: f64, count: usize) -> Vec<f64> {
        self.powers[..=count].iter().map(|depths| (-depths[node] / cosine).exp()).collect()
    }

    /// Exponents of a contour at a node.
    pub fn exponents(&self, node: usize) -> Exponents<'_> {
        let [real, imaginary] = &self.complex[node];
        Exponents { real, imaginary }
    }

    /// The weights of `∫` from a node to the end of its panel, for the nodes of the panel.
    pub fn rest_of_panel(&self, node: usize) -> Vec<f64> {
        let (place, length) = (node % self.per_panel, self.panel_length(node));
        let all = self.mesh.weights();
        self.mesh
            .running_weights(place)
            .iter()
            .zip(all)
            .map(|(row, all)| length * (all - row))
            .collect()
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

/// `1 − r` and σ̂ at the nodes of a panel; where σ̂ = 0, so is σ_t.
fn nulls<'a>(panel: Panel<'a>, sampling: &'a Piecewise) -> impl Iterator<Item = [f64; 2]> + 'a {
    panel.t.iter().zip(panel.extinction).map(move |(&t, &extinction)| {
        let sampling = sampling.value(t);
        let real = if sampling > 0.0 { extinction / sampling } else { 1.0 };
        [(1.0 - real).max(0.0), sampling]
    })
}

/// Depths where panels end.
fn cuts(mesh: &Mesh, problem: &LitSlab, sampling: &Piecewise, resolution: &Resolution) -> Vec<f64> {
    let mut cuts = sampling.knots().to_vec();
    let lowest = problem.light.lowest();
    for panel in mesh.panels() {
        let depth = mesh.integral(panel, panel.extinction) / lowest;
        cuts.extend(panel.span.even_cuts((depth / resolution.depth).ceil().max(1.0)));
    }
    if let Light::Disc { distance, .. } | Light::Point(distance) = problem.light {
        let (end, length) = (problem.end(), problem.medium().span().length());
        let places = resolution.away(distance, length);
        cuts.extend(places.into_iter().map(|before| end - before));
    }
    cuts
}
