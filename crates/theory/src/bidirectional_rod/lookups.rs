//! Moments of the number of lookups of a draw, where `σ_t/σ̂` has one value.
//!
//! ```text
//! G(y) = E[(1 + y)^M]:   a flight of optical depth d has e^{−d} e^{νdy}, ν = σ̂/σ_t − 1, its end 1 + y,
//! a tracked connection e^{dy σ̂/σ_t}
//! ```
//!
//! All are power series in y up to y⁴; their coefficients are factorial moments.

use super::grid::{Grid, Operator};
use super::{Connection, Scene};
use crate::raw::{self, Raw};

/// Coefficients of y⁰ … y⁴.
const TERMS: usize = 5;

type Series = [f64; TERMS];
/// A series at each node of a grid.
type Field = [Vec<f64>; TERMS];

const TURNS: [bool; 2] = [false, true];

/// `E[M^k]`, k = 0 … 4, of the technique with `s` light vertices.
pub fn of_technique(walks: &Walks, order: usize, s: usize) -> Raw {
    let series = if s == 0 || s == order + 2 {
        plus(walks.failed(order), walks.after(order, true))
    } else {
        let (light, camera) = (s - 1, order + 1 - s);
        let later = times(walks.mass(light), walks.failed(camera));
        plus(plus(walks.failed(light), later), walks.connected(light, camera))
    };
    let mut factorial = [0.0; 4];
    let mut scale = 1.0;
    for (k, (entry, coefficient)) in (1_u32..).zip(factorial.iter_mut().zip(&series[1..])) {
        scale *= f64::from(k);
        *entry = scale * coefficient;
    }
    raw::of_factorial(factorial)
}

fn plus(a: Series, b: Series) -> Series {
    std::array::from_fn(|j| a[j] + b[j])
}

fn times(a: Series, b: Series) -> Series {
    std::array::from_fn(|j| (0..=j).map(|i| a[i] * b[j - i]).sum())
}

/// `e^{xy}`.
fn exponential(x: f64) -> Series {
    let mut series = [1.0; TERMS];
    for j in 1..TERMS {
        series[j] = series[j - 1] * x / j as f64;
    }
    series
}

/// The sum of two rows.
fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

/// `(1 + y)` times a series.
fn looked_up(field: &Field) -> Field {
    std::array::from_fn(|j| match j {
        0 => field[0].clone(),
        _ => sum(&field[j], &field[j - 1]),
    })
}

/// The flights of a series.
fn flown(flights: &[Operator], is_before: bool, field: &Field) -> Field {
    std::array::from_fn(|j| {
        let terms = (0..=j).map(|i| flights[i].over(is_before, &field[j - i]));
        terms.reduce(|a, b| sum(&a, &b)).unwrap_or_default()
    })
}

/// Walks from one end of the rod; walks from the other end are their mirror images.
pub struct Walks<'a> {
    scene: &'a Scene,
    grid: &'a Grid,
    /// ν.
    nulls: f64,
    /// `σ̂/σ_t` where connections are tracked, else 0.
    tracked: f64,
    /// Walks that arrive at each scattering, from the first on, flying backward and forward.
    arriving: Vec<[Field; 2]>,
    /// Connections of two places.
    connections: Vec<Operator>,
    /// Flights that end in the rod, from each node backward and forward.
    collided: [Field; 2],
}

impl<'a> Walks<'a> {
    /// Walks with up to as many scatterings as the scene has, for this value of `σ_t/σ̂`.
    pub fn new(scene: &'a Scene, connection: Connection, ratio: f64, grid: &'a Grid) -> Self {
        let nulls = (1.0 - ratio) / ratio;
        let tracked = if matches!(connection, Connection::Ratio(_)) { 1.0 / ratio } else { 0.0 };
        let flight = |d: f64| exponential(nulls * d).map(|term| (-d).exp() * term);
        let operators = |series: &dyn Fn(f64) -> Series| -> Vec<Operator> {
            (0..TERMS).map(|j| grid.operator(|d| series(d)[j])).collect()
        };
        let (flights, connections) = (operators(&flight), operators(&|d| exponential(tracked * d)));
        let field = |f: &dyn Fn(f64) -> Series| -> Field {
            std::array::from_fn(|j| grid.values(|u| f(u)[j]))
        };
        let [nothing, one] = [0.0, 1.0].map(|mass| field(&|_| [mass, 0.0, 0.0, 0.0, 0.0]));
        let collided = TURNS.map(|is_forward| looked_up(&flown(&flights, !is_forward, &one)));
        let mut arriving = vec![[nothing, looked_up(&field(&flight))]];
        for _ in 1..*scene.orders.end() {
            let last = &arriving[arriving.len() - 1];
            let next = TURNS.map(|is_forward| {
                let scattered = std::array::from_fn(|j| {
                    let [on, round] = TURNS.map(|turn| scene.albedo * scene.phase(turn));
                    let same = last[usize::from(is_forward)][j].iter();
                    let pairs = same.zip(&last[usize::from(!is_forward)][j]);
                    pairs.map(|(same, other)| on * same + round * other).collect()
                });
                looked_up(&flown(&flights, is_forward, &scattered))
            });
            arriving.push(next);
        }
        Self { scene, grid, nulls, tracked, arriving, connections, collided }
    }

