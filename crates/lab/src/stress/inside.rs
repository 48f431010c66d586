//! Inside rods: orders of scattering, the flux, and the energy absorbed, by nodes in 32 digits.
//!
//! Importances obey the equations of `nodes`:
//!
//! ```text
//! order n to the power k:   A = σ̂(1 − Q_k), B = 0,  s from order n − 1
//! Y^k, Y = Σ c w:           A = σ̂(1 − Q_k − S_k p_f), B = σ̂ S_k p_b,  s from Y, …, Y^{k−1}
//! ```

use super::equations::{binomial, power};
use super::nodes::{BothDirections, PanelLine, Solution, after};
use super::prelude::*;
use super::rods::{moments_of, rod_with, rule};
use theory::problems::rod::{self, HIGHEST_ORDER, MAX_PARTS, RodQuantity};
use theory::{ParticleRule, rod as rods};

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "to order 6, 1 … 4 parts, two albedos, τ = 1e-6 … 30";
    #[allow(clippy::cast_possible_truncation)] // six
    let highest = HIGHEST_ORDER as usize;
    let case = || Case::any(sized(-6.0, 1.48), highest..=highest);
    let mut rows =
        run.fill([16, 256], SEEN.map(|seen| TrialRow::stated(seen, range)), case, truths);
    let range = "to order 3, 1 … 4 parts, 3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
    let of_walks = std::array::from_fn::<_, 6, _>(|i| {
        let what = ["variance", "fourth moment"][i / 3];
        TrialRow::stated(format!("{what}, {}", SEEN[i % 3]), range)
    });
    let walks = || (Case::any(sized(-3.0, 1.0), 1..=3), sized(-1.0, 0.5), 0..3_usize);
    rows.extend(run.fill([8, 96], of_walks, walks, moments));
    rows
}

const SEEN: [&str; 3] =
    ["orders of scattering in a rod", "flux inside a rod", "absorption in a rod"];

/// The row of a channel.
fn row_of(seen: RodQuantity) -> Option<usize> {
    match seen {
        RodQuantity::ReflectedBy(_) | RodQuantity::TransmittedBy(_) => Some(0),
        RodQuantity::Flux(_) => Some(1),
        RodQuantity::Absorbed => Some(2),
        RodQuantity::Reflected | RodQuantity::Transmitted => None,
    }
}

parameters! {
    /// A rod of one or two halves, and what is seen of it.
    Case(range: NumberStrategy, orders: std::ops::RangeInclusive<usize>) {
        depth: f64 = range,
        forward: f64 = share(),
        albedo: Vec<f64> = vec(share(), 1..=2),
        parts: usize = 1..=MAX_PARTS,
        highest_order: usize = orders,
    }
}

impl Case {
    fn channels(&self) -> Vec<RodQuantity> {
        rod::channels(self.parts, true, Some(self.highest_order))
    }

    fn albedo(&self, stretch: usize) -> f64 {
        self.albedo[stretch * self.albedo.len() / STRETCHES]
    }
}

fn truths(case: &Case, seen: &mut Seen) {
    let (mesh, rod) = rod_with(case.depth, &case.albedo, case.forward, case.channels());
    let computed = rods::truth(&mesh, &rod);
    let exact = ExactScores::new(case, ParticleRule::Terminating, case.depth, 1);
    for (i, channel) in case.channels().into_iter().enumerate() {
        let Some(row) = row_of(channel) else { continue };
        seen.at(channel.name());
        let [exact, ..] = exact.powers(channel);
        match computed.as_ref().filter(|_| exact.high >= 1e-290) {
            Some(computed) => seen.stated(row, computed[i], exact),
            None => seen.skip(row),
        }
    }
}

fn moments((case, ratio, kind): &(Case, f64, usize), seen: &mut Seen) {
    let (sampling, rule) = (case.depth / ratio, rule(*ratio, *kind));
    let (mesh, rod) = rod_with(case.depth, &case.albedo, case.forward, case.channels());
    let flown = Piecewise::constant(sampling, mesh.support());
    let computed = rods::predict(&mesh, &rod, &flown, rule, true);
    let exact = ExactScores::new(case, rule, sampling, 4);
    for (i, channel) in case.channels().into_iter().enumerate() {
        let Some(row) = row_of(channel) else { continue };
        seen.at(channel.name());
        // A moment that diverges says so, as `rods` checks.
        let raw = exact.powers(channel);
        let known = computed.channels[i].moments.filter(|_| raw[0].high >= 1e-70);
        seen.resolved([row, row + 3], known, &raw);
    }
}

/// Twelfths hold halves, thirds and quarters.
const STRETCHES: usize = 12;
/// Values of 0, in both directions.
const NOTHING: BothDirections = [DoubleDouble { high: 0.0, low: 0.0 }; 2];

/// Light that leaves by order at the end and at the beginning, and scores, to the powers 1 … 4.
struct ExactScores<'a> {
    case: &'a Case,
    sampling: DoubleDouble,
    /// `σ_t/σ̂`.
    ratio: DoubleDouble,
    line: PanelLine,
    /// Number of the stretch of every node.
    stretches: Vec<usize>,
    /// Q and S of the stretches to the powers 0 … 4.
    odds: Vec<[[DoubleDouble; 2]; 5]>,
    /// Highest power.
    powers: usize,
    orders: [Vec<Vec<DoubleDouble>>; 2],
}

