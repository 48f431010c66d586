//! Next-flight and unidirectional MIS: moments from power series in 32 digits.
//!
//! On a piece of constant σ_t the Volterra equations of `theory::volterra` are ordinary ones in
//! `v = e^{−σ̄(ℓ−x)}`, whose solution is continued from series to series, a quarter of v at a time.
//!
//! ```text
//! v A_k' = (1 − ρ^k) A_k − ρ^k g_k,  A_k(1) = 0;   v = v₀(1 + t),  A_k = Σ aₙ tⁿ:
//! (n + 1) aₙ₊₁ = (1 − ρ^k − n) aₙ − ρ^k [g_k]ₙ,   m_k = g_k + A_k
//! ```

use super::prelude::*;
use super::series::{self, add, binomial, constant, inverse, power, product, value};

use super::depths::knots;
use super::fields;
use estimators::transmittance::next_flight::NextFlight;
use estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use theory::volterra::{self, Source};

/// Terms of a series: at a quarter of its radius, 4⁻⁴⁸ = 1e-29 of the largest.
const TERMS: usize = 48;
/// The moments that are compared.
const ORDERS: usize = 4;

/// All rows.
pub fn rows(run: Run) -> Vec<Row> {
    let range = "1 … 4 layers, r = 0 … 1.7, 0.1 … 12 collisions";
    run.fill([16, 640], Row::moments("next-flight and MIS", range), Layers::any, trial)
}

parameters! {
    /// Widths and ratios of layers.
    Layers {
        collisions: f64 = sized(-1.0, 1.08),
        layers: Vec<(f64, f64)> = vec((between(0.1, 1.0), between(0.0, 1.7)), 1..=4),
    }
}

fn trial(Layers { collisions, layers }: &Layers, seen: &mut Seen) {
    let (widths, ratios): (Vec<f64>, Vec<f64>) = layers.iter().copied().unzip();
    let breaks = knots(0.0, &widths);
    let sampling = collisions / breaks[widths.len()];
    let values: Vec<f64> = ratios.iter().map(|ratio| sampling * ratio).collect();
    let mesh = Mesh::new(fields::pieces(&breaks, &values));
    let sources: [(&str, &dyn Source, bool); 2] =
        [("next-flight", &NextFlight, false), ("unidirectional-mis", &UnidirectionalMis, true)];
    for (name, source, is_shared) in sources {
        seen.at(name);
        let found = volterra::predict(&mesh, sampling, source).channels[0].moments;
        seen.moments(0, found, |_| {
            let raw = raw(&breaks, &values, sampling, is_shared);
            central(raw, raw[0])
        });
    }
}

/// A power series in t, cut off.
type Series = series::Series<TERMS>;

/// `v` and what is added at a collision, around `v₀`: `v` or `v/(1 + v)`.
fn parts(centre: Wide, is_shared: bool) -> [Series; 2] {
    let mut v = constant(centre);
    v[1] = centre;
    if !is_shared {
        return [v; 2];
    }
    let mut below = v;
    below[0] += Wide::ONE;
    [v, product(&v, &inverse(&below))]
}

/// `g_k` without and with what comes later, `A_1 … A_{k−1}`.
fn added(k: usize, v: &Series, powers: &[Series], later: &[Series], is_shared: bool) -> Series {
    let mut sum = powers[k];
    if is_shared {
        // v(2u)^k + (1 − v)u^k
        add(&mut sum, power(Wide::from(2.0), k) - 1.0, &product(v, &powers[k]));
    }
    for j in 1..k {
        add(&mut sum, Wide::from(binomial(k, j)), &product(&powers[k - j], &later[j - 1]));
    }
    sum
}

/// `m_1 … m_4` at the beginning.
fn raw(breaks: &[f64], values: &[f64], sampling: f64, is_shared: bool) -> [Wide; ORDERS] {
    let end = Wide::from(breaks[breaks.len() - 1]);
    let mut after = [Wide::default(); ORDERS];
    let mut centre = Wide::ONE;
    for (pair, &value_here) in breaks.windows(2).zip(values).rev() {
        let target = (-(sampling * (end - pair[0]))).exp();
        let rho = 1.0 - Wide::from(value_here) / sampling;
        while target.high < centre.high {
            let next = centre * 0.75;
            let next = if next.high > target.high { next } else { target };
            let series = continued(centre, rho, after, is_shared);
            after = std::array::from_fn(|k| value(&series[k], next / centre - 1.0));
            centre = next;
        }
    }
    // What is added where nothing has been flown yet.
    let whole = continued(centre, Wide::default(), after, is_shared);
    let [v, part] = parts(centre, is_shared);
    let powers = powers(&part);
    std::array::from_fn(|k| after[k] + added(k + 1, &v, &powers, &whole, is_shared)[0])
}

fn powers(part: &Series) -> Vec<Series> {
    let mut powers = vec![constant(Wide::ONE)];
    for k in 0..ORDERS {
        powers.push(product(&powers[k], part));
    }
    powers
}

/// The series of `A_1 … A_4` around v₀, where they have such values.
fn continued(centre: Wide, rho: Wide, values: [Wide; ORDERS], is_shared: bool) -> Vec<Series> {
    let [v, part] = parts(centre, is_shared);
    let powers = powers(&part);
    let mut all: Vec<Series> = Vec::new();
    for (k, &value) in (1_u32..).zip(&values) {
        let kept = rho.powi(k);
        let source = added(all.len() + 1, &v, &powers, &all, is_shared);
        let mut series = constant(value);
        for n in 0..TERMS - 1 {
            let at = n as f64;
            series[n + 1] = ((1.0 - kept - at) * series[n] - kept * source[n]) / (at + 1.0);
        }
        all.push(series);
    }
    all
}
