//! Paths of given directions: chains of flights along the rod, with a factor `a ρ` at each scattering.
//!
//! A technique with weights that depend on the directions of a path only has the moments
//!
//! ```text
//! E[X_s^k] = Σ_directions w_s^k ∫ f c_s^{k−1},   c_s = f/p_s = T̂_{s−1} [a ρ_{s−1}]_{s≥2} [a ρ_s]_{s≤r}
//! ```

use super::grid::{NodeGrid, Operator};
use super::{DrawRules, RodScene, quotient};
use crate::prediction::raw::{HIGHEST, Powers};

/// Adds `E[X_s^k]`, k = 1 … 8, of the techniques s = 0 … r + 2 of each order.
pub fn add(scene: &RodScene, rules: &DrawRules, grid: &NodeGrid, sums: &mut [Vec<Powers>]) {
    let segment = |depth: f64, _| -> Powers {
        std::array::from_fn(|k| rules.connection.power(depth, k.max(1)))
    };
    Chain::new(scene, grid, &segment).add(sums, |path, s| {
        let order = path.turns.len();
        let weight = rules.combination.weight(&path.phase, s);
        let ends = quotient(s, order, |_| 1.0, |i| scene.albedo * path.phase[i - 1]);
        let mut factors = [0.0; HIGHEST + 1];
        let mut power = 1.0;
        for factor in &mut factors[1..] {
            power *= weight;
            *factor = power;
            power *= ends;
        }
        factors
    });
}

/// The segments of all paths.
pub struct Chain<'a> {
    scene: &'a RodScene,
    grid: &'a NodeGrid,
    /// Number of kernels of a segment.
    count: usize,
    /// Each kernel over the whole rod.
    through: Vec<f64>,
    /// Each kernel from the light to the first scattering, by the turn there.
    light: [Vec<Vec<f64>>; 2],
    /// Each kernel from the last scattering to the sensor, by the turn there.
    sensor: [Vec<Vec<f64>>; 2],
    /// Each kernel between two scatterings with no turn, one turn or two turns; empty where no path is scattered twice.
    flights: [Vec<Operator>; 3],
}

/// A path with given turns at its scatterings.
pub struct TurnPath {
    /// 1 for each scattering that turns the path round, else 0.
    turns: Vec<usize>,
    /// ρ at each scattering.
    phase: Vec<f64>,
    /// True for each segment that goes forward.
    is_forward: Vec<bool>,
    /// Light that arrives at each scattering.
    arriving: Vec<Vec<f64>>,
    /// Light that reaches the sensor from each scattering, `a ρ` included.
    leaving: Vec<Vec<f64>>,
}

impl<'a> Chain<'a> {
    /// Segments with kernels that depend on the optical depth and on the product of `a ρ` at both ends. The first kernel
    /// is that without a connection, the k-th that of the k-th moment of one; the last stands for all further moments.
    pub fn new<const N: usize>(
        scene: &'a RodScene,
        grid: &'a NodeGrid,
        segment: &dyn Fn(f64, f64) -> [f64; N],
    ) -> Self {
        let scattered = [false, true].map(|turns| scene.albedo * scene.phase(turns));
        let light = scattered.map(|ends| {
            let at_nodes = grid.values(|u| segment(u, ends));
            (0..N).map(|i| at_nodes.iter().map(|kernels| kernels[i]).collect()).collect()
        });
        let mut sensor: [Vec<Vec<f64>>; 2] = light.clone();
        if scene.is_transmitted {
            // Nodes are symmetric about the middle.
            sensor.iter_mut().flatten().for_each(|kernel| kernel.reverse());
        }
        let is_needed = *scene.orders.end() >= 2;
        let flights = [[0, 0], [0, 1], [1, 1]].map(|[i, j]| {
            let between = |depth: f64| segment(depth, scattered[i] * scattered[j]);
            if is_needed { grid.several(&between).into() } else { Vec::new() }
        });
        let through = segment(scene.depth.value, 1.0).into();
        Self { scene, grid, count: N, through, light, sensor, flights }
    }

