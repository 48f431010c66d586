//! A ray seen from the side: the curves of Figures 5 and 8 of Szirmay-Kalos et al. 2017.

use super::double::walk;
use crate::Setup;
use numeric::Span;
use numeric::rng::Address;
use theory::Moments;
use theory::collisions::rules::Weight;
use theory::problems::{Problem, TransmittanceCurve};

/// Number of distances at which the ray is shown.
const POINTS: usize = 400;
/// Number of sample walks that are shown.
const WALKS: u64 = 6;

/// The functions of a ray and a few walks along it.
#[derive(Debug, Clone, Default)]
pub struct RayView {
    /// Distances, ascending.
    pub t: Vec<f64>,
    /// σ_t there.
    pub extinction: Vec<f64>,
    /// σ_c there.
    pub control: Vec<f64>,
    /// σ̂ there.
    pub sampling: Vec<f64>,
    /// T(t) there.
    pub transmittance: Vec<f64>,
    /// The standard deviation of one draw of T̂(t) there.
    pub deviation: Vec<f64>,
    /// The tentative collisions of the first walk: `(t, σ_t)`.
    pub collisions: Vec<[f64; 2]>,
    /// T̂(t) of each walk.
    pub walks: Vec<Vec<f64>>,
}

/// Draws the view; walks take their random numbers from the blocks of `address`.
pub fn ray_view(setup: &Setup<TransmittanceCurve>, address: Address) -> RayView {
    let medium = setup.problem.medium();
    let (span, support) = (medium.span(), setup.fields.mesh.support());
    if span.is_empty() {
        return RayView::default();
    }
    let t: Vec<f64> =
        (0..=POINTS).map(|i| span.from + span.length() * (i as f64 / POINTS as f64)).collect();
    let inside = |t: f64| t >= support.from && t <= support.to;
    let shown = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        t.iter().map(|&t| if inside(t) { f(t) } else { 0.0 }).collect()
    };
    let control_depth = |t: f64| {
        let upto = Span::new(support.from, t).intersect(support);
        setup.fields.control.optical_depth(upto).value
    };
    let transmittance: Vec<f64> =
        t.iter().map(|&t| (-medium.optical_depth(Span::new(span.from, t)).value).exp()).collect();
    let product = setup.product(&Weight);
    let mesh = product.mesh(&t);
    let ends: Vec<f64> = t.iter().map(|&t| t.clamp(support.from, support.to)).collect();
    let deviation = product
        .integrals(&mesh, &ends)
        .iter()
        .zip(&transmittance)
        .map(|(integrals, &mean)| {
            Moments::of_product(mean, integrals.losses, 0.0).variance().sqrt()
        })
        .collect();
    let walks: Vec<Vec<[f64; 3]>> = (0..WALKS)
        .map(|block| walk(setup, medium, &mut Address { block, ..address }.stream()))
        .collect();
    let curve = |collisions: &Vec<[f64; 3]>| -> Vec<f64> {
        t.iter()
            .map(|&t| {
                let passed = collisions.iter().take_while(|collision| collision[0] <= t);
                passed.last().map_or(1.0, |collision| collision[2]) * (-control_depth(t)).exp()
            })
            .collect()
    };
    RayView {
        extinction: shown(&|t| medium.extinction(t)),
        control: shown(&|t| setup.fields.control.extinction(t)),
        sampling: shown(&|t| setup.fields.sampling.value(t)),
        transmittance,
        deviation,
        collisions: walks[0].iter().map(|[t, extinction, _]| [*t, *extinction]).collect(),
        walks: walks.iter().map(curve).collect(),
        t,
    }
}
