//! Predictions of each channel against numbers derived by hand.

use crate::common::{case, differs, none, options, predicted, row, rows, verdict, with_optima};
use trueflight::media::{Control, Piecewise};
use trueflight::plan::Plan;
use trueflight::record::{Row, Verdict, build, curves};
use trueflight::report::layout::{self, Pen};
use trueflight::report::run::console::{self, TableView};
use trueflight::theory::collisions::rules::Weight;
use trueflight::theory::ray::curve;
use trueflight::theory::ray::product::Product;
use trueflight::theory::{Mesh, Prediction};

fn predictions(text: &str) -> Vec<Prediction> {
    let cases = [case("test", text)];
    let plan = Plan::new(&cases, &options(1, 1000));
    let ready = plan.experiments().map(|(_, planned)| planned.outcome.as_ref().expect("ready"));
    ready.map(|ready| ready.prediction.clone()).collect()
}

#[test]
fn the_clock_of_a_curve_in_a_homogeneous_medium() {
    // σ_t = 1/2, σ̂ = 1: r = 1/2 and X(s)/T(s) = e^{s/2} 2^{−N}, N ~ Poisson(s), so that
    // E[(X/T)^k] = exp(s(k/2 − 1 + 2^{−k})) and J₂(s) = s/4.
    let mesh = Mesh::new(crate::common::medium("medium.constant.extinction = 0.5\nspan = [0, 3]"));
    let sampling = Piecewise::constant(1.0, mesh.support());
    let product = Product::new(&mesh, &sampling, &Control::None, &Weight);
    let prediction = curve::predict(&product, &[1.0, 3.0]);
    let raw = |s: f64, k: i32| (s * (0.5 * f64::from(k) - 1.0 + 0.5f64.powi(k))).exp();
    // E[(Y − 1)⁴] of a step, by its raw moments.
    let fourth = |s: f64| raw(s, 4) - 4.0 * raw(s, 3) + 6.0 * raw(s, 2) - 3.0;
    let step = raw(3.0, 2) - raw(1.0, 2);
    let first = fourth(1.0) / (raw(1.0, 2) - 1.0).powi(2);
    let second = raw(1.0, 4) * fourth(2.0) / (step * step);
    let expected = [(0.25f64.exp_m1(), first), (0.75f64.exp() - 0.25f64.exp(), second)];
    let mut differences = Vec::new();
    for (found, (variance, kurtosis)) in prediction.increments.iter().zip(expected) {
        differences.extend(differs("variance", found.variance, variance, 1e-13));
        differences.extend(differs("kurtosis", found.kurtosis, kurtosis, 1e-11));
    }
    assert_eq!(prediction.increments.len(), 2);
    none(&differences);
}

#[test]
fn the_steps_of_a_clock_add_up_and_agree_with_the_channels() {
    let prediction = &predictions(
        "title = \"a curve\"\n[problem.transmittance]\nvolume.eq21 = {}\n\
         ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }\ndistances = 12\n\
         sampling.constant.value = 1.2\nestimators = [{ double = {} }]",
    )[0];
    let mut sum = 0.0;
    let mut differences = Vec::new();
    assert_eq!(prediction.increments.len(), prediction.channels.len());
    for (step, channel) in prediction.increments.iter().zip(&prediction.channels) {
        sum += step.variance;
        let [m2, ..] = channel.moments.expect("moments").relative;
        differences.extend(differs("sum of steps", sum, m2, 1e-12));
        assert!(step.kurtosis >= 1.0 && step.error * step.variance < 1e-12 * m2);
    }
    none(&differences);
}

const ALL: &str = "{ closed-form = {} }, { regular = {} }, { woodcock = {} }, { ratio = {} }, \
                   { residual-ratio.control.constant.value = 0.1 }, { next-flight = {} }, \
                   { unidirectional-mis = {} }, { ray-marching = { steps = 4, jitter = true } }";

