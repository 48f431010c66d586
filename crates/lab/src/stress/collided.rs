//! Next-flight and unidirectional MIS: moments by nodes in 32 digits.
//!
//! The Volterra equations of `theory::ray::volterra`, with `v = e^{−σ̂(ℓ−x)}`, the probability of a flight to the end, and
//! what a collision adds, `v` or `v/(1 + v)`:
//!
//! ```text
//! A_k' = σ̂(1 − ρ^k) A_k − σ̂ρ^k g_k,  A_k(ℓ) = 0,   m_k = g_k + A_k
//! ```

use super::equations::{binomial, power};
use super::nodes::{PanelLine, Solution};
use super::prelude::*;

use super::depths::knots;
use super::fields;
use estimators::transmittance::next_flight::NextFlight;
use estimators::transmittance::unidirectional_mis::UnidirectionalMis;
use theory::ray::volterra::{self, ScoreMoments};

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "1 … 4 layers, r = 0 … 1.7, 0.1 … 12 collisions";
    run.fill([16, 640], TrialRow::moments("next-flight and MIS", range), Layers::any, trial)
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
    let sources: [(&str, &dyn ScoreMoments, bool); 2] =
        [("next-flight", &NextFlight, false), ("unidirectional-mis", &UnidirectionalMis, true)];
    for (name, source, is_shared) in sources {
        seen.at(name);
        let computed = volterra::predict(&mesh, sampling, source).channels[0].moments;
        seen.moments([0, 1], computed, &raw(&breaks, &values, sampling, is_shared));
    }
}

/// `m_1 … m_4` at the beginning.
fn raw(breaks: &[f64], values: &[f64], sampling: f64, is_shared: bool) -> [DoubleDouble; 4] {
    let ends: Vec<DoubleDouble> = breaks.iter().copied().map(DoubleDouble::from).collect();
    // Twice the rate: 1/(1 + v) has a pole at v = −1.
    let line = PanelLine::new(&ends, |_| 2.0 * sampling);
    let to_end = |x: DoubleDouble| (-(sampling * (ends[ends.len() - 1] - x))).exp();
    let at =
        line.values(|layer, x| (to_end(x), 1.0 - DoubleDouble::from(values[layer]) / sampling));
    // g_k with and without A_1 … A_{k−1}.
    let added = |k: usize, v: DoubleDouble, later: &dyn Fn(usize) -> DoubleDouble| {
        let u = if is_shared { v / (1.0 + v) } else { v };
        let whole = power(u, k);
        // v(2u)^k + (1 − v)u^k
        let twice =
            if is_shared { (power(DoubleDouble::from(2.0), k) - 1.0) * v * whole } else { 0.0 * v };
        let term = |j: usize| binomial(k, j) * power(u, k - j) * later(j);
        whole + twice + (1..k).map(term).sum::<DoubleDouble>()
    };
    let mut known: Vec<Solution<DoubleDouble>> = Vec::new();
    for k in 1..=4 {
        let kept = |i: usize| power(at[i].1, k);
        let rate = |i: usize| sampling * (1.0 - kept(i));
        let source = |i: usize| sampling * kept(i) * added(k, at[i].0, &|j| known[j - 1].at[i]);
        known.push(line.one_way(rate, source));
    }
    // Something is added where nothing has been flown yet.
    let begin = |j: usize| known[j - 1].begin;
    [1, 2, 3, 4].map(|k| begin(k) + added(k, to_end(ends[0]), &begin))
}
