//! Means of weights that depend on all null collisions between the ray's origin and a point, see [`crate::light::contour`].

use super::shadows::PANELS;
use crate::Mesh;
use crate::light::Heuristic;
use crate::light::contour::{Contour, Made, ROUNDINGS};
use crate::prediction::raw::{POWERS, PerPower};
use crate::ray::mesh::Panel;
use media::Piecewise;
use numeric::quadrature::GaussLegendre;
use numeric::{Cumulative, Span};

/// Moments, k = 1 … 4.
const MOMENTS: usize = 4;

/// Integrals `∫ σ̂ (1 − (1 − σ_t/σ̂)^s)` along a ray at all exponents, for evaluation at any point.
pub struct NullPaths<'a> {
    mesh: &'a Mesh,
    sampling: &'a Piecewise,
    contour: Contour,
    rule: GaussLegendre,
    /// The relative error of the integrals.
    off: f64,
    table: Cumulative,
    /// σ_t of panels on which it and σ̂ are constant.
    flat: Vec<Option<f64>>,
}

impl<'a> NullPaths<'a> {
    /// Integrates along the ray, `σ̂ ≥ σ_t`.
    pub fn new(mesh: &'a Mesh, sampling: &'a Piecewise, heuristic: Heuristic) -> Self {
        let contour = Contour::new(Some(heuristic), MOMENTS, true);
        let table = Cumulative::new(mesh.support().from, contour.width());
        let rule = GaussLegendre::new(16);
        let mut paths = Self { mesh, sampling, contour, rule, off: 0.0, table, flat: Vec::new() };
        paths.integrate();
        paths
    }

    fn integrate(&mut self) {
        let (mesh, sampling) = (self.mesh, self.sampling);
        let cuts = mesh.cuts(sampling.knots().to_vec(), [|t, x| sampling.value(t) - x]);
        let fine = mesh.refined(&cuts, &|_, panel| {
            let nodes = panel.t.iter().zip(panel.extinction);
            let row = |(&t, &x): (&f64, &f64)| {
                let mut row = vec![0.0; self.contour.width()];
                self.losses(t, x, None, &mut row);
                row
            };
            let rows: Vec<Vec<f64>> = nodes.map(row).collect();
            let of = self.contour.steepest().map(|i| rows.iter().map(|row| row[i]).collect());
            of.into()
        });
        self.off = fine.relative_error();
        let panels: Vec<Panel<'_>> = fine.panels().collect();
        // In media of many pieces several panels share an entry.
        let is_many = mesh.medium().breaks().len() > PANELS;
        let together = if is_many { panels.len().div_ceil(PANELS) } else { 1 };
        let mut missed = 0.0f64;
        let mut table = self.table.clone();
        for group in panels.chunks(together) {
            let (first, sigma) = (sampling.value(group[0].t[0]), group[0].extinction[0]);
            let mut nodes = group.iter().flat_map(|panel| panel.t.iter().zip(panel.extinction));
            let is_flat = nodes.all(|(&t, &x)| sampling.value(t) == first && x == sigma);
            self.flat.push(is_flat.then_some(sigma));
            let entry = self.flat.len() - 1;
            let span = Span::new(group[0].span.from, group[group.len() - 1].span.to);
            table.push(span.to, |row| {
                for panel in group {
                    self.add(entry, panel.span, None, row);
                }
                if group.len() > 1 {
                    let mut at_once = vec![0.0; row.len()];
                    self.add(entry, span, None, &mut at_once);
                    let apart = at_once.iter().zip(row).map(|(a, b)| (a - *b).abs());
                    missed = apart.fold(missed, f64::max);
                }
            });
        }
        let largest = table.whole().iter().fold(0.0, |maximum: f64, x| maximum.max(x.abs()));
        if missed > 0.0 {
            self.off += missed / largest;
        }
        self.table = table;
    }

    /// Writes `σ̂ (1 − (1 − σ_t/σ̂)^s)` at a place, of all lines or of one.
    fn losses(&self, t: f64, sigma: f64, line: Option<usize>, row: &mut [f64]) {
        let sampling = self.sampling.value(t);
        let kept = if sampling > 0.0 { (1.0 - sigma / sampling).max(0.0) } else { 1.0 };
        self.contour.losses(kept, line, row);
        for place in self.contour.places(line) {
            for loss in &mut row[place] {
                *loss *= sampling;
            }
        }
    }

    /// Adds the integrals over a part of a panel, of all lines or of one.
    fn add(&self, panel: usize, span: Span, line: Option<usize>, row: &mut [f64]) {
        let mut losses = vec![0.0; row.len()];
        let mut at = |weight: f64, t: f64, sigma: f64| {
            self.losses(t, sigma, line, &mut losses);
            for place in self.contour.places(line) {
                for (sum, loss) in row[place.clone()].iter_mut().zip(&losses[place]) {
                    *sum += weight * loss;
                }
            }
        };
        if let Some(sigma) = self.flat[panel] {
            at(span.length(), span.middle(), sigma);
            return;
        }
        let sigma = self.mesh.medium().extinctions(&self.rule.nodes_on(span));
        for ((t, weight), sigma) in self.rule.on(span).zip(sigma) {
            at(weight, t, sigma);
        }
    }

    /// The moments of the weights of paths to a point, r = R x, and bounds on their errors, for [`POWERS`]; the eighth is
    /// not known.
    pub fn weights(&self, made: Made, s: f64, ratio: f64) -> [PerPower; 2] {
        // Scores of collisions are those of `E[x^{3/2}]`, not of the larger `E[x^{1/2}]`.
        let line = self.contour.line(if made == Made::ByPoint { ratio } else { ratio.min(1.0) });
        let mut integrals = vec![0.0; self.contour.width()];
        let add = |panel, rest, row: &mut [f64]| self.add(panel, rest, Some(line), row);
        self.table.up_to(s, &mut integrals, add);
        let size = self.contour.size(line, &integrals);
        let off = f64::EPSILON * (ROUNDINGS + size) + self.off * size;
        let moments = self.contour.moments(line, &integrals, 1.0);
        let scores = self.contour.scores(line, ratio, &moments, off);
        [scores.means, scores.errors].map(|result| {
            let mut row = [f64::NAN; POWERS.len()];
            row[..MOMENTS].copy_from_slice(&result[made as usize][1..=MOMENTS]);
            row
        })
    }
}
