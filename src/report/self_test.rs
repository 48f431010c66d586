//! The self-test's tables: promises, streams and mutants, on the screen and as CSV.

use std::fmt::Write;

use crate::report::console::layout::{Column, Field, Grid, Paint, Pen, wrapped};
use crate::report::number::{count, exact, short};
use crate::report::rows::table as csv;
use crate::report::{Artifact, ReportError};
use crate::self_test::calibration::Rate;
use crate::self_test::streams::ALPHA;
use crate::self_test::{Calibration, Caught, SelfTest, StreamVerdicts};

/// The tables for the screen.
#[must_use]
pub fn table(found: &SelfTest, pen: Pen) -> String {
    let mut text = String::new();
    promises(&mut text, pen, &found.calibration);
    streams(&mut text, pen, &found.streams);
    mutants(&mut text, pen, &found.mutants);
    let verdict = if found.holds() {
        pen.paint(Paint::Green, "every promise is kept and every mutant is caught")
    } else {
        pen.paint(Paint::Red, "a promise is broken or a mutant escapes")
    };
    let _ = writeln!(text, "{verdict} · {} s", short(found.seconds, 3));
    text
}

fn promises(text: &mut String, pen: Pen, calibration: &Calibration) {
    let Calibration { runs, scalars, laws, draws, .. } = calibration;
    let title =
        format!("calibration: {runs} independent runs of {scalars} scalars and {laws} laws");
    let _ = writeln!(text, "{} · {} draws", pen.paint(Paint::Bold, &title), count(*draws));
    let rates: Vec<&Rate> = rates(calibration).collect();
    let column = |head, field: fn(&Rate) -> String| Column {
        head,
        right: true,
        rank: 0,
        fields: rates.iter().map(|rate| Field::plain(field(rate))).collect(),
    };
    let kept = rates.iter().map(|rate| {
        let (word, paint) =
            if rate.is_kept { ("kept", Paint::Green) } else { ("BROKEN", Paint::Red) };
        Field { text: word.to_owned(), paint }
    });
    let mut grid = Grid {
        columns: vec![
            Column { right: false, ..column("what", |rate| rate.what.clone()) },
            column("count", |rate| rate.count.to_string()),
            column("of", |rate| rate.trials.to_string()),
            column("rate", |rate| short(share(rate), 2)),
            column("at least", |rate| short(rate.limits[0], 2)),
            column("at most (99 %)", |rate| short(rate.limits[1], 2)),
            column("promised", |rate| short(rate.promise, 2)),
        ],
    };
    grid.push("", kept.collect());
    grid.fit(pen.width);
    text.push_str(&grid.render(pen));
    let uniform = calibration
        .uniformity
        .iter()
        .filter_map(|check| Some(format!("{} {}", check.check, short(check.p?, 2))));
    let uniform: Vec<String> = uniform.collect();
    if !uniform.is_empty() {
        let said =
            format!("p-values against the uniform law, Anderson–Darling p: {}", uniform.join(", "));
        for line in wrapped(&said, pen.width) {
            let _ = writeln!(text, "{}", pen.paint(Paint::Dim, &line));
        }
    }
    text.push('\n');
}

fn streams(text: &mut String, pen: Pen, streams: &[StreamVerdicts]) {
    let failed: u64 = streams.iter().map(|verdicts| verdicts.failed).sum();
    let judged: u64 = streams.iter().map(|verdicts| verdicts.streams).sum();
    let title = format!(
        "foreign draws: {failed} of {judged} verdicts on correct streams of hard laws fail"
    );
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &title));
    let column = |head, right, field: fn(&StreamVerdicts) -> String| Column {
        head,
        right,
        rank: 0,
        fields: streams.iter().map(|verdicts| Field::plain(field(verdicts))).collect(),
    };
    let kept = streams.iter().map(|verdicts| {
        let (word, paint) =
            if verdicts.is_kept() { ("kept", Paint::Green) } else { ("BROKEN", Paint::Red) };
        Field { text: word.to_owned(), paint }
    });
    let mut grid = Grid {
        columns: vec![
            column("law", false, |verdicts| verdicts.law.clone()),
            column("known", false, |verdicts| verdicts.known.clone()),
            column("pass", true, |verdicts| verdicts.passed.to_string()),
            column("fail", true, |verdicts| verdicts.failed.to_string()),
            column("inconclusive", true, |verdicts| verdicts.inconclusive.to_string()),
        ],
    };
    grid.push("", kept.collect());
    grid.fit(pen.width);
    let _ = writeln!(text, "{}", grid.render(pen));
}

