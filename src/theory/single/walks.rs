//! Draws that scatter at many points of one walk.
//!
//! ```text
//! at every collision   X = Σᵢ wᵢ hᵢ T̂_shadow,  h = σ_t S/σ̂,  wᵢ = T_c(tᵢ) ∏_{j<i} (1 − rⱼ)
//! resampled            X = (Σᵢ |wᵢ| hᵢ) sgn(w_J) T̂_shadow(t_J),  J chosen with chance ∝ |w_J| h_J
//! at n points of a density p    X = (1/n) Σⱼ T̂(sⱼ) σ_t S/p T̂_shadow,  one T̂ for all
//! ```

use super::camera::Losses;
use super::chain::{At, Chain, Solved, halved};
use super::passage::{Passage, added, poisson};
use super::predict::{LOOKUPS, MOMENT, Points};
use super::scene::{Node, Scene};
use crate::numeric::Span;

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

const BINOMIAL: [[f64; 5]; 5] = [
    [1.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 1.0, 0.0, 0.0, 0.0],
    [1.0, 2.0, 1.0, 0.0, 0.0],
    [1.0, 3.0, 3.0, 1.0, 0.0],
    [1.0, 4.0, 6.0, 4.0, 1.0],
];

/// Moments on the panels and on their halves; the difference bounds the error.
fn both(panels: &[Span], powers: impl Fn(&[Span]) -> [f64; 5]) -> ([f64; 5], f64) {
    let (coarse, fine) = (powers(panels), powers(&halved(panels)));
    let apart = (1..5).map(|k| ((fine[k] - coarse[k]) / fine[k]).abs());
    (fine, apart.fold(1e-13, f64::max))
}

/// `h` and what follows at a collision; nothing where σ̂ is zero, since the residual is zero there.
fn gain(at: &At) -> [f64; 3] {
    let [sampling, weight] = at.collision;
    if sampling <= 0.0 {
        return [0.0, 0.0, 1.0];
    }
    [sampling, at.node.extinction * at.node.source / sampling, weight]
}

/// The panels that resolve `σ̂ E[(h T̂_shadow)^k] E[T̂^k]`, and the cumulants of the lookups.
fn panels_at_collisions(scene: &Scene) -> (Vec<Span>, [f64; 4]) {
    let mut parts = [MOMENT; 8];
    parts[4..].fill(LOOKUPS);
    let found = scene.integrate(parts, &|node| {
        let [sampling, _] = scene.camera.collision(node.s, node.extinction);
        if sampling <= 0.0 {
            return [0.0; 8];
        }
        let h = node.extinction * node.source / sampling;
        let power = |k: usize| {
            let k32 = i32::try_from(k).unwrap_or(i32::MAX);
            sampling * h.powi(k32) * node.camera.powers[k] * node.shadow.powers[k]
        };
        // A compound Poisson number: its cumulants are moments of what each collision costs.
        let shadow =
            if node.extinction > 0.0 { node.shadow.lookups } else { Passage::exact(0.0).lookups };
        let each = added([1.0; 5], shadow);
        [
            power(1),
            power(2),
            power(3),
            power(4),
            sampling * each[1],
            sampling * each[2],
            sampling * each[3],
            sampling * each[4],
        ]
    });
    let [.., k1, k2, k3, k4] = found.value;
    (found.panels, [k1, k2, k3, k4])
}

/// Raw moments from cumulants.
fn raw([k1, k2, k3, k4]: [f64; 4]) -> [f64; 5] {
    let second = k2 + k1 * k1;
    let third = k3 + 3.0 * k2 * k1 + k1.powi(3);
    let fourth = k4 + 4.0 * k3 * k1 + 3.0 * k2 * k2 + 6.0 * k2 * k1 * k1 + k1.powi(4);
    [1.0, k1, second, third, fourth]
}

/// At every collision.
#[must_use]
pub fn at_collisions(scene: &Scene) -> Points {
    let (panels, cumulants) = panels_at_collisions(scene);
    let powers = |panels: &[Span]| {
        let chain = Chain::new(scene, panels);
        let mut known: Vec<Solved> = Vec::new();
        let mut powers = [1.0; 5];
        for k in 1..5 {
            let solved = chain.solve(&|losses| losses.signed[k], &|at, p, i| {
                let [sampling, h, weight] = gain(at);
                let lower = |n: usize| if n == 0 { 1.0 } else { known[n - 1].at[p][i] };
                let term = |j: usize| {
                    let scored = power(h, j) * at.node.shadow.powers[j];
                    BINOMIAL[k][j] * scored * power(weight, k - j) * lower(k - j)
                };
                sampling * (1..=k).map(term).sum::<f64>()
            });
            powers[k] = solved.begin;
            known.push(solved);
        }
        powers
    };
    let (powers, error) = both(&panels, powers);
    Points { truth: scene.radiance(), powers, error, eighth: None, lookups: Some(raw(cumulants)) }
}

