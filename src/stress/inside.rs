//! Inside rods: orders of scattering, the flux, and the energy absorbed, from power series in 32 digits.
//!
//! Where rates are constant, what a particle is worth obeys linear equations of constant coefficients. Each
//! step, half a collision long at most, has its power series; what leaves it is joined from the end of the rod
//! backwards.
//!
//! ```text
//! m± = Σ mₙ± tⁿ, step h:   (n + 1) m⁺ₙ₊₁ = h(A m⁺ₙ − B m⁻ₙ − s⁺ₙ),   (n + 1) m⁻ₙ₊₁ = h(B m⁺ₙ − A m⁻ₙ + s⁻ₙ)
//! order n to the power k:   A = σ̂(1 − Q_k), B = 0,  s from order n − 1
//! Y^k, Y = Σ c w:           A = σ̂(1 − Q_k − S_k p_f), B = σ̂ S_k p_b,  s from Y, …, Y^{k−1}
//! ```

use std::cell::OnceCell;

use super::rods::{moments_of, rod_with, rule};
use super::series::{binomial, power};
use super::trial::{Dice, Trial, central, share};
use super::{Effort, Row, in_parts};
use media::Piecewise;
use numeric::Wide;
use theory::particle::ParticleRule;
use theory::problems::rod::{self, HIGHEST_ORDER, MOST_PARTS, Quantity};
use theory::rod as rods;

/// Terms of a series: at half a collision, 2⁻²²/22! = 2e-28.
const TERMS: usize = 22;
/// The highest power.
const POWERS: u32 = 4;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(16, "inside", seed, |part| {
        let range = "to order 6, 1 … 4 parts, two albedos, τ = 1e-6 … 30";
        part.run(effort.of(1, 16), SEEN.map(|seen| Row::stated(seen, range)), truths);
        let range = "to order 3, 1 … 4 parts, 3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
        let rows = std::array::from_fn::<_, 6, _>(|i| {
            let what = ["variance", "fourth moment"][i / 3];
            Row::stated(format!("{what}, {}", SEEN[i % 3]), range)
        });
        part.run(effort.of(u32::from(part.number % 2 == 0), 6), rows, moments);
    })
}

const SEEN: [&str; 3] =
    ["orders of scattering in a rod", "flux inside a rod", "absorption in a rod"];

/// Which of them a channel is.
fn row_of(seen: Quantity) -> Option<usize> {
    match seen {
        Quantity::ReflectedBy(_) | Quantity::TransmittedBy(_) => Some(0),
        Quantity::Flux(_) => Some(1),
        Quantity::Absorbed => Some(2),
        Quantity::Reflected | Quantity::Transmitted => None,
    }
}

/// A rod of one or two halves, its channels, and how it is walked.
struct Case {
    depth: f64,
    forward: f64,
    albedo: Vec<f64>,
    channels: Vec<Quantity>,
}

impl Case {
    fn new(dice: &mut Dice, depth: f64, highest_order: usize) -> Self {
        let forward = share(dice);
        let albedo = (0..=dice.below(2)).map(|_| share(dice)).collect();
        let channels = rod::channels(1 + dice.below(MOST_PARTS), true, Some(highest_order));
        Self { depth, forward, albedo, channels }
    }

    fn place(&self, seen: Quantity) -> String {
        let Self { depth, forward, albedo, .. } = self;
        format!("{}, τ = {depth:e}, a = {albedo:?}, p_f = {forward:e}", seen.name())
    }
}

fn truths(t: &mut Trial) {
    let depth = t.dice.sized(-6.0, 1.48);
    #[allow(clippy::cast_possible_truncation)] // six
    let case = Case::new(t.dice, depth, HIGHEST_ORDER as usize);
    let found = rod_with(depth, &case.albedo, case.forward, case.channels.clone())
        .and_then(|(mesh, rod)| rods::truth(&mesh, &rod));
    let line = Line::new(&case, ParticleRule::Terminating, depth);
    for (i, &seen) in case.channels.iter().enumerate() {
        let Some(row) = row_of(seen) else { continue };
        t.place = case.place(seen);
        let [exact, ..] = line.powers(seen, 1);
        match found.as_ref().filter(|_| exact.high >= 1e-290) {
            Some(found) => t.stated(row, found[i], exact),
            None => t.skip(row),
        }
    }
}

