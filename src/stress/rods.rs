//! Rods: truths and moments of walks against closed forms in 32 digits.
//!
//! ```text
//! constant rates, κ² = A² − B², E = e^{−2κℓ}, s = (1 − E)/κ:
//!     R = Bs/(1 + E + As),  T = 2e^{−κℓ}/(1 + E + As)
//! κ² = −ω²:  T = 1/(cos ωℓ + A sin(ωℓ)/ω),  R = B T sin(ωℓ)/ω
//! two halves:  R = R₁ + T₁² R₂/(1 − R₁R₂),  T = T₁T₂/(1 − R₁R₂)
//! ```

use super::text::homogeneous;
use super::trial::{Dice, Trial, central, share};
use super::{Effort, Row, in_parts};
use media::Piecewise;
use numeric::{Known, Wide};
use theory::particle::ParticleRule;
use theory::problems::Rod;
use theory::problems::rod::{self, Quantity};
use theory::{Mesh, rod as rods};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(4, 150);
    in_parts(16, "rods", seed, |part| {
        let range = "τ = 1e-9 … 600, a and p_f next to 0 and 1, too";
        part.run(20 * trials, [Row::stated("rod, closed form", range)], closed);
        let range = "two halves of other albedos, τ = 1e-6 … 100";
        part.run(trials, [Row::stated("rod, two-stream equations", range)], solved);
        let range = "3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
        let [second, fourth] = Row::moments("walks in a rod", range);
        let diverging = Row::wrong("diverging variances, wrong", range);
        part.run(trials / 2, [second, fourth, diverging], moments);
    })
}

