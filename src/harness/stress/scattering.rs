//! Exact answers with scattering: each against a closed form in 32 digits or another method.

use std::f64::consts::PI;
use std::sync::Arc;

use super::{Dice, Effort, Measure, Row, beyond, in_parts, text};
use crate::media::Piecewise;
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::{Known, Wide};
use crate::phase::{Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic};
use crate::problems::rod::{self, Rod};
use crate::problems::slab::{Incidence, Light};
use crate::theory::slab::{self, Resolution, layer::Slice};
use crate::theory::{Mesh, rod as rods};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(2, 40);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "scattering", part);
        vec![
            closed_rods(dice, 40 * trials),
            solved_rods(dice, trials / 2),
            slabs(dice, trials / 10 + u32::from(part % 4 == 0)),
            single(dice, trials / 4 + 1),
        ]
    })
}

/// How far a value is off, in units of its stated error.
fn of_stated(found: Known, exact: Wide) -> f64 {
    let off = (Wide::from(found.value) - exact).abs().value();
    let rounding = 0.5 * f64::EPSILON * exact.high.abs();
    if off <= rounding { 0.0 } else { off / found.error }
}

/// R and T of a rod in 32 digits; `lost` is 1 − a.
fn leaving(depth: Wide, albedo: f64, forward: f64) -> [Wide; 2] {
    let [a, p] = [albedo, forward].map(Wide::from);
    let (lost, turned) = (Wide::ONE - a * p, a * (Wide::ONE - p));
    let square = (Wide::ONE - a) * (Wide::ONE - a * (p.scaled(1) - Wide::ONE));
    let kappa = square.sqrt();
    let x = kappa * depth;
    let s = if kappa.high > 0.0 { -(-x.scaled(1)).exp_m1() / kappa } else { depth.scaled(1) };
    let below = Wide::ONE + (-x.scaled(1)).exp() + lost * s;
    [turned * s / below, (-x).exp().scaled(1) / below]
}

/// A share in [0, 1], often next to an end.
fn share(dice: &mut Dice) -> f64 {
    match dice.below(5) {
        0 => dice.sized(-12.0, -1.0),
        1 => 1.0 - dice.sized(-15.0, -1.0),
        2 => [0.0, 0.5, 1.0][dice.below(3)],
        _ => dice.between(0.0, 1.0),
    }
}

fn rod_of(depth: f64, albedo: &[f64], forward: f64) -> Option<(Mesh, Rod)> {
    let text = format!("medium.constant.extinction = {depth:e}\nspan = [0, 1]");
    let medium = text::medium(&text)?;
    let cuts: Vec<f64> = (0..=albedo.len()).map(|i| i as f64 / albedo.len() as f64).collect();
    let albedo = Piecewise::steps(&cuts, albedo);
    let forward = Piecewise::constant(forward, medium.span());
    let rod = Rod::new(medium.clone(), &albedo, &forward, rod::channels(0, false, None));
    Some((Mesh::new(medium), rod))
}

fn see_rod(
    row: &mut Row,
    albedo: &[f64],
    exact: impl Fn(Wide) -> [Wide; 2],
    depth: f64,
    forward: f64,
) {
    let Some((mesh, rod)) = rod_of(depth, albedo, forward) else { return };
    let Some(found) = rods::truth(&mesh, &rod) else { return };
    for (found, exact) in found.into_iter().zip(exact(Wide::from(depth))) {
        if exact.high >= 1e-290 {
            row.see(of_stated(found, exact), || {
                format!("τ = {depth:e}, a = {albedo:?}, p_f = {forward:e}")
            });
        }
    }
}

fn closed_rods(dice: &mut Dice, trials: u32) -> Row {
    let range = "τ = 1e-9 … 600, a and p_f next to 0 and 1, too";
    let mut row = Row::new("rod, closed form", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, albedo, forward) = (dice.sized(-9.0, 2.78), share(dice), share(dice));
        see_rod(&mut row, &[albedo], |depth| leaving(depth, albedo, forward), depth, forward);
    }
    row
}

/// Two halves of other albedos, which the solver of varying rods has to join: by adding in 32 digits.
fn solved_rods(dice: &mut Dice, trials: u32) -> Row {
    let range = "two halves of other albedos, τ = 1e-6 … 30";
    let mut row = Row::new("rod, two-stream equations", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, forward) = (dice.sized(-6.0, 1.48), dice.between(0.0, 1.0));
        let albedo = [share(dice), share(dice)];
        let joined = |depth: Wide| {
            let half = depth.scaled(-1);
            let [[r1, t1], [r2, t2]] = albedo.map(|albedo| leaving(half, albedo, forward));
            let echoes = Wide::ONE / (Wide::ONE - r1 * r2);
            [r1 + t1 * t1 * r2 * echoes, t1 * t2 * echoes]
        };
        see_rod(&mut row, &albedo, joined, depth, forward);
    }
    row
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
        let Some(case) = text::case(&text) else { continue };
        let case = Arc::new(case);
        let prepared = case.scenario.prepare(0, None, super::NOWHERE);
        let Ok(ready) = prepared.outcome else { continue };
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
        let place = || format!("σ_t = {sigma:e}, D = {distance:e}, ℓ = {length:e}, foot {foot:e}");
        row.see(beyond(off, reference) / found.error, place);
    }
    row
}
