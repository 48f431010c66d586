//! Moments of techniques whose weights know the whole path.
//!
//! ```text
//! E[X_s^k] = ∫ f c_s^{(1−β)k−1} (Σⱼ cⱼ^{−β})^{−k},   c₀ = c_{r+2} = 1,   y^{−k} = ∫₀^∞ z^{k−1} e^{−zy} dz/Γ(k)
//! ```
//!
//! At a fixed z the sum in the exponent is a product again: f is a chain of flights, each with a factor
//! `exp(−z cⱼ^{−β})` of its own, which depends on the flight and on the turns at both of its ends. The
//! integral over z is the trapezoidal rule in ln z, whose error falls as `e^{−π²/h}`.

use super::grid::{Grid, Operator};
use super::{Connection, HIGHEST, Heuristic, Powers, Scene};

/// Where the integral over z begins and ends.
const RANGE: [f64; 2] = [-52.0, 3.5];

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
        let chain = Chain::new(scene, connection, heuristic, grid, ln_z.exp());
        // h z^k e^{−2z}/Γ(k)
        let mut weights = [0.0; HIGHEST + 1];
        let mut weight = step * (-2.0 * chain.z).exp();
        for (k, entry) in (1_u32..).zip(&mut weights[1..]) {
            weight *= chain.z;
            *entry = weight;
            weight /= f64::from(k);
        }
        chain.add(&weights, &mut sums);
        ln_z += step;
    }
    sums
}

/// For both turns: straight on, and round.
type ByTurn<T> = [T; 2];
/// By the direction in which light arrives at a scattering, backward and forward, and the turn there.
type States = [ByTurn<Vec<f64>>; 2];

const TURNS: [bool; 2] = [false, true];

/// The flights of a path at one z.
struct Chain<'a> {
    scene: &'a Scene,
    connection: Connection,
    heuristic: Heuristic,
    grid: &'a Grid,
    z: f64,
    /// `a ρ` of each turn.
    scattered: ByTurn<f64>,
    /// The flights between scatterings, and then the same with the power of a connection, for each k that
    /// has one of its own; none where no path is scattered twice.
    flights: Vec<Middle>,
}

/// The flights between two scatterings, by both turns: neither, one, both.
type Middle = [Operator; 3];

impl<'a> Chain<'a> {
    fn new(
        scene: &'a Scene,
        connection: Connection,
        heuristic: Heuristic,
        grid: &'a Grid,
        z: f64,
    ) -> Self {
        let scattered = TURNS.map(|turn| scene.albedo * scene.phase(turn));
        let flights = Vec::new();
        let bare = Self { scene, connection, heuristic, grid, z, scattered, flights };
        if *scene.orders.end() < 2 {
            return bare;
        }
        let powers = heuristic.own_powers().map(|k| heuristic.power(k));
        let middle = |power: f64| {
            [[0, 0], [0, 1], [1, 1]]
                .map(|[i, j]| grid.operator(|d| bare.kernel(d, scattered[i] * scattered[j], power)))
        };
        let flights = std::iter::once(0.0).chain(powers).map(middle).collect();
        Self { flights, ..bare }
    }

    /// `e^{−d} E[(A T̂)^p exp(−z (A T̂)^{−β})]` of a segment whose ends contribute A.
    fn kernel(&self, depth: f64, ends: f64, power: f64) -> f64 {
        if ends == 0.0 {
            return 0.0;
        }
        let beta = self.heuristic.exponent();
        self.connection.mean(depth, |ln_transmittance| {
            let ln = ends.ln() + ln_transmittance;
            (power * ln - self.z * (-beta * ln).exp()).exp()
        })
    }

    /// What arrives at the first scattering, by the turn there.
    fn light(&self, power: f64) -> ByTurn<Vec<f64>> {
        self.scattered.map(|ends| self.grid.values(|u| self.kernel(u, ends, power)))
    }

    /// From the last scattering to the sensor, by the turn there.
    fn sensor(&self, power: f64) -> ByTurn<Vec<f64>> {
        let flown = |u| self.scene.to_sensor(u);
        self.scattered.map(|ends| self.grid.values(|u| self.kernel(flown(u), ends, power)))
    }

