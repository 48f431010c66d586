//! A rod cut into steps, and its two-stream equations on them.
//!
//! ```text
//! m₊' = A m₊ − B m₋ − s₊,   m₋' = −A m₋ + B m₊ + s₋
//! ```
//!
//! m₊(x) and m₋(x) are the expected scores of a particle of weight 1 at x that flies forward or backward. A is the
//! rate at which it leaves its state, B the rate at which it turns round, and s the score per length. The implicit
//! midpoint rule makes every step a layer with reflection r, equal from both sides, transmission t and emission e:
//!
//! ```text
//! D = (1 + a)² − b²,  t = (1 − a² + b²)/D,  r = 2b/D,  e± = h((1 + a)s± + b s∓)/D,  a = hA/2, b = hB/2
//! ```
//!
//! It is symmetric, so that its error is a series in h², which Romberg's scheme removes term by term.

use super::super::particle::{Odds, ParticleRule};
use super::super::{Mesh, mesh::Panel};
use crate::problems::{Problem, Rod};
use media::Piecewise;
use numeric::Span;

/// The largest `h(|A_k| + B_k)`, k = 0 … 2, of a step of the coarsest grid.
const COARSEST: f64 = 0.5;
/// Maximum number of steps of the coarsest grid.
const MOST: f64 = 1e4;

/// The middle of a step.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// The step's end.
    pub end: f64,
    /// h.
    pub width: f64,
    /// σ̂.
    pub sampling: f64,
    /// `r (1 − a)`: the part of the weight that a collision absorbs.
    pub absorbed: f64,
    /// The part of the rod that it lies in, see [`Rod::part`].
    pub part: usize,
    /// `p_f`.
    pub forward: f64,
    /// Probabilities and weights at a collision.
    pub odds: Odds,
    /// `1 − r` and `a r`, the mean weights of transmitted and of scattered particles.
    pub means: [f64; 2],
}

impl Step {
    /// `Q_k` and `S_k`.
    #[inline]
    pub fn moments(&self, k: i32) -> [f64; 2] {
        self.odds.moments(self.means, k)
    }

    /// k-th moment of the score of a particle that collides here, given the moments after the collision.
    #[inline]
    pub fn after(&self, k: i32, worth: [f64; 2]) -> [f64; 2] {
        let [q, s] = self.moments(k);
        let spread = self.spread(worth);
        [q * worth[0] + s * spread[0], q * worth[1] + s * spread[1]]
    }

    /// Moments of a particle that is scattered here, given those of both new directions.
    #[inline]
    pub fn spread(&self, [plus, minus]: [f64; 2]) -> [f64; 2] {
        let backward = 1.0 - self.forward;
        [self.forward * plus + backward * minus, self.forward * minus + backward * plus]
    }

    /// A and B of the k-th moment.
    #[inline]
    pub fn rates(&self, k: i32) -> [f64; 2] {
        self.rates_of(self.moments(k))
    }

    /// A and B of the absolute values, which converge where the moment exists.
    fn absolute_rates(&self, k: i32) -> [f64; 2] {
        self.rates_of(self.moments(k).map(f64::abs))
    }

    #[inline]
    fn rates_of(&self, [q, s]: [f64; 2]) -> [f64; 2] {
        [self.sampling * (1.0 - q - s * self.forward), self.sampling * s * (1.0 - self.forward)]
    }
}

/// Steps from the beginning of the support to its end.
pub struct Grid {
    steps: Vec<Step>,
    parts_per_length: f64,
    raised: [f64; 2],
}

/// A walk through a rod, as theory describes it.
pub struct Walk<'a> {
    /// The rod.
    pub rod: &'a Rod,
    /// σ̂; `None` for the walk of the light itself, which flies through σ_t.
    pub sampling: Option<&'a Piecewise>,
    /// Rule at a collision.
    pub rule: ParticleRule,
    panels: Vec<(Span, usize)>,
}

