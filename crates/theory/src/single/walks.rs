//! Draws that scatter at many points of one walk.
//!
//! ```text
//! at every collision   X = Σᵢ wᵢ hᵢ T̂_shadow,  h = σ_t S/σ̂,  wᵢ = T_c(tᵢ) ∏_{j<i} (1 − rⱼ)
//! resampled            X = (Σᵢ |wᵢ| hᵢ) sgn(w_J) T̂_shadow(t_J),  J chosen with probability ∝ |w_J| h_J
//! at n points of a density p    X = (1/n) Σⱼ T̂(sⱼ) σ_t S/p T̂_shadow,  one T̂ for all
//! ```

use super::camera::Losses;
use super::chain::{At, Chain, SolvedChain};
use super::predict::{DENSITY, LOOKUPS, MOMENT, TechniqueMoments};
use super::scene::{RayNode, RayScene};
use super::segment::Segment;
use super::shadows::Among;
use crate::prediction::raw::{self, RawMoments, added, binomial, poisson, power};
use numeric::{Known, Span};

/// The orders `n₁ … n₄` of the moments of a shared walk, from the fewest points to the most.
pub const ORDERS: [[usize; 4]; 11] = [
    [1, 0, 0, 0],
    [0, 1, 0, 0],
    [2, 0, 0, 0],
    [0, 0, 1, 0],
    [1, 1, 0, 0],
    [3, 0, 0, 0],
    [0, 0, 0, 1],
    [1, 0, 1, 0],
    [0, 2, 0, 0],
    [2, 1, 0, 0],
    [4, 0, 0, 0],
];

/// Raw moments on halved panels. Their errors are the difference to the moments on the panels, and the rounding of the
/// terms, relative to the sums of their absolute values. `powers` returns moments and these sums.
fn both(
    scene: &RayScene,
    panels: &[Span],
    rounding: f64,
    powers: impl Fn(&Chain) -> [[f64; 5]; 2],
) -> RawMoments {
    let [coarse, _] = powers(&Chain::new(scene, panels, Among::Half));
    let halved: Vec<Span> = panels.iter().flat_map(|x| x.halves()).collect();
    let [fine, sizes] = powers(&Chain::new(scene, &halved, Among::All));
    let known = |k: usize| {
        let rounded = (SUMS + rounding) * sizes[k].abs().max(fine[k].abs());
        Known::of_resolutions(fine[k], coarse[k]).blurred(rounded)
    };
    RawMoments([known(1), known(2), known(3), known(4), Known::UNKNOWN])
}

/// Relative rounding error of running sums over panels.
const SUMS: f64 = 1e-13;

/// Relative rounding error of the fourth power of the score at a node.
fn blur(node: &RayNode) -> f64 {
    4.0 * (node.error[0] + DENSITY) + node.camera.error + node.shadow.error
}

/// σ̂, `h` and the weight after a collision; h = 0 where σ̂ is zero, since the residual is zero there.
fn gain(at: &At) -> [f64; 3] {
    let [sampling, weight] = at.collision;
    if sampling <= 0.0 {
        return [0.0, 0.0, 1.0];
    }
    [sampling, at.node.extinction * at.node.source / sampling, weight]
}

/// Panels that resolve `p E[(h T̂_shadow)^k] E[T̂^k]`, k = 1 … 4, with p the density of scatterings.
struct Scattered {
    panels: Vec<Span>,
    /// `∫ p E[N^k]`, k = 1 … 4, of the lookups, and the error of the first.
    lookups: [f64; 4],
    off: f64,
    /// The largest relative rounding error of a power.
    rounding: f64,
}

/// Integrates over scatterings; `at` returns the powers, the lookups and the relative rounding of a power at a
/// node.
fn scattered(scene: &RayScene, at: impl Fn(&RayNode) -> ([f64; 4], [f64; 4], f64)) -> Scattered {
    let mut parts = [MOMENT; 12];
    parts[4..8].fill(LOOKUPS);
    parts[8..].fill(f64::INFINITY);
    let result = scene.integrate(parts, Vec::new(), &|node| {
        let (powers, lookups, blur) = at(node);
        let rows = [powers, lookups, powers.map(|power| power.abs() * blur)];
        std::array::from_fn(|i| rows[i / 4][i % 4])
    });
    let rows = |row: usize| -> [f64; 4] { std::array::from_fn(|i| result.value[4 * row + i]) };
    let shares = rows(2).into_iter().zip(rows(0)).map(|(rounded, power)| rounded / power.abs());
    let rounding = shares.fold(0.0, f64::max);
    Scattered { lookups: rows(1), off: result.error[4], rounding, panels: result.panels }
}

