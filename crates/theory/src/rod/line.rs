//! The two-stream equations of a walk through a rod, by collocation on short panels.
//!
//! ```text
//! m₊' = A m₊ − B m₋ − s₊,   m₋' = −A m₋ + B m₊ + s₋
//! ```
//!
//! m₊(x) and m₋(x) are the expected scores of a particle of weight 1 at x that flies forward or backward. A is the
//! rate at which it leaves its state, B the rate at which it turns round, and s the score per length. The polynomials
//! through the Gauss nodes xᵢ of a panel solve
//!
//! ```text
//! m₊(xᵢ) = p − ∫ᵢ¹ (A m₊ − B m₋ − s₊),   m₋(xᵢ) = m + ∫₀ⁱ (B m₊ − A m₋ + s₋)
//! ```
//!
//! for the values p and m that enter at the end and at the beginning. A panel is a layer with two reflections, a
//! transmission and an emission, and layers are joined by adding. With n nodes the error at the ends of panels is of
//! the order 2n in their width. At the nodes it is of the order n + 1 only. Sources may be values at the nodes all the
//! same: equations that use each other's values are one larger system on the same nodes.
//!
//! Source: E. Hairer, S. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I* (Springer, 1993), section II.7.

use std::cell::OnceCell;
use std::sync::LazyLock;

use super::walk::RodPoint;
use numeric::Span;
use numeric::matrix::Matrix;
use numeric::quadrature::GaussLegendre;

/// Number of nodes of a panel.
const NODES: usize = 8;
/// Number of values of each direction: those at the nodes, and the one that leaves the panel.
const ROWS: usize = NODES + 1;
/// Highest power of the weight.
const HIGHEST: usize = 8;

static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(NODES));

/// A rod cut into panels, from the beginning of the support to its end.
pub struct Line {
    /// Panels and their widths.
    panels: Vec<(Span, f64)>,
    nodes: Vec<RodPoint>,
    share: f64,
    /// Joined layers of both kinds of rates and of every power.
    flows: [[OnceCell<Option<Layers>>; HIGHEST + 1]; 2],
}

/// A function of a place.
type Rates<'f> = dyn Fn(&RodPoint) -> [f64; 2] + 'f;

impl Line {
    /// Joins panels with their widths and the places of their nodes, in order. What leaves a panel is increased by a share
    /// for each panel and each collision.
    pub fn new(panels: Vec<(Span, f64)>, nodes: Vec<RodPoint>, share: f64) -> Self {
        Self { panels, nodes, share, flows: Default::default() }
    }

    /// The places of the nodes of some panels.
    pub fn places(panels: &[(Span, f64)]) -> Vec<f64> {
        panels.iter().flat_map(|&(span, _)| RULE.nodes_on(span)).collect()
    }

    /// The nodes of all panels.
    pub fn nodes(&self) -> &[RodPoint] {
        &self.nodes
    }

