//! What draws are made of: logarithm, exponential, sine and cosine.

use super::trial::off;
use super::{Effort, Measure, Row, in_parts};
use numeric::{Lane, Wide};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(32, "elementary", seed, |part| {
        let rows = [
            Row::relative("ln", "1e-307 … 1e308", 5e-16),
            Row::relative("ln next to 1", "1 ± k·2⁻⁵³, k = 1 … 2⁵²", 5e-16),
            Row::relative("exp", "−708 … 709", 4e-16),
            Row::new("sine and cosine", "|x| ≤ 1e5", Measure::Absolute, 5e-16),
            Row::stated("sine and cosine, far", "1e5 ≤ |x| ≤ 1e9, 5e-16 and 2⁻⁸⁶|x|"),
        ];
        part.run(effort.of(100, 4000), rows, |t| {
            let x = t.dice.sized(-307.0, 308.0);
            t.place = format!("{x:e}");
            t.relative(0, Lane::ln(x), Wide::from(x).ln());
            let k = t.dice.sized(0.0, 15.65).floor();
            for x in [1.0 - k * f64::EPSILON / 2.0, 1.0 + k * f64::EPSILON] {
                if x > 0.0 {
                    t.place = format!("1 {:+e}", x - 1.0);
                    t.relative(1, Lane::ln(x), (Wide::from(x) - 1.0).ln_1p());
                }
            }
            let x = t.dice.between(-708.0, 709.0);
            t.place = format!("{x:e}");
            t.relative(2, Lane::exp(x), Wide::from(x).exp());
            for (row, least, most) in [(3, -9.0, 5.0), (4, 5.0, 9.0)] {
                let x = t.dice.sign() * t.dice.sized(least, most);
                t.place = format!("{x:e}");
                let [sine, cosine] = Wide::from(x).sin_cos();
                let off = off(Lane::sin(x), sine).max(off(Lane::cos(x), cosine));
                let stated = if row == 4 { 5e-16 + x.abs() * 2f64.powi(-86) } else { 1.0 };
                t.see(row, off / stated);
            }
            Some(())
        });
    })
}
