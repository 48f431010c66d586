//! Random numbers: their ends, their grain, and whether streams know of each other.

use std::f64::consts::FRAC_1_SQRT_2;

use super::{Effort, Measure, Row};
use gate::stats::{anderson_darling, chi_square, correlation, ties};
use media::Piecewise;
use numeric::rng::{Address, LANES, Stream, Streams, exponential, name_hash, unit};
use numeric::{Span, Wide};
use theory::parallel;

/// Uniform numbers are multiples of this.
const GRAIN: f64 = f64::EPSILON / 2.0;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    vec![
        ends(),
        collisions(),
        distances(effort, seed),
        equal_distances(effort, seed),
        overlaps(effort, seed),
        lagged(effort, seed),
        dispersion(effort, seed),
    ]
}

/// A stream whose next word is known.
fn before(word: u64) -> Stream {
    // out = s₀ + s₃ with s₀ = 0.
    Stream::at([0, 1, 2, word])
}

fn ends() -> Row {
    let range = "words 0, 2¹¹, 2⁶³, 2⁶⁴ − 1 and neighbours";
    let mut row = Row::wrong("uniforms outside their range", range);
    for near in [0, 1 << 11, 1 << 63, u64::MAX] {
        for word in [near, near.wrapping_sub(1), near.wrapping_add(1)] {
            let numbers = [before(word).uniform(), unit(&mut before(word))];
            let positive = before(word).positive_uniform();
            let flights = [-before(word).ln_uniform(), exponential(&mut before(word))];
            let is_right = before(word).word() == word
                && numbers.iter().all(|u| (0.0..1.0).contains(u))
                && positive > 0.0
                && positive <= 1.0
                && flights.iter().all(|depth| (0.0..36.8).contains(depth));
            row.count(!is_right, || format!("word {word:#x}"));
        }
    }
    row
}

/// How many of the 2⁵³ numbers make a flight that ends within an optical depth: a whole number, found
/// by bisection, against `1 − e^{−τ}`.
fn collisions() -> Row {
    let range = "τ = 1e-18 … 36, all 2⁵³ numbers";
    let mut row = Row::new("chance of a collision", range, Measure::Absolute, 3.0 * GRAIN);
    for step in 0..400 {
        let depth = 10f64.powf(-18.0 + 19.55 * f64::from(step) / 400.0);
        let is_within = |k: u64| -before(k << 11).ln_uniform() < depth;
        let (mut low, mut high) = (0, 1_u64 << 53);
        while low < high {
            let middle = low.midpoint(high);
            if is_within(middle) { low = middle + 1 } else { high = middle }
        }
        let exact = -(-Wide::from(depth)).exp_m1();
        let off = (Wide::from(low as f64 * GRAIN) - exact).abs().value();
        row.see(off, || format!("τ = {depth:.3e}"));
    }
    row
}

/// Flights through σ̂ of any size: each is `−ln(u)/σ̂`.
fn distances(effort: Effort, seed: u64) -> Row {
    let range = "σ̂ = 1e-9 … 1e9";
    let mut row = Row::relative("distance of a flight", range, 1e-15);
    for power in -9..=9 {
        let sampling = 10f64.powi(power);
        let field = Piecewise::constant(sampling, Span::new(0.0, 40.0 / sampling));
        let mut stream = address(seed, "distances", power.unsigned_abs().into(), 0).stream();
        for _ in 0..effort.of(50, 2000) {
            let uniform = stream.clone().positive_uniform();
            let depth = -stream.ln_uniform();
            let mut cursor = field.begin();
            if uniform < 1.0 && field.fly(&mut cursor, depth).is_some() {
                let exact = -Wide::from(uniform).ln() / Wide::from(sampling);
                let place = || format!("u = {uniform:e}, σ̂ = {sampling:e}");
                row.see(exact.relative_error(cursor.t), place);
            }
        }
    }
    row
}

/// Two flights of equal length among many: as seldom as 53 bits promise.
fn equal_distances(effort: Effort, seed: u64) -> Row {
    let range = "σ̂ = 1e-9 … 1e9";
    let name = "flights of equal length";
    let mut row = Row::improbable(name, range);
    let draws = effort.of(20_000, 1_000_000);
    for power in [-9, -3, 0, 9] {
        let sampling = 10f64.powi(power);
        let field = Piecewise::constant(sampling, Span::new(0.0, 40.0 / sampling));
        let mut stream = address(seed, "equal distances", power.unsigned_abs().into(), 0).stream();
        let mut flights: Vec<f64> = (0..draws)
            .map(|_| {
                let mut cursor = field.begin();
                field.fly(&mut cursor, -stream.ln_uniform());
                cursor.t
            })
            .collect();
        let expected = f64::from(draws) * f64::from(draws) * GRAIN / 2.0;
        let found = ties::ties(&mut flights);
        let p = ties::p_value(found, expected);
        row.see(-p.log10(), || format!("{found} of {draws} at σ̂ = {sampling:e}"));
    }
    row
}

