//! Next-flight and unidirectional-MIS estimators: moments from their Volterra equations.
//!
//! Both add a closed-form part at every collision and go on with a weight:
//!
//! ```text
//! F(x) = G(x) + A,  A = 1[x' < ℓ] ρ(x') F(x'),  x' = x + flight of rate σ̄,  ρ = 1 − σ_t/σ̄
//! ```
//!
//! With `A_k(x) = E[A^k; x' < ℓ]` and `m_k = E[F^k]`,
//!
//! ```text
//! A_k(x) = ∫ₓ^ℓ σ̄ e^{−σ̄(y−x)} ρ(y)^k m_k(y) dy,   m_k = g_k + A_k
//! ```
//!
//! where `g_k` needs only `A_1 … A_{k−1}`. Differentiation turns this into a linear equation with
//! the solution
//!
//! ```text
//! A_k(x) = ∫ₓ^ℓ σ̄ ρ^k g_k(y) exp(−∫ₓ^y σ̄ (1 − ρ^k)) dy
//! ```
//!
//! One sweep over the panels from the far end evaluates it for k = 1 … 8: four for the moments that are tested, the
//! eighth for the sample size of their tests.
//!
//! Source: I. Georgiev, Z. Misso, T. Hachisuka, D. Nowrouzezahrai, J. Křivánek, W. Jarosz,
//! *Integral formulations of volumetric transmittance*, ACM Transactions on Graphics 38 (2019);
//! next-flight after S. N. Cramer, *Application of the fictitious scattering radiation transport
//! model for deep-penetration Monte Carlo calculations*, Nuclear Science and Engineering 65 (1978).

use super::mesh::Panel;
use crate::prediction::raw::{POWERS, RawMoments};
use crate::{Channel, CountDistribution, Mesh, Moments, Prediction, Tails};
use numeric::Known;

/// Maximum relative error of central moments that are given; cancellation makes larger ones.
const WORST: f64 = 0.05;

/// The highest order.
pub const ORDERS: usize = 8;

/// The part that an estimator adds at a collision, as moments.
pub trait ScoreMoments {
    /// `g_k(x)` for k = 1 … 8 from `v = e^{−σ̄(ℓ−x)}` and `A_1 … A_8` at `x` (only lower ones
    /// than k may be used).
    fn moment(&self, k: usize, v: f64, lower: &[f64; ORDERS]) -> f64;
}

/// Mean, moments and cost of such an estimator over the whole support, at constant `σ̄ > 0`.
pub fn predict(mesh: &Mesh, sampling: f64, source: &dyn ScoreMoments) -> Prediction {
    let end = mesh.support().to;
    let layer = cuts(mesh, sampling);
    let fine = mesh.refined(&layer, &|mesh, panel| panel_functions(mesh, panel, sampling, end));
    let mut after = [0.0; ORDERS];
    for panel in fine.panels().rev() {
        after = sweep(&fine, panel, sampling, end, source, after);
    }
    let v = (-sampling * mesh.support().length()).exp();
    let raw: [f64; ORDERS] = std::array::from_fn(|k| source.moment(k + 1, v, &after) + after[k]);
    let depth = mesh.optical_depth();
    let t = raw[0];
    // The mean is known: the error of its quadrature estimates that of the others, which grows with the power.
    let missed = (t * depth.value.exp() - 1.0).abs();
    let relative_error = fine.relative_error() + missed + 1e-14;
    let [m1, m2, m3, m4, .., m8] = raw;
    let raw = RawMoments::estimated([m1, m2, m3, m4, m8], [relative_error; POWERS.len()]);
    let raw = raw.in_units_of_their_mean();
    // Central moments by subtraction: these estimators are not used where the relative spread
    // vanishes, and the loss of digits is part of the error.
    let central = raw.central(Known::estimated(t, relative_error * t), WORST);
    let is_known = central.error <= WORST && central.relative[2].is_finite();
    let flown = sampling * mesh.support().length();
    let (moments, tails) = if flown == 0.0 {
        // No collisions: every draw is the closed form.
        (Moments::certain(t), Tails::LIGHT)
    } else {
        let rare_event_size = central.kurtosis().unwrap_or(1.0);
        (central, Tails { rare_event_size, ..raw.tails(WORST) })
    };
    let moments = Moments { scale: depth.exp_neg().value, ..moments };
    let mut channel = Channel::transmittance(depth, 0.0, moments, tails);
    channel.moments = channel.moments.filter(|_| is_known || flown == 0.0);
    Prediction::single(channel, CountDistribution::poisson(flown))
}

/// Cuts towards the end of the support: v decays within a few mean free paths of the end, which may be a millionth
/// of the support.
fn cuts(mesh: &Mesh, sampling: f64) -> Vec<f64> {
    let support = mesh.support();
    let paths = std::iter::successors(Some(0.5), |paths| Some(2.0 * paths));
    let cuts = paths.map(|paths| support.to - paths / sampling);
    cuts.take_while(|&cut| cut > support.from).filter(|&cut| cut < support.to).collect()
}

/// Functions that must be smooth on a panel: v, the decay of every order, and the powers of ρ.
fn panel_functions(mesh: &Mesh, panel: Panel<'_>, sampling: f64, end: f64) -> Vec<Vec<f64>> {
    let v = panel.t.iter().map(|t| (-sampling * (end - t)).exp()).collect();
    let mut functions = vec![v];
    for k in [1, 2, 4, ORDERS] {
        let rate: Vec<f64> =
            panel.extinction.iter().map(|s| sampling * lost(s / sampling, k)).collect();
        functions.push(mesh.running(panel, &rate).iter().map(|depth| (-depth).exp()).collect());
        functions.push(rate);
    }
    functions
}

/// Takes `A_k` from the end of a panel to its beginning.
fn sweep(
    mesh: &Mesh,
    panel: Panel<'_>,
    sampling: f64,
    end: f64,
    source: &dyn ScoreMoments,
    after: [f64; ORDERS],
) -> [f64; ORDERS] {
    let ratio: Vec<f64> = panel.extinction.iter().map(|s| s / sampling).collect();
    let n = ratio.len();
    let v: Vec<f64> = panel.t.iter().map(|t| (-sampling * (end - t)).exp()).collect();
    let mut at_nodes = vec![[0.0; ORDERS]; n];
    let mut before = [0.0; ORDERS];
    for k in 1..=ORDERS {
        let rate: Vec<f64> = ratio.iter().map(|&r| sampling * lost(r, k)).collect();
        let brings =
            |i: usize| sampling * power(1.0 - ratio[i], k) * source.moment(k, v[i], &at_nodes[i]);
        let f: Vec<f64> = (0..n).map(brings).collect();
        let (result, begin) = mesh.backward(panel, &rate, &f, after[k - 1]);
        at_nodes.iter_mut().zip(result).for_each(|(node, result)| node[k - 1] = result);
        before[k - 1] = begin;
    }
    before
}

/// `x^k` for small k.
pub fn power(x: f64, k: usize) -> f64 {
    std::iter::repeat_n(x, k).product()
}

/// `1 − (1 − r)^k` without cancellation where r is small: no panel would resolve its noise.
fn lost(ratio: f64, k: usize) -> f64 {
    (0..k).fold(0.0, |sum, _| sum * (1.0 - ratio) + ratio)
}