    /// The equations of the k-th moment; `None` where the echoes diverge.
    pub fn flow(&self, k: i32) -> Option<Flow<'_>> {
        self.cached(0, k, &|node| node.rates(k))
    }

    /// The equations of the k-th moment between scatterings, with B = 0.
    pub fn straight(&self, k: i32) -> Option<Flow<'_>> {
        self.cached(1, k, &|node| [node.straight_rate(k), 0.0])
    }

    fn cached(&self, kind: usize, k: i32, rates: &Rates<'_>) -> Option<Flow<'_>> {
        let cell = self.flows[kind].get(usize::try_from(k).ok()?)?;
        let layers = cell.get_or_init(|| self.joined(rates)).as_ref()?;
        Some(Flow { line: self, layers })
    }

    fn joined(&self, rates: &Rates<'_>) -> Option<Layers> {
        let mut result = Layers { layers: Vec::new(), beyond: vec![0.0; self.panels.len() + 1] };
        let mut last = None;
        for panel in 0..self.panels.len() {
            let here = self.coefficients(panel, rates);
            let same = result.layers.last().filter(|_| last == Some(here)).cloned();
            result.layers.push(same.or_else(|| self.layer(here))?);
            last = Some(here);
        }
        for (i, layer) in result.layers.iter().enumerate().rev() {
            result.beyond[i] = layer.ends().seen(result.beyond[i + 1])?;
        }
        Some(result)
    }

    /// The first panel in which the echoes of the k-th moment diverge, and the reflection of all before it.
    ///
    /// The passed part reflects ρ, and the next layer r: their echoes `Σ(ρr)^n` diverge where ρr reaches 1.
    pub fn divergence(&self, k: i32) -> Option<(Span, f64)> {
        let mut passed = 0.0;
        for (panel, &(span, _)) in self.panels.iter().enumerate() {
            let here = self.coefficients(panel, &|node| node.rates(k));
            let next = self.layer(here)?.ends().turned().seen(passed);
            let Some(next) = next else { return Some((span, passed)) };
            passed = next;
        }
        None
    }

    /// The reflection of the first panel for the k-th moment, seen from its beginning.
    pub fn reflection(&self, k: i32) -> Option<f64> {
        Some(self.layer(self.coefficients(0, &|node| node.rates(k)))?.ends().back[0])
    }

    /// Width of a panel, and A, B and the rate of collisions of either kind at its nodes.
    fn coefficients(&self, panel: usize, rates: &Rates<'_>) -> (f64, [[f64; 3]; NODES]) {
        let nodes = &self.nodes[panel * NODES..][..NODES];
        let at_nodes = std::array::from_fn(|j| {
            let [a, b] = rates(&nodes[j]);
            [a, b, 2.0 * nodes[j].sampling + a.abs() + b.abs()]
        });
        (self.panels[panel].1, at_nodes)
    }

    /// A panel as a layer.
    fn layer(&self, (width, rates): (f64, [[f64; 3]; NODES])) -> Option<Layer> {
        let rule = &*RULE;
        // Weight of the node j in the integral up to a row, from the end for m₊ and from the beginning for m₋.
        let weight = |row: usize, j: usize| {
            let from_begin = rule.running.get(row % ROWS).unwrap_or(&rule.weights)[j];
            let is_end = row % ROWS == NODES;
            width * if row < ROWS && !is_end { rule.weights[j] - from_begin } else { from_begin }
        };
        let system = Matrix::new(2 * ROWS, 2 * ROWS, |row, column| match column % ROWS {
            NODES => 0.0,
            j if (row < ROWS) == (column < ROWS) => -rates[j][0] * weight(row, j),
            j => rates[j][1] * weight(row, j),
        });
        let inputs = Matrix::new(2 * ROWS, 2 * ROWS, |row, input| match input % ROWS {
            _ if (row < ROWS) != (input < ROWS) => 0.0,
            NODES => 1.0,
            j => weight(row, j),
        });
        let collisions: f64 = rates.iter().zip(&rule.weights).map(|(rates, w)| rates[2] * w).sum();
        let factor = 1.0 + self.share * (1.0 + width * collisions);
        let solved = system.series_times(&inputs)?;
        Some(Layer(std::array::from_fn(|input| {
            std::array::from_fn(|row| factor * solved.at(row, input))
        })))
    }

    /// `∫` of rates, given at each node, from each node to the end of the rod.
    pub fn to_end(&self, rates: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let widths: Vec<f64> = self.panels.iter().map(|&(_, width)| width).collect();
        RULE.all_to_end(&widths, rates)
    }

    /// Importance 1 everywhere.
    pub fn one(&self) -> Importance {
        Importance { nodes: vec![[1.0; 2]; self.nodes.len()], entering: 1.0 }
    }
}

/// A panel as a layer: values of m₊ and of m₋ for each input of one. Inputs of each direction are the sources at the
/// nodes, and the value that enters.
#[derive(Clone)]
struct Layer([[f64; 2 * ROWS]; 2 * ROWS]);

/// Rows and inputs of the values that leave and that enter a layer, in the direction of `m₊` and in the other.
const ENDS: [usize; 2] = [NODES, ROWS + NODES];

