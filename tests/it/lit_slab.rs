//! Slab with a light behind it against reference values that were computed by other means, and draws of every
//! estimator.

use serde::Deserialize;

use crate::common::lit::{self, ESTIMATORS, techniques};
use crate::common::{failing, medium, none, rows};
use trueflight::media::Piecewise;
use trueflight::numeric::quadrature::GaussLegendre;
use trueflight::phase::Phase;
use trueflight::phase::henyey_greenstein::HenyeyGreenstein;
use trueflight::problems::LitSlab;
use trueflight::problems::lit_slab::LightBehind;
use trueflight::theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};
use trueflight::theory::slab;
use trueflight::theory::{Mesh, Prediction};

#[derive(Deserialize)]
struct Reference {
    case: String,
    what: String,
    sigma: f64,
    a: f64,
    g: f64,
    thickness: f64,
    /// Thickness and σ_t of a second layer.
    below: Option<[f64; 2]>,
    majorant: f64,
    light: Shape,
    value: f64,
    kurtosis: Option<f64>,
    error: f64,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Shape {
    Cap(String, f64),
    Disc(String, f64, f64),
}

impl Reference {
    fn light(&self) -> LightBehind {
        match &self.light {
            Shape::Cap(_, cosine) => LightBehind::Cap(*cosine),
            Shape::Disc(_, distance, radius) => {
                LightBehind::Disc { distance: *distance, radius: *radius }
            }
        }
    }

    /// Returns the light as in a case file.
    fn light_in_words(&self) -> String {
        match &self.light {
            Shape::Cap(name, cosine) => format!("{name}.cosine = {cosine}"),
            Shape::Disc(name, distance, radius) => {
                format!("{name} = {{ distance = {distance}, radius = {radius} }}")
            }
        }
    }

    fn medium(&self) -> String {
        let Self { sigma, thickness, .. } = self;
        let Some([more, below]) = self.below else {
            return format!("medium.constant.extinction = {sigma}\nspan = [0, {thickness}]");
        };
        let end = thickness + more;
        format!(
            "medium.piecewise-constant = {{ breaks = [0, {thickness}, {end}], values = [{sigma}, {below}] }}
            span = [0, {end}]"
        )
    }

