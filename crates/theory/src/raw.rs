//! Raw moments `E[N^k]`, k = 0 … 4.

/// `E[N^k]`, k = 0 … 4.
pub type Raw = [f64; 5];

/// Binomial coefficients: row k, column j.
pub const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// `n over k`.
pub fn binomial(n: usize, k: usize) -> f64 {
    (1..=k).fold(1.0, |product, i| product * (n + 1 - i) as f64 / i as f64)
}

/// Raw moments of a Poisson number of mean m.
pub fn poisson(m: f64) -> Raw {
    [1.0, m, m * (1.0 + m), m * (1.0 + m * (3.0 + m)), m * (1.0 + m * (7.0 + m * (6.0 + m)))]
}

/// Raw moments of the sum of two independent numbers.
pub fn added(a: Raw, b: Raw) -> Raw {
    std::array::from_fn(|k| (0..=k).map(|j| BINOMIAL[k][j] * a[k - j] * b[j]).sum())
}

/// Raw moments from `E[N(N − 1)…(N − k + 1)]`, k = 1 … 4.
pub fn of_factorial([f1, f2, f3, f4]: [f64; 4]) -> Raw {
    [1.0, f1, f2 + f1, f3 + 3.0 * f2 + f1, f4 + 6.0 * f3 + 7.0 * f2 + f1]
}

/// Raw moments from the cumulants of orders 1 to 4.
pub fn of_cumulants([k1, k2, k3, k4]: [f64; 4]) -> Raw {
    let second = k2 + k1 * k1;
    let third = k3 + 3.0 * k2 * k1 + k1.powi(3);
    let fourth = k4 + 4.0 * k3 * k1 + 3.0 * k2 * k2 + 6.0 * k2 * k1 * k1 + k1.powi(4);
    [1.0, k1, second, third, fourth]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_a_poisson_number_add_like_means() {
        let sum = added(poisson(0.7), poisson(1.9));
        for (a, b) in sum.iter().zip(poisson(2.6)) {
            assert!((a - b).abs() < 1e-13 * b);
        }
    }
}
