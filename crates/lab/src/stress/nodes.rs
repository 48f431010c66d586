//! Linear differential equations along a line, solved at the Gauss nodes of panels in 32 digits.
//!
//! A function is stored as its values at the nodes: products, quotients and exponentials are taken node by node.
//! Integrals are those of the polynomial through the nodes of a panel.
//!
//! ```text
//! one way      U' = a U − g:    U(s) = ∫ₛ g e^{−∫ₛ a} dt + U(end) e^{−∫ₛ a}
//! both ways    m₊' = A m₊ − B m₋ − s₊,  m₋' = B m₊ − A m₋ + s₋:   m(t) = e^{Mt} (m(0) − ∫₀ᵗ e^{−Mt'} (s₊, −s₋) dt'),
//!              M² = κ² = A² − B²,  e^{Mt} = cosh κt + M sinh(κt)/κ
//! ```

use std::sync::LazyLock;

use numeric::DoubleDouble;
use numeric::quadrature::GaussLegendre;

/// Nodes of a panel.
const NODES: usize = 20;
/// Largest product of a panel's width and rate: polynomials of degree 19 leave 1e-24 of `e^{±2x}`.
const STEEPEST: f64 = 2.0;

/// Gauss' rule on `[0, 1]` with its running integrals.
struct GaussRule {
    nodes: [DoubleDouble; NODES],
    weights: [DoubleDouble; NODES],
    running: [[DoubleDouble; NODES]; NODES],
}

static RULE: LazyLock<GaussRule> = LazyLock::new(GaussRule::new);

