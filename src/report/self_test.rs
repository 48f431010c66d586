//! The self-test's two tables: promises and mutants, on the screen and as CSV.

use std::fmt::Write;

use crate::harness::self_test::calibration::Rate;
use crate::harness::self_test::{Calibration, Caught, SelfTest};
use crate::report::number::{count, exact, short};
use crate::report::rows::table as csv;
use crate::report::{Artifact, ReportError};

/// The two tables for the screen.
#[must_use]
pub fn table(found: &SelfTest) -> String {
    let mut text = String::new();
    promises(&mut text, &found.calibration);
    mutants(&mut text, &found.mutants);
    let verdict = if found.holds() {
        "every promise is kept and every mutant is caught"
    } else {
        "a promise is broken or a mutant escapes"
    };
    let _ = writeln!(text, "{verdict} · {} s", short(found.seconds, 3));
    text
}

fn promises(text: &mut String, calibration: &Calibration) {
    let Calibration { runs, scalars, laws, draws, .. } = calibration;
    let _ = writeln!(
        text,
        "Calibration: {runs} independent runs of {scalars} scalars and {laws} laws, {} draws",
        count(*draws)
    );
    let _ =
        writeln!(text, "  {:<44} {:>15} {:>9}  {:<22} promise", "", "count", "rate", "99 % limits");
    let shares = calibration.uniformity.iter().flat_map(|check| &check.below);
    for rate in calibration.rates.iter().chain(shares) {
        let word = if rate.is_kept { "" } else { "  BROKEN" };
        let [low, high] = rate.limits.map(|limit| short(limit, 2));
        let counts = format!("{} / {}", rate.count, rate.trials);
        let _ = writeln!(
            text,
            "  {:<44} {counts:>15} {:>9}  {:<22} ≤ {}{word}",
            rate.what,
            short(share(rate), 2),
            format!("[{low}, {high}]"),
            short(rate.promise, 2)
        );
    }
    for check in &calibration.uniformity {
        if let Some(p) = check.p {
            let what = format!("p of {} are uniform", check.check);
            let _ = writeln!(text, "  {what:<44} Anderson–Darling p = {}", short(p, 2));
        }
    }
    text.push('\n');
}

fn share(rate: &Rate) -> f64 {
    if rate.trials == 0 { 0.0 } else { rate.count as f64 / rate.trials as f64 }
}

fn mutants(text: &mut String, mutants: &[Caught]) {
    let caught = mutants.iter().filter(|mutant| mutant.is_right()).count();
    let _ =
        writeln!(text, "Mutants: {caught} of {} caught, each honest twin passes", mutants.len());
    let _ = writeln!(text, "  {:<30} {:<28} {:<12} {:>10}  also", "mutant", "on", "check", "draws");
    for mutant in mutants {
        let draws = match mutant.draws {
            Some(draws) => count(draws),
            None => "ESCAPES".to_owned(),
        };
        let others: Vec<&str> =
            mutant.failed.iter().filter(|name| *name != mutant.check).map(String::as_str).collect();
        let twin = if mutant.twin_passes { "" } else { "  THE TWIN FAILS" };
        let on = mutant.case.rsplit('/').next().unwrap_or(mutant.case);
        let on = format!("{on}: {}", mutant.estimator);
        let _ = writeln!(
            text,
            "  {:<30} {on:<28} {:<12} {draws:>10}  {}{twin}",
            mutant.name,
            mutant.check,
            others.join(", ")
        );
    }
    text.push('\n');
}

/// The two tables as CSV files.
///
/// # Errors
///
/// Where the encoder gives up.
pub fn artifacts(found: &SelfTest) -> Result<Vec<Artifact>, ReportError> {
    let shares = found.calibration.uniformity.iter().flat_map(|check| &check.below);
    let rates = found.calibration.rates.iter().chain(shares).map(|rate| {
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
        artifact("self-test/mutants.csv", mutants),
    ])
}
