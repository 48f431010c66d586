//! What draws are made of: logarithm, exponential, sine and cosine.

use super::{Dice, Effort, Measure, Row, in_parts};
use crate::numeric::{Lane, Wide};

/// Parts of the random arguments.
const PARTS: u64 = 32;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(100, 4000);
    in_parts(PARTS, |part| {
        let mut dice = Dice::new(seed, "elementary", part);
        let row = |what: &str, range: &str, bound| Row::new(what, range, Measure::Relative, bound);
        let mut all = row("ln", "1e-307 … 1e308", 5e-16);
        let mut next = row("ln next to 1", "1 ± k·2⁻⁵³, k = 1 … 2⁵²", 5e-16);
        let mut exponential = row("exp", "−708 … 709", 4e-16);
        let mut circle = Row::new("sine and cosine", "|x| ≤ 1e5", Measure::Absolute, 5e-16);
        let mut far = Row::new(
            "sine and cosine, far",
            "1e5 ≤ |x| ≤ 1e9, 5e-16 and 2⁻⁸⁶|x|",
            Measure::OfStated,
            1.0,
        );
        for _ in 0..trials {
            let x = dice.sized(-307.0, 308.0);
            all.see(Wide::from(x).ln().relative_error(Lane::ln(x)), || format!("{x:e}"));
            let k = dice.sized(0.0, 15.65).floor();
            for x in [1.0 - k * f64::EPSILON / 2.0, 1.0 + k * f64::EPSILON] {
                if x > 0.0 {
                    let exact = (Wide::from(x) - Wide::ONE).ln_1p();
                    next.see(exact.relative_error(Lane::ln(x)), || format!("1 {:+e}", x - 1.0));
                }
            }
            let x = dice.between(-708.0, 709.0);
            exponential.see(Wide::from(x).exp().relative_error(Lane::exp(x)), || format!("{x:e}"));
            let x = dice.sign() * dice.sized(-9.0, 5.0);
            circle.see(off_the_circle(x), || format!("{x:e}"));
            let x = dice.sign() * dice.sized(5.0, 9.0);
            let stated = 5e-16 + x.abs() * 2f64.powi(-86);
            far.see(off_the_circle(x) / stated, || format!("{x:e}"));
        }
        vec![all, next, exponential, circle, far]
    })
}

fn off_the_circle(x: f64) -> f64 {
    let [sine, cosine] = Wide::from(x).sin_cos();
    let off = |exact: Wide, found: f64| (Wide::from(found) - exact).abs().value();
    off(sine, Lane::sin(x)).max(off(cosine, Lane::cos(x)))
}