    fn predict(&self) -> Prediction {
        let text = self.medium();
        predict(&text, (self.a, self.g), self.light(), self.majorant, techniques(&self.what))
    }
}

fn references() -> Vec<Reference> {
    serde_json::from_str(include_str!("../data/lit-slab.json")).expect("the reference values")
}

fn predict(
    text: &str,
    (albedo, g): (f64, f64),
    light: LightBehind,
    majorant: f64,
    techniques: Techniques,
) -> Prediction {
    let medium = medium(text);
    let sampling = Piecewise::constant(majorant, medium.span());
    let phase = Phase::HenyeyGreenstein(HenyeyGreenstein::new(g).expect("|g| < 1"));
    let problem = LitSlab::new(medium.clone(), albedo, phase, light);
    slab::lit::predict(&Mesh::new(medium), &problem, &sampling, techniques, true)
}

#[test]
fn means_and_variances_are_those_of_the_references() {
    let all = references();
    assert_eq!(all.len(), 43);
    let mut wrong = Vec::new();
    for reference in &all {
        let asked = (reference.what.as_str(), reference.value, reference.error);
        let prediction = reference.predict();
        let found = lit::differs(asked, &prediction, 1e-10);
        wrong.extend(found.map(|found| format!("{}, {found}", reference.case)));
        let Some(expected) = reference.kurtosis else { continue };
        let moments = prediction.channels[0].moments.expect("known");
        let kurtosis = moments.kurtosis().expect("a variance");
        if (kurtosis / expected - 1.0).abs() > 1e-9 {
            let what = format!("{}, {}", reference.case, reference.what);
            wrong.push(format!("{what}: a kurtosis of {kurtosis} for {expected}"));
        }
    }
    none(&wrong);
}

/// Returns the mean of f over a Poisson number of null collisions that each keep 1 − r.
fn poisson(mean: f64, left: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (mut sum, mut chance, mut x) = (0.0, (-mean).exp(), 1.0);
    for n in 1..150 {
        sum += chance * f(x);
        chance *= mean / f64::from(n);
        x *= left;
    }
    sum
}

#[test]
fn fourth_moments_are_those_of_sums_over_null_collisions() {
    // Homogeneous: E[X⁴] by a plain rule over depths and directions, and Poisson sums.
    let (sigma, majorant, albedo, g, length, lowest) = (1.0, 1.6, 0.9, 0.8, 1.5, 0.8);
    let phase = HenyeyGreenstein::new(g).expect("in range");
    let rule = GaussLegendre::new(60);
    for heuristic in [Heuristic::Balance, Heuristic::Power] {
        let combination = Combination::Mis(Densities::Full, heuristic);
        let techniques = Techniques { shadow: Some(Shadow::Ratio), combination };
        let moment = |k: i32| {
            rule.integrate(0.0, length, |z| {
                // Means of the j-th powers of both scores over directions.
                let means = |j: i32, is_hit: bool| {
                    if j == 0 {
                        return 1.0;
                    }
                    rule.integrate(lowest, 1.0, |cosine| {
                        let solid = std::f64::consts::TAU * (1.0 - lowest);
                        let q = trueflight::phase::PhaseFunction::value(&phase, cosine) * solid;
                        let along = majorant * (length - z) / cosine;
                        let share = if is_hit { q } else { 1.0 } / (1.0 - lowest);
                        share
                            * poisson(along, 1.0 - sigma / majorant, |x| {
                                let raised = heuristic.raised(q * x);
                                if is_hit {
                                    x * (raised / (1.0 + raised)).powi(j)
                                } else {
                                    (q * x / (1.0 + raised)).powi(j)
                                }
                            })
                    })
                };
                let mut ways = 1.0;
                let mut sum = 0.0;
                for j in 0..=k {
                    sum += ways * means(j, false) * means(k - j, true);
                    ways *= f64::from(k - j) / f64::from(j + 1);
                }
                albedo * sigma * (-sigma * z).exp() * sum
            })
        };
        let [one, two, three, four] = [1, 2, 3, 4].map(moment);
        let text = format!("medium.constant.extinction = {sigma}\nspan = [0, {length}]");
        let found = predict(&text, (albedo, g), LightBehind::Cap(lowest), majorant, techniques);
        let channel = &found.channels[0];
        let moments = channel.moments.expect("known");
        let variance = two - one * one;
        let central = four - 4.0 * one * three + 6.0 * one * one * two - 3.0 * one.powi(4);
        assert!((channel.truth.value - one).abs() < 1e-13, "{one}");
        assert!((moments.variance() - variance).abs() < 1e-13, "{variance}");
        let kurtosis = moments.kurtosis().expect("spread");
        assert!((kurtosis / (central / variance.powi(2)) - 1.0).abs() < 1e-10, "{kurtosis}");
    }
}

/// Shadow rays change no walk: without the lookups of shadow rays those of exact ones are left, which look up nothing.
#[test]
fn lookups_of_shadow_rays_add_to_those_of_the_walk() {
    let text = "medium.exponential = { base = 0.2, extinction = 1.2, rate = 0.5 }\nspan = [0, 3]";
    let predicted = |shadow, combination| {
        let techniques = Techniques { shadow, combination };
        let found = predict(text, (0.7, 0.4), LightBehind::Cap(0.6), 1.9, techniques);
        (found.lookups.expect("known").mean, found.shadow_lookups)
    };
    assert_eq!(predicted(None, Combination::Unidirectional).1, None);
    for combination in
        [Combination::NextEvent, Combination::Mis(Densities::Directional, Heuristic::Balance)]
    {
        let (walk, nothing) = predicted(Some(Shadow::Exact), combination);
        assert_eq!(nothing, Some(0.0));
        for shadow in [Shadow::Ratio, Shadow::Delta] {
            let (all, of_shadow_rays) = predicted(Some(shadow), combination);
            let of_shadow_rays = of_shadow_rays.expect("known");
            assert!(of_shadow_rays > 0.1, "{shadow:?}: {of_shadow_rays}");
            assert!((walk + of_shadow_rays - all).abs() < 1e-12 * all, "{shadow:?}: {walk}, {all}");
        }
    }
}

#[test]
fn all_combinations_have_one_mean() {
    // Extinction varies, and σ̂ equals its maximum: the means of shadow rays and of hits, weighted, are the truth.
    let text = "medium.exponential = { base = 0.2, extinction = 1.2, rate = 0.5 }\nspan = [0, 3]";
    let disc = LightBehind::Disc { distance: 0.3, radius: 0.5 };
    let field = medium(text);
    for light in [LightBehind::Cap(0.6), disc] {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            for (shadow, densities) in [
                (Shadow::Delta, Densities::Directional),
                (Shadow::Ratio, Densities::Full),
                (Shadow::Exact, Densities::Full),
            ] {
                let combination = Combination::Mis(densities, heuristic);
                let techniques = Techniques { shadow: Some(shadow), combination };
                let phase = HenyeyGreenstein::new(0.9).expect("in range");
                let problem =
                    LitSlab::new(field.clone(), 0.7, Phase::HenyeyGreenstein(phase), light);
                let (mesh, sampling) =
                    (Mesh::new(field.clone()), Piecewise::constant(1.4, field.span()));
                let truth = slab::lit::truth(&mesh, &problem, &sampling);
                let mean = slab::lit::mean(&mesh, &problem, &sampling, techniques);
                let off = (mean.value - truth.value).abs();
                assert!(off < 1e-12, "{techniques:?}, {light:?}: {off:e}");
                assert!(off <= mean.error + truth.error && mean.error < 1e-9, "{:e}", mean.error);
            }
        }
    }
}

#[test]
fn draws_agree_with_the_predictions() {
    draws_agree(500_000);
}

