//! An interval for a probability from counted successes.
//!
//! ```text
//! P(X ≥ k; low) = (1 − level)/2,  P(X ≤ k; high) = (1 − level)/2,  X binomial in n trials
//! ```
//!
//! Source: C. J. Clopper, E. S. Pearson, *The use of confidence or fiducial limits illustrated in the
//! case of the binomial*, Biometrika 26 (1934), 404–413; probabilities by C. Loader, *Fast and
//! accurate computation of binomial probabilities* (2000). Valid up to 1e9 trials and beyond, at a cost
//! of about `√n` terms for each tail; the ends have relative error 1e-9.

use std::f64::consts::PI;

use numeric::roots;

/// Interval that covers the probability of success with probability `level` or more.
///
/// Without trials, and at the level 1, it is `(0, 1)`. More successes than trials and a level outside `[0, 1]` give
/// NaN.
pub fn interval(successes: u64, trials: u64, level: f64) -> (f64, f64) {
    if successes > trials || !(0.0..=1.0).contains(&level) {
        return (f64::NAN, f64::NAN);
    }
    if trials == 0 || level == 1.0 {
        return (0.0, 1.0);
    }
    let (k, n) = (successes as f64, trials as f64);
    let tail = 0.5 * (1.0 - level);
    let low = if successes == 0 { 0.0 } else { end(k, n, tail, above) };
    let high = if successes == trials { 1.0 } else { end(k, n, tail, below) };
    (low, high)
}

/// The probability at which `tail_of` has the given size, between `k/n` and the end beyond.
///
/// In the logit of the probability, the logarithm of a tail is almost straight.
fn end(k: f64, n: f64, tail: f64, tail_of: fn(f64, f64, Chance) -> f64) -> f64 {
    let excess = |logit: f64| tail_of(k, n, Chance::of_logit(logit)).ln() - tail.ln();
    // A step of one standard deviation of the logit, with half a count where there are none.
    let centre = ((k + 0.5) / (n - k + 0.5)).ln();
    let step = (1.0 / (k + 0.5) + 1.0 / (n - k + 0.5)).sqrt();
    let outwards = if excess(centre - step) < excess(centre + step) { -step } else { step };
    let mut far = centre;
    while excess(far) > 0.0 && far.abs() < 700.0 {
        far += outwards;
    }
    let (low, high) = (far.min(far - outwards), far.max(far - outwards));
    Chance::of_logit(roots::root(low, high, &excess)).p
}

/// A probability and its complement, neither of them rounded away.
#[derive(Clone, Copy)]
struct Chance {
    p: f64,
    q: f64,
}

impl Chance {
    fn of_logit(logit: f64) -> Self {
        Self { p: 1.0 / (1.0 + (-logit).exp()), q: 1.0 / (1.0 + logit.exp()) }
    }

    fn other(self) -> Self {
        Self { p: self.q, q: self.p }
    }
}

/// `P(X ≥ k)`, by terms that fall from `k` on where `k ≥ np`.
fn above(k: f64, n: f64, probability: Chance) -> f64 {
    let odds = probability.p / probability.q;
    let (mut sum, mut term, mut j) = (1.0, 1.0, k);
    while j < n {
        term *= (n - j) / (j + 1.0) * odds;
        sum += term;
        j += 1.0;
        if term < 1e-17 * sum {
            break;
        }
    }
    ln_mass(k, n, probability).exp() * sum
}

/// `P(X ≤ k)`: the probability of `n − k` failures or more.
fn below(k: f64, n: f64, probability: Chance) -> f64 {
    above(n - k, n, probability.other())
}

/// `ln P(X = k)`: deviances and Stirling remainders, so that no digits cancel.
fn ln_mass(k: f64, n: f64, probability: Chance) -> f64 {
    if k == 0.0 {
        return n * (-probability.p).ln_1p();
    }
    if k == n {
        return n * (-probability.q).ln_1p();
    }
    remainder(n)
        - remainder(k)
        - remainder(n - k)
        - deviance(k, n * probability.p)
        - deviance(n - k, n * probability.q)
        - 0.5 * (2.0 * PI * k * (n - k) / n).ln()
}

/// `ln n! − ln(√(2πn) (n/e)ⁿ)`.
fn remainder(n: f64) -> f64 {
    if n < 16.0 {
        return libm::lgamma(n + 1.0) - (n + 0.5) * n.ln() + n - 0.5 * (2.0 * PI).ln();
    }
    let z = 1.0 / (n * n);
    (1.0 / 12.0 - z * (1.0 / 360.0 - z * (1.0 / 1260.0 - z * (1.0 / 1680.0 - z / 1188.0)))) / n
}

