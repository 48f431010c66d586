//! Shells of a ball; in each of them the mean intensity is a polynomial of `r²`.
//!
//! At the surface the mean intensity has a term `(R − r) ln(R − r)`, at a black sphere of radius ρ one like
//! `√(r − ρ)`. Towards such a place the shells are halved repeatedly, and the polynomials
//! lose degrees as the shells lose weight. On a ray `r² = p² + t²`, p its distance from the centre and t the
//! distance from its foot: a function that is smooth in `r²` is smooth along the ray, even where the ray passes the
//! centre.

use numeric::Known;
use numeric::quadrature::{GaussLegendre, legendre};

/// A shell: `from ≤ r² ≤ to`.
#[derive(Debug, Clone)]
pub struct Shell {
    /// The square of the inner radius.
    pub from: f64,
    /// The square of the outer radius.
    pub to: f64,
    /// Number of Gauss nodes of `r²`.
    pub nodes: usize,
    /// Index of the first of them among all.
    pub first: usize,
}

/// Resolution of a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallResolution {
    /// Nodes of a shell that is not near a place of grading.
    pub nodes: usize,
    /// Nodes between two directions at which the radiance changes its character.
    pub directions: usize,
    /// Number of halvings of shells towards the surface.
    pub surface: u32,
    /// Number of halvings of shells towards a black sphere.
    pub core: u32,
    /// Relative error at which two answers may agree by accident: several times a measured one.
    pub probability: f64,
}

impl BallResolution {
    /// Resolution of reference values: about twelve digits.
    pub const FINE: Self =
        Self { nodes: 12, directions: 12, surface: 15, core: 23, probability: 2e-13 };
    /// Resolution for comparison with draws: about seven digits.
    pub const COARSE: Self =
        Self { nodes: 7, directions: 7, surface: 8, core: 11, probability: 1e-8 };

    /// Answer with the error from two other resolutions.
    pub(super) fn known(self, [fine, coarse, other]: [f64; 3]) -> Known {
        let difference = (fine - coarse).abs().max(SAFETY * (fine - other).abs());
        Known::estimated(fine, difference + self.probability * fine.abs())
    }

    /// Resolution around the centre: shells as wide as a small black sphere resolve `1/r²` badly, with similar
    /// errors in all three answers.
    pub(super) fn about(self, centre: Centre, radius: f64) -> Self {
        match centre {
            Centre::Black(core) => {
                Self { probability: self.probability * (2.0 * radius / core).powi(2), ..self }
            }
            Centre::Medium => self,
        }
    }

    /// Resolutions for error bounds: the answers of both others differ by more than the error of the finest, unless
    /// they agree by accident. All three seldom do.
    pub(super) fn all(self) -> [Self; 3] {
        [self, self.coarser([2, 2, 3]), self.coarser([1, 1, 1])]
    }

    fn coarser(self, [nodes, surface, core]: [u32; 3]) -> Self {
        Self {
            nodes: self.nodes - nodes as usize,
            directions: self.directions - nodes as usize,
            surface: self.surface - surface,
            core: self.core - core,
            probability: self.probability,
        }
    }
}

/// Factor of the difference to the answer of nearly the same resolution. Of 6000 answers that state less than 1e-4
/// none deviated by more than half of that.
const SAFETY: f64 = 8.0;

/// Content of the centre of a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Centre {
    /// The medium.
    Medium,
    /// A black sphere of the given radius.
    Black(f64),
}

/// Minimum number of nodes of a shell.
const FEWEST: usize = 4;
/// Maximum optical depth across a shell.
const THICKEST: f64 = 1.0;
/// Maximum ratio of `r²` across a shell around a black sphere. Light from there falls off like `1/r²`, which a
/// polynomial of n nodes resolves to about 12⁻ⁿ. Across a ratio of 2 it is 6⁻ⁿ: the answers of five and six nodes,
/// which the error bounds use, are then wrong by hundreds of times the error of the finest.
const WIDEST: f64 = 1.4;

