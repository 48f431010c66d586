//! Slabs against reference values that were computed by other means: reflectance, transmittance, the
//! H-function and the second moments of walks.

use serde::Deserialize;

use lab::h_function::h_function;
use trueflight::numeric::Known;
use trueflight::phase::Phase;
use trueflight::phase::henyey_greenstein::HenyeyGreenstein;
use trueflight::phase::isotropic::Isotropic;
use trueflight::phase::rayleigh::Rayleigh;
use trueflight::problems::slab::{Incidence, IncidentLight};
use trueflight::theory::ParticleRule;
use trueflight::theory::slab::{Existence, Piece, Pieces, Resolution, SlabWalk, cached, solve};

#[derive(Deserialize)]
struct Reference {
    id: String,
    params: Params,
    value: Vec<f64>,
}

#[derive(Deserialize)]
struct Params {
    a: f64,
    tau: Option<f64>,
    g: Option<f64>,
    #[serde(rename = "D")]
    thickness: Option<f64>,
}

const COSINES: [f64; 6] = [0.1, 0.3, 0.5, 0.7, 0.9, 1.0];

fn references() -> Vec<Reference> {
    serde_json::from_str(include_str!("../data/slabs.json")).expect("the reference values")
}

/// Returns the phase function of a slab, and the tolerance of its values.
fn phase(reference: &Reference) -> Option<(Phase, f64)> {
    let isotropic = Phase::Isotropic(Isotropic);
    match reference.id.as_str() {
        "slab_iso" => Some((isotropic, 1e-10)),
        "slab_rayleigh" => Some((Phase::Rayleigh(Rayleigh), 1e-10)),
        "slab_hg" => {
            let phase = HenyeyGreenstein::new(reference.params.g?)?;
            Some((Phase::HenyeyGreenstein(phase), 1e-8))
        }
        _ => None,
    }
}

#[test]
fn reflectance_and_transmittance_are_those_of_the_references() {
    let mut count = 0;
    for reference in references() {
        let Some((phase, tolerance)) = phase(&reference) else { continue };
        let depth = Known::exact(reference.params.tau.expect("an optical depth"));
        let lights =
            COSINES.map(IncidentLight::Collimated).into_iter().chain([IncidentLight::Diffuse]);
        for (i, light) in lights.enumerate() {
            let incidence = Incidence { light, phase };
            let answer = cached(&incidence, depth, reference.params.a).expect("finite");
            // Six reflectances, six transmittances, and both for diffuse light.
            let places = if i < 6 { [i, 6 + i] } else { [12, 13] };
            for (known, place) in [answer.reflected, answer.transmitted].into_iter().zip(places) {
                let expected = reference.value[place];
                let error = (known.value - expected).abs();
                let context = format!("{} {:?} {light:?}", reference.id, reference.params.tau);
                assert!(error <= tolerance, "{context}: {} for {expected}", known.value);
                // The stated error of the answer is an upper bound, but does not widen the tolerance.
                assert!(error <= known.error, "{context}: {error:e} > {:e}", known.error);
                assert!(known.error <= tolerance, "{context}: {:e}", known.error);
                count += 1;
            }
        }
    }
    assert!(count >= 14 * 15, "{count}");
}

#[test]
fn the_h_function_is_that_of_the_references() {
    let mut count = 0;
    for reference in references().iter().filter(|reference| reference.id == "H_iso") {
        for (cosine, expected) in COSINES.iter().zip(&reference.value) {
            let found = h_function(reference.params.a, *cosine);
            assert!((found / expected - 1.0).abs() < 1e-13, "{cosine}: {found} for {expected}");
            count += 1;
        }
    }
    assert!(count >= 30);
}

