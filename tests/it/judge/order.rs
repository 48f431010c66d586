//! Order of draws: a bias of later draws, draws that depend on each other, several files.

use std::io::Read;

use trueflight::judge::{CheckedClaim, Claim, DrawSource, NumberFormat, Options, Stop};

use super::{CASE, Place, UNIFORM, raw, uniform};

#[test]
fn what_comes_after_the_decision_is_seen() {
    let mut draws = uniform(400_000);
    draws[300_000..].fill(f64::NAN);
    let mut late = uniform(400_000);
    late[150_000..].iter_mut().for_each(|x| *x += 0.05);
    let place = Place::new(&[("nan.f64", &raw(&draws)), ("late.f64", &raw(&late))]);
    let early = "--tolerance 0.02 --stop-early";
    for claim in [UNIFORM, "--truth 1 --range 0.7,1.4"] {
        let numeric = ["numeric: draw 300000 is NaN", "100000 draws are like that"];
        place.expect(1, &format!("{claim} nan.f64"), &numeric);
        let change = "the mean changes: from draw 147456 on it is off by +";
        place.expect(1, &format!("{claim} --tolerance 0.02 late.f64"), &[change]);
        for file in ["nan.f64", "late.f64"] {
            let words = ["stopped early: what comes after", "draws was not seen"];
            place.expect(0, &format!("{claim} {early} {file}"), &words);
        }
    }
    let looks = "the mean looks off by +";
    place.expect(3, "--truth 1 --tolerance 0.02 late.f64", &[looks]);
    assert!(place.json("--truth 1 late.f64", &[])["drift"].is_null());
}

#[test]
fn a_mean_that_is_right_on_average_only_is_drift() {
    // A bias of 7 standard errors over 50,000 draws, then its opposite: 2.6 standard errors of all draws before its
    // end.
    let mut draws = uniform(400_000);
    draws[300_000..350_000].iter_mut().for_each(|x| *x += 0.0045);
    draws[350_000..].iter_mut().for_each(|x| *x -= 0.0045);
    let place = Place::new(&[("x.f64", &raw(&draws))]);
    let found = place.json(&format!("{UNIFORM} x.f64"), &[]);
    assert_eq!((&found["verdict"], &found["drift"]["verdict"]), (&"fail".into(), &"fail".into()));
    let reason = found["reason"].as_str().expect("words");
    assert!(reason.starts_with("the mean changes: from draw "), "{reason}");
    assert_ne!(found["findings"][0]["verdict"], "fail");
}

/// Returns a chain of correlation .9 with mean 1 and variance 1.
fn chain(n: usize) -> Vec<f64> {
    let noise = uniform(4 * n);
    let mut state = 0.0;
    noise
        .chunks(4)
        .map(|four| {
            // Four uniforms of variance 1/48.
            let step = 12f64.sqrt() * (four.iter().sum::<f64>() - 4.0);
            state = 0.9 * state + step * 0.19f64.sqrt();
            1.0 + state
        })
        .collect()
}

#[test]
fn draws_that_depend_on_each_other_are_not_judged_as_if_they_did_not() {
    let n = 400_000;
    let fine = uniform(n);
    let strata: Vec<f64> =
        fine.iter().enumerate().map(|(i, x)| ((i % 16) as f64 + 2.0 * x - 1.5) / 16.0).collect();
    let sorted: Vec<f64> =
        fine.iter().enumerate().map(|(i, x)| (i as f64 + 2.0 * x - 1.5) / n as f64).collect();
    let doubled: Vec<f64> = fine.iter().step_by(2).flat_map(|&x| [x, x]).collect();
    let replayed: Vec<f64> = fine[..100_000].iter().copied().cycle().take(n).collect();
    let place = Place::new(&[
        ("chain.f64", &raw(&chain(n))),
        ("strata.f64", &raw(&strata)),
        ("sorted.f64", &raw(&sorted)),
        ("doubled.f64", &raw(&doubled)),
        ("replayed.f64", &raw(&replayed)),
        ("fine.f64", &raw(&fine)),
    ]);
    let half = format!("--truth 0.5 --variance {} --kurtosis 1.8", 1.0 / 12.0);
    for (claim, file, words) in [
        (
            "--truth 1 --variance 1",
            "chain",
            "the draws are not independent: correlation at lag 1 is 0.9",
        ),
        ("--truth 1", "chain", "correlation at lag 1 is 0.9"),
        (half.as_str(), "strata", "the draws are not independent: correlation at lag 1 is 0."),
        (half.as_str(), "sorted", "the draws are not independent: correlation at lag 1 is 1.00"),
        (UNIFORM, "doubled", "the draws are not independent: draws are written more than once"),
        (UNIFORM, "replayed", "the same draws come again 100000 draws later"),
    ] {
        let not_judged = "the mean is not judged";
        place.expect(3, &format!("{claim} {file}.f64"), &[words, not_judged]);
    }
    place.expect(0, &format!("{UNIFORM} fine.f64"), &["against independent draws: nothing found"]);
    // A draw of NaN fails in any order.
    let mut broken = doubled;
    broken[399_999] = f64::INFINITY;
    std::fs::write(place.path().join("doubled.f64"), raw(&broken)).expect("written");
    place.expect(1, &format!("{UNIFORM} doubled.f64"), &["numeric: draw 399999"]);
    // Averages of whole strata are independent: the variance of one is 1/(12 · 16³).
    let average = format!("--truth 0.5 --variance {} --batch 16", 1.0 / (12.0 * 4096.0));
    place.expect(0, &format!("{average} strata.f64"), &["averages of 16", "pass"]);
    let wrong = average.replace("0.5 ", "0.501 ");
    place.expect(1, &format!("{wrong} strata.f64"), &["the mean is off"]);
    place.expect(
        0,
        "--truth 1 --range -20,20 --batch 256 --tolerance 0.5 chain.f64",
        &["averages of 256"],
    );
}

