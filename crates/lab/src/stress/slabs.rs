//! Slabs: adding and doubling against itself with more directions, and against discrete ordinates, see
//! `ordinates`.

use super::ordinates::Ordinates;
use super::prelude::*;
use media::phase::{
    Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic, rayleigh::Rayleigh,
};
use theory::problems::slab::Light;
use theory::slab::{self, Answer, Energy, Resolution, layer::Slice};

/// Directions of the ordinates.
const ORDINATES: usize = 72;
/// Lights on one slab.
pub(super) const LIGHTS: usize = 8;

/// All rows.
pub fn rows(run: Run) -> Vec<Row> {
    let range = "τ = 1e-6 … 100, μ₀ = 1e-4 … 1, |g| to 0.935; twice the resolution";
    let row = Row::stated("slab, adding and doubling", range);
    let slab = || (Slab::any(sized(-6.0, 2.0)), phase());
    let mut rows = run.fill([2, 48], [row], slab, |(slab, phase), seen| finer(slab, *phase, seen));
    let range = "isotropic, τ = 1e-2 … 100, μ₀ = 1e-4 … 1; discrete ordinates, 32 digits";
    let row = Row::stated("slab, another method", range);
    rows.extend(run.fill([4, 64], [row], || Slab::any(sized(-2.0, 2.0)), even));
    rows
}

parameters! {
    /// A slab in several lights.
    Slab(range: Number) {
        depth: f64 = range,
        albedo: f64 = share(),
        lights: Vec<Light> = lights(),
    }
}

impl Slab {
    /// Compares R, T and collisions in each light.
    fn compare(&self, found: Vec<Answer>, exact: Vec<[Wide; 3]>, seen: &mut Seen) {
        for ((found, exact), light) in found.into_iter().zip(exact).zip(&self.lights) {
            seen.at(format_args!("{light:?}"));
            let found = [found.reflected, found.transmitted, found.score];
            for (found, exact) in found.into_iter().zip(exact) {
                seen.stated(0, found, exact);
            }
        }
    }
}

/// Light from all sides, and from near and far of the normal.
pub(super) fn lights() -> impl Strategy<Value = Vec<Light>> {
    let cosine = prop_oneof![1 => sized(-4.0, -1.0), 2 => between(0.05, 1.0)];
    vec(cosine, LIGHTS - 1).prop_map(|cosines| {
        std::iter::once(Light::Diffuse).chain(cosines.into_iter().map(Light::Collimated)).collect()
    })
}

pub(super) fn phase() -> impl Strategy<Value = Phase> {
    (0..4, between(-0.935, 0.935)).prop_map(|(kind, asymmetry)| match kind {
        0 => Phase::Isotropic(Isotropic),
        1 => Phase::Rayleigh(Rayleigh),
        _ => henyey_greenstein(asymmetry),
    })
}

pub(super) fn henyey_greenstein(asymmetry: f64) -> Phase {
    let phase = HenyeyGreenstein::new(asymmetry).map(Phase::HenyeyGreenstein);
    phase.unwrap_or(Phase::Isotropic(Isotropic))
}

/// Adding and doubling with more directions and a thinner first layer.
fn finer(slab: &Slab, phase: Phase, seen: &mut Seen) -> Option<()> {
    let resolution =
        Resolution { faintest: 1e-14, directions: 72, first_layer: 1e-14, ..Resolution::FINE };
    let Slab { depth, albedo, lights } = slab;
    let slice = Slice { flown: *depth, straight: 0.0, scattered: *albedo, score: 1.0 };
    let found = slab::answers(&phase, lights, Known::exact(*depth), *albedo);
    let found = seen.found(0, found)?;
    let fine = slab::energies(&phase, lights, &[slice], resolution)?;
    let all = |fine: Energy| [fine.reflected, fine.transmitted, fine.score].map(Wide::from);
    slab.compare(found, fine.into_iter().map(all).collect(), seen);
    Some(())
}

/// Isotropic scattering by discrete ordinates.
fn even(slab: &Slab, seen: &mut Seen) -> Option<()> {
    let Slab { depth, albedo, lights } = slab;
    // At a = 0 and a = 1 two solutions are one: a grain beside it, 1e-20, nobody sees.
    let near = match *albedo {
        0.0 => Wide::from(1e-20),
        1.0 => 1.0 - Wide::from(1e-20),
        inside => Wide::from(inside),
    };
    let phase = Phase::Isotropic(Isotropic);
    let found = slab::answers(&phase, lights, Known::exact(*depth), *albedo);
    let found = seen.found(0, found)?;
    let exact = Ordinates::new(Wide::from(*depth), near, ORDINATES)?;
    let all = |(light, found): (&Light, &Answer)| {
        let [r, t] = exact.energy(*light);
        let lost = 1.0 - near;
        // Collisions are what is absorbed over 1 − a, of which a white slab leaves no digits.
        let score = (1.0 - r - t) / lost;
        [r, t, if lost.high > 1e-9 { score } else { Wide::from(found.score.value) }]
    };
    let exact = lights.iter().zip(&found).map(all).collect();
    slab.compare(found, exact, seen);
    Some(())
}
