//! Slabs: adding and doubling against itself with more directions, and against discrete ordinates, see
//! `ordinates`.

use super::ordinates::Ordinates;
use super::trial::{Dice, Trial, share};
use super::{Effort, Row, in_parts};
use media::phase::{
    Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic, rayleigh::Rayleigh,
};
use numeric::{Known, Wide};
use theory::problems::slab::Light;
use theory::slab;
use theory::slab::{Resolution, layer::Slice};

/// Directions of the ordinates.
const ORDINATES: usize = 72;
/// Lights on one slab.
pub(super) const LIGHTS: usize = 8;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(16, "slabs", seed, |part| {
        let some = |every: u64, full: u32| effort.of(u32::from(part.number % every == 0), full);
        let (few, more) = (some(8, 3), some(4, 4));
        let range = "τ = 1e-6 … 100, μ₀ = 1e-4 … 1, |g| to 0.935; twice the resolution";
        part.run(few, [Row::stated("slab, adding and doubling", range)], finer);
        let range = "isotropic, τ = 1e-2 … 100, μ₀ = 1e-4 … 1; discrete ordinates, 32 digits";
        part.run(more, [Row::stated("slab, another method", range)], even);
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

/// Compares what theory finds in each light with what is exact of it, R, T and collisions.
fn compare(
    t: &mut Trial,
    (depth, albedo, phase, said): (f64, f64, Phase, &str),
    lights: &[Light],
    exact: impl FnOnce(&[slab::Answer]) -> Option<Vec<[Wide; 3]>>,
) {
    let found = slab::answers(&phase, lights, Known::exact(depth), albedo);
    let Some((exact, found)) = found.and_then(|found| Some((exact(&found)?, found))) else {
        t.place = format!("τ = {depth:e}, a = {albedo:e}, {:?}{said}", lights[0]);
        t.see(0, f64::NAN);
        return;
    };
    for ((found, exact), light) in found.into_iter().zip(exact).zip(lights) {
        t.place = format!("τ = {depth:e}, a = {albedo:e}, {light:?}{said}");
        let found = [found.reflected, found.transmitted, found.score];
        for (found, exact) in found.into_iter().zip(exact) {
            t.stated(0, found, exact);
        }
    }
}

/// Adding and doubling with more directions and a thinner first layer.
fn finer(t: &mut Trial) {
    let resolution =
        Resolution { faintest: 1e-14, directions: 72, first_layer: 1e-14, ..Resolution::FINE };
    let (depth, albedo) = (t.dice.sized(-6.0, 2.0), share(t.dice));
    let (phase, lights) = (phase(t.dice), lights(t.dice));
    let slice = Slice { flown: depth, straight: 0.0, scattered: albedo, score: 1.0 };
    let said = format!(", {phase:?}");
    compare(t, (depth, albedo, phase, &said), &lights, |_| {
        let fine = slab::energies(&phase, &lights, &[slice], resolution)?;
        let all = |fine: slab::Energy| [fine.reflected, fine.transmitted, fine.score];
        Some(fine.into_iter().map(|fine| all(fine).map(Wide::from)).collect())
    });
}

/// Isotropic scattering by discrete ordinates.
fn even(t: &mut Trial) {
    let (depth, albedo) = (t.dice.sized(-2.0, 2.0), share(t.dice));
    let (phase, lights) = (Phase::Isotropic(Isotropic), lights(t.dice));
    // At a = 0 and a = 1 two solutions are one: a grain beside it, 1e-20, nobody sees.
    let near = match albedo {
        0.0 => Wide::from(1e-20),
        1.0 => 1.0 - Wide::from(1e-20),
        inside => Wide::from(inside),
    };
    compare(t, (depth, albedo, phase, ""), &lights, |found| {
        let exact = Ordinates::new(Wide::from(depth), near, ORDINATES)?;
        let all = |(light, found): (&Light, &slab::Answer)| {
            let [r, t] = exact.energy(*light);
            let lost = 1.0 - near;
            // Collisions are what is absorbed over 1 − a, of which a white slab leaves no digits.
            let score = (1.0 - r - t) / lost;
            [r, t, if lost.high > 1e-9 { score } else { Wide::from(found.score.value) }]
        };
        Some(lights.iter().zip(found).map(all).collect())
    });
}