#[test]
fn a_thick_slab_reflects_like_a_semi_infinite_one() {
    // Van de Hulst's e^{−2kτ} is below 1e-16 here.
    for (albedo, depth) in [(0.5, 25.0), (0.9, 40.0)] {
        for cosine in COSINES {
            let light = IncidentLight::Collimated(cosine);
            let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
            let answer = cached(&incidence, Known::exact(depth), albedo).expect("finite");
            let exact = 1.0 - h_function(albedo, cosine) * f64::sqrt(1.0 - albedo);
            assert!((answer.reflected.value - exact).abs() < 1e-12, "a = {albedo}, μ₀ = {cosine}");
        }
    }
}

#[test]
fn all_light_leaves_a_slab_that_absorbs_none() {
    for g in [0.0, 0.5, 0.9, -0.4] {
        let phase = Phase::HenyeyGreenstein(HenyeyGreenstein::new(g).expect("in range"));
        for light in [
            IncidentLight::Diffuse,
            IncidentLight::Collimated(0.05),
            IncidentLight::Collimated(1.0),
        ] {
            let answer =
                cached(&Incidence { light, phase }, Known::exact(3.0), 1.0).expect("finite");
            let sum = answer.reflected.value + answer.transmitted.value;
            assert!((sum - 1.0).abs() < 2e-13, "g = {g}, {light:?}: {sum}");
        }
    }
}

#[test]
fn sharp_phase_functions_meet_their_error_bound() {
    for light in [IncidentLight::Diffuse, IncidentLight::Collimated(0.3)] {
        let phase = Phase::HenyeyGreenstein(HenyeyGreenstein::new(0.9).expect("in range"));
        let answer = cached(&Incidence { light, phase }, Known::exact(4.0), 0.95).expect("finite");
        for known in [answer.reflected, answer.transmitted] {
            assert!(known.error < 1e-8, "{known:?}");
        }
    }
}

/// Returns the rule, σ̂ and the parameters of a walk through σ_t = 1 on a slab of thickness D.
fn walk(reference: &Reference) -> (ParticleRule, &'static str, f64, f64) {
    let (name, sampling) = reference.id["spm_slab/".len()..].split_once('/').expect("a rule");
    let (rule, name) = match name {
        "term" => (ParticleRule::Terminating, "terminating"),
        "non" => (ParticleRule::NonTerminating, "non-terminating"),
        other => panic!("{other}"),
    };
    let thickness = reference.params.thickness.expect("a thickness");
    (rule, name, sampling.parse().expect("σ̂"), thickness)
}

#[test]
fn second_moments_that_predict_prints_are_those_of_the_references() {
    let (mut count, mut worst) = (0, 0.0f64);
    for reference in references().iter().filter(|r| r.id.starts_with("spm_slab/")) {
        let (_, rule, sampling, thickness) = walk(reference);
        for (cosine, expected) in [(0.5, &reference.value[..2]), (1.0, &reference.value[2..])] {
            let rows = crate::common::predicted(&format!(
                "title = \"a slab\"\n[problem.slab]\nmedium.constant.extinction = 1\n\
                 span = [0, {thickness}]\nalbedo = {}\nphase.isotropic = {{}}\n\
                 incidence.collimated.cosine = {cosine}\nsampling.constant.value = {sampling}\n\
                 estimators = [{{ {rule} = {{}} }}]",
                reference.params.a
            ));
            for (row, expected) in rows.iter().zip(expected) {
                let [mean, variance] = [row.truth, row.predicted_variance].map(|x| x.expect("V"));
                let off = (variance + mean * mean - expected).abs();
                let stated = row.moments_error.expect("an error") * variance;
                assert!(off <= stated, "{}: {off:e} > {stated:e}", reference.id);
                assert!(stated < 1e-4 * variance, "{}: {stated:e}", reference.id);
                worst = worst.max(off / expected);
                count += 1;
            }
        }
    }
    assert_eq!(count, 12);
    // The bound that the README states.
    assert!(worst < 7e-10, "{worst:e}");
}

