//! Rods: truths and moments of walks against closed forms in 32 digits.
//!
//! ```text
//! constant rates, κ² = A² − B², E = e^{−2κℓ}, s = (1 − E)/κ:
//!     R = Bs/(1 + E + As),  T = 2e^{−κℓ}/(1 + E + As)
//! κ² = −ω²:  T = 1/(cos ωℓ + A sin(ωℓ)/ω),  R = B T sin(ωℓ)/ω
//! two halves:  R = R₁ + T₁² R₂/(1 − R₁R₂),  T = T₁T₂/(1 − R₁R₂)
//! ```

use super::collided::central;
use super::{Dice, Effort, Measure, Row, in_parts, text};
use crate::media::Piecewise;
use crate::numeric::{Known, Wide};
use crate::problems::Rod;
use crate::problems::rod::{self, Seen};
use crate::theory::particle::ParticleRule;
use crate::theory::{Mesh, rod as rods};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(4, 150);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "rods", part);
        let mut rows = vec![closed(dice, 20 * trials), solved(dice, trials)];
        rows.extend(moments(dice, trials / 2));
        rows
    })
}

/// How far a value is off, in units of its stated error.
pub(super) fn of_stated(found: Known, exact: Wide) -> f64 {
    let off = (Wide::from(found.value) - exact).abs().value();
    let rounding = 0.5 * f64::EPSILON * exact.high.abs();
    if off <= rounding { 0.0 } else { off / found.error }
}

/// How far a moment is off, in units of its stated error, which is relative.
pub(super) fn of_relative(found: f64, error: f64, exact: Wide) -> f64 {
    of_stated(Known::new(found, found.abs() * error), exact)
}

/// R and T of two-stream equations with rates A and B, in units of one over the length.
pub(super) fn leaving([a, b]: [Wide; 2]) -> [Wide; 2] {
    let square = (a - b) * (a + b);
    let root = square.abs().sqrt();
    if square.high < 0.0 {
        let [sine, cosine] = root.sin_cos();
        let through = Wide::ONE / (cosine + a * sine / root);
        return [b * through * sine / root, through];
    }
    let faint = (-root.scaled(1)).exp();
    let s = if root.high > 0.0 { -(-root.scaled(1)).exp_m1() / root } else { Wide::from(2.0) };
    // 1 + E + As, without the cancellation where weights grow and A is negative.
    let below = if a.high < 0.0 && root.high > 0.0 {
        faint * (Wide::ONE - a / root) - b * b / (root * (root - a))
    } else {
        Wide::ONE + faint + a * s
    };
    [b * s / below, (-root).exp().scaled(1) / below]
}

/// The share of the length at which the echoes of such rates diverge.
fn critical([a, b]: [Wide; 2]) -> f64 {
    if b.high == 0.0 {
        return f64::INFINITY;
    }
    let (a, b, square) = (a.value(), b.value().abs(), ((a - b) * (a + b)).value());
    let root = square.abs().sqrt();
    if square < 0.0 {
        root.atan2(-a) / root
    } else if a < 0.0 {
        // artanh(root/|A|), of which |A| − root = B²/(|A| + root) would leave nothing.
        if root > 0.0 { ((root - a) / b).ln() / root } else { -1.0 / a }
    } else {
        f64::INFINITY
    }
}

/// A and B of the light itself.
fn light(depth: Wide, albedo: f64, forward: f64) -> [Wide; 2] {
    let [a, p] = [albedo, forward].map(Wide::from);
    [depth * (Wide::ONE - a * p), depth * a * (Wide::ONE - p)]
}

/// A share in [0, 1], often next to an end.
pub(super) fn share(dice: &mut Dice) -> f64 {
    match dice.below(5) {
        0 => dice.sized(-12.0, -1.0),
        1 => 1.0 - dice.sized(-15.0, -1.0),
        2 => [0.0, 0.5, 1.0][dice.below(3)],
        _ => dice.between(0.0, 1.0),
    }
}

/// A rod of which what leaves is known.
pub(super) fn rod_of(depth: f64, albedo: &[f64], forward: f64) -> Option<(Mesh, Rod)> {
    rod_with(depth, albedo, forward, rod::channels(0, false, None))
}

