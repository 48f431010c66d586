//! How much faster packets are than the plainest scalar loop.
//!
//! `cargo bench --bench kernels`, or with `-- WORD` only the comparisons whose name has the word. The
//! plainest loop is what a textbook shows: one draw after the
//! other, the standard library's `ln` and `cos`, one PCG generator. Both sides are drawn in turn in
//! one process and timed by processor time; a ratio is taken within its round, and the median of the
//! rounds is reported. On the homogeneous medium the textbook's density is hidden from the compiler,
//! which would otherwise delete the lookups.
//!
//! The textbook's grid is looked up in space: eight voxels, seven linear interpolations. Its noise is
//! Perlin's own program of 2002 with a table of permutations; the field here chooses its gradients by
//! a hash, so that the two means differ and the work does not.

use std::hint::black_box;
use std::sync::LazyLock;

use cpu_time::ThreadTime;
use fearless_simd::Level;
use rand::Rng;
use rand_pcg::Pcg64;
use trueflight::case::Case;
use trueflight::case::Source;
use trueflight::estimators::{DrawBuffer, Kernel};
use trueflight::media::lattice::hash3;
use trueflight::plan::Amount;
use trueflight::plan::Options;
use trueflight::plan::Plan;
use trueflight::plan::{BLOCK, Planned};

const ROUNDS: usize = 7;
/// Draws of the textbook's loop in a round.
const TEXTBOOK: u64 = 100_000;
/// Blocks of packets in a round.
const BLOCKS: u64 = 16;

/// One comparison.
struct Contest {
    name: &'static str,
    /// The least ratio of times on AVX-512; `None` for no target.
    target: Option<f64>,
    case: &'static str,
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

const CONTESTS: [Contest; 6] = [
    Contest { name: "Eq. 21, ratio", target: Some(15.0), case: "ratio", textbook: eq21_ratio },
    Contest {
        name: "Eq. 21, woodcock",
        target: Some(15.0),
        case: "woodcock",
        textbook: eq21_woodcock,
    },
    Contest {
        name: "Eq. 21, next-flight",
        target: None,
        case: "next-flight",
        textbook: eq21_next_flight,
    },
    Contest { name: "128³ grid, ratio", target: Some(6.0), case: "grid", textbook: grid_ratio },
    Contest {
        name: "12-octave noise, ratio",
        target: Some(8.0),
        case: "noise",
        textbook: noise_ratio,
    },
    Contest {
        name: "homogeneous, ratio",
        target: Some(7.0),
        case: "homogeneous",
        textbook: homogeneous,
    },
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

fn eq21_next_flight(rng: &mut Pcg64) -> f64 {
    let (majorant, length): (f64, f64) = (black_box(1.0), black_box(20.0));
    let (mut t, mut weight, mut score) = (0.0, 1.0, (-majorant * length).exp());
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return score;
        }
        weight *= 1.0 - eq21(0.0, 0.0, t) / majorant;
        score += weight * (-majorant * (length - t)).exp();
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

/// 128³ random voxels, x first.
static VOXELS: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let value = |n: u32| f64::from(hash3(n % 128, n / 128 % 128, n / 16_384, 1)) / 4_294_967_296.0;
    (0..1 << 21).map(value).collect()
});

/// The interpolation of the eight voxels about a point of the box.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // within the box
fn voxels(values: &[f64], p: [f64; 3]) -> f64 {
    let u = p.map(|x| x * 12.7);
    let i = u.map(|u| (u as usize).min(126));
    let f = [u[0] - i[0] as f64, u[1] - i[1] as f64, u[2] - i[2] as f64];
    let at = |x: usize, y: usize, z: usize| values[((i[2] + z) * 128 + i[1] + y) * 128 + i[0] + x];
    let lerp = |f: f64, a: f64, b: f64| a + f * (b - a);
    let row = |y: usize, z: usize| lerp(f[0], at(0, y, z), at(1, y, z));
    lerp(f[2], lerp(f[1], row(0, 0), row(1, 0)), lerp(f[1], row(0, 1), row(1, 1)))
}

