//! How much faster packets are than the plainest scalar loop.
//!
//! `cargo bench --bench kernels`. The plainest loop is what a textbook shows: one draw after the
//! other, the standard library's `ln` and `cos`, one PCG generator. Both sides are drawn in turn in
//! one process and timed by processor time; a ratio is taken within its round, and the median of the
//! rounds is reported. On the homogeneous medium the textbook's density is hidden from the compiler,
//! which would otherwise delete the lookups.

use std::hint::black_box;

use cpu_time::ThreadTime;
use fearless_simd::Level;
use rand::Rng;
use rand_pcg::Pcg64;
use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::harness::plan::{BLOCK, Planned};
use trueflight::harness::{Amount, Case, Options, Plan, Source};

const ROUNDS: usize = 7;
/// Draws of the textbook's loop in a round.
const TEXTBOOK: u64 = 100_000;
/// Blocks of packets in a round.
const BLOCKS: u64 = 16;

/// One comparison.
struct Contest {
    name: &'static str,
    /// At least so many times as fast, on AVX-512.
    target: f64,
    case: &'static str,
    textbook: fn(&mut Pcg64) -> f64,
}

const EQ21: &str = "volume.eq21 = {}
    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }
    sampling.constant.value = 1";

const CONTESTS: [Contest; 3] = [
    Contest { name: "Eq. 21, ratio", target: 15.0, case: "ratio", textbook: eq21_ratio },
    Contest { name: "Eq. 21, woodcock", target: 15.0, case: "woodcock", textbook: eq21_woodcock },
    Contest { name: "homogeneous, ratio", target: 7.0, case: "homogeneous", textbook: homogeneous },
];

fn uniform(rng: &mut Pcg64) -> f64 {
    (rng.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

/// Eq. 21 at a point, as it is printed.
#[allow(clippy::manual_midpoint)] // as it is printed
fn eq21(x: f64, y: f64, z: f64) -> f64 {
    (((1.5 * (x + y + z)).cos() + 1.0) / 2.0).powi(5) * ((z / 2.0).sin() + 2.0) / 3.0
}

fn eq21_ratio(rng: &mut Pcg64) -> f64 {
    let (majorant, length) = (black_box(1.0), black_box(20.0));
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        weight *= 1.0 - eq21(0.0, 0.0, t) / majorant;
    }
}

fn eq21_woodcock(rng: &mut Pcg64) -> f64 {
    let (majorant, length) = (black_box(1.0), black_box(20.0));
    let mut t = 0.0;
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return 1.0;
        }
        if uniform(rng) < eq21(0.0, 0.0, t) / majorant {
            return 0.0;
        }
    }
}

fn homogeneous(rng: &mut Pcg64) -> f64 {
    let (majorant, length) = (black_box(1.0), black_box(8.0));
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        weight *= 1.0 - black_box(0.5) / majorant;
    }
}

fn case(name: &str) -> Case {
    let body = match name {
        "ratio" => format!("{EQ21}\nestimators = [{{ ratio = {{}} }}]"),
        "woodcock" => format!("{EQ21}\nestimators = [{{ woodcock = {{}} }}]"),
        _ => "medium.constant.extinction = 0.5\nspan = [0, 8]\nsampling.constant.value = 1
            estimators = [{ ratio = {} }]"
            .to_owned(),
    };
    let text = format!("title = \"{name}\"\n[problem.transmittance]\n{body}");
    let source = Source { name: name.into(), path: format!("{name}.toml").into(), text };
    Case::read(&source).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Processor seconds of a draw, and the mean.
fn of_textbook(draw: fn(&mut Pcg64) -> f64, round: u128) -> (f64, f64) {
    let mut rng = Pcg64::new(round, 1);
    let begin = ThreadTime::now();
    let sum: f64 = (0..TEXTBOOK).map(|_| draw(&mut rng)).sum();
    let draws = TEXTBOOK as f64;
    (begin.elapsed().as_secs_f64() / draws, sum / draws)
}

fn of_kernel(planned: &Planned, kernel: Kernel, round: u64) -> (f64, f64) {
    let ready = planned.outcome.as_ref().expect("it is not refused");
    let mut buffer = DrawBuffer::new(1);
    let (mut seconds, mut sum, mut draws) = (0.0, 0.0, 0);
    for block in 0..BLOCKS {
        let mut streams = planned.streams(round * BLOCKS + block);
        for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
            let begin = ThreadTime::now();
            ready.experiment.fill_by(kernel, &mut streams, DrawBuffer::LENGTH, &mut buffer);
            seconds += begin.elapsed().as_secs_f64();
            // Not timed: adding up is a chain of additions, which the textbook's loop hides.
            sum += buffer.values[0].iter().sum::<f64>();
            draws += DrawBuffer::LENGTH;
        }
    }
    (seconds / draws as f64, sum / draws as f64)
}

fn kernels() -> Vec<(&'static str, Kernel)> {
    let best = Level::new();
    let mut kernels = vec![("packets", Kernel::Packets(best))];
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let levels = [
            ("packets, avx2", best.as_avx2().map(Level::Avx2)),
            ("packets, sse2", best.as_sse2().map(Level::Sse2)),
        ];
        kernels.extend(
            levels
                .into_iter()
                .filter_map(|(name, level)| level.map(|level| (name, Kernel::Packets(level)))),
        );
    }
    kernels.push(("one by one", Kernel::Single));
    kernels
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    println!("{:?}, {ROUNDS} rounds, processor time of one draw", Level::new());
    for contest in CONTESTS {
        let cases = [case(contest.case)];
        let options = Options { draws: Amount::Exactly(BLOCK), ..Options::default() };
        let plan = Plan::new(&cases, &options);
        let planned = &plan.cases[0].experiments[0];
        let kernels = kernels();
        let (mut book, mut book_mean) = (Vec::new(), 0.0);
        let mut times = vec![Vec::new(); kernels.len()];
        let mut ratios = vec![Vec::new(); kernels.len()];
        let mut means = vec![0.0; kernels.len()];
        for round in 0..ROUNDS {
            let (textbook, mean) = of_textbook(contest.textbook, round as u128);
            book.push(textbook);
            book_mean += mean / ROUNDS as f64;
            for (i, (_, kernel)) in kernels.iter().enumerate() {
                let (time, mean) = of_kernel(planned, *kernel, round as u64);
                times[i].push(time);
                ratios[i].push(textbook / time);
                means[i] += mean / ROUNDS as f64;
            }
        }
        println!("\n{} (target {}×)", contest.name, contest.target);
        println!(
            "  {:14} {:8.2} ns          mean {book_mean:.5}",
            "textbook",
            1e9 * median(&mut book)
        );
        for (i, (name, _)) in kernels.iter().enumerate() {
            let (time, ratio) = (1e9 * median(&mut times[i]), median(&mut ratios[i]));
            println!("  {name:14} {time:8.2} ns {ratio:7.2}× mean {:.5}", means[i]);
        }
    }
}
