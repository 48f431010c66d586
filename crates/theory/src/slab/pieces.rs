//! A slab cut into layers on which the ratio `r = σ_t/σ̂` is constant, or nearly so.
//!
//! Where r varies, layers end where the moments of collisions have kinks, as at r = 1. The first layer is halved
//! repeatedly towards the top: grazing light gets no deeper than μ₀ free paths, and its r is that of the top rather
//! than the mean of a layer.

use crate::collisions::particle::EventProbabilities;
use crate::problems::slab::IncidentLight;
use crate::{Kernel, Mesh};
use media::Piecewise;
use numeric::Span;
use numeric::quadrature::GaussLegendre;

/// Maximum variation of a ratio that counts as constant.
const SAME: f64 = 1e-12;
/// Maximum number of layers that are not averaged.
const MAX_EXACT: usize = 16;
/// Number of layers of the coarser cut where r varies, before the first is halved: the minimum, or two for each
/// smooth panel of σ_t, up to the maximum.
const COARSE: [usize; 2] = [12, 48];
/// Maximum number of breaks at which layers end.
const MAX_BREAKS: usize = 24;
/// Nodes on a smooth part of a layer.
const NODES: usize = 6;
/// Cosine of the light that limits the thickness of the first layer, even if no light grazes.
const STEEP: f64 = 0.1;
/// Maximum number of halvings of the first layer.
const HALVINGS: u32 = 30;

/// A layer: its `∫σ̂`, and the ratios in it with their shares, which add up to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// `∫σ̂` over the layer.
    pub flown: f64,
    /// Shares of `∫σ̂` and the ratios there.
    pub ratios: Vec<[f64; 2]>,
}

impl Piece {
    /// A layer of one ratio.
    pub fn of(flown: f64, ratio: f64) -> Self {
        Self { flown, ratios: vec![[1.0, ratio]] }
    }

    /// The layer with the mean kernel of its collisions, which is given by the ratio.
    pub(super) fn kernel(&self, at: impl Fn(f64) -> Kernel) -> Kernel {
        let none = Kernel { rate: self.flown, straight: 0.0, scattered: 0.0, score: 0.0 };
        self.ratios.iter().fold(none, |sum, &[share, ratio]| {
            let here = at(ratio);
            Kernel {
                straight: sum.straight + share * here.straight,
                scattered: sum.scattered + share * here.scattered,
                score: sum.score + share * here.score,
                ..sum
            }
        })
    }

    /// Returns whether every collision in it is null: then no particle changes.
    pub(super) fn is_idle(&self, probabilities: impl Fn(f64) -> EventProbabilities) -> bool {
        self.ratios.iter().all(|&[_, ratio]| probabilities(ratio).transmit >= 1.0)
    }
}

/// The layers of a slab, the first on top.
#[derive(Debug, Clone, PartialEq)]
pub enum Pieces {
    /// r is constant in each.
    Exact(Vec<Piece>),
    /// r varies in them: a coarser cut, and one of twice as many layers.
    Graded([Vec<Piece>; 2]),
}

impl Pieces {
    /// The layers of a medium under a sampling extinction, for any of the given lights. The walk's moments have
    /// kinks at some ratios.
    pub fn new(mesh: &Mesh, sampling: &Piecewise, kinks: &[f64], lights: &[IncidentLight]) -> Self {
        let cut = mesh.cut(sampling.knots());
        let mut exact: Vec<Piece> = Vec::new();
        let mut is_exact = true;
        for panel in cut.panels() {
            let there: Vec<f64> = panel.t.iter().map(|&t| sampling.value(t)).collect();
            let flown = cut.integral(panel, &there);
            // Intervals without collisions and without scattering are left out.
            if flown <= 0.0 {
                continue;
            }
            let mut ratios = panel.extinction.iter().zip(&there).map(|(sigma, here)| sigma / here);
            let first = ratios.next().unwrap_or(0.0);
            let same = |ratio: f64| (ratio - first).abs() <= SAME * first.abs();
            is_exact &= ratios.all(same);
            match exact.last_mut() {
                Some(last) if same(last.ratios[0][1]) => last.flown += flown,
                _ => exact.push(Piece::of(flown, first)),
            }
            if !is_exact || exact.len() > MAX_EXACT {
                return Self::Graded(graded(&cut, sampling, kinks, lights));
            }
        }
        Self::Exact(exact)
    }
}

