//! Single scattering of a point light: the radiance against another quadrature.

use std::f64::consts::PI;
use std::sync::Arc;

use super::{Dice, Effort, Measure, Row, beyond, in_parts, text};
use crate::numeric::Wide;
use crate::numeric::quadrature::GaussLegendre;

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(2, 40);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "scattering", part);
        vec![single(dice, trials / 4 + 1)]
    })
}

/// The radiance of a homogeneous medium against Gauss' rule in the angle at the light, of many panels.
fn single(dice: &mut Dice, trials: u32) -> Row {
    let range = "homogeneous, light 1e-4 … 10 away; 800 panels in θ";
    let mut row = Row::new("single scattering, radiance", range, Measure::OfStated, 1.0);
    let rule = GaussLegendre::new(16);
    for _ in 0..trials {
        let (sigma, albedo, length) =
            (dice.sized(-3.0, 1.0), dice.between(0.1, 1.0), dice.sized(-1.0, 1.5));
        let (distance, foot) = (dice.sized(-4.0, 1.0), dice.between(-0.3, 1.3) * length);
        let text = format!(
            "title = \"t\"\n[problem.single-scattering]\nvolume.constant.extinction = {sigma:e}\n\
             ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = {length:e} }}\n\
             light = {{ position = [{distance:e}, 0, {foot:e}] }}\nalbedo = {albedo:e}\n\
             phase.isotropic = {{}}\nestimators = [{{ source-driven = {{}} }}]"
        );
        let place = || format!("σ_t = {sigma:e}, D = {distance:e}, ℓ = {length:e}, foot {foot:e}");
        let prepared = text::case(&text)
            .map(|case| Arc::new(case).scenario.prepare(0, None, super::NOWHERE).outcome);
        let Some(Ok(ready)) = prepared else {
            row.skip(place);
            continue;
        };
        let found = ready.prediction.channels[0].truth;
        // L = a σ_t/(16π² D) ∫ e^{−σ_t(s + r)} dθ,  s = foot + D tan θ, r = D/cos θ.
        let angle = |s: f64| ((s - foot) / distance).atan();
        let (first, last) = (angle(0.0), angle(length));
        let mut cuts: Vec<f64> = (0..=400)
            .map(|i| f64::from(i) / 400.0)
            .flat_map(|x| [first + x * (last - first), angle(x * length)])
            .collect();
        cuts.sort_by(f64::total_cmp);
        let f = |x: f64| (-sigma * (foot + distance * x.tan() + distance / x.cos())).exp();
        let panel = |pair: &[f64]| Wide::from(rule.integrate(pair[0], pair[1], f));
        let integral: Wide = cuts.windows(2).map(panel).sum();
        let exact = integral * Wide::from(albedo * sigma / (16.0 * PI * PI * distance));
        // The reference's own rounding: that of tan θ next to a right angle.
        let reference =
            (4e-14 + 8.0 * f64::EPSILON * (sigma * length + length / distance)) * exact.high;
        let off = (Wide::from(found.value) - exact).abs().value();
        row.see(beyond(off, reference) / found.error, place);
    }
    row
}
