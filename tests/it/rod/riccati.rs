//! Moments of a walk through a rod by invariant imbedding, from the rules' definitions alone.
//!
//! A rod on [x, L] sends back ρ and lets through η of a moment; put a thin slice before it:
//!
//! ```text
//! ρ' = 2Aρ − B(1 + ρ²),  η' = (A − Bρ) η,  ρ(L) = 0, η(L) = 1;  E[R^k] = ρ(0), E[T^k] = η(0)
//! ```
//!
//! The lookups of a particle that goes forward, backward: `N₊ = ρ N₋ + ν`, with
//! `ν' = (A − Bρ)ν − σ̂(1 + ρ)`, `ν(L) = 0` and `N₋(0) = 0`.

/// A rod as functions of the distance.
pub struct Rod {
    pub extinction: fn(f64) -> f64,
    pub albedo: fn(f64) -> f64,
    pub forward: f64,
    pub sampling: f64,
    pub length: f64,
    /// Where r passes 1: there the adaptive rule's chances jump, and Runge–Kutta must not step over it.
    pub jump: f64,
}

/// `(chance, weight)` straight on, and scattered.
pub type Odds = fn(f64, f64) -> [(f64, f64); 2];

/// S 3.2: weights of size 1.
pub fn terminating(r: f64, a: f64) -> [(f64, f64); 2] {
    [((1.0 - r).abs(), (1.0 - r).signum()), (a * r, 1.0)]
}

/// S Eq. 12.
pub fn non_terminating(r: f64, a: f64) -> [(f64, f64); 2] {
    let straight = (1.0 - r).abs();
    let chance = straight / (a * r.abs() + straight);
    [(chance, (1.0 - r) / chance), (1.0 - chance, a * r / (1.0 - chance))]
}

/// `SimulateParticle`.
pub fn adaptive(r: f64, a: f64) -> [(f64, f64); 2] {
    if r < 1.0 || a * r + (1.0 - r).abs() > 1.0 { non_terminating(r, a) } else { terminating(r, a) }
}

/// `E[R^k]`, `E[T^k]`, and for k = 0 the expected lookups in the third place, by Runge–Kutta steps
/// of two sizes and Richardson's extrapolation.
pub fn moments(rod: &Rod, odds: Odds, k: i32) -> [f64; 3] {
    let (coarse, fine) = (march(rod, odds, k, 20_000), march(rod, odds, k, 40_000));
    std::array::from_fn(|i| fine[i] + (fine[i] - coarse[i]) / 15.0)
}

fn slope(rod: &Rod, odds: Odds, k: i32, x: f64, [rho, eta, nu]: [f64; 3]) -> [f64; 3] {
    let r = (rod.extinction)(x) / rod.sampling;
    let [straight, scattered] =
        odds(r, (rod.albedo)(x)).map(|(chance, weight)| chance * weight.powi(k));
    let a = rod.sampling * (1.0 - straight - scattered * rod.forward);
    let b = rod.sampling * scattered * (1.0 - rod.forward);
    [
        2.0 * a * rho - b * (1.0 + rho * rho),
        (a - b * rho) * eta,
        (a - b * rho) * nu - rod.sampling * (1.0 + rho),
    ]
}

fn march(rod: &Rod, odds: Odds, k: i32, steps: usize) -> [f64; 3] {
    let after = stretch(rod, odds, k, steps, [rod.length, rod.jump], [0.0, 1.0, 0.0]);
    stretch(rod, odds, k, steps, [rod.jump, 0.0], after)
}

/// From one distance down to another, never looking at either from outside.
fn stretch(
    rod: &Rod,
    odds: Odds,
    k: i32,
    steps: usize,
    [from, to]: [f64; 2],
    start: [f64; 3],
) -> [f64; 3] {
    let h = (to - from) / steps as f64;
    let inside = |x: f64| x.clamp(to + 1e-12, from - 1e-12);
    let slope =
        |rod: &Rod, odds: Odds, k: i32, x: f64, y: [f64; 3]| slope(rod, odds, k, inside(x), y);
    let mut y = start;
    for i in 0..steps {
        let x = from + h * i as f64;
        let moved = |d: [f64; 3], by: f64| std::array::from_fn(|j| y[j] + by * d[j]);
        let k1 = slope(rod, odds, k, x, y);
        let k2 = slope(rod, odds, k, x + 0.5 * h, moved(k1, 0.5 * h));
        let k3 = slope(rod, odds, k, x + 0.5 * h, moved(k2, 0.5 * h));
        let k4 = slope(rod, odds, k, x + h, moved(k3, h));
        y = std::array::from_fn(|j| y[j] + h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j]));
    }
    y
}
