//! Sweeps of the medium: at every value a case equals one with its numbers written out.

use trueflight::case::sweep::SweptQuantity;
use trueflight::catalogue::Page;
use trueflight::catalogue::own_pages;
use trueflight::media;
use trueflight::plan::Plan;
use trueflight::recipes::{controls, sampling};
use trueflight::record::build;
use trueflight::record::curves;
use trueflight::record::{Row, Verdict};

use crate::common::{case, failing, none, options, predicted, rows};

/// Case with a sweep, and equal cases without it for some of its values.
type Written = (&'static str, &'static str, &'static [(f64, &'static str)]);

const WRITTEN: [Written; 6] = [
    (
        "transmittance]\nmedium.exponential = { extinction = 1.5, rate = 0.5, base = 0.25 }\nspan = [0, 2]\n\
         sampling.piecewise-linear = { knots = [0, 2], values = [2, 1] }\ncontrol.constant.value = 0.5\n",
        "density.values = [0.5, 2]\nestimators = [{ ratio = {} }, { residual-ratio = {} }, \
         { woodcock.sampling.constant.value = 2 }]",
        &[(
            0.5,
            "transmittance]\nmedium.exponential = { extinction = 0.75, rate = 0.5, base = 0.125 }\nspan = [0, 2]\n\
             sampling.piecewise-linear = { knots = [0, 2], values = [1, 0.5] }\ncontrol.constant.value = 0.25\n\
             estimators = [{ ratio = {} }, { residual-ratio = {} }, { woodcock.sampling.constant.value = 1 }]",
        )],
    ),
    (
        "transmittance]\nvolume.gaussian = { peak = 1, centre = [0, 0, 2], width = 0.7 }\n\
         ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }\nsampling.constant.value = 1.25\n\
         control.field.volume.radial = { centre = [0, 0, 2], radius = 2, coefficients = [0.5, -0.5] }\n",
        "density.values = [2, 3]\nestimators = [{ double = {} }]",
        &[(
            3.0,
            "transmittance]\nvolume.gaussian = { peak = 3, centre = [0, 0, 2], width = 0.7 }\n\
             ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 4 }\nsampling.constant.value = 3.75\n\
             control.field.volume.radial = { centre = [0, 0, 2], radius = 2, coefficients = [1.5, -1.5] }\n\
             estimators = [{ double = {} }]",
        )],
    ),
    (
        "transmittance]\nmedium = [\n\
         { piecewise-constant = { breaks = [0, 1, 2], values = [1, 0.2] } },\n\
         { piecewise-constant = { values = [0.2, 0.4], breaks = [0, 1, 2] } },\n]\nspan = [0, 2]\n\
         sampling = [{ constant.value = 1.2 }, { constant.value = 0.6 }]\n",
        "contrast.values = [0, 0.5, 1]\nestimators = [{ spectral-mis.collisions = \"delta\" }, \
         { independent.sampling = [{ constant.value = 2 }, { constant.value = 1 }] }, \
         { spectral-tracking.sampling.constant.value = 1.2 }]",
        &[
            (
                0.0,
                "transmittance]\nmedium = [\n\
                 { piecewise-constant = { breaks = [0, 1, 2], values = [0.6, 0.3] } },\n\
                 { piecewise-constant = { breaks = [0, 1, 2], values = [0.6, 0.3] } },\n]\nspan = [0, 2]\n\
                 sampling = [{ constant.value = 0.9 }, { constant.value = 0.9 }]\n\
                 estimators = [{ spectral-mis.collisions = \"delta\" }, \
                 { independent.sampling = [{ constant.value = 1.5 }, { constant.value = 1.5 }] }, \
                 { spectral-tracking.sampling.constant.value = 0.9 }]",
            ),
            (
                0.5,
                "transmittance]\nmedium = [\n\
                 { piecewise-constant = { breaks = [0, 1, 2], values = [0.8, 0.25] } },\n\
                 { piecewise-constant = { breaks = [0, 1, 2], values = [0.4, 0.35] } },\n]\nspan = [0, 2]\n\
                 sampling = [{ constant.value = 1.05 }, { constant.value = 0.75 }]\n\
                 estimators = [{ spectral-mis.collisions = \"delta\" }, \
                 { independent.sampling = [{ constant.value = 1.75 }, { constant.value = 1.25 }] }, \
                 { spectral-tracking.sampling.constant.value = 1.05 }]",
            ),
        ],
    ),
    (
        "rod]\nmedium.constant.extinction = 1\nspan = [0, 1.5]\nalbedos = [0.8, 0.4, 0.6]\n\
         sampling.constant.value = 1.2\n",
        "contrast.values = [0.5, 1]\nestimators = [{ spectral-mis = {} }, { spectral-tracking = {} }]",
        &[(
            0.5,
            "rod]\nmedium.constant.extinction = 1\nspan = [0, 1.5]\nalbedos = [0.7, 0.5, 0.6]\n\
             sampling.constant.value = 1.2\nestimators = [{ spectral-mis = {} }, { spectral-tracking = {} }]",
        )],
    ),
    (
        "rod]\nlight = 'emitter'\nmedium = [{ constant.extinction = 1 }, { constant.extinction = 0.5 }]\nspan = [0, 2]\n\
         albedos = [{ piecewise-constant = { breaks = [0, 1, 2], values = [1, 0.5] } }, \
         { piecewise-linear = { knots = [0, 2], values = [0.2, 0.8] } }]\nsampling.constant.value = 1.2\n",
        "albedo-scale.values = [0.5, 1]\nestimators = [{ independent = {} }]",
        &[(
            0.5,
            "rod]\nlight = 'emitter'\nmedium = [{ constant.extinction = 1 }, { constant.extinction = 0.5 }]\nspan = [0, 2]\n\
             albedos = [{ piecewise-constant = { breaks = [0, 1, 2], values = [0.5, 0.25] } }, \
             { piecewise-linear = { knots = [0, 2], values = [0.1, 0.4] } }]\nsampling.constant.value = 1.2\n\
             estimators = [{ independent = {} }]",
        )],
    ),
    (
        "rod]\nlight = 'emitter'\nmedium.constant.extinction = 1\nspan = [0, 2]\nalbedo = 0.9\nsampling.constant.value = 1.5\n",
        "albedo-scale.values = [0.5]\nestimators = [{ unidirectional = {} }, { full-mis = {} }]",
        &[(
            0.5,
            "rod]\nlight = 'emitter'\nmedium.constant.extinction = 1\nspan = [0, 2]\nalbedo = 0.45\nsampling.constant.value = 1.5\n\
             estimators = [{ unidirectional = {} }, { full-mis = {} }]",
        )],
    ),
];

