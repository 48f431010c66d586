//! Elementary functions of draws: logarithm, exponential, sine and cosine.

use super::prelude::*;
use numeric::Lane;

parameters! {
    /// An argument of each function.
    Arguments {
        ln: f64 = sized(-307.0, 308.0),
        ulps_from_one: f64 = sized(0.0, 15.65),
        exp: f64 = between(-708.0, 709.0),
        sign: f64 = sign(),
        angle: f64 = sized(-9.0, 5.0),
        far_angle: f64 = sized(5.0, 9.0),
    }
}

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let rows = [
        TrialRow::relative("ln", "1e-307 … 1e308", 5e-16),
        TrialRow::relative("ln next to 1", "1 ± k·2⁻⁵³, k = 1 … 2⁵²", 5e-16),
        TrialRow::relative("exp", "−708 … 709", 4e-16),
        TrialRow::new("sine and cosine", "|x| ≤ 1e5", Measure::Absolute, 5e-16),
        TrialRow::stated("sine and cosine, far", "1e5 ≤ |x| ≤ 1e9, 5e-16 and 2⁻⁸⁶|x|"),
    ];
    run.fill([3200, 128_000], rows, Arguments::any, |arguments, seen| {
        let Arguments { ln, ulps_from_one, exp, sign, angle, far_angle } = *arguments;
        seen.relative(0, Lane::ln(ln), DoubleDouble::from(ln).ln());
        let k = ulps_from_one.floor();
        for x in [1.0 - k * f64::EPSILON / 2.0, 1.0 + k * f64::EPSILON] {
            if x > 0.0 {
                seen.relative(1, Lane::ln(x), (DoubleDouble::from(x) - 1.0).ln_1p());
            }
        }
        seen.relative(2, Lane::exp(exp), DoubleDouble::from(exp).exp());
        let far = 5e-16 + far_angle * 2f64.powi(-86);
        for (row, x, allowed) in [(3, angle, 1.0), (4, far_angle, far)] {
            let [sine, cosine] = DoubleDouble::from(sign * x).sin_cos();
            let [s, c] = [Lane::sin(sign * x), Lane::cos(sign * x)];
            seen.see(row, off(s, sine).max(off(c, cosine)) / allowed);
        }
    })
}
