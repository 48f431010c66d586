//! The promise of advice, measured: `cargo test --release --test it advise::promise -- --ignored` writes
//! `results/advise.csv`. Run it on a machine without other work: 40 cases take a few minutes.
//!
//! ```text
//! measured time to 1 % = max(V/(0.01 T)², 1) · (processor time of a draw + lookup · its share of the setup lookups)
//! ```
//!
//! V is exact theory, of which draws of ten advised estimators are a check. Times are taken of the estimators with a
//! predicted time below 2.5 times the least, and of two others at random, each at five σ̂. They are timed in turn, in many
//! short rounds. The advised estimator and the fastest are then timed again, so that the fastest is not the luckiest.

use std::fmt::Write;

use super::{asked, request};
use crate::common::{case, none};
use cpu_time::ThreadTime;
use trueflight::advise::costs::fast;
use trueflight::advise::{Costs, Group, Row};
use trueflight::case::Case;
use trueflight::case::sweep::{SweptQuantity, Variation};
use trueflight::estimators::{DrawBuffer, Experiment};
use trueflight::rng::{Address, Streams};

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
const DENSITIES: [f64; 4] = [0.5, 2.0, 4.5, 8.0];
/// Density at which the variance of the advised estimator is compared with draws.
const DRAWN: f64 = 2.0;
/// Factors on the advised σ̂ of each estimator that are measured, the advised one in the middle.
const FACTORS: [f64; 5] = [0.5, 0.7, 1.0, 1.4, 2.0];
/// Predicted time over the least up to which all estimators are measured.
const NEAR: f64 = 2.5;
/// Number of others, at random.
const OTHERS: usize = 2;
/// Largest measured time of the advised estimator, relative to the best.
const PROMISE: f64 = 1.15;
/// Draws at a time.
const DRAWS: usize = 2048;
/// Shortest time of a round, seconds.
const MIN_SECONDS: f64 = 2e-4;
/// Numbers of rounds of which the lower quartile counts, and the relative error that ends them.
const ROUNDS: [usize; 2] = [8, 40];
const ERROR: f64 = 0.03;

/// Estimator at one σ̂ that is timed.
struct Timed {
    /// Place of its row, and the factor on the advised σ̂.
    row: usize,
    factor: f64,
    experiment: Box<dyn Experiment>,
    streams: Streams,
    buffer: DrawBuffer,
    fills: u32,
    /// Seconds of a draw in each round.
    rounds: Vec<f64>,
    /// Draws until the error is 1 %.
    draws: f64,
    /// Lookups of a draw, and its share of those of the setup.
    lookups: f64,
    setup: f64,
}

impl Timed {
    /// Prepares an estimator of a case; `None` if it is refused.
    fn new(case: &Case, (listed, row, factor): (usize, usize, f64), at: Variation) -> Option<Self> {
        let place = case.at(at).ok()?;
        let pilots = case.pilots(1, listed);
        let prediction = place.predict(listed, None, pilots)?;
        let experiment = place.join(listed, pilots).ok()?;
        let channel = &prediction.channels[0];
        let relative = channel.moments?.variance() / channel.truth.value.powi(2);
        let mut timed = Self {
            row,
            factor,
            experiment,
            streams: case.address(1, listed, at).streams(),
            buffer: DrawBuffer::new(1),
            fills: 1,
            rounds: Vec::new(),
            draws: (relative * 1e4).max(1.0),
            lookups: prediction.lookups.as_ref()?.mean,
            setup: prediction.shared_setup(case.draws_per_ray),
        };
        // The first buffer maps memory.
        timed.round();
        timed.round();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 1 to 1024
        let fills = (MIN_SECONDS / (timed.rounds[1] * DRAWS as f64)).clamp(1.0, 1024.0) as u32;
        timed.fills = fills;
        timed.rounds.clear();
        Some(timed)
    }