    /// Flights that leave the rod over this optical depth.
    fn escape(&self, depth: f64) -> Series {
        exponential(self.nulls * depth).map(|term| (-depth).exp() * term)
    }

    /// `∫` of the product of two series.
    fn joined(&self, a: &Field, b: &Field) -> Series {
        std::array::from_fn(|j| (0..=j).map(|i| self.grid.product(&a[i], &b[j - i])).sum())
    }

    /// Walks that have made `count` scatterings.
    fn mass(&self, count: usize) -> Series {
        let Some(last) = count.checked_sub(1) else { return [1.0, 0.0, 0.0, 0.0, 0.0] };
        let [back, on] = &self.arriving[last];
        std::array::from_fn(|j| self.grid.integral(&back[j]) + self.grid.integral(&on[j]))
    }

    /// Walks that end after `count` scatterings: absorbed, or out of the rod. If the flight is the last one, walks
    /// that collide once more are included.
    fn after(&self, count: usize, is_last: bool) -> Series {
        let depth = self.scene.depth.value;
        let Some(last) = count.checked_sub(1) else {
            let escaped = self.escape(depth);
            return if is_last { plus(escaped, self.mass(1)) } else { escaped };
        };
        let absorbed = 1.0 - self.scene.albedo;
        let mut ended = self.mass(count).map(|mass| absorbed * mass);
        for (arrives, field) in self.arriving[last].iter().enumerate() {
            for turn in TURNS {
                let is_forward = (arrives == 1) ^ turn;
                let left = |u: f64| if is_forward { depth - u } else { u };
                let flights: Field = std::array::from_fn(|j| {
                    let escapes = self.grid.values(|u| self.escape(left(u))[j]);
                    let collided = &self.collided[usize::from(is_forward)][j];
                    if is_last { sum(&escapes, collided) } else { escapes }
                });
                let factor = self.scene.albedo * self.scene.phase(turn);
                ended = plus(ended, self.joined(field, &flights).map(|term| factor * term));
            }
        }
        ended
    }

    /// Walks that end before they have made `count` scatterings.
    fn failed(&self, count: usize) -> Series {
        (0..count).fold([0.0; TERMS], |sum, i| plus(sum, self.after(i, false)))
    }

    /// Positions of walks after `count` scatterings, from the far end of the rod if `is_mirrored`.
    fn places(&self, count: usize, is_mirrored: bool) -> Field {
        let [back, on] = &self.arriving[count - 1];
        std::array::from_fn(|j| {
            let mut places = sum(&back[j], &on[j]);
            if is_mirrored {
                places.reverse();
            }
            places
        })
    }

    /// Pairs of walks with the given numbers of scatterings, and their connection.
    fn connected(&self, light: usize, camera: usize) -> Series {
        let is_mirrored = self.scene.is_transmitted;
        let sensor = if is_mirrored { self.scene.depth.value } else { 0.0 };
        let along = |depth: f64| exponential(self.tracked * depth);
        let to = |point: f64| -> Field {
            std::array::from_fn(|j| self.grid.values(|u| along((u - point).abs())[j]))
        };
        match (light, camera) {
            (0, 0) => along(sensor),
            (_, 0) => self.joined(&self.places(light, false), &to(sensor)),
            (0, _) => self.joined(&self.places(camera, is_mirrored), &to(0.0)),
            _ => {
                let (from, to) = (self.places(light, false), self.places(camera, is_mirrored));
                let both = TURNS
                    .map(|is_before| self.joined(&flown(&self.connections, is_before, &from), &to));
                plus(both[0], both[1])
            }
        }
    }
}