impl<'a> Walk<'a> {
    /// Cuts the rod where a, `p_f` or σ̂ has a knot and where the rule changes; `None` where that makes too many
    /// steps.
    pub fn new(
        mesh: &Mesh,
        rod: &'a Rod,
        sampling: Option<&'a Piecewise>,
        rule: ParticleRule,
    ) -> Option<Self> {
        let mut cuts = rod.albedo.knots().to_vec();
        cuts.extend(rod.forward.knots());
        if let Some(sampling) = sampling {
            cuts.extend(sampling.knots());
        }
        let from = mesh.support().from;
        cuts.extend((1..rod.parts).map(|part| from + rod.width() * part as f64));
        let cut = mesh.refined(&cuts, &|_, _| Vec::new());
        let mut kinks = Vec::new();
        if let Some(sampling) = sampling {
            for kink in 0..rule.kinks(1.0).len() {
                let ratio = |t: f64| rule.kinks(rod.albedo.value(t))[kink];
                kinks.extend(cut.roots(|t, sigma| sigma - ratio(t) * sampling.value(t)));
            }
        }
        let cut = cut.refined(&kinks, &|_, _| Vec::new());
        let mut walk = Self { rod, sampling, rule, panels: Vec::new() };
        let mut sum = 0.0;
        for panel in cut.panels() {
            let steps = walk.steps_of(panel);
            sum += steps;
            // NaN stops here too.
            if sum.is_nan() || sum > MOST {
                return None;
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
            walk.panels.push((panel.span, steps as usize));
        }
        Some(walk)
    }

    fn steps_of(&self, panel: Panel<'_>) -> f64 {
        let at = panel.t.iter().zip(panel.extinction);
        let rates = at.map(|(&t, &sigma)| {
            let step = self.at(t, sigma);
            let rate = |k: i32| step.rates(k).map(f64::abs).iter().sum::<f64>();
            (0..=2)
                .map(rate)
                .fold(0.0, |most, rate| if rate.is_nan() { rate } else { rate.max(most) })
        });
        let fastest = rates.fold(0.0, |most, rate| if rate <= most { most } else { rate });
        (panel.span.length() * fastest / COARSEST).ceil().max(2.0)
    }

    /// The walk with steps that also resolve a transmittance: at most a quarter of an optical depth.
    pub fn resolving_transmittance(mut self) -> Option<Self> {
        let mut sum = 0.0;
        for (span, steps) in &mut self.panels {
            let places = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| span.from + share * span.length());
            let densest = self.rod.medium().extinctions(&places).into_iter().fold(0.0, f64::max);
            let wanted = (4.0 * span.length() * densest).ceil().max(*steps as f64);
            sum += wanted;
            if sum.is_nan() || sum > MOST {
                return None;
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MOST
            let wanted = wanted as usize;
            *steps = wanted;
        }
        Some(self)
    }

    fn at(&self, t: f64, extinction: f64) -> Step {
        let (albedo, forward) = (self.rod.albedo.value(t), self.rod.forward.value(t));
        let sampling = self.sampling.map_or(extinction, |sampling| sampling.value(t));
        // Where both vanish there are no collisions, and any finite ratio is valid.
        let ratio = match self.sampling {
            None => 1.0,
            Some(_) if extinction == 0.0 => 0.0,
            Some(_) => extinction / sampling,
        };
        let odds = self.rule.odds(ratio, albedo);
        let absorbed = ratio * (1.0 - albedo);
        let part = self.rod.part(t);
        let means = [1.0 - ratio, albedo * ratio];
        Step { end: t, width: 0.0, sampling, absorbed, part, forward, odds, means }
    }

    /// The grid with steps `finer` times shorter than those of the coarsest grid.
    pub fn grid(&self, finer: usize) -> Grid {
        let mut steps = Vec::new();
        for &(span, count) in &self.panels {
            let count = count * finer;
            let width = span.length() / count as f64;
            let middles: Vec<f64> =
                (0..count).map(|i| span.from + width * (i as f64 + 0.5)).collect();
            let extinctions = self.rod.medium().extinctions(&middles);
            let pairs = middles.iter().zip(&extinctions).enumerate();
            steps.extend(pairs.map(|(i, (&t, &sigma))| {
                let end = span.from + width * (i + 1) as f64;
                Step { end, width, ..self.at(t, sigma) }
            }));
        }
        Grid { steps, parts_per_length: 1.0 / self.rod.width(), raised: [0.0; 2] }
    }

    /// Number of steps of the coarsest grid.
    pub fn coarsest(&self) -> usize {
        self.panels.iter().map(|panel| panel.1).sum()
    }
}

/// m₊ and m₋ at the ends of all steps.
#[derive(Debug, Clone)]
pub struct Importance(Vec<[f64; 2]>);

impl Importance {
    /// Values in the middle of a step.
    #[inline]
    pub fn middle(&self, step: usize) -> [f64; 2] {
        let (from, to) = (self.0[step], self.0[step + 1]);
        [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])]
    }

    /// Value of the particle that enters.
    pub fn entering(&self) -> f64 {
        self.0[0][0]
    }
}

/// A step as a layer.
struct Layer {
    through: f64,
    back: f64,
    /// `h(1 + a)/D` and `h b/D`: the parts of a source that leave in its direction, and in the other one.
    emission: [f64; 2],
}

impl Layer {
    fn new([a, b]: [f64; 2], width: f64) -> Self {
        let (a, b) = (0.5 * width * a, 0.5 * width * b);
        let scale = 1.0 / ((1.0 + (a - b)) * (1.0 + (a + b)));
        Self {
            through: (1.0 - (a - b) * (a + b)) * scale,
            back: 2.0 * b * scale,
            emission: [width * (1.0 + a) * scale, width * b * scale],
        }
    }

    /// The layer with all that leaves it multiplied by a factor; a factor of 1 changes no bit.
    fn times(self, factor: f64) -> Self {
        Self {
            through: self.through * factor,
            back: self.back * factor,
            emission: self.emission.map(|emission| emission * factor),
        }
    }
}

