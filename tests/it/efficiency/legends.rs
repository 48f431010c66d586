//! Every experiment has one entry of its plot's legend, entries are distinct, and a note lists equal lines.

use std::collections::BTreeSet;

use crate::common::{case, none, options, shipped_plan};
use trueflight::case::Case;
use trueflight::drawing::Sheet;
use trueflight::drawing::paint;
use trueflight::drawing::sheet::{Align, Shape};
use trueflight::plan::Plan;
use trueflight::record::build;
use trueflight::record::{CaseRecord, Record, Row};
use trueflight::report::plots::series::{Series, collect};
use trueflight::report::plots::svg;
use trueflight::report::run::sweep_plot;

/// Sizes of the words of legends and of notes.
const LEGEND: f64 = 13.5;
const NOTE: f64 = 12.5;

/// Returns the words of a figure that begin at the left edge, of a size.
fn words(sheet: &Sheet, size: f64) -> Vec<String> {
    let words = sheet.shapes.iter().filter_map(|shape| match shape {
        Shape::Text(label) if label.align == Align::Start && label.size == size => {
            Some(label.text.clone())
        }
        _ => None,
    });
    words.collect()
}

/// Lists the faults of the legend of a case's plot.
fn wrong_in(case: &CaseRecord) -> Vec<String> {
    let mut wrong = Vec::new();
    let Some(sweep) = &case.sweep else { return wrong };
    let mut say = |what: String| wrong.push(format!("{}: {what}", case.name));
    let series = collect(case, sweep);
    let key = |row: &Row| (row.experiment.id.clone(), row.number);
    let shown: Vec<_> = series.iter().flat_map(|one| one.rows.iter().map(key)).collect();
    let all = || series.iter().map(|one| &one.label);
    let labels: BTreeSet<&String> = all().collect();
    if labels.len() != series.len() {
        say(format!("labels are not distinct: {:?}", all().collect::<Vec<_>>()));
    }
    // The rows of an experiment and channel are in one series, and a series has rows of one estimator.
    for one in &series {
        let listed: BTreeSet<_> = one.rows.iter().map(|row| row.experiment.listed).collect();
        if listed.len() > 1 || one.rows.is_empty() {
            say(format!("{} is of the estimators {listed:?}", one.label));
        }
    }
    for row in case.rows() {
        let count = shown.iter().filter(|other| **other == key(&row)).count();
        let has_entry = series.iter().any(|one| {
            one.rows.iter().any(|other| other.experiment.listed == row.experiment.listed)
        });
        let is_crowded = count == 0 && !row.channel.is_empty() && has_entry;
        if count != 1 && !is_crowded {
            say(format!(
                "{} {} at {:?} stands in {count} series",
                row.experiment.label,
                row.channel,
                row.experiment.swept()
            ));
        }
    }
    // The figure shows each entry once, in full.
    let sheet = sweep_plot::figure(case, sweep, 1).expect("a figure");
    let legend = words(&sheet, LEGEND);
    let entries: Vec<String> = series.iter().map(|one| one.entry().label).collect();
    if legend != entries {
        say(format!("the legend shows {legend:?} for {entries:?}"));
    }
    for (a, b) in equal_pairs(&series) {
        let notes = words(&sheet, NOTE).join(" ");
        if !notes.contains(&a) || !notes.contains(&b) || !notes.contains("Equal in theory") {
            say(format!("{a} and {b} have an equal line and no note: {notes}"));
        }
    }
    wrong
}

/// Quantities of the panels, for rows.
const QUANTITIES: [fn(&Row) -> Option<f64>; 3] = [
    |row| row.predicted_variance.filter(|variance| *variance > 0.0),
    |row| row.experiment.predicted_lookups.filter(|lookups| *lookups > 0.0),
    |row| row.predicted_fom,
];