fn address(seed: u64, name: &str, block: u64, lane: u64) -> Address {
    Address { seed, experiment: name_hash(&format!("stress|{name}")), block, lane }
}

/// The streams of many blocks of several experiments and seeds.
fn blocks(effort: Effort, seed: u64) -> Vec<Streams> {
    let mut all = Vec::new();
    for run in 0..effort.of(2, 8) {
        for experiment in ["ratio|0.5", "ratio|0.6", "woodcock|0.5"] {
            for block in 0..effort.of(4, 32) {
                all.push(address(seed + run, experiment, block, 0).streams());
            }
        }
    }
    all
}

/// A word whose upper bits are zero marks a place of a stream; overlapping streams share such words.
fn overlaps(effort: Effort, seed: u64) -> Row {
    let blocks = blocks(effort, seed);
    let words = effort.of(1 << 14, 1 << 17);
    let range = format!("{} blocks of {LANES} streams, {words} words each", blocks.len());
    let mut row = Row::wrong("words that streams share", range);
    let marked = parallel::map(&blocks, |streams| -> Vec<u64> {
        streams.clone().words().take(words).filter(|word| word >> 56 == 0).collect()
    });
    let mut marked = marked.concat();
    marked.sort_unstable();
    marked.windows(2).for_each(|pair| {
        row.count(pair[0] == pair[1], || format!("word {:#x}", pair[0]));
    });
    row
}

/// Correlations of neighbours at all lags: lanes of a block, blocks, experiments, seeds.
fn lagged(effort: Effort, seed: u64) -> Row {
    const NUMBERS: usize = 16_384;
    let blocks = blocks(effort, seed);
    let standard = |streams: &Streams| -> Vec<Vec<f64>> {
        let mut lanes = streams.lanes;
        let number = |stream: &mut Stream| 12f64.sqrt() * (stream.uniform() - 0.5);
        lanes.iter_mut().map(|lane| (0..NUMBERS).map(|_| number(lane)).collect()).collect()
    };
    let found = parallel::range(blocks.len() - 1, |i| {
        let (here, next) = (standard(&blocks[i]), standard(&blocks[i + 1]));
        let pairs = here.windows(2).map(|pair| correlation::lagged(&pair[0], &pair[1], -16..=16));
        let across = here.iter().zip(&next).map(|(a, b)| correlation::lagged(a, b, -16..=16));
        let own = here.iter().map(|lane| correlation::lagged(lane, lane, 1..=32));
        pairs.chain(across).chain(own).flatten().collect::<Vec<_>>()
    });
    let found: Vec<correlation::Lagged> = found.into_iter().flatten().collect();
    let range = format!("{} pairs of streams, 32 lags", found.len());
    let mut row = Row::improbable("correlation of streams", range);
    for pair in &found {
        let p = (pair.p_value * found.len() as f64).min(1.0);
        row.see(-p.log10(), || format!("lag {}, z = {:.2}", pair.lag, pair.z));
    }
    row
}

/// The means of blocks: normal, neither too far from each other nor too near.
fn dispersion(effort: Effort, seed: u64) -> Row {
    const DRAWS: u32 = 4096;
    let blocks = effort.of(512, 16_384);
    let mut z: Vec<f64> = parallel::numbered(blocks, |block| {
        let mut streams = address(seed, "dispersion", block, 0).streams();
        let sum: f64 = (0..DRAWS).map(|_| -streams.of_next_draw().ln_uniform() - 1.0).sum();
        sum / f64::from(DRAWS).sqrt()
    });
    let range = format!("{blocks} blocks of {DRAWS} flights");
    let mut row = Row::improbable("z-scores of blocks", range);
    let squares: f64 = z.iter().map(|z| z * z).sum();
    row.see(-chi_square::two_sided(squares, blocks as f64).log10(), || "their spread".to_owned());
    let neighbours = correlation::lagged(&z, &z, 1..=64).map_or(1.0, |found| found.p_value);
    row.see(-neighbours.log10(), || "neighbours".to_owned());
    z.sort_by(f64::total_cmp);
    // An exponential mean of 4096 has skewness 2/64: Edgeworth's first term takes it away.
    let skewness = 2.0 / f64::from(DRAWS).sqrt();
    let uniform = |z: f64| {
        let density = (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt();
        let below = 0.5 * libm::erfc(-z * FRAC_1_SQRT_2) - skewness / 6.0 * (z * z - 1.0) * density;
        below.clamp(0.0, 1.0)
    };
    let mut uniforms: Vec<f64> = z.into_iter().map(uniform).collect();
    uniforms.sort_by(f64::total_cmp);
    let p = anderson_darling::p_value_of_uniforms(&uniforms);
    row.see(-p.log10(), || "their law".to_owned());
    row
}