/// A rod of length 1, in equal parts of the given albedos.
pub(super) fn rod_with(
    depth: f64,
    albedo: &[f64],
    forward: f64,
    channels: Vec<Seen>,
) -> Option<(Mesh, Rod)> {
    let text = format!("medium.constant.extinction = {depth:e}\nspan = [0, 1]");
    let medium = text::medium(&text)?;
    let cuts: Vec<f64> = (0..=albedo.len()).map(|i| i as f64 / albedo.len() as f64).collect();
    let albedo = Piecewise::steps(&cuts, albedo);
    let forward = Piecewise::constant(forward, medium.span());
    let rod = Rod::new(medium.clone(), &albedo, &forward, channels);
    Some((Mesh::new(medium), rod))
}

fn see_truth(row: &mut Row, albedo: &[f64], exact: [Wide; 2], depth: f64, forward: f64) {
    let place = || format!("τ = {depth:e}, a = {albedo:?}, p_f = {forward:e}");
    let found = rod_of(depth, albedo, forward).and_then(|(mesh, rod)| rods::truth(&mesh, &rod));
    let Some(found) = found else { return row.skip(place) };
    for (found, exact) in found.into_iter().zip(exact) {
        if exact.high >= 1e-290 {
            row.see(of_stated(found, exact), place);
        } else {
            row.skip(place);
        }
    }
}

fn closed(dice: &mut Dice, trials: u32) -> Row {
    let range = "τ = 1e-9 … 600, a and p_f next to 0 and 1, too";
    let mut row = Row::new("rod, closed form", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, albedo, forward) = (dice.sized(-9.0, 2.78), share(dice), share(dice));
        let exact = leaving(light(Wide::from(depth), albedo, forward));
        see_truth(&mut row, &[albedo], exact, depth, forward);
    }
    row
}

/// Two halves of other albedos, which the solver of varying rods has to join: by adding in 32 digits.
fn solved(dice: &mut Dice, trials: u32) -> Row {
    let range = "two halves of other albedos, τ = 1e-6 … 100";
    let mut row = Row::new("rod, two-stream equations", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (depth, forward) = (dice.sized(-6.0, 2.0), share(dice));
        let albedo = [share(dice), share(dice)];
        let half = Wide::from(depth).scaled(-1);
        let [[r1, t1], [r2, t2]] = albedo.map(|albedo| leaving(light(half, albedo, forward)));
        let echoes = Wide::ONE / (Wide::ONE - r1 * r2);
        let exact = [r1 + t1 * t1 * r2 * echoes, t1 * t2 * echoes];
        see_truth(&mut row, &albedo, exact, depth, forward);
    }
    row
}

/// Q and S of a rule to a power, in 32 digits.
pub(super) fn moments_of(rule: ParticleRule, ratio: Wide, albedo: f64, k: u32) -> [Wide; 2] {
    let (left, scattered) = (Wide::ONE - ratio, Wide::from(albedo) * ratio);
    let signed = |x: Wide, size: Wide| if x.high < 0.0 && k % 2 == 1 { -size } else { size };
    let (chances, sum) = match rule {
        ParticleRule::Terminating => ([left, scattered].map(Wide::abs), Wide::ONE),
        ParticleRule::Weighted => {
            let sum = left.abs() + ratio.abs();
            ([left.abs() / sum, ratio.abs() / sum], sum)
        }
        _ => {
            let sum = left.abs() + scattered.abs();
            ([left.abs() / sum, scattered.abs() / sum], sum)
        }
    };
    let of_weight = if rule == ParticleRule::Weighted { Wide::from(albedo) } else { Wide::ONE };
    [signed(left, chances[0] * sum.powi(k)), signed(ratio, chances[1] * (sum * of_weight).powi(k))]
}

