//! Reports of one fixed bench: one file of each format byte for byte.

use std::path::Path;

use trueflight::bench::clock::Clock;
use trueflight::bench::record::{
    Bench, BenchCase, BenchRow, Conditions, CurvePoint, Spread, Times,
};
use trueflight::bench::stored::{BenchComparison, TimeChange};
use trueflight::case::id::{EstimatorName, ExperimentId, Number, SamplingName, SweepPoint};
use trueflight::case::sweep::SweptQuantity;
use trueflight::report::bench::{console, render, tables};
use trueflight::report::layout::Pen;

use super::{assert_drawn, compare};

fn spread(median: f64) -> Spread {
    Spread { median, least: median * 0.875, most: median * 1.25 }
}

fn times(ns: f64, variance: Option<f64>) -> Times {
    Times {
        ns_per_draw: spread(ns),
        plain_ns_per_draw: spread(4.0 * ns),
        speedup: spread(4.0),
        scaling: Some(spread(1.875)),
        draws_per_second: 1e9 / ns,
        ns_per_lookup: Some(ns / 8.0),
        seconds_to: variance.map(|v| [1e4, 1e6, 1e8].map(|n| n * v * 16.0 * ns * 1e-9)),
        efficiency: variance.map(|v| 1e9 / (v * ns)),
    }
}

/// Returns the identity of an experiment of the case, at a swept σ̂.
fn id(estimator: &str, swept: Option<f64>) -> ExperimentId {
    let constant = swept.map(Number);
    ExperimentId {
        case: "bench/eq21-sweep".to_owned(),
        estimator: EstimatorName { name: estimator.to_owned(), settings: String::new() },
        sampling: SamplingName { constant, kind: constant.map_or("", |_| "constant").to_owned() },
        swept: constant.map(|value| SweepPoint { what: SweptQuantity::Sampling, value }),
        namesake: 1,
        ..ExperimentId::default()
    }
}

fn row(estimator: &str, swept: Option<f64>, ns: f64, variance: f64) -> BenchRow {
    let point = |draws: u64| {
        let predicted = (variance / draws as f64).sqrt() * 4.0;
        CurvePoint {
            draws,
            lookups: draws as f64 * 8.0,
            error: predicted * 0.25,
            relative: predicted,
            least: predicted * 0.25,
            most: predicted * 2.0,
            predicted: Some(predicted),
        }
    };
    let curve: Vec<CurvePoint> = [64, 256, 1024].map(point).into();
    BenchRow {
        is_first: true,
        id: id(estimator, swept),
        draws: Some(3072),
        mean: Some(0.25),
        truth: Some(0.25),
        variance: Some(variance * 1.0625),
        predicted_variance: Some(variance),
        lookups_per_draw: Some(8.0),
        predicted_lookups: Some(8.0),
        fom: Some(1.0 / (variance * 8.0)),
        is_shown: swept.is_none_or(|swept| swept == 2.0),
        times: Some(times(ns, Some(variance))),
        curve,
        ..BenchRow::default()
    }
}

fn case() -> BenchCase {
    let refused = BenchRow {
        is_first: true,
        is_refused: true,
        id: id("woodcock", Some(0.5)),
        reason: "the majorant is 0.9: below it the chance of a real collision would exceed 1"
            .to_owned(),
        ..BenchRow::default()
    };
    let exact = BenchRow {
        is_first: true,
        id: id("regular", None),
        draws: Some(3072),
        mean: Some(0.25),
        truth: Some(0.25),
        variance: Some(0.0),
        predicted_variance: Some(0.0),
        lookups_per_draw: Some(8.0),
        predicted_lookups: Some(8.0),
        reason: "no variance: each draw is the answer, and there is no error to wait for"
            .to_owned(),
        times: Some(times(16.0, None)),
        ..BenchRow::default()
    };
    BenchCase {
        name: "bench/eq21-sweep".to_owned(),
        title: "Eq. 21, \"quoted\" & <tagged>".to_owned(),
        problem: "transmittance".to_owned(),
        medium: "eq21".to_owned(),
        digest: "00ff".to_owned(),
        swept: Some(SweptQuantity::Sampling),
        rows: vec![
            refused,
            row("woodcock", Some(1.0), 32.0, 0.1875),
            row("woodcock", Some(2.0), 64.0, 0.1875),
            row("single (non-terminating, a=0.7)", Some(2.0), 128.0, 0.015_625),
            exact,
        ],
    }
}