/// Endless pipe of halves.
struct Endless;

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let whole = buffer.len() / 3 * 3;
        buffer[..whole].chunks_mut(3).for_each(|three| three.copy_from_slice(b".5\n"));
        Ok(whole)
    }
}

#[test]
fn a_pipe_without_end_ends() {
    let claim = Claim { variance: Some(0.0), ..Claim::of_truth(0.5) }.validated();
    let wanted = Options { maximum: Some(1_000_000), ..Options::default() };
    let trial = CheckedClaim::new(claim.expect("a claim"), wanted, None).expect("a trial");
    let format = NumberFormat::Csv { column: None, lookups: None };
    let mut draws = DrawSource::from_reader(Endless, "stdin", format).expect("draws");
    let judgement = trial.judge(&mut draws).expect("a verdict");
    assert_eq!((judgement.draws, judgement.stopped), (1_000_000, Some(Stop::Limit)));
    let place = Place::new(&[("x.f64", &raw(&uniform(20_000)))]);
    let limit = ["10000 of 20000", "stopped at the limit: what comes after 10000 draws"];
    place.expect(0, &format!("{UNIFORM} --draws 1e4 x.f64"), &limit);
    let whole = place.json(&format!("{UNIFORM} --draws 2e4 x.f64"), &[]);
    assert!(whole["stopped"].is_null());
}

#[test]
fn several_files_share_alpha_and_have_one_report() {
    let good = uniform(100_000);
    let bad: Vec<f64> = good.iter().map(|x| x + 0.01).collect();
    let short = &good[..100];
    let place = Place::new(&[
        ("good.f64", &raw(&good)),
        ("bad.f64", &raw(&bad)),
        ("short.f64", &raw(short)),
    ]);
    let claim = "--truth 1 --range 0.5,1.5";
    let all = format!("{claim} --junit report.xml good.f64 bad.f64 short.f64");
    place.expect(1, &all, &["fail: 1 pass, 1 fail, 1 inconclusive of 3 files", "α = 0.001 shared"]);
    let report = std::fs::read_to_string(place.path().join("report.xml")).expect("a report");
    for part in
        ["tests=\"3\"", "failures=\"1\"", "errors=\"1\"", "name=\"bad.f64\"", "the mean is off"]
    {
        assert!(report.contains(part), "no {part} in {report}");
    }
    let found = place.json(&format!("{claim} good.f64 short.f64"), &[]);
    assert_eq!(found["verdict"], "inconclusive");
    assert_eq!(found["files"][0]["judgement"]["alpha"], 5e-4);
    place.expect(0, &format!("{claim} --inconclusive pass good.f64 short.f64"), &[]);
    // Readable files are judged and reported although another one cannot be read.
    std::fs::remove_file(place.path().join("report.xml")).expect("removed");
    place.expect(
        2,
        &format!("{claim} --junit report.xml good.f64 none.f64"),
        &["none.f64", "pass"],
    );
    let report = std::fs::read_to_string(place.path().join("report.xml")).expect("a report");
    assert!(report.contains("name=\"none.f64\"") && report.contains("errors=\"1\""), "{report}");
}

#[test]
fn lookups_are_judged_beside_the_draws() {
    let draws = uniform(200_000);
    let line = |i: usize, x: &f64| format!("{x:?},{}\n", 2 + (i * 7919) % 3);
    let rows: String = draws.iter().enumerate().map(|(i, x)| line(i, x)).collect();
    let place = Place::new(&[("x.csv", format!("X,n\n{rows}").as_bytes())]);
    let claim = format!("{UNIFORM} --column X --lookups n");
    let known = "--lookups-variance 0.6666666666666666";
    place.expect(
        0,
        &format!("{claim} --expected-lookups 3 {known} x.csv"),
        &["3 a draw, 3 expected"],
    );
    let wrong = format!("{claim} --expected-lookups 3.1 {known} x.csv");
    place.expect(1, &wrong, &["the number of lookups is off"]);
    let fixed = format!("{claim} --expected-lookups 3 --lookups-variance 0 x.csv");
    place.expect(1, &fixed, &["lookups: draw 0 takes 2 lookups, not 3"]);
}

#[test]
fn a_case_may_give_its_truth_alone() {
    let place = Place::new(&[
        ("case.toml", CASE.as_bytes()),
        // Draws of another estimator of the same transmittance, e⁻¹.
        ("x.f64", &raw(&uniform(200_000).iter().map(|x| x * (-1f64).exp()).collect::<Vec<_>>())),
    ]);
    let case = "--case case.toml --estimator woodcock --swept 1";
    place.expect(1, &format!("{case} x.f64"), &["the variance"]);
    place.expect(0, &format!("{case} --mean-only --range 0,1 x.f64"), &["pass"]);
    place.expect(0, &format!("{case} --mean-only x.f64"), &["variance estimated"]);
}
