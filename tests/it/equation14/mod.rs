//! Predictions against the differential equations they solve, integrated without the crate.
//!
//! A walk gains the random factor `W(s, ds)` in every step: 1 without a collision, else the rule's.
//! With `E[W^k] = (1 − r)^k q^{1−k}` at a collision, all raw moments of `X` obey
//!
//! ```text
//! dm_k/ds = −[σ̂ (1 − E[W^k]) + k σ_c] m_k
//! dV/ds = V (w − 2σ_t) + w T²                  (Eq. 14, w of Eqs. 17–20)
//! ```
//!
//! They are solved here by Dormand and Prince's pair of orders 5 and 4, restarted at every break, on
//! fields and rules that are written down a second time. Next-flight and unidirectional MIS are
//! solved from their Volterra equations, by the trapezoid and Richardson's extrapolation.
//!
//! Equation numbers: Szirmay-Kalos et al., *Unbiased Light Transport Estimators for Inhomogeneous
//! Participating Media*, Computer Graphics Forum 36 (2017).

mod field;
mod ode;
mod rule;
mod volterra;

use crate::common::differs;
use field::{
    Field, Shape, atmosphere, blob, constant, explorers, hills, homogeneous, layers, lines,
    no_control, smooth, steps, twin, waves,
};
use ode::{Solution, solve};
use rule::Rule;
use trueflight::case::Case;
use trueflight::theory::Prediction;
use volterra::volterra;

/// Largest relative difference of a prediction from the solution of its equation.
const TOLERANCE: f64 = 1e-8;
/// Largest kurtosis for which moments are compared.
const WILDEST: f64 = 1e6;

/// Configuration that all estimators of one case share.
struct Scene {
    medium: Field,
    sampling: Field,
    control: Field,
    length: f64,
}

impl Scene {
    fn at(&self, t: f64, inside: f64) -> (f64, f64, f64) {
        let [medium, sampling, control] = [&self.medium, &self.sampling, &self.control];
        ((medium.value)(t, inside), (sampling.value)(t, inside), (control.value)(t, inside))
    }

    fn pieces(&self) -> Vec<[f64; 2]> {
        let fields = [&self.medium, &self.sampling, &self.control];
        let mut ends: Vec<f64> = fields.iter().flat_map(|f| f.breaks.clone()).collect();
        ends.extend([0.0, self.length]);
        ends.retain(|&t| (0.0..=self.length).contains(&t));
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }

    /// Returns the smallest and the largest residual and r.
    fn ranges(&self, controlled: bool) -> [[f64; 2]; 2] {
        let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for [from, to] in self.pieces() {
            for i in 0..=2000 {
                let t = from + (to - from) * f64::from(i) / 2000.0;
                let (medium, sampling, control) = self.at(t, 0.5 * (from + to));
                let residual = if controlled { medium - control } else { medium };
                for (range, x) in ranges.iter_mut().zip([residual, residual / sampling]) {
                    *range = [range[0].min(x), range[1].max(x)];
                }
            }
        }
        ranges
    }

    fn case(&self) -> Case {
        let entries: Vec<String> =
            estimators().iter().map(|estimator| format!("{{ {} }}", estimator.text)).collect();
        let medium = self.medium.text.replace("constant.value", "constant.extinction");
        crate::common::case(
            "equation14",
            &format!(
                "title = \"t\"\n[problem.transmittance]\nmedium.{medium}\nspan = [0, {}]\n\
                 sampling.{}\ncontrol.{}\nestimators = [{}]",
                self.length,
                self.sampling.text,
                self.control.text,
                entries.join(", ")
            ),
        )
    }
}

/// Equation that an estimator solves.
#[derive(Clone, Copy, PartialEq)]
enum Law {
    /// Collisions of the residual, the control integrated.
    Product {
        rule: Rule,
        controlled: bool,
    },
    /// Collisions of the residual, the control sampled.
    Decomposition,
    NextFlight,
    UnidirectionalMis,
}

struct Estimator {
    text: &'static str,
    law: Law,
    /// Returns whether the estimator exists in a scene with the given ranges of residual and r.
    exists: fn(&Scene, [[f64; 2]; 2]) -> bool,
}