/// Variance, third and fourth central moments of the walks of three rules, and where they diverge.
fn moments(dice: &mut Dice, trials: u32) -> Vec<Row> {
    let range = "3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
    let row = |what, measure, bound| Row::new(what, range, measure, bound);
    let mut second = row("variance of walks in a rod", Measure::OfStated, 1.0);
    let mut fourth = row("fourth moment of walks in a rod", Measure::OfStated, 1.0);
    let mut diverging = row("diverging variances, wrong", Measure::Count, 0.0);
    for _ in 0..trials {
        let (depth, forward) = (dice.sized(-3.0, 1.0), share(dice));
        let (albedo, ratio) = (dice.between(0.05, 1.0), dice.sized(-1.0, 0.5));
        let sampling = depth / ratio;
        let rule = if ratio <= 1.0 && dice.below(3) == 0 {
            ParticleRule::Terminating
        } else {
            [ParticleRule::NonTerminating, ParticleRule::Weighted][dice.below(2)]
        };
        let place =
            || format!("{rule:?}, τ = {depth:e}, r = {ratio:e}, a = {albedo:e}, p_f = {forward:e}");
        let Some((mesh, rod)) = rod_of(depth, &[albedo], forward) else {
            second.skip(place);
            continue;
        };
        let flown = Piecewise::constant(sampling, mesh.support());
        let found = rods::predict(&mesh, &rod, &flown, rule, true);
        let r = Wide::from(depth) / Wide::from(sampling);
        let rates = [1, 2, 3, 4].map(|k| {
            let ([q, s], p) = (moments_of(rule, r, albedo, k), Wide::from(forward));
            let (sampling, turned) = (Wide::from(sampling), s * (Wide::ONE - p));
            [sampling * (Wide::ONE - q - s * p), sampling * turned]
        });
        // Within two thousandths of the critical length either answer is right.
        let length = critical(rates[1]);
        let is_known = found.channels[0].moments.is_some();
        if (length - 1.0).abs() > 2e-3 {
            diverging.count(is_known != (length > 1.0), place);
        }
        if !is_known || length <= 1.0 {
            second.skip(place);
            continue;
        }
        let raw = rates.map(leaving);
        for (i, channel) in found.channels.iter().take(2).enumerate() {
            let Some(moments) = channel.moments else { continue };
            let raw = raw.map(|moment| moment[i]);
            if raw[0].high < 1e-70 {
                second.skip(place);
                continue;
            }
            let [variance, exact] = central(raw, raw[0]);
            second.see(of_relative(moments.relative[0], moments.error, variance), place);
            // A moment that grids do not resolve says so: there are no digits to compare.
            if critical(rates[3]) <= 1.002 || !moments.relative[2].is_finite() {
                fourth.skip(place);
                continue;
            }
            fourth.see(of_relative(moments.relative[2], moments.error, exact), place);
        }
    }
    vec![second, fourth, diverging]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn echoes_of_next_to_nothing_are_counted() {
        // ln(44/2.84e-14)/22: the tangent of the same rounds to 1 and leaves 0.85.
        let length = critical([-22.0, 2.84e-14].map(Wide::from));
        assert!((length - (44.0_f64 / 2.84e-14).ln() / 22.0).abs() < 1e-14 && length > 1.5);
        assert!(
            (critical([-2.0, 1.0].map(Wide::from)) - 0.75_f64.sqrt().atanh() / 3f64.sqrt()).abs()
                < 1e-15
        );
    }

    /// Its E[X⁴] is `e^{107}` times T⁴: grids of two hundred steps gave a negative fourth moment, and an error
    /// that left it out.
    #[test]
    fn a_moment_that_grids_do_not_resolve_is_unknown() {
        let (depth, ratio) = (8.940_790_550_262_802, 1.577_262_931_059_708_6);
        let (mesh, rod) = rod_of(depth, &[0.975_508_180_662_457_5], 1.0).expect("a rod");
        let flown = Piecewise::constant(depth / ratio, mesh.support());
        let found = rods::predict(&mesh, &rod, &flown, ParticleRule::NonTerminating, true);
        let moments = found.channels[1].moments.expect("a variance");
        assert!((moments.relative[0] / 562_318_773.801_692_5 - 1.0).abs() < 1e-10);
        assert!(moments.relative[2].is_infinite() && moments.error < 1e-10, "{moments:?}");
    }
}
