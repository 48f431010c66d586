//! A walk through a rod: what happens to a particle at each place, and where panels end.

use super::NoVariance;
use super::line::Line;
use crate::collisions::particle::EventProbabilities;
use crate::problems::rod::RodQuantity;
use crate::problems::{Problem, Rod};
use crate::ray::mesh::Panel;
use crate::{Kernel, Mesh, ParticleRule};
use media::Piecewise;
use numeric::{Known, Span, roots};

/// Largest width of a panel of the coarse line times `|A| + |B|`. Below π/2 the echoes inside a panel converge.
const THICKNESS: f64 = 1.5;
/// Maximum number of panels of the coarse line.
const MAX_PANELS: f64 = 5e3;
/// Relative error of what leaves a panel, per panel and per collision of either kind.
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Relative rounding error of every path: scores on the way, up to eight times.
const OF_PATH: f64 = 128.0 * f64::EPSILON;

/// A place in a rod.
#[derive(Debug, Clone, Copy)]
pub struct RodPoint {
    /// σ̂.
    pub sampling: f64,
    /// `r (1 − a)`: the part of the weight that a collision absorbs.
    pub absorbed: f64,
    /// The part of the rod that it lies in, see [`Rod::part`].
    pub part: usize,
    /// `p_f`.
    pub forward: f64,
    /// Probabilities and weights at a collision.
    pub probabilities: EventProbabilities,
    /// `1 − r` and `a r`, the mean weights of transmitted and of scattered particles.
    pub means: [f64; 2],
}

impl RodPoint {
    /// Effect of a collision here on the k-th moment.
    #[inline]
    pub fn kernel(&self, k: i32) -> Kernel {
        self.probabilities.kernel(self.sampling, self.means, k)
    }

    /// k-th moment of the score of a particle that collides here, given the moments after the collision.
    #[inline]
    pub fn after(&self, k: i32, worth: [f64; 2]) -> [f64; 2] {
        let (kernel, spread) = (self.kernel(k), self.spread(worth));
        [0, 1].map(|way| kernel.after(worth[way], spread[way]))
    }

    /// Moments of a particle that is scattered here, given those of both new directions.
    #[inline]
    pub fn spread(&self, [plus, minus]: [f64; 2]) -> [f64; 2] {
        let backward = 1.0 - self.forward;
        [self.forward * plus + backward * minus, self.forward * minus + backward * plus]
    }

    /// A and B of the k-th moment.
    pub fn rates(&self, k: i32) -> [f64; 2] {
        let kernel = self.kernel(k);
        let lost = kernel.lost() - kernel.scattered * self.forward;
        [self.sampling * lost, kernel.scattering() * (1.0 - self.forward)]
    }

    /// A of the k-th moment between scatterings.
    pub fn straight_rate(&self, k: i32) -> f64 {
        self.sampling * self.kernel(k).lost()
    }

    /// Rate of scattering: that of the mean weight.
    pub fn scattering(&self) -> f64 {
        self.sampling * self.means[1]
    }
}

/// A walk through a rod, as theory describes it.
pub struct RodWalk<'a> {
    /// The rod.
    pub rod: &'a Rod,
    sampling: Option<&'a Piecewise>,
    rule: ParticleRule,
    /// True if panels also resolve flights and scattering, each by itself.
    has_orders: bool,
    mesh: Mesh,
}

/// A list of numbers that a line yields.
pub type LineNumbers<'f> = dyn Fn(&Line) -> Option<Vec<f64>> + 'f;