/// Layers of about equal thickness, which end at the breaks of σ_t and σ̂, if these are few, and at kinks, if
/// they are still few with them; and the same layers cut in two.
fn graded(
    cut: &Mesh,
    sampling: &Piecewise,
    kinks: &[f64],
    lights: &[IncidentLight],
) -> [Vec<Piece>; 2] {
    let support = cut.support();
    let mut knots = cut.medium().breaks();
    knots.extend(sampling.knots());
    let passed = |&ratio: &f64| {
        cut.roots(&|t, sigma| {
            let (kink, off) = (ratio * sampling.value(t), sigma - ratio * sampling.value(t));
            // Where both are one field rounding crosses no kink.
            if off.abs() <= SAME * kink { 0.0 } else { off }
        })
    };
    let both = knots.iter().copied().chain(kinks.iter().flat_map(passed)).collect();
    let (knots, breaks) = (support.cut(knots), support.cut(both));
    let few = [&breaks, &knots].into_iter().find(|breaks| breaks.len() <= MAX_BREAKS);
    let stretches = few.cloned().unwrap_or_else(|| vec![support.from, support.to]);
    let layers = (2 * cut.panels().len()).clamp(COARSE[0], COARSE[1]);
    let mut ends = vec![support.from];
    for stretch in stretches.windows(2) {
        let length = stretch[1] - stretch[0];
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a few dozen
        let parts = ((layers as f64 * length / support.length()).ceil() as usize).max(1);
        ends.extend((1..parts).map(|i| stretch[0] + length / parts as f64 * i as f64));
        ends.push(stretch[1]);
    }
    let rule = GaussLegendre::new(NODES);
    let piece = |from: f64, to: f64| piece(cut, sampling, Span::new(from, to), &breaks, &rule);
    let minimum = lights.iter().filter_map(|light| light.cosine()).fold(STEEP, f64::min);
    let flown = |ends: &[f64]| piece(ends[0], ends[1]).map_or(0.0, |piece| piece.flown);
    for _ in 0..HALVINGS {
        // Light passes layers without collisions.
        let Some(first) = ends.windows(2).position(|ends| flown(ends) > 0.0) else { break };
        if flown(&ends[first..]) <= minimum {
            break;
        }
        ends.insert(first + 1, 0.5 * (ends[first] + ends[first + 1]));
    }
    [1, 2].map(|times| {
        let split = |ends: &[f64]| -> Vec<Piece> {
            let step = (ends[1] - ends[0]) / f64::from(times);
            let from = |i: i32| if i == times { ends[1] } else { ends[0] + step * f64::from(i) };
            (0..times).filter_map(|i| piece(from(i), from(i + 1))).collect()
        };
        ends.windows(2).flat_map(split).collect()
    })
}

/// One layer by quadrature between the breaks inside it; `None` where `∫σ̂` is 0.
fn piece(
    mesh: &Mesh,
    sampling: &Piecewise,
    within: Span,
    breaks: &[f64],
    rule: &GaussLegendre,
) -> Option<Piece> {
    let mut ends = vec![within.from];
    ends.extend(breaks.iter().copied().filter(|&t| within.contains_inside(t)));
    ends.push(within.to);
    let mut ratios: Vec<[f64; 2]> = Vec::new();
    for span in Span::between(&ends) {
        let extinction = mesh.medium().extinctions(&rule.nodes_on(span));
        for ((t, weight), sigma) in rule.on(span).zip(extinction) {
            let here = sampling.value(t);
            if here > 0.0 {
                ratios.push([weight * here, sigma / here]);
            }
        }
    }
    let flown: f64 = ratios.iter().map(|[share, _]| share).sum();
    for [share, _] in &mut ratios {
        *share /= flown;
    }
    (flown > 0.0).then_some(Piece { flown, ratios })
}