/// The lookups of a shadow ray, if one is cast.
fn of_shadow(node: &RayNode) -> [f64; 5] {
    if node.extinction > 0.0 { node.shadow.lookups } else { Segment::free().lookups }
}

/// Scatterings at collisions: `p = σ̂`, and the lookups are the cumulants of a compound Poisson number, moments of
/// the lookups of each collision.
fn scattered_at_collisions(scene: &RayScene) -> Scattered {
    scattered(scene, |node: &RayNode| {
        let [sampling, _] = scene.camera.collision(node.s, node.extinction);
        if sampling <= 0.0 {
            return ([0.0; 4], [0.0; 4], 0.0);
        }
        let h = node.extinction * node.source / sampling;
        let each = added([1.0; 5], of_shadow(node));
        let of = |k: usize| {
            sampling * power(h, k) * node.camera.powers[k - 1] * node.shadow.powers[k - 1]
        };
        let from_first = [1, 2, 3, 4];
        (from_first.map(of), from_first.map(|k| sampling * each[k]), blur(node))
    })
}

/// The powers 1 … most of `Σ wᵢ sᵢ` over the collisions of a walk, or of `Σ |wᵢ| sᵢ`; `scored` is `E[sᵢ^j]` given h.
fn powers_of_sum(
    chain: &Chain,
    maximum: usize,
    signed: bool,
    scored: &dyn Fn(&At, f64, usize) -> f64,
) -> Vec<SolvedChain> {
    let mut known: Vec<SolvedChain> = Vec::new();
    for k in 1..=maximum {
        let loss = |losses: &Losses| if signed { losses.signed[k] } else { losses.sizes[k] };
        let solved = chain.solve(&loss, &|at, p, i| {
            let [sampling, h, weight] = gain(at);
            let weight = if signed { weight } else { weight.abs() };
            let lower = |n: usize| if n == 0 { 1.0 } else { known[n - 1].at[p][i] };
            let term =
                |j: usize| binomial(k, j) * scored(at, h, j) * power(weight, k - j) * lower(k - j);
            sampling * (1..=k).map(term).sum::<f64>()
        });
        known.push(solved);
    }
    known
}

/// Moments of draws that scatter at every collision.
pub fn at_collisions(scene: &RayScene) -> TechniqueMoments {
    let Scattered { panels, lookups: cumulants, off, rounding } = scattered_at_collisions(scene);
    let of = |chain: &Chain, signed: bool| {
        let scored = |at: &At, h: f64, j: usize| power(h, j) * at.node.shadow.powers[j - 1];
        let known = powers_of_sum(chain, 4, signed, &scored);
        std::array::from_fn(|k| if k == 0 { 1.0 } else { known[k - 1].begin })
    };
    let powers = |chain: &Chain| {
        let sizes = if chain.is_signed() { of(chain, false) } else { [0.0; 5] };
        [of(chain, true), sizes]
    };
    let raw = both(scene, &panels, rounding, powers);
    let (truth, lookups) = (scene.radiance(), Some(raw::of_cumulants(cumulants)));
    let counted = SUMS + off / cumulants[0];
    TechniqueMoments { truth, raw, lookups, minimum: 0.0, counted, shadow_lookups: None }
}