fn estimators() -> Vec<Estimator> {
    let product = |rule, controlled| Law::Product { rule, controlled };
    let always = |_: &Scene, _: [[f64; 2]; 2]| true;
    let constant_control =
        |scene: &Scene, _: [[f64; 2]; 2]| matches!(scene.control.shape, Shape::Constant(_));
    let constant_sampling =
        |scene: &Scene, _: [[f64; 2]; 2]| matches!(scene.sampling.shape, Shape::Constant(_));
    vec![
        Estimator { text: "double = {}", law: product(Rule::Double, true), exists: always },
        Estimator { text: "ratio = {}", law: product(Rule::Double, false), exists: always },
        Estimator {
            text: "residual-ratio = {}",
            law: product(Rule::Double, true),
            exists: constant_control,
        },
        Estimator {
            text: "single.rule = \"terminating\"",
            law: product(Rule::Terminating, true),
            exists: |_, [_, r]| r[0] >= 0.0 && r[1] <= 2.0,
        },
        Estimator {
            text: "single.rule = \"clamped\"",
            law: product(Rule::Clamped, true),
            exists: always,
        },
        Estimator {
            text: "single = { rule = \"non-terminating\", albedo = 0.7 }",
            law: product(Rule::NonTerminating(0.7), true),
            exists: always,
        },
        Estimator {
            text: "single = { rule = \"non-terminating\", albedo = 0 }",
            law: product(Rule::NonTerminating(0.0), true),
            exists: always,
        },
        Estimator {
            text: "single = { rule = \"adaptive\", albedo = 0.2 }",
            law: product(Rule::Adaptive(0.2), true),
            exists: always,
        },
        Estimator {
            text: "weighted-delta = {}",
            law: product(Rule::NonTerminating(1.0), false),
            exists: always,
        },
        Estimator {
            text: "woodcock = {}",
            law: product(Rule::Null, false),
            exists: |_, [_, r]| r[1] <= 1.0,
        },
        Estimator {
            text: "local-majorant = {}",
            law: product(Rule::Null, false),
            exists: |scene, [_, r]| r[1] <= 1.0 && scene.sampling.shape != Shape::Other,
        },
        Estimator {
            text: "decomposition = {}",
            law: Law::Decomposition,
            exists: |scene, [residual, r]| {
                let control = scene.control.shape;
                matches!(control, Shape::Constant(c) if c >= 0.0)
                    && residual[0] >= 0.0
                    && r[1] <= 1.0
            },
        },
        Estimator { text: "next-flight = {}", law: Law::NextFlight, exists: constant_sampling },
        Estimator {
            text: "unidirectional-mis = {}",
            law: Law::UnidirectionalMis,
            exists: constant_sampling,
        },
    ]
}

fn compare(what: &str, found: &Prediction, expected: &Solution) -> Vec<String> {
    let channel = &found.channels[0];
    let moments = channel.moments.expect("moments");
    let lookups = found.lookups.as_ref().expect("lookups").mean;
    let [c2, c3, c4] = expected.relative;
    let mut pairs =
        vec![("mean", channel.mean.value, expected.mean), ("lookups", lookups, expected.lookups)];
    if c4 < WILDEST * c2 * c2 {
        pairs.extend([
            ("variance", moments.variance(), expected.variance),
            ("second moment", moments.relative[0], c2),
            ("third moment", moments.relative[1], c3),
            ("fourth moment", moments.relative[2], c4),
        ]);
    }
    let differences = pairs.into_iter().filter_map(|(name, found, expected)| {
        differs(&format!("{what}: {name}"), found, expected, TOLERANCE)
    });
    differences.collect()
}

/// Compares every estimator in a scene; returns the differences and the number of compared estimators.
fn check(scene: &Scene) -> (Vec<String>, usize) {
    let case = scene.case();
    let mut differences = Vec::new();
    let mut compared = 0;
    for (index, estimator) in estimators().iter().enumerate() {
        let [medium, sampling, control] = [&scene.medium, &scene.sampling, &scene.control];
        let what =
            format!("{} in {}, {}, {}", estimator.text, medium.text, sampling.text, control.text);
        let law = estimator.law;
        let controlled = !matches!(
            law,
            Law::Product { controlled: false, .. } | Law::NextFlight | Law::UnidirectionalMis
        );
        let exists = (estimator.exists)(scene, scene.ranges(controlled));
        let found = case.at(None).expect("as written").predict(index, None, case.pilots(1, index));
        assert_eq!(found.is_some(), exists, "whether it exists: {what}");
        let Some(found) = found else { continue };
        let expected = match (law, sampling.shape) {
            (Law::NextFlight | Law::UnidirectionalMis, Shape::Constant(rate)) => {
                volterra(law, scene, rate)
            }
            _ => solve(law, scene),
        };
        differences.extend(compare(&what, &found, &expected));
        compared += 1;
    }
    (differences, compared)
}

fn check_all(scenes: &[Scene], least: usize) {
    let (mut differences, mut compared) = (Vec::new(), 0);
    for scene in scenes {
        let (found, count) = check(scene);
        differences.extend(found);
        compared += count;
    }
    crate::common::none(&differences);
    assert!(compared >= least, "only {compared} predictions were compared");
}

