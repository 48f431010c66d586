//! Every moment of a walk through a rod, from its two-stream equations.
//!
//! Let `Q_k` and `S_k` be those of a rule's [`crate::Kernel`], and `c = r(1 − a)` for the absorbed energy and
//! `c = 1/(σ̂ width)` for the flux. The k-th moment of the particle's score solves the equations of `line` with
//!
//! ```text
//! A_k = σ̂(1 − Q_k − S_k p_f),  B_k = σ̂ S_k p_b
//! reflectance^k, transmittance^k:  no source; leaving is worth 1 at that end
//! of scattering order n:           A = σ̂(1 − Q_k), B = 0, source σ̂ S_k(p_f, p_b) of order n − 1
//! Y^j X^k, Y = Σ c w a score:      source σ̂ Σ_{i<j} (j over i) c^{j−i} (Q, S)_{i+k} of Y^i X^k
//! M(M − 1)…(M − n + 1), M lookups: A₀, B₀, source n σ̂ (Q, S)₀ of the one before, and n σ̂ for n = 1
//! ```
//!
//! Each is the expectation over the events at the next collision. Terms with different powers of the weight never
//! mix: therefore the equations close.

use super::line::{Importance, Line};
use super::walk::RodPoint;
use crate::prediction::raw::binomial;
use crate::problems::rod::RodQuantity;

/// `E[Y^j X^k]` for j, k = 1, 2, of the absorbed energy and what leaves at one end.
pub type Joint = [[f64; 2]; 2];

fn nothing(_: usize, _: &RodPoint) -> [f64; 2] {
    [0.0; 2]
}

const BEGINNING: [f64; 2] = [1.0, 0.0];
const END: [f64; 2] = [0.0, 1.0];

/// `E[X^k]` of a channel; a flux is the mean in parts of a width.
pub fn power(line: &Line, quantity: RodQuantity, width: f64, k: i32) -> Option<f64> {
    let worth = match quantity {
        RodQuantity::Reflected => line.flow(k)?.solve(&nothing, BEGINNING),
        RodQuantity::Transmitted => line.flow(k)?.solve(&nothing, END),
        RodQuantity::ReflectedBy(order) => by_order(line, k, BEGINNING, order)?,
        RodQuantity::TransmittedBy(order) => by_order(line, k, END, order)?,
        RodQuantity::Absorbed => score_times(line, &absorbed, k, None)?.pop()?,
        RodQuantity::Flux(part) => {
            let flux = move |node: &RodPoint, power: i32| {
                // σ̂ c = 1/width even where both c and a flight through σ̂ = 0 are infinite.
                if node.part == part { node.sampling.powi(1 - power) } else { 0.0 }
            };
            let path = score_times(line, &flux, k, None)?.pop()?;
            return Some(path.entering / width.powi(k));
        }
    };
    Some(worth.entering)
}

fn by_order(line: &Line, k: i32, ends: [f64; 2], order: usize) -> Option<Importance> {
    let flow = line.straight(k)?;
    let mut worth = flow.solve(&nothing, ends);
    for _ in 0..order {
        let source = |i: usize, node: &RodPoint| {
            let scattered = node.kernel(k).scattering();
            node.spread(worth.at(i)).map(|spread| scattered * spread)
        };
        worth = flow.solve(&source, [0.0; 2]);
    }
    Some(worth)
}

/// `σ̂ c^k` of a score.
type ScorePower<'f> = dyn Fn(&RodPoint, i32) -> f64 + 'f;

fn absorbed(node: &RodPoint, power: i32) -> f64 {
    node.sampling * node.absorbed.powi(power)
}

/// `Y^i X^k` for i = 0 … j; `X^k` is the weight that leaves at one end to the power k, or 1.
fn score_times(
    line: &Line,
    score: &ScorePower<'_>,
    j: i32,
    end: Option<([f64; 2], i32)>,
) -> Option<Vec<Importance>> {
    let (first, k) = match end {
        Some((ends, k)) => (line.flow(k)?.solve(&nothing, ends), k),
        None => (line.one(), 0),
    };
    let mut result = vec![first];
    for power in 1..=j {
        let source = |at: usize, node: &RodPoint| {
            let mut sum = [0.0; 2];
            let mut ways = 1.0;
            for (i, worth) in (0_i32..).zip(&result) {
                let left = power - i;
                let share = ways * score(node, left);
                let order = i + k;
                // With the power 0 of the weight nothing is lost at any event.
                let worth = worth.at(at);
                let after = if order == 0 { worth } else { node.after(order, worth) };
                sum = [sum[0] + share * after[0], sum[1] + share * after[1]];
                ways *= f64::from(left) / f64::from(i + 1);
            }
            sum
        };
        let worth = line.flow(power + k)?.solve(&source, [0.0; 2]);
        result.push(worth);
    }
    Some(result)
}

/// See [`Joint`]; what leaves at the beginning is reflected.
pub fn joint(line: &Line) -> Option<Joint> {
    let mut joint = [[0.0; 2]; 2];
    for k in [1, 2] {
        let result = score_times(line, &absorbed, 2, Some((BEGINNING, k)))?;
        let place = usize::from(k == 2);
        joint[0][place] = result[1].entering;
        joint[1][place] = result[2].entering;
    }
    Some(joint)
}

/// The factorial moments `E[M(M − 1)…(M − n + 1)]` of the number of lookups, n = 1 … 4.
pub fn lookups(line: &Line) -> Option<[f64; 4]> {
    lookups_with(line, &|_| [1.0, 0.0, 0.0, 0.0, 0.0])
}

/// The factorial moments of the number of lookups, given those of the K further lookups of a scattering at each node,
/// n = 0 … 4. The further ones add `σ̂ S₀ Σⱼ (n over j) E[K(K − 1)…(K − j + 1)]` times the moment n − j to a source.
pub fn lookups_with(line: &Line, further: &dyn Fn(usize) -> [f64; 5]) -> Option<[f64; 4]> {
    let flow = line.flow(0)?;
    let mut result: Vec<Importance> = Vec::new();
    for n in 1..=4_usize {
        let source = |at: usize, node: &RodPoint| {
            let worth = |m: usize| if m == 0 { [1.0; 2] } else { result[m - 1].at(at) };
            // With j or more of the further lookups, and the others afterwards.
            let further = further(at);
            let scattered = |m: usize, minimum: usize| {
                let mut sum = [0.0; 2];
                for (j, moment) in further.iter().enumerate().take(m + 1).skip(minimum) {
                    let share = binomial(m, j) * moment;
                    let spread = node.spread(worth(m - j));
                    sum = [sum[0] + share * spread[0], sum[1] + share * spread[1]];
                }
                sum
            };
            let kernel = node.kernel(0);
            let (own, after, on) = (scattered(n, 1), scattered(n - 1, 0), worth(n - 1));
            [0, 1].map(|d| {
                let later = if n == 1 { 1.0 } else { kernel.after(on[d], after[d]) };
                node.sampling * (kernel.scattered * own[d] + n as f64 * later)
            })
        };
        result.push(flow.solve(&source, [0.0; 2]));
    }
    Some(std::array::from_fn(|n| result[n].entering))
}
