//! Gauss–Legendre quadrature, running integrals at its nodes, and the scalar linear equation on panels of nodes.

use super::Span;

/// An `n`-point Gauss–Legendre rule on `[0, 1]` with the matrix of its running integrals.
///
/// ```text
/// ∫₀¹ f ≈ Σⱼ wⱼ f(xⱼ),   exact for polynomials of degree 2n − 1
/// ∫₀^{xᵢ} f ≈ Σⱼ Aᵢⱼ f(xⱼ), exact for polynomials of degree n − 1
/// ```
///
/// The running integrals integrate the interpolation polynomial through the nodes, as collocation
/// methods do (E. Hairer, S. Nørsett, G. Wanner, *Solving Ordinary Differential Equations I*,
/// section II.7).
#[derive(Debug, Clone)]
pub struct GaussLegendre {
    /// Nodes in `(0, 1)`, ascending.
    pub nodes: Vec<f64>,
    /// Weights; they sum to 1.
    pub weights: Vec<f64>,
    /// Row `i` holds the weights of `∫₀^{xᵢ}`.
    pub running: Vec<Vec<f64>>,
    barycentric: Vec<f64>,
}

impl GaussLegendre {
    /// The rule with `n ≥ 1` nodes.
    pub fn new(n: usize) -> Self {
        let (nodes, weights): (Vec<f64>, Vec<f64>) =
            (0..n).map(|i| node_and_weight(n, n - 1 - i)).unzip();
        let others = |j: usize| nodes.iter().enumerate().filter(move |&(i, _)| i != j);
        // In units of the interval's capacity, 1/4: the product of hundreds of differences would underflow.
        let apart = |j: usize| others(j).map(|(_, x)| 4.0 * (nodes[j] - x)).product::<f64>();
        let barycentric = (0..n).map(|j| 1.0 / apart(j)).collect();
        let mut rule = Self { nodes, weights, running: Vec::new(), barycentric };
        // ∫₀^{xᵢ} of the Lagrange polynomials, themselves integrated exactly by this very rule:
        // they have degree n − 1 ≤ 2n − 1.
        let up_to = |end: f64| {
            let mut row = vec![0.0; n];
            for (at, weight) in rule.on(Span::new(0.0, end)) {
                row.iter_mut().zip(rule.weights_at(at)).for_each(|(sum, x)| *sum += weight * x);
            }
            row
        };
        rule.running = rule.nodes.iter().map(|&end| up_to(end)).collect();
        rule
    }

    /// Weights of the values at the nodes in the polynomial through all of them, at `x` in `[0, 1]`, by barycentric
    /// interpolation.
    ///
    /// ```text
    /// ℓⱼ(x) = wⱼ/(x − xⱼ)/Σᵢ wᵢ/(x − xᵢ),   wⱼ = 1/∏ (xⱼ − xᵢ)
    /// ```
    ///
    /// Source: J.-P. Berrut, L. N. Trefethen, *Barycentric Lagrange interpolation*, SIAM Review 46 (2004).
    pub fn weights_at(&self, x: f64) -> Vec<f64> {
        if let Some(hit) = self.nodes.iter().position(|&node| node == x) {
            return (0..self.nodes.len()).map(|j| f64::from(u8::from(j == hit))).collect();
        }
        let pairs = self.nodes.iter().zip(&self.barycentric);
        let terms: Vec<f64> = pairs.map(|(node, weight)| weight / (x - node)).collect();
        let sum: f64 = terms.iter().sum();
        terms.into_iter().map(|term| term / sum).collect()
    }

    /// The nodes on a stretch, each with its weight; the weights sum to its length.
    pub fn on(&self, span: Span) -> impl Iterator<Item = (f64, f64)> + '_ {
        let length = span.to - span.from;
        let points = self.nodes.iter().zip(&self.weights);
        points.map(move |(x, weight)| (span.from + length * x, length * weight))
    }

    /// The nodes on a stretch.
    pub fn nodes_on(&self, span: Span) -> Vec<f64> {
        self.on(span).map(|(t, _)| t).collect()
    }

    /// Solves `−U' = f − A' U` on a panel backwards from its end, by running integrals. Returns U at the nodes and at the
    /// panel's beginning.
    ///
    /// ```text
    /// U(s) = ∫_s^end f(t) e^{−(A(t) − A(s))} dt + U(end) e^{−(A(end) − A(s))}
    /// ```
    ///
    /// `losses` are A at the nodes and `loss` that at the end, both from the panel's beginning; `f` are values of f times
    /// the panel's length.
    pub fn backward(&self, losses: &[f64], loss: f64, f: &[f64], end: f64) -> (Vec<f64>, f64) {
        let decayed: Vec<f64> = f.iter().zip(losses).map(|(f, loss)| f * (-loss).exp()).collect();
        let begin = end * (-loss).exp() + dot(&self.weights, &decayed);
        let at = |(row, loss): (&Vec<f64>, &f64)| (begin - dot(row, &decayed)) * loss.exp();
        (self.running.iter().zip(losses).map(at).collect(), begin)
    }

    /// Weights of the integral from a node to the end of `[0, 1]`.
    pub fn to_end(&self, node: usize) -> impl Iterator<Item = f64> + '_ {
        self.weights.iter().zip(&self.running[node]).map(|(whole, before)| whole - before)
    }

    /// Integrals of several functions from each node of adjacent panels to the end of the last, given the widths of the
    /// panels and the values at all nodes: the equation of [`GaussLegendre::backward`] with A = 0.
    pub fn all_to_end(&self, widths: &[f64], values: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let add = |sum: &mut [f64], row: &[f64], weight: f64| {
            sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += weight * x);
        };
        let mut beyond = vec![0.0; values.first().map_or(0, Vec::len)];
        let mut result = vec![Vec::new(); values.len()];
        let nodes = self.nodes.len();
        let panels = values.chunks(nodes).zip(result.chunks_mut(nodes)).zip(widths);
        for ((values, result), width) in panels.rev() {
            for (i, result) in result.iter_mut().enumerate() {
                result.clone_from(&beyond);
                for (row, weight) in values.iter().zip(self.to_end(i)) {
                    add(result, row, width * weight);
                }
            }
            for (row, weight) in values.iter().zip(&self.weights) {
                add(&mut beyond, row, width * weight);
            }
        }
        result
    }

    /// `∫_from^to f`.
    pub fn integrate(&self, from: f64, to: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let length = to - from;
        let points = self.nodes.iter().zip(&self.weights);
        length * points.map(|(&x, &w)| w * f(from + length * x)).sum::<f64>()
    }
}