/// Returns pairs of series with equal predictions in one of the panels.
fn equal_pairs(series: &[Series]) -> Vec<(String, String)> {
    let mut pairs = Vec::new();
    for quantity in QUANTITIES {
        let values = |one: &Series| -> Vec<(Option<u64>, f64)> {
            let rows = one.rows.iter();
            rows.filter_map(|row| Some((row.experiment.swept().map(f64::to_bits), quantity(row)?)))
                .collect()
        };
        for (i, a) in series.iter().enumerate() {
            for b in &series[..i] {
                let (a_values, b_values) = (values(a), values(b));
                let same_places = a_values.len() == b_values.len() && !a_values.is_empty();
                let equal = same_places
                    && a_values
                        .iter()
                        .zip(&b_values)
                        .all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() <= 1e-12 * a.1.abs());
                if equal {
                    pairs.push((a.label.clone(), b.label.clone()));
                }
            }
        }
    }
    pairs
}

#[test]
fn every_experiment_of_the_shipped_cases_has_one_entry() {
    let record = build::predicted(shipped_plan());
    let cases = || record.results.cases.iter();
    assert!(cases().filter(|case| case.sweep.is_some()).count() > 40);
    none(&cases().flat_map(wrong_in).collect::<Vec<_>>());
}

fn with_curves(cases: &[Case]) -> Record {
    let plan = Plan::new(cases, &options(1, 1000));
    let mut record = build::predicted(&plan);
    build::add_curves(&plan, &mut record);
    record
}

#[test]
fn lines_of_theory_merge_nothing() {
    let read = |name: &str| {
        let source = trueflight::case::suite::find(name).expect("a built-in case");
        Case::read(&source).expect("it can be read")
    };
    let record =
        with_curves(&["transmittance/decomposition", "transmittance/layers-with-gap"].map(read));
    none(&record.results.cases.iter().flat_map(wrong_in).collect::<Vec<_>>());
    let labels = |index: usize| -> Vec<String> {
        let case = &record.results.cases[index];
        let series = collect(case, case.sweep.as_ref().expect("a sweep"));
        series.iter().map(|one| one.entry().label).collect()
    };
    let expected = [
        "decomposition, σ\u{302} 0.9",
        "decomposition, minimum, σ\u{302} 0.6 (needs min σₜ; not swept)",
        "woodcock (not swept)",
    ];
    assert_eq!(labels(0), expected);
    let gap = labels(1);
    assert_eq!(gap.len(), 12, "{gap:?}");
    let local = "local-majorant, local majorants, 10 segments (needs max |σₜ − σ_c|; not swept)";
    assert!(gap.iter().any(|label| label == local), "{gap:?}");
}

#[test]
fn twins_and_crowds_are_told_apart() {
    let sweep = "sweep.sampling.values = [1, 2]";
    let texts = [
        // Rows with equal labels: controls that are fields with different numbers.
        "estimators = [{ double.control.field.medium.constant.extinction = 0.1 }, \
         { double.control.field.medium.constant.extinction = 0.2 }, { double = {} }, { ratio = {} }, \
         { ratio.sampling.constant.value = 3 }, { ratio.sampling.constant.value = 4 }, \
         { residual-ratio.control.constant.value = 0 }, { residual-ratio = {} }]",
    ];
    for estimators in texts {
        let text = format!(
            "title = \"twins\"\n[problem.transmittance]\nmedium.constant.extinction = 0.5\nspan = [0, 4]\n{sweep}\n{estimators}"
        );
        let record = with_curves(&[case("test", &text)]);
        none(&record.results.cases.iter().flat_map(wrong_in).collect::<Vec<_>>());
        let case = &record.results.cases[0];
        assert_eq!(collect(case, case.sweep.as_ref().expect("a sweep")).len(), 8);
    }
}

#[test]
fn a_dashed_line_of_a_plot_is_one_element() {
    let record = with_curves(&[Case::read(
        &trueflight::case::suite::find("transmittance/eq21-overview").expect("built in"),
    )
    .expect("it can be read")]);
    let case = &record.results.cases[0];
    let sheet =
        sweep_plot::figure(case, case.sweep.as_ref().expect("a sweep"), 1).expect("a figure");
    let dashed = sheet
        .shapes
        .iter()
        .filter(|shape| matches!(shape, Shape::Path { dash, .. } if !dash.is_empty()));
    let dashed = dashed.count();
    let svg = svg::document(&sheet);
    assert!(dashed > 5 && svg.matches("stroke-dasharray=").count() == dashed, "{dashed}");
    // Separate dashes would be a thousand.
    assert!(svg.matches("<path").count() < 250, "{}", svg.matches("<path").count());
    assert!(paint::png(&sheet).is_ok());
}
