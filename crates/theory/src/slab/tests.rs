//! Answers and their errors where they are hardest: next to criticality, with peaked phase functions, in thick slabs.

use super::*;
use crate::problems::slab::Incidence;
use crate::{Mesh, ParticleRule};
use media::exponential::Exponential;
use media::phase::henyey_greenstein::HenyeyGreenstein;
use media::phase::isotropic::Isotropic;
use media::{Medium, Piecewise};
use numeric::Span;
use numeric::quadrature::GaussLegendre;
use std::sync::Arc;

const LIGHTS: [IncidentLight; 3] =
    [IncidentLight::Collimated(1.0), IncidentLight::Collimated(0.3), IncidentLight::Diffuse];

pub(super) fn peaked(g: f64) -> Phase {
    Phase::HenyeyGreenstein(HenyeyGreenstein::new(g).expect("in range"))
}

fn slab(depth: f64, albedo: f64) -> [Kernel; 1] {
    [Kernel { rate: depth, straight: 0.0, scattered: albedo, score: 1.0 }]
}

/// Adding and doubling with three times the directions is the other method. It confirms the stated error also where the
/// series diverges with fewer directions.
#[test]
fn next_to_criticality_the_error_covers_what_directions_are_missing() {
    let phase = Phase::Isotropic(Isotropic);
    let precise = Resolution { directions: 48, first_layer: 1e-12, ..Resolution::FINE };
    let mut without = [0; 3];
    for depth in [0.1, 1.0, 4.0] {
        let at =
            |albedo: f64, resolution| energies(&phase, &LIGHTS, &slab(depth, albedo), resolution);
        let (mut low, mut high) = (1.0, 64.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if at(middle, Resolution::COARSE).is_some() { low = middle } else { high = middle }
        }
        for exponent in 1..=24 {
            let albedo = low * (1.0 - 0.5f64.powi(exponent));
            let computed = solve(&phase, &LIGHTS, &slab(depth, albedo), Resolution::COARSE);
            // The albedo is below the critical one of all directions.
            let context = format!("{depth}, 1 - 2^-{exponent}");
            let Some(computed) = computed else { panic!("{context}: not infinite") };
            for (count, eighths) in without.iter_mut().zip([6, 5, 4]) {
                *count += u32::from(at(albedo, Resolution::COARSE.coarser(eighths)).is_none());
            }
            let exact = at(albedo, precise);
            for (i, answer) in computed.iter().enumerate() {
                let exact = exact.as_ref().map_or(f64::INFINITY, |exact| exact[i].reflected);
                let Known { value, error, .. } = answer.reflected;
                let context = format!("{context}: {value} ± {error}, {exact}");
                assert!((value - exact).abs() <= error, "{context}");
                assert!(exponent > 6 || error < 0.1 * value, "{context}");
            }
        }
    }
    assert!(without[1..].iter().all(|&count| count > 0), "{without:?}");
}

/// All directions resolve g = 0.9, and confirm the error with 48 directions and the peak cut off.
#[test]
fn a_forward_peak_that_is_cut_off_is_covered_by_the_error() {
    for depth in [0.2, 1.0, 5.0, 30.0] {
        for albedo in [0.5, 0.9, 1.0] {
            let at = |resolution| {
                solve(&peaked(0.9), &LIGHTS, &slab(depth, albedo), resolution).expect("finite")
            };
            let exact = at(Resolution { faintest: 1e-8, first_layer: 1e-11, ..Resolution::FINE });
            let cut = at(Resolution { peaked: 48, first_layer: 1e-11, ..Resolution::FINE });
            for (i, (cut, exact)) in cut.iter().zip(&exact).enumerate() {
                for (cut, exact) in
                    [(cut.reflected, exact.reflected), (cut.transmitted, exact.transmitted)]
                {
                    let off = (cut.value - exact.value).abs();
                    let context =
                        format!("{depth}, {albedo}, light {i}: {cut:?}, {exact:?}, {off:e}");
                    assert!(off <= cut.error + exact.error, "{context}");
                    assert!(cut.error < 1e-2 * cut.value, "{context}");
                }
            }
        }
    }
}

