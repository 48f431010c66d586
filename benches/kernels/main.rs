//! Speed of packets relative to a dozen textbook loops.
//!
//! `cargo bench --bench kernels`, or with `-- WORD` only comparisons with the word in their name. Both sides are drawn in
//! turn in one process and timed by processor time. A ratio is taken within its round, and the median of the rounds is
//! reported. Both means are printed beside the exact one; only the noise is another field in the textbook's loop.

mod fields;
mod textbook;

use cpu_time::ThreadTime;
use fearless_simd::Level;
use gate::stats::verdict::BLOCK;
use rand_pcg::Pcg64;
use trueflight::case::Case;
use trueflight::case::CaseText;
use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::plan::PlannedExperiment;

/// Number of rounds; the median counts.
const ROUNDS: usize = 7;
/// Number of draws of the textbook's loop in a round.
const TEXTBOOK: u64 = 100_000;
/// Number of blocks of packets in a round.
const BLOCKS: u64 = 16;

/// One comparison.
struct Contest {
    name: &'static str,
    /// Smallest ratio of times that is accepted on AVX-512; `None` for no target.
    target: Option<f64>,
    problem: &'static str,
    medium: &'static str,
    estimator: &'static str,
    textbook: fn(&mut Pcg64) -> f64,
}

const EQ21: &str = "volume.eq21 = {}
    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }
    sampling.constant.value = 1";

const GRID: &str =
    "volume.grid = { random = { size = [128, 128, 128], seed = 1 }, extinction = 1.2,
                    samples = \"vertices\", bounds.box = { low = [0, 0, 0], high = [10, 10, 10] } }
    ray = { origin = [0, 0.5, 0.3], direction = [1, 0.9, 0.95], length = 30 }
    sampling.constant.value = 1.2";

const NOISE: &str = "volume.noise = { extinction = 1, octaves = 12, seed = 1 }
    ray = { origin = [0.3, 0.7, -0.45], direction = [0.6, 0.5, 0.37], length = 10 }
    sampling.constant.value = 1";

const HOMOGENEOUS: &str = "medium.constant.extinction = 0.5
    span = [0, 8]
    sampling.constant.value = 1";

const ROD: &str = "volume.eq21 = {}
    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 20 }
    albedo = 0.7
    forward = 0.5
    sampling.constant.value = 1";

const LIT_ROD: &str = "medium.constant.extinction = 1
    span = [0, 2]
    albedo = 0.9
    forward = 0.75
    light = \"emitter\"
    sampling.constant.value = 1.6";

const SLAB: &str = "medium.constant.extinction = 1
    span = [0, 1.5]
    albedo = 0.7
    phase.isotropic = {}
    incidence.collimated.cosine = 0.5
    sampling.constant.value = 1.25";

const BALL: &str = "volume.radial = { centre = [0, 0, 0], radius = 1.5, coefficients = [2, -2] }
    ray = { origin = [0.5, 0, -3], direction = [0, 0, 1], length = 6 }
    albedo = 0.9
    phase.isotropic = {}
    light.environment = {}
    sampling.constant.value = 2";

const SINGLE: &str = "volume.constant.extinction = 0.8
    ray = { origin = [0, 0, 0], direction = [0, 0, 1], length = 6 }
    light.position = [0.5, 0, 2.5]
    albedo = 0.9
    phase.isotropic = {}
    sampling.constant.value = 1";