fn moments(t: &mut Trial) {
    let (depth, ratio) = (t.dice.sized(-3.0, 1.0), t.dice.sized(-1.0, 0.5));
    let order = 1 + t.dice.below(3);
    let case = Case::new(t.dice, depth, order);
    let (sampling, rule) = (depth / ratio, rule(t.dice, ratio, 3));
    let found = rod_with(depth, &case.albedo, case.forward, case.channels.clone());
    let found = found.map(|(mesh, rod)| {
        let flown = Piecewise::constant(sampling, mesh.support());
        rods::predict(&mesh, &rod, &flown, rule, true)
    });
    let line = Line::new(&case, rule, sampling);
    for (i, &seen) in case.channels.iter().enumerate() {
        let Some(row) = row_of(seen) else { continue };
        t.place = format!("{rule:?}, r = {ratio:e}, {}", case.place(seen));
        let moments = found.as_ref().and_then(|found| found.channels[i].moments);
        // A moment that diverges says so, as `rods` checks.
        let known = moments.filter(|moments| moments.relative[0].is_finite());
        let known = known.map(|known| (known, line.powers(seen, POWERS)));
        let Some((known, raw)) = known.filter(|(_, raw)| raw[0].high >= 1e-70) else {
            t.skip(row);
            t.skip(row + 3);
            continue;
        };
        // In units of the mean as it is told, which may have few digits.
        let [second, fourth] = central(raw, Wide::from(known.scale));
        t.central(row, known.relative[0], known.error, second);
        t.central(row + 3, known.relative[2], known.error, fourth);
    }
}

type Series = [Wide; TERMS];

/// What a particle is worth that goes forward, and one that goes backward.
type Both = [Series; 2];

const NOTHING: Both = [[Wide { high: 0.0, low: 0.0 }; TERMS]; 2];

/// Equal steps of constant rates.
struct Stretch {
    steps: usize,
    step: Wide,
    sampling: Wide,
    /// `r (1 − a)`.
    absorbed: Wide,
    part: usize,
    /// Q and S to the powers 0 … 4.
    odds: [[Wide; 2]; 5],
}

/// A rod from 0 to 1.
struct Line {
    stretches: Vec<Stretch>,
    forward: Wide,
    parts: f64,
    /// The highest order.
    highest: usize,
    /// What leaves at the end and at the beginning by order, to the powers 1 … 4, once it is known.
    orders: [[OnceCell<Vec<Wide>>; 2]; 4],
}

impl Line {
    fn new(case: &Case, rule: ParticleRule, sampling: f64) -> Self {
        let parts = case.channels.iter().filter(|seen| matches!(seen, Quantity::Flux(_))).count();
        // Twelfths hold halves, thirds and quarters.
        let forward = Wide::from(case.forward);
        let ratio = Wide::from(case.depth) / sampling;
        let sampling = Wide::from(sampling);
        let of = |twelfth: usize| {
            let albedo = case.albedo[twelfth * case.albedo.len() / 12];
            let odds = [0, 1, 2, 3, 4].map(|k| moments_of(rule, ratio, albedo, k));
            let fastest = odds.iter().fold(0.0, |most: f64, &[q, s]| {
                let straight = (1.0 - q).high.abs().max((1.0 - q - s * forward).high.abs());
                most.max(straight + s.high.abs())
            });
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // some hundreds
            let steps = (sampling.high * fastest / 6.0).ceil().max(1.0) as usize;
            let step = Wide::ONE / (12.0 * steps as f64);
            let absorbed = ratio * (1.0 - Wide::from(albedo));
            Stretch { steps, step, sampling, absorbed, part: twelfth * parts / 12, odds }
        };
        let stretches = (0..12).map(of).collect();
        let order = |seen: &Quantity| match seen {
            Quantity::ReflectedBy(order) | Quantity::TransmittedBy(order) => *order,
            _ => 0,
        };
        let highest = case.channels.iter().map(order).max().unwrap_or(0);
        Self { stretches, forward, parts: parts as f64, highest, orders: Default::default() }
    }