/// Without a cut, 200 directions resolve g = 0.95 to 1e-9. For g = 0.99, 144 directions confirm the error of 72.
#[test]
fn peaks_that_most_directions_do_not_resolve_have_answers() {
    let lights = [IncidentLight::Collimated(1.0), IncidentLight::Diffuse];
    let many = Resolution {
        faintest: 1.0,
        directions: 200,
        first_layer: 1e-9,
        peaked: 0,
        ..Resolution::FINE
    };
    assert!(resolves(&peaked(0.95)) && resolves(&peaked(0.99)) && !resolves(&peaked(-0.95)));
    let slices = slab(5.0, 0.9);
    let exact = energies_at(&peaked(0.95), &lights, &slices, many).expect("finite");
    let computed = answers(&peaked(0.95), &lights, Known::exact(5.0), 0.9).expect("finite");
    for (computed, exact) in computed.iter().zip(&exact) {
        let pairs = [
            (computed.reflected, exact.reflected),
            (computed.transmitted, exact.transmitted),
            (computed.score, exact.score),
        ];
        for (computed, exact) in pairs {
            assert!(
                (computed.value - exact).abs() <= computed.error + 1e-8,
                "{computed:?}, {exact}"
            );
            assert!(computed.error < 1e-4 * computed.value, "{computed:?}");
        }
    }
    let few = Resolution { peaked: 72, first_layer: 1e-9, ..Resolution::FINE };
    let exact = energies(&peaked(0.99), &lights, &slices, Resolution { peaked: 144, ..few });
    let computed = solve(&peaked(0.99), &lights, &slices, few).expect("finite");
    for (computed, exact) in computed.iter().zip(exact.expect("finite")) {
        for (computed, exact) in
            [(computed.reflected, exact.reflected), (computed.transmitted, exact.transmitted)]
        {
            assert!((computed.value - exact).abs() <= computed.error, "{computed:?}, {exact}");
        }
        assert!(computed.transmitted.error < 1e-2 * computed.transmitted.value, "{computed:?}");
    }
}

/// Deep in a slab the flux falls off like `e^{−κτ}`, `(a/2κ) ln((1 + κ)/(1 − κ)) = 1`: κ = 0.52543 for a = 0.9.
#[test]
fn thick_slabs_let_as_much_through_as_diffusion_says() {
    let (mut low, mut high) = (0.1, 0.9);
    for _ in 0..60 {
        let kappa: f64 = 0.5 * (low + high);
        let rest = 0.9 * kappa.atanh() / kappa - 1.0;
        if rest < 0.0 { low = kappa } else { high = kappa }
    }
    let kappa: f64 = 0.5 * (low + high);
    assert!((kappa - 0.52543).abs() < 1e-5, "{kappa}");
    let through = |depth: f64| {
        // An optical depth is a product that is rounded.
        let depth = Known::new(depth, f64::EPSILON * depth);
        let computed = answers(&Phase::Isotropic(Isotropic), &LIGHTS, depth, 0.9);
        let computed = computed.expect("finite");
        computed.iter().map(|answer| answer.transmitted).collect::<Vec<_>>()
    };
    let first = through(60.0);
    for depth in [80.0, 150.0, 290.0] {
        for (first, computed) in first.iter().zip(through(depth)) {
            let ratio = (kappa * (depth - 60.0)).exp() * computed.value / first.value;
            let error = computed.error / computed.value + first.error / first.value;
            assert!((ratio - 1.0).abs() <= error, "{depth}: {ratio} ± {error}");
            assert!(computed.error < 1e-4 * computed.value, "{depth}: {computed:?}");
        }
    }
}

/// Draws of all these walks are in [0, 1], hence V ≤ T(1 − T), and 0 or 1 without weights: V = T(1 − T).
#[test]
fn the_variance_of_shares_of_thick_slabs_is_at_most_that_of_a_coin() {
    let incidence =
        Incidence { light: IncidentLight::Collimated(1.0), phase: Phase::Isotropic(Isotropic) };
    let mut resolved = 0;
    for depth in [5.0, 40.0, 60.0, 120.0] {
        let known = Known::new(depth, f64::EPSILON * depth);
        let truth = answers(&incidence.phase, &[incidence.light], known, 0.9);
        let truth = truth.expect("finite")[0];
        for rule in ParticleRule::ALL {
            for sampling in [1.0, 1.3] {
                let pieces = Pieces::Exact(vec![Piece::of(sampling * depth, 1.0 / sampling)]);
                let (largest_ratio, with_distributions) = (1.0 / sampling, true);
                let walk = SlabWalk {
                    incidence,
                    albedo: 0.9,
                    rule,
                    pieces,
                    largest_ratio,
                    depth,
                    with_distributions,
                };
                for channel in walk.predict(&truth).channels {
                    let coin = channel.truth.value * (1.0 - channel.truth.value);
                    let Some(moments) = channel.resolved_moments() else { continue };
                    resolved += 1;
                    let error = channel.moments_error().expect("known");
                    let ratio = moments.variance() / coin;
                    let context =
                        format!("{rule:?}, {depth}, {sampling}, {}: {ratio}", channel.name);
                    assert!(ratio <= 1.0 + error.min(1e-3), "{context}");
                    if matches!(rule, ParticleRule::Analog | ParticleRule::Terminating) {
                        assert!((ratio - 1.0).abs() <= error.min(1e-3), "{context}");
                    }
                }
            }
        }
    }
    assert!(resolved > 60, "{resolved}");
}

/// An exponential medium under a constant σ̂, cut into layers.
fn exponential(lights: &[IncidentLight], sampling: f64) -> (Mesh, Pieces) {
    let span = Span::new(0.0, 1.0);
    let mesh = Mesh::new(Medium::new(Arc::new(Exponential::new(10.0, 2.0)), span, span));
    let flown = Piecewise::constant(sampling, span);
    let pieces = Pieces::new(&mesh, &flown, &ParticleRule::Adaptive.kinks(1.0), lights);
    assert!(matches!(pieces, Pieces::Graded(_)));
    (mesh, pieces)
}