fn bench() -> Bench {
    let id = |name: &str| ExperimentId { case: "case".to_owned(), ..id(name, None) };
    let change = |ratio: f64| TimeChange {
        id: self::id("woodcock", Some(1.0)),
        ns_per_draw: [spread(32.0), spread(32.0 * ratio)],
        speedup: [spread(4.0), spread(4.0 / ratio)],
        ratio,
        is_regression: ratio > 1.0,
    };
    Bench {
        version: "0.1.0".to_owned(),
        seed: 1,
        draws: 1024,
        rounds: 3,
        conditions: Conditions {
            threads: 2,
            clock: Clock::Elapsed,
            level: "avx2".to_owned(),
            seconds: 2.25,
            speedup: Some(spread(4.0)),
        },
        cases: vec![case()],
        comparison: Some(BenchComparison {
            name: "main".to_owned(),
            tolerance: 0.25,
            compared: 3,
            changes: vec![change(0.5), change(2.0)],
            added: vec![id("new")],
            missing: Vec::new(),
            rewritten: vec![id("old")],
            levels: Some(["sse2", "avx2"].map(str::to_owned)),
        }),
    }
}

#[test]
fn files_of_a_bench() {
    let artifacts = render(&bench()).expect("renders");
    let names: Vec<String> = artifacts.iter().map(|a| a.path.display().to_string()).collect();
    let case = |ending: &str| format!("bench/eq21-sweep.{ending}");
    let [rows, page, changes] = ["bench.csv", "report.html", "changes.csv"].map(str::to_owned);
    assert_eq!(names, [rows, page, changes, case("error.csv"), case("svg"), case("png")]);
    for artifact in artifacts {
        let ending = artifact.path.extension().unwrap_or_default();
        if ending == "png" || ending == "svg" {
            assert_drawn(&artifact, 1800);
        } else if ending == "html" {
            let page = String::from_utf8(artifact.bytes).expect("text");
            assert!(
                page.contains("Since baseline main") && page.contains("<symbol id=\"error-0\"")
            );
        } else if artifact.path != Path::new("changes.csv") {
            compare(&artifact.path, &artifact.bytes);
        }
    }
}

#[test]
fn rows_of_a_bench() {
    let json = tables::json(&bench()).expect("renders");
    let parsed: Vec<serde_json::Map<String, serde_json::Value>> =
        serde_json::from_str(&json).expect("is JSON");
    let csv = tables::csv(&bench()).expect("renders");
    let header: Vec<&str> = csv.lines().next().expect("a line").split(',').collect();
    assert_eq!(parsed.len(), 5);
    assert!(header.iter().all(|&name| parsed[0].contains_key(name)));
    // Unknown numbers are empty, never zero.
    assert_eq!(parsed[0]["ns_per_draw"], serde_json::Value::Null);
    assert_eq!(parsed[4]["seconds_to_1e-3"], serde_json::Value::Null);
}

#[test]
fn consoles_of_a_bench() {
    for width in [80, 160] {
        let text = console::table(&bench(), Pen { width, colour: false });
        let widest = text.lines().map(|line| line.chars().count()).max();
        // A combining hat is a character without width.
        assert!(widest.is_some_and(|widest| widest <= width + 2), "{width}: {widest:?}");
    }
    let text = console::table(&bench(), Pen { width: 160, colour: false });
    compare(Path::new("bench/console.txt"), text.as_bytes());
}

#[test]
fn nothing_is_too_odd_to_plot() {
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e308, 5e-324] {
        let mut bench = bench();
        for row in &mut bench.cases[0].rows {
            for point in &mut row.curve {
                (point.relative, point.least, point.predicted) = (value, value, Some(value));
            }
            if let Some(times) = &mut row.times {
                times.ns_per_draw.median = value;
            }
        }
        render(&bench).expect("renders");
    }
}
