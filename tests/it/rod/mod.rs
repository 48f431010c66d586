//! Rods against numbers from another arithmetic, see `tests/data/README.md`.

use crate::common::{case, differs, none, options, rows_of};
use serde_json::Value;
use trueflight::plan::Plan;
use trueflight::record::build;
use trueflight::record::{Row, Verdict};

const EQ21: &str = "volume.eq21 = {}
    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }";

/// Returns the values of `rod-values.json` with this name.
fn reference(id: &str) -> Vec<Value> {
    let all: Vec<Value> =
        serde_json::from_str(include_str!("../../data/rod-values.json")).expect("JSON");
    all.into_iter().filter(|entry| entry["id"] == id).collect()
}

/// Returns the numbers of an entry; a moment that diverges is written as null.
fn numbers(entry: &Value) -> Vec<f64> {
    let list = entry["value"].as_array().expect("a list");
    list.iter().map(|x| x.as_f64().unwrap_or(f64::INFINITY)).collect()
}

/// Returns the predictions of a rod with one estimator.
fn planned(rod: &str, estimator: &str) -> Vec<Row<'static>> {
    let text =
        format!("title = \"a rod\"\n[problem.rod]\n{rod}\nestimators = [{{ {estimator} = {{}} }}]");
    let cases = [case("test", &text)];
    let record = build::planned(&Plan::new(&cases, &options(1, 100_000)));
    rows_of(record)
}

/// Returns the truths of a rod, channel by channel.
fn truths(rod: &str) -> Vec<(String, f64)> {
    let rows = planned(rod, "non-terminating");
    let truth = |row: &Row| row.truth.unwrap_or_else(|| panic!("{}", row.reason()));
    rows.iter().map(|row| (row.channel.clone(), truth(row))).collect()
}

#[test]
fn closed_forms_are_met() {
    let mut wrong = Vec::new();
    for entry in reference("rod_RT") {
        let [a, pf, tau] =
            ["a", "pf", "tau"].map(|key| entry["params"][key].as_f64().expect("a number"));
        let expected = numbers(&entry);
        // Only the optical depth matters: a constant medium, and layers with a gap.
        let (half, quarter) = (0.5 * tau, 0.25 * tau);
        let media = [
            format!("medium.constant.extinction = {tau}\nspan = [0, 1]"),
            format!(
                "medium.piecewise-constant = {{ breaks = [1, 2, 3, 5], \
                 values = [{half}, 0, {quarter}] }}\nspan = [1, 5]"
            ),
        ];
        for medium in media {
            let rod =
                format!("{medium}\nalbedo = {a}\nforward = {pf}\nsampling.constant.value = 4");
            for ((name, value), expected) in truths(&rod).iter().zip(&expected) {
                let what = format!("{name} of {}", entry["params"]);
                wrong.extend(differs(&what, *value, *expected, 1e-14));
            }
        }
    }
    none(&wrong);
}

/// Returns a rod of `rod_lin`, seen from its beginning or from its end.
fn ramp(from_the_end: bool) -> String {
    let (extinction, albedo) =
        if from_the_end { ("[3.5, 0.5]", "[0.35, 0.95]") } else { ("[0.5, 3.5]", "[0.95, 0.35]") };
    format!(
        "medium.piecewise-linear = {{ knots = [0, 3], values = {extinction} }}\nspan = [0, 3]\n\
         albedo.piecewise-linear = {{ knots = [0, 3], values = {albedo} }}\nforward = 0.7"
    )
}

/// Returns a rod of `rod_pw`, seen from its beginning or from its end.
fn layers(from_the_end: bool) -> String {
    let (breaks, extinction, albedo) = if from_the_end {
        ("[0, 0.5, 2.5, 3.5]", "[2, 1.2, 0.5]", "[1, 0.4, 0.9]")
    } else {
        ("[0, 1, 3, 3.5]", "[0.5, 1.2, 2]", "[0.9, 0.4, 1]")
    };
    format!(
        "medium.piecewise-constant = {{ breaks = {breaks}, values = {extinction} }}\n\
         span = [0, 3.5]\n\
         albedo.piecewise-constant = {{ breaks = {breaks}, values = {albedo} }}\nforward = 0.6"
    )
}

#[test]
fn varying_albedo_is_met() {
    let mut wrong = Vec::new();
    for (id, rod) in [("rod_lin", ramp as fn(bool) -> String), ("rod_pw", layers)] {
        let expected = numbers(&reference(id)[0]);
        for (from_the_end, reflectance) in [(false, expected[0]), (true, expected[2])] {
            let found = truths(&format!("{}\nsampling.constant.value = 4", rod(from_the_end)));
            let pairs = found.iter().zip([reflectance, expected[1]]);
            wrong.extend(pairs.filter_map(|((name, value), expected)| {
                differs(&format!("{name} of {id}"), *value, expected, 5e-12)
            }));
        }
    }
    none(&wrong);
}

