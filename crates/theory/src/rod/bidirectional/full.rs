//! Moments of techniques with weights that depend on the whole path.
//!
//! ```text
//! E[X_s^k] = ∫ f c_s^{(1−β)k−1} (Σⱼ cⱼ^{−β})^{−k},   c₀ = c_{r+2} = 1,   y^{−k} = ∫₀^∞ z^{k−1} e^{−zy} dz/Γ(k)
//! ```
//!
//! At a fixed z the sum in the exponent becomes a product: f is a chain of flights, each with its own factor
//! `exp(−z cⱼ^{−β})`, which depends on the flight and on the turns at both of its ends. The integral over z is the
//! trapezoidal rule in ln z, with an error that falls as `e^{−π²/h}`.

use super::grid::{Grid, Operator};
use super::{Connection, Scene};
use crate::light::Heuristic;
use crate::prediction::raw::{HIGHEST, Powers};

/// Limits of the integral over ln z.
const RANGE: [f64; 2] = [-52.0, 3.5];
/// Terms of a segment that are smaller than this, relative to their sum, are left out.
const FAINT: f64 = 1e-18;

/// `E[X_s^k]`, k = 1 … 8, of the techniques s = 0 … r + 2 of each order.
pub fn moments(
    scene: &Scene,
    connection: Connection,
    heuristic: Heuristic,
    grid: &Grid,
    step: f64,
) -> Vec<Vec<Powers>> {
    let orders = scene.orders.clone();
    let mut sums: Vec<Vec<Powers>> =
        orders.map(|order| vec![[0.0; HIGHEST + 1]; order + 3]).collect();
    let mut ln_z = RANGE[0];
    while ln_z <= RANGE[1] {
        let chain = Chain::new(Segments { connection, heuristic, z: ln_z.exp() }, scene, grid);
        chain.add(&weights(chain.segments.z, step), &mut sums);
        ln_z += step;
    }
    sums
}

/// `h z^k e^{−2z}/Γ(k)`, k = 1 … 8.
fn weights(z: f64, step: f64) -> Powers {
    let mut weights = [0.0; HIGHEST + 1];
    let mut weight = step * (-2.0 * z).exp();
    for (k, entry) in (1_u32..).zip(&mut weights[1..]) {
        weight *= z;
        *entry = weight;
        weight /= f64::from(k);
    }
    weights
}

/// The segments of a path at one z.
#[derive(Clone, Copy)]
struct Segments {
    connection: Connection,
    heuristic: Heuristic,
    z: f64,
}

impl Segments {
    /// Number of kernels: one without a connection, and one for each of its powers.
    fn count(self) -> usize {
        if self.heuristic == Heuristic::Power { HIGHEST + 1 } else { 2 }
    }

    /// The kernel of the k-th moment.
    fn index(self, k: usize) -> usize {
        if self.heuristic == Heuristic::Power { k } else { 1 }
    }

    /// `e^{−d} E[exp(−z c^{−β})]` of a segment with ends that contribute `c/T̂`; then with the factors
    /// `c^{(1−β)k−1}`: `1/c` for β = 1, and `1/c²`, `1/c³`, … for β = 2.
    fn kernels(self, depth: f64, ends: f64) -> Powers {
        let (mut sums, count) = ([0.0; HIGHEST + 1], self.count());
        let mut last = 0.0;
        for [probability, inverse] in self.connection.transmittances(depth) {
            let density = inverse / ends;
            let mut term = probability * (-self.z * self.heuristic.raised(density)).exp();
            // Terms rise to one peak and fall.
            if ends == 0.0 || term == 0.0 {
                break;
            }
            sums[0] += term;
            if self.heuristic == Heuristic::Power {
                term *= density;
            }
            for sum in &mut sums[1..count] {
                term *= density;
                *sum += term;
            }
            if term <= last && term <= FAINT * sums[count - 1] {
                break;
            }
            last = term;
        }
        sums
    }
}

/// Values for both turns: straight on, and round.
type ByTurn<T> = [T; 2];
/// Functions by the direction in which light arrives at a scattering (backward, forward) and by the turn there.
type States = [ByTurn<Vec<f64>>; 2];

const TURNS: [bool; 2] = [false, true];

/// The flights of a path at one z.
struct Chain<'a> {
    segments: Segments,
    scene: &'a Scene,
    grid: &'a Grid,
    /// `a ρ` of each turn.
    scattered: ByTurn<f64>,
    /// Each kernel from the light to the first scattering, by the turn there.
    light: ByTurn<Vec<Vec<f64>>>,
    /// Each kernel from the last scattering to the sensor.
    sensor: ByTurn<Vec<Vec<f64>>>,
    /// Flights between two scatterings with no turn, one turn or two turns at their ends; empty where no path is
    /// scattered twice.
    flights: [Vec<Operator>; 3],
}

