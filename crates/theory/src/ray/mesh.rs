//! A ray cut into panels on which everything is smooth.

mod even;

use media::Medium;
use numeric::quadrature::{GaussLegendre, dot, legendre};
use numeric::sum::Sum;
use numeric::{Known, Span, order, roots};
use std::ops::Range;

/// Nodes per panel, unless the medium needs fewer.
const NODES: usize = 16;
/// Above this many panels a medium's own number of nodes is used.
const MANY: usize = 2000;
/// Legendre coefficients of the two highest orders, relative to the largest value: a panel with
/// larger ones is halved.
const TAIL: f64 = 1e-13;
/// Tails below this that halving does not shrink are rounding noise. A larger tail belongs to a function that is
/// not resolved yet: it may grow for a while. Callers keep noisier functions away.
const NOISE: f64 = 1e-9;
/// Maximum number of panels of an adaptive mesh: a function that needs more contains noise.
const MAX_PANELS: usize = 50_000;
/// Rounding of a polynomial through nodes, relative to its largest value.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Distance between an upper bound of a function and its largest value, relative to that.
const TIGHT: f64 = 0.01;
/// Shortest part of a panel with a bound of its own, relative to the support.
const SHORTEST: f64 = 1e-12;
/// Maximum number of halvings for one bound, which then is not as tight.
const MAX_HALVINGS: usize = 100_000;
/// Maximum number of halvings of one panel.
const HALVINGS: u32 = 40;
/// Distance from the ends of a panel at which its edges are, relative to its length: beside a jump there.
const EDGE: f64 = 1e-9;

/// The support of a medium cut into panels with Gauss–Legendre nodes, and σ_t at the nodes.
///
/// Panels end at every break of the medium. Between breaks they are halved until the interpolation
/// polynomial through the nodes has no tail: until the Legendre coefficients
/// `c_k = (2k + 1) Σ wᵢ f(tᵢ) P_k` of the two highest orders vanish to 1e-13 of the largest value.
/// The quadrature error is then of the order of the square of that.
#[derive(Clone)]
pub struct Mesh {
    medium: Medium,
    rule: GaussLegendre,
    /// Weights that turn node values into each Legendre coefficient.
    legendre: Vec<Vec<f64>>,
    panels: Vec<Span>,
    t: Vec<f64>,
    extinction: Vec<f64>,
    adaptive: bool,
    /// True if panels do not end at kinks, see [`Mesh::coarse`].
    is_coarse: bool,
    error: f64,
    /// τ over the support: a closed form may be a sum over thousands of pieces.
    depth: Known,
    /// σ_t next to both ends of each panel, see [`EDGE`]; empty for media with thousands of breaks.
    edges: Vec<[f64; 2]>,
}

/// The nodes of one panel.
#[derive(Debug, Clone, Copy)]
pub struct Panel<'a> {
    /// The panel's ends.
    pub span: Span,
    /// Distances of the nodes.
    pub t: &'a [f64],
    /// σ_t at the nodes.
    pub extinction: &'a [f64],
}

impl Panel<'_> {
    /// Distances next to both ends.
    fn edges(&self) -> [f64; 2] {
        let inset = EDGE * self.span.length();
        [self.span.from + inset, self.span.to - inset]
    }
}

/// Functions of a caller at the nodes of a panel, which must be smooth there.
pub type Functions<'f> = dyn Fn(&Mesh, Panel<'_>) -> Vec<Vec<f64>> + 'f;

/// The size of a function on a panel or one that holds it, and of its highest coefficients.
#[derive(Debug, Clone, Copy)]
struct Tail {
    scale: f64,
    size: f64,
}

fn is_rough(tails: &[Tail], parent: &[Tail]) -> bool {
    tails.iter().enumerate().any(|(i, tail)| {
        let shrinks = parent.get(i).is_none_or(|before| tail.size < 0.5 * before.size);
        tail.size > TAIL * tail.scale && (shrinks || tail.size > NOISE * tail.scale)
    })
}

/// The largest value of each function over all panels.
fn largest(tails: &[Vec<Tail>]) -> Vec<Tail> {
    let mut whole: Vec<Tail> = Vec::new();
    for panel in tails {
        for (i, tail) in panel.iter().enumerate() {
            match whole.get_mut(i) {
                Some(known) => known.scale = known.scale.max(tail.scale),
                None => whole.push(Tail { size: f64::INFINITY, ..*tail }),
            }
        }
    }
    whole
}