impl Grid {
    /// The grid with absolute values of all weights, where the energy that leaves a step is increased by a share
    /// per step and a share per collision of either kind.
    ///
    /// The relative growth of a number per share is the mean number of steps, or collisions, on its paths. This is
    /// how many roundings of steps it collects.
    #[must_use]
    pub fn raised(&self, by: [f64; 2]) -> Self {
        let absolute = |step: &Step| Step {
            odds: step.odds.absolute(),
            means: step.means.map(f64::abs),
            absorbed: step.absorbed.abs(),
            sampling: step.sampling.abs(),
            ..*step
        };
        Self { steps: self.steps.iter().map(absolute).collect(), raised: by, ..*self }
    }

    /// The steps, from the beginning of the support to its end.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Factor by which the energy that leaves a step is increased.
    fn growth(&self, step: &Step, [a, b]: [f64; 2]) -> f64 {
        // σ̂(1 + Q + S) ≤ 2σ̂ + |A| + |B|
        let collisions = step.width * (2.0 * step.sampling + a.abs() + b.abs());
        1.0 + self.raised[0] + self.raised[1] * collisions
    }

    /// One over the length of the parts in which the flux is counted.
    pub fn parts_per_length(&self) -> f64 {
        self.parts_per_length
    }

    /// Distance at which the k-th moment diverges in a rod that is longer everywhere by a share: the moment exists
    /// only if the rod ends before it. `None` where it exists.
    ///
    /// The passed part reflects ρ, and the next layer r: their echoes `Σ(ρr)^n` diverge where ρr reaches 1. This is
    /// so on the grid, which finds the critical length to about a ten-thousandth; see [`Self::margin`].
    pub fn critical(&self, k: i32, longer: f64) -> Option<f64> {
        let mut passed = 0.0;
        for step in &self.steps {
            let layer = Layer::new(step.absolute_rates(k), step.width * (1.0 + longer));
            let echo = 1.0 - passed * layer.back;
            if !(echo > 0.0 && layer.through > 0.0 && layer.back >= 0.0) {
                return Some(step.end);
            }
            passed = layer.back + layer.through * layer.through * passed / echo;
        }
        None
    }

    /// Distance of the k-th moment from its divergence: the moment exists where this is positive.
    ///
    /// ```text
    /// y' = Ay − Bz,  z' = −Az + By,  (y, z) = (1, 0) at the beginning;   y/√(y² + z²) at the end
    /// ```
    ///
    /// The moment exists where y stays positive, and is 1/y for transmission. Over a layer `y → y (1 − ρr)/t` with
    /// ρ = z/y. It is smooth in the steps' lengths even where y is 0. `None` where y turns more than once, or steps
    /// are too long.
    pub fn margin(&self, k: i32) -> Option<f64> {
        let (mut passed, mut turns) = (0.0, 0);
        for step in &self.steps {
            let layer = Layer::new(step.absolute_rates(k), step.width);
            let echo = 1.0 - passed * layer.back;
            if !(layer.through > 0.0 && layer.back >= 0.0) {
                return None;
            }
            turns += u32::from(echo <= 0.0);
            passed = layer.back + layer.through * layer.through * passed / echo;
        }
        let size = 1.0 / 1.0_f64.hypot(passed);
        match turns {
            0 => Some(size),
            1 => Some(-size),
            _ => None,
        }
    }

    /// Solves the equations with given rates and sources, where leaving at the beginning and at the end scores
    /// `ends`; `None` where the echoes diverge.
    pub fn solve(
        &self,
        rates: impl Fn(&Step) -> [f64; 2],
        source: impl Fn(usize, &Step) -> [f64; 2],
        ends: [f64; 2],
    ) -> Option<Importance> {
        let n = self.steps.len();
        // m₊ = ρ m₋ + η at the beginning of each step, from the end of the rod backwards.
        let mut beyond = vec![[0.0, ends[1]]; n + 1];
        let mut layers = Vec::with_capacity(n);
        for (i, step) in self.steps.iter().enumerate().rev() {
            let rates = rates(step);
            let layer = Layer::new(rates, step.width).times(self.growth(step, rates));
            let [plus, minus] = source(i, step);
            let [straight, turned] = layer.emission;
            let emitted = [straight * plus + turned * minus, straight * minus + turned * plus];
            let [rho, eta] = beyond[i + 1];
            let echo = 1.0 - layer.back * rho;
            if echo.is_nan() || echo <= 0.0 {
                return None;
            }
            let minus = (layer.back * eta + emitted[1]) / echo;
            beyond[i] = [
                layer.back + layer.through * layer.through * rho / echo,
                emitted[0] + layer.through * (eta + rho * minus),
            ];
            layers.push((layer, emitted[1]));
        }
        let mut worth = Vec::with_capacity(n + 1);
        let mut minus = ends[0];
        for (i, (layer, emitted)) in layers.iter().rev().enumerate() {
            let [rho, eta] = beyond[i];
            worth.push([rho * minus + eta, minus]);
            let [rho, eta] = beyond[i + 1];
            minus = (layer.through * minus + layer.back * eta + emitted) / (1.0 - layer.back * rho);
        }
        worth.push([beyond[n][0] * minus + ends[1], minus]);
        Some(Importance(worth))
    }
}
