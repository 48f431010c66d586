//! Paths: two subpaths and their connection.
//!
//! ```text
//! the first s vertices by delta tracking from the light, the other r + 2 − s from the sensor, then
//! T̂ between the last ones: exp(−∫σ_t), or ∏ (1 − σ_t/σ̂) by ratio tracking
//! s = 0 and s = r + 2: all of it from one side, a hit of the light or of the sensor
//! ```
//!
//! Independent paths have subpaths of their own. Shared ones begin with one walk from either side, until it is
//! absorbed, leaves, or has been scattered as often as the highest order, and all techniques of all orders take
//! their first vertices.

use super::subpath::{Subpath, Tracker};
use crate::{Draw, Setup};
use media::Lookups;
use numeric::rng::Stream;
use numeric::{Lane, Span};
use theory::bidirectional_rod::{Combination, quotient};
use theory::problems::bidirectional_rod::{HIGHEST_ORDER, MOST, Sensor, Values};
use theory::problems::{BidirectionalRod, Problem};

/// A path from the light to the sensor.
#[derive(Debug, Clone, Copy)]
pub struct Path {
    /// How often it is scattered, r.
    pub order: usize,
    /// How many of its vertices were made from the light, s.
    pub light: usize,
    /// Light, scatterings and sensor, as distances along the ray.
    pub at: [f64; HIGHEST_ORDER + 2],
    /// Whether each segment goes forward.
    pub is_forward: [bool; HIGHEST_ORDER + 1],
    /// `T̂ⱼ` of each segment.
    pub transmittance: [f64; HIGHEST_ORDER + 1],
    /// ρ at each scattering, from the first on.
    pub phase: [f64; HIGHEST_ORDER],
    /// a.
    pub albedo: f64,
}

impl Path {
    /// `c_s = f/p_s` of a technique for this path.
    #[inline(always)]
    pub fn quotient(&self, s: usize) -> f64 {
        let scattered = |i: usize| self.albedo * self.phase[i - 1];
        quotient(s, self.order, |j| self.transmittance[j], scattered)
    }

    /// The weight of the technique that made it.
    #[inline(always)]
    pub fn weight(&self, combination: Combination) -> f64 {
        match combination {
            Combination::Full(heuristic) => {
                heuristic.share(self.light, self.order, |j| self.quotient(j))
            }
            _ => combination.weight(&self.phase[..self.order], self.light),
        }
    }
}

/// What an estimator does, some of which a known bug may replace.
pub trait Steps {
    /// Which techniques, and what they are worth beside each other.
    fn combination(&self) -> Combination;

    /// Whether connections are tracked.
    fn is_tracked(&self) -> bool;

    /// Whether all techniques share their subpaths.
    fn is_shared(&self) -> bool;

    /// What the generator does before each path: it goes on.
    #[inline(always)]
    fn begin(&self, rng: &mut Stream, beginning: &Stream) {
        let _ = (rng, beginning);
    }

    /// Where the connection of a path begins: the last vertex from the light.
    #[inline(always)]
    fn joined(&self, path: &Path) -> usize {
        path.light - 1
    }

    /// What a path is worth; `T̂` of its connection is positive.
    #[inline(always)]
    fn worth(&self, path: &Path) -> f64 {
        path.weight(self.combination()) * path.quotient(path.light)
    }

    /// What all techniques are worth together.
    #[inline(always)]
    fn together(&self, each: &[f64]) -> f64 {
        each.iter().sum()
    }
}

/// Makes one draw: a path of each technique.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    setup: &Setup<BidirectionalRod>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let tracker = Tracker { setup, medium };
    let mut values = Values { at: [0.0; MOST], count: 0 };
    let (mut lookups, beginning) = (0, *rng);
    let orders = setup.problem.orders.clone();
    let shared = steps.is_shared().then(|| {
        let whole = [*orders.end(), 1];
        [true, false].map(|from_light| tracker.subpath(from_light, whole, rng, &mut lookups))
    });
    for order in orders {
        for s in steps.combination().techniques(order) {
            steps.begin(rng, &beginning);
            let subpaths = match shared {
                Some(subpaths) => Some(subpaths),
                None => independent(&tracker, order, s, rng, &mut lookups),
            };
            let path = subpaths.and_then(|subpaths| {
                joined(&tracker, steps, [order, s], &subpaths, rng, &mut lookups)
            });
            values.at[values.count] = path.map_or(0.0, |path| steps.worth(&path));
            values.count += 1;
        }
    }
    let sum = steps.together(&values.at[..values.count]);
    if !setup.problem.has_shares {
        values.count = 0;
    }
    if values.count != 1 {
        values.at[values.count] = sum;
        values.count += 1;
    }
    Draw::free(values, lookups)
}

