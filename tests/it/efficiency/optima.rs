//! The best constant σ̂: an optimum, or a share of a limit that a rising figure of merit never reaches.

use std::f64::consts::PI;

use crate::common::{case, differs, none, options, with_optima};
use trueflight::numeric::digits;
use trueflight::plan::Plan;
use trueflight::record::build;
use trueflight::record::{Record, Row};
use trueflight::report::layout::{self, Pen};
use trueflight::report::run::console::{self, TableView};
use trueflight::report::run::sweep_plot;
use trueflight::theory::prediction::search::PlaceKind;

fn record(text: &str) -> Record {
    let cases = [case("test", text)];
    build::predicted_with_optima(&Plan::new(&cases, &options(1, 1000)))
}

/// Returns the kind of the best σ̂; `None` if it was not searched.
fn kind(row: &Row) -> Option<PlaceKind> {
    row.best.as_ref().map(|best| best.kind)
}

/// Returns a homogeneous line of length 4 with σ_t = 1/2, for some estimators.
fn line(more: &str, estimators: &str) -> String {
    format!(
        "title = \"a line\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\nspan = [0, 4]\n\
         {more}\nestimators = [{estimators}]"
    )
}

/// Returns the root of a decreasing function between two places.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn a_rising_figure_of_merit_has_a_limit_and_no_optimum() {
    // V = T²(e^y − 1), y = ∫(σ_t − σ_c)²/σ̂, N = 4σ̂: FoM = y/(e^y − 1) of the limit 1/(T² · 4 ∫(σ_t − σ_c)²).
    for (estimator, residual) in
        [("ratio = {}", 0.5_f64), ("double.control.constant.value = 0.3", 0.2)]
    {
        let rows =
            with_optima(&line("sampling.constant.value = 50", &format!("{{ {estimator} }}")));
        let square = 4.0 * residual * residual;
        let t = (-2f64).exp();
        let limit = 1.0 / (t * t * 4.0 * square);
        let y = root(1e-3, 5.0, |y| y / y.exp_m1() - 0.9);
        let row = &rows[0];
        assert_eq!(kind(row), Some(PlaceKind::NearLimit), "{estimator}");
        let found =
            [row.best_limit(), row.best_fom(), row.best_sampling()].map(|x| x.expect("found"));
        let expected = [limit, 0.9 * limit, square / y];
        let names = ["limit", "figure of merit", "σ̂"];
        let wrong = names.iter().zip(found.into_iter().zip(expected));
        let wrong: Vec<_> = wrong
            .filter_map(|(name, (found, expected))| differs(name, found, expected, 1e-5))
            .collect();
        none(&wrong);
        // The row at σ̂ = 50 is above the best row, and below the limit.
        let at_fifty = row.predicted_fom.expect("known");
        assert!(at_fifty > found[1] && at_fifty < found[0], "{at_fifty}");
    }
}

#[test]
fn setup_lookups_move_the_best_sampling_extinction() {
    // Explorers at both ends of whole periods: the control is the mean, the residual a sine, ∫residual² = a²ℓ/2 over
    // ℓ = 2π. FoM = 1/(T²(e^y − 1)(σ̂ℓ + 2/n)), y = a²ℓ/(2σ̂).
    let (base, a, length) = (0.6_f64, 0.3_f64, 2.0 * PI);
    for draws in [1.0_f64, 8.0] {
        let rows = with_optima(&format!(
            "title = \"waves\"\ndraws_per_ray = {draws}\n[problem.transmittance]\n\
             medium.sines = {{ base = {base}, amplitudes = [{a}], frequencies = [1] }}\n\
             span = [0, {length}]\nsampling.constant.value = 1\n\
             estimators = [{{ double.control.explorers.points = 2 }}]"
        ));
        let square = a * a * length / 2.0;
        let t = (-base * length).exp();
        let fom = |sampling: f64| {
            1.0 / (t * t * (square / sampling).exp_m1() * (sampling * length + 2.0 / draws))
        };
        let limit = 1.0 / (t * t * square * length);
        let best = root(1e-3, 1e3, |sampling| 0.9 * limit - fom(sampling));
        let row = &rows[0];
        assert_eq!(
            (row.experiment.setup_lookups, kind(row)),
            (Some(2), Some(PlaceKind::NearLimit))
        );
        let found =
            [row.best_limit(), row.best_sampling(), row.predicted_fom].map(|x| x.expect("found"));
        let wrong: Vec<_> = ["limit", "σ̂", "at 1"]
            .iter()
            .zip(found.into_iter().zip([limit, best, fom(1.0)]))
            .filter_map(|(name, (found, expected))| differs(name, found, expected, 1e-5))
            .collect();
        none(&wrong);
    }
}

#[test]
fn a_thin_medium_reaches_its_limit_below_the_search() {
    // y = σ_t²ℓ/σ̂ = 0.2069… at 90 %: σ̂ = 1e-4 · 1e-4 · 1/0.2069…, far below 1e-2 σ_t.
    let text = "title = \"thin\"\n[problem.transmittance]\nmedium.constant.extinction = 1e-4\nspan = [0, 1]\n\
                sampling.constant.value = 1\nestimators = [{ ratio = {} }]";
    let row = &with_optima(text)[0];
    let y = root(1e-3, 5.0, |y| y / y.exp_m1() - 0.9);
    assert_eq!(kind(row), Some(PlaceKind::NearLimit));
    none(
        &differs("σ̂", row.best_sampling().expect("found"), 1e-8 / y, 1e-4)
            .into_iter()
            .collect::<Vec<_>>(),
    );
}