/// Moments of resampled draws: one of the collisions casts a shadow ray for all.
///
/// ```text
/// E[X^k] = E[F^{k−1} G_k],  F = Σ |wᵢ| hᵢ,  G_k = Σ hᵢ |wᵢ| sgn(wᵢ)^k E[T̂_shadow(tᵢ)^k]
/// ```
pub fn resampled(scene: &RayScene, shadow_is_free: bool) -> TechniqueMoments {
    let Scattered { panels, rounding, .. } = scattered_at_collisions(scene);
    let powers = |chain: &Chain| {
        let f = powers_of_sum(chain, 3, false, &|_, h, j| power(h, j));
        let last = |k: usize, odd: bool| {
            let mut g: Vec<SolvedChain> = Vec::new();
            for j in 0..k {
                let loss = |losses: &Losses| match (odd, j) {
                    (true, 1) => losses.mixed,
                    (true, _) => losses.signed[j + 1],
                    (false, _) => losses.sizes[j + 1],
                };
                let solved = chain.solve(&loss, &|at, p, i| {
                    let [sampling, h, weight] = gain(at);
                    let size = weight.abs();
                    let last = if odd { weight } else { size };
                    let lower = |n: usize| if n == 0 { 1.0 } else { f[n - 1].at[p][i] };
                    let shadow = at.node.shadow.powers[k - 1];
                    let term = |n: usize| {
                        let scored = h * shadow * lower(j - n);
                        let later = if n == 0 { 0.0 } else { last * g[j - n].at[p][i] };
                        binomial(j, n) * power(h, n) * power(size, j - n) * (scored + later)
                    };
                    sampling * (0..=j).map(term).sum::<f64>()
                });
                g.push(solved);
            }
            g[k - 1].begin
        };
        let [mut powers, mut sizes] = [[1.0, 0.0, 0.0, 0.0, 0.0]; 2];
        for k in 1..5 {
            let odd = k % 2 == 1;
            powers[k] = last(k, odd);
            if odd && chain.is_signed() {
                sizes[k] = last(k, false);
            }
        }
        [powers, sizes]
    };
    let raw = both(scene, &panels, rounding, powers);
    // The collision that casts the ray depends on all of them; without lookups of the ray this does not matter.
    let lookups = shadow_is_free.then(|| poisson(scene.camera.collisions()));
    let truth = scene.radiance();
    TechniqueMoments { truth, raw, lookups, minimum: 0.0, counted: SUMS, shadow_lookups: None }
}

/// Moments of draws at `count` points of a density, all with the transmittance of one walk over the whole ray.
pub fn at_points(
    scene: &RayScene,
    count: usize,
    density: &dyn Fn(&RayNode) -> f64,
) -> TechniqueMoments {
    let scored = |node: &RayNode, k: usize| {
        let p = density(node);
        p * power(node.extinction * node.source / p, k) * node.shadow.powers[k - 1]
    };
    let result = scattered(scene, |node: &RayNode| {
        let shadow = of_shadow(node);
        let from_first = [1, 2, 3, 4];
        let powers = from_first.map(|k| scored(node, k) * node.camera.powers[k - 1]);
        let lookups = from_first.map(|k| density(node) * shadow[k]);
        (powers, lookups, blur(node) + 4.0 * DENSITY)
    });
    let powers = |chain: &Chain| {
        // E[A₁^{n₁} A₂^{n₂} …] with A_m = ∫ p (T̂ σ_t S/p)^m E[T̂_shadow^m] ds, by total degree.
        let mut known: Vec<([usize; 4], SolvedChain)> = Vec::new();
        for order in ORDERS {
            let degree: usize = order.iter().enumerate().map(|(i, n)| (i + 1) * n).sum();
            let solved = chain.solve(&|losses| losses.signed[degree], &|at, p, i| {
                let term = |m: usize| {
                    if order[m] == 0 {
                        return 0.0;
                    }
                    let mut lower = order;
                    lower[m] -= 1;
                    let rest = known.iter().find(|(order, _)| *order == lower);
                    let rest = rest.map_or(1.0, |(_, solved)| solved.at[p][i]);
                    order[m] as f64 * scored(&at.node, m + 1) * rest
                };
                (0..4).map(term).sum()
            });
            known.push((order, solved));
        }
        let of: Vec<f64> = known.iter().map(|(_, solved)| solved.begin).collect();
        let n = count as f64;
        let (two, three, four) =
            (n * (n - 1.0), n * (n - 1.0) * (n - 2.0), n * (n - 1.0) * (n - 2.0) * (n - 3.0));
        let third = n * of[3] + 3.0 * two * of[4] + three * of[5];
        let fourth =
            n * of[6] + two * (4.0 * of[7] + 3.0 * of[8]) + 6.0 * three * of[9] + four * of[10];
        let second = n * of[1] + two * of[2];
        // All terms are positive.
        [[1.0, of[0], second / n.powi(2), third / n.powi(3), fourth / n.powi(4)], [0.0; 5]]
    };
    let raw = both(scene, &result.panels, result.rounding, powers);
    let [first, ..] = result.lookups;
    let each = std::array::from_fn(|k| if k == 0 { 1.0 } else { result.lookups[k - 1] });
    let walk = poisson(scene.camera.collisions());
    let lookups = (0..count).fold(walk, |sum, _| added(sum, each));
    let counted = SUMS + result.off / (1.0 + first);
    let (truth, minimum) = (scene.radiance(), count as f64);
    TechniqueMoments { truth, raw, lookups: Some(lookups), minimum, counted, shadow_lookups: None }
}
