//! Exact answers with scattering: each against a closed form in 32 digits or another method.

use std::f64::consts::PI;
use std::sync::Arc;

use super::rods::{of_stated, share};
use super::{Dice, Effort, Measure, Row, beyond, in_parts, text};
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::{Known, Wide};
use crate::phase::{Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic};
use crate::problems::slab::{Incidence, Light};
use crate::theory::slab::{self, Resolution, layer::Slice};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(2, 40);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "scattering", part);
        vec![slabs(dice, trials / 10 + u32::from(part % 4 == 0)), single(dice, trials / 4 + 1)]
    })
}

/// Adding and doubling with more directions and a thinner first layer.
fn slabs(dice: &mut Dice, trials: u32) -> Row {
    let range = "τ = 1e-4 … 30, |g| to 0.6; twice the resolution";
    let mut row = Row::new("slab, adding and doubling", range, Measure::OfStated, 1.0);
    let finer = Resolution { faintest: 1e-14, directions: 72, first_layer: 1e-14 };
    for _ in 0..trials {
        let (depth, albedo) = (dice.sized(-4.0, 1.48), share(dice));
        let asymmetry = dice.between(-0.6, 0.6);
        let forward = HenyeyGreenstein::new(asymmetry).filter(|_| dice.below(2) == 0);
        let phase = forward.map_or(Phase::Isotropic(Isotropic), Phase::HenyeyGreenstein);
        let cosine = dice.between(0.05, 1.0);
        let light = if dice.below(3) == 0 { Light::Diffuse } else { Light::Collimated(cosine) };
        let incidence = Incidence { light, phase };
        let slice = Slice { flown: depth, straight: 0.0, scattered: albedo, score: 1.0 };
        let found = slab::answer(&incidence, Known::exact(depth), albedo);
        let fine = slab::energy(&incidence, &[slice], finer);
        let (Some(found), Some(fine)) = (found, fine) else {
            row.see(f64::NAN, || format!("τ = {depth:e}, a = {albedo:e}"));
            continue;
        };
        let pairs = [(found.reflected, fine.reflected), (found.transmitted, fine.transmitted)];
        for (found, exact) in pairs {
            let place = || format!("τ = {depth:e}, a = {albedo:e}, g = {asymmetry:.2}, {light:?}");
            row.see(of_stated(found, Wide::from(exact)), place);
        }
    }
    row
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