#[test]
fn thin_media_are_measured_by_their_opacity() {
    // τ = .05, .2 and 0: 1 − T = −expm1(−τ) below .1, T elsewhere.
    let opacity = 0.048_770_575_499_285_99;
    for (extinction, unit) in [(0.025, opacity), (0.1, (-0.2f64).exp()), (0.0, 1.0)] {
        let found = predictions(&format!(
            "title = \"thin\"\n[problem.transmittance]\n\
             medium.constant.extinction = {extinction}\nspan = [0, 2]\n\
             sampling.constant.value = 0.5\nestimators = [{ALL}]"
        ));
        let differences =
            found.iter().filter_map(|found| differs("unit", found.channels[0].unit, unit, 1e-15));
        none(&differences.collect::<Vec<_>>());
    }
    // 1 − T has fewer digits than T: an error of 1e-12 is exact for T, and not for the opacity.
    let faint = predictions(
        "title = \"faint\"\n[problem.transmittance]\nmedium.constant.extinction = 1e-12\n\
         span = [0, 1]\nestimators = [{ closed-form = {} }]",
    );
    none(&differs("unit", faint[0].channels[0].unit, 1e-12, 1e-12).into_iter().collect::<Vec<_>>());
    let flight = &predictions(
        "title = \"flight\"\n[problem.free-flight]\nmedium.constant.extinction = 0.01\n\
         span = [0, 2]\nestimators = [{ inversion = {} }]",
    )[0];
    assert_eq!(flight.channels[0].unit, flight.channels[0].truth.value);
}

/// Text of a case with τ = 1000 and a control of 999: `X/T = e · ∏ (1 − r)`, r = .1/2.
const THICK: &str = "title = \"thick\"\n[problem.transmittance]\n\
                     medium.constant.extinction = 100\nspan = [0, 10]\n\
                     sampling.constant.value = 2\ncontrol.constant.value = 99.9\n\
                     estimators = [{ double = {} }, { single.rule = \"terminating\" }, \
                     { residual-ratio = {} }, { closed-form = {} }, { regular = {} }, \
                     { ray-marching.steps = 3 }, { ratio = {} }, { woodcock = {} }, \
                     { decomposition = {} }, { weighted-delta = {} }, { next-flight = {} }]";

#[test]
fn thick_media_are_drawn_in_units_of_their_own() {
    // double: J₂ = 20 · .05² = .05; single at 0 ≤ r ≤ 1: J₂ = 20 · .05 = 1 = J₁.
    let found = rows(THICK, 400_000);
    let expected = [
        ("double", 0.05f64.exp_m1(), 20.0),
        ("single", 1f64.exp_m1(), 20.0 * -(-1f64).exp_m1()),
        ("residual-ratio", 0.05f64.exp_m1(), 20.0),
        ("closed-form", 0.0, 0.0),
        ("regular", 0.0, 1.0),
    ];
    let mut differences = Vec::new();
    for (name, variance, lookups) in expected {
        let row = row(&found, name);
        assert_eq!((row.truth, row.log_unit), (Some(1.0), Some(1000.0)), "{name}");
        let number = |x: Option<f64>| x.expect("a number");
        // The residual .1 is a difference of 100 and 99.9: 1e-14 of it is their rounding.
        let found = number(row.predicted_variance);
        differences.extend(differs(&format!("V {name}"), found, variance, 1e-12));
        let found = number(row.experiment.predicted_lookups);
        differences.extend(differs(&format!("N {name}"), found, lookups, 1e-12));
        assert_eq!(verdict(row), Verdict::Pass, "{name}: {}", row.reason());
        assert!((number(row.mean) - 1.0).abs() < 0.01, "{name}: {:?}", row.mean);
    }
    none(&differences);
    let marched = row(&found, "ray-marching");
    assert!((marched.mean.expect("draws") - 1.0).abs() < 1e-12);
    for name in ["ratio", "woodcock", "decomposition", "weighted-delta", "next-flight"] {
        let row = row(&found, name);
        assert_eq!(verdict(row), Verdict::Refused, "{name}");
        assert!(
            row.reason().contains("τ = 1000") || row.reason().contains("τ ≤ 300"),
            "{}",
            row.reason()
        );
    }
}