/// Legendre polynomials of the degrees 0 … N.
fn legendre(x: DoubleDouble) -> [DoubleDouble; NODES + 1] {
    let mut p = [DoubleDouble::ONE; NODES + 1];
    p[1] = x;
    for k in 1..NODES {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

impl GaussRule {
    /// Finds the nodes by Newton's method from those in doubles; `∫ Pₖ = (Pₖ₊₁ − Pₖ₋₁)/(2k + 1)`.
    fn new() -> Self {
        let slope = |x: DoubleDouble, p: &[DoubleDouble]| {
            NODES as f64 * (x * p[NODES] - p[NODES - 1]) / (x * x - 1.0)
        };
        let rule = GaussLegendre::new(NODES);
        let nodes: [DoubleDouble; NODES] = std::array::from_fn(|i| {
            (0..3).fold(DoubleDouble::from(2.0 * rule.nodes[i] - 1.0), |x, _| {
                let p = legendre(x);
                x - p[NODES] / slope(x, &p)
            })
        });
        let values = nodes.map(legendre);
        let weights = std::array::from_fn(|i| {
            let slope = slope(nodes[i], &values[i]);
            1.0 / ((1.0 - nodes[i] * nodes[i]) * slope * slope)
        });
        let running = |i: usize, j: usize| {
            let of_degree = |k: usize| values[j][k] * (values[i][k + 1] - values[i][k - 1]);
            let sum: DoubleDouble = (1..NODES).map(of_degree).sum();
            (weights[j] * (1.0 + nodes[i] + sum)).scaled(-1)
        };
        let running = std::array::from_fn(|i| std::array::from_fn(|j| running(i, j)));
        Self { nodes: nodes.map(|x| (1.0 + x).scaled(-1)), weights, running }
    }
}

/// `Σ wⱼ fⱼ`.
fn sum(weights: &[DoubleDouble; NODES], values: &[DoubleDouble]) -> DoubleDouble {
    weights.iter().zip(values).map(|(&weight, &value)| weight * value).sum()
}

/// A part of a line.
#[derive(Debug, Clone, Copy)]
struct LinePanel {
    stretch: usize,
    from: DoubleDouble,
    width: DoubleDouble,
}

/// A line in panels.
pub(super) struct PanelLine(Vec<LinePanel>);

/// Values at the nodes of a line, in order, and at its beginning.
pub(super) struct Solution<T> {
    /// Values at the nodes.
    pub at: Vec<T>,
    /// Value at the beginning.
    pub begin: T,
}

impl PanelLine {
    /// Cuts the stretches between ends into panels, given the largest rate in each.
    pub fn new(ends: &[DoubleDouble], rate: impl Fn(usize) -> f64) -> Self {
        let cut = |(stretch, pair): (usize, &[DoubleDouble])| {
            let length = pair[1] - pair[0];
            let count = (rate(stretch) * length.high / STEEPEST).ceil().max(1.0);
            let (from, width) = (pair[0], length / count);
            let panels = (0..).map(f64::from).take_while(move |&i| i < count);
            panels.map(move |i| LinePanel { stretch, from: from + width * i, width })
        };
        Self(ends.windows(2).enumerate().flat_map(cut).collect())
    }

    /// Returns the value of a function of the stretch and the place at every node.
    pub fn values<T>(&self, f: impl Fn(usize, DoubleDouble) -> T) -> Vec<T> {
        let place =
            |panel: &LinePanel, x: DoubleDouble| f(panel.stretch, panel.from + panel.width * x);
        self.0.iter().flat_map(|panel| RULE.nodes.map(|x| place(panel, x))).collect()
    }

    /// Solves one equation with `U(end) = 0`, given a and g by the number of the node.
    pub fn one_way(
        &self,
        rate: impl Fn(usize) -> DoubleDouble,
        source: impl Fn(usize) -> DoubleDouble,
    ) -> Solution<DoubleDouble> {
        let mut at = vec![DoubleDouble::default(); self.0.len() * NODES];
        let mut begin = DoubleDouble::default();
        for ((number, panel), at) in self.0.iter().enumerate().zip(at.chunks_mut(NODES)).rev() {
            let width = panel.width;
            let rates: [DoubleDouble; NODES] = std::array::from_fn(|i| rate(number * NODES + i));
            let left = RULE.running.map(|weights| (-(width * sum(&weights, &rates))).exp());
            let left_at_end = (-(width * sum(&RULE.weights, &rates))).exp();
            let gained: [DoubleDouble; NODES] =
                std::array::from_fn(|i| left[i] * source(number * NODES + i));
            let all = width * sum(&RULE.weights, &gained) + begin * left_at_end;
            for (i, value) in at.iter_mut().enumerate() {
                *value = (all - width * sum(&RULE.running[i], &gained)) / left[i];
            }
            begin = all;
        }
        Solution { at, begin }
    }

    /// Solves two equations with `m₋(0)` and `m₊(end)` given, A and B by the stretch, s± by the number of the node.
    /// The value at the beginning is `m₊`.
    ///
    /// First, from the end back: how `m₊` depends on `m₋` at the beginning of each panel ([`Beyond`]). Then, from the
    /// beginning on: the values in each panel.
    pub fn both_ways(
        &self,
        rates: impl Fn(usize) -> [DoubleDouble; 2],
        source: impl Fn(usize) -> [DoubleDouble; 2],
        [first, last]: [DoubleDouble; 2],
    ) -> Solution<BothDirections> {
        let panels = self.0.iter().enumerate();
        let panels = panels.map(|(number, panel)| {
            Passage::new(rates(panel.stretch), panel.width, |node| source(number * NODES + node))
        });
        let panels: Vec<Passage> = panels.collect();
        let end = Beyond { returned: DoubleDouble::default(), emitted: last };
        let beyond = panels.iter().rev().scan(end, |beyond, panel| {
            *beyond = beyond.before(panel);
            Some(*beyond)
        });
        let beyond: Vec<Beyond> = beyond.collect();
        let mut minus = first;
        let mut at = Vec::with_capacity(self.0.len() * NODES);
        let mut begin = None;
        for (panel, beyond) in panels.iter().zip(beyond.iter().rev()) {
            let here = [beyond.returned * minus + beyond.emitted, minus];
            begin.get_or_insert(here);
            at.extend((0..NODES).map(|node| panel.value(node, here)));
            minus = panel.value(NODES, here)[1];
        }
        Solution { at, begin: begin.unwrap_or([last, first]) }
    }
}

/// A panel between its beginning and its nodes; number `NODES` is its end.
struct Passage {
    /// `e^{Mt}`.
    flows: [Flow; NODES + 1],
    /// `∫₀ᵗ e^{−Mt'} (s₊, −s₋) dt'`.
    lost: [BothDirections; NODES + 1],
}

impl Passage {
    /// A panel with its A and B, its width, and its s± by the number of the node.
    fn new(
        rates: [DoubleDouble; 2],
        width: DoubleDouble,
        source: impl Fn(usize) -> [DoubleDouble; 2],
    ) -> Self {
        let place = |node: usize| if node < NODES { RULE.nodes[node] } else { DoubleDouble::ONE };
        let flows = std::array::from_fn(|node| Flow::new(rates, width * place(node)));
        let rate: [BothDirections; NODES] = std::array::from_fn(|node| {
            let [plus, minus] = source(node);
            Flow::back(flows[node], [plus, -minus])
        });
        let ways = [0, 1].map(|way| rate.map(|rate| rate[way]));
        let lost = std::array::from_fn(|node| {
            let weights = if node < NODES { &RULE.running[node] } else { &RULE.weights };
            ways.map(|rate| width * sum(weights, &rate))
        });
        Self { flows, lost }
    }

    /// The values at a node, given those at the beginning.
    fn value(&self, node: usize, begin: BothDirections) -> BothDirections {
        let lost = self.lost[node];
        self.flows[node].on([begin[0] - lost[0], begin[1] - lost[1]])
    }
}

/// The line beyond a place: `m₊ = returned · m₋ + emitted` there.
#[derive(Clone, Copy)]
struct Beyond {
    returned: DoubleDouble,
    emitted: DoubleDouble,
}

impl Beyond {
    /// The line beyond the beginning of a panel, given the line beyond its end.
    ///
    /// `m₊ − returned · m₋ = emitted` at the end is linear in the values at the beginning.
    fn before(self, panel: &Passage) -> Self {
        let at_end = |begin: BothDirections| {
            let [plus, minus] = panel.flows[NODES].on(begin);
            plus - self.returned * minus
        };
        let of_plus = at_end([DoubleDouble::ONE, DoubleDouble::default()]);
        let of_minus = at_end([DoubleDouble::default(), DoubleDouble::ONE]);
        Self {
            returned: -of_minus / of_plus,
            emitted: (self.emitted + at_end(panel.lost[NODES])) / of_plus,
        }
    }
}

/// Values of a particle that goes forward, and of one that goes backward.
pub(super) type BothDirections = [DoubleDouble; 2];

/// The matrix `e^{Mt}` by three numbers: `cosh κt`, `A sinh(κt)/κ` and `B sinh(κt)/κ`.
#[derive(Clone, Copy)]
struct Flow([DoubleDouble; 3]);

impl Flow {
    fn new([a, b]: [DoubleDouble; 2], t: DoubleDouble) -> Self {
        let square = (a - b) * (a + b) * t * t;
        let (mut even, mut odd, mut term) =
            (DoubleDouble::ONE, DoubleDouble::ONE, DoubleDouble::ONE);
        for n in 1..=14 {
            let n = f64::from(2 * n);
            term = term * square / (n * (n - 1.0));
            even += term;
            odd += term / (n + 1.0);
        }
        Self([even, a * t * odd, b * t * odd])
    }

    fn on(self, [plus, minus]: BothDirections) -> BothDirections {
        let Self([even, a, b]) = self;
        [(even + a) * plus - b * minus, b * plus + (even - a) * minus]
    }

    /// `e^{−Mt}`.
    fn back(self, both: BothDirections) -> BothDirections {
        let Self([even, a, b]) = self;
        Self([even, -a, -b]).on(both)
    }
}

/// Values after a collision that leads onward or turns, with these factors.
pub(super) fn after(
    [onward, turned]: [DoubleDouble; 2],
    [plus, minus]: BothDirections,
) -> BothDirections {
    [onward * plus + turned * minus, onward * minus + turned * plus]
}