impl<'a> RodWalk<'a> {
    /// Cuts the rod where a, `p_f` or σ̂ has a knot and where the rule changes. Without σ̂ it is the walk of the light
    /// itself, which flies through σ_t.
    pub fn new(
        mesh: &Mesh,
        rod: &'a Rod,
        sampling: Option<&'a Piecewise>,
        rule: ParticleRule,
    ) -> Self {
        let mut cuts = [rod.albedo.knots(), rod.forward.knots()].concat();
        cuts.extend(sampling.into_iter().flat_map(Piecewise::knots));
        let from = mesh.support().from;
        cuts.extend((1..rod.parts).map(|part| from + rod.width() * part as f64));
        let is_order = |q: &RodQuantity| {
            matches!(q, RodQuantity::ReflectedBy(_) | RodQuantity::TransmittedBy(_))
        };
        let has_orders = rod.channels.iter().any(is_order);
        let mesh = mesh.refined(&cuts, &|_, _| Vec::new());
        let walk = Self { rod, sampling, rule, has_orders, mesh };
        let Some(sampling) = sampling else { return walk };
        let mut kinks = Vec::new();
        for kink in 0..rule.kinks(1.0).len() {
            let ratio = |t: f64| rule.kinks(rod.albedo.value(t))[kink];
            kinks.extend(walk.mesh.roots(&|t, sigma| sigma - ratio(t) * sampling.value(t)));
        }
        // Added to σ̂, so that nothing but rounding is no function that no panel resolves.
        let smooth = |_: &Mesh, panel: Panel<'_>| {
            let nodes = panel.t.iter().zip(panel.extinction).map(|(&t, &sigma)| walk.at(t, sigma));
            let nodes: Vec<RodPoint> = nodes.collect();
            let of = |k: i32, event: fn(Kernel) -> f64| {
                nodes.iter().map(|node| node.sampling * (1.0 + event(node.kernel(k)))).collect()
            };
            let (straight, scattered) = (|k: Kernel| k.straight, |k: Kernel| k.scattered);
            vec![of(0, straight), of(0, scattered), of(2, straight), of(2, scattered)]
        };
        Self { mesh: walk.mesh.refined(&kinks, &smooth), ..walk }
    }

    /// The walk with panels that also resolve flights and scattering, each by itself: orders of scattering, and weights
    /// of paths to an emitter. Weights have poles at an optical depth of ±iπ/2 from it.
    #[must_use]
    pub fn with_orders(self) -> Self {
        Self { has_orders: true, ..self }
    }

    fn at(&self, t: f64, extinction: f64) -> RodPoint {
        let (albedo, forward) = (self.rod.albedo.value(t), self.rod.forward.value(t));
        let sampling = self.sampling.map_or(extinction, |sampling| sampling.value(t));
        // Where both vanish there are no collisions, and any finite ratio is valid.
        let ratio = match self.sampling {
            None => 1.0,
            Some(_) if extinction == 0.0 => 0.0,
            Some(_) => extinction / sampling,
        };
        let probabilities = self.rule.probabilities(ratio, albedo);
        let absorbed = ratio * (1.0 - albedo);
        let part = self.rod.part(t);
        RodPoint {
            sampling,
            absorbed,
            part,
            forward,
            probabilities,
            means: [1.0 - ratio, albedo * ratio],
        }
    }

    /// The line for powers up to a highest, with panels `finer` times shorter than the coarse ones; `None` where there
    /// are too many. What leaves a panel is increased by a share for each panel and each collision.
    fn line(&self, highest: i32, finer: u32, share: f64) -> Option<Line> {
        let mut panels = Vec::new();
        let mut sum = 0.0;
        for panel in self.mesh.panels() {
            let mut fastest = 0.0;
            for (&t, &sigma) in panel.t.iter().zip(panel.extinction) {
                let node = self.at(t, sigma);
                for k in 0..=highest {
                    let [a, b] = node.rates(k).map(f64::abs);
                    let scattered = node.kernel(k).scattering().abs();
                    let apart = node.straight_rate(k).abs().max(scattered);
                    let rate = if self.has_orders { (2.0 * apart).max(a + b) } else { a + b };
                    fastest = if rate <= fastest { fastest } else { rate };
                }
            }
            let required = (panel.span.length() * fastest / THICKNESS).ceil().max(1.0);
            sum += required;
            if fastest.is_nan() || sum > MAX_PANELS {
                return None;
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most MAX_PANELS
            let count = required as u32 * finer;
            let at =
                |i: u32| panel.span.from + panel.span.length() * (f64::from(i) / f64::from(count));
            let width = panel.span.length() / f64::from(count);
            panels.extend((0..count).map(|i| (Span::new(at(i), at(i + 1)), width)));
        }
        Some(self.on(panels, share))
    }

    fn on(&self, panels: Vec<(Span, f64)>, share: f64) -> Line {
        let places = Line::places(&panels);
        let extinctions = self.rod.medium().extinctions(&places);
        let nodes = places.iter().zip(extinctions).map(|(&t, sigma)| self.at(t, sigma)).collect();
        Line::new(panels, nodes, share)
    }

    /// Checks that theory can cut the rod into panels.
    pub fn is_within_reach(&self) -> bool {
        self.line(2, 1, 0.0).is_some()
    }

    /// Checks that the k-th moment exists, with rounding errors and without.
    ///
    /// # Errors
    ///
    /// The reason why not.
    pub fn exists(&self, k: i32) -> Result<(), NoVariance> {
        let line = self.line(k, 1, ROUNDING).ok_or(NoVariance::TooLong)?;
        if line.flow(k).is_some() {
            return Ok(());
        }
        Err(self.critical(k).map_or(NoVariance::Unresolved(f64::INFINITY), NoVariance::Diverges))
    }

    /// Distance at which the k-th moment diverges, in spite of rounding errors: it exists only if the rod ends before
    /// it.
    fn critical(&self, k: i32) -> Option<f64> {
        let (span, passed) = self.line(k, 2, -ROUNDING)?.divergence(k)?;
        let echo = |t: f64| {
            let part = self.on(vec![(Span::new(span.from, t), t - span.from)], -ROUNDING);
            part.reflection(k).map_or(-1.0, |next| 1.0 - passed * next)
        };
        Some(roots::root(span.from, span.to, &echo))
    }

    /// Numbers of a line with powers up to a highest, each with an absolute error; `None` where it has no answer.
    ///
    /// The error is the difference to the numbers of panels twice as wide, on which what leaves a panel is increased by
    /// more than rounding errors. It grows as they do next to a divergence.
    pub fn known(&self, highest: i32, numbers: &LineNumbers<'_>) -> Option<Vec<Known>> {
        let result = numbers(&self.line(highest, 2, 0.0)?)?;
        let raised = numbers(&self.line(highest, 1, ROUNDING)?);
        let raised = raised.unwrap_or_else(|| vec![f64::INFINITY; result.len()]);
        let pairs = result.into_iter().zip(raised);
        let known = |(x, y): (f64, f64)| Known::of_resolutions(x, y).blurred(OF_PATH * x.abs());
        Some(pairs.map(known).collect())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use media::Medium;
    use media::constant::Constant;
    use media::exponential::Exponential;

    use super::*;
    use crate::rod::moments;

    /// Solves the equations by the implicit midpoint rule, from the beginning to the end: values in the middle of each
    /// step, and of the particle that enters.
    fn midpoint(
        nodes: &[RodPoint],
        width: f64,
        rates: &dyn Fn(&RodPoint) -> [f64; 2],
        source: &dyn Fn(usize, &RodPoint) -> [f64; 2],
        ends: [f64; 2],
    ) -> (Vec<[f64; 2]>, f64) {
        let march = |mut from: [f64; 2], share: f64| {
            let mut middles = Vec::new();
            for (i, node) in nodes.iter().enumerate() {
                let [a, b] = rates(node).map(|rate| 0.5 * width * rate);
                let [plus, minus] = source(i, node).map(|s| share * width * s);
                let x = (1.0 + a) * from[0] - b * from[1] - plus;
                let y = (1.0 - a) * from[1] + b * from[0] + minus;
                let to = [(1.0 + a) * x - b * y, (1.0 - a) * y + b * x];
                let to = to.map(|value| value / (1.0 - a * a + b * b));
                middles.push([0, 1].map(|side| 0.5 * (from[side] + to[side])));
                from = to;
            }
            (middles, from[0])
        };
        let ((entering, by_one), (forced, rest)) =
            (march([1.0, 0.0], 0.0), march([0.0, ends[0]], 1.0));
        let begin = (ends[1] - rest) / by_one;
        let sums = entering.iter().zip(&forced);
        (sums.map(|(x, y)| [0, 1].map(|side| begin * x[side] + y[side])).collect(), begin)
    }

    /// Romberg's limit of numbers of steps.
    fn romberg(numbers: &dyn Fn(usize) -> Vec<f64>) -> Vec<f64> {
        let mut rows: Vec<Vec<f64>> = (0..6).map(|level| numbers(60 << level)).collect();
        for column in 1..6 {
            let better = |pair: &[Vec<f64>]| {
                let pairs = pair[1].iter().zip(&pair[0]);
                pairs
                    .map(|(fine, coarse)| fine + (fine - coarse) / (4.0_f64.powi(column) - 1.0))
                    .collect()
            };
            rows = rows.windows(2).map(better).collect();
        }
        rows.remove(0)
    }

    /// Every step has its own place in a rod of which all parts vary, with knots at multiples of a half.
    #[test]
    fn collocation_agrees_with_the_implicit_midpoint_rule() {
        let span = Span::new(0.0, 3.0);
        let medium = Medium::new(Arc::new(Exponential::new(1.8, 0.6)), span, span);
        let albedo = Piecewise::lines(&[0.0, 3.0], &[0.95, 0.35]);
        let forward = Piecewise::steps(&[0.0, 1.5, 3.0], &[0.8, 0.4]);
        let channels =
            vec![RodQuantity::Absorbed, RodQuantity::Reflected, RodQuantity::Transmitted];
        let rod = Rod::new(medium.clone(), &albedo, &forward, channels);
        let sampling = Piecewise::lines(&[0.0, 0.5, 3.0], &[2.5, 2.0, 0.9]);
        let walk =
            RodWalk::new(&Mesh::new(medium), &rod, Some(&sampling), ParticleRule::NonTerminating);
        let known = walk.known(4, &|line| {
            let mut result = moments::lookups(line)?[..2].to_vec();
            result.push(moments::power(line, RodQuantity::Reflected, 1.0, 2)?);
            result.push(moments::power(line, RodQuantity::Transmitted, 1.0, 4)?);
            result.push(moments::power(line, RodQuantity::Absorbed, 1.0, 1)?);
            Some(result)
        });
        let expected = romberg(&|steps| {
            let width = 3.0 / steps as f64;
            let at: Vec<f64> = (0..steps).map(|i| width * (i as f64 + 0.5)).collect();
            let pairs = at.iter().zip(rod.medium().extinctions(&at));
            let nodes: Vec<RodPoint> = pairs.map(|(&t, sigma)| walk.at(t, sigma)).collect();
            let none = |_: usize, _: &RodPoint| [0.0; 2];
            let leaving = |k: i32, ends: [f64; 2]| {
                midpoint(&nodes, width, &|node| node.rates(k), &none, ends).1
            };
            let first = |_: usize, node: &RodPoint| [node.sampling; 2];
            let counts = |source: &dyn Fn(usize, &RodPoint) -> [f64; 2]| {
                midpoint(&nodes, width, &|node| node.rates(0), source, [0.0; 2])
            };
            let (middles, mean) = counts(&first);
            let second = |i: usize, node: &RodPoint| {
                node.after(0, middles[i]).map(|after| 2.0 * node.sampling * after)
            };
            let absorbed = |_: usize, node: &RodPoint| [node.sampling * node.absorbed; 2];
            let energy = midpoint(&nodes, width, &|node| node.rates(1), &absorbed, [0.0; 2]).1;
            let [reflected, transmitted] = [leaving(2, [1.0, 0.0]), leaving(4, [0.0, 1.0])];
            vec![mean, counts(&second).1, reflected, transmitted, energy]
        });
        for (Known { value: result, error, .. }, expected) in
            known.expect("known").into_iter().zip(expected)
        {
            let off = (result / expected - 1.0).abs();
            assert!(off < 2e-12 && error < 1e-12 * result, "{result} ± {error:e}: off by {off:e}");
        }
    }

    /// `cos ωx + (A/ω) sin ωx` is 0 at the critical length.
    #[test]
    fn the_critical_length_is_exact() {
        let (albedo, ratio) = (0.7, 1.0 / 0.3);
        let sum: f64 = albedo * ratio + (ratio - 1.0);
        let (q, s) = ((ratio - 1.0) * sum, albedo * ratio * sum);
        let (a, b) = (0.3 * (1.0 - q - 0.5 * s), 0.3 * 0.5 * s);
        let critical = if a < -b {
            let root = ((a - b) * (a + b)).sqrt();
            (-root / a).atanh() / root
        } else {
            let root = ((b - a) * (b + a)).sqrt();
            root.atan2(-a) / root
        };
        let has_variance = |length: f64| {
            let span = Span::new(0.0, length);
            let medium = Medium::new(Arc::new(Constant { extinction: 1.0 }), span, span);
            let [albedo, forward, sampling] =
                [albedo, 0.5, 0.3].map(|x| Piecewise::constant(x, span));
            let rod = Rod::new(medium.clone(), &albedo, &forward, vec![RodQuantity::Transmitted]);
            let rule = ParticleRule::NonTerminating;
            crate::rod::has_variance(&Mesh::new(medium), &rod, &sampling, rule)
        };
        for longer in [1e-12, 1e-6, 0.1, 3.0] {
            let result = has_variance(critical * (1.0 + longer));
            let Err(NoVariance::Diverges(at)) = result else { panic!("{longer}: {result:?}") };
            assert!((at / critical - 1.0).abs() < 1e-13, "{longer}: {at} for {critical}");
        }
        for shorter in [1e-12, 1e-6, 0.1] {
            assert_eq!(has_variance(critical * (1.0 - shorter)), Ok(()), "{shorter}");
        }
        assert_eq!(has_variance(critical), Err(NoVariance::Unresolved(f64::INFINITY)));
    }
}
