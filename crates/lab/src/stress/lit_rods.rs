//! Rods with an emitter at the end, and bidirectional paths: moments by nodes in 32 digits.
//!
//! Real collisions alone change a walk; the moments of a shadow ray's score s are exponentials of the way that is
//! left, or a quotient of them. A hit that follows a scattering directly is part of its score, with the probability
//! T and the weight h. With the equations of `nodes`, D the direction before and ρ its phase function towards the emitter:
//!
//! ```text
//! A = σ(1 − a p_f), B = σ a p_b,
//! s_D = aσ [ρ (E[s^k](1 − T) + T E[(s + h)^k]) + (1 − ρ) E[s^k] + Σ_{0<i<k} (k over i) E[s^{k−i}] (ρ m⁺ᵢ + (1 − ρ) m⁻ᵢ)]
//! bidirectional, s light vertices:   E[X^k] = ∫ f c^{k−1}:  segment s − 1 is lost at E[T̂^k], scatterings s − 1 and s
//!     count aρ to the power k, every other once
//! ```

use super::equations::{binomial, power};
use super::fields::homogeneous;
use super::nodes::{BothDirections, PanelLine, Solution, after};
use super::prelude::*;
use theory::light::{Combination, Densities, Heuristic, Shadow, Techniques};
use theory::problems::LitRod;
use theory::rod::bidirectional::{self, Connection, DrawRules, RodScene};
use theory::rod::lit;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range =
        "3 shadows, 2 heuristics, r = 0.1 … 1, τ = 1e-3 … 10, a and p_f next to 0 and 1, too";
    let row = TrialRow::moments("walks in a rod with an emitter", range);
    let mut rows = run.fill([16, 960], row, Lit::any, lit);
    let range = "order 0 … 4, each technique, r = 0.1 … 1, τ = 1e-3 … 5";
    let mut of_paths = vec![TrialRow::stated("light of bidirectional paths", range)];
    of_paths.extend(TrialRow::moments("bidirectional paths in a rod", range));
    rows.extend(run.fill([16, 640], of_paths, Bidirectional::any, bidirectional));
    rows
}

parameters! {
    /// A rod with an emitter at its end.
    Lit {
        depth: f64 = sized(-3.0, 1.0),
        albedo: f64 = share(),
        forward: f64 = share(),
        ratio: f64 = sized(-1.0, 0.0),
        shadow: Shadow = any_of(&[Shadow::Exact, Shadow::Delta, Shadow::Ratio]),
        combination: Combination = any_of(&[
            Combination::NextEvent,
            Combination::Mis(Densities::Directional, Heuristic::Balance),
            Combination::Mis(Densities::Directional, Heuristic::Power),
            Combination::Mis(Densities::Full, Heuristic::Balance),
            Combination::Mis(Densities::Full, Heuristic::Power),
        ]),
    }
    /// A rod between a light and a sensor.
    Bidirectional {
        depth: f64 = sized(-3.0, 0.7),
        albedo: f64 = between(0.05, 1.0),
        forward: f64 = between(0.05, 0.95),
        is_transmitted: bool = proptest::bool::ANY,
        order: usize = 1..=4_usize,
        light_vertices: usize = 0..=6_usize,
        ratio: Option<f64> = proptest::option::of(sized(-1.0, -0.01)),
    }
}

fn lit(case: &Lit, seen: &mut Seen) -> Option<()> {
    let &Lit { depth, albedo, forward, ratio, shadow, combination } = case;
    let is_full = matches!(combination, Combination::Mis(Densities::Full, _));
    // The weights of full densities and ratio tracking depend on null collisions: see the tests of the theory.
    let shadow = if is_full { Shadow::Exact } else { shadow };
    let medium = homogeneous(depth, 1.0);
    let everywhere = |value| Piecewise::constant(value, medium.span());
    let rod = LitRod::new(medium.clone(), &everywhere(albedo), &everywhere(forward));
    let (mesh, flown) = (Mesh::new(medium.clone()), everywhere(depth / ratio));
    let techniques = Techniques { shadow: Some(shadow), combination };
    let computed = lit::predict(&mesh, &rod, &flown, techniques, true).channels[0].moments;
    let raw = moments(case, shadow);
    if raw[0].high < 1e-70 {
        return None;
    }
    seen.resolved([0, 1], computed, &raw);
    Some(())
}

/// `E[X], …, E[X⁴]`.
fn moments(case: &Lit, shadow: Shadow) -> [DoubleDouble; 4] {
    let [depth, albedo, forward] = [case.depth, case.albedo, case.forward].map(DoubleDouble::from);
    let null = 1.0 - DoubleDouble::from(case.ratio);
    // Losses of a shadow ray to the power k, per length.
    let losses = [0, 1, 2, 3, 4].map(|k: usize| match shadow {
        Shadow::Exact => depth * k as f64,
        Shadow::Delta => depth * f64::from(u8::from(k > 0)),
        Shadow::Ratio => depth / case.ratio * (1.0 - power(null, k)),
    });
    let line = PanelLine::new(&[0.0, 1.0].map(DoubleDouble::from), |_| {
        2.0 * losses[4].high.max(depth.high)
    });
    let (scattered, ways) = (albedo * depth, [forward, 1.0 - forward]);
    let rates = [depth - scattered * forward, scattered * (1.0 - forward)];
    let scores = line.values(|_, x| {
        // e^{−loss} of the way that is left.
        let left = losses.map(|loss| (-(loss * (1.0 - x))).exp());
        ways.map(|phase| ScatteringScores::new(case.combination, phase, left))
    });
    let mut computed: Vec<Solution<BothDirections>> = Vec::new();
    for k in 1..=4 {
        let scored = |i: usize, way: usize| {
            let (phase, scores) = (ways[way], &scores[i][way]);
            let hit = |j: usize| binomial(k, j) * scores.with_hit(k, j);
            let later = |j: usize| {
                let [later, _] = after([phase, 1.0 - phase], computed[j - 1].at[i]);
                binomial(k, j) * scores.of_ray[k - j] * later
            };
            let hits: DoubleDouble = (1..=k).map(hit).sum();
            let later: DoubleDouble = (1..k).map(later).sum();
            scattered * (scores.of_ray[k] + phase * scores.alive * hits + later)
        };
        computed.push(line.both_ways(|_| rates, |i| [0, 1].map(|way| scored(i, way)), NOTHING));
    }
    let unscattered = (-depth).exp();
    std::array::from_fn(|k| unscattered + computed[k].begin[0])
}