fn titled(text: &str) -> String {
    format!("title = \"a sweep\"\n[problem.{text}")
}

/// Returns the prediction of a row.
fn theory(row: &Row) -> (String, String, [Option<f64>; 4]) {
    let lookups = row.experiment.predicted_lookups;
    let numbers = [row.truth, row.predicted_variance, lookups, row.predicted_kurtosis];
    (row.experiment.label.clone(), row.channel.clone(), numbers)
}

#[test]
fn a_swept_medium_is_the_one_that_is_written_out() {
    let mut count = 0;
    for (head, sweep, written) in WRITTEN {
        let swept = predicted(&titled(&format!("{head}sweep.{sweep}")));
        for (value, text) in written {
            let at: Vec<_> = swept
                .iter()
                .filter(|row| row.experiment.swept() == Some(*value))
                .map(theory)
                .collect();
            let own: Vec<_> = predicted(&titled(text)).iter().map(theory).collect();
            assert!(own.iter().all(|(_, _, numbers)| numbers[0].is_some() && numbers[1].is_some()));
            assert_eq!(at, own, "{head} at {value}");
            count += own.len();
        }
    }
    assert_eq!(count, 38);
}

#[test]
fn the_whole_numbers_of_a_sweep_leave_a_case_as_it_is() {
    for (head, sweep, _) in WRITTEN {
        let (what, rest) = sweep.split_once('.').expect("a sweep");
        let (_, estimators) = rest.split_once('\n').expect("estimators");
        let swept = predicted(&titled(&format!("{head}sweep.{what}.values = [1]\n{estimators}")));
        let plain = predicted(&titled(&format!("{head}{estimators}")));
        let of = |rows: &[Row]| rows.iter().map(theory).collect::<Vec<_>>();
        assert_eq!(of(&swept), of(&plain), "{head}");
    }
}

