//! Dependence of passes on those shortly before them, and of pixels on adjacent ones.
//!
//! The order of the passes is compared with random orders:
//!
//! ```text
//! G_pq = Σ_i (x_pi − x̄_i)(x_qi − x̄_i)/s_i²                              over the pixels i that vary
//! T    = max over l = 1 … 4 of |mean of G_{p,p+l} over p − mean of G_pq over p ≠ q| √(n − l)
//! p    = (1 + how many of B random orders of the passes have a T as large)/(1 + B)
//! ```
//!
//! Independent passes of one distribution are as likely in one order as in any other, even if the pixels of a pass
//! depend on each other: p is exact. Passes that resemble the passes before them (a chain that goes on, a render that
//! gets brighter) or avoid them (a sampler that fills gaps) have a large T. Fewer than 8 passes have too few orders for
//! a test.
//!
//! Source: J. Besag, P. Clifford, *Sequential Monte Carlo p-values*, Biometrika 78 (1991), for stopping after 20 orders
//! with a T as large.

use super::picture::Stack;
use gate::stats::capital::ln_mean_exp;
use gate::stats::independence::Signs;
use numeric::rng::{Address, unit};
use theory::parallel;

/// Largest lag.
const LAGS: usize = 4;
/// Maximum number of orders that are compared.
const ORDERS: u32 = 100_000;
/// Number of orders with a T as large at which the comparison ends.
const ENOUGH: u32 = 20;
/// Approximate maximum number of products; beyond it, only every k-th pixel is used.
const PRODUCTS: usize = 1 << 32;
/// Number of parts of the pixels that are summed up separately.
const PARTS: usize = 32;

/// Comparison of the order of passes with random orders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Order {
    pub p: f64,
    /// Lag of the strongest correlation.
    pub lag: usize,
    pub correlation: f64,
}

/// Returns the smallest number of passes with enough orders for a p-value at that level.
pub(super) fn fewest(level: f64) -> usize {
    let (mut passes, mut orders) = (2_usize, 1.0);
    while 1.0 / orders > level {
        passes += 1;
        // An order and its reverse have the same T.
        orders *= passes as f64;
    }
    passes
}

/// Compares the order of the passes with random orders; `None` if no pixel varies.
pub(super) fn order(stack: &Stack) -> Option<Order> {
    let n = stack.passes;
    let gram = gram(stack);
    let diagonal: f64 = (0..n).map(|p| gram[p * n + p]).sum();
    if diagonal <= 0.0 {
        return None;
    }
    let apart = (gram.iter().sum::<f64>() - diagonal) / (n * (n - 1)) as f64;
    let statistic = |order: &[usize]| {
        let mut maximum = (0.0, 1, 0.0);
        for lag in 1..=LAGS.min(n - 1) {
            let pairs = order.iter().zip(&order[lag..]);
            let sum: f64 = pairs.map(|(p, q)| gram[p * n + q]).sum();
            let excess = sum / (n - lag) as f64 - apart;
            let scaled = excess.abs() * ((n - lag) as f64).sqrt();
            if scaled > maximum.0 {
                maximum = (scaled, lag, excess);
            }
        }
        maximum
    };
    let mut order: Vec<usize> = (0..n).collect();
    let (finding, lag, excess) = statistic(&order);
    let mut rng = Address { seed: 1, experiment: 0, block: 0, lane: 0 }.stream();
    let (mut drawn, mut above) = (0, 0);
    // Reversed orders add up in another order, with other rounding.
    let limit = finding * (1.0 - 1e-9);
    while drawn < ORDERS && above < ENOUGH {
        for last in (1..n).rev() {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // up to `last`
            let other = (unit(&mut rng) * (last + 1) as f64) as usize;
            order.swap(last, other.min(last));
        }
        drawn += 1;
        above += u32::from(statistic(&order).0 >= limit);
    }
    let p = if above == ENOUGH {
        f64::from(ENOUGH) / f64::from(drawn)
    } else {
        f64::from(1 + above) / f64::from(1 + drawn)
    };
    Some(Order { p, lag, correlation: excess * n as f64 / diagonal })
}

/// Returns G, row after row.
fn gram(stack: &Stack) -> Vec<f64> {
    let (n, pixels) = (stack.passes, stack.size.pixels());
    let step = (n * n).saturating_mul(pixels).div_ceil(PRODUCTS).max(1);
    let parts = parallel::range(PARTS, |part| {
        let (mut sums, mut values) = (vec![0.0; n * n], Vec::new());
        for pixel in (part * step..pixels).step_by(PARTS * step) {
            values.clear();
            values.extend((0..n).map(|pass| stack.grey(pass, pixel)));
            if standardise(&mut values) {
                for (p, x) in values.iter().enumerate() {
                    let row = &mut sums[p * n..(p + 1) * n];
                    row.iter_mut().zip(&values).for_each(|(sum, y)| *sum += x * y);
                }
            }
        }
        sums
    });
    let mut gram = vec![0.0; n * n];
    for part in parts {
        gram.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
    }
    gram
}

/// Scales to mean 0 and mean square 1; `false` for values that do not vary, or are not finite.
fn standardise(values: &mut [f64]) -> bool {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    for x in &mut *values {
        *x -= mean;
    }
    let deviation = (values.iter().map(|x| x * x).sum::<f64>() / n).sqrt();
    for x in values {
        *x /= deviation;
    }
    deviation.is_finite() && deviation > 1e-14 * mean.abs()
}

