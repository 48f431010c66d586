//! Lookups before the first draw of a ray, their share in figures of merit, and knowledge that costs no lookups.

use crate::common::{differs, none, options, predicted, row, rows, source};
use trueflight::case::Case;
use trueflight::estimators::Knowledge;
use trueflight::plan::Plan;
use trueflight::record::Row;
use trueflight::record::build;
use trueflight::report::layout::Pen;
use trueflight::report::run::console::{self, TableView};
use trueflight::report::run::summary_csv as tables;

/// Returns the central ray of Eq. 21, with more keys of the case and its estimators.
fn eq21(head: &str, more: &str, estimators: &str) -> String {
    format!(
        "title = \"costs\"\n{head}\n[problem.transmittance]\nvolume.eq21 = {{}}\n\
         ray = {{ origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }}\n{more}\n\
         estimators = [{estimators}]"
    )
}

const EXPLORERS: &str =
    "{ double = { sampling.constant.value = 0.4, control.explorers.points = 20 } }";

/// Returns `1/(V · (N + S/n))`.
fn merit(row: &Row, draws_per_ray: f64) -> f64 {
    let [variance, lookups] =
        [row.predicted_variance, row.experiment.predicted_lookups].map(|x| x.expect("known"));
    let setup = row.experiment.setup_lookups.expect("counted") as f64;
    1.0 / (variance * (lookups + setup / draws_per_ray))
}

#[test]
fn explorer_lookups_are_charged_to_the_draws_of_a_ray() {
    let mut wrong = Vec::new();
    for (head, draws) in [("", 1.0), ("draws_per_ray = 1", 1.0), ("draws_per_ray = 16", 16.0)] {
        let rows = predicted(&eq21(head, "", EXPLORERS));
        // ∫σ̂ = 0.4 · 20 lookups per draw, and one at each explorer point.
        assert_eq!(rows[0].experiment.setup_lookups, Some(20), "{head}");
        wrong.extend(differs(
            "lookups",
            rows[0].experiment.predicted_lookups.expect("known"),
            8.0,
            1e-12,
        ));
        let fom = rows[0].predicted_fom.expect("a figure of merit");
        wrong.extend(differs(head, fom, merit(&rows[0], draws), 1e-12));
        let ltuv = rows[0].predicted_log10_ltuv().expect("LTUV");
        wrong.extend(differs(head, ltuv, -fom.log10(), 1e-12));
    }
    none(&wrong);
}

#[test]
fn the_measured_figure_of_merit_charges_them_too() {
    for (head, draws) in [("", 1.0), ("draws_per_ray = 5", 5.0)] {
        let row = &rows(&eq21(head, "", EXPLORERS), 20_000)[0];
        let [variance, lookups, fom] =
            [row.variance, row.experiment.lookups_per_draw, row.fom].map(|x| x.expect("measured"));
        let expected = 1.0 / (variance * (lookups + 20.0 / draws));
        none(&differs(head, fom, expected, 1e-12).into_iter().collect::<Vec<_>>());
    }
}

#[test]
fn what_looks_nothing_up_before_pays_nothing() {
    let estimators = "{ ratio = {} }, { residual-ratio = {} }, { double.control.constant.value = 0.1 }, \
                      { double.control.none = {} }, { double.control.field.volume.eq21 = {} }, \
                      { decomposition = { control.minimum = {}, sampling.constant.value = 1.1 } }, \
                      { local-majorant.sampling.local-majorants.segments = 8 }, { closed-form = {} }";
    let rows = predicted(&eq21("draws_per_ray = 3", "sampling.constant.value = 0.7", estimators));
    for row in &rows {
        assert_eq!(
            row.experiment.setup_lookups,
            Some(0),
            "{} {}",
            row.experiment.label,
            row.experiment.id.control
        );
    }
    let ratio = row(&rows, "ratio");
    assert_eq!(ratio.predicted_fom, Some(merit(ratio, 1.0)));
}

#[test]
fn a_sweep_of_explorer_points_charges_each_number() {
    let estimators = "{ double = { sampling.constant.value = 0.5, control.explorers.points = 3 } }";
    let rows = predicted(&eq21("", "sweep.points.values = [2, 7, 40]", estimators));
    let counts: Vec<_> = rows.iter().map(|row| row.experiment.setup_lookups).collect();
    assert_eq!(counts, [Some(2), Some(7), Some(40)]);
    for row in &rows {
        assert_eq!(row.predicted_fom, Some(merit(row, 1.0)));
    }
    // A ray that misses the medium has no explorer points.
    let missed = eq21("", "", EXPLORERS).replace("origin = [0, 0, 0]", "origin = [0, 50, 0]");
    assert_eq!(predicted(&missed)[0].experiment.setup_lookups, Some(0));
}

