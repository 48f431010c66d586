//! One path of one technique: two subpaths and their connection.
//!
//! ```text
//! the first s vertices by delta tracking from the light, the other r + 2 − s from the sensor, then
//! T̂ between the last ones: exp(−∫σ_t), or ∏ (1 − σ_t/σ̂) by ratio tracking
//! s = 0 and s = r + 2: all of it from one side, a hit of the light or of the sensor
//! ```
//!
//! A subpath is tracked through σ̂: a flight and each tentative collision take a random number, a scattering
//! one more, which says whether the particle is absorbed, goes straight on or turns. The last vertex of a
//! subpath is a real collision, where nothing is decided yet. A subpath that is absorbed, or leaves, ends the
//! path: it is worth 0.

use crate::estimators::{Draw, Setup};
use crate::media::{Cursor, Extinction, Lookups};
use crate::numeric::{Lane, Span};
use crate::problems::bidirectional_rod::{HIGHEST_ORDER, MOST, Sensor, Values};
use crate::problems::{BidirectionalRod, Problem};
use crate::rng::Stream;
use crate::theory::bidirectional_rod::{Combination, quotient};

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
    let walk = Walk { setup, medium, is_tracked: steps.is_tracked() };
    let mut values = Values { at: [0.0; MOST], count: 0 };
    let (mut lookups, beginning) = (0, *rng);
    for order in setup.problem.orders.clone() {
        for s in steps.combination().techniques(order) {
            steps.begin(rng, &beginning);
            let path = walk.path(steps, order, s, rng, &mut lookups);
            values.at[values.count] = path.map_or(0.0, |path| steps.worth(&path));
            values.count += 1;
        }
    }
    if values.count > 1 {
        values.at[values.count] = steps.together(&values.at[..values.count]);
        values.count += 1;
    }
    Draw::free(values, lookups)
}

/// Where a subpath stands.
#[derive(Clone, Copy)]
struct Head {
    cursor: Cursor,
    is_forward: bool,
    /// `∏ (1 − σ_t/σ̂)` over the null vertices since the last real one.
    nulls: f64,
}

/// Tracking through the rod of one experiment.
struct Walk<'a> {
    setup: &'a Setup<BidirectionalRod>,
    medium: &'a Lookups<'a>,
    is_tracked: bool,
}