const CONTESTS: [Contest; 12] = [
    Contest {
        name: "Eq. 21, ratio",
        target: Some(15.0),
        problem: "transmittance",
        medium: EQ21,
        estimator: "ratio = {}",
        textbook: textbook::eq21_ratio,
    },
    Contest {
        name: "Eq. 21, woodcock",
        target: Some(15.0),
        problem: "transmittance",
        medium: EQ21,
        estimator: "woodcock = {}",
        textbook: textbook::eq21_woodcock,
    },
    Contest {
        name: "Eq. 21, residual ratio",
        target: None,
        problem: "transmittance",
        medium: EQ21,
        estimator: "residual-ratio.control.constant.value = 0.3",
        textbook: textbook::eq21_residual_ratio,
    },
    Contest {
        name: "Eq. 21, next-flight",
        target: None,
        problem: "transmittance",
        medium: EQ21,
        estimator: "next-flight = {}",
        textbook: textbook::eq21_next_flight,
    },
    Contest {
        name: "128³ grid, ratio",
        target: Some(6.0),
        problem: "transmittance",
        medium: GRID,
        estimator: "ratio = {}",
        textbook: textbook::grid_ratio,
    },
    Contest {
        name: "12-octave noise, ratio",
        target: Some(8.0),
        problem: "transmittance",
        medium: NOISE,
        estimator: "ratio = {}",
        textbook: textbook::noise_ratio,
    },
    Contest {
        name: "homogeneous, ratio",
        target: Some(7.0),
        problem: "transmittance",
        medium: HOMOGENEOUS,
        estimator: "ratio = {}",
        textbook: textbook::homogeneous,
    },
    Contest {
        name: "rod, analog",
        target: None,
        problem: "rod",
        medium: ROD,
        estimator: "analog = {}",
        textbook: textbook::rod_analog,
    },
    Contest {
        name: "lit rod, next-event",
        target: None,
        problem: "rod",
        medium: LIT_ROD,
        estimator: "next-event.shadow = \"ratio\"",
        textbook: textbook::lit_rod_next_event,
    },
    Contest {
        name: "slab, analog",
        target: None,
        problem: "slab",
        medium: SLAB,
        estimator: "analog = {}",
        textbook: textbook::slab_analog,
    },
    Contest {
        name: "ball, analog",
        target: None,
        problem: "ball",
        medium: BALL,
        estimator: "particle.rule = \"analog\"",
        textbook: textbook::ball_analog,
    },
    Contest {
        name: "single scattering, delta tracking",
        target: None,
        problem: "single-scattering",
        medium: SINGLE,
        estimator: "delta-tracking.shadow.ratio.sampling = 1",
        textbook: textbook::single_scattering,
    },
];

fn case(contest: &Contest) -> Case {
    let Contest { name, problem, medium, estimator, .. } = contest;
    let text = format!(
        "title = \"{name}\"\n[problem.{problem}]\n{medium}\nestimators = [{{ {estimator} }}]"
    );
    let source = CaseText { name: (*name).into(), path: "bench.toml".into(), text };
    Case::read(&source).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Returns the processor seconds of a draw, and the mean.
fn of_textbook(draw: fn(&mut Pcg64) -> f64, round: u128) -> (f64, f64) {
    let mut rng = Pcg64::new(round, 1);
    let begin = ThreadTime::now();
    let sum: f64 = (0..TEXTBOOK).map(|_| draw(&mut rng)).sum();
    let draws = TEXTBOOK as f64;
    (begin.elapsed().as_secs_f64() / draws, sum / draws)
}

fn of_kernel(planned: &PlannedExperiment, kernel: Kernel, round: u64) -> (f64, f64) {
    let ready = planned.outcome.as_ref().expect("it is not refused");
    let mut buffer = DrawBuffer::new(ready.prediction.channels.len());
    let (mut seconds, mut sum, mut draws) = (0.0, 0.0, 0);
    for block in 0..BLOCKS {
        let mut streams = planned.streams(round * BLOCKS + block);
        for _ in 0..BLOCK / DrawBuffer::LENGTH as u64 {
            let begin = ThreadTime::now();
            ready.experiment.fill_by(kernel, &mut streams, DrawBuffer::LENGTH, &mut buffer);
            seconds += begin.elapsed().as_secs_f64();
            // Not timed: the sum is a chain of dependent additions, which the textbook's loop hides.
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
    if let Some(level) = best.as_avx2() {
        kernels.push(("packets, avx2", Kernel::Packets(Level::Avx2(level))));
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
    let word = std::env::args().skip(1).find(|word| !word.starts_with('-')).unwrap_or_default();
    for contest in CONTESTS.into_iter().filter(|contest| contest.name.contains(&word)) {
        let cases = [case(&contest)];
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
        let target = contest.target.map(|target| format!(" (target {target}×)"));
        let ready = planned.outcome.as_ref().expect("it is not refused");
        let exact = ready.prediction.channels[0].truth.value;
        println!("\n{}{}, mean {exact:.5}", contest.name, target.unwrap_or_default());
        println!(
            "  {:16} {:8.2} ns          mean {book_mean:.5}",
            "textbook",
            1e9 * median(&mut book)
        );
        for (i, (name, _)) in kernels.iter().enumerate() {
            let (time, ratio) = (1e9 * median(&mut times[i]), median(&mut ratios[i]));
            println!("  {name:16} {time:8.2} ns {ratio:7.2}× mean {:.5}", means[i]);
        }
    }
}