    /// Times a round.
    fn round(&mut self) {
        let begin = ThreadTime::now();
        for _ in 0..self.fills {
            self.experiment.fill(&mut self.streams, DRAWS, &mut self.buffer);
        }
        let draws = f64::from(self.fills) * DRAWS as f64;
        self.rounds.push((begin.elapsed().as_secs_f64() / draws).max(1e-12));
    }

    /// Returns the seconds of a draw.
    fn seconds(&self) -> f64 {
        fast(self.rounds.clone()).0
    }

    /// Returns the measured time to 1 %, given the seconds of a lookup of the setup.
    fn time(&self, lookup: f64) -> f64 {
        self.draws * (self.seconds() + lookup * self.setup)
    }
}

/// Returns the seconds of a lookup: the median of what more of them add to a draw of one estimator.
fn of_lookup(all: &[Timed]) -> f64 {
    let pairs = all.iter().flat_map(|few| all.iter().map(move |many| (few, many)));
    let pairs =
        pairs.filter(|(few, many)| few.row == many.row && many.lookups > 2.0 * few.lookups + 0.5);
    let slope = |(few, many): (&Timed, &Timed)| {
        (many.seconds() - few.seconds()) / (many.lookups - few.lookups)
    };
    let mut slopes: Vec<f64> = pairs.map(slope).collect();
    slopes.sort_by(f64::total_cmp);
    slopes.get(slopes.len() / 2).copied().unwrap_or(0.0)
}

/// Times experiments in turn until each is known.
fn measure(all: &mut [Timed]) {
    for timed in all.iter_mut() {
        timed.rounds.clear();
    }
    for round in 0..ROUNDS[1] {
        let is_open = |timed: &Timed| round < ROUNDS[0] || fast(timed.rounds.clone()).1 > ERROR;
        all.iter_mut().filter(|timed| is_open(timed)).for_each(Timed::round);
    }
}

/// Returns the setting of a row at a factor on its σ̂; `None` where it has one factor only.
fn setting(row: &Row, factor: f64) -> Option<Variation> {
    match (row.constant, row.margins) {
        (Some(value), _) => Some(Some((SweptQuantity::Sampling, value * factor))),
        (None, Some(_)) => {
            Some(Some((SweptQuantity::SamplingScale, row.factor.unwrap_or(1.0) * factor)))
        }
        (None, None) => (factor == 1.0).then_some(None),
    }
}

/// Returns the entry of a row in a list of estimators.
fn entry(row: &Row) -> &str {
    let list = row.lines.lines().last().and_then(|line| line.strip_prefix("estimators = ["));
    list.and_then(|list| list.strip_suffix(']')).expect("a list of one")
}

/// Returns the mistake of the variance of an estimator's draws, if there is one.
fn wrong_variance(case: &Case, row: &Row) -> Option<String> {
    let at = setting(row, 1.0)?;
    let prediction = case.at(at).ok()?.predict(0, None, case.pilots(1, 0))?;
    let (moments, truth) = (prediction.channels[0].moments?, prediction.channels[0].truth.value);
    let mut timed = Timed::new(case, (0, 0, 1.0), at)?;
    let (mut squares, mut count) = (0.0, 0.0);
    for _ in 0..64 {
        timed.experiment.fill(&mut timed.streams, DRAWS, &mut timed.buffer);
        squares += timed.buffer.values[0].iter().map(|x| (x - truth).powi(2)).sum::<f64>();
        count += timed.buffer.values[0].len() as f64;
    }
    let found = squares / count;
    let error = moments.variance() * ((moments.kurtosis()? - 1.0) / count).sqrt();
    let is_off = (found - moments.variance()).abs() > 5.0 * error + 1e-12 * truth * truth;
    is_off.then(|| format!("{}: variance {found:e}, not {:e}", row.lines, moments.variance()))
}