impl Mesh {
    /// Cuts the support of a medium and looks σ_t up at every node.
    pub fn new(medium: Medium) -> Self {
        let support = medium.support();
        let ends = support.cut(medium.breaks());
        let many = ends.len() > MANY;
        let nodes = if many { medium.panel_nodes().unwrap_or(NODES) } else { NODES };
        let mut mesh = Self::without_panels(medium, nodes, !many);
        mesh.depth = mesh.medium.optical_depth(support);
        let largest =
            |span: Span| mesh.medium.extinctions(&mesh.nodes(span)).into_iter().fold(0.0, f64::max);
        let scale = if many { 0.0 } else { Span::between(&ends).map(largest).fold(0.0, f64::max) };
        let whole = [Tail { scale, size: f64::INFINITY }];
        for span in Span::between(&ends) {
            mesh.grow(span, HALVINGS, &|_, panel| vec![panel.extinction.to_vec()], &whole);
        }
        mesh.error += mesh.measured_error();
        mesh
    }

    fn without_panels(medium: Medium, nodes: usize, adaptive: bool) -> Self {
        let rule = GaussLegendre::new(nodes);
        let legendre = (0..nodes).map(|order| legendre_row(&rule, order)).collect();
        let (panels, t, extinction, edges) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (depth, is_coarse) = (Known::new(0.0, 0.0), false);
        Self {
            medium,
            rule,
            legendre,
            panels,
            t,
            extinction,
            adaptive,
            is_coarse,
            error: 0.0,
            depth,
            edges,
        }
    }

    /// The medium.
    pub fn medium(&self) -> &Medium {
        &self.medium
    }

    /// The support of the medium, which the panels cover.
    pub fn support(&self) -> Span {
        self.medium.support()
    }