/// All rates that were promised.
fn rates(calibration: &Calibration) -> impl Iterator<Item = &Rate> {
    let shares = calibration.uniformity.iter().flat_map(|check| &check.below);
    calibration.rates.iter().chain(shares)
}

fn share(rate: &Rate) -> f64 {
    if rate.trials == 0 { 0.0 } else { rate.count as f64 / rate.trials as f64 }
}

fn mutants(text: &mut String, pen: Pen, mutants: &[Caught]) {
    let caught = mutants.iter().filter(|mutant| mutant.is_right()).count();
    let title = format!("mutants: {caught} of {} caught, each honest twin passes", mutants.len());
    let _ = writeln!(text, "{}", pen.paint(Paint::Bold, &title));
    let column = |head, right, field: &dyn Fn(&Caught) -> Field| Column {
        head,
        right,
        rank: 0,
        fields: mutants.iter().map(field).collect(),
    };
    let draws = |mutant: &Caught| match mutant.draws {
        Some(draws) if mutant.twin_passes => Field::plain(count(draws)),
        Some(_) => Field { text: "THE TWIN FAILS".to_owned(), paint: Paint::Red },
        None => Field { text: "ESCAPES".to_owned(), paint: Paint::Red },
    };
    let others = |mutant: &Caught| {
        let others = mutant.failed.iter().filter(|name| *name != mutant.check);
        Field::plain(others.map(String::as_str).collect::<Vec<_>>().join(", "))
    };
    let mut grid = Grid {
        columns: vec![
            column("mutant", false, &|mutant| Field::plain(mutant.name.to_owned())),
            Column { rank: 1, ..column("on", false, &|mutant| Field::plain(place(mutant))) },
            column("caught by", false, &|mutant| Field::plain(mutant.check.to_owned())),
            column("draws", true, &draws),
            Column { rank: 2, ..column("also by", false, &others) },
        ],
    };
    grid.fit(pen.width);
    let _ = writeln!(text, "{}", grid.render(pen));
}

/// `magnet: ratio`.
fn place(mutant: &Caught) -> String {
    let case = mutant.case.rsplit('/').next().unwrap_or(mutant.case);
    format!("{case}: {}", mutant.estimator)
}

/// The tables as CSV files.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn artifacts(found: &SelfTest) -> Result<Vec<Artifact>, ReportError> {
    let rates = rates(&found.calibration).map(|rate| {
        let [low, high] = rate.limits.map(exact);
        let (count, trials) = (rate.count.to_string(), rate.trials.to_string());
        vec![
            rate.what.clone(),
            count,
            trials,
            low,
            high,
            exact(rate.promise),
            rate.is_kept.to_string(),
        ]
    });
    let header = ["what", "count", "trials", "low_99", "high_99", "promise", "kept"];
    let calibration = csv("the calibration", header, rates)?;
    let rows = found.streams.iter().map(|verdicts| {
        let counts = [verdicts.streams, verdicts.passed, verdicts.failed, verdicts.inconclusive];
        let mut row = vec![verdicts.law.clone(), verdicts.known.clone()];
        row.extend(counts.map(|count| count.to_string()));
        row.extend([exact(ALPHA), verdicts.is_kept().to_string()]);
        row
    });
    let header = ["law", "known", "streams", "pass", "fail", "inconclusive", "promise", "kept"];
    let streams = csv("the streams", header, rows)?;
    let rows = found.mutants.iter().map(|mutant| {
        let draws = mutant.draws.map(|draws| draws.to_string()).unwrap_or_default();
        let words = [mutant.name, mutant.bug, mutant.case, mutant.estimator, mutant.check];
        let mut row: Vec<String> = words.map(str::to_owned).to_vec();
        row.extend([draws, mutant.failed.join(" "), mutant.twin_passes.to_string()]);
        row
    });
    let header = ["mutant", "bug", "case", "estimator", "check", "draws", "failed", "twin_passes"];
    let mutants = csv("the mutants", header, rows)?;
    let artifact =
        |path: &str, text: String| Artifact { path: path.into(), bytes: text.into_bytes() };
    Ok(vec![
        artifact("self-test/calibration.csv", calibration),
        artifact("self-test/foreign-streams.csv", streams),
        artifact("self-test/mutants.csv", mutants),
    ])
}