#[test]
#[ignore = "measures times for minutes: on a machine without other work"]
fn the_advised_estimator_is_as_fast_as_the_best_that_is_measured() {
    let mut table = String::from(
        "medium,density,advised,sampling,predicted_s,measured_s,best,best_sampling,best_s,ratio,first_three_s,is_in_order,\
         measured\n",
    );
    let mut wrong = Vec::new();
    let address = Address { seed: 1, experiment: 0, block: 0, lane: 0 };
    for (name, text) in MEDIA {
        for density in DENSITIES {
            let medium = text.replace('S', &density.to_string());
            let head =
                format!("title = \"{name}\"\ndraws_per_ray = 1000\n[problem.transmittance]\n");
            let with =
                |list: &str| format!("{head}{medium}\nsampling = 1\nestimators = [{list}]\n");
            let costs = Costs::Measured { folder: None, anew: true };
            let advice = asked(&with("\"ratio\""), &request(costs));
            let ranked: Vec<&Row> =
                advice.rows.iter().filter(|row| row.group == Group::Ranked).collect();
            let near = ranked.iter().take_while(|row| row.time <= NEAR * ranked[0].time).count();
            let mut chosen: Vec<usize> = (0..ranked.len().min(near.max(3))).collect();
            let mut random = address.stream();
            for i in 0..OTHERS.min(ranked.len() - chosen.len()) {
                #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
                // below the length
                let step = (random.uniform() * (ranked.len() - near.max(3) - i) as f64) as usize;
                let left = (0..ranked.len()).filter(|row| !chosen.contains(row)).nth(step);
                chosen.extend(left);
            }
            let list: Vec<&str> = chosen.iter().map(|&row| entry(ranked[row])).collect();
            let read = case("promise", &with(&list.join(", ")));
            let places =
                chosen.iter().enumerate().flat_map(|(i, &row)| FACTORS.map(|f| (i, row, f)));
            let timed = places.filter_map(|at| Timed::new(&read, at, setting(ranked[at.1], at.2)?));
            let mut timed: Vec<Timed> = timed.collect();
            measure(&mut timed);
            let lookup = of_lookup(&timed);
            let own = |timed: &[Timed], row: usize| {
                let own = timed.iter().find(|one| one.row == row && one.factor == 1.0);
                own.map_or(f64::NAN, |one| one.time(lookup))
            };
            let three: Vec<f64> = (0..ranked.len().min(3)).map(|row| own(&timed, row)).collect();
            let is_in_order = three.windows(2).all(|pair| pair[0] <= pair[1] * PROMISE);
            timed.sort_by(|a, b| a.time(lookup).total_cmp(&b.time(lookup)));
            let (count, best) = (timed.len(), (timed[0].row, timed[0].factor));
            timed.retain(|one| (one.row, one.factor) == best || (one.row, one.factor) == (0, 1.0));
            measure(&mut timed);
            let fastest = timed.iter().find(|one| (one.row, one.factor) == best);
            let fastest = fastest.map_or(f64::NAN, |one| one.time(lookup));
            let ratio = own(&timed, 0) / fastest;
            let list = three.iter().map(|time| format!("{time:.3e}")).collect::<Vec<_>>().join(" ");
            let sampling = |row: usize, factor: f64| {
                ranked[row].constant.or(ranked[row].factor).unwrap_or(1.0) * factor
            };
            let words = |row: usize| {
                format!(
                    "\"{} {} {}\"",
                    ranked[row].estimator, ranked[row].sampling, ranked[row].control
                )
            };
            let _ = writeln!(
                table,
                "{name},{density},{},{:.4},{:.3e},{:.3e},{},{:.4},{fastest:.3e},{ratio:.3},{list},{is_in_order},{count}",
                words(0),
                sampling(0, 1.0),
                ranked[0].time,
                own(&timed, 0),
                words(best.0),
                sampling(best.0, best.1),
            );
            if ratio.is_nan() || ratio > PROMISE || !is_in_order {
                let (advised, best) = (words(0), words(best.0));
                wrong.push(format!(
                    "{name}, density {density}: {ratio:.3}, first three {list}; {advised} and {best}"
                ));
            }
            if density == DRAWN {
                let read = case("promise", &with(entry(ranked[0])));
                wrong.extend(wrong_variance(&read, ranked[0]));
            }
        }
    }
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/results/advise.csv"), table)
        .expect("written");
    none(&wrong);
}