impl Walk<'_> {
    /// A path of a technique; `None` where a subpath ends too soon or nothing comes through.
    #[inline(always)]
    fn path(
        &self,
        steps: &impl Steps,
        order: usize,
        s: usize,
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> Option<Path> {
        let (problem, support) = (&*self.setup.problem, self.setup.mesh.support());
        let is_transmitted = problem.sensor == Sensor::Transmitted;
        let mut path = Path {
            order,
            light: s,
            at: [support.from; HIGHEST_ORDER + 2],
            is_forward: [true; HIGHEST_ORDER + 1],
            transmittance: [1.0; HIGHEST_ORDER + 1],
            phase: [0.0; HIGHEST_ORDER],
            albedo: problem.albedo,
        };
        let sensor = if is_transmitted { support.to } else { support.from };
        path.at[order + 1] = sensor;
        let sampling = &self.setup.sampling;
        let mut light = Head { cursor: sampling.begin(), is_forward: true, nulls: 1.0 };
        let from_sensor = if is_transmitted { sampling.end() } else { sampling.begin() };
        let mut camera = Head { cursor: from_sensor, is_forward: !is_transmitted, nulls: 1.0 };
        for i in 1..s.min(order + 1) {
            self.collide(&mut light, i > 1, rng, lookups)?;
            path.at[i] = light.cursor.t;
            path.is_forward[i - 1] = light.is_forward;
            path.transmittance[i - 1] = light.nulls;
        }
        for i in (s.max(1)..=order).rev() {
            self.collide(&mut camera, i < order, rng, lookups)?;
            path.at[i] = camera.cursor.t;
            path.is_forward[i] = !camera.is_forward;
            path.transmittance[i] = camera.nulls;
        }
        if s == 0 || s == order + 2 {
            let (head, segment, leaves_forward) =
                if s == 0 { (&mut camera, 0, false) } else { (&mut light, order, is_transmitted) };
            let is_hit = self.escape(head, order > 0, rng, lookups)? == leaves_forward;
            if !is_hit {
                return None;
            }
            path.is_forward[segment] = s == 0 || leaves_forward;
            path.transmittance[segment] = head.nulls;
        } else {
            path.is_forward[s - 1] =
                if s == order + 1 { is_transmitted } else { s == 1 || path.at[s - 1] < path.at[s] };
            if self.is_tracked {
                let connected =
                    self.connect(light.cursor, path.at[s], path.is_forward[s - 1], rng, lookups);
                path.transmittance[s - 1] = connected;
            }
        }
        for i in 1..=order {
            let goes_on = path.is_forward[i - 1] == path.is_forward[i];
            path.phase[i - 1] = if goes_on { problem.forward } else { 1.0 - problem.forward };
        }
        if !self.is_tracked {
            self.attenuate(steps, &mut path);
        }
        let is_connected = s >= 1 && s <= order + 1;
        (!is_connected || path.transmittance[s - 1] > 0.0).then_some(path)
    }

    /// `T̂` in closed form: of the connection, or of all segments where weights ask for them.
    #[inline(always)]
    fn attenuate(&self, steps: &impl Steps, path: &mut Path) {
        let medium = self.setup.problem.medium();
        let between = |a: f64, b: f64| {
            let depth = medium.optical_depth(Span::new(a.min(b), a.max(b))).value;
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

    /// Scatters, where that is asked for, and flies to the next real collision.
    #[inline(always)]
    fn collide(
        &self,
        head: &mut Head,
        scatters: bool,
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> Option<()> {
        if scatters {
            self.scatter(head, rng)?;
        }
        self.fly(head, rng, lookups).then_some(())
    }

    /// The end, forward or not, at which a walk leaves after one more scattering, where that is asked
    /// for.
    #[inline(always)]
    fn escape(
        &self,
        head: &mut Head,
        scatters: bool,
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> Option<bool> {
        if scatters {
            self.scatter(head, rng)?;
        }
        (!self.fly(head, rng, lookups)).then_some(head.is_forward)
    }

    /// `None` if it is absorbed.
    #[inline(always)]
    fn scatter(&self, head: &mut Head, rng: &mut Stream) -> Option<()> {
        let (number, problem) = (rng.uniform(), &self.setup.problem);
        if number >= problem.albedo {
            return None;
        }
        head.is_forward ^= number >= problem.albedo * problem.forward;
        Some(())
    }

    /// Flies to the next real collision; false if it leaves before.
    #[inline(always)]
    fn fly(&self, head: &mut Head, rng: &mut Stream, lookups: &mut u32) -> bool {
        head.nulls = 1.0;
        loop {
            let depth = -rng.ln_uniform();
            let flown = if head.is_forward {
                self.setup.sampling.fly(&mut head.cursor, depth)
            } else {
                self.setup.sampling.fly_back(&mut head.cursor, depth)
            };
            let Some(sampling) = flown else { return false };
            *lookups += 1;
            let ratio = self.medium.extinction(head.cursor.t) / sampling;
            if rng.uniform() < ratio {
                return true;
            }
            head.nulls *= 1.0 - ratio;
        }
    }

    /// `∏ (1 − σ_t/σ̂)` on the way to a place.
    #[inline(always)]
    fn connect(
        &self,
        mut cursor: Cursor,
        to: f64,
        is_forward: bool,
        rng: &mut Stream,
        lookups: &mut u32,
    ) -> f64 {
        let sampling = &self.setup.sampling;
        let mut nulls = 1.0;
        loop {
            let depth = -rng.ln_uniform();
            let flown = if is_forward {
                sampling.fly(&mut cursor, depth).filter(|_| cursor.t < to)
            } else {
                sampling.fly_back(&mut cursor, depth).filter(|_| cursor.t > to)
            };
            let Some(sampling) = flown else { return nulls };
            *lookups += 1;
            nulls *= 1.0 - self.medium.extinction(cursor.t) / sampling;
        }
    }
}
