//! The estimated transmittance from the ray's origin to any point of the ray.

use super::CameraTracking;
use super::segment::{Segment, loss, losses, rounding, size};
use crate::Mesh;
use crate::prediction::raw::POWERS;
use crate::ray::survival::factorial_rates;
use media::{Control, Piecewise};
use numeric::quadrature::GaussLegendre;
use numeric::{Cumulative, Known, Span};

/// Number of integrals that are kept.
const COUNT: usize = 10;
/// Index of `∫σ̂` among the integrals.
const FLOWN: usize = 8;

/// Losses of a walk from the ray's origin to a point: `A_k = ∫ kσ_c + σ̂(1 − w^k)`, `w = 1 − r`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Losses {
    /// `A_k` for k = 0 … 4.
    pub signed: [f64; 5],
    /// `A_k` with `|w|^k` in place of `w^k`.
    pub sizes: [f64; 5],
    /// `A_2` with `w|w|` in place of `w²`.
    pub mixed: f64,
}

/// Integrals along the ray, for evaluation at any point.
pub struct Camera<'a> {
    mesh: &'a Mesh,
    sampling: &'a Piecewise,
    control: &'a Control,
    along: CameraTracking,
    rule: GaussLegendre,
    cuts: Vec<f64>,
    table: Cumulative,
}

impl<'a> Camera<'a> {
    /// Integrates along the ray.
    pub fn new(
        mesh: &'a Mesh,
        sampling: &'a Piecewise,
        control: &'a Control,
        along: CameraTracking,
    ) -> Self {
        let rule = GaussLegendre::new(16);
        let support = mesh.support();
        let mut camera = Self {
            mesh,
            sampling,
            control,
            along,
            rule,
            cuts: Vec::new(),
            table: Cumulative::new(support.from, COUNT),
        };
        if along == CameraTracking::Exact || support.is_empty() {
            return camera;
        }
        let mut knots = sampling.knots().to_vec();
        knots.extend(control.breaks());
        // Where w changes its sign, `|w|` has a kink.
        let turns = (along == CameraTracking::Ratio)
            .then_some(|t, x| sampling.value(t) - (x - control.extinction(t)));
        camera.cuts = mesh.cuts(knots, turns);
        let fine = mesh.refined(&camera.cuts, &|_, panel| {
            let nodes = panel.t.iter().zip(panel.extinction);
            let rows: Vec<[f64; COUNT]> = nodes.map(|(&t, &x)| camera.integrand(t, x)).collect();
            (0..COUNT).map(|i| rows.iter().map(|row| row[i]).collect()).collect()
        });
        let panels = fine.panels().map(|panel| panel.span);
        camera.table =
            Cumulative::over(support.from, COUNT, panels, |span, row| camera.add(span, row));
        camera
    }

    fn integrand(&self, t: f64, extinction: f64) -> [f64; COUNT] {
        let sampling = self.sampling.value(t);
        let control = self.control.extinction(t);
        if self.along == CameraTracking::Delta {
            let from = self.mesh.support().from;
            let depth = self.depth(t).value;
            let nulls = self.flown(Span::new(from, t)) - depth;
            let [a, b, c, d] = factorial_rates(sampling, depth, nulls);
            return [a, b, c, d, 0.0, 0.0, 0.0, 0.0, sampling, depth];
        }
        if sampling <= 0.0 {
            let [a, b, c, d, e] = POWERS.map(|k| f64::from(k) * control);
            return [a, b, c, d, e, a, c, b, 0.0, d.abs()];
        }
        let residual = extinction - control;
        let weight = 1.0 - residual / sampling;
        let [a, b, c, d, e] = losses(control, residual, weight);
        let [one, three, two] = if weight < 0.0 {
            // σ̂(1 − |w|) = 2σ̂ − (σ_t − σ_c), and 1 − w|w| = 1 + w².
            let size = -weight;
            let left = 2.0 * sampling - residual;
            let mixed = 2.0 * control + sampling * (1.0 + weight * weight);
            [loss(1, control, left, size), loss(3, control, left, size), mixed]
        } else {
            [a, c, b]
        };
        [a, b, c, d, e, one, three, two, sampling, size(control, residual, weight)]
    }

    /// τ up to a point.
    fn depth(&self, s: f64) -> Known {
        let from = self.mesh.support().from;
        self.mesh.medium().optical_depth(Span::new(from, s))
    }

    /// `∫σ̂` over a span.
    fn flown(&self, span: Span) -> f64 {
        media::OpticalDepth::optical_depth(self.sampling, span).value
    }

    /// Adds the integrals over a span.
    fn add(&self, span: Span, row: &mut [f64]) {
        let sigma = self.mesh.medium().extinctions(&self.rule.nodes_on(span));
        for ((t, weight), sigma) in self.rule.on(span).zip(sigma) {
            let values = self.integrand(t, sigma);
            row.iter_mut().zip(values).for_each(|(sum, x)| *sum += weight * x);
        }
    }

    fn at(&self, s: f64) -> [f64; COUNT] {
        let mut row = [0.0; COUNT];
        self.table.up_to(s, &mut row, |_, rest, row| self.add(rest, row));
        row
    }

    /// The moments of the estimate up to `s`.
    pub fn segment(&self, s: f64) -> Segment {
        let depth = self.depth(s);
        match self.along {
            CameraTracking::Exact => Segment::exact(depth),
            CameraTracking::Ratio => {
                let [_, b, c, d, e, .., flown, size] = self.at(s);
                let error = rounding(size) + 4.0 * depth.error;
                Segment::product([depth.value, b, c, d, e], flown, [error, size])
            }
            CameraTracking::Delta => {
                let [a, b, c, d, ..] = self.at(s);
                let from = self.mesh.support().from;
                Segment::decided(depth, self.flown(Span::new(from, s)), [a, b, c, d])
            }
        }
    }

    /// Losses of a walk with weights up to `s`.
    pub fn losses(&self, s: f64) -> Losses {
        let [_, b, c, d, _, size, cube, mixed, ..] = self.at(s);
        let signed = [0.0, self.depth(s).value, b, c, d];
        Losses { signed, sizes: [0.0, size, b, cube, d], mixed }
    }

    /// σ̂ and `w = 1 − r` at a point.
    pub fn collision(&self, s: f64, extinction: f64) -> [f64; 2] {
        let sampling = self.sampling.value(s);
        [sampling, 1.0 - (extinction - self.control.extinction(s)) / sampling]
    }

    /// `∫σ̂` over the whole support.
    pub fn collisions(&self) -> f64 {
        self.table.whole()[FLOWN]
    }

    /// The distances where σ̂, the control or the size of a weight have kinks.
    pub fn cuts(&self) -> &[f64] {
        &self.cuts
    }
}