#[test]
fn orders_of_scattering_are_met() {
    let found = truths(
        "medium.constant.extinction = 2\nspan = [0, 1]\nalbedo = 1\nforward = 0.75\norders = 6
        sampling.constant.value = 3",
    );
    let (r, t) = (numbers(&reference("rod_orders_R")[0]), numbers(&reference("rod_orders_T")[0]));
    let mut wrong = Vec::new();
    for order in 0..=6 {
        for (word, expected) in [("reflectance", &r), ("transmittance", &t)] {
            let name = format!("{word}, order {order}");
            match found.iter().find(|(channel, _)| *channel == name) {
                Some((_, value)) => wrong.extend(differs(&name, *value, expected[order], 1e-13)),
                None => assert!(order == 0 && word == "reflectance"),
            }
        }
    }
    none(&wrong);
}

/// Returns a raw moment from the central ones.
fn raw(row: &Row, k: usize) -> f64 {
    let m = row.truth.expect("a truth");
    let [m2, m3, m4] = row.relative_moments.map(|moment| moment.unwrap_or(f64::INFINITY));
    if k == 2 { m * m * (1.0 + m2) } else { m.powi(4) * (m4 + 4.0 * m3 + 6.0 * m2 + 1.0) }
}

/// Returns `E[R²]`, `E[T²]`, `E[R⁴]`, `E[T⁴]` and the expected lookups.
fn found(rows: &[Row]) -> [f64; 5] {
    let [reflected, transmitted] = rows else { panic!("{}", rows[0].reason()) };
    let lookups = reflected.experiment.predicted_lookups.expect("lookups");
    [raw(reflected, 2), raw(transmitted, 2), raw(reflected, 4), raw(transmitted, 4), lookups]
}

const NAMES: [&str; 5] = ["E[R²]", "E[T²]", "E[R⁴]", "E[T⁴]", "E[M]"];

#[test]
fn moments_of_every_rule_are_met() {
    let mut wrong = Vec::new();
    let mut met = 0;
    for (id, rule) in [("term", "terminating"), ("non", "non-terminating"), ("adapt", "adaptive")] {
        for sampling in ["0.5", "0.6", "0.8", "1.0", "1.5"] {
            let Some(entry) = reference(&format!("spm_rod_eq21/{id}/{sampling}")).pop() else {
                continue;
            };
            let rod = format!("{EQ21}\nalbedo = 0.7\nsampling.constant.value = {sampling}");
            let rows = planned(&rod, rule);
            let found = found(&rows);
            for (row, expected) in rows.iter().zip(numbers(&entry)) {
                // The stated error of the variance is an upper bound, but does not widen the tolerance.
                let stated = row.moments_error.expect("an error");
                let off = (raw(row, 2) - expected).abs() / row.predicted_variance.expect("V");
                assert!(off <= stated && stated < 1e-8, "{rule} at {sampling}: {off:e} {stated:e}");
            }
            for ((name, found), expected) in NAMES.iter().zip(found).zip(numbers(&entry)) {
                wrong.extend(differs(
                    &format!("{name}, {rule} at {sampling}"),
                    found,
                    expected,
                    1e-11,
                ));
            }
            met += 1;
        }
    }
    assert_eq!(met, 12);
    none(&wrong);
}

#[test]
fn the_adaptive_rule_never_has_the_smaller_variance() {
    let mut worse = 0;
    for albedo in ["0.1", "0.5", "0.7", "0.9", "1"] {
        for sampling in ["0.6", "0.7", "0.8", "0.9", "1", "1.5"] {
            let rod = format!("{EQ21}\nalbedo = {albedo}\nsampling.constant.value = {sampling}");
            let (adaptive, other) = (planned(&rod, "adaptive"), planned(&rod, "non-terminating"));
            let is_refused = |rows: &[Row]| rows[0].verdict == Some(Verdict::Refused);
            if is_refused(&adaptive) || is_refused(&other) {
                // If the variance is infinite without terminating, so it is with it.
                assert!(is_refused(&adaptive), "{albedo}, {sampling}");
                continue;
            }
            for (a, b) in adaptive.iter().zip(&other) {
                let [a2, b2] = [a, b].map(|row| row.predicted_variance.expect("a variance"));
                assert!(a2 >= b2 * (1.0 - 1e-10), "{albedo}, {sampling}: {a2} < {b2}");
                worse += usize::from(a2 > b2 * 1.001);
            }
            let [a, b] = [&adaptive, &other]
                .map(|rows| rows[0].experiment.predicted_lookups.expect("lookups"));
            assert!(a <= b * (1.0 + 1e-10), "{albedo}, {sampling}: {a} > {b} lookups");
        }
    }
    assert!(worse >= 10, "{worse}");
}

