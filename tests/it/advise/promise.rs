//! The promise of advice, measured: `cargo test --release --test it advise::promise -- --ignored` writes
//! `results/advise.csv`. Run it on a machine without other work.

use std::fmt::Write;

use super::{ANY, asked, request};
use crate::common::{case, none, options};
use trueflight::advise::{Costs, Group, Row};
use trueflight::bench::{Amounts, measure};
use trueflight::plan::Plan;

/// Media that the rules of advice were not tuned with; `S` is the density.
const MEDIA: [(&str, &str); 10] = [
    ("constant", "medium.constant.extinction = S\nspan = [0, 2]"),
    (
        "steps",
        "medium.piecewise-constant = { breaks = [0, 1, 1.5, 3], values = [0.2, S, 0.5] }\nspan = [0, 3]",
    ),
    (
        "ramps",
        "medium.piecewise-linear = { knots = [0, 1, 2, 3], values = [0.1, S, 0.3, S] }\nspan = [0, 3]",
    ),
    ("exponential", "medium.exponential = { extinction = S, rate = 1.2 }\nspan = [0, 4]"),
    ("gaussian", "medium.gaussian = { peak = S, centre = 1.2, width = 0.4 }\nspan = [0, 4]"),
    ("sines", "medium.sines = { base = S, amplitudes = [S], frequencies = [5] }\nspan = [0, 2.5]"),
    (
        "noise",
        "volume.noise = { extinction = S, octaves = 5, frequency = 1.7, bounds.box = { low = [0, 0, 0], high = [3, 3, 3] } }\n\
         ray = { origin = [-1, 0.3, 1.1], direction = [1, 0.2, 0.1], length = 6 }",
    ),
    (
        "fine noise",
        "volume.noise = { extinction = S, octaves = 9, seed = 3, bounds.sphere = { centre = [0, 0, 0], radius = 1 } }\n\
         ray = { origin = [-2, 0.3, 0.1], direction = [1, 0, 0], length = 4 }",
    ),
    (
        "grid",
        "volume.grid = { random = { size = [16, 16, 16] }, extinction = S, bounds.box = { low = [0, 0, 0], high = [3, 3, 3] } }\n\
         ray = { origin = [-1, 0.4, 0.9], direction = [1, 0.3, 0.2], length = 6 }",
    ),
    (
        "fine grid",
        "volume.grid = { random = { size = [64, 64, 64] }, extinction = S, bounds.box = { low = [0, 0, 0], high = [3, 3, 3] } }\n\
         ray = { origin = [1.3, -1, 0.2], direction = [0.1, 1, 0.4], length = 6 }",
    ),
];
/// Densities.
const DENSITIES: [f64; 4] = [0.3, 1.0, 3.0, 6.0];
/// Factors on the advised σ̂ of each estimator that are measured.
const FACTORS: [f64; 7] = [0.35, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0];
/// Largest measured time of the advised estimator, relative to the best.
const PROMISE: f64 = 1.15;

/// Measures the time to 1 % of the first estimator of a case; `None` if it is refused.
fn measured(text: &str) -> Option<f64> {
    let cases = [case("promise", text)];
    let plan = Plan::new(&cases, &options(1, 1000));
    plan.experiments().next()?.1.outcome.as_ref().ok()?;
    let amounts = Amounts { draws: 16_384, rounds: 5, level: fearless_simd::Level::new() };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let bench = pool.install(|| measure(&plan, amounts, &|_| {}));
    let row = bench.cases.first()?.rows.first()?;
    let times = row.times.as_ref()?;
    // A draw without variance is the answer.
    Some(times.seconds_to.map_or(times.ns_per_draw.median * 1e-9, |seconds| seconds[0]))
}

/// Returns the lines of a row with another constant σ̂.
fn lines(row: &Row, factor: f64) -> String {
    let Some(sampling) = row.constant else { return row.lines.clone() };
    let list = row.lines.lines().last().unwrap_or_default();
    format!("sampling = {}\n{list}", sampling * factor)
}

#[test]
#[ignore = "measures times for minutes: on a machine without other work"]
fn the_advised_estimator_is_as_fast_as_the_best_that_is_measured() {
    let mut table = String::from(
        "medium,density,advised,predicted_s,measured_s,best,best_s,ratio,first_three_s,is_in_order\n",
    );
    let mut wrong = Vec::new();
    for (name, text) in MEDIA {
        for density in DENSITIES {
            let medium = text.replace('S', &density.to_string());
            let medium = format!("title = \"{name}\"\n[problem.transmittance]\n{medium}\n");
            let costs = Costs::Measured { folder: None, anew: true };
            let advice = asked(&format!("{medium}{ANY}"), &request(costs));
            let ranked: Vec<&Row> =
                advice.rows.iter().filter(|row| row.group == Group::Ranked).collect();
            let times = |row: &&Row| {
                let factors = FACTORS.iter().filter(|&&f| row.constant.is_some() || f == 1.0);
                let all = factors.map(|&f| (f, measured(&format!("{medium}{}", lines(row, f)))));
                all.filter_map(|(f, time)| Some((f, time?))).collect::<Vec<_>>()
            };
            let times: Vec<Vec<(f64, f64)>> = ranked.iter().map(times).collect();
            let own =
                |i: usize| times[i].iter().find(|(f, _)| *f == 1.0).map_or(f64::NAN, |at| at.1);
            let least = |i: &usize| times[*i].iter().map(|at| at.1).fold(f64::INFINITY, f64::min);
            let best =
                (0..ranked.len()).min_by(|a, b| least(a).total_cmp(&least(b))).expect("a row");
            let (advised, ratio) = (&ranked[0], own(0) / least(&best));
            let three: Vec<f64> = (0..ranked.len().min(3)).map(own).collect();
            let is_in_order = three.windows(2).all(|pair| pair[0] <= pair[1] * PROMISE);
            let list = three.iter().map(|time| format!("{time:.3e}")).collect::<Vec<_>>().join(" ");
            let _ = writeln!(
                table,
                "{name},{density},{},{:.3e},{:.3e},{},{:.3e},{ratio:.3},{list},{is_in_order}",
                advised.estimator.replace(',', ""),
                advised.time,
                own(0),
                ranked[best].estimator.replace(',', ""),
                least(&best),
            );
            if ratio > PROMISE || !is_in_order {
                wrong.push(format!("{name}, density {density}: {ratio:.3}, first three {list}"));
            }
        }
    }
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/results/advise.csv"), table)
        .expect("written");
    none(&wrong);
}