/// `2⁻ⁿ`.
pub(super) fn halved(times: u32) -> f64 {
    0.5f64.powi(times.cast_signed())
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // small and not negative
pub(super) fn whole(x: f64) -> usize {
    x as usize
}

/// The shells of a ball, from the inside out.
#[derive(Debug, Clone)]
pub struct Shells {
    /// Shells from the inside out.
    pub shells: Vec<Shell>,
    /// Number of nodes of all shells.
    pub count: usize,
}

impl Shells {
    /// Cuts a ball of a radius, in which `extinction` is a function of `r²`.
    pub fn new(
        radius: f64,
        centre: Centre,
        extinction: &dyn Fn(f64) -> f64,
        resolution: BallResolution,
    ) -> Self {
        let outer = radius * radius;
        let (inner, halvings, drop) = match centre {
            Centre::Medium => (0.0, 0, 1.0),
            // Nodes lost with each halving: the errors of √x, 1/√x and x ln x weighted with the shell.
            Centre::Black(core) => (core * core, resolution.core, 0.5),
        };
        let widest = if matches!(centre, Centre::Black(_)) { WIDEST } else { f64::INFINITY };
        let middle = 0.5 * (inner + outer);
        let mut parts = Vec::new();
        let nodes = |level: u32, drop: f64| {
            let lost = whole(drop * f64::from(level));
            resolution.nodes.saturating_sub(lost).max(FEWEST)
        };
        let half = middle - inner;
        parts.push((inner, inner + half * halved(halvings), nodes(halvings, drop)));
        for level in (0..halvings).rev() {
            let from = inner + half * halved(level + 1);
            parts.push((from, inner + half * halved(level), nodes(level, drop)));
        }
        for level in 0..resolution.surface {
            let from = outer - half * halved(level);
            let to = outer - half * halved(level + 1);
            parts.push((from, to, nodes(level, 0.66)));
        }
        let last = outer - half * halved(resolution.surface);
        parts.push((last, outer, nodes(resolution.surface, 0.66)));
        let mut result = Self { shells: Vec::new(), count: 0 };
        for (from, to, nodes) in parts {
            let width = to.sqrt() - from.sqrt();
            let thickest = (0..=8)
                .map(|i| extinction(from + (to - from) * f64::from(i) / 8.0))
                .fold(0.0, f64::max);
            let steep = if widest < f64::INFINITY { (to / from).ln() / widest.ln() } else { 0.0 };
            let pieces = (thickest * width / THICKEST).max(steep).ceil().clamp(1.0, 256.0);
            let mut below = from;
            for piece in 1..=whole(pieces) {
                // Equal steps in r, of about equal optical depth.
                let r = from.sqrt() + width * piece as f64 / pieces;
                let above = if piece as f64 >= pieces { to } else { r * r };
                result.shells.push(Shell { from: below, to: above, nodes, first: result.count });
                result.count += nodes;
                below = above;
            }
        }
        result
    }

    /// The values of `r²` at all nodes.
    pub fn nodes(&self, rules: &GaussRules) -> Vec<f64> {
        let at = |shell: &Shell| -> Vec<f64> {
            let nodes = &rules.of(shell.nodes).nodes;
            nodes.iter().map(|x| shell.from + (shell.to - shell.from) * x).collect()
        };
        self.shells.iter().flat_map(at).collect()
    }
}

/// Gauss–Legendre rules of every size that is needed.
#[derive(Debug, Clone)]
pub struct GaussRules(Vec<GaussLegendre>);

impl GaussRules {
    /// Rules of 1 to `maximum` nodes.
    pub fn new(maximum: usize) -> Self {
        Self((1..=maximum.max(1)).map(GaussLegendre::new).collect())
    }

    /// The rule of a number of nodes, clamped to those that exist.
    pub fn of(&self, nodes: usize) -> &GaussLegendre {
        &self.0[nodes.clamp(1, self.0.len()) - 1]
    }
}

/// Number of places that are computed side by side.
const SIDE: usize = 8;

/// Values of a linear functional for the Legendre polynomials of each shell. They give its weights for the values
/// at the nodes.
///
/// ```text
/// ℓⱼ(x) = wⱼ Σₘ (2m + 1) Pₘ(xⱼ) Pₘ(x),   x from −1 to 1, Σⱼ wⱼ = 1
/// ```
#[derive(Debug, Clone)]
pub struct FunctionalRow(Vec<f64>);

impl FunctionalRow {
    /// The functional 0 on `count` nodes.
    pub fn new(count: usize) -> Self {
        Self(vec![0.0; count])
    }

    /// Adds weights times the values at places of `r²` within a shell, some of them side by side.
    #[inline]
    pub fn add(&mut self, shell: &Shell, places: &[f64], weights: &[f64]) {
        let moments = &mut self.0[shell.first..][..shell.nodes];
        for (places, weights) in places.chunks(SIDE).zip(weights.chunks(SIDE)) {
            let [mut x, mut previous, mut value] = [[0.0; SIDE]; 3];
            for (x, r2) in x.iter_mut().zip(places) {
                *x = 2.0 * (r2 - shell.from) / (shell.to - shell.from) - 1.0;
            }
            value[..weights.len()].copy_from_slice(weights);
            for (m, moment) in moments.iter_mut().enumerate() {
                for value in &value {
                    *moment += value;
                }
                let m = m as f64;
                for i in 0..SIDE {
                    let next = ((2.0 * m + 1.0) * x[i] * value[i] - m * previous[i]) / (m + 1.0);
                    (previous[i], value[i]) = (value[i], next);
                }
            }
        }
    }

    /// The weights of the values at the nodes.
    pub fn weights(&self, shells: &Shells, rules: &GaussRules) -> Vec<f64> {
        let mut weights = Vec::with_capacity(self.0.len());
        for shell in &shells.shells {
            let moments = &self.0[shell.first..][..shell.nodes];
            let rule = rules.of(shell.nodes);
            for (&node, &w) in rule.nodes.iter().zip(&rule.weights) {
                let x = 2.0 * node - 1.0;
                let terms = moments.iter().zip(legendre(x)).enumerate();
                let sum: f64 = terms.map(|(m, (a, p))| (2.0 * m as f64 + 1.0) * p * a).sum();
                weights.push(w * sum);
            }
        }
        weights
    }
}