#[test]
fn adding_and_doubling_resolves_second_moments_like_truths_where_it_is_asked_to() {
    for reference in references().iter().filter(|r| r.id.starts_with("spm_slab/")) {
        let (rule, _, sampling, thickness) = walk(reference);
        for (cosine, expected) in [(0.5, &reference.value[..2]), (1.0, &reference.value[2..])] {
            let (ratio, albedo) = (1.0 / sampling, reference.params.a);
            let odds = rule.probabilities(ratio, albedo);
            let slice = odds.kernel(thickness * sampling, [1.0 - ratio, albedo * ratio], 2);
            let (light, phase) = (IncidentLight::Collimated(cosine), Phase::Isotropic(Isotropic));
            let answer = solve(&phase, &[light], &[slice], Resolution::FINE).expect("finite")[0];
            for (known, expected) in [answer.reflected, answer.transmitted].iter().zip(expected) {
                let error = (known.value - expected).abs();
                assert!(error <= known.error && known.error < 1e-10, "{known:?} for {expected}");
            }
        }
    }
}

/// Returns a walk by the non-terminating rule at a = 0.8 through layers.
fn through(light: IncidentLight, pieces: Vec<Piece>) -> SlabWalk {
    SlabWalk {
        incidence: Incidence { light, phase: Phase::Rayleigh(Rayleigh) },
        albedo: 0.8,
        rule: ParticleRule::NonTerminating,
        depth: 1.0,
        largest_ratio: 2.0,
        pieces: Pieces::Exact(pieces),
        with_distributions: true,
    }
}

/// Returns the mean of the lookups. The gate tests it to 1e-5 at best, with 1e9 draws. Its error is stated from ten
/// directions and eight, and is far above that of sixteen.
fn lookups(walk: &SlabWalk) -> Known {
    let truth = cached(&walk.incidence, Known::exact(1.0), 0.8).expect("finite");
    let law = walk.predict(&truth).lookups.expect("r is constant in each layer");
    assert!(law.error < 1e-5, "{:e}", law.error);
    Known::new(law.mean, law.mean * law.error)
}

/// Returns whether a number agrees with its expected value within its error.
fn is(known: Known, expected: f64) -> bool {
    (known.value - expected).abs() <= known.error
}

#[test]
fn a_walk_without_end_looks_up_the_mean_chord() {
    // Lambertian light on both sides: 4V/S = 2D, times the mean σ̂, for any content of the slab.
    let layers = [(0.7, 0.3), (0.2, 0.9), (1.1, 0.6)];
    let of = |order: &[usize]| {
        let pieces = order.iter().map(|&i| Piece::of(layers[i].0, layers[i].1)).collect();
        lookups(&through(IncidentLight::Diffuse, pieces))
    };
    let (there, back) = (of(&[0, 1, 2]), of(&[2, 1, 0]));
    let both = there + back;
    assert!(is(both, 2.0 * 2.0 * 2.0) && (both.value - 8.0).abs() < 1e-8, "{both:?}");
    assert!((there.value - back.value).abs() > 1e-3);
    let alone = lookups(&through(IncidentLight::Diffuse, vec![Piece::of(1.7, 0.5)]));
    assert!(is(alone, 3.4) && (alone.value - 3.4).abs() < 1e-8, "{alone:?}");
}