#[test]
#[ignore = "long: 4e6 draws of 24 experiments"]
fn many_draws_agree_with_the_predictions() {
    draws_agree(4_000_000);
}

/// Compares mean, variance and lookups of every estimator of every reference. A narrow cap is hit rarely, and has wide
/// tolerances.
fn draws_agree(draws: u64) {
    let all = references();
    let means: Vec<&Reference> = all.iter().filter(|reference| reference.what == "mean").collect();
    assert_eq!(means.len(), 5);
    for reference in means {
        let text = format!(
            "title = \"t\"\n[problem.slab]\n{}\nalbedo = {}\nphase.henyey-greenstein = {{ g = {} }}
            light.{}\nsampling.constant.value = {}
            estimators = [{ESTIMATORS}]
            [tolerance]\nmean = {}\nvariance = {}",
            reference.medium(),
            reference.a,
            reference.g,
            reference.light_in_words(),
            reference.majorant,
            if reference.case == "CAP-NARROW" { 0.5 } else { 0.05 },
            if reference.case == "CAP-NARROW" { 0.5 } else { 0.2 },
        );
        let rows = rows(&text, draws);
        assert_eq!(rows.len(), 8);
        none(&failing(&rows));
    }
}

#[test]
fn varying_media_and_majorants_in_steps_are_predicted_as_drawn() {
    for (light, more) in [
        ("disc = { distance = 0.1, radius = 0.5 }", ", { unidirectional = {} }"),
        ("cap.cosine = 0.2", ", { unidirectional = {} }"),
        ("distant.cosine = 0.5", ""),
        ("point.distance = 0.5", ""),
    ] {
        let text = format!(
            "title = \"t\"\n[problem.slab]
            medium.piecewise-constant = {{ breaks = [0, 1, 1.5, 2.5, 3], values = [0.4, 0, 1.5, 0.7] }}
            span = [0, 3]\nalbedo = 0.8\nphase.henyey-greenstein = {{ g = 0.5 }}\nlight.{light}
            sampling.piecewise-constant = {{ breaks = [0, 1, 1.6, 3], values = [0.6, 3, 2] }}
            estimators = [{{ full-mis.heuristic = \"power\" }},
                {{ full-mis = {{ shadow = \"exact\", heuristic = \"power\" }} }},
                {{ directional-mis = {{ shadow = \"exact\", heuristic = \"power\" }} }},
                {{ directional-mis = {{ shadow = \"ratio\" }} }}, {{ next-event.shadow = \"delta\" }},
                {{ next-event = {{}} }}, {{ full-mis = {{}} }}{more}]
            [tolerance]\nmean = 0.05\nvariance = 0.3"
        );
        none(&failing(&rows(&text, 1_200_000)));
    }
}

#[test]
fn extreme_slabs_are_predicted_or_refused() {
    // Every depth with every phase function, in one of the three lights.
    let predictions = extremes(|place| place % 3 == 0);
    assert!(predictions > 66, "only {predictions}");
}

#[test]
#[ignore = "long: 270 experiments, 12 s of a core"]
fn all_extreme_slabs_are_predicted_or_refused() {
    let predictions = extremes(|_| true);
    assert!(predictions > 200, "only {predictions}");
}

/// Returns the number of predicted experiments in extreme slabs, for places of the table with a wanted sum of indices.
fn extremes(is_wanted: fn(usize) -> bool) -> usize {
    let mut cases = Vec::new();
    let lights =
        ["cap.cosine = 0.05", "cap.cosine = 0.999999", "disc = { distance = 0.01, radius = 1 }"];
    for (row, depth) in [1e-6, 0.3, 30.0].into_iter().enumerate() {
        for (column, g) in [-0.9, 0.0, 0.99].into_iter().enumerate() {
            for (layer, light) in lights.into_iter().enumerate() {
                for factor in [1.0, 20.0].into_iter().filter(|_| is_wanted(row + column + layer)) {
                    let text = format!(
                        "title = \"t\"\n[problem.slab]\nmedium.constant.extinction = {depth:e}\nspan = [0, 1]
                        albedo = 0.9\nphase.henyey-greenstein = {{ g = {g} }}\nlight.{light}
                        sampling.constant.value = {:e}
                        estimators = [{{ unidirectional = {{}} }}, {{ next-event.shadow = \"delta\" }},
                            {{ next-event = {{}} }}, {{ directional-mis = {{}} }}, {{ full-mis = {{}} }}]",
                        depth * factor
                    );
                    cases.push((format!("τ = {depth}, g = {g}, {light}, {factor}"), text));
                }
            }
        }
    }
    // A hit scores 1 or 0.
    lit::predictions(&cases, |row, truth, variance| {
        let is_bit = (variance - truth * (1.0 - truth)).abs() < 1e-12;
        let is_walked = row.experiment.predicted_lookups > Some(0.0);
        is_walked && (row.experiment.label != "unidirectional" || is_bit)
    })
}
