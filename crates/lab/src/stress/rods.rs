//! Rods: truths and moments of walks against closed forms in 32 digits.
//!
//! ```text
//! constant rates, κ² = A² − B², E = e^{−2κℓ}, s = (1 − E)/κ:
//!     R = Bs/(1 + E + As),  T = 2e^{−κℓ}/(1 + E + As)
//! κ² = −ω²:  T = 1/(cos ωℓ + A sin(ωℓ)/ω),  R = B T sin(ωℓ)/ω
//! two halves:  R = R₁ + T₁² R₂/(1 − R₁R₂),  T = T₁T₂/(1 − R₁R₂)
//! ```

use super::fields::homogeneous;
use super::prelude::*;
use theory::problems::Rod;
use theory::problems::rod::{self, RodQuantity};
use theory::{CountDistribution, ParticleRule, rod as rods};

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let row =
        TrialRow::stated("rod, closed form", "τ = 1e-9 … 600, a and p_f next to 0 and 1, too");
    let even = || Parts::any(sized(-9.0, 2.78), 1);
    let mut rows = run.fill([1280, 48_000], [row], even, truths);
    let row = TrialRow::stated(
        "rod, two-stream equations",
        "two halves of other albedos, τ = 1e-6 … 100",
    );
    let halves = || Parts::any(sized(-6.0, 2.0), 2);
    rows.extend(run.fill([64, 2400], [row], halves, truths));
    let range = "3 rules, r = 0.1 … 3, τ = 1e-3 … 10";
    let mut of_walks = TrialRow::moments("walks in a rod", range).to_vec();
    of_walks.push(TrialRow::wrong("diverging variances, wrong", range));
    of_walks.push(TrialRow::stated("lookups of walks in a rod", range));
    rows.extend(run.fill([64, 2400], of_walks, Walked::any, walks));
    let range = "2 rules, 0.0025 … 0.3 below the critical length, r = 2 … 3.2";
    let row = TrialRow::stated("variance of walks in a nearly critical rod", range);
    rows.extend(run.fill([64, 2400], [row], NearCritical::any, near_critical));
    rows
}

parameters! {
    /// A rod of length 1 in equal parts of other albedos.
    Parts(range: NumberStrategy, count: usize) {
        depth: f64 = range,
        forward: f64 = share(),
        albedos: Vec<f64> = vec(share(), count),
    }
}

/// R and T of two-stream equations with rates A and B, in units of one over the length.
pub(super) fn leaving([a, b]: [DoubleDouble; 2]) -> [DoubleDouble; 2] {
    let square = (a - b) * (a + b);
    let root = square.abs().sqrt();
    if square.high < 0.0 {
        let [sine, cosine] = root.sin_cos();
        let through = 1.0 / (cosine + a * sine / root);
        return [b * through * sine / root, through];
    }
    let faint = (-root.scaled(1)).exp();
    let s =
        if root.high > 0.0 { -(-root.scaled(1)).exp_m1() / root } else { DoubleDouble::from(2.0) };
    // 1 + E + As, without the cancellation where weights grow and A is negative.
    let below = if a.high < 0.0 && root.high > 0.0 {
        faint * (1.0 - a / root) - b * b / (root * (root - a))
    } else {
        1.0 + faint + a * s
    };
    [b * s / below, (-root).exp().scaled(1) / below]
}

