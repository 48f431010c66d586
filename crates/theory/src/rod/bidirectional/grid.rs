//! Functions of the optical depth along a rod, and integrals over one flight.

use numeric::quadrature::GaussLegendre;
use numeric::{Scalar, Span};

/// Values at the Gauss–Legendre nodes of `[0, τ]`: polynomials between them.
pub struct NodeGrid {
    /// The nodes u, optical depths from the beginning of the rod, ascending.
    pub points: Vec<f64>,
    weights: Vec<f64>,
    /// For each node u the nodes v of `[0, u]`: `u − v` and the weight of v.
    before: Vec<Vec<[f64; 2]>>,
    /// The interpolation polynomials of the grid there: `[u][v][point]`, one after the other.
    basis: Vec<f64>,
}

/// `∫ K(|u − v|) φ(v) dv` from the nodes before each u, as a matrix by rows.
pub struct Operator<S = f64> {
    rows: Vec<S>,
    size: usize,
}

impl NodeGrid {
    /// A grid of `size` nodes on `[0, depth]`.
    pub fn new(depth: f64, size: usize) -> Self {
        let rule = GaussLegendre::new(size);
        let (points, weights): (Vec<f64>, Vec<f64>) = rule.on(Span::new(0.0, depth)).unzip();
        let nodes = |u: f64| rule.on(Span::new(0.0, u)).collect::<Vec<_>>();
        let places = points.iter().flat_map(|&u| nodes(u));
        let basis = places.flat_map(|(v, _)| rule.weights_at(v / depth)).collect();
        let before = points
            .iter()
            .map(|&u| nodes(u).into_iter().map(|(v, weight)| [u - v, weight]).collect());
        Self { before: before.collect(), points, weights, basis }
    }

    /// A function at the nodes.
    pub fn values<S>(&self, f: impl Fn(f64) -> S) -> Vec<S> {
        self.points.iter().map(|&u| f(u)).collect()
    }

    /// `∫ f` over the rod.
    pub fn integral<S: Scalar>(&self, f: &[S]) -> S {
        dot(f.iter().zip(&self.weights).map(|(&f, &weight)| f * weight))
    }

    /// `∫ f g` over the rod.
    pub fn product<S: Scalar>(&self, f: &[S], g: &[S]) -> S {
        let pairs = f.iter().zip(g).zip(&self.weights);
        dot(pairs.map(|((&f, &g), &weight)| f * weight * g))
    }

    /// Flights with a kernel that depends on the optical depth flown.
    pub fn operator<S: Scalar>(&self, kernel: impl Fn(f64) -> S) -> Operator<S> {
        let [operator] = self.several(&|depth| [kernel(depth)]);
        operator
    }

    /// The flights of several kernels.
    pub fn several<S: Scalar, const N: usize>(
        &self,
        kernels: &dyn Fn(f64) -> [S; N],
    ) -> [Operator<S>; N] {
        let size = self.points.len();
        let nothing = || vec![S::from(0.0); size * size];
        let mut operators = [(); N].map(|()| Operator { rows: nothing(), size });
        for (i, nodes) in self.before.iter().enumerate() {
            let basis = self.basis[i * size * size..].chunks(size);
            for (&[flown, weight], basis) in nodes.iter().zip(basis) {
                for (operator, kernel) in operators.iter_mut().zip(kernels(flown)) {
                    let row = &mut operator.rows[i * size..(i + 1) * size];
                    let factor = kernel * weight;
                    row.iter_mut().zip(basis).for_each(|(sum, &x)| *sum = *sum + factor * x);
                }
            }
        }
        operators
    }
}

impl<S: Scalar> Operator<S> {
    /// The integral from each node over the part of the rod before it, or behind it: nodes are symmetric about the
    /// middle.
    pub fn over(&self, is_before: bool, f: &[S]) -> Vec<S> {
        let rows = self.rows.chunks(self.size);
        let product = |(&a, &b): (&S, &S)| a * b;
        if is_before {
            return rows.map(|row| dot(row.iter().zip(f).map(product))).collect();
        }
        rows.rev().map(|row| dot(row.iter().zip(f.iter().rev()).map(product))).collect()
    }
}

/// The sum of products.
fn dot<S: Scalar>(products: impl Iterator<Item = S>) -> S {
    products.fold(S::from(0.0), |sum, product| sum + product)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flights_are_integrals_on_both_sides() {
        // ∫₀^u e^{−(u − v)} cos v dv = (sin u + cos u − e^{−u})/2, and mirrored.
        for size in [20, 21] {
            let grid = NodeGrid::new(2.0, size);
            let flights = grid.operator(|d| (-d).exp());
            let exact = |u: f64| 0.5 * (u.sin() + u.cos() - (-u).exp());
            let result = flights.over(true, &grid.values(f64::cos));
            let mirrored = flights.over(false, &grid.values(|v| (2.0 - v).cos()));
            for (i, &u) in grid.points.iter().enumerate() {
                assert!((result[i] - exact(u)).abs() < 1e-14, "{u}");
                assert!((mirrored[i] - exact(2.0 - u)).abs() < 1e-14, "{u}");
            }
            assert!((grid.integral(&grid.values(f64::cos)) - 2f64.sin()).abs() < 1e-14);
        }
    }
}