#[test]
fn the_unit_does_not_depend_on_which_side_of_the_limit_a_depth_is() {
    // The relative moments at τ = 299 and τ = 301 with the same residual are the same.
    let rows: Vec<Row> = [29.9, 30.1]
        .into_iter()
        .flat_map(|extinction| {
            predicted(&format!(
                "title = \"limit\"\n[problem.transmittance]\n\
                 medium.constant.extinction = {extinction}\nspan = [0, 10]\n\
                 sampling.constant.value = 2\nestimators = [{{ double.control.constant.value = \
                 {} }}]",
                extinction - 0.1
            ))
        })
        .collect();
    assert_eq!((rows[0].log_unit, rows[1].log_unit.is_some()), (None, true));
    let relative = |row: &Row| row.relative_moments.map(|m| m.expect("a moment"));
    let pairs = relative(&rows[0]).into_iter().zip(relative(&rows[1]));
    let differences = pairs.filter_map(|(a, b)| differs("moment", a, b, 1e-11));
    none(&differences.collect::<Vec<_>>());
}

/// Returns a rod through Eq. 21 by the non-terminating rule.
fn rod(more: &str) -> String {
    format!(
        "title = \"a rod\"\n[problem.rod]\nvolume.eq21 = {{}}\n\
         ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }}\nforward = 0.5\n\
         {more}\nestimators = [{{ non-terminating = {{}} }}]"
    )
}

#[test]
fn every_channel_has_an_optimum_of_its_own() {
    // Figures of merit at σ̂ = 0.6, 0.61, … 1.6 give the best σ̂ to within a step.
    let steps: Vec<String> = (60..=160).map(|i| format!("{}", f64::from(i) / 100.0)).collect();
    let more = format!("albedo = 0.7\nsweep.sampling.values = [{}]", steps.join(", "));
    let rows = with_optima(&rod(&more));
    for (channel, sampling, fom) in [("reflectance", 0.902, 0.576), ("transmittance", 0.952, 1.138)]
    {
        let of: Vec<&Row> = rows.iter().filter(|row| row.channel == channel).collect();
        let merit = |row: &Row| row.predicted_fom.expect("a figure of merit");
        let best = of.iter().max_by(|a, b| merit(a).total_cmp(&merit(b))).expect("rows");
        let at = best.experiment.sampling().expect("σ̂");
        assert!((at - sampling).abs() < 0.01, "{channel}: best of the sweep at {at}");
        for row in &of {
            let [found, found_fom] =
                [row.best_sampling(), row.best_fom()].map(|x| x.expect("known"));
            assert!((found - sampling).abs() < 6e-4, "{channel}: {found}");
            assert!((found_fom - fom).abs() < 6e-4, "{channel}: {found_fom}");
            assert!((found - at).abs() < 0.01 && found_fom >= merit(best), "{channel}: {found}");
        }
    }
    // It takes a hundred predictions, and is searched only on request.
    let bare = predicted(&rod("albedo = 0.7\nsampling.constant.value = 1"));
    assert!(bare.iter().all(|row| row.best_sampling().is_none() && row.best_fom().is_none()));
}

#[test]
fn an_optimum_at_the_edge_of_a_domain_is_inside() {
    // Woodcock's V = T(1 − T) at any σ̂ ≥ σ_t, E[M] = (σ̂/σ_t)(1 − T): best at σ_t, below it refused.
    let rows = with_optima(
        "title = \"edge\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\n\
         span = [0, 4]\nsampling.constant.value = 1\nestimators = [{ woodcock = {} }]",
    );
    let [best, fom] = [rows[0].best_sampling(), rows[0].best_fom()].map(|x| x.expect("known"));
    let t = (-2f64).exp();
    assert!((0.5..0.5 * (1.0 + 1e-5)).contains(&best), "{best}");
    assert!((fom * t * (1.0 - t).powi(2) - 1.0).abs() < 1e-5, "{fom}");
}

#[test]
fn every_curve_of_a_plot_has_an_optimum_of_its_own() {
    let cases = [case("test", &rod("albedo = 0.7\nsweep.sampling.values = [0.7, 0.9, 1.5]"))];
    let stars: Vec<f64> = curves::curves(&cases[0], 1)
        .iter()
        .map(|curve| {
            let star = curve.optimum.expect("inside the sweep");
            let highest = curve.points.iter().map(|point| point.fom).fold(0.0, f64::max);
            assert!(star.fom >= highest, "{}: {} below {highest}", curve.channel, star.fom);
            star.x
        })
        .collect();
    assert!((stars[0] - 0.902).abs() < 6e-4 && (stars[1] - 0.952).abs() < 6e-4, "{stars:?}");
}