/// Values of 0, in both directions.
const NOTHING: BothDirections = [DoubleDouble { high: 0.0, low: 0.0 }; 2];

/// Scores of a scattering.
struct ScatteringScores {
    /// Probability that a flight reaches the emitter.
    alive: DoubleDouble,
    /// `E[s^k]`, k = 0 … 4.
    of_ray: [DoubleDouble; 5],
    /// h, of a hit.
    hit: DoubleDouble,
}

impl ScatteringScores {
    /// Given the phase function towards the emitter, and `E[T̂^k]`.
    fn new(
        combination: Combination,
        phase: DoubleDouble,
        transmittance: [DoubleDouble; 5],
    ) -> Self {
        let alive = transmittance[1];
        let of_ray = |weight: DoubleDouble| {
            std::array::from_fn(|k| transmittance[k] * power(phase * weight, k))
        };
        let Combination::Mis(densities, heuristic) = combination else {
            return Self { alive, of_ray: of_ray(DoubleDouble::ONE), hit: DoubleDouble::default() };
        };
        let ratio = if densities == Densities::Full { phase * alive } else { phase };
        let raised = match heuristic {
            Heuristic::Balance => ratio,
            Heuristic::Power => ratio * ratio,
        };
        let weight = 1.0 / (1.0 + raised);
        Self { alive, of_ray: of_ray(weight), hit: raised * weight }
    }

    /// `E[s^{k−i}] h^i`.
    fn with_hit(&self, k: usize, i: usize) -> DoubleDouble {
        self.of_ray[k - i] * power(self.hit, i)
    }
}

fn bidirectional(case: &Bidirectional, seen: &mut Seen) -> Option<()> {
    let &Bidirectional { depth, albedo, forward, is_transmitted, order, ratio, .. } = case;
    let order = if is_transmitted { order - 1 } else { order };
    let s = case.light_vertices % (order + 3);
    let depth = Known::exact(depth);
    let scene = RodScene { depth, albedo, forward, is_transmitted, orders: order..=order };
    let rules = DrawRules {
        combination: bidirectional::Combination::Technique(s),
        connection: ratio.map_or(Connection::Exact, Connection::Ratio),
        is_shared: false,
        has_shares: true,
    };
    let computed = bidirectional::predict(&scene, &rules, ratio, true);
    let raw = [1, 2, 3, 4].map(|k| of_paths(case, (order, s), k));
    let channel = computed.channels.first()?;
    seen.at(format_args!("order {order}, s = {s}"));
    seen.stated(0, channel.truth, raw[0]);
    let moments = channel.moments?;
    // Of draws that hardly vary there are no digits.
    let [second, _] = central(raw, DoubleDouble::from(moments.scale));
    seen.resolved([1, 2], (second.high.abs() >= 1e-20).then_some(moments), &raw);
    Some(())
}

/// `E[X^k]` of one technique.
fn of_paths(case: &Bidirectional, (order, s): (usize, usize), k: usize) -> DoubleDouble {
    let [depth, albedo, forward] = [case.depth, case.albedo, case.forward].map(DoubleDouble::from);
    let is_one = s == 0 || s == order + 2;
    // Per length, of the segment j.
    let loss = |j: usize| match case.ratio {
        _ if is_one || j + 1 != s || k == 1 => depth,
        None => depth * k as f64,
        Some(ratio) => {
            let null = 1.0 - DoubleDouble::from(ratio);
            depth + depth * null / ratio * (1.0 - power(null, k - 1))
        }
    };
    let line = PanelLine::new(&[0.0, 1.0].map(DoubleDouble::from), |_| {
        (0..=order).map(|j| loss(j).high).fold(0.0, f64::max)
    });
    let mut ends = NOTHING;
    ends[usize::from(case.is_transmitted)] = DoubleDouble::ONE;
    let rates = |j: usize| [loss(j), DoubleDouble::default()];
    let mut worth = line.both_ways(|_| rates(order), |_| NOTHING, ends);
    for j in (0..order).rev() {
        // The scattering between the segments j and j + 1.
        let counts = if !is_one && (j + 2 == s || j + 1 == s) { k } else { 1 };
        let [onward, turned] = [forward, 1.0 - forward].map(|p| depth * power(albedo * p, counts));
        let source = |i: usize| after([onward, turned], worth.at[i]);
        worth = line.both_ways(|_| rates(j), source, NOTHING);
    }
    worth.begin[0]
}