impl<'a> Chain<'a> {
    fn new(segments: Segments, scene: &'a Scene, grid: &'a Grid) -> Self {
        let scattered = TURNS.map(|turn| scene.albedo * scene.phase(turn));
        let light = scattered.map(|ends| {
            let at_nodes: Vec<Powers> =
                grid.points.iter().map(|&u| segments.kernels(u, ends)).collect();
            let kernel = |i: usize| at_nodes.iter().map(|kernels| kernels[i]).collect();
            (0..segments.count()).map(kernel).collect::<Vec<Vec<f64>>>()
        });
        let mut sensor = light.clone();
        if scene.is_transmitted {
            // Nodes are symmetric about the middle.
            sensor.iter_mut().flatten().for_each(|kernel| kernel.reverse());
        }
        let is_needed = *scene.orders.end() >= 2;
        let flights = [[0, 0], [0, 1], [1, 1]].map(|[i, j]| {
            let kernels = |d: f64| segments.kernels(d, scattered[i] * scattered[j]);
            if !is_needed {
                return Vec::new();
            }
            if segments.count() == 2 {
                return grid.several(|d| [kernels(d)[0], kernels(d)[1]]).into();
            }
            grid.several(kernels).into()
        });
        Self { segments, scene, grid, scattered, light, sensor, flights }
    }

    /// Light that arrives at each scattering, from the first to the last of the highest order.
    fn arriving(&self) -> Vec<States> {
        let mut all = vec![self.first(0)];
        for _ in 1..*self.scene.orders.end() {
            let last = &all[all.len() - 1];
            let next = TURNS.map(|is_forward| {
                TURNS.map(|turn| {
                    let from =
                        |before: bool| &last[usize::from(is_forward ^ before)][usize::from(before)];
                    self.flown([is_forward, turn], 0, from, |before| before)
                })
            });
            all.push(next);
        }
        all
    }

    /// Light that reaches the sensor from a scattering, `a ρ` included, by the number of scatterings that follow.
    fn leaving(&self) -> Vec<States> {
        let mut all = vec![self.last(0)];
        for _ in 1..*self.scene.orders.end() {
            let next = self.before(0, &all[all.len() - 1]);
            all.push(next);
        }
        all
    }

    /// Light that arrives at the first scattering, by a kernel.
    fn first(&self, kernel: usize) -> States {
        let nothing = TURNS.map(|_| vec![0.0; self.grid.points.len()]);
        [nothing, self.light.each_ref().map(|light| light[kernel].clone())]
    }

    /// Light that reaches the sensor from the last scattering, by a kernel.
    fn last(&self, kernel: usize) -> States {
        TURNS.map(|is_forward| {
            TURNS.map(|turn| {
                let is_seen = (is_forward ^ turn) == self.scene.is_transmitted;
                let factor = if is_seen { self.scattered[usize::from(turn)] } else { 0.0 };
                self.sensor[usize::from(turn)][kernel].iter().map(|x| factor * x).collect()
            })
        })
    }

    /// The functions of the scattering before, by a kernel.
    fn before(&self, kernel: usize, leaving: &States) -> States {
        TURNS.map(|is_forward| {
            TURNS.map(|turn| {
                let goes = is_forward ^ turn;
                let to = |next: bool| &leaving[usize::from(goes)][usize::from(next)];
                self.flown([!goes, turn], kernel, to, |_| turn)
            })
        })
    }

    /// The flights from, or to, a scattering with this turn from scatterings with either turn, each with the `a ρ`
    /// of one of the two.
    fn flown<'f>(
        &self,
        [is_before, turn]: [bool; 2],
        kernel: usize,
        there: impl Fn(bool) -> &'f Vec<f64>,
        scatters: impl Fn(bool) -> bool,
    ) -> Vec<f64> {
        let mut sum = vec![0.0; self.grid.points.len()];
        for other in TURNS {
            let flight = &self.flights[usize::from(turn) + usize::from(other)][kernel];
            let factor = self.scattered[usize::from(scatters(other))];
            let flown = flight.over(is_before, there(other));
            sum.iter_mut().zip(flown).for_each(|(sum, x)| *sum += factor * x);
        }
        sum
    }

    /// `∫` over the place where two halves of a path are joined.
    fn joined(&self, arriving: &States, leaving: &States) -> f64 {
        let pairs = arriving.iter().flatten().zip(leaving.iter().flatten());
        pairs.map(|(f, g)| self.grid.product(f, g)).sum()
    }

    fn add(&self, weights: &Powers, sums: &mut [Vec<Powers>]) {
        let (arriving, leaving) = (self.arriving(), self.leaving());
        let through = self.segments.kernels(self.scene.depth.value, 1.0);
        for (order, sums) in self.scene.orders.clone().zip(sums) {
            let whole = match order {
                0 => through[0],
                _ => self.joined(&arriving[0], &leaving[order - 1]),
            };
            for hit in [0, order + 2] {
                sums[hit].iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * whole);
            }
            for j in 0..=order {
                // The path with each power of a connection on segment j.
                let connected = |kernel: usize| match j {
                    _ if order == 0 => through[kernel],
                    0 => self.joined(&self.first(kernel), &leaving[order - 1]),
                    _ if j == order => self.joined(&arriving[order - 1], &self.last(kernel)),
                    _ => {
                        let rest = self.before(kernel, &leaving[order - j - 1]);
                        self.joined(&arriving[j - 1], &rest)
                    }
                };
                let connected: Vec<f64> = (1..self.segments.count()).map(connected).collect();
                for (k, weight) in weights.iter().enumerate().skip(1) {
                    sums[j + 1][k] += weight * connected[self.segments.index(k) - 1];
                }
            }
        }
    }
}