#[test]
fn an_optimum_belongs_to_the_albedo_of_its_row() {
    let swept = with_optima(&rod("sampling.constant.value = 1\nsweep.albedo.values = [0.2, 0.9]"));
    for (albedo, of_albedo) in [0.2, 0.9].into_iter().zip(swept.chunks(2)) {
        let alone = with_optima(&rod(&format!("sampling.constant.value = 1\nalbedo = {albedo}")));
        for (row, alone) in of_albedo.iter().zip(&alone) {
            assert_eq!(row.experiment.swept(), Some(albedo));
            assert!(row.best_sampling().is_some());
            assert_eq!(row.best_sampling(), alone.best_sampling(), "{albedo} {}", row.channel);
            assert_eq!(row.best_fom(), alone.best_fom(), "{albedo} {}", row.channel);
        }
    }
}

/// Returns a table of theory, this number of columns wide.
fn table(text: &str, view: TableView, width: usize) -> String {
    let cases = [case("test", text)];
    let record = build::predicted(&Plan::new(&cases, &options(1, 1000)));
    let table = console::table(&record, view, Pen { width, colour: false });
    let widest = table.lines().map(layout::width).max().expect("lines");
    assert!(widest <= width, "{widest} > {width}:\n{table}");
    table
}

#[test]
fn all_moments_are_shown_on_a_narrow_screen() {
    let transmittance = "title = \"moments\"\n[problem.transmittance]\nvolume.eq21 = {}\n\
        ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }\n\
        sweep.sampling.values = [1, 2]\nestimators = [{ ratio = {} }, \
        { double.control.explorers.points = 20 }, { single = { rule = \"non-terminating\", albedo = 0.7 } }]";
    let shown = table(transmittance, TableView::Moments, 80);
    for head in ["J₁", "J₂", "J₃", "J₄", "m₂", "m₃", "m₄", "m error", "lookups", "± σ", "n(2)"]
    {
        assert!(shown.contains(head), "{head}:\n{shown}");
    }
    let slab = "title = \"moments\"\n[problem.slab]\nmedium.constant.extinction = 1\nspan = [0, 2]\n\
        albedo = 0.9\nphase.isotropic = {}\nincidence.diffuse = {}\n\
        estimators = [{ non-terminating.sampling.constant.value = 1.25 }, \
        { analog.sampling.local-majorants.segments = 4 }]";
    let shown = table(slab, TableView::Moments, 80);
    for head in ["m₂", "m₃", "m₄", "m error", "lookups", "± σ", "n(2)"] {
        assert!(shown.contains(head), "{head}:\n{shown}");
    }
}

#[test]
fn values_of_one_sweep_are_printed_apart() {
    let text = "title = \"labels\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\n\
        span = [0, 4]\nsweep.sampling.values = [0.48639, 0.4864, 0.6]\n\
        estimators = [{ ratio = {} }, { woodcock = {} }]";
    for view in [TableView::Predict, TableView::Plan, TableView::Moments] {
        let shown = table(text, view, 100);
        for value in ["0.48639", "0.4864 ", "0.6 "] {
            assert!(shown.contains(value), "{value}:\n{shown}");
        }
    }
    // The reason that both refusals share is listed with both places.
    let shown = table(text, TableView::Predict, 100);
    assert!(shown.contains("(σ\u{302} 0.48639)") && shown.contains("(σ\u{302} 0.4864)"), "{shown}");
    let cases = [case("test", text)];
    let record = build::planned(&Plan::new(&cases, &options(1, 1000)));
    let case = &record.results.cases[0];
    let names: Vec<String> = case.rows().map(|row| row.name()).collect();
    for (name, label) in names.iter().zip(["0.48639", "0.4864"]) {
        assert_eq!(*name, format!("ratio, σ\u{302} {label}"));
    }
}