#[test]
fn both_ends_together_look_up_what_the_whole_sampling_extinction_asks() {
    for rod in [ramp as fn(bool) -> String, layers] {
        let lookups = |from_the_end: bool| {
            let rod = format!("{}\nsampling.constant.value = 1.9", rod(from_the_end));
            planned(&rod, "non-terminating")[0].experiment.predicted_lookups.expect("lookups")
        };
        let length = if rod(false).contains("[0, 3]") { 3.0 } else { 3.5 };
        let mean = 0.5 * (lookups(false) + lookups(true));
        assert!((mean / (1.9 * length) - 1.0).abs() < 1e-11, "{mean}");
    }
}

/// Without scattering the flux is the transmittance; with scattering, the absorbed density is σ_t (1 − a) times the
/// flux.
#[test]
fn the_flux_is_what_absorption_feeds_on() {
    let rod = |albedo: f64| {
        let found = truths(&format!(
            "medium.constant.extinction = 1.5\nspan = [0, 2]\nalbedo = {albedo}\nflux = 2
            absorbed = true\nforward = 0.8\nsampling.constant.value = 2"
        ));
        let of = |name: &str| found.iter().find(|(channel, _)| channel == name).expect(name).1;
        (of("flux, part 1"), of("flux, part 2"), of("absorbed"))
    };
    let (first, second, absorbed) = rod(0.6);
    let mut wrong = Vec::new();
    wrong.extend(differs("absorbed", 1.5 * 0.4 * (first + second), absorbed, 1e-11));
    // ∫ e^{−1.5 t} over each half.
    let bare = |from: f64, to: f64| ((-1.5 * from).exp() - (-1.5 * to).exp()) / 1.5;
    let text = "medium.constant.extinction = 1.5\nspan = [0, 2]\nalbedo = 1e-12\nflux = 2
        sampling.constant.value = 2";
    let found = truths(text);
    wrong.extend(differs("first half", found[0].1, bare(0.0, 1.0), 1e-11));
    wrong.extend(differs("second half", found[1].1, bare(1.0, 2.0), 1e-11));
    none(&wrong);
}

#[test]
fn what_diverges_is_told_before_a_draw() {
    let rod = |sampling: f64| format!("{EQ21}\nalbedo = 0.7\nsampling.constant.value = {sampling}");
    let far_below = &planned(&rod(0.3), "non-terminating")[0];
    assert_eq!(far_below.verdict, Some(Verdict::Refused));
    assert!(far_below.reason().contains("finite variance"), "{}", far_below.reason());
    let below = &planned(&rod(0.55), "non-terminating")[1];
    assert_eq!(below.verdict, None);
    assert!(below.predicted_variance.is_some() && below.predicted_kurtosis.is_none());
    assert!(below.reason().contains("the fourth moment"), "{}", below.reason());
    let above = &planned(&rod(0.9), "non-terminating")[1];
    assert!(above.reason().is_empty() && above.predicted_kurtosis.is_some(), "{}", above.reason());
}

/// With `σ_t = 1`, `a = 0.7`, `p_f = ½` and `σ̂ = 0.8`, `E[T²] = 1/y(L)`, where `y = cos ωx + (A/ω) sin ωx` and
/// `ω² = B² − A²`. It falls to 0 at the critical length.
#[test]
fn near_the_critical_length_a_moment_is_right_or_refused() {
    let (sampling, albedo) = (0.8, 0.7);
    let ratio: f64 = 1.0 / sampling;
    let sum = albedo * ratio + (1.0 - ratio).abs();
    let (q, s) = ((1.0 - ratio).abs() * sum, albedo * ratio * sum);
    let (a, b) = (sampling * (1.0 - q - 0.5 * s), sampling * 0.5 * s);
    let omega = (b * b - a * a).sqrt();
    let critical = omega.atan2(-a) / omega;
    let rows = |length: f64| {
        let rod = format!(
            "medium.constant.extinction = 1\nspan = [0, {length}]\nalbedo = {albedo}\n\
             forward = 0.5\nsampling.constant.value = {sampling}"
        );
        planned(&rod, "non-terminating")
    };
    for beyond in [1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0] {
        let row = &rows(critical * (1.0 + beyond))[0];
        assert_eq!(row.verdict, Some(Verdict::Refused), "{beyond}");
        assert!(row.reason().contains("a finite variance"), "{}", row.reason());
    }
    let mut known = 0;
    for below in [0.3, 0.1, 1e-2, 2e-3, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12] {
        let length = critical * (1.0 - below);
        let rows = rows(length);
        if rows[0].verdict == Some(Verdict::Refused) {
            continue;
        }
        let second = raw(&rows[1], 2);
        let expected = 1.0 / ((omega * length).cos() + a / omega * (omega * length).sin());
        let error = (second / expected - 1.0).abs();
        assert!(error <= 1e-9 / below, "{below}: E[T²] = {second}, not {expected}");
        known += 1;
    }
    assert!(known >= 6, "{known} lengths below the critical one are predicted");
}