#[test]
fn the_law_of_the_lookups_is_that_of_a_line_without_scattering() {
    // Black, r = 0.4: each of Poisson(∫σ̂/μ₀) collisions is the last with probability r.
    let light = IncidentLight::Collimated(0.4);
    let black = through(light, vec![Piece::of(1.2, 0.4)]);
    let walk = SlabWalk { albedo: 0.0, rule: ParticleRule::Terminating, ..black };
    let truth = cached(&walk.incidence, Known::exact(0.48), 0.0).expect("finite");
    let law = walk.predict(&truth).lookups.expect("r is constant");
    let (collisions, survival) = (3.0_f64, 0.6_f64);
    // P(M = m) = s^{m−1} ((1 − s) P(N ≥ m) + s P(N = m)),  N ~ Poisson(∫σ̂/μ₀)
    let mut poisson = vec![(-collisions).exp()];
    (1..60).for_each(|n| poisson.push(poisson[n - 1] * collisions / n as f64));
    let chance = |m: usize| {
        let beyond: f64 = poisson[m..].iter().sum();
        survival.powi(i32::try_from(m).expect("a few") - 1)
            * ((1.0 - survival) * beyond + survival * poisson[m])
    };
    let moment = |f: &dyn Fn(f64) -> f64| -> f64 {
        poisson[0] * f(0.0) + (1..60).map(|m| chance(m) * f(m as f64)).sum::<f64>()
    };
    let mean = moment(&|m| m);
    let variance = moment(&|m| (m - mean).powi(2));
    let kurtosis = moment(&|m| (m - mean).powi(4)) / (variance * variance);
    assert!((law.mean / mean - 1.0).abs() < 1e-8, "{} {mean}", law.mean);
    assert!((law.variance / variance - 1.0).abs() < 1e-8, "{} {variance}", law.variance);
    assert!((law.kurtosis / kurtosis - 1.0).abs() < 1e-8, "{} {kurtosis}", law.kurtosis);
}

#[test]
fn layers_of_one_kind_are_one_layer() {
    let light = IncidentLight::Collimated(0.3);
    let moments = |pieces: Vec<Piece>| {
        let walk = through(light, pieces);
        let truth = cached(&walk.incidence, Known::exact(1.0), 0.8).expect("finite");
        let channels = walk.predict(&truth).channels;
        let variances = channels.iter().map(|channel| {
            let moments = channel.moments.expect("r is constant");
            assert!(moments.error < 1e-4, "{:e}", moments.error);
            Known::new(moments.variance(), moments.variance() * moments.error)
        });
        (variances.collect::<Vec<Known>>(), lookups(&walk))
    };
    let (whole, cut) = (
        moments(vec![Piece::of(1.6, 0.7)]),
        moments(vec![Piece::of(0.5, 0.7), Piece::of(0.1, 0.7), Piece::of(1.0, 0.7)]),
    );
    let same = |a: &Known, b: &Known| {
        assert!((a.value - b.value).abs() <= a.error + b.error, "{a:?} {b:?}");
        // With the same directions only the first layers differ.
        assert!((a.value / b.value - 1.0).abs() < 1e-9, "{a:?} {b:?}");
    };
    whole.0.iter().zip(&cut.0).for_each(|(a, b)| same(a, b));
    same(&whole.1, &cut.1);
}

#[test]
fn a_varying_ratio_is_averaged_to_its_error() {
    // Weighted delta tracking: E[X^k] is the energy of the slab of albedo a^k, for any r(z) ≤ 1.
    let ramp = |count: usize| -> Vec<Piece> {
        let layer = |i: usize| {
            let at = |x: f64| (i as f64 + x) / count as f64;
            // r from 0.2 to 1 with σ̂ = 1.5 on [0, 1]; two-point Gauss in each layer.
            let nodes = [0.5 - 0.75f64.sqrt() / 3.0, 0.5 + 0.75f64.sqrt() / 3.0];
            let ratios = nodes.map(|x| [0.5, 0.2 + 0.8 * at(x)]).to_vec();
            Piece { flown: 1.5 / count as f64, ratios }
        };
        (0..count).map(layer).collect()
    };
    let graded = SlabWalk {
        rule: ParticleRule::Weighted,
        depth: 0.9,
        pieces: Pieces::Graded([ramp(12), ramp(24)]),
        ..through(IncidentLight::Collimated(0.6), Vec::new())
    };
    let exact = SlabWalk { largest_ratio: 1.0, ..graded.clone() };
    let truth = cached(&graded.incidence, Known::exact(0.9), 0.8).expect("finite");
    let (graded, exact) = (graded.predict(&truth), exact.predict(&truth));
    for (graded, exact) in graded.channels.iter().zip(&exact.channels) {
        let (graded, exact) = (graded.moments.expect("known"), exact.moments.expect("known"));
        let difference = (graded.variance() / exact.variance() - 1.0).abs();
        assert!(difference <= graded.error + exact.error, "{difference:e} > {:e}", graded.error);
        assert!(graded.error < 0.01, "{:e}", graded.error);
    }
}