    /// What arrives at each scattering, from the first to the last of the highest order.
    fn arriving(&self) -> Vec<States> {
        let nothing = || TURNS.map(|_| vec![0.0; self.grid.points.len()]);
        let mut all = vec![[nothing(), self.light(0.0)]];
        for _ in 1..*self.scene.orders.end() {
            let last = &all[all.len() - 1];
            let next = TURNS.map(|is_forward| {
                TURNS.map(|turn| {
                    let mut sum = vec![0.0; self.grid.points.len()];
                    for before in TURNS {
                        let from = &last[usize::from(is_forward ^ before)][usize::from(before)];
                        let flight = &self.flights[0][usize::from(turn) + usize::from(before)];
                        let factor = self.scattered[usize::from(before)];
                        let flown = flight.over(is_forward, from);
                        sum.iter_mut().zip(flown).for_each(|(sum, x)| *sum += factor * x);
                    }
                    sum
                })
            });
            all.push(next);
        }
        all
    }

    /// What reaches the sensor from a scattering, `a ρ` included, with so many more scatterings to come.
    fn leaving(&self) -> Vec<States> {
        let ends = self.sensor(0.0);
        let last = self.last(&ends);
        let mut all = vec![last];
        for _ in 1..*self.scene.orders.end() {
            let next = self.before(&self.flights[0], &all[all.len() - 1]);
            all.push(next);
        }
        all
    }

    /// From the last scattering, by what a turn there sends to the sensor.
    fn last(&self, ends: &ByTurn<Vec<f64>>) -> States {
        TURNS.map(|is_forward| {
            TURNS.map(|turn| {
                let is_seen = (is_forward ^ turn) == self.scene.is_transmitted;
                let factor = if is_seen { self.scattered[usize::from(turn)] } else { 0.0 };
                ends[usize::from(turn)].iter().map(|x| factor * x).collect()
            })
        })
    }

    /// One scattering earlier.
    fn before(&self, flights: &Middle, leaving: &States) -> States {
        TURNS.map(|is_forward| {
            TURNS.map(|turn| {
                let goes = is_forward ^ turn;
                let mut sum = vec![0.0; self.grid.points.len()];
                for next in TURNS {
                    let to = &leaving[usize::from(goes)][usize::from(next)];
                    let flown = flights[usize::from(turn) + usize::from(next)].over(!goes, to);
                    let factor = self.scattered[usize::from(turn)];
                    sum.iter_mut().zip(flown).for_each(|(sum, x)| *sum += factor * x);
                }
                sum
            })
        })
    }

    /// `∫` over the last place where two halves of a path meet.
    fn joined(&self, arriving: &States, leaving: &States) -> f64 {
        let pairs = arriving.iter().flatten().zip(leaving.iter().flatten());
        pairs.map(|(f, g)| self.grid.product(f, g)).sum()
    }

    fn add(&self, weights: &Powers, sums: &mut [Vec<Powers>]) {
        let (arriving, leaving) = (self.arriving(), self.leaving());
        for (order, sums) in self.scene.orders.clone().zip(sums) {
            let whole = match order {
                0 => self.kernel(self.scene.depth.value, 1.0, 0.0),
                _ => self.joined(&arriving[0], &leaving[order - 1]),
            };
            for hit in [0, order + 2] {
                sums[hit].iter_mut().zip(weights).for_each(|(sum, weight)| *sum += weight * whole);
            }
            for j in 0..=order {
                let mut connected = 0.0;
                for (k, weight) in weights.iter().enumerate().skip(1) {
                    if k == 1 || self.heuristic == Heuristic::Power {
                        connected = self.connection(order, j, k, &arriving, &leaving);
                    }
                    sums[j + 1][k] += weight * connected;
                }
            }
        }
    }

    /// The path with the power of a connection on segment j.
    fn connection(&self, order: usize, j: usize, k: usize, to: &[States], from: &[States]) -> f64 {
        let power = self.heuristic.power(k);
        if order == 0 {
            return self.kernel(self.scene.depth.value, 1.0, power);
        }
        if j == 0 {
            let nothing = TURNS.map(|_| vec![0.0; self.grid.points.len()]);
            return self.joined(&[nothing, self.light(power)], &from[order - 1]);
        }
        if j == order {
            return self.joined(&to[order - 1], &self.last(&self.sensor(power)));
        }
        let flights = &self.flights[k.min(self.flights.len() - 1)];
        self.joined(&to[j - 1], &self.before(flights, &from[order - j - 1]))
    }
}