/// `E[T²] = 1/y(20)` by fourth-order Magnus steps in another language: 8000 of them, with the digits that 4000 steps
/// confirm. Where y changes sign, the moment is infinite.
#[test]
fn a_moment_next_to_its_divergence_is_known() {
    let finite = [
        ("non-terminating", 0.4864, 6346.646),
        ("non-terminating", 0.4865, 692.249_17),
        ("adaptive", 0.4881, 2397.0527),
        ("adaptive", 0.4882, 591.805_30),
        ("weighted", 0.4885, 1944.233),
    ];
    let rod = |sampling: f64| format!("{EQ21}\nalbedo = 0.7\nsampling.constant.value = {sampling}");
    for (rule, sampling, expected) in finite {
        let rows = planned(&rod(sampling), rule);
        assert_eq!(rows[0].verdict, None, "{rule} at {sampling}: {}", rows[0].reason());
        let second = raw(&rows[1], 2);
        assert!((second / expected - 1.0).abs() < 1e-5, "{rule} at {sampling}: {second}");
    }
    let infinite = [("non-terminating", 0.486_37), ("adaptive", 0.488_05), ("weighted", 0.4884)];
    for (rule, sampling) in infinite {
        let row = &planned(&rod(sampling), rule)[0];
        assert!(row.reason().contains("diverges: the critical length ends"), "{}", row.reason());
    }
}

#[test]
fn a_rule_is_refused_where_it_has_no_chances() {
    let rod = format!("{EQ21}\nalbedo = 0.9\nsampling.constant.value = 0.6");
    let refused = &planned(&rod, "terminating")[0];
    assert_eq!(refused.verdict, Some(Verdict::Refused));
    assert!(refused.reason().contains("2/(a + 1)"), "{}", refused.reason());
    let refused = &planned(&rod, "analog")[0];
    assert!(refused.reason().contains("σ_t ≤ σ̂"), "{}", refused.reason());
}

/// A second moment that underflows is not taken for one that diverges, and small expected values keep their digits.
#[test]
fn faint_rods_say_what_theory_lacks() {
    let rod = "medium.constant.extinction = 900\nspan = [0, 1]\nalbedo = 0.5\nforward = 0.5
        sampling.constant.value = 900";
    let refused = &planned(rod, "weighted")[0];
    assert_eq!(refused.verdict, Some(Verdict::Refused));
    assert!(refused.reason().contains("E[X²] is below 1e-292"), "{}", refused.reason());
    let rows = planned(rod, "analog");
    let through = rows.iter().find(|row| row.channel == "transmittance").expect("a row");
    // In 50 digits (mpmath).
    let [truth, error] = [through.truth, through.truth_error].map(|known| known.expect("known"));
    assert!(
        (truth - 4.015_205_257_747_527e-277).abs() <= error && error < 1e-10 * truth,
        "{truth:e} {error:e}"
    );
}

/// What is never drawn is not confirmed by draws.
#[test]
fn a_transmittance_that_no_draw_shows_passes_nothing() {
    let text = "medium.constant.extinction = 100\nspan = [0, 3]\nalbedo = 0.7
        sampling.constant.value = 100";
    let rows = planned(text, "analog");
    let through = rows.iter().find(|row| row.channel == "transmittance").expect("a row");
    assert_ne!(through.verdict, Some(Verdict::Pass));
    let case = crate::common::case(
        "unknown",
        &format!("title = \"t\"\n[problem.rod]\n{text}\nestimators = [{{ analog = {{}} }}]"),
    );
    let record = crate::common::judged(&[case], &crate::common::options(1, 20_000));
    let through = record.results.cases[0].rows().find(|row| row.channel == "transmittance");
    assert_ne!(through.and_then(|row| row.verdict), Some(Verdict::Pass));
}