/// `x ln(x/m) + m − x`, by its series in `(x − m)/(x + m)` where `x` is near `m`.
pub(super) fn deviance(x: f64, m: f64) -> f64 {
    if (x - m).abs() >= 0.1 * (x + m) {
        return x * (x / m).ln() + m - x;
    }
    let v = (x - m) / (x + m);
    let mut sum = (x - m) * v;
    let mut power = 2.0 * x * v;
    let mut odd = 1.0;
    loop {
        power *= v * v;
        odd += 2.0;
        let next = sum + power / odd;
        if next == sum {
            return sum;
        }
        sum = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_forms_at_no_and_at_all_successes() {
        for n in [1, 10, 1000, 1_000_000_000_u64] {
            let (low, high) = interval(0, n, 0.99);
            let exact = -(0.005f64.ln() / n as f64).exp_m1();
            assert!(low == 0.0 && (high / exact - 1.0).abs() < 1e-12, "{n}: {high} {exact}");
            let (low, high) = interval(n, n, 0.99);
            let exact = (0.005f64.ln() / n as f64).exp();
            assert!(high == 1.0 && (low / exact - 1.0).abs() < 1e-12, "{n}: {low} {exact}");
        }
    }

    /// Quantiles of the beta distribution by the Boost library, which gives them to 1e-12 at these sizes.
    #[test]
    fn agrees_with_the_beta_law() {
        let known = [
            (3, 10, 0.95, 0.066_739_511_177_734_5, 0.652_452_850_059_997_3),
            (1, 1000, 0.99, 5.012_529_260_777_51e-6, 0.007_406_286_938_352_937),
            (5, 57, 0.999_999, 0.002_663_364_121_090_352, 0.383_083_883_037_265_55),
            (50, 100, 0.99, 0.368_861_437_358_924_1, 0.631_138_562_641_075_6),
            (12_345, 1_000_000, 0.99, 0.012_062_397_109_951_805, 0.012_632_253_380_844_84),
            (500_000_000, 1_000_000_000, 0.99, 0.499_959_272_062_762_64, 0.500_040_727_937_237_4),
        ];
        for (k, n, level, low, high) in known {
            let result = interval(k, n, level);
            assert!((result.0 / low - 1.0).abs() < 1e-12, "{k} of {n}: {result:?}");
            assert!((result.1 / high - 1.0).abs() < 1e-12, "{k} of {n}: {result:?}");
        }
    }

    #[test]
    fn rare_successes_in_a_billion_trials() {
        let (n, level) = (1e9, 0.999_999);
        let (low, high) = interval(3, 1_000_000_000, level);
        // C(n, j) p^j q^{n−j}, j ≤ 3, term by term.
        let below = |k: i32, p: f64| {
            let mass = |j: i32| {
                let ways: f64 = (0..j).map(|i| (n - f64::from(i)) / f64::from(i + 1)).product();
                ways * p.powi(j) * ((n - f64::from(j)) * (-p).ln_1p()).exp()
            };
            (0..=k).map(mass).sum::<f64>()
        };
        assert!((below(3, high) / 5e-7 - 1.0).abs() < 1e-9);
        assert!(((1.0 - below(2, low)) / 5e-7 - 1.0).abs() < 1e-8);
    }

    #[test]
    fn no_trials_know_nothing() {
        assert_eq!(interval(0, 0, 0.99), (0.0, 1.0));
        assert_eq!(interval(3, 10, 1.0), (0.0, 1.0));
        assert!(interval(2, 1, 0.99).0.is_nan());
        assert!(interval(3, 10, 1.5).0.is_nan() && interval(3, 10, f64::NAN).0.is_nan());
    }

    #[test]
    fn the_interval_covers_as_often_as_it_says() {
        // All outcomes of 40 trials, each with its probability.
        for p in [0.003, 0.11, 0.5, 0.93] {
            let probability = Chance { p, q: 1.0 - p };
            let covered = |k: &u64| {
                let (low, high) = interval(*k, 40, 0.99);
                low <= p && p <= high
            };
            let cover: f64 =
                (0..=40).filter(covered).map(|k| ln_mass(k as f64, 40.0, probability).exp()).sum();
            assert!((0.99..=1.0 + 1e-12).contains(&cover), "{p}: {cover}");
        }
    }
}
