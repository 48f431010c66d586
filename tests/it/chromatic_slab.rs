//! Slabs in which every channel has a medium of its own: against slabs of one channel and of coloured scatterers, drawn,
//! and what is refused.

use trueflight::harness::record::{Row, Verdict};

use crate::common::{mistakes, none, predicted, rows};

const THREE_COLOURS: &str = include_str!("../../cases/chromatic-slab/three-colours.toml");

fn of<'a>(rows: &'a [Row], estimator: &str) -> Vec<&'a Row> {
    rows.iter().filter(|row| row.estimator == estimator).collect()
}

fn near(found: Option<f64>, expected: Option<f64>, relative: f64) {
    let (found, expected) = (found.expect("known"), expected.expect("known"));
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} for {expected}");
}

#[test]
fn every_channel_is_the_slab_of_its_own_medium() {
    let rows = predicted(THREE_COLOURS);
    let of_channels = of(&rows, "independent");
    let alone = [
        ("exponential = { extinction = 2, rate = 1 }", 0.95, "henyey-greenstein.g = 0.6", 2.0),
        ("constant.extinction = 0.8", 0.6, "isotropic = {}", 0.8),
        ("piecewise-linear = { knots = [0, 1], values = [0.2, 1.8] }", 0.8, "rayleigh = {}", 2.0),
    ];
    for (channel, (medium, albedo, phase, majorant)) in alone.into_iter().enumerate() {
        let slab = predicted(&format!(
            "title = \"t\"\n[problem.slab]\nmedium.{medium}\nspan = [0, 1]\nalbedo = {albedo}\nphase.{phase}
            incidence.collimated.cosine = 0.6\nsampling.constant.value = {majorant:?}\nestimators = [{{ analog = {{}} }}]"
        ));
        for (side, row) in slab.iter().enumerate() {
            let own = of_channels[3 * side + channel];
            near(own.truth, row.truth, 1e-12);
            // X = 3 with a third of the probability.
            let truth = row.truth.expect("known");
            near(own.predicted_variance, Some(3.0 * truth - truth * truth), 1e-12);
        }
    }
}

/// Where channels differ in their albedo alone, theory knows the variance from orders of scattering.
#[test]
fn channels_that_differ_in_albedo_alone_are_a_slab_of_coloured_scatterers() {
    let rest = "span = [0, 1]\nalbedos = [1, 0.7, 0.4]\nincidence.diffuse = {}\nsampling.constant.value = 1.5
        estimators = [{ spectral-mis = {} }]";
    let medium = "{ constant.extinction = 1.2 }";
    let chromatic = format!(
        "title = \"t\"\ndraws = 800_000\n[problem.chromatic-slab]\nmedium = [{medium}, {medium}, {medium}]
        phases = [{{ isotropic = {{}} }}, {{ isotropic = {{}} }}, {{ isotropic = {{}} }}]\n{rest}"
    );
    let coloured = predicted(&format!(
        "title = \"t\"\n[problem.spectral-slab]\nmedium.constant.extinction = 1.2\nphase.isotropic = {{}}\n{rest}"
    ));
    let drawn = rows(&chromatic, 800_000);
    assert_eq!(drawn.len(), 6);
    for (drawn, known) in drawn.iter().zip(&coloured) {
        assert_eq!((drawn.verdict, &drawn.channel), (Some(Verdict::Pass), &known.channel));
        near(drawn.truth, known.truth, 1e-12);
        near(drawn.predicted_lookups, known.predicted_lookups, 1e-6);
        near(drawn.variance, known.predicted_variance, 0.03);
    }
}

fn draws_agree(draws: u64) {
    let diffuse = THREE_COLOURS
        .replace("incidence.collimated = { cosine = 0.6 }", "incidence.diffuse = {}")
        .replace("{ hero = \"luminance\" }", "{ hero = [0.2, 0.2, 0.6] }");
    for text in [THREE_COLOURS, &diffuse] {
        let rows = rows(text, draws);
        assert_eq!(rows.len(), 4 * 6);
        let wrong = rows.iter().filter(|row| row.verdict != Some(Verdict::Pass));
        none(&wrong.map(|row| format!("{} {}", row.estimator, row.reason)).collect::<Vec<_>>());
        let (alone, together) = (of(&rows, "independent"), of(&rows, "spectral-mis"));
        for (alone, together) in alone.iter().zip(together) {
            // Colour noise is what multiple importance sampling takes away.
            assert!(together.variance.expect("drawn") < alone.variance.expect("drawn"));
        }
    }
}

#[test]
fn draws_agree_with_adding_and_doubling() {
    draws_agree(600_000);
}

#[test]
#[ignore = "long: 4e6 draws of 8 experiments"]
fn many_draws_agree_with_adding_and_doubling() {
    draws_agree(4_000_000);
}

#[test]
fn mistakes_and_what_is_out_of_reach_are_told() {
    let said = |from: &str, to: &str| {
        mistakes(&THREE_COLOURS.replacen(from, to, 1)).expect("a mistake").render(false)
    };
    let expected = [
        (
            "albedos = [0.95, 0.6, 0.8]",
            "albedos = [0.95, 0.6]",
            "`albedos` lists 2 channels, and the",
        ),
        ("{ isotropic = {} }, ", "", "`phases` lists 2 channels, and the medium has 3"),
        ("cosine = 0.6", "cosine = 1.6", "`cosine` is 1.6"),
        ("hero = [0.5, 0.3, 0.2]", "hero = [0.5, 0.3, 0.3]", "the probabilities sum to 1.1"),
    ];
    for (from, to, words) in expected {
        let said = said(from, to);
        assert!(said.contains(words), "{words}:\n{said}");
    }
    let said = said("constant.extinction = 0.8", "constant.extinction = -1");
    assert!(!said.contains("not known here"), "{said}");
    let refused = [
        (
            "constant.value = 0.8",
            "constant.value = 0.7",
            "σ̂ = 0.700000 and σ_t = 0.800000 in channel 2",
        ),
        ("g = 0.6", "g = 0.97", "phase henyey-greenstein, g=0.97 in channel 1"),
        ("hero = [0.5, 0.3, 0.2]", "hero = [0.5, 0.5]", "there are 2 for 3 channels"),
    ];
    for (from, to, words) in refused {
        let rows = predicted(&THREE_COLOURS.replacen(from, to, 1));
        let reasons: Vec<&str> = rows.iter().map(|row| row.reason.as_str()).collect();
        assert!(reasons.iter().any(|reason| reason.contains(words)), "{words}: {reasons:?}");
    }
}
