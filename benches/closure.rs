//! What a check costs over the draws themselves: ratio tracking of Eq. 21 as a closure, at σ̂ = 1.
//!
//! ```text
//! cargo bench --bench closure
//! ```
//!
//! Three loops are timed in turn, the median of 15 rounds each: the closure alone, `check` with the closure and what
//! theory knows of it (mean, variance, dependence, drift), and the plain loop of `run` over the same experiment.

use std::hint::black_box;
use std::time::Instant;

use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::harness::sweep::What;
use trueflight::rng::{Address, Stream};
use trueflight::{Catalogue, check};

const DRAWS: u32 = 1 << 18;
const ROUNDS: usize = 15;
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
        .find(|&estimator| case.scenario.names(estimator, None).estimator == "ratio")
        .expect("ratio tracking");
    let ready = case.scenario.prepare(estimator, Some((What::Sampling, 1.0)), address);
    let experiment = ready.unwrap_or_else(|refusal| panic!("{refusal}")).experiment;
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..ROUNDS {
        times[0].push(timed(|| {
            let mut stream = address.stream();
            let sum: f64 = (0..DRAWS).map(|_| ratio(&mut stream)).sum();
            black_box(sum);
        }));
        times[1].push(timed(|| {
            let check = check("ratio", ratio).of(CASE, "ratio", 1.0).draws(DRAWS.into());
            check.assert_pass();
        }));
        times[2].push(timed(|| {
            let (mut streams, mut buffer) = (address.streams(), DrawBuffer::default());
            for _ in 0..DRAWS / 256 {
                experiment.fill_by(Kernel::Single, &mut streams, 256, &mut buffer);
                black_box(&buffer);
            }
        }));
    }
    let [closure, check, run] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    println!("loop,ns a draw,over the closure,over the plain loop of run");
    for (name, time) in [("closure", closure), ("check", check), ("plain loop of run", run)] {
        println!("{name},{time:.1},{:.3},{:.3}", time / closure, time / run);
    }
}