fn grid_ratio(rng: &mut Pcg64) -> f64 {
    let values = &VOXELS[..];
    let (majorant, size) = (black_box(1.2), (1.0f64 + 0.9 * 0.9 + 0.95 * 0.95).sqrt());
    let (length, d) = (10.0 * size, [1.0 / size, 0.9 / size, 0.95 / size]);
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        let p = [t * d[0], 0.5 + t * d[1], 0.3 + t * d[2]];
        weight *= 1.0 - 1.2 * voxels(values, p) / majorant;
    }
}

/// A permutation of 0 to 255, twice.
static PERMUTATION: LazyLock<Vec<usize>> = LazyLock::new(|| {
    let mut table: Vec<(u32, usize)> = (0..256).map(|n| hash3(n, 0, 0, 1)).zip(0..).collect();
    table.sort_unstable();
    let table: Vec<usize> = table.into_iter().map(|(_, n)| n).collect();
    table.repeat(2)
});

fn grad(hash: usize, x: f64, y: f64, z: f64) -> f64 {
    let h = hash & 15;
    let u = if h < 8 { x } else { y };
    let v = if h < 4 {
        y
    } else if h == 12 || h == 14 {
        x
    } else {
        z
    };
    (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
}

/// Improved noise, as its author wrote it.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the low eight bits
fn improved_noise(p: &[usize], x: f64, y: f64, z: f64) -> f64 {
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let lerp = |t: f64, a: f64, b: f64| a + t * (b - a);
    let cell = |x: f64| (x.floor() as i64 & 255) as usize;
    let (i, j, k) = (cell(x), cell(y), cell(z));
    let (x, y, z) = (x - x.floor(), y - y.floor(), z - z.floor());
    let (u, v, w) = (fade(x), fade(y), fade(z));
    let (a, b) = (p[i] + j, p[i + 1] + j);
    let (aa, ab, ba, bb) = (p[a] + k, p[a + 1] + k, p[b] + k, p[b + 1] + k);
    let near = lerp(
        v,
        lerp(u, grad(p[aa], x, y, z), grad(p[ba], x - 1.0, y, z)),
        lerp(u, grad(p[ab], x, y - 1.0, z), grad(p[bb], x - 1.0, y - 1.0, z)),
    );
    let z = z - 1.0;
    let far = lerp(
        v,
        lerp(u, grad(p[aa + 1], x, y, z), grad(p[ba + 1], x - 1.0, y, z)),
        lerp(u, grad(p[ab + 1], x, y - 1.0, z), grad(p[bb + 1], x - 1.0, y - 1.0, z)),
    );
    lerp(w, near, far)
}

fn noise_ratio(rng: &mut Pcg64) -> f64 {
    let table = &PERMUTATION[..];
    let (majorant, length) = (black_box(1.0), black_box(10.0));
    let size = (0.6f64 * 0.6 + 0.5 * 0.5 + 0.37 * 0.37).sqrt();
    let d = [0.6 / size, 0.5 / size, 0.37 / size];
    let bound = 1.036_353_811_211_802_7 * (2.0 - 0.5f64.powi(11));
    let (mut t, mut weight) = (0.0, 1.0);
    loop {
        t -= (1.0 - uniform(rng)).ln() / majorant;
        if t >= length {
            return weight;
        }
        let p = [0.3 + t * d[0], 0.7 + t * d[1], -0.45 + t * d[2]];
        let (mut sum, mut amplitude, mut scale) = (0.0, 1.0, 1.0);
        for _ in 0..12 {
            sum += amplitude * improved_noise(table, p[0] * scale, p[1] * scale, p[2] * scale);
            (amplitude, scale) = (0.5 * amplitude, 2.0 * scale);
        }
        weight *= 1.0 - (0.5 + 0.5 * sum / bound) / majorant;
    }
}

fn case(name: &str) -> Case {
    let body = match name {
        "ratio" | "woodcock" | "next-flight" => {
            format!("{EQ21}\nestimators = [{{ {name} = {{}} }}]")
        }
        "grid" => format!("{GRID}\nestimators = [{{ ratio = {{}} }}]"),
        "noise" => format!("{NOISE}\nestimators = [{{ ratio = {{}} }}]"),
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
        let target = contest.target.map(|target| format!(" (target {target}×)"));
        println!("\n{}{}", contest.name, target.unwrap_or_default());
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
