//! Whether the pixels of a pass depend on each other: exact signs, as `stats::independence` takes of draws.
//!
//! ```text
//! a = x_pi − x_qi,  b = x_pj − x_qj    for passes p, q = 2k, 2k + 1 and neighbours i, j, each in one pair
//! of independent pixels ab is as often positive as negative (exchange x_pi and x_qi)
//! E = mean of e for neighbours in a row and for neighbours in a column
//! ```
//!
//! A filter that blends pixels, or one seed for all of them, makes ab positive; samples that are spread over
//! the picture like blue noise make it negative. The channels of a pixel, which share paths, are added up.

use super::picture::Stack;
use gate::stats::capital::ln_mean_exp;
use gate::stats::independence::Signs;

/// What was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Neighbours {
    /// ln E.
    pub ln_e: f64,
    /// The stronger of the two correlations.
    pub correlation: f64,
}

/// Compares each pixel with a neighbour.
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
    use numeric::rng::{Address, unit};

    /// Two passes of 64 × 64 pixels that are blended with the pixels to the left and above.
    fn stack(seed: u64, blend: f64) -> Stack {
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
            assert!(neighbours(&stack(seed, 0.0)).ln_e < 7.6, "seed {seed}");
        }
        let found = neighbours(&stack(1, 0.3));
        assert!(found.ln_e > 20.0 && (0.15..0.4).contains(&found.correlation), "{found:?}");
    }
}