/// By every rule draws are 0 or 1 where a white medium has σ̂ ≥ σ_t: V = T(1 − T).
#[test]
fn draws_of_0_and_1_are_seen_by_their_weights() {
    let of = |rule, light, albedo, ratio, depth, pieces: Pieces| {
        let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
        let truth = answers(&incidence.phase, &[light], Known::exact(depth), albedo);
        let truth = truth.expect("finite")[0];
        let walk = SlabWalk {
            incidence,
            albedo,
            rule,
            pieces,
            largest_ratio: ratio,
            depth,
            with_distributions: true,
        };
        (truth, walk.predict(&truth))
    };
    for light in [IncidentLight::Collimated(0.5), IncidentLight::Diffuse] {
        for rule in ParticleRule::ALL {
            let constant = Pieces::Exact(vec![Piece::of(28.0, 1.0 / 1.4)]);
            let (mesh, graded) = exponential(&[light], 14.0);
            let depth = mesh.optical_depth().value;
            for (depth, ratio, pieces) in
                [(20.0, 1.0 / 1.4, constant), (depth, 10.0 / 14.0, graded)]
            {
                let (truth, computed) = of(rule, light, 1.0, ratio, depth, pieces);
                for (truth, channel) in
                    [truth.reflected, truth.transmitted].iter().zip(&computed.channels)
                {
                    let moments = channel.resolved_moments().expect("known");
                    let coin = truth.value * (1.0 - truth.value);
                    let off = (moments.variance() / coin - 1.0).abs();
                    let error = channel.moments_error().expect("known");
                    assert!(
                        off <= error && error < 1e-7,
                        "{rule:?}, {light:?}: {off:e}, {error:e}"
                    );
                }
            }
            // With absorption the weights of three rules are below 1.
            let pieces = Pieces::Exact(vec![Piece::of(1.4, 1.0 / 1.4)]);
            let (truth, computed) = of(rule, light, 0.6, 1.0 / 1.4, 1.0, pieces);
            let variance = computed.channels[0].moments.expect("known").variance();
            let coin = truth.reflected.value * (1.0 - truth.reflected.value);
            let is_coin = matches!(rule, ParticleRule::Analog | ParticleRule::Terminating);
            assert_eq!((variance / coin - 1.0).abs() < 1e-7, is_coin, "{rule:?}, {light:?}");
        }
    }
}

/// A walk without end looks up the mean chord times the mean σ̂ under light on both sides, and without scattering lookups
/// are those of a line: `E[M(M − 1)…(M − k + 1)] = k ∫ σ̂ e^{−K} A^{k − 1} ds`, K and A the integrals of `σ_t/μ` and `(σ̂ − σ_t)/μ`.
#[test]
fn lookups_are_known_where_the_ratio_varies() {
    let light = IncidentLight::Diffuse;
    let sampling = 12.0;
    let (mesh, pieces) = exponential(&[light], sampling);
    let depth = mesh.optical_depth().value;
    let (rule, with_distributions) = (ParticleRule::NonTerminating, true);
    let walk = |light, rule, albedo, pieces| {
        let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
        SlabWalk {
            incidence,
            albedo,
            rule,
            pieces,
            largest_ratio: 10.0 / 12.0,
            depth,
            with_distributions,
        }
    };
    let Pieces::Graded(cuts) = pieces.clone() else { panic!("varies") };
    let reversed = Pieces::Graded(cuts.map(|cut| cut.into_iter().rev().collect()));
    let mean = |pieces| walk(light, rule, 0.8, pieces).lookups(&[light]).expect("known")[0][0];
    let both = mean(pieces) + mean(reversed);
    assert!((both.value - 4.0 * sampling).abs() <= both.error, "{both:?}");
    assert!(both.error < 2e-3 * both.value, "{both:?}");
    let cosine = 0.5;
    let light = IncidentLight::Collimated(cosine);
    let pieces = exponential(&[light], sampling).1;
    let computed =
        walk(light, ParticleRule::Analog, 0.0, pieces).lookups(&[light]).expect("known")[0];
    let rule = GaussLegendre::new(96);
    let exact = [1, 2, 3, 4].map(|k| {
        rule.integrate(0.0, 1.0, |t| {
            let lost = 5.0 * (1.0 - (-2.0 * t).exp()) / cosine;
            let survived = sampling * t / cosine - lost;
            f64::from(k) * sampling / cosine * (-lost).exp() * survived.powi(k - 1)
        })
    });
    for (computed, exact) in computed.iter().zip(exact) {
        assert!((computed.value - exact).abs() <= computed.error, "{computed:?}, {exact}");
        assert!(computed.error < 0.02 * computed.value, "{computed:?}, {exact}");
    }
}