/// Returns all combinations of σ̂ and controls with a medium.
fn scenes(
    medium: fn() -> Field,
    length: f64,
    samplings: &[fn() -> Field],
    controls: &[fn() -> Field],
) -> Vec<Scene> {
    let mut scenes = Vec::new();
    for sampling in samplings {
        for control in controls {
            let (medium, sampling, control) = (medium(), sampling(), control());
            scenes.push(Scene { medium, sampling, control, length });
        }
        let medium = medium();
        for points in [2, 6] {
            let control = explorers(&medium, length, points);
            let (medium, sampling) = (twin(&medium), sampling());
            scenes.push(Scene { medium, sampling, control, length });
        }
    }
    scenes
}

#[test]
fn homogeneous_medium() {
    let samplings: [fn() -> Field; 4] = [
        || constant(0.8),
        || constant(0.3),
        || steps(&[0.0, 1.0, 4.0], &[0.4, 0.9]),
        || lines(&[0.0, 4.0], &[0.35, 1.4]),
    ];
    let controls: [fn() -> Field; 4] =
        [no_control, || constant(0.3), || constant(0.7), || constant(-0.1)];
    check_all(&scenes(homogeneous, 4.0, &samplings, &controls), 180);
}

#[test]
fn layers_with_an_empty_one() {
    let samplings: [fn() -> Field; 4] = [
        || constant(1.1),
        || constant(0.4),
        || steps(&[0.0, 2.0, 5.0, 10.0], &[0.25, 1.3, 0.6]),
        || lines(&[0.0, 3.5, 10.0], &[0.3, 1.2, 0.5]),
    ];
    let controls: [fn() -> Field; 2] = [no_control, || constant(0.3)];
    check_all(&scenes(layers, 10.0, &samplings, &controls), 130);
}

#[test]
fn straight_lines() {
    let samplings: [fn() -> Field; 3] =
        [|| constant(1.6), || constant(0.8), || lines(&[0.0, 1.2, 4.0], &[0.5, 1.9, 1.0])];
    let controls: [fn() -> Field; 3] = [no_control, || constant(0.15), || constant(0.9)];
    check_all(&scenes(hills, 4.0, &samplings, &controls), 120);
}

#[test]
fn exponential_atmosphere() {
    let samplings: [fn() -> Field; 3] =
        [|| constant(2.5), || constant(0.9), || lines(&[0.0, 1.5, 5.0], &[2.2, 0.8, 0.3])];
    let controls: [fn() -> Field; 3] = [no_control, || constant(0.05), || constant(0.6)];
    check_all(&scenes(atmosphere, 5.0, &samplings, &controls), 120);
}

#[test]
fn gaussian_blob() {
    let samplings: [fn() -> Field; 3] =
        [|| constant(1.3), || constant(0.7), || lines(&[0.0, 2.2, 4.0], &[0.2, 1.4, 0.3])];
    let controls: [fn() -> Field; 2] = [no_control, || constant(0.4)];
    check_all(&scenes(blob, 4.0, &samplings, &controls), 100);
}

#[test]
fn plane_waves() {
    let samplings: [fn() -> Field; 3] = [
        || constant(1.7),
        || constant(0.9),
        || steps(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], &[1.5, 1.6, 1.4, 0.8, 1.6]),
    ];
    let controls: [fn() -> Field; 2] = [no_control, || constant(0.8)];
    check_all(&scenes(waves, 5.0, &samplings, &controls), 100);
}

/// Returns σ_t of Eq. 21 along the axis, from its formula; (1 + cos u)/2 = cos²(u/2).
fn eq21(t: f64) -> f64 {
    (0.75 * t).cos().powi(10) * (2.0 + (0.5 * t).sin()) / 3.0
}

#[test]
fn eq_21_by_equation_14() {
    let case = crate::common::case(
        "eq21",
        "title = \"t\"\n[problem.transmittance]\nvolume.eq21 = {}\n\
         ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }\n\
         sampling.constant.value = 1.0\n\
         estimators = [{ double = {} }, { single.rule = \"terminating\" }, \
         { single = { rule = \"non-terminating\", albedo = 0.7 } }, \
         { double.control.explorers.points = 21 }, { weighted-delta = {} }]",
    );
    let medium = || smooth("eq21", eq21);
    let product = |rule, control| {
        let law = Law::Product { rule, controlled: true };
        solve(law, &Scene { medium: medium(), sampling: constant(1.0), control, length: 20.0 })
    };
    let expected = [
        product(Rule::Double, no_control()),
        product(Rule::Terminating, no_control()),
        product(Rule::NonTerminating(0.7), no_control()),
        product(Rule::Double, explorers(&medium(), 20.0, 21)),
        product(Rule::NonTerminating(1.0), no_control()),
    ];
    let mut differences = Vec::new();
    for (index, expected) in expected.iter().enumerate() {
        let found = case
            .at(None)
            .expect("as written")
            .predict(index, None, case.pilots(1, index))
            .expect("it exists");
        differences.extend(compare(&format!("estimator {index} of Eq. 21"), &found, expected));
    }
    crate::common::none(&differences);
}