fn power(x: f64, k: usize) -> f64 {
    x.powi(i32::try_from(k).unwrap_or(i32::MAX))
}

/// Resampled: one of the collisions casts a shadow ray for all.
///
/// ```text
/// E[X^k] = E[F^{k−1} G_k],  F = Σ |wᵢ| hᵢ,  G_k = Σ hᵢ |wᵢ| sgn(wᵢ)^k E[T̂_shadow(tᵢ)^k]
/// ```
#[must_use]
pub fn resampled(scene: &Scene, shadow_is_free: bool) -> Points {
    let (panels, _) = panels_at_collisions(scene);
    let powers = |panels: &[Span]| {
        let chain = Chain::new(scene, panels);
        let mut f: Vec<Solved> = Vec::new();
        for (j, binomial) in BINOMIAL.iter().enumerate().take(4).skip(1) {
            let solved = chain.solve(&|losses| losses.sizes[j], &|at, p, i| {
                let [sampling, h, weight] = gain(at);
                let lower = |n: usize| if n == 0 { 1.0 } else { f[n - 1].at[p][i] };
                let term = |n: usize| {
                    binomial[n] * power(h, n) * power(weight.abs(), j - n) * lower(j - n)
                };
                sampling * (1..=j).map(term).sum::<f64>()
            });
            f.push(solved);
        }
        let mut powers = [1.0; 5];
        for k in 1..5 {
            let odd = k % 2 == 1;
            let mut g: Vec<Solved> = Vec::new();
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
                    let shadow = at.node.shadow.powers[k];
                    let term = |n: usize| {
                        let scored = h * shadow * lower(j - n);
                        let later = if n == 0 { 0.0 } else { last * g[j - n].at[p][i] };
                        BINOMIAL[j][n] * power(h, n) * power(size, j - n) * (scored + later)
                    };
                    sampling * (0..=j).map(term).sum::<f64>()
                });
                g.push(solved);
            }
            powers[k] = g[k - 1].begin;
        }
        powers
    };
    let (powers, error) = both(&panels, powers);
    // Which collision casts the ray depends on all of them; without lookups of its own it does not
    // matter.
    let lookups = shadow_is_free.then(|| poisson(scene.camera.collisions()));
    Points { truth: scene.radiance(), powers, error, eighth: None, lookups }
}

/// At `count` points of a density, all with the transmittance of one walk over the whole ray.
#[must_use]
pub fn at_points(scene: &Scene, count: usize, density: &dyn Fn(&Node) -> f64) -> Points {
    let mut parts = [MOMENT; 8];
    parts[4..].fill(LOOKUPS);
    let scored = |node: &Node, k: usize| {
        let p = density(node);
        p * power(node.extinction * node.source / p, k) * node.shadow.powers[k]
    };
    let found = scene.integrate(parts, &|node| {
        let each = |k: usize| scored(node, k) * node.camera.powers[k];
        let shadow =
            if node.extinction > 0.0 { node.shadow.lookups } else { Passage::exact(0.0).lookups };
        let lookups = added([1.0; 5], shadow);
        let cost = |k: usize| density(node) * lookups[k];
        [each(1), each(2), each(3), each(4), cost(1), cost(2), cost(3), cost(4)]
    });
    let powers = |panels: &[Span]| {
        let chain = Chain::new(scene, panels);
        // E[A₁^{n₁} A₂^{n₂} …] with A_m = ∫ p (T̂ σ_t S/p)^m E[T̂_shadow^m] ds, by total degree.
        let mut known: Vec<([usize; 4], Solved)> = Vec::new();
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
        [1.0, of[0], (n * of[1] + two * of[2]) / n.powi(2), third / n.powi(3), fourth / n.powi(4)]
    };
    let (powers, error) = both(&found.panels, powers);
    let value = found.value;
    let each = [1.0, value[4], value[5], value[6], value[7]];
    let walk = poisson(scene.camera.collisions());
    let lookups = (0..count).fold(walk, |sum, _| added(sum, each));
    Points { truth: scene.radiance(), powers, error, eighth: None, lookups: Some(lookups) }
}
