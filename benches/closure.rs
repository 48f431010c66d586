//! Cost of a check beside that of the draws: ratio tracking of Eq. 21 as a closure, at σ̂ = 1.
//!
//! ```text
//! cargo bench --bench closure
//! ```
//!
//! Four loops are timed in turn, the median of 9 rounds each: the closure alone; `check` with it and everything that
//! theory knows; the plain loop of `run` over the same experiment; and `check` with a closure that hands out the draws
//! of that loop. The time that theory takes before the first draw is reported separately.

use std::hint::black_box;
use std::time::Instant;

use trueflight::OfCase;
use trueflight::case::sweep::SweptQuantity;
use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::rng::{Address, Stream};
use trueflight::{Catalogue, check};

const DRAWS: u32 = 1 << 20;
const ROUNDS: usize = 9;
/// Number of draws that the plain loop makes at a time.
const BUFFER: u32 = 256;
const CASE: &str = "transmittance/eq21-overview";

fn sigma_t(t: f64) -> f64 {
    (0.75 * t).cos().powi(10) * ((t / 2.0).sin() + 2.0) / 3.0
}

fn ratio(rng: &mut Stream) -> f64 {
    let (mut weight, mut t) = (1.0, -rng.positive_uniform().ln());
    while t < 20.0 {
        weight *= 1.0 - sigma_t(t);
        t -= rng.positive_uniform().ln();
    }
    weight
}

/// Nanoseconds a draw.
fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e9 / f64::from(DRAWS)
}

fn main() {
    let mut cases = Catalogue::builtin().named(CASE).unwrap_or_else(|errors| {
        panic!("{}", errors[0].in_full());
    });
    let case = cases.remove(0);
    let address = Address { seed: 1, experiment: 1, block: 0, lane: 0 };
    let estimator = (0..case.scenario.estimators())
        .find(|&estimator| case.id(estimator, None).estimator.name == "ratio")
        .expect("ratio tracking");
    let ready =
        case.at(Some((SweptQuantity::Sampling, 1.0))).and_then(|at| at.prepare(estimator, address));
    let experiment = ready.unwrap_or_else(|refusal| panic!("{refusal}")).experiment;
    let mut times = [const { Vec::new() }; 4];
    let mut theory = f64::INFINITY;
    for _ in 0..ROUNDS {
        times[0].push(timed(|| {
            let mut stream = address.stream();
            let sum: f64 = (0..DRAWS).map(|_| ratio(&mut stream)).sum();
            black_box(sum);
        }));
        let start = Instant::now();
        let own = check("ratio", ratio).of(CASE, "ratio", 1.0).draws(DRAWS.into());
        theory = theory.min(start.elapsed().as_secs_f64());
        times[1].push(timed(|| own.assert_pass()));
        times[2].push(timed(|| {
            let (mut streams, mut buffer) = (address.streams(), DrawBuffer::new(1));
            for _ in 0..DRAWS / BUFFER {
                experiment.fill_by(Kernel::Single, &mut streams, BUFFER as usize, &mut buffer);
                black_box(&buffer);
            }
        }));
        let (mut streams, mut buffer, mut at) = (address.streams(), DrawBuffer::new(1), 0);
        let handed_out = check("the draws of run", |_| {
            if at == buffer.values.first().map_or(0, Vec::len) {
                experiment.fill_by(Kernel::Single, &mut streams, BUFFER as usize, &mut buffer);
                at = 0;
            }
            at += 1;
            buffer.values[0][at - 1]
        });
        let handed_out = handed_out.of(CASE, "ratio", 1.0).draws(DRAWS.into());
        times[3].push(timed(|| handed_out.assert_pass()));
    }
    let [closure, own, run, handed_out] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    println!("loop,ns a draw,over the draws alone");
    println!("closure,{closure:.1},1");
    println!("check of the closure,{own:.1},{:.3}", own / closure);
    println!("plain loop of run,{run:.1},1");
    println!("check of its draws,{handed_out:.1},{:.3}", handed_out / run);
    println!("theory,{:.1} ms a check,", theory * 1e3);
}