#[test]
fn a_walk_far_below_the_extinction_diverges() {
    let of = |sampling: f64| SlabWalk {
        largest_ratio: 1.0 / sampling,
        depth: 3.0,
        ..through(IncidentLight::Diffuse, vec![Piece::of(3.0 * sampling, 1.0 / sampling)])
    };
    for (sampling, expected) in [
        (1.0, Existence::Finite),
        (0.9, Existence::Finite),
        (0.5, Existence::Diverges),
        (0.3, Existence::Diverges),
    ] {
        assert_eq!(of(sampling).second_moment(), expected, "{sampling}");
    }
}

/// The place where the second moment diverges is found by bisection: next to it the side of a slab is undecided.
#[test]
fn next_to_the_critical_extinction_a_slab_is_not_said_to_diverge() {
    let of = |sampling: f64| {
        let walk = SlabWalk {
            largest_ratio: 1.0 / sampling,
            depth: 3.0,
            ..through(IncidentLight::Diffuse, vec![Piece::of(3.0 * sampling, 1.0 / sampling)])
        };
        walk.second_moment()
    };
    let (mut diverges, mut exists) = (0.5, 0.9);
    for _ in 0..24 {
        let middle = 0.5 * (diverges + exists);
        if of(middle) == Existence::Finite { exists = middle } else { diverges = middle }
    }
    assert_eq!(of(diverges), Existence::Unknown);
    assert_eq!(of(0.99 * diverges), Existence::Diverges);
}

/// Distribution of the collisions of a walk through layers of isotropic scattering.
#[derive(Deserialize)]
struct Lookups {
    rule: String,
    a: f64,
    /// `∫σ̂` and `σ_t/σ̂` of each, the first on top.
    layers: Vec<[f64; 2]>,
    cosine: Option<f64>,
    mean: f64,
    variance: f64,
    kurtosis: f64,
}

#[test]
fn variances_and_kurtoses_of_lookups_are_those_of_the_references() {
    let references: Vec<Lookups> =
        serde_json::from_str(include_str!("../data/slab-lookups.json")).expect("the references");
    assert_eq!(references.len(), 21);
    for Lookups { rule, a, layers, cosine, mean, variance, kurtosis } in references {
        let rule = ParticleRule::ALL.into_iter().find(|page| page.name() == rule).expect("a rule");
        let light = cosine.map_or(IncidentLight::Diffuse, IncidentLight::Collimated);
        let depth: f64 = layers.iter().map(|[flown, ratio]| flown * ratio).sum();
        let walk = SlabWalk {
            incidence: Incidence { light, phase: Phase::Isotropic(Isotropic) },
            albedo: a,
            rule,
            depth,
            largest_ratio: layers.iter().map(|layer| layer[1]).fold(0.0, f64::max),
            pieces: Pieces::Exact(layers.iter().map(|&[flown, r]| Piece::of(flown, r)).collect()),
            with_distributions: true,
        };
        let truth = cached(&walk.incidence, Known::exact(depth), a).expect("finite");
        let law = walk.predict(&truth).lookups.expect("r is constant in each layer");
        let context = format!("{rule:?}, a = {a}, {layers:?}, {light:?}");
        assert!((law.mean / mean - 1.0).abs() <= law.error, "{context}: {} {mean}", law.mean);
        // The references have nine digits.
        let error = law.moments_error + 2e-9;
        assert!(error < 1e-2, "{context}: {error:e}");
        let off = law.variance / variance - 1.0;
        assert!(off.abs() < 2e-6_f64.min(error), "{context}: {} for {variance}", law.variance);
        let off = law.kurtosis / kurtosis - 1.0;
        assert!(
            off.abs() < 1e-4_f64.min(3.0 * error),
            "{context}: {} for {kurtosis}",
            law.kurtosis
        );
    }
}

