//! Slabs: adding and doubling against itself with more directions, and against discrete ordinates, see
//! `ordinates`, up to the critical albedo.

use super::ordinates::Ordinates;
use super::prelude::*;
use media::phase::{
    Phase, henyey_greenstein::HenyeyGreenstein, isotropic::Isotropic, rayleigh::Rayleigh,
};
use theory::Kernel;
use theory::problems::slab::IncidentLight;
use theory::slab::{self, Energy, EnergyBounds, Resolution};

/// Directions of the ordinates.
const ORDINATES: usize = 72;
/// Bisections of the critical albedo.
const BISECTIONS: u32 = 40;
/// Relative distance to the critical albedo beyond which a slab is on a known side of it.
const NEAR: f64 = 2e-3;
/// Lights on one slab.
pub(super) const LIGHTS: usize = 8;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "τ = 1e-6 … 100, μ₀ = 1e-4 … 1, |g| to 0.935; twice the resolution";
    let row = TrialRow::stated("slab, adding and doubling", range);
    let slab = || (Slab::any(sized(-6.0, 2.0)), phase());
    let mut rows = run.fill([2, 48], [row], slab, |(slab, phase), seen| finer(slab, *phase, seen));
    let range = "isotropic, τ = 1e-2 … 100, μ₀ = 1e-4 … 1; discrete ordinates, 32 digits";
    let row = TrialRow::stated("slab, another method", range);
    rows.extend(run.fill([4, 64], [row], || Slab::any(sized(-2.0, 2.0)), even));
    let range =
        "g = 0.935 … 0.98, peak cut off, τ = 1e-2 … 30, μ₀ = 1e-4 … 1; twice the directions";
    let row = TrialRow::stated("slab, peaked phase function", range);
    let slab = || (Slab::any(sized(-2.0, 1.48)), between(0.935, 0.98).prop_map(henyey_greenstein));
    rows.extend(run.fill([1, 6], [row], slab, |(slab, phase), seen| finer(slab, *phase, seen)));
    let range = "isotropic, albedo 1e-7 … 0.5 below the critical one, τ = 1e-2 … 10; discrete ordinates, 32 digits";
    let computed = ["slab next to criticality", "moments next to criticality"];
    let mut of_critical = computed.map(|computed| TrialRow::stated(computed, range)).to_vec();
    of_critical.push(TrialRow::wrong("infinite slabs, wrong", range));
    rows.extend(run.fill([4, 64], of_critical, Critical::any, |slab, seen| {
        critical(slab, seen);
        Some(())
    }));
    rows
}

parameters! {
    /// A slab in several lights.
    Slab(range: NumberStrategy) {
        depth: f64 = range,
        albedo: f64 = share(),
        lights: Vec<IncidentLight> = lights(),
    }
}

parameters! {
    /// A slab next to its critical albedo, below or above.
    Critical {
        depth: f64 = sized(-2.0, 1.0),
        distance: f64 = sized(-7.0, -0.3),
        is_beyond: bool = proptest::bool::weighted(0.2),
        lights: Vec<IncidentLight> = lights(),
    }
}

impl Slab {
    /// Compares R, T and collisions in each light.
    fn compare(&self, computed: Vec<EnergyBounds>, exact: Vec<[DoubleDouble; 3]>, seen: &mut Seen) {
        for ((computed, exact), light) in computed.into_iter().zip(exact).zip(&self.lights) {
            seen.at(format_args!("{light:?}"));
            let computed = [computed.reflected, computed.transmitted, computed.score];
            for (computed, exact) in computed.into_iter().zip(exact) {
                seen.stated(0, computed, exact);
            }
        }
    }
}