    /// The panels in ascending order.
    pub fn panels(&self) -> impl DoubleEndedIterator<Item = Panel<'_>> + ExactSizeIterator {
        let n = self.rule.nodes.len();
        self.panels.iter().enumerate().map(move |(i, &span)| {
            let nodes = i * n..(i + 1) * n;
            Panel { span, t: &self.t[nodes.clone()], extinction: &self.extinction[nodes] }
        })
    }

    /// A mesh that also ends panels at `cuts` and on which every function that `smooth` makes of a
    /// panel's nodes is smooth.
    ///
    /// Media with thousands of breaks are only cut: their panels are short already.
    #[must_use]
    pub fn refined(&self, cuts: &[f64], smooth: &Functions<'_>) -> Self {
        let mut cuts = cuts.to_vec();
        order::ascend(&mut cuts);
        let mut fine = Self {
            medium: self.medium.clone(),
            rule: self.rule.clone(),
            legendre: self.legendre.clone(),
            panels: Vec::with_capacity(self.panels.len()),
            t: Vec::with_capacity(self.t.len()),
            extinction: Vec::with_capacity(self.t.len()),
            edges: Vec::with_capacity(self.edges.len()),
            ..*self
        };
        let tails = |panel| self.tails(&smooth(self, panel), &[]);
        let mut tails: Vec<Vec<Tail>> =
            if self.adaptive { self.panels().map(tails).collect() } else { Vec::new() };
        // A function that is small relative to its maximum need not be smooth to its own last digits.
        let whole = largest(&tails);
        for tail in &mut tails {
            tail.iter_mut().zip(&whole).for_each(|(tail, whole)| tail.scale = whole.scale);
        }
        for (i, panel) in self.panels().enumerate() {
            let first = cuts.partition_point(|&cut| cut <= panel.span.from);
            let last = cuts.partition_point(|&cut| cut < panel.span.to);
            let inside = &cuts[first..last.max(first)];
            let is_smooth = !self.adaptive || !is_rough(&tails[i], &whole);
            if inside.is_empty() && is_smooth {
                fine.keep(panel);
                fine.edges.extend(self.edges.get(i));
                continue;
            }
            let mut ends = vec![panel.span.from];
            ends.extend(inside);
            ends.push(panel.span.to);
            ends.dedup();
            for span in Span::between(&ends) {
                fine.grow(span, HALVINGS, smooth, &whole);
            }
        }
        fine
    }

    /// A mesh that also ends panels at `cuts`.
    #[must_use]
    pub fn cut(&self, cuts: &[f64]) -> Self {
        self.refined(cuts, &|_, _| Vec::new())
    }

    /// Places inside the support where panels end: `cuts`, and where a function `kink(t, σ_t)` changes its sign. A
    /// coarse mesh does without the latter.
    pub fn cuts<K: Fn(f64, f64) -> f64>(
        &self,
        mut cuts: Vec<f64>,
        kinks: impl IntoIterator<Item = K>,
    ) -> Vec<f64> {
        if !self.is_coarse {
            let cut = self.cut(&cuts);
            cuts.extend(kinks.into_iter().flat_map(|kink| cut.roots(&kink)));
        }
        cuts.retain(|&t| self.support().contains_inside(t));
        cuts
    }

    /// Places where panels for several channels end: `cuts`, the ends of the panels of each, and where rates of two
    /// channels at a distance cross.
    pub fn joint_cuts<const N: usize>(
        meshes: &[&Self],
        mut cuts: Vec<f64>,
        rates: &dyn Fn(usize, f64) -> [f64; N],
    ) -> Vec<f64> {
        cuts.extend(meshes.iter().flat_map(|mesh| mesh.panels().map(|panel| panel.span.from)));
        let pairs = (0..meshes.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
        let crossed = pairs.flat_map(|[i, j]| (0..N).map(move |event| [i, j, event]));
        let apart = crossed
            .map(|[i, j, event]| move |t: f64, _: f64| rates(i, t)[event] - rates(j, t)[event]);
        meshes[0].cuts(cuts, apart)
    }

    fn keep(&mut self, panel: Panel<'_>) {
        self.panels.push(panel.span);
        self.t.extend_from_slice(panel.t);
        self.extinction.extend_from_slice(panel.extinction);
    }

    /// Adds a panel, or its halves where a function on it is not smooth.
    ///
    /// `parent` holds the tails of the panel that this one is a half of.
    fn grow(&mut self, span: Span, halvings: u32, smooth: &Functions<'_>, parent: &[Tail]) {
        let t = self.nodes(span);
        let extinction = self.medium.extinctions(&t);
        let panel = Panel { span, t: &t, extinction: &extinction };
        let room =
            halvings > 0 && self.panels.len() < MAX_PANELS && span.contains_inside(span.middle());
        let tails =
            if self.adaptive { self.tails(&smooth(self, panel), parent) } else { Vec::new() };
        let rough = is_rough(&tails, parent);
        if rough && !room {
            // A function that stays unresolved adds an error to the integrals, which is stated.
            let share = span.length() / self.support().length();
            let left = tails.iter().map(|tail| tail.size / tail.scale).fold(0.0, f64::max);
            self.error += share * left;
        }
        if rough && room {
            for half in span.halves() {
                self.grow(half, halvings - 1, smooth, &tails);
            }
        } else {
            self.keep(panel);
            if self.adaptive {
                self.edges.push(panel.edges().map(|t| self.medium.extinction(t)));
            }
        }
    }

    /// The distances of the nodes of a panel.
    pub(crate) fn nodes(&self, span: Span) -> Vec<f64> {
        self.rule.nodes_on(span)
    }

    fn tails(&self, functions: &[Vec<f64>], parent: &[Tail]) -> Vec<Tail> {
        let tail = |(i, f): (usize, &Vec<f64>)| {
            let largest = f.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let highest = self.legendre.iter().rev().take(2);
            let size = highest.map(|row| dot(row, f).abs()).fold(0.0, f64::max);
            Tail { scale: parent.get(i).map_or(largest, |tail| tail.scale.max(largest)), size }
        };
        functions.iter().enumerate().map(tail).collect()
    }

    /// `∫ f` over a panel, from values at its nodes.
    pub fn integral(&self, panel: Panel<'_>, f: &[f64]) -> f64 {
        panel.span.length() * dot(&self.rule.weights, f)
    }

    /// The rule of every panel.
    pub(crate) fn rule(&self) -> &GaussLegendre {
        &self.rule
    }

    /// Solves `−U' = f − rate · U` on a panel backwards from its end, see [`GaussLegendre::backward`].
    pub fn backward(&self, panel: Panel<'_>, rate: &[f64], f: &[f64], end: f64) -> (Vec<f64>, f64) {
        let length = panel.span.length();
        let f: Vec<f64> = f.iter().map(|f| length * f).collect();
        self.rule.backward(&self.running(panel, rate), self.integral(panel, rate), &f, end)
    }

    /// `∫ f` from the panel's beginning to each of its nodes.
    pub fn running(&self, panel: Panel<'_>, f: &[f64]) -> Vec<f64> {
        let length = panel.span.length();
        self.rule.running.iter().map(|row| length * dot(row, f)).collect()
    }

    /// `∫ f(t, σ_t)` over the support.
    pub fn integrate(&self, f: &dyn Fn(f64, f64) -> f64) -> f64 {
        self.integrate_nodes(&|node| f(self.t[node], self.extinction[node]))
    }

    /// Panels with the numbers of their nodes.
    pub fn numbered(&self) -> impl Iterator<Item = (Panel<'_>, Range<usize>)> {
        let n = self.rule.nodes.len();
        self.panels().enumerate().map(move |(i, panel)| (panel, i * n..(i + 1) * n))
    }

    /// `∫ f` over the support, from values at nodes by their numbers.
    pub fn integrate_nodes(&self, f: &dyn Fn(usize) -> f64) -> f64 {
        let mut sum = Sum::default();
        for (panel, nodes) in self.numbered() {
            sum.add(self.integral(panel, &nodes.map(f).collect::<Vec<f64>>()));
        }
        sum.value()
    }

    /// A relative error bound for integrals on this mesh: the deviation of `∫σ_t` by quadrature from the exact
    /// optical depth, and 1e-13 for errors that this does not show.
    pub fn relative_error(&self) -> f64 {
        self.error
    }

    fn measured_error(&self) -> f64 {
        let exact = self.depth.value;
        if exact == 0.0 {
            return 1e-13;
        }
        1e-13 + ((self.integrate(&|_, sigma| sigma) - exact) / exact).abs()
    }

    /// The distances at which `f(t, σ_t)` changes sign.
    pub fn roots(&self, f: &dyn Fn(f64, f64) -> f64) -> Vec<f64> {
        let mut result = Vec::new();
        let at = |t: f64| f(t, self.medium.extinction(t));
        for (i, panel) in self.panels().enumerate() {
            let mut last = None;
            for (&t, &sigma) in panel.t.iter().zip(panel.extinction) {
                let value = f(t, sigma);
                match last {
                    Some((before, old)) if (old < 0.0) != (value < 0.0) => {
                        result.push(roots::root(before, t, &at));
                    }
                    _ => {}
                }
                last = Some((t, value));
            }
            // The gaps between the outer nodes and the ends, without the jumps at the ends; thousands of panels
            // have gaps too short to matter.
            let Some(&[sigma_first, sigma_last]) = self.edges.get(i) else { continue };
            let ([low, high], end) = (panel.edges(), panel.t.len() - 1);
            let node = |i: usize| (panel.t[i], panel.extinction[i]);
            for [a, b] in [[(low, sigma_first), node(0)], [node(end), (high, sigma_last)]] {
                if a.0 < b.0 && (f(a.0, a.1) < 0.0) != (f(b.0, b.1) < 0.0) {
                    result.push(roots::root(a.0, b.0, &at));
                }
            }
        }
        result
    }

    /// Position and value of the maximum of `f(t, σ_t)`: the best node, then a search between the nodes beside it.
    /// `None` on an empty support.
    pub fn largest(&self, f: &dyn Fn(f64, f64) -> f64) -> Option<(f64, f64)> {
        self.largest_in(self.support(), f)
    }

    /// Maximum of `f(t, σ_t)` over a part of the support that begins and ends with panels.
    pub fn largest_in(&self, span: Span, f: &dyn Fn(f64, f64) -> f64) -> Option<(f64, f64)> {
        let (from, to) =
            (self.t.partition_point(|&t| t < span.from), self.t.partition_point(|&t| t <= span.to));
        let best = (from..to)
            .map(|i| (i, f(self.t[i], self.extinction[i])))
            .max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (index, at_node) = best;
        let panel = self.panels[index / self.rule.nodes.len()];
        let edge = 1e-9 * panel.length();
        let inside = Span::new(panel.from + edge, panel.to - edge);
        let before = if index == 0 { inside.from } else { self.t[index - 1].max(inside.from) };
        let after = self.t.get(index + 1).map_or(inside.to, |t| t.min(inside.to));
        let at = |t: f64| f(t, self.medium.extinction(t));
        let peak = roots::minimum(before, after, 1e-9 * panel.length(), &|t| -at(t));
        let candidates =
            [(self.t[index], at_node), (peak, at(peak)), (before, at(before)), (after, at(after))];
        candidates.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Every local maximum of a function, and its values at both ends of each panel: distances and values.
    pub fn peaks(&self, f: &dyn Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let mut peaks = Vec::new();
        for Panel { span, t, .. } in self.panels() {
            let edge = 1e-12 * span.length();
            let mut places = vec![span.from + edge];
            places.extend(t);
            places.push(span.to - edge);
            let values: Vec<f64> = places.iter().map(|&t| f(t)).collect();
            let last = places.len() - 1;
            peaks.extend([(places[0], values[0]), (places[last], values[last])]);
            for here in 0..=last {
                let (before, after) = (here.saturating_sub(1), (here + 1).min(last));
                if values[here] >= values[before] && values[here] >= values[after] {
                    let tolerance = 1e-9 * span.length();
                    let [from, to] = [places[before], places[after]];
                    let peak = roots::minimum(from, to, tolerance, &|t| -f(t));
                    peaks.extend([(places[here], values[here]), (peak, f(peak))]);
                }
            }
        }
        peaks
    }

    /// Interval that holds σ_t on a part of a panel, from the Legendre coefficients c of its polynomial:
    ///
    /// ```text
    /// |σ_t − c₀| ≤ Σ |c_k|,  k ≥ 1
    /// ```
    ///
    /// The two highest coefficients count twice: they stand for those that are left out. For a medium that is a
    /// polynomial between its breaks the bound is exact up to rounding, which is added.
    pub fn extremes(&self, part: Span) -> Span {
        let values = self.medium.extinctions(&self.nodes(part));
        let largest = values.iter().copied().fold(0.0, f64::max);
        if values.iter().all(|&value| value == largest) {
            return Span::new(largest, largest);
        }
        let coefficients: Vec<f64> = self.legendre.iter().map(|row| dot(row, &values)).collect();
        let left_out = coefficients.iter().rev().take(2);
        let sizes = coefficients.iter().skip(1).chain(left_out).map(|c| c.abs());
        let spread = sizes.sum::<f64>() + ROUNDING * largest;
        Span::new((coefficients[0] - spread).max(0.0), coefficients[0] + spread)
    }

    /// Upper bound of a function over all panels: `at` returns its value at a distance, and `within` an upper bound on
    /// a part of a panel.
    ///
    /// Panels are halved until the bound is at most 1 % above the largest value that was met. Parts of 1e-12 of the
    /// support, next to a place where the function is a limit, count with the value in their middle.
    pub fn supremum(&self, at: impl Fn(f64) -> f64, within: impl Fn(Span) -> f64) -> f64 {
        let mut largest = self.t.iter().map(|&t| at(t)).fold(f64::NEG_INFINITY, f64::max);
        let mut bound = largest;
        let mut parts = self.panels.clone();
        let mut halvings = 0;
        while let Some(part) = parts.pop() {
            let highest = within(part);
            if highest <= largest + TIGHT * largest.abs() || halvings == MAX_HALVINGS {
                bound = bound.max(highest);
                continue;
            }
            largest = largest.max(at(part.middle()));
            if part.length() > SHORTEST * self.support().length() {
                parts.extend(part.halves());
                halvings += 1;
            }
        }
        bound.max(largest)
    }

    /// τ over the support.
    pub fn optical_depth(&self) -> Known {
        self.depth
    }
}

/// The weights that turn node values into the Legendre coefficient of the given order on `[0, 1]`.
fn legendre_row(rule: &GaussLegendre, order: usize) -> Vec<f64> {
    let polynomial = |x: f64| legendre(2.0 * x - 1.0).nth(order).unwrap_or(f64::NAN);
    let scale = 2.0 * order as f64 + 1.0;
    rule.nodes.iter().zip(&rule.weights).map(|(&x, &w)| scale * w * polynomial(x)).collect()
}