#[test]
fn where_collisions_are_too_many_the_limit_is_named_all_the_same() {
    let text = "title = \"thick\"\n[problem.transmittance]\n\
                medium.piecewise-constant = { breaks = [0, 1, 2000], values = [1, 1e-3] }\nspan = [0, 2000]\n\
                sampling.constant.value = 2\nestimators = [{ ratio = {} }]";
    let row = &with_optima(text)[0];
    // ∫σ_t² = 1 + 1999e-6, τ = 1 + 1.999.
    let (square, t) = (1.0 + 1999e-6_f64, (-2.999_f64).exp());
    assert_eq!(kind(row), Some(PlaceKind::NearLimit));
    let limit = 1.0 / (t * t * 2000.0 * square);
    none(
        &differs("limit", row.best_limit().expect("found"), limit, 1e-3)
            .into_iter()
            .collect::<Vec<_>>(),
    );
}

#[test]
fn an_optimum_is_called_one() {
    let rows = with_optima(&line(
        "sampling.constant.value = 1",
        "{ woodcock = {} }, { closed-form = {} }",
    ));
    assert_eq!((kind(&rows[0]), rows[0].best_limit()), (Some(PlaceKind::Optimum), None));
    // An estimator without σ̂ has no best σ̂.
    let none = (rows[1].best_sampling(), rows[1].best_fom(), kind(&rows[1]));
    assert_eq!(none, (None, None, None));
}

#[test]
fn without_a_variance_there_is_no_best() {
    // Theory has only a bound on the variance of Russian roulette.
    let text = "title = \"a rod\"\n[problem.rod]\nmedium.constant.extinction = 0.5\nspan = [0, 4]\nalbedo = 0.7\n\
                forward = 0.5\nsampling.constant.value = 1\nestimators = [{ roulette = {} }]";
    for row in with_optima(text) {
        assert_eq!((row.best_sampling(), kind(&row)), (None, None), "{}", row.channel);
    }
}

#[test]
fn tables_say_what_the_best_is_however_narrow() {
    let text = line("sampling.constant.value = 50", "{ ratio = {} }, { woodcock = {} }");
    let limit = 1.0 / ((-4f64).exp() * 4.0);
    for width in [60, 80, 100, 120, 200] {
        for view in [TableView::Predict, TableView::Moments] {
            let table = console::table(&record(&text), view, Pen { width, colour: false });
            assert!(table.lines().all(|line| layout::width(line) <= width), "{table}");
            let one_line = table.split_whitespace().collect::<Vec<_>>().join(" ");
            let note = format!("is 90 % of the limit; the limit is {},", digits::short(limit, 4));
            assert!(one_line.contains(&note) && one_line.contains("(optimum)"), "{table}");
            // If the column is wide enough its values are marked.
            let mut heads = table.lines().filter(|line| line.starts_with("estimator"));
            let has_column = heads.any(|line| line.contains("best σ\u{302}"));
            assert_eq!(has_column, table.contains(" (90 %)"), "{width}: {table}");
        }
    }
}

#[test]
fn plots_have_a_filled_star_for_an_optimum_and_a_hollow_one_for_a_limit() {
    let plot = |estimators: &str, values: &str| -> String {
        let cases = [case("test", &line(&format!("sweep.sampling.values = {values}"), estimators))];
        let plan = Plan::new(&cases, &options(1, 1000));
        let mut record = build::predicted(&plan);
        build::add_curves(&plan, &mut record);
        let artifacts = sweep_plot::render(&record).expect("renders");
        let svg = artifacts.into_iter().find(|a| a.path.ends_with("test.svg")).expect("a plot");
        String::from_utf8(svg.bytes).expect("text")
    };
    // The key above the panel and the note below it.
    let has_star = |svg: &str, key: &str| svg.contains(&format!(">{key}<"));
    let [optimum, limit] = ["predicted optimum", "90 % of the limit"];
    let both = "{ ratio = {} }, { woodcock = {} }";
    let all = plot(both, "[0.4, 0.6, 8]");
    assert!(has_star(&all, optimum) && has_star(&all, limit), "both stars");
    assert!(all.contains("ratio rises to 13.65, 90 % of the limit at σ\u{302} = 4.8"), "{all}");
    let only = plot("{ ratio = {} }", "[0.4, 0.6, 8]");
    assert!(!has_star(&only, optimum) && has_star(&only, limit), "hollow only");
    let only = plot("{ woodcock = {} }", "[0.4, 0.6, 8]");
    assert!(has_star(&only, optimum) && !only.contains("90 % of"), "filled only");
    // σ̂ = 4.8 is the best of ratio, σ̂ = 0.5 that of woodcock: neither is in this sweep.
    let outside = plot(both, "[1, 2]");
    assert!(!has_star(&outside, optimum) && !has_star(&outside, limit), "no star");
    let note = "woodcock: optimum at σ\u{302} = 0.5, outside of the panel";
    assert!(outside.contains(note), "{outside}");
}