/// Returns a slab of constant σ_t = σ̂ on [0, 1] as the text of a case, with all rules.
fn constant(depth: &str, albedo: &str, phase: &str) -> String {
    format!(
        "title = \"a slab\"\nunderpowered = \"allow\"\n[problem.slab]\n\
         medium.constant.extinction = {depth}\nspan = [0, 1]\nalbedo = {albedo}\nphase.{phase}\n\
         incidence.collimated.cosine = 0.5\nsampling.constant.value = {depth}\n\
         estimators = [{{ analog = {{}} }}, {{ non-terminating = {{}} }}]"
    )
}

#[test]
fn thin_slabs_are_answered() {
    for (depth, albedo, phase) in [
        ("1e-12", "1", "isotropic = {}"),
        ("1e-12", "1", "rayleigh = {}"),
        ("1e-12", "0.9", "henyey-greenstein.g = 0.8"),
        ("1e-6", "0.9", "isotropic = {}"),
        ("1e-5", "0.9", "isotropic = {}"),
    ] {
        for row in crate::common::predicted(&constant(depth, albedo, phase)) {
            let context = format!("τ = {depth}, a = {albedo}, {phase}: {}", row.reason());
            let [truth, error] = [row.truth, row.truth_error].map(|x| x.expect(&context));
            assert!(error < 1e-4 * truth, "{context}: {error:e}");
        }
    }
}

/// A refusal names the limit that is hit and its value.
#[test]
fn what_adding_and_doubling_does_not_resolve_is_named() {
    let sharp = |g: &str| format!("henyey-greenstein.g = {g}");
    for (depth, albedo, phase, words) in [
        ("1", "0", sharp("0.5"), ["a reflectance above 1e-70", "it is 0 at a = 0"]),
        ("1e3", "0.9", sharp("0"), ["a transmittance above 1e-70", "it is 3.75e-229 at a = 0.9"]),
        ("1e6", "1", sharp("0"), ["a transmittance that", "rounding adds up in so thick a slab"]),
        ("20", "0.9", sharp("0.99"), ["a reflectance that", "the forward peak of phase"]),
        ("1", "0.9", sharp("-0.99"), ["a phase function that", "g=-0.99"]),
    ] {
        for row in crate::common::predicted(&constant(depth, albedo, &phase)) {
            for word in words {
                assert!(row.reason().contains(word), "τ = {depth}, a = {albedo}: {}", row.reason());
            }
        }
    }
}

/// Theory predicts the mean of the lookups of draws where r varies.
#[test]
fn lookups_of_draws_through_a_varying_ratio_are_predicted() {
    let rows = crate::common::rows(
        "title = \"an exponential slab\"\nunderpowered = \"allow\"\n[problem.slab]\n\
         medium.exponential = { extinction = 3, rate = 1 }\nspan = [0, 1]\nalbedo = 0.8\n\
         phase.henyey-greenstein.g = 0.5\nincidence.collimated.cosine = 0.5\n\
         sampling.constant.value = 3.2\n\
         estimators = [{ analog = {} }, { weighted = {} }, { non-terminating = {} }, \
         { terminating.sampling.constant.value = 2.9 }]",
        200_000,
    );
    assert_eq!(rows.len(), 8);
    for row in &rows {
        let of = &row.experiment;
        let known = |value: Option<f64>| value.expect("known");
        let (mean, error) = (known(of.predicted_lookups), known(of.lookups_error));
        let off = (known(of.lookups_per_draw) - mean).abs();
        let allowed = error * mean + 5.0 * known(of.lookups_deviation);
        assert!(off <= allowed && error < 5e-3, "{}: {off:e}, {error:e}", of.label);
    }
}