impl<'a> ExactScores<'a> {
    fn new(case: &'a Case, rule: ParticleRule, sampling: f64, powers: usize) -> Self {
        let ratio = DoubleDouble::from(case.depth) / sampling;
        let of = |albedo: f64| [0, 1, 2, 3, 4].map(|k| moments_of(rule, ratio, albedo, k));
        let odds: Vec<_> = (0..STRETCHES).map(|stretch| of(case.albedo(stretch))).collect();
        let fastest = |stretch: usize| {
            odds[stretch].iter().fold(0.0, |maximum: f64, &[q, s]| {
                let straight = 1.0 - q - s * case.forward;
                let straight = (1.0 - q).high.abs().max(straight.high.abs());
                maximum.max(sampling * (straight + s.high.abs()))
            })
        };
        let ends: Vec<DoubleDouble> =
            (0..=STRETCHES).map(|i| DoubleDouble::from(i as f64) / STRETCHES as f64).collect();
        let line = PanelLine::new(&ends, fastest);
        let stretches = line.values(|stretch, _| stretch);
        let (sampling, orders) = (DoubleDouble::from(sampling), Default::default());
        let mut computed = Self { case, sampling, ratio, line, stretches, odds, powers, orders };
        computed.orders =
            [0, 1].map(|end| (1..=powers).map(|k| computed.by_order(k, end)).collect());
        computed
    }

    /// `E[X], …, E[X^k]` of a channel, the others 0.
    fn powers(&self, seen: RodQuantity) -> [DoubleDouble; 4] {
        match seen {
            RodQuantity::ReflectedBy(order) => self.of_order(order, 1),
            RodQuantity::TransmittedBy(order) => self.of_order(order, 0),
            RodQuantity::Flux(part) => {
                // σ̂c = 1/width.
                let score = self.case.parts as f64 / self.sampling;
                self.scores(&|stretch| {
                    let is_inside = stretch * self.case.parts / STRETCHES == part;
                    if is_inside { score } else { DoubleDouble::default() }
                })
            }
            _ => self.scores(&|stretch| {
                self.ratio * (1.0 - DoubleDouble::from(self.case.albedo(stretch)))
            }),
        }
    }

    fn of_order(&self, order: usize, end: usize) -> [DoubleDouble; 4] {
        std::array::from_fn(|k| {
            self.orders[end].get(k).map_or(DoubleDouble::default(), |all| all[order])
        })
    }

    /// Onward and turned, per σ̂, after a collision to a power.
    fn odds(&self, stretch: usize, k: usize) -> [DoubleDouble; 2] {
        let ([q, s], forward) = (self.odds[stretch][k], DoubleDouble::from(self.case.forward));
        [q + s * forward, s * (1.0 - forward)]
    }

    /// Light that leaves at the end or at the beginning, of all orders to the power k.
    fn by_order(&self, k: usize, end: usize) -> Vec<DoubleDouble> {
        let rates = |stretch: usize| {
            [self.sampling * (1.0 - self.odds[stretch][k][0]), DoubleDouble::default()]
        };
        let mut ends = NOTHING;
        ends[1 - end] = DoubleDouble::ONE;
        let mut order = self.line.both_ways(rates, |_| NOTHING, ends);
        let mut orders = vec![order.begin[0]];
        let forward = DoubleDouble::from(self.case.forward);
        for _ in 0..self.case.highest_order {
            let source = |i: usize| {
                let scattered = self.sampling * self.odds[self.stretches[i]][k][1];
                after([scattered * forward, scattered * (1.0 - forward)], order.at[i])
            };
            order = self.line.both_ways(rates, source, NOTHING);
            orders.push(order.begin[0]);
        }
        orders
    }

    /// `E[Y^j]` of a score c.
    fn scores(&self, score: &dyn Fn(usize) -> DoubleDouble) -> [DoubleDouble; 4] {
        let mut known: Vec<Solution<BothDirections>> = Vec::new();
        for j in 1..=self.powers {
            let rates = |stretch: usize| {
                let [onward, turned] = self.odds(stretch, j);
                [self.sampling * (1.0 - onward), self.sampling * turned]
            };
            let source = |i: usize| {
                let (stretch, c) = (self.stretches[i], score(self.stretches[i]));
                let mut sum = [power(c, j); 2];
                for lower in 1..j {
                    let later = after(self.odds(stretch, lower), known[lower - 1].at[i]);
                    let factor = binomial(j, lower) * power(c, j - lower);
                    sum = [0, 1].map(|way| sum[way] + factor * later[way]);
                }
                sum.map(|sum| self.sampling * sum)
            };
            known.push(self.line.both_ways(rates, source, NOTHING));
        }
        std::array::from_fn(|k| {
            known.get(k).map_or(DoubleDouble::default(), |power| power.begin[0])
        })
    }
}