    /// Adds the moments of all techniques, order by order: each path, or its connection on one segment, times a factor
    /// for each power.
    pub fn add(&self, sums: &mut [Vec<Powers>], factors: impl Fn(&TurnPath, usize) -> Powers) {
        for (order, sums) in self.scene.orders.clone().zip(sums) {
            for path in (0..1 << order).filter_map(|bits| self.path(order, bits)) {
                let whole = [self.connected(&path, 0, 0)];
                for (s, sums) in sums.iter_mut().enumerate() {
                    let is_hit = s == 0 || s == order + 2;
                    let kernels = if is_hit { 1..1 } else { 1..self.count };
                    let connected: Vec<f64> =
                        kernels.map(|kernel| self.connected(&path, s - 1, kernel)).collect();
                    let result = if is_hit { &whole[..] } else { &connected };
                    let factors = factors(&path, s);
                    for (k, sum) in sums.iter_mut().enumerate().skip(1) {
                        *sum += factors[k] * result[k.min(result.len()) - 1];
                    }
                }
            }
        }
    }

    /// The path with turns at the scatterings of which the bits are 1; `None` where a turn is impossible, or the path
    /// does not reach the sensor.
    fn path(&self, order: usize, bits: usize) -> Option<TurnPath> {
        let turns: Vec<usize> = (0..order).map(|i| bits >> i & 1).collect();
        let phase: Vec<f64> = turns.iter().map(|&turn| self.scene.phase(turn == 1)).collect();
        let mut is_forward = vec![true];
        for (i, turn) in turns.iter().enumerate() {
            is_forward.push(is_forward[i] ^ (*turn == 1));
        }
        if is_forward[order] != self.scene.is_transmitted || phase.contains(&0.0) {
            return None;
        }
        let nothing = vec![Vec::new(); order];
        let (arriving, leaving) = (nothing.clone(), nothing);
        let mut path = TurnPath { turns, phase, is_forward, arriving, leaving };
        for i in 0..order {
            path.arriving[i] = match i.checked_sub(1) {
                None => self.light[path.turns[0]][0].clone(),
                Some(last) => {
                    let scattered = self.scattered(&path, last, &path.arriving[last]);
                    self.flight(&path, i, 0).over(path.is_forward[i], &scattered)
                }
            };
        }
        for i in (0..order).rev() {
            path.leaving[i] = self.scattered(&path, i, &self.onward(&path, i, 0));
        }
        Some(path)
    }

    /// `a ρ` of a scattering times a function.
    fn scattered(&self, path: &TurnPath, i: usize, f: &[f64]) -> Vec<f64> {
        f.iter().map(|x| self.scene.albedo * path.phase[i] * x).collect()
    }

    /// Flights on the segment before a scattering.
    fn flight(&self, path: &TurnPath, i: usize, kernel: usize) -> &Operator {
        &self.flights[path.turns[i - 1] + path.turns[i]][kernel]
    }

    /// Light that reaches the sensor behind a scattering, with a kernel on the segment that follows.
    fn onward(&self, path: &TurnPath, i: usize, kernel: usize) -> Vec<f64> {
        let next = i + 1;
        if next == path.turns.len() {
            return self.sensor[path.turns[i]][kernel].clone();
        }
        self.flight(path, next, kernel).over(!path.is_forward[next], &path.leaving[next])
    }

    /// `∫` of the path with a kernel on segment j.
    fn connected(&self, path: &TurnPath, j: usize, kernel: usize) -> f64 {
        match j.checked_sub(1) {
            _ if path.turns.is_empty() => self.through[kernel],
            None => self.grid.product(&self.light[path.turns[0]][kernel], &path.leaving[0]),
            Some(i) => {
                let onward = self.scattered(path, i, &self.onward(path, i, kernel));
                self.grid.product(&path.arriving[i], &onward)
            }
        }
    }
}