    /// `E[X], …, E[X^k]` of a channel, the others 0.
    fn powers(&self, seen: Quantity, k: u32) -> [Wide; 4] {
        let mut powers = [Wide::default(); 4];
        match seen {
            Quantity::ReflectedBy(order) | Quantity::TransmittedBy(order) => {
                let is_back = usize::from(matches!(seen, Quantity::ReflectedBy(_)));
                for (power, k) in powers.iter_mut().zip(1..=k as usize) {
                    let orders = &self.orders[k - 1][is_back];
                    *power = orders.get_or_init(|| self.by_order(k, is_back))[order];
                }
            }
            Quantity::Flux(part) => {
                // σ̂c = 1/width.
                let width = Wide::ONE / self.parts;
                let score = |stretch: &Stretch| {
                    let inside = stretch.part == part;
                    if inside { 1.0 / (stretch.sampling * width) } else { Wide::default() }
                };
                self.scores(&score, k, &mut powers);
            }
            _ => self.scores(&|stretch| stretch.absorbed, k, &mut powers),
        }
        powers
    }

    /// Of all orders to the power k.
    fn by_order(&self, k: usize, is_back: usize) -> Vec<Wide> {
        let mut ends = [Wide::default(); 2];
        ends[1 - is_back] = Wide::ONE;
        let rates = |stretch: &Stretch| [1.0 - stretch.odds[k][0], Wide::default()];
        let mut worth = self.solve(&rates, &|_, _| NOTHING, ends);
        let mut orders = vec![worth[0][0][0]];
        for _ in 0..self.highest {
            let before = worth;
            let source = |stretch: &Stretch, i: usize| {
                self.after([Wide::default(), stretch.odds[k][1]], &before[i])
            };
            worth = self.solve(&rates, &source, [Wide::default(); 2]);
            orders.push(worth[0][0][0]);
        }
        orders
    }

    /// `E[Y^j]` of a score c.
    fn scores(&self, score: &dyn Fn(&Stretch) -> Wide, k: u32, powers: &mut [Wide; 4]) {
        let mut found: Vec<Vec<Both>> = Vec::new();
        for j in 1..=k as usize {
            let rates = |stretch: &Stretch| self.rates(stretch.odds[j]);
            let source = |stretch: &Stretch, at: usize| {
                let c = score(stretch);
                let mut sum = NOTHING;
                if c.high == 0.0 {
                    return sum;
                }
                let whole = power(c, j);
                (sum[0][0], sum[1][0]) = (whole, whole);
                for i in 1..j {
                    let factor = binomial(j, i) * power(c, j - i);
                    let after = self.after(stretch.odds[i], &found[i - 1][at]);
                    for (sum, after) in sum.iter_mut().flatten().zip(after.iter().flatten()) {
                        *sum += factor * *after;
                    }
                }
                sum
            };
            let worth = self.solve(&rates, &source, [Wide::default(); 2]);
            powers[j - 1] = worth[0][0][0];
            found.push(worth);
        }
    }

    /// A and B over σ̂.
    fn rates(&self, [q, s]: [Wide; 2]) -> [Wide; 2] {
        [1.0 - q - s * self.forward, s * (1.0 - self.forward)]
    }

    /// What a particle that collides is worth afterwards.
    fn after(&self, [q, s]: [Wide; 2], [plus, minus]: &Both) -> Both {
        let [onward, turned] = [q + s * self.forward, s * (1.0 - self.forward)];
        let mixed = |a: &Series, b: &Series| -> Series {
            std::array::from_fn(|n| onward * a[n] + turned * b[n])
        };
        [mixed(plus, minus), mixed(minus, plus)]
    }