/// R and T of two-stream equations with rates A and B, in units of one over the length.
pub(super) fn leaving([a, b]: [Wide; 2]) -> [Wide; 2] {
    let square = (a - b) * (a + b);
    let root = square.abs().sqrt();
    if square.high < 0.0 {
        let [sine, cosine] = root.sin_cos();
        let through = 1.0 / (cosine + a * sine / root);
        return [b * through * sine / root, through];
    }
    let faint = (-root.scaled(1)).exp();
    let s = if root.high > 0.0 { -(-root.scaled(1)).exp_m1() / root } else { Wide::from(2.0) };
    // 1 + E + As, without the cancellation where weights grow and A is negative.
    let below = if a.high < 0.0 && root.high > 0.0 {
        faint * (1.0 - a / root) - b * b / (root * (root - a))
    } else {
        1.0 + faint + a * s
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
    [depth * (1.0 - Wide::product(albedo, forward)), depth * albedo * (1.0 - Wide::from(forward))]
}

/// A rod of length 1, in equal parts of the given albedos.
pub(super) fn rod_with(
    depth: f64,
    albedo: &[f64],
    forward: f64,
    channels: Vec<Quantity>,
) -> Option<(Mesh, Rod)> {
    let medium = homogeneous(depth, 1.0)?;
    let cuts: Vec<f64> = (0..=albedo.len()).map(|i| i as f64 / albedo.len() as f64).collect();
    let albedo = Piecewise::steps(&cuts, albedo);
    let forward = Piecewise::constant(forward, medium.span());
    let rod = Rod::new(medium.clone(), &albedo, &forward, channels);
    Some((Mesh::new(medium), rod))
}

/// A rod of which what leaves is known.
fn rod_of(depth: f64, albedo: &[f64], forward: f64) -> Option<(Mesh, Rod)> {
    rod_with(depth, albedo, forward, rod::channels(0, false, None))
}

fn see_truth(
    t: &mut Trial,
    albedo: &[f64],
    exact: [Wide; 2],
    [depth, forward]: [f64; 2],
) -> Option<()> {
    t.place = format!("τ = {depth:e}, a = {albedo:?}, p_f = {forward:e}");
    let (mesh, rod) = rod_of(depth, albedo, forward)?;
    for (found, exact) in rods::truth(&mesh, &rod)?.into_iter().zip(exact) {
        if exact.high >= 1e-290 { t.stated(0, found, exact) } else { t.skip(0) }
    }
    Some(())
}

fn closed(t: &mut Trial) -> Option<()> {
    let (depth, albedo, forward) = (t.dice.sized(-9.0, 2.78), share(t.dice), share(t.dice));
    let exact = leaving(light(Wide::from(depth), albedo, forward));
    see_truth(t, &[albedo], exact, [depth, forward])
}

/// Two halves of other albedos, which the solver of varying rods has to join: by adding in 32 digits.
fn solved(t: &mut Trial) -> Option<()> {
    let (depth, forward) = (t.dice.sized(-6.0, 2.0), share(t.dice));
    let albedo = [share(t.dice), share(t.dice)];
    let half = Wide::from(depth).scaled(-1);
    let [[r1, t1], [r2, t2]] = albedo.map(|albedo| leaving(light(half, albedo, forward)));
    let echoes = 1.0 / (1.0 - r1 * r2);
    let exact = [r1 + t1 * t1 * r2 * echoes, t1 * t2 * echoes];
    see_truth(t, &albedo, exact, [depth, forward])
}

/// Q and S of a rule to a power, in 32 digits.
pub(super) fn moments_of(rule: ParticleRule, ratio: Wide, albedo: f64, k: u32) -> [Wide; 2] {
    let (left, scattered) = (1.0 - ratio, albedo * ratio);
    let signed = |x: Wide, size: Wide| if x.high < 0.0 && k % 2 == 1 { -size } else { size };
    let (chances, sum) = if rule == ParticleRule::Terminating {
        ([left, scattered].map(Wide::abs), Wide::ONE)
    } else {
        let other = if rule == ParticleRule::Weighted { ratio } else { scattered };
        let sum = left.abs() + other.abs();
        ([left.abs() / sum, other.abs() / sum], sum)
    };
    let of_weight = if rule == ParticleRule::Weighted { albedo } else { 1.0 };
    [signed(left, chances[0] * sum.powi(k)), signed(ratio, chances[1] * (sum * of_weight).powi(k))]
}

/// A rule that exists for a ratio: the terminating one now and then.
pub(super) fn rule(dice: &mut Dice, ratio: f64, every: usize) -> ParticleRule {
    if ratio <= 1.0 && dice.below(every) == 0 {
        return ParticleRule::Terminating;
    }
    [ParticleRule::NonTerminating, ParticleRule::Weighted][dice.below(2)]
}

/// Walks in a rod of one albedo.
pub(super) struct Walked {
    depth: f64,
    /// The chance to be scattered forward.
    pub forward: f64,
    albedo: f64,
    ratio: f64,
    /// σ̂.
    pub sampling: f64,
    /// What collisions do.
    pub rule: ParticleRule,
}

impl Walked {
    /// One in so many terminates.
    pub fn new(dice: &mut Dice, every: usize) -> Self {
        let (depth, forward) = (dice.sized(-3.0, 1.0), share(dice));
        let (albedo, ratio) = (dice.between(0.05, 1.0), dice.sized(-1.0, 0.5));
        let rule = rule(dice, ratio, every);
        Self { depth, forward, albedo, ratio, sampling: depth / ratio, rule }
    }

    /// All of it.
    pub fn place(&self) -> String {
        let Self { depth, forward, albedo, ratio, rule, .. } = self;
        format!("{rule:?}, τ = {depth:e}, r = {ratio:e}, a = {albedo:e}, p_f = {forward:e}")
    }

    /// As theory sees it, and σ̂.
    pub fn rod(&self) -> Option<(Mesh, Rod, Piecewise)> {
        let (mesh, rod) = rod_of(self.depth, &[self.albedo], self.forward)?;
        let flown = Piecewise::constant(self.sampling, mesh.support());
        Some((mesh, rod, flown))
    }

    /// Q and S to a power.
    pub fn moments(&self, k: u32) -> [Wide; 2] {
        moments_of(self.rule, Wide::from(self.depth) / self.sampling, self.albedo, k)
    }

    /// A and B to a power.
    pub fn rates(&self, k: u32) -> [Wide; 2] {
        let ([q, s], p) = (self.moments(k), self.forward);
        [self.sampling * (1.0 - q - s * p), self.sampling * (s * (1.0 - Wide::from(p)))]
    }
}

/// Variance and fourth central moment of the walks of three rules, and where they diverge.
fn moments(t: &mut Trial) -> Option<()> {
    let walked = Walked::new(t.dice, 3);
    t.place = walked.place();
    let (mesh, rod, flown) = walked.rod()?;
    let found = rods::predict(&mesh, &rod, &flown, walked.rule, true);
    let rates = [1, 2, 3, 4].map(|k| walked.rates(k));
    // Within two thousandths of the critical length either answer is right.
    let length = critical(rates[1]);
    let is_known = found.channels[0].moments.is_some();
    if (length - 1.0).abs() > 2e-3 {
        t.count(2, is_known != (length > 1.0));
    }
    if !is_known || length <= 1.0 {
        t.skip(0);
        return Some(());
    }
    let raw = rates.map(leaving);
    for (i, channel) in found.channels.iter().take(2).enumerate() {
        let Some(moments) = channel.moments else { continue };
        let raw = raw.map(|moment| moment[i]);
        if raw[0].high < 1e-70 {
            t.skip(0);
            continue;
        }
        let [variance, fourth] = central(raw, raw[0]);
        let second = moments.relative[0];
        t.stated(0, Known::new(second, second.abs() * moments.error), variance);
        // A moment that grids do not resolve says so: there are no digits to compare.
        let found = if critical(rates[3]) > 1.002 { moments.relative[2] } else { f64::INFINITY };
        t.central(1, found, moments.error, fourth);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn echoes_of_next_to_nothing_are_counted() {
        // ln(44/2.84e-14)/22: the tangent of the same rounds to 1 and leaves 0.85.
        let length = critical([-22.0, 2.84e-14].map(Wide::from));
        assert!((length - (44.0_f64 / 2.84e-14).ln() / 22.0).abs() < 1e-14 && length > 1.5);
        let closed = 0.75_f64.sqrt().atanh() / 3f64.sqrt();
        assert!((critical([-2.0, 1.0].map(Wide::from)) - closed).abs() < 1e-15);
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
