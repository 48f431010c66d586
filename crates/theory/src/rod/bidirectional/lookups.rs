//! Moments of the number of lookups of a draw, where `σ_t/σ̂` has one value.
//!
//! ```text
//! G(y) = E[(1 + y)^M]:   a flight of optical depth d has e^{−d} e^{νdy}, ν = σ̂/σ_t − 1, its end 1 + y,
//! a tracked connection e^{dy σ̂/σ_t}
//! ```
//!
//! All are power series in y up to y⁴; their coefficients are factorial moments.

use super::grid::{NodeGrid, Operator};
use super::{Connection, RodScene};
use crate::prediction::raw::{self, Raw};
use numeric::{Jet, Scalar};

/// Coefficients of y⁰ … y⁴.
type Series = Jet<5>;
/// A series at each node of a grid.
type NodeSeries = Vec<Series>;

const TURNS: [bool; 2] = [false, true];

/// `E[M^k]`, k = 0 … 4, of the technique with `s` light vertices.
pub fn of_technique(walks: &Walks, order: usize, s: usize) -> Raw {
    let Jet([_, f1, f2, f3, f4]) = if s == 0 || s == order + 2 {
        walks.failed(order) + walks.after(order, true)
    } else {
        let (light, camera) = (s - 1, order + 1 - s);
        let later = walks.mass(light) * walks.failed(camera);
        walks.failed(light) + later + walks.connected(light, camera)
    };
    raw::of_factorial([f1, 2.0 * f2, 6.0 * f3, 24.0 * f4])
}

/// `e^{−d + xy}`.
fn exponential(depth: f64, x: f64) -> Series {
    Jet([-depth, x, 0.0, 0.0, 0.0]).exp()
}

/// The sum of two fields.
fn sum(a: &[Series], b: &[Series]) -> NodeSeries {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}

/// `(1 + y)` times a field.
fn looked_up(field: &[Series]) -> NodeSeries {
    field.iter().map(|&series| Series::mark() * series).collect()
}

/// Walks from one end of the rod; walks from the other end are their mirror images.
pub struct Walks<'a> {
    scene: &'a RodScene,
    grid: &'a NodeGrid,
    /// ν.
    nulls: f64,
    /// `σ̂/σ_t` where connections are tracked, else 0.
    tracked: f64,
    /// Walks that arrive at each scattering, from the first on, flying backward and forward.
    arriving: Vec<[NodeSeries; 2]>,
    /// Connections of two places.
    connections: Operator<Series>,
    /// Flights that end in the rod, from each node backward and forward.
    collided: [NodeSeries; 2],
}

impl<'a> Walks<'a> {
    /// Walks with up to as many scatterings as the scene has, for this value of `σ_t/σ̂`.
    pub fn new(
        scene: &'a RodScene,
        connection: Connection,
        ratio: f64,
        grid: &'a NodeGrid,
    ) -> Self {
        let nulls = (1.0 - ratio) / ratio;
        let tracked = if matches!(connection, Connection::Ratio(_)) { 1.0 / ratio } else { 0.0 };
        let flight = |d: f64| exponential(d, nulls * d);
        let flights = grid.operator(flight);
        let [nothing, one] = [0.0, 1.0].map(|mass| grid.values(|_| Series::from(mass)));
        let collided = TURNS.map(|is_forward| looked_up(&flights.over(!is_forward, &one)));
        let mut arriving = vec![[nothing, looked_up(&grid.values(flight))]];
        for _ in 1..*scene.orders.end() {
            let last = &arriving[arriving.len() - 1];
            let next = TURNS.map(|is_forward| {
                let [on, round] = TURNS.map(|turn| scene.albedo * scene.phase(turn));
                let [same, other] = [is_forward, !is_forward].map(|way| &last[usize::from(way)]);
                let pairs = same.iter().zip(other);
                let scattered: NodeSeries = pairs.map(|(&a, &b)| a * on + b * round).collect();
                looked_up(&flights.over(is_forward, &scattered))
            });
            arriving.push(next);
        }
        let connections = grid.operator(|d| exponential(0.0, tracked * d));
        Self { scene, grid, nulls, tracked, arriving, connections, collided }
    }

    /// Flights that leave the rod over this optical depth.
    fn escape(&self, depth: f64) -> Series {
        exponential(depth, self.nulls * depth)
    }

    /// Walks that have made `count` scatterings.
    fn mass(&self, count: usize) -> Series {
        let Some(last) = count.checked_sub(1) else { return Series::from(1.0) };
        let [back, on] = &self.arriving[last];
        self.grid.integral(back) + self.grid.integral(on)
    }

    /// Walks that end after `count` scatterings: absorbed, or out of the rod. If the flight is the last one, walks
    /// that collide once more are included.
    fn after(&self, count: usize, is_last: bool) -> Series {
        let depth = self.scene.depth.value;
        let Some(last) = count.checked_sub(1) else {
            let escaped = self.escape(depth);
            return if is_last { escaped + self.mass(1) } else { escaped };
        };
        let mut ended = self.mass(count) * (1.0 - self.scene.albedo);
        for (arrives, field) in self.arriving[last].iter().enumerate() {
            for turn in TURNS {
                let is_forward = (arrives == 1) ^ turn;
                let left = |u: f64| if is_forward { depth - u } else { u };
                let escapes = self.grid.values(|u| self.escape(left(u)));
                let collided = &self.collided[usize::from(is_forward)];
                let flights = if is_last { sum(&escapes, collided) } else { escapes };
                let factor = self.scene.albedo * self.scene.phase(turn);
                ended = ended + self.grid.product(field, &flights) * factor;
            }
        }
        ended
    }

    /// Walks that end before they have made `count` scatterings.
    fn failed(&self, count: usize) -> Series {
        (0..count).fold(Series::from(0.0), |sum, i| sum + self.after(i, false))
    }

    /// Positions of walks after `count` scatterings, from the far end of the rod if `is_mirrored`.
    fn places(&self, count: usize, is_mirrored: bool) -> NodeSeries {
        let [back, on] = &self.arriving[count - 1];
        let mut places = sum(back, on);
        if is_mirrored {
            places.reverse();
        }
        places
    }

    /// Pairs of walks with the given numbers of scatterings, and their connection.
    fn connected(&self, light: usize, camera: usize) -> Series {
        let is_mirrored = self.scene.is_transmitted;
        let sensor = if is_mirrored { self.scene.depth.value } else { 0.0 };
        let along = |depth: f64| exponential(0.0, self.tracked * depth);
        let to = |point: f64| self.grid.values(|u| along((u - point).abs()));
        match (light, camera) {
            (0, 0) => along(sensor),
            (_, 0) => self.grid.product(&self.places(light, false), &to(sensor)),
            (0, _) => self.grid.product(&self.places(camera, is_mirrored), &to(0.0)),
            _ => {
                let (from, to) = (self.places(light, false), self.places(camera, is_mirrored));
                let connected =
                    |is_before| self.grid.product(&self.connections.over(is_before, &from), &to);
                connected(false) + connected(true)
            }
        }
    }
}