    /// The series of all steps, where leaving is worth `ends`; rates and sources are per σ̂.
    fn solve(
        &self,
        rates: &dyn Fn(&Stretch) -> [Wide; 2],
        source: &dyn Fn(&Stretch, usize) -> Both,
        ends: [Wide; 2],
    ) -> Vec<Both> {
        let steps: Vec<&Stretch> =
            self.stretches.iter().flat_map(|stretch| vec![stretch; stretch.steps]).collect();
        // What follows from m₊ = 1, from m₋ = 1, and from the source alone.
        let mut basis: Vec<[Both; 3]> = Vec::with_capacity(steps.len());
        for (i, &stretch) in steps.iter().enumerate() {
            let rates = rates(stretch).map(|rate| rate * stretch.sampling * stretch.step);
            let own = {
                let factor = stretch.sampling * stretch.step;
                let source = source(stretch, i).map(|series| series.map(|x| factor * x));
                continued(rates, [Wide::default(); 2], &source)
            };
            let same = i > 0 && std::ptr::eq(steps[i - 1], stretch);
            let [plus, minus] = if same {
                [basis[i - 1][0], basis[i - 1][1]]
            } else {
                let (zero, one) = (Wide::default(), Wide::ONE);
                [[one, zero], [zero, one]].map(|begin| continued(rates, begin, &NOTHING))
            };
            basis.push([plus, minus, own]);
        }
        // m₊ = ρ m₋ + η at the beginning of each step.
        let mut beyond = vec![[Wide::default(), ends[1]]];
        for basis in basis.iter().rev() {
            let [rho, eta] = beyond[beyond.len() - 1];
            let [of_plus, of_minus, own] = basis.each_ref().map(|both| both.each_ref().map(at_end));
            let left = |[plus, minus]: [Wide; 2]| plus - rho * minus;
            let scale = left(of_plus);
            beyond.push([-left(of_minus) / scale, (eta - left(own)) / scale]);
        }
        let mut minus = ends[0];
        let joined = basis.iter().zip(beyond.iter().rev()).map(|(basis, &[rho, eta])| {
            let factors = [rho * minus + eta, minus, Wide::ONE];
            let both: Both = std::array::from_fn(|way| {
                std::array::from_fn(|n| (0..3).map(|i| factors[i] * basis[i][way][n]).sum())
            });
            minus = at_end(&both[1]);
            both
        });
        joined.collect()
    }
}

fn at_end(series: &Series) -> Wide {
    series.iter().rev().copied().sum()
}

/// The series of a step with rates and a source for its whole width.
fn continued([a, b]: [Wide; 2], begin: [Wide; 2], source: &Both) -> Both {
    let mut found = NOTHING;
    (found[0][0], found[1][0]) = (begin[0], begin[1]);
    for n in 0..TERMS - 1 {
        let (plus, minus) = (found[0][n], found[1][n]);
        let share = Wide::ONE / (n + 1) as f64;
        found[0][n + 1] = (a * plus - b * minus - source[0][n]) * share;
        found[1][n + 1] = (b * plus - a * minus + source[1][n]) * share;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::rods::leaving;

    #[test]
    fn orders_add_up_to_all_that_leaves() {
        let (depth, albedo, forward) = (2.5, 0.004, 0.3);
        let channels = rod::channels(1, true, Some(6));
        let case = Case { depth, forward, albedo: vec![albedo], channels };
        let line = Line::new(&case, ParticleRule::Terminating, depth);
        let [a, p] = [albedo, forward].map(Wide::from);
        let rates = [1.0 - a * p, a * (1.0 - p)].map(|rate| rate * depth);
        let [r, t] = leaving(rates);
        let sum = |seen: fn(usize) -> Quantity| -> Wide {
            (0..=6).map(|order| line.powers(seen(order), 1)[0]).sum()
        };
        assert!(t.relative_error(sum(Quantity::TransmittedBy).value()) < 1e-15);
        assert!(r.relative_error(sum(Quantity::ReflectedBy).value()) < 1e-15);
        // What does not leave is absorbed, and what is absorbed is the flux times the rate.
        let lost = 1.0 - r - t;
        let absorbed = line.powers(Quantity::Absorbed, 1)[0];
        let flux = line.powers(Quantity::Flux(0), 1)[0] * depth * (1.0 - a);
        assert!((lost - absorbed).abs().value() < 1e-28 && (lost - flux).abs().value() < 1e-28);
    }
}