/// Transmissions and reflections of a layer.
#[derive(Clone, Copy)]
struct LayerResponse {
    through: [f64; 2],
    /// Reflections at the beginning and at the end.
    back: [f64; 2],
}

impl LayerResponse {
    /// The layer seen from its end.
    fn turned(self) -> Self {
        let [[a, b], [c, d]] = [self.through, self.back];
        Self { through: [b, a], back: [d, c] }
    }

    /// Reflection at the beginning with something that reflects ρ behind the end; `None` where the echoes diverge.
    fn seen(self, rho: f64) -> Option<f64> {
        let ([t, other], [front, back]) = (self.through, self.back);
        let echo = 1.0 - back * rho;
        (echo > 0.0 && t > 0.0).then(|| front + t * rho * other / echo)
    }
}

impl Layer {
    fn ends(&self) -> LayerResponse {
        let [p, m] = ENDS.map(|input| ENDS.map(|row| self.0[input][row]));
        LayerResponse { through: [p[0], m[1]], back: [m[0], p[1]] }
    }
}

/// Layers joined.
struct Layers {
    layers: Vec<Layer>,
    /// Reflection of all that begins with each layer, and of nothing.
    beyond: Vec<f64>,
}

/// The two-stream equations of one moment.
#[derive(Clone, Copy)]
pub struct Flow<'a> {
    line: &'a Line,
    layers: &'a Layers,
}

/// m₊ and m₋.
#[derive(Debug, Clone)]
pub struct Importance {
    nodes: Vec<[f64; 2]>,
    /// Value of the particle that enters.
    pub entering: f64,
}

impl Importance {
    /// Values at a node.
    #[inline]
    pub fn at(&self, node: usize) -> [f64; 2] {
        self.nodes[node]
    }
}

impl Flow<'_> {
    /// Solves the equations with given sources, where leaving at the beginning and at the end scores `ends`.
    pub fn solve(
        &self,
        source: &dyn Fn(usize, &RodPoint) -> [f64; 2],
        ends: [f64; 2],
    ) -> Importance {
        let Layers { layers, beyond } = self.layers;
        let mut inputs = vec![[0.0; 2 * ROWS]; layers.len()];
        // m₊ = ρ m₋ + η at the beginning of each layer, from the end of the rod backwards.
        let mut eta = vec![ends[1]; layers.len() + 1];
        // m₋ at the end of each layer, by its sources and by what enters at its end.
        let mut emitted = vec![0.0; layers.len()];
        for (i, layer) in layers.iter().enumerate().rev() {
            for j in 0..NODES {
                let node = i * NODES + j;
                [inputs[i][j], inputs[i][ROWS + j]] = source(node, &self.line.nodes[node]);
            }
            let pairs = inputs[i].iter().zip(&layer.0);
            let [plus, minus] = ENDS.map(|row| pairs.clone().map(|(x, y)| x * y[row]).sum::<f64>());
            let LayerResponse { through, back } = layer.ends();
            emitted[i] = (minus + back[1] * eta[i + 1]) / (1.0 - back[1] * beyond[i + 1]);
            eta[i] = plus + through[0] * (eta[i + 1] + beyond[i + 1] * emitted[i]);
        }
        let entering = beyond[0] * ends[0] + eta[0];
        let mut nodes = Vec::with_capacity(self.line.nodes.len());
        let mut minus = ends[0];
        for (i, layer) in layers.iter().enumerate() {
            let (LayerResponse { through, back }, rho) = (layer.ends(), beyond[i + 1]);
            let next = emitted[i] + through[1] * minus / (1.0 - back[1] * rho);
            [inputs[i][ENDS[0]], inputs[i][ENDS[1]]] = [rho * next + eta[i + 1], minus];
            let mut values = [0.0; 2 * ROWS];
            for (input, column) in inputs[i].iter().zip(&layer.0) {
                for (value, x) in values.iter_mut().zip(column) {
                    *value += input * x;
                }
            }
            nodes.extend((0..NODES).map(|j| [values[j], values[ROWS + j]]));
            minus = next;
        }
        Importance { nodes, entering }
    }
}