#[test]
fn pilot_rays_look_up_where_they_collide() {
    // The first pilot ray is a Poisson process of rate σ̂ = 2 on a ray of length 5: 10 lookups on average.
    let text = "title = \"pilots\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\n\
                span = [0, 5]\nsampling.pilot = { rays = 1, start = 2 }\n\
                estimators = [{ ratio = {} }, { double = {} }]";
    let seeds = 400;
    let mut sum = 0;
    for seed in 0..seeds {
        let cases = [Case::read(&source("pilots", text)).expect("a case")];
        let record = build::predicted(&Plan::new(&cases, &options(seed, 1000)));
        let rows = record.results.cases[0].rows().collect::<Vec<_>>();
        for row in &rows {
            assert!(
                row.predicted_fom.is_none_or(|fom| fom == merit(row, 1.0)),
                "{}",
                row.experiment.label
            );
        }
        sum += rows[0].experiment.setup_lookups.expect("counted");
    }
    let mean = sum as f64 / f64::from(u32::try_from(seeds).expect("few"));
    // Five standard errors.
    assert!((mean - 10.0).abs() < 5.0 * (10.0_f64 / 400.0).sqrt(), "{mean}");
}

#[test]
fn what_no_lookup_pays_for_has_a_name() {
    let estimators = "{ residual-ratio = {} }, { double.control.mean = {} }, { closed-form = {} }, \
                      { decomposition = { control.minimum = {}, sampling.constant.value = 1.1 } }, \
                      { local-majorant.sampling.local-majorants.segments = 8 }, \
                      { double = { control.mean = {}, sampling.local-majorants.segments = 8 } }, \
                      { ratio = {} }, { residual-ratio.control.constant.value = 0.1 }";
    let rows = predicted(&eq21("", "sampling.constant.value = 0.7", estimators));
    let needs: Vec<String> =
        rows.iter().map(|row| Knowledge::list(&row.experiment.needs)).collect();
    let both = "τ, max |σ_t − σ_c|";
    assert_eq!(needs, ["τ", "τ", "τ", "min σ_t", "max |σ_t − σ_c|", both, "", ""]);
    // A swept control or σ̂ replaces the recipe.
    let swept = eq21(
        "",
        "sampling.constant.value = 0.7\nsweep.control.values = [0, 0.1]",
        "{ residual-ratio = {} }",
    );
    assert!(predicted(&swept).iter().all(|row| row.experiment.needs.is_empty()));
    let swept = eq21(
        "",
        "sampling.local-majorants.segments = 4\nsweep.sampling.values = [1, 2]",
        "{ ratio = {} }",
    );
    assert!(predicted(&swept).iter().all(|row| row.experiment.needs.is_empty()));
    // A table of predictions shows it.
    let cases =
        [Case::read(&source("needs", &eq21("", "sampling.constant.value = 0.7", estimators)))
            .expect("a case")];
    let record = build::predicted(&Plan::new(&cases, &options(1, 1000)));
    let table = console::table(&record, TableView::Predict, Pen { width: 120, colour: false });
    let line = |name: &str| table.lines().find(|line| line.starts_with(name)).expect("a line");
    assert!(table.contains("needs") && line("closed-form").contains('τ'), "{table}");
    assert!(!line("ratio").contains('τ'), "{table}");
}

#[test]
fn exact_transmittances_need_tau() {
    let lit = |estimator: &str| {
        let text = format!(
            "title = \"lit\"\n[problem.single-scattering]\nvolume.constant = {{ extinction = 0.8 }}\n\
             ray = {{ origin = [0, 0, 0], direction = [1, 0, 0], length = 2 }}\n\
             light.position = [1, 1, 0]\nalbedo = 0.9\nphase.isotropic = {{}}\nsampling.constant.value = 1.2\nestimators = [{{ {estimator} }}]"
        );
        Knowledge::list(&predicted(&text)[0].experiment.needs)
    };
    assert_eq!(lit("delta-tracking = {}"), "τ");
    assert_eq!(lit("delta-tracking.shadow.ratio.sampling = 1.2"), "");
    assert_eq!(lit("source-driven.shadow.ratio.sampling = 1.2"), "τ");
    assert_eq!(lit("source-driven = { camera = \"ratio\", shadow.ratio.sampling = 1.2 }"), "");
    let flights = "title = \"flight\"\n[problem.free-flight]\nmedium.constant.extinction = 0.5\n\
                   span = [0, 4]\nsampling.constant.value = 1\n\
                   estimators = [{ inversion = {} }, { woodcock = {} }]";
    let needs: Vec<String> =
        predicted(flights).into_iter().map(|row| Knowledge::list(&row.experiment.needs)).collect();
    assert_eq!(needs, ["inverse of τ", ""]);
}

#[test]
fn files_gain_columns_at_their_end() {
    let cases =
        [Case::read(&source("columns", &eq21("draws_per_ray = 4", "", EXPLORERS)))
            .expect("a case")];
    let record = build::predicted(&Plan::new(&cases, &options(1, 1000)));
    let csv = tables::csv(&record).expect("renders");
    let lines: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let last = ["setup_lookups", "draws_per_ray", "needs", "best_kind", "best_limit"];
    let begin = lines[0].iter().position(|name| *name == last[0]).expect("the column");
    assert_eq!(lines[0][begin - 1], "predicted_log10_ltuv");
    assert_eq!(lines[0][begin..begin + 5], last);
    assert_eq!(lines[1][begin..begin + 5], ["20", "4", "", "", ""]);
}