/// The share of the length at which the echoes of such rates diverge.
pub(super) fn critical([a, b]: [DoubleDouble; 2]) -> f64 {
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
pub(super) fn light(depth: DoubleDouble, albedo: DoubleDouble, forward: f64) -> [DoubleDouble; 2] {
    [depth * (1.0 - albedo * forward), depth * albedo * (1.0 - DoubleDouble::from(forward))]
}

/// A rod of length 1, in equal parts of the given albedos.
pub(super) fn rod_with(
    depth: f64,
    albedo: &[f64],
    forward: f64,
    channels: Vec<RodQuantity>,
) -> (Mesh, Rod) {
    let medium = homogeneous(depth, 1.0);
    let cuts: Vec<f64> = (0..=albedo.len()).map(|i| i as f64 / albedo.len() as f64).collect();
    let albedo = Piecewise::steps(&cuts, albedo);
    let forward = Piecewise::constant(forward, medium.span());
    let rod = Rod::new(medium.clone(), &albedo, &forward, channels);
    (Mesh::new(medium), rod)
}

/// A rod of which what leaves is known.
pub fn rod_of(depth: f64, albedo: &[f64], forward: f64) -> (Mesh, Rod) {
    rod_with(depth, albedo, forward, rod::channels(0, false, None))
}

/// One part in closed form; two parts, which the solver of varying rods has to join, by adding in 32 digits.
fn truths(Parts { depth, forward, albedos }: &Parts, seen: &mut Seen) -> Option<()> {
    let part = DoubleDouble::from(*depth) / albedos.len() as f64;
    let parts =
        albedos.iter().map(|&albedo| leaving(light(part, DoubleDouble::from(albedo), *forward)));
    let exact = parts.reduce(|[r1, t1], [r2, t2]| {
        let echoes = 1.0 / (1.0 - r1 * r2);
        [r1 + t1 * t1 * r2 * echoes, t1 * t2 * echoes]
    })?;
    let (mesh, rod) = rod_of(*depth, albedos, *forward);
    for (computed, exact) in rods::truth(&mesh, &rod)?.into_iter().zip(exact) {
        if exact.high >= 1e-290 { seen.stated(0, computed, exact) } else { seen.skip(0) }
    }
    Some(())
}

/// Q and S of a rule to a power, in 32 digits.
pub(super) fn moments_of(
    rule: ParticleRule,
    ratio: DoubleDouble,
    albedo: f64,
    k: u32,
) -> [DoubleDouble; 2] {
    let (left, scattered) = (1.0 - ratio, albedo * ratio);
    let signed =
        |x: DoubleDouble, size: DoubleDouble| if x.high < 0.0 && k % 2 == 1 { -size } else { size };
    let (chances, sum) = if rule == ParticleRule::Terminating {
        ([left, scattered].map(DoubleDouble::abs), DoubleDouble::ONE)
    } else {
        let other = if rule == ParticleRule::Weighted { ratio } else { scattered };
        let sum = left.abs() + other.abs();
        ([left.abs() / sum, other.abs() / sum], sum)
    };
    let of_weight = if rule == ParticleRule::Weighted { albedo } else { 1.0 };
    [signed(left, chances[0] * sum.powi(k)), signed(ratio, chances[1] * (sum * of_weight).powi(k))]
}

/// A rule that exists for a ratio: the terminating one in one of three.
pub(super) fn rule(ratio: f64, kind: usize) -> ParticleRule {
    use ParticleRule::{NonTerminating, Terminating, Weighted};
    match kind % 3 {
        0 if ratio <= 1.0 => Terminating,
        1 => Weighted,
        _ => NonTerminating,
    }
}

parameters! {
    /// Walks in a rod of one albedo.
    Walked {
        depth: f64 = sized(-3.0, 1.0),
        forward: f64 = share(),
        albedo: f64 = between(0.05, 1.0),
        ratio: f64 = sized(-1.0, 0.5),
        kind: usize = 0..3_usize,
    }
    /// Walks of growing weights in a rod that is a share shorter than critical to their variance.
    NearCritical {
        forward: f64 = share(),
        albedo: f64 = between(0.05, 1.0),
        ratio: f64 = between(2.05, 3.2),
        kind: usize = 1..3_usize,
        missing: f64 = sized(-2.6, -0.5),
    }
}

impl Walked {
    fn sampling(&self) -> f64 {
        self.depth / self.ratio
    }

    /// Q and S to a power.
    fn moments(&self, k: u32) -> [DoubleDouble; 2] {
        let ratio = DoubleDouble::from(self.depth) / self.sampling();
        moments_of(rule(self.ratio, self.kind), ratio, self.albedo, k)
    }

    /// A and B to a power.
    fn rates(&self, k: u32) -> [DoubleDouble; 2] {
        let ([q, s], p) = (self.moments(k), self.forward);
        [self.sampling() * (1.0 - q - s * p), self.sampling() * (s * (1.0 - DoubleDouble::from(p)))]
    }

    /// Mean number of lookups.
    fn collisions(&self) -> DoubleDouble {
        let (flown, [q, s]) = (DoubleDouble::from(self.sampling()), self.moments(0));
        let ends = 1.0 - q - s;
        let [r, t] = leaving(self.rates(0));
        // A walk that nothing ends collides as often as one that nothing turns.
        if ends.high > 1e-25 { (1.0 - r - t) / ends } else { flown }
    }
}

/// Returns lookups with the error that their check takes.
pub(super) fn lookups(distribution: &CountDistribution) -> Known {
    Known::new(
        distribution.mean,
        distribution.mean * distribution.error.max(CountDistribution::ERROR),
    )
}

/// Variance and fourth central moment of the walks of three rules, where they diverge, and their lookups.
fn walks(walked: &Walked, seen: &mut Seen) {
    let (mesh, rod) = rod_of(walked.depth, &[walked.albedo], walked.forward);
    let flown = Piecewise::constant(walked.sampling(), mesh.support());
    let computed = rods::predict(&mesh, &rod, &flown, rule(walked.ratio, walked.kind), true);
    if let Some(distribution) = &computed.lookups {
        seen.stated(3, lookups(distribution), walked.collisions());
    }
    let rates = [1, 2, 3, 4].map(|k| walked.rates(k));
    // Within two thousandths of the critical length either answer is right.
    let length = critical(rates[1]);
    let is_known = computed.channels[0].moments.is_some();
    if (length - 1.0).abs() > 2e-3 {
        seen.wrong(2, is_known != (length > 1.0));
    }
    if !is_known || length <= 1.0 {
        seen.skip(0);
        return;
    }
    let raw = rates.map(leaving);
    for (i, channel) in computed.channels.iter().take(2).enumerate() {
        let Some(moments) = channel.moments else { continue };
        let raw = raw.map(|moment| moment[i]);
        if raw[0].high < 1e-70 {
            seen.skip(0);
            continue;
        }
        seen.at(&channel.name);
        // A moment that grids do not resolve says so: there are no digits to compare.
        let finite = if critical(rates[3]) > 1.002 { 4 } else { 3 };
        seen.resolved([0, 1], Some(moments), &raw[..finite]);
    }
}

/// The variance next to the length where it becomes infinite.
fn near_critical(case: &NearCritical, seen: &mut Seen) -> Option<()> {
    let &NearCritical { forward, albedo, ratio, kind, missing } = case;
    let long = Walked { depth: 1.0, forward, albedo, ratio, kind };
    let depth = critical(long.rates(2)) * (1.0 - missing);
    let walked = Walked { depth, ..long };
    if !(1e-3..30.0).contains(&depth) {
        return None;
    }
    let (mesh, rod) = rod_of(walked.depth, &[walked.albedo], walked.forward);
    let flown = Piecewise::constant(walked.sampling(), mesh.support());
    let computed = rods::predict(&mesh, &rod, &flown, rule(walked.ratio, walked.kind), false);
    let raw = [1, 2].map(|k| leaving(walked.rates(k)));
    for (i, channel) in computed.channels.iter().take(2).enumerate() {
        seen.at(&channel.name);
        let [mean, square] = raw.map(|moment| moment[i]);
        match channel.moments.filter(|_| mean.high > 1e-70) {
            Some(moments) => {
                let exact = square / (mean * mean) - 1.0;
                seen.central(0, moments.relative[0], moments.error, exact);
            }
            None => seen.skip(0),
        }
    }
    Some(())
}
