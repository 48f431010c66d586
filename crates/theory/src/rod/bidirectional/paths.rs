//! Moments of techniques with weights that depend on the directions of a path only.
//!
//! ```text
//! E[X_s^k] = Σ_directions w_s^k ∫ f c_s^{k−1},   c_s = f/p_s = T̂_{s−1} [a ρ_{s−1}]_{s≥2} [a ρ_s]_{s≤r}
//! ```
//!
//! For given directions f is a chain of flights along the rod, with a factor `a ρ` at each scattering.

use super::grid::{Grid, Operator};
use super::{Rules, Scene};
use crate::prediction::raw::{HIGHEST, Powers};

/// `E[X_s^k]`, k = 1 … 8, of the techniques s = 0 … r + 2 of one order.
pub fn moments(scene: &Scene, rules: &Rules, order: usize, grid: &Grid) -> Vec<Powers> {
    let chain = Chain::new(scene, rules, grid);
    let mut sums = vec![[0.0; HIGHEST + 1]; order + 3];
    for bits in 0..1_u32 << order {
        let turns: Vec<bool> = (0..order).map(|i| bits >> i & 1 == 1).collect();
        if let Some(path) = Directions::of(scene, &turns) {
            chain.add(&path, &mut sums);
        }
    }
    sums
}

/// The directions of a path that reaches the sensor.
struct Directions {
    /// True for each of the r + 1 segments that goes forward.
    is_forward: Vec<bool>,
    /// ρ at each of the r scatterings.
    phase: Vec<f64>,
}

impl Directions {
    /// Directions with turns at these scatterings; `None` where a turn is impossible, or the path does not reach
    /// the sensor.
    fn of(scene: &Scene, turns: &[bool]) -> Option<Self> {
        let mut is_forward = vec![true];
        for (i, turn) in turns.iter().enumerate() {
            is_forward.push(is_forward[i] ^ turn);
        }
        let phase: Vec<f64> = turns.iter().map(|&turn| scene.phase(turn)).collect();
        let is_seen = is_forward[turns.len()] == scene.is_transmitted;
        (is_seen && phase.iter().all(|&phase| phase > 0.0)).then_some(Self { is_forward, phase })
    }
}

/// The flights of a path.
struct Chain<'a> {
    scene: &'a Scene,
    rules: &'a Rules,
    grid: &'a Grid,
    /// `e^{−d} E[T̂^{k−1}]`, k = 1 … 8, as flights between scatterings.
    flights: Vec<Operator>,
}

impl<'a> Chain<'a> {
    fn new(scene: &'a Scene, rules: &'a Rules, grid: &'a Grid) -> Self {
        let flights = (1..=HIGHEST).map(|k| grid.operator(|d| rules.connection.power(d, k)));
        let flights = flights.collect();
        Self { scene, rules, grid, flights }
    }

    /// `e^{−d} E[T̂^{k−1}]` from the light to each node.
    fn light(&self, k: usize) -> Vec<f64> {
        self.grid.values(|u| self.rules.connection.power(u, k))
    }

    /// `e^{−d} E[T̂^{k−1}]` from each node to the sensor.
    fn sensor(&self, k: usize) -> Vec<f64> {
        self.grid.values(|u| self.rules.connection.power(self.scene.to_sensor(u), k))
    }

    fn add(&self, path: &Directions, sums: &mut [Powers]) {
        let (grid, order) = (self.grid, path.phase.len());
        let scattered = |i: usize| self.scene.albedo * path.phase[i - 1];
        // Functions of arriving at scattering i, and of leaving it for the sensor, `a ρ` included.
        let (mut arriving, mut leaving) =
            (vec![Vec::new(); order + 1], vec![Vec::new(); order + 1]);
        for i in 1..=order {
            arriving[i] = if i == 1 {
                self.light(1)
            } else {
                let flown = self.flights[0].over(path.is_forward[i - 1], &arriving[i - 1]);
                scaled(scattered(i - 1), flown)
            };
        }
        for i in (1..=order).rev() {
            let flown = if i == order {
                self.sensor(1)
            } else {
                self.flights[0].over(!path.is_forward[i], &leaving[i + 1])
            };
            leaving[i] = scaled(scattered(i), flown);
        }
        // The path with the k-th power of the connection on segment j.
        let connected = |j: usize, k: usize| match j {
            _ if order == 0 => self.rules.connection.power(self.scene.depth.value, k),
            0 => grid.product(&self.light(k), &leaving[1]),
            _ if j == order => scattered(order) * grid.product(&arriving[order], &self.sensor(k)),
            _ => {
                let flown = self.flights[k - 1].over(!path.is_forward[j], &leaving[j + 1]);
                scattered(j) * grid.product(&arriving[j], &flown)
            }
        };
        let whole = connected(0, 1);
        for (s, sums) in sums.iter_mut().enumerate() {
            let weight = self.rules.combination.weight(&path.phase, s);
            let ends = super::quotient(s, order, |_| 1.0, scattered);
            let mut power = 1.0;
            for (k, sum) in sums.iter_mut().enumerate().skip(1) {
                power *= weight;
                let is_hit = s == 0 || s == order + 2;
                *sum += power * if is_hit { whole } else { connected(s - 1, k) };
                power *= ends;
            }
        }
    }
}

fn scaled(factor: f64, f: Vec<f64>) -> Vec<f64> {
    f.into_iter().map(|x| factor * x).collect()
}
