//! Slabs in which every channel has a medium of its own: against slabs of one channel and of coloured scatterers,
//! against draws, and refusals.

use serde::Deserialize;

use trueflight::media::Piecewise;
use trueflight::phase::Phase;
use trueflight::phase::isotropic::Isotropic;
use trueflight::problems::ChromaticSlab;
use trueflight::problems::slab::{Incidence, IncidentLight};
use trueflight::record::Verdict;
use trueflight::theory::Mesh;
use trueflight::theory::colours::Chance;
use trueflight::theory::colours::rates::Proposal;
use trueflight::theory::slab::chromatic::SlabSpectrum;

use crate::common::{case, channels, medium, none, not_passing, predicted, rows};
use crate::packets::compare;

const THREE_COLOURS: &str = include_str!("../../cases/slab/chromatic-three-colours.toml");

const LIKE: &str = include_str!("../../cases/slab/chromatic-like-colours.toml");

fn near(found: Option<f64>, expected: Option<f64>, relative: f64) {
    let (found, expected) = (found.expect("known"), expected.expect("known"));
    assert!((found - expected).abs() <= relative * expected.abs(), "{found} for {expected}");
}

#[test]
fn every_channel_is_the_slab_of_its_own_medium() {
    let rows = predicted(THREE_COLOURS);
    let of_channels = channels(&rows, "independent");
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

/// If channels differ in their albedo only, theory knows the variance from orders of scattering.
#[test]
fn channels_that_differ_in_albedo_alone_are_a_slab_of_coloured_scatterers() {
    let rest = "span = [0, 1]\nalbedos = [1, 0.7, 0.4]\nincidence.diffuse = {}\nsampling.constant.value = 1.5
        estimators = [{ spectral-mis = {} }]";
    let medium = "{ constant.extinction = 1.2 }";
    let chromatic = format!(
        "title = \"t\"\ndraws = 800_000\n[problem.slab]\nmedium = [{medium}, {medium}, {medium}]
        phases = [{{ isotropic = {{}} }}, {{ isotropic = {{}} }}, {{ isotropic = {{}} }}]\n{rest}"
    );
    let coloured = predicted(&format!(
        "title = \"t\"\n[problem.slab]\nmedium.constant.extinction = 1.2\nphase.isotropic = {{}}\n{rest}"
    ));
    let drawn = rows(&chromatic, 800_000);
    assert_eq!(drawn.len(), 6);
    for (drawn, known) in drawn.iter().zip(&coloured) {
        assert_eq!((drawn.verdict, &drawn.channel), (Some(Verdict::Pass), &known.channel));
        near(drawn.truth, known.truth, 1e-12);
        near(drawn.experiment.predicted_lookups, known.experiment.predicted_lookups, 1e-6);
        near(drawn.variance, known.predicted_variance, 0.03);
    }
}

/// If channels differ in their albedo only, theory knows the variance of a hero and of spectral tracking in a slab of
/// coloured scatterers: the bound is above it, and the draws have it.
#[test]
fn bounds_of_walks_relative_to_one_walker_are_above_their_variances() {
    let rest = "span = [0, 0.8]\nalbedos = [0.8, 0.7, 0.6]\nincidence.diffuse = {}\nsampling.constant.value = 1.5
        estimators = [{ hero = {} }, { spectral-tracking = {} },
            { spectral-tracking = { probabilities = \"maximum\" } }]";
    let medium = "{ constant.extinction = 1.2 }";
    let chromatic = format!(
        "title = \"t\"\ndraws = 800_000\n[problem.slab]\nmedium = [{medium}, {medium}, {medium}]
        phases = [{{ isotropic = {{}} }}, {{ isotropic = {{}} }}, {{ isotropic = {{}} }}]\n{rest}"
    );
    let coloured = predicted(&format!(
        "title = \"t\"\n[problem.slab]\nmedium.constant.extinction = 1.2\nphase.isotropic = {{}}\n{rest}"
    ));
    let drawn = rows(&chromatic, 800_000);
    assert_eq!(drawn.len(), 3 * 6);
    for (drawn, known) in drawn.iter().zip(&coloured) {
        assert_eq!(
            drawn.verdict,
            Some(Verdict::Pass),
            "{}: {}",
            drawn.experiment.label,
            drawn.reason()
        );
        near(drawn.truth, known.truth, 1e-12);
        // Null collisions are distinguished from real ones here, so that the maximum has another distribution.
        if !drawn.experiment.label.contains("maximum") {
            near(drawn.variance, known.predicted_variance, 0.03);
        }
    }
}

/// Homogeneous isotropic channels on `[0, length]`: second moments of draws relative to one walker, and their bound.
#[derive(Deserialize)]
struct Bounded {
    walker: String,
    by: String,
    sigma: Vec<f64>,
    albedo: Vec<f64>,
    majorant: Vec<f64>,
    length: f64,
    cosine: Option<f64>,
    bound: Vec<f64>,
    reflected: Vec<f64>,
    transmitted: Vec<f64>,
}

impl Bounded {
    fn walk(&self) -> Proposal {
        match (self.walker.as_str(), self.by.as_str()) {
            ("hero", channel) => Proposal::Hero(channel.parse().expect("a channel")),
            ("tracking", "average") => Proposal::Together(Chance::Average),
            ("tracking", "maximum") => Proposal::Together(Chance::Maximum),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn bounds_are_those_of_the_references_and_above_the_second_moments() {
    let references: Vec<Bounded> =
        serde_json::from_str(include_str!("../data/chromatic-slab.json")).expect("the references");
    assert_eq!(references.len(), 10);
    let mut closest = 0.0f64;
    for reference in references {
        let constant = |sigma| {
            format!("medium.constant.extinction = {sigma}\nspan = [0, {}]", reference.length)
        };
        let media: Vec<_> = reference.sigma.iter().map(|sigma| medium(&constant(sigma))).collect();
        let light = reference.cosine.map_or(IncidentLight::Diffuse, IncidentLight::Collimated);
        let incidence = Incidence { light, phase: Phase::Isotropic(Isotropic) };
        let majorants = reference.majorant.iter();
        let flown: Vec<_> = majorants.map(|&m| Piecewise::constant(m, media[0].span())).collect();
        let problem = ChromaticSlab::new(
            media.clone(),
            reference.albedo.clone(),
            vec![incidence; media.len()],
        );
        let meshes: Vec<Mesh> = media.into_iter().map(Mesh::new).collect();
        let spectrum = SlabSpectrum::new(&problem, meshes.iter().zip(&flown).collect(), false);
        for (channel, &bound) in reference.bound.iter().enumerate() {
            let found = spectrum.second_moment_bound(reference.walk(), channel, 1.0);
            let found = found.expect("a bound");
            let context = format!("{} {}, channel {channel}", reference.walker, reference.by);
            assert!((found / bound - 1.0).abs() < 1e-8, "{context}: {found} for {bound}");
            // A walk leaves once.
            let exact = reference.reflected[channel] + reference.transmitted[channel];
            assert!(exact <= found, "{context}: {exact} above {found}");
            closest = closest.max(exact / found);
        }
    }
    assert!(closest > 0.99, "{closest}");
}

/// The rest of an atmosphere of e^{−40} scatters a negligible share: its rounding is no reason to refuse.
#[test]
fn thin_ends_of_steep_atmospheres_have_a_bound() {
    let text = "title = \"steep\"
        [problem.slab]
        medium = [{ exponential = { extinction = 1, rate = 40 } }]
        span = [0, 1]
        albedos = [0.5]
        phases = [{ isotropic = {} }]
        incidence.collimated = { cosine = 0.8 }
        sampling.constant.value = 1.6
        estimators = [{ hero = {} }, { spectral-tracking = {} }]";
    for row in predicted(text) {
        assert_ne!(
            row.verdict,
            Some(Verdict::Refused),
            "{}: {}",
            row.experiment.label,
            row.reason()
        );
    }
}

/// Packets and single walks make the same draws, for every walker.
#[test]
fn walks_side_by_side_are_walks_one_by_one() {
    let diffuse = LIKE.replace("incidence.collimated = { cosine = 0.8 }", "incidence.diffuse = {}");
    let forward = LIKE.replace("isotropic = {}", "henyey-greenstein = { g = 0.4 }");
    let cases = [("like", LIKE), ("diffuse", &diffuse), ("forward", &forward)];
    compare(&cases.map(|(name, text)| case(name, text)), 20);
}

fn draws_agree(draws: u64) {
    let diffuse = THREE_COLOURS
        .replace("incidence.collimated = { cosine = 0.6 }", "incidence.diffuse = {}")
        .replace("{ hero = \"luminance\" }", "{ hero = [0.2, 0.2, 0.6] }");
    for text in [THREE_COLOURS, &diffuse] {
        let rows = rows(text, draws);
        assert_eq!(rows.len(), 4 * 6);
        none(&not_passing(&rows, &[]));
        let (alone, together) = (channels(&rows, "independent"), channels(&rows, "spectral-mis"));
        for (alone, together) in alone.iter().zip(together) {
            // Multiple importance sampling removes colour noise.
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