/// Evidence of a dependence between adjacent pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Neighbours {
    /// ln E.
    pub ln_e: f64,
    /// Stronger of the two correlations.
    pub correlation: f64,
}

/// Compares each pixel with an adjacent one by exact signs, as `stats::independence` compares draws.
///
/// ```text
/// a = x_pi − x_qi,  b = x_pj − x_qj    for passes p, q = 2k, 2k + 1 and neighbours i, j, each in one pair
/// of independent pixels ab is as often positive as negative (exchange x_pi and x_qi)
/// E = mean of e for neighbours in a row and for neighbours in a column
/// ```
///
/// A filter that blends pixels, or one seed for all of them, makes ab positive. Samples that are spread over the
/// picture like blue noise make it negative. The channels of a pixel, which share paths, are added up.
pub(super) fn neighbours(stack: &Stack) -> Neighbours {
    let (rows, columns) = (stack.size.rows, stack.size.columns);
    let mut questions = [Signs::default(); 2];
    for first in (0..stack.passes - 1).step_by(2) {
        let apart = |row: usize, column: usize| {
            let pixel = row * columns + column;
            stack.grey(first, pixel) - stack.grey(first + 1, pixel)
        };
        for row in 0..rows {
            for column in 0..columns {
                let here = apart(row, column);
                if column % 2 == 1 {
                    questions[0].add(apart(row, column - 1), here);
                }
                if row % 2 == 1 {
                    questions[1].add(apart(row - 1, column), here);
                }
            }
        }
    }
    let [row, column] = &questions;
    let stronger = if row.ln_e() > column.ln_e() { row } else { column };
    let ln_e = ln_mean_exp(&questions.map(|signs| signs.ln_e()));
    Neighbours { ln_e, correlation: stronger.correlation() }
}

#[cfg(test)]
mod tests {
    use super::super::picture::Size;
    use super::*;

    /// Returns passes of 16 pixels: each pass is the last one times `keep` plus noise, the same for all pixels or not.
    fn stack(seed: u64, n: usize, keep: f64, is_shared: bool) -> Stack {
        let mut rng = Address { seed, experiment: 7, block: 0, lane: 0 }.stream();
        let mut state = [0.0; 16];
        let mut values = Vec::new();
        for _ in 0..n {
            let shared = unit(&mut rng);
            for x in &mut state {
                let noise = if is_shared { shared } else { unit(&mut rng) };
                *x = keep * *x + noise;
            }
            values.extend(state);
        }
        Stack::new(n, Size { rows: 4, columns: 4, channels: 1 }, values).expect("a stack")
    }

    #[test]
    fn chains_are_found_and_independent_passes_have_even_p_values() {
        for is_shared in [false, true] {
            let small = (0..200).filter(|&seed| {
                order(&stack(seed, 12, 0.0, is_shared)).expect("it varies").p <= 0.1
            });
            // Binomial(200, 0.1): 20 ± 4.2.
            let small = small.count();
            assert!((3..=37).contains(&small), "{small}");
        }
        let finding = order(&stack(1, 24, 0.8, false)).expect("it varies");
        assert!(finding.p < 1e-4 && finding.lag == 1, "{finding:?}");
        assert!((0.3..0.9).contains(&finding.correlation), "{finding:?}");
    }

    #[test]
    fn eight_passes_have_enough_orders() {
        assert_eq!(fewest(3.3e-4), 8);
        assert_eq!(fewest(1.0), 2);
        assert_eq!(order(&stack(1, 2, 0.0, false)).map(|finding| finding.p), Some(1.0));
    }

    #[test]
    fn what_does_not_vary_says_nothing() {
        let size = Size { rows: 1, columns: 2, channels: 1 };
        assert_eq!(order(&Stack::new(3, size, vec![0.1; 6]).expect("a stack")), None);
    }

    /// Returns two passes of 64 × 64 pixels that are blended with the pixels to the left and above.
    fn blended(seed: u64, blend: f64) -> Stack {
        let size = Size { rows: 64, columns: 64, channels: 1 };
        let mut rng = Address { seed, experiment: 9, block: 0, lane: 0 }.stream();
        let mut values = Vec::new();
        for _ in 0..2 {
            let noise: Vec<f64> = (0..65 * 65).map(|_| unit(&mut rng).powi(8)).collect();
            for (row, column) in (0..64).flat_map(|row| (0..64).map(move |column| (row, column))) {
                let at = |row: usize, column: usize| noise[row * 65 + column];
                let others = at(row, column + 1) + at(row + 1, column);
                values.push(at(row + 1, column + 1) + blend * others);
            }
        }
        Stack::new(2, size, values).expect("a stack")
    }

    #[test]
    fn blended_pixels_are_found_and_independent_ones_are_not() {
        for seed in 0..200 {
            assert!(neighbours(&blended(seed, 0.0)).ln_e < 7.6, "seed {seed}");
        }
        let finding = neighbours(&blended(1, 0.3));
        assert!(finding.ln_e > 20.0 && (0.15..0.4).contains(&finding.correlation), "{finding:?}");
    }
}
