//! Slabs: adding and doubling against itself with more directions, and against discrete ordinates, see
//! `ordinates`.

use super::ordinates::Ordinates;
use super::rods::{of_stated, share};
use super::{Dice, Effort, Measure, Row, in_parts};
use crate::numeric::{Known, Wide};
use crate::phase::{
    Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic, rayleigh::Rayleigh,
};
use crate::problems::slab::Light;
use crate::theory::slab;
use crate::theory::slab::{Resolution, layer::Slice};

const PARTS: u64 = 16;
/// Directions of the ordinates.
const ORDINATES: usize = 72;

/// Lights on one slab.
pub(super) const LIGHTS: usize = 8;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "slabs", part);
        let some = effort.of(u32::from(part % 8 == 0), 3);
        vec![finer(dice, some), even(dice, effort.of(u32::from(part % 4 == 0), 4))]
    })
}

/// From all sides, and from near and far of the normal.
pub(super) fn lights(dice: &mut Dice) -> Vec<Light> {
    let mut lights = vec![Light::Diffuse];
    while lights.len() < LIGHTS {
        let grazes = dice.below(3) == 0;
        let cosine = if grazes { dice.sized(-4.0, -1.0) } else { dice.between(0.05, 1.0) };
        lights.push(Light::Collimated(cosine));
    }
    lights
}

pub(super) fn phase(dice: &mut Dice) -> Phase {
    let asymmetry = dice.between(-0.935, 0.935);
    match dice.below(4) {
        0 => Phase::Isotropic(Isotropic),
        1 => Phase::Rayleigh(Rayleigh),
        _ => {
            let phase = HenyeyGreenstein::new(asymmetry).map(Phase::HenyeyGreenstein);
            phase.unwrap_or(Phase::Isotropic(Isotropic))
        }
    }
}

fn see(row: &mut Row, found: &slab::Answer, exact: [Wide; 3], place: &dyn Fn() -> String) {
    let found = [found.reflected, found.transmitted, found.score];
    for (found, exact) in found.into_iter().zip(exact) {
        row.see(of_stated(found, exact), place);
    }
}

/// Adding and doubling with more directions and a thinner first layer.
fn finer(dice: &mut Dice, trials: u32) -> Row {
    let range = "τ = 1e-6 … 100, μ₀ = 1e-4 … 1, |g| to 0.935; twice the resolution";
    let mut row = Row::new("slab, adding and doubling", range, Measure::OfStated, 1.0);
    let finer =
        Resolution { faintest: 1e-14, directions: 72, first_layer: 1e-14, ..Resolution::FINE };
    for _ in 0..trials {
        let (depth, albedo) = (dice.sized(-6.0, 2.0), share(dice));
        let (phase, lights) = (phase(dice), lights(dice));
        let slice = Slice { flown: depth, straight: 0.0, scattered: albedo, score: 1.0 };
        let found = slab::answers(&phase, &lights, Known::exact(depth), albedo);
        let fine = slab::energies(&phase, &lights, &[slice], finer);
        let place = |light: &Light| {
            let light = *light;
            move || format!("τ = {depth:e}, a = {albedo:e}, {light:?}, {phase:?}")
        };
        let Some((found, fine)) = found.zip(fine) else {
            row.see(f64::NAN, place(&lights[0]));
            continue;
        };
        for ((found, fine), light) in found.iter().zip(fine).zip(&lights) {
            let exact = [fine.reflected, fine.transmitted, fine.score].map(Wide::from);
            see(&mut row, found, exact, &place(light));
        }
    }
    row
}

/// Isotropic scattering by discrete ordinates.
fn even(dice: &mut Dice, trials: u32) -> Row {
    let range = "isotropic, τ = 1e-2 … 100, μ₀ = 1e-4 … 1; discrete ordinates, 32 digits";
    let mut row = Row::new("slab, another method", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, albedo) = (dice.sized(-2.0, 2.0), share(dice));
        let (phase, lights) = (Phase::Isotropic(Isotropic), lights(dice));
        let place = |light: &Light| {
            let light = *light;
            move || format!("τ = {depth:e}, a = {albedo:e}, {light:?}")
        };
        let found = slab::answers(&phase, &lights, Known::exact(depth), albedo);
        // At a = 0 and a = 1 two solutions are one: a grain beside it, 1e-20, nobody sees.
        let grain = Wide::from(1e-20);
        let near = match albedo {
            0.0 => grain,
            1.0 => Wide::ONE - grain,
            inside => Wide::from(inside),
        };
        let exact = Ordinates::new(Wide::from(depth), near, ORDINATES);
        let Some((found, exact)) = found.zip(exact) else {
            row.see(f64::NAN, place(&lights[0]));
            continue;
        };
        for (found, light) in found.iter().zip(&lights) {
            let [r, t] = exact.energy(*light);
            let lost = Wide::ONE - near;
            // Collisions are what is absorbed over 1 − a, of which a white slab leaves no digits.
            let score = (Wide::ONE - r - t) / lost;
            let score = if lost.high > 1e-9 { score } else { Wide::from(found.score.value) };
            see(&mut row, found, [r, t, score], &place(light));
        }
    }
    row
}