#[test]
fn swept_media_are_drawn_as_predicted() {
    for ((head, sweep, _), draws) in [(WRITTEN[0], 2_000_000), (WRITTEN[2], 400_000)] {
        none(&failing(&rows(&titled(&format!("{head}sweep.{sweep}")), draws)));
    }
}

#[test]
fn the_lines_of_theory_go_through_the_experiments_and_between_them() {
    let (head, sweep, _) = WRITTEN[2];
    let cases = [case("test", &titled(&format!("{head}sweep.{sweep}")))];
    let options = options(1, 1000);
    let record = build::predicted(&Plan::new(&cases, &options));
    let case = &record.results.cases[0];
    assert_eq!(case.sweep.as_ref().map(|sweep| sweep.what), Some(SweptQuantity::Contrast));
    let curves = curves::curves(&cases[0], options.seed);
    assert_eq!(curves.len(), 9, "three estimators, two channels and the luminance");
    for row in case.rows() {
        let is_own = |curve: &&_| {
            let curve: &trueflight::record::PredictedCurve = curve;
            curve.estimator == row.experiment.label && curve.channel == row.channel
        };
        let curve = curves.iter().find(is_own).expect("a line");
        assert!(curve.points.len() > 40, "{}: {}", curve.estimator, curve.points.len());
        let at = curve
            .points
            .iter()
            .find(|point| Some(point.x) == row.experiment.swept())
            .expect("a point");
        assert_eq!(
            (Some(at.variance), Some(at.lookups)),
            (row.predicted_variance, row.experiment.predicted_lookups)
        );
    }
}

/// Settings of a field, a σ̂ or a control in 1/length that it is not proportional to.
const RATES: [&str; 2] = ["rate", "frequency"];

/// Names of the settings that a page is proportional to.
type Extinctions<'a> = &'a dyn Fn(&str) -> &'static [&'static str];

#[test]
fn every_extinction_of_a_page_is_one_that_sweeps_scale() {
    let fields = |name: &str| media::reader::extinctions(name, &own_pages::NONE);
    let catalogues: [(_, Extinctions); 3] = [
        (media::CATALOGUE.pages, &fields),
        (sampling::CATALOGUE.pages, &sampling::extinctions),
        (controls::CATALOGUE.pages, &controls::extinctions),
    ];
    let mut seen = 0;
    for (catalogue, extinctions) in catalogues {
        for page in catalogue {
            let text = Page::text(page);
            let settings = text.lines().filter(|line| line.contains("| 1/length |"));
            let written = settings.map(|line| line.split('`').nth(1).expect("a name"));
            let mut written: Vec<&str> = written.filter(|name| !RATES.contains(name)).collect();
            let mut scaled = extinctions(&page.name()).to_vec();
            written.sort_unstable();
            scaled.sort_unstable();
            assert_eq!(scaled, written, "{}", page.name());
            seen += scaled.len();
        }
    }
    assert!(seen >= 14, "{seen}");
}

#[test]
fn an_infinite_variance_along_a_sweep_is_refused_where_it_begins() {
    // P_s = 1/2 for any contrast, and E[w²] is that of a rod of albedo a' = (1 + c)²/2, infinite from the length
    // atan2(w, a'/2 − 1)/w, w² = a' − 1, on: 6.96 at c = 0.5, 1.87 at 0.9, π/2 at 1.
    let text = titled(
        "rod]\nmedium.constant.extinction = 1\nspan = [0, 1.5]\nalbedos = [1, 0]\n\
         sampling.constant.value = 1\nsweep.contrast.values = [0, 0.5, 0.9, 1]\n\
         estimators = [{ spectral-tracking = {} }]\n",
    );
    assert!(predicted(&text).iter().all(|row| row.verdict != Some(Verdict::Refused)));
    let longer = text.replace("span = [0, 1.5]", "span = [0, 2]");
    let refused: Vec<f64> = predicted(&longer)
        .iter()
        .filter(|row| row.verdict == Some(Verdict::Refused))
        .filter_map(|row| row.experiment.swept())
        .collect();
    assert_eq!(refused, [0.9, 1.0]);
}
