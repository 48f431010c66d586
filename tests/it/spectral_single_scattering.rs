//! Single scattering in several channels: the answers of the single channels, and refusals.

use std::sync::LazyLock;

use serde::Deserialize;
use trueflight::record::{Row, Verdict};

use crate::common::{case, predicted, rows};
use crate::packets::compare;

const BALL: &str = include_str!("../cases/single-scattering/spectral-known-bugs.toml");

const WITHOUT: &str = include_str!("../../cases/single-scattering/spectral-without-mis.toml");

/// Rows of [`BALL`], drawn once for all tests.
static DRAWN: LazyLock<Vec<Row<'static>>> = LazyLock::new(|| rows(BALL, 300_000));

/// Case with the second channel of [`BALL`] alone.
const SECOND: &str = "title = \"green\"
    [problem.single-scattering]
    volume.constant = { extinction = 0.8, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }
    ray = { origin = [0.2, 0.1, -2], direction = [0, 0, 1], length = 4 }
    light = { position = [0.9, -0.3, 0.4], power = 10 }
    albedo = 0.5
    phase.isotropic = {}
    estimators = [
      { delta-tracking = { absorption = \"analog\", sampling.constant.value = 1 } },
      { delta-tracking = { absorption = \"analog\", shadow.ratio.sampling = 1, sampling.constant.value = 1 } },
    ]";

fn second(rows: &[Row<'static>], estimator: &str) -> Row<'static> {
    let is_it = |row: &&Row| row.experiment.label == estimator && row.channel == "channel 2";
    *rows.iter().find(is_it).expect("a row")
}

#[test]
fn every_estimator_finds_the_answer_of_each_channel() {
    for row in DRAWN.iter() {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}: {}", row.experiment.label, row.reason());
    }
}

/// `E[X²] = E[x²]/w` with a third of the draws for each channel.
#[test]
fn one_channel_a_draw_has_the_moments_of_that_channel_by_itself() {
    let (all, alone) = (predicted(BALL), predicted(SECOND));
    for (estimator, own) in ["exact", "ratio"].into_iter().zip(&alone) {
        let row = second(&all, &format!("independent ({estimator} shadow)"));
        assert_eq!(row.truth, own.truth);
        let (mean, variance) = (own.truth.expect("known"), own.predicted_variance.expect("known"));
        let expected = 3.0 * (variance + mean * mean) - mean * mean;
        let found = row.predicted_variance.expect("known");
        assert!((found / expected - 1.0).abs() < 1e-9, "{estimator}: {found} for {expected}");
    }
}

/// Multiple importance sampling is better than one channel a draw, and costs the same lookups.
#[test]
fn colour_noise_is_gone_for_the_same_lookups() {
    for shadow in ["exact", "ratio"] {
        let independent = second(&DRAWN, &format!("independent ({shadow} shadow)"));
        let balanced = second(&DRAWN, &format!("spectral-mis ({shadow} shadow)"));
        assert_eq!(independent.experiment.predicted_lookups, balanced.experiment.predicted_lookups);
        let (one, all) = (independent.variance.expect("drawn"), balanced.variance.expect("drawn"));
        assert!(all < 0.5 * one, "{shadow}: {all} and {one}");
    }
}

/// Walks without multiple importance sampling agree in all their moments, and history-aware spectral tracking has the
/// scores of the balance heuristic.
#[test]
fn walks_relative_to_one_walker_agree_with_theory() {
    let rows = rows(WITHOUT, 300_000);
    assert_eq!(rows.len(), 7 * 3);
    for row in &rows {
        assert_eq!(row.verdict, Some(Verdict::Pass), "{}: {}", row.experiment.label, row.reason());
        let is_bounded =
            row.experiment.label.contains("mis") || row.experiment.label.contains("history");
        assert_eq!(row.predicted_variance.is_none(), is_bounded, "{}", row.experiment.label);
    }
    let lookups =
        |estimator: &str| second(&rows, estimator).experiment.predicted_lookups.expect("known");
    assert!(lookups("spectral-tracking (exact shadow, maximum)") < lookups("hero (exact shadow)"));
}

/// Moments of all channels by one estimator of [`WITHOUT`], see `tests/data/README.md`.
#[derive(Deserialize)]
struct Moments {
    estimator: String,
    mean: Vec<f64>,
    variance: Vec<f64>,
    third: Vec<f64>,
    fourth: Vec<f64>,
    covariance: Vec<f64>,
    lookups: f64,
    lookups_variance: f64,
}

#[test]
fn moments_relative_to_one_walker_are_those_of_the_references() {
    let references: Vec<Moments> =
        serde_json::from_str(include_str!("../data/spectral-single-scattering.json"))
            .expect("the references");
    assert_eq!(references.len(), 5);
    let rows = predicted(WITHOUT);
    for reference in references {
        let own = rows.iter().filter(|row| row.experiment.label == reference.estimator);
        assert_eq!(own.clone().count(), 3, "{}", reference.estimator);
        for (channel, row) in own.enumerate() {
            let [_, third, fourth] = row.relative_moments;
            let mut pairs = vec![
                (row.truth, reference.mean[channel]),
                (row.predicted_variance, reference.variance[channel]),
                (third, reference.third[channel]),
                (fourth, reference.fourth[channel]),
                (row.experiment.predicted_lookups, reference.lookups),
                (row.experiment.lookups_variance, reference.lookups_variance),
            ];
            let found = row.experiment.lookups_variance.expect("known");
            let stated = row.experiment.lookups_moments_error.expect("stated");
            let off = (found / reference.lookups_variance - 1.0).abs();
            assert!(off <= stated && stated < 1e-6, "{}: {off:e} {stated:e}", reference.estimator);
            if let Some(&covariance) = reference.covariance.get(channel) {
                pairs.push((row.covariance, covariance));
            }
            for (i, (found, expected)) in pairs.into_iter().enumerate() {
                let found = found.expect("known");
                let off = (found / expected - 1.0).abs();
                assert!(off < 1e-9, "{}, {channel}, {i}: {found}", reference.estimator);
            }
        }
    }
}

/// If one channel walks alone, all estimators are delta tracking.
#[test]
fn one_channel_is_delta_tracking() {
    let alone = predicted(SECOND);
    let text = "title = \"green\"
        [problem.single-scattering]
        volume = [{ constant = { extinction = 0.8, bounds.sphere = { centre = [0, 0, 0], radius = 1 } } }]
        ray = { origin = [0.2, 0.1, -2], direction = [0, 0, 1], length = 4 }
        light = { position = [0.9, -0.3, 0.4], power = 10 }
        albedos = [0.5]
        phases = [{ isotropic = {} }]
        sampling.constant.value = 1
        estimators = [{ hero = {} }, { hero = { shadow = \"ratio\" } }, { spectral-tracking = {} },
            { spectral-tracking = { probabilities = \"maximum\", shadow = \"ratio\" } }]";
    for (row, number) in predicted(text).iter().zip([0, 1, 0, 1]) {
        let own = &alone[number];
        assert_eq!(row.truth, own.truth);
        let lookups = [row.experiment.predicted_lookups, own.experiment.predicted_lookups]
            .map(|x| x.expect("known"));
        let variance = [row.predicted_variance, own.predicted_variance].map(|x| x.expect("known"));
        for [found, expected] in [lookups, variance] {
            assert!((found / expected - 1.0).abs() < 1e-10, "{}: {found}", row.experiment.label);
        }
    }
}

/// Light that is almost never found is no reason to fail: it is behind a wall that one hero in 1e8 passes, and pilots
/// do not find it.
#[test]
fn what_lies_behind_a_wall_fails_no_correct_estimator() {
    let layers = |values: &str| {
        format!(
            "{{ piecewise-constant = {{ breaks = [-1, -0.5, 0, 1], values = {values}, \
             bounds.sphere = {{ centre = [0, 0, 0], radius = 1 }} }} }}"
        )
    };
    let text = format!(
        "title = \"a wall\"
        [problem.single-scattering]
        volume = [{}, {}]
        ray = {{ origin = [0.2, 0.1, -2], direction = [0, 0, 1], length = 4 }}
        light = {{ position = [0.9, -0.3, 0.4], power = 10 }}
        albedos = [1, 1]
        phases = [{{ isotropic = {{}} }}, {{ isotropic = {{}} }}]
        sampling.constant.value = 600
        estimators = [{{ spectral-mis = {{}} }}]",
        layers("[1e-8, 1e-8, 1e-8]"),
        layers("[1, 600, 1]")
    );
    for row in rows(&text, 400_000) {
        assert_ne!(row.verdict, Some(Verdict::Fail), "{}: {}", row.channel, row.reason());
    }
}

/// A hero with a tenth of the scattering of another channel, everywhere, has a finite variance, however thin both are.
#[test]
fn thin_tails_of_two_colours_are_no_reason_to_refuse() {
    let volume = [1.0, 0.1].map(|peak: f64| {
        format!(
            "{{ gaussian = {{ peak = {peak:?}, centre = [0, 0, 0], width = 0.16, \
             bounds.sphere = {{ centre = [0, 0, 0], radius = 1 }} }} }}"
        )
    });
    let rows = predicted(&format!(
        "title = \"tails\"\n[problem.single-scattering]\nvolume = [{}, {}]\n\
         ray = {{ origin = [0, 0, -2], direction = [0, 0, 1], length = 4 }}\n\
         light = {{ position = [0.9, -0.3, 0.4], power = 10 }}\nalbedos = [0.7, 0.8]\n\
         phases = [{{ isotropic = {{}} }}, {{ isotropic = {{}} }}]\nsampling.constant.value = 1.6\n\
         estimators = [{{ hero = {{}} }}]\n",
        volume[0], volume[1]
    ));
    for row in &rows {
        assert!(row.predicted_variance.is_some_and(f64::is_finite), "{}", row.reason());
    }
}

/// Pairs of fields in a ball or a box, of every cost, with both forms of shadow rays, some of which miss the medium.
#[test]
fn walks_side_by_side_are_walks_one_by_one() {
    const BALL_OF: &str = "bounds.sphere = { centre = [0, 0, 0], radius = 1 }";
    const BOX_OF: &str = "bounds.box = { low = [-1, -0.8, -1], high = [1, 0.9, 0.7] }";
    const FIELDS: [&str; 5] = [
        "constant = { extinction = 2.1,",
        "gaussian = { peak = 1.9, centre = [0.5, 0, 0], width = 0.8,",
        "noise = { extinction = 2, octaves = 2, seed = 3,",
        "piecewise-linear = { knots = [-1, 0, 1], values = [0.8, 0.1, 1.9],",
        "grid = { random = { size = [3, 4, 3], seed = 5 }, extinction = 1.5,",
    ];
    let mut cases = vec![case("ball", BALL), case("without", WITHOUT)];
    for (body, bounds) in [BALL_OF, BOX_OF].into_iter().enumerate() {
        // Grids exist in boxes only.
        let fields = if body == 0 { &FIELDS[..4] } else { &FIELDS };
        for first in 0..fields.len() {
            let other = (first + 1 + body) % fields.len();
            let volume = |field: usize| format!("{{ {} {bounds} }} }}", fields[field]);
            let [one, two] = [first, other].map(volume);
            let light = if first % 2 == 0 { "[0.9, -0.3, 0.4]" } else { "[-2, 1.5, -4]" };
            let text = format!(
                "title = \"walks\"\n[problem.single-scattering]\nvolume = [{one}, {two}]
                ray = {{ origin = [0.3, 0.2, -3], direction = [0.1, 0, 1], length = 9 }}
                light = {{ position = {light}, power = 10 }}\nalbedos = [0.95, 0.4]
                phases = [{{ henyey-greenstein = {{ g = -0.7 }} }}, {{ rayleigh = {{}} }}]
                sampling.constant.value = 2.1
                estimators = [{{ independent = {{}} }}, {{ spectral-mis = {{}} }},
                    {{ independent = {{ shadow = \"ratio\", hero = [0.2, 0.8] }} }},
                    {{ spectral-mis = {{ shadow = \"ratio\" }} }},
                    {{ spectral-mis = {{ shadow = \"ratio\", hero = [0.7, 0.3],
                        sampling = [{{ constant.value = 2.5 }}, {{ constant.value = 2.2 }}] }} }},
                    {{ hero = {{ hero = [0.6, 0.4], sampling.constant.value = 2.9 }} }},
                    {{ hero = {{ shadow = \"ratio\",
                        sampling = [{{ constant.value = 2.5 }}, {{ constant.value = 2.2 }}] }} }},
                    {{ spectral-tracking = {{}} }},
                    {{ spectral-tracking = {{ probabilities = \"maximum\", shadow = \"ratio\" }} }},
                    {{ spectral-tracking = {{ probabilities = \"history\", shadow = \"ratio\" }} }}]"
            );
            cases.push(case(&format!("{first} and {other}, body {body}"), &text));
        }
    }
    compare(&cases, 89);
}