/// The subpaths of a technique; `None` where that from the light ends too soon.
#[inline(always)]
fn independent(
    tracker: &Tracker,
    order: usize,
    s: usize,
    rng: &mut Stream,
    lookups: &mut u32,
) -> Option<[Subpath; 2]> {
    let [light, camera] = match s {
        0 => [[0, 0], [order, 1]],
        _ if s == order + 2 => [[order, 1], [0, 0]],
        _ => [[s - 1, 0], [order + 1 - s, 0]],
    };
    let from_light = tracker.subpath(true, light, rng, lookups);
    let is_whole = from_light.count == light[0];
    is_whole.then(|| [from_light, tracker.subpath(false, camera, rng, lookups)])
}

/// A path by a technique with `[r, s]`, from the first vertices of two subpaths; `None` where one of them has
/// too few, a hit misses, or nothing comes through.
#[inline(always)]
fn joined(
    tracker: &Tracker,
    steps: &impl Steps,
    [order, s]: [usize; 2],
    [light, camera]: &[Subpath; 2],
    rng: &mut Stream,
    lookups: &mut u32,
) -> Option<Path> {
    let (problem, support) = (&*tracker.setup.problem, tracker.setup.mesh.support());
    let is_transmitted = problem.sensor == Sensor::Transmitted;
    let is_hit = s == 0 || s == order + 2;
    // Scatterings that each of the two makes.
    let from_light = s.saturating_sub(1).min(order);
    let from_camera = order - from_light;
    if light.count < from_light || camera.count < from_camera {
        return None;
    }
    if is_hit {
        let (whole, leaves) = if s == 0 { (camera, false) } else { (light, is_transmitted) };
        if whole.count != order || whole.left != Some(leaves) {
            return None;
        }
    }
    let mut path = Path {
        order,
        light: s,
        at: [support.from; HIGHEST_ORDER + 2],
        is_forward: [true; HIGHEST_ORDER + 1],
        transmittance: [1.0; HIGHEST_ORDER + 1],
        phase: [0.0; HIGHEST_ORDER],
        albedo: problem.albedo,
    };
    path.at[order + 1] = if is_transmitted { support.to } else { support.from };
    for i in 0..from_light {
        path.at[i + 1] = light.at[i];
    }
    for i in 0..from_camera {
        path.at[order - i] = camera.at[i];
    }
    // A hit has one more segment than scatterings.
    for j in 0..from_light + usize::from(is_hit && s > 0) {
        path.is_forward[j] = light.is_forward[j];
        path.transmittance[j] = light.nulls[j];
    }
    for j in 0..from_camera + usize::from(s == 0) {
        path.is_forward[order - j] = !camera.is_forward[j];
        path.transmittance[order - j] = camera.nulls[j];
    }
    if !is_hit {
        let j = s - 1;
        path.is_forward[j] = match s {
            _ if s == order + 1 => is_transmitted,
            1 => true,
            _ => path.at[j] < path.at[s],
        };
        if steps.is_tracked() {
            let (begin, is_forward) = (light.cursors[from_light], path.is_forward[j]);
            path.transmittance[j] = tracker.connect(begin, path.at[s], is_forward, rng, lookups);
        }
    }
    for i in 0..order {
        let goes_on = path.is_forward[i] == path.is_forward[i + 1];
        path.phase[i] = if goes_on { problem.forward } else { 1.0 - problem.forward };
    }
    if !steps.is_tracked() {
        attenuate(problem, steps, &mut path);
    }
    (is_hit || path.transmittance[s - 1] > 0.0).then_some(path)
}

/// `T̂` in closed form: of the connection, or of all segments where weights ask for them.
#[inline(always)]
fn attenuate(problem: &BidirectionalRod, steps: &impl Steps, path: &mut Path) {
    let between = |a: f64, b: f64| {
        let depth = problem.medium().optical_depth(Span::new(a.min(b), a.max(b))).value;
        Lane::exp(-depth)
    };
    if matches!(steps.combination(), Combination::Full(_)) {
        for j in 0..=path.order {
            path.transmittance[j] = between(path.at[j], path.at[j + 1]);
        }
    }
    if path.light >= 1 && path.light <= path.order + 1 {
        let from = steps.joined(path);
        path.transmittance[path.light - 1] = between(path.at[from], path.at[path.light]);
    }
}