/// Light from all sides, and from near and far of the normal.
pub(super) fn lights() -> impl Strategy<Value = Vec<IncidentLight>> {
    let cosine = prop_oneof![1 => sized(-4.0, -1.0), 2 => between(0.05, 1.0)];
    vec(cosine, LIGHTS - 1).prop_map(|cosines| {
        std::iter::once(IncidentLight::Diffuse)
            .chain(cosines.into_iter().map(IncidentLight::Collimated))
            .collect()
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
    let fine = Resolution::FINE;
    let resolution = if fine.cuts(&phase) {
        Resolution { peaked: 2 * fine.peaked, first_layer: 1e-12, ..fine }
    } else {
        // The library has the maximum number of directions from |g| = 0.91 on.
        let directions = if phase.moment(1).abs() > 0.88 { 240 } else { 72 };
        Resolution { faintest: 1e-14, directions, first_layer: 1e-14, peaked: 0, ..fine }
    };
    let Slab { depth, albedo, lights } = slab;
    let slice = Kernel { rate: *depth, straight: 0.0, scattered: *albedo, score: 1.0 };
    // Answers of thin and of black slabs have other solvers.
    let computed = seen.computed(0, slab::solve(&phase, lights, &[slice], fine))?;
    let fine = slab::energies(&phase, lights, &[slice], resolution)?;
    let all = |fine: Energy| [fine.reflected, fine.transmitted, fine.score].map(DoubleDouble::from);
    slab.compare(computed, fine.into_iter().map(all).collect(), seen);
    Some(())
}

/// Isotropic scattering by discrete ordinates.
fn even(slab: &Slab, seen: &mut Seen) -> Option<()> {
    let Slab { depth, albedo, lights } = slab;
    // At a = 0 and a = 1 two solutions are one: a grain beside it, 1e-20, changes no digit of shares that are not 0.
    let near = match *albedo {
        0.0 => DoubleDouble::from(1e-20),
        1.0 => 1.0 - DoubleDouble::from(1e-20),
        inside => DoubleDouble::from(inside),
    };
    let phase = Phase::Isotropic(Isotropic);
    let computed = slab::answers(&phase, lights, Known::exact(*depth), *albedo);
    let computed = seen.computed(0, computed)?;
    let exact = Ordinates::new(DoubleDouble::from(*depth), near, ORDINATES)?;
    let all = |(light, computed): (&IncidentLight, &EnergyBounds)| {
        let [r, t] = match *light {
            IncidentLight::Collimated(cosine) if *albedo == 0.0 => {
                [DoubleDouble::default(), (-(DoubleDouble::from(*depth) / cosine)).exp()]
            }
            IncidentLight::Diffuse if *albedo == 0.0 => {
                [DoubleDouble::default(), exact.energy(*light)[1]]
            }
            _ => exact.energy(*light),
        };
        let lost = 1.0 - near;
        // Collisions are what is absorbed over 1 − a, of which a white slab leaves no digits.
        let score = (1.0 - r - t) / lost;
        [r, t, if lost.high > 1e-9 { score } else { DoubleDouble::from(computed.score.value) }]
    };
    let exact = lights.iter().zip(&computed).map(all).collect();
    slab.compare(computed, exact, seen);
    Some(())
}

/// Isotropic scattering next to the critical albedo, by discrete ordinates.
fn critical(slab: &Critical, seen: &mut Seen) {
    let &Critical { depth, distance, is_beyond, ref lights } = slab;
    let phase = Phase::Isotropic(Isotropic);
    let slice = |scattered| Kernel { rate: depth, straight: 0.0, scattered, score: 1.0 };
    let resolution = Resolution { first_layer: 1e-10, ..Resolution::FINE };
    let is_finite = |albedo| {
        slab::energies(&phase, &[IncidentLight::Diffuse], &[slice(albedo)], resolution).is_some()
    };
    let (mut low, mut high) = (1.0, 2.0);
    while is_finite(high) {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if is_finite(middle) { low = middle } else { high = middle }
    }
    let albedo = low * if is_beyond { 1.0 + distance } else { 1.0 - distance };
    let exact = Ordinates::new(DoubleDouble::from(depth), DoubleDouble::from(albedo), ORDINATES)
        .filter(Ordinates::is_positive);
    let fine = slab::answers(&phase, lights, Known::exact(depth), albedo);
    let moments = slab::solve(&phase, lights, &[slice(albedo)], Resolution::COARSE);
    if distance > NEAR {
        for computed in [&fine, &moments] {
            seen.wrong(2, computed.is_some() != exact.is_some());
        }
    }
    for (row, computed) in [fine, moments].into_iter().enumerate() {
        let Some((computed, exact)) = computed.zip(exact.as_ref()) else {
            seen.skip(row);
            continue;
        };
        for (computed, light) in computed.into_iter().zip(lights) {
            seen.at(format_args!("{light:?}"));
            let exact = exact.energy(*light);
            for (computed, exact) in
                [computed.reflected, computed.transmitted].into_iter().zip(exact)
            {
                seen.stated(row, computed, exact);
            }
        }
    }
}
