//! How many lookups one indirect call should answer.
//!
//! ```text
//! cargo bench --bench batches
//! ```
//!
//! A batch of walks flies, is looked up by one call, and collides, over and over. Sixteen walks stay in registers
//! between the three, as packets do; batches of 64 to 1024 stay in arrays. They take turns in rounds, and a time is
//! told relative to that of sixteen in its round. Random numbers are made beforehand: they cost the same in any batch.

use std::cell::RefCell;
use std::hint::black_box;
use std::path::Path;

use cpu_time::ThreadTime;
use fearless_simd::{Level, Simd, SimdBase, f64x8};
use trueflight::case::Source;
use trueflight::catalogue::Settings;
use trueflight::media::{Body, Lookups, Medium};
use trueflight::numeric::pack::{self, Task};
use trueflight::numeric::{Lane, Twin};

/// Walks that one call looks up.
const BATCHES: [usize; 4] = [64, 128, 256, 1024];
/// Steps of all walks together in a round.
const LOOKUPS: usize = 1 << 20;
const ROUNDS: usize = 31;

const MEDIA: [(&str, &str); 5] = [
    ("homogeneous, hidden", "medium.gaussian = { peak = 1, centre = 2, width = 1e6 }\nspan = [0, 4]"),
    (
        "layers",
        "medium.piecewise-constant = { breaks = [0, 1, 2.5, 4], values = [0.2, 1.5, 0.4] }\nspan = [0, 4]",
    ),
    ("Eq. 21", "volume.eq21 = {}\nray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }"),
    (
        "grid",
        "volume.grid = { random = { size = [64, 64, 64], seed = 7 }, bounds.box = { low = [0, 0, 0], high = [4, 4, 4] } }
        ray = { origin = [-1, 0.4, 0.9], direction = [4.2, 2.2, 1.9], length = 9 }",
    ),
    (
        "4-octave noise",
        "volume.noise = { extinction = 1.2, octaves = 4, seed = 5 }
        ray = { origin = [0.3, 0.7, -0.4], direction = [0.6, 0.5, 0.4], length = 5 }",
    ),
];

fn medium(text: &str) -> Medium {
    let source = Source { name: "medium".into(), path: "medium.toml".into(), text: text.into() };
    let faults = RefCell::default();
    let root = source.parse(&faults);
    let body = Body::read(&Settings::new(&root, Path::new("."), &faults));
    body.expect("a field").medium()
}

/// Seconds of processor time that so many walks at a time take for all steps.
fn walk(medium: &Medium, lookups: &Lookups, flights: &[f64], batch: usize) -> f64 {
    let support = medium.support();
    let mut t: Vec<f64> = flights[..batch].iter().map(|f| support.from + f).collect();
    let (mut weight, mut found) = (vec![1.0; batch], vec![0.0; batch]);
    let begin = ThreadTime::now();
    let mut at = 0;
    for _ in 0..LOOKUPS / batch {
        let numbers = &flights[at..at + batch];
        at = if at + 2 * batch <= flights.len() { at + batch } else { 0 };
        for ((t, found), flight) in t.iter_mut().zip(&mut found).zip(numbers) {
            let next = *t + flight;
            *t = if next < support.to { next } else { support.from + flight };
            *found = *t;
        }
        lookups.replace_all(&mut found);
        for (weight, found) in weight.iter_mut().zip(&found) {
            *weight *= 1.0 - 0.5 * found;
        }
    }
    black_box(&weight);
    begin.elapsed().as_secs_f64()
}

/// Seconds of sixteen walks, and of the batches relative to them.
type Round = (f64, [f64; BATCHES.len()]);

/// Sixteen walks in registers.
struct Registers<'a> {
    medium: &'a Medium,
    lookups: &'a Lookups<'a>,
    flights: &'a [f64],
}

impl Task for Registers<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> f64 {
        let Self { medium, lookups, flights } = self;
        let support = medium.support();
        let (from, to) = (f64x8::splat(simd, support.from), f64x8::splat(simd, support.to));
        let (one, half) = (f64x8::splat(simd, 1.0), f64x8::splat(simd, 0.5));
        let (mut t, mut weight) = (Twin(from, from), Twin(one, one));
        let begin = ThreadTime::now();
        let mut at = 0;
        for _ in 0..LOOKUPS / 16 {
            let Some(flight) = flights[at..].first_chunk() else { break };
            let flight = Twin::from_slice(simd, flight);
            let next = Twin(t.0 + flight.0, t.1 + flight.1);
            t = Twin(
                Lane::select(next.0.below(to), next.0, from + flight.0),
                Lane::select(next.1.below(to), next.1, from + flight.1),
            );
            let Twin(first, second) = lookups.pair(simd, t);
            weight = Twin(weight.0 * (one - half * first), weight.1 * (one - half * second));
            at = if at + 32 <= flights.len() { at + 16 } else { 0 };
        }
        black_box(weight.0);
        black_box(weight.1);
        begin.elapsed().as_secs_f64()
    }
}

fn main() {
    let level = Level::new();
    println!("{level:?}, {ROUNDS} rounds, time per lookup relative to 16 in registers");
    print!("{:<20} {:>9} ", "", "16, ns");
    for batch in BATCHES {
        print!("{batch:>7}");
    }
    println!();
    for (name, text) in MEDIA {
        let medium = medium(text);
        let length = medium.support().length();
        // A tenth of the ray in the mean, from a low-discrepancy sequence.
        let flight = |i: usize| 0.2 * length * (i as f64 * 0.618_033_988_749_894_9).fract();
        let flights: Vec<f64> = (0..1 << 14).map(flight).collect();
        let lookups = medium.lookups(level);
        let mut rounds: Vec<Round> = (0..ROUNDS)
            .map(|_| {
                let task = Registers { medium: &medium, lookups: &lookups, flights: &flights };
                let registers = pack::on(level, task);
                let arrays = BATCHES.map(|batch| walk(&medium, &lookups, &flights, batch));
                (registers, arrays.map(|seconds| seconds / registers))
            })
            .collect();
        rounds.remove(0);
        let median = |of: &dyn Fn(&Round) -> f64| {
            let mut values: Vec<f64> = rounds.iter().map(of).collect();
            values.sort_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let first = median(&|round| round.0 / LOOKUPS as f64 * 1e9);
        print!("{name:<20} {first:>9.2} ");
        for i in 0..BATCHES.len() {
            print!("{:>7.2}", median(&|round| round.1[i]));
        }
        println!();
    }
}