/// Legendre polynomials `P_0(x), P_1(x), …`.
///
/// ```text
/// (m + 1) P_{m+1} = (2m + 1) x P_m − m P_{m−1}
/// ```
pub fn legendre(x: f64) -> impl Iterator<Item = f64> {
    polynomials(x).map(|[_, value, _]| value)
}

/// `P_{m−1}(x)`, `P_m(x)` and m, from m = 0.
fn polynomials(x: f64) -> impl Iterator<Item = [f64; 3]> {
    std::iter::successors(Some([0.0, 1.0, 0.0]), move |&[previous, value, m]| {
        Some([value, ((2.0 * m + 1.0) * x * value - m * previous) / (m + 1.0), m + 1.0])
    })
}

/// Newton's iteration on the Legendre polynomial `P_n` from Tricomi's starting value, mapped to
/// `[0, 1]`; `i = 0` is the largest node.
fn node_and_weight(n: usize, i: usize) -> (f64, f64) {
    let order = n as f64;
    let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (order + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..100 {
        let [previous, value, _] = polynomials(x).nth(n).unwrap_or_default();
        slope = order * (x * value - previous) / (x * x - 1.0);
        let step = value / slope;
        x -= step;
        if step.abs() <= 1e-16 {
            break;
        }
    }
    (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
}

/// Sum of the products of two lists.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrates_the_highest_degree_exactly() {
        for n in 1..=20_u32 {
            let rule = GaussLegendre::new(n as usize);
            let degree = 2 * n - 1;
            let exact = 1.0 / f64::from(degree + 1);
            let value = rule.integrate(0.0, 1.0, |x| x.powi(degree.cast_signed()));
            assert!((value - exact).abs() < 1e-14, "{n} nodes: {value} against {exact}");
            let total: f64 = rule.on(Span::new(1.0, 3.0)).map(|(t, weight)| weight * t).sum();
            assert!((total - 4.0).abs() < 1e-13);
        }
    }

    #[test]
    fn interpolation_keeps_its_digits_with_many_nodes() {
        for n in [5, 16, 200] {
            let rule = GaussLegendre::new(n);
            for x in [1e-9, 0.1, rule.nodes[2], 0.5, 0.77, 1.0 - 1e-9] {
                let pairs = rule.weights_at(x).into_iter().zip(&rule.nodes);
                let result: f64 = pairs.map(|(weight, node)| weight * node.powi(4)).sum();
                assert!((result - x.powi(4)).abs() < 1e-14, "{n} nodes at {x}: {result}");
            }
        }
    }

    #[test]
    fn running_integrals_reach_every_node() {
        let rule = GaussLegendre::new(12);
        let f: Vec<f64> = rule.nodes.iter().map(|x| x.exp()).collect();
        for (row, &end) in rule.running.iter().zip(&rule.nodes) {
            let value: f64 = row.iter().zip(&f).map(|(a, b)| a * b).sum();
            assert!((value - end.exp_m1()).abs() < 1e-14);
        }
    }
    #[test]
    fn a_panel_is_solved_backwards() {
        // −U' = f − a U with f = cos s e^{as}: U e^{−as} = sin 1 − sin s + U(1) e^{−a}.
        let (rule, a, end) = (GaussLegendre::new(14), 0.7, 2.0);
        let losses: Vec<f64> = rule.nodes.iter().map(|x| a * x).collect();
        let f: Vec<f64> = rule.nodes.iter().map(|x| x.cos() * (a * x).exp()).collect();
        let (result, begin) = rule.backward(&losses, a, &f, end);
        let exact = |s: f64| (a * s).exp() * (1f64.sin() - s.sin() + end * (-a).exp());
        assert!((begin - exact(0.0)).abs() < 1e-15);
        for (result, &s) in result.iter().zip(&rule.nodes) {
            assert!((result - exact(s)).abs() < 1e-14, "{s}");
        }
    }

    #[test]
    fn integrals_to_the_end_pass_all_panels() {
        let (rule, ends) = (GaussLegendre::new(5), [0.0, 0.5, 0.7, 2.0]);
        let nodes: Vec<f64> = Span::between(&ends).flat_map(|span| rule.nodes_on(span)).collect();
        let values: Vec<Vec<f64>> = nodes.iter().map(|t| vec![1.0, t.powi(3)]).collect();
        let widths: Vec<f64> = Span::between(&ends).map(Span::length).collect();
        for (result, t) in rule.all_to_end(&widths, &values).iter().zip(nodes) {
            assert!((result[0] - (2.0 - t)).abs() < 1e-14);
            assert!((result[1] - (4.0 - 0.25 * t.powi(4))).abs() < 1e-14, "{t}");
        }
    }
}
