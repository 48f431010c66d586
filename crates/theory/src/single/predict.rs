//! Draws that scatter at one point, or at one point of each of two techniques.

use super::Collisions;
use super::scene::{RayNode, RayScene};
use crate::prediction::raw::{POWERS, PerPower, Raw, RawMoments, added};
use crate::{Channel, CountDistribution, Prediction, Tails};
use numeric::Known;

/// Relative difference of two resolutions of moments at which panels are fine enough.
pub const MOMENT: f64 = 1e-11;
/// Maximum relative error of moments that are given: checks use no others.
const BLURRED: f64 = 1e-2;
/// Relative difference of two resolutions of lookups at which panels are fine enough.
pub const LOOKUPS: f64 = 1e-12;

/// Moments of weights at a node, with bounds on their errors.
pub type Weighted<'a> = dyn Fn(&RayNode) -> [PerPower; 2] + 'a;

/// Density of a scattering point, and the score at the point.
pub struct ScoredDensity<'a> {
    /// The density of the point, 1/length; its integral may be below 1: then there may be no point.
    pub density: &'a dyn Fn(&RayNode) -> f64,
    /// The draw without both estimated transmittances.
    pub gain: &'a dyn Fn(&RayNode) -> f64,
    /// A relative error bound of the density, and of its substitute in the gain.
    pub blur: &'a dyn Fn(&RayNode) -> f64,
    /// The delta tracking that found the point, if it did. The transmittance from the origin is then no factor of
    /// the draw, and the lookups are those of the tracking.
    pub by_collisions: Option<&'a Collisions<'a>>,
    /// Substitute for the moments of the transmittance from the origin, where weights depend on the walk.
    pub weighted: Option<&'a Weighted<'a>>,
}

impl ScoredDensity<'_> {
    /// Moments of the factor from the walk from the origin, and bounds on their errors.
    fn camera(&self, node: &RayNode) -> [PerPower; 2] {
        match self.weighted {
            Some(weighted) => weighted(node),
            None if self.by_collisions.is_some() => [[1.0; 5], [0.0; 5]],
            None => [node.camera.powers, node.camera.powers.map(|power| power * node.camera.error)],
        }
    }
}

/// The raw moments of the draws of a technique.
#[derive(Debug, Clone, Copy)]
pub struct TechniqueMoments {
    /// The radiance by quadrature.
    pub truth: Known,
    /// Raw moments of the draw.
    pub raw: RawMoments,
    /// `E[(N − minimum)^k]`, k = 0 … 4; `None` where it is not computed.
    pub lookups: Option<Raw>,
    /// Number of lookups of every draw, kept apart: beside it rare lookups would lose their digits.
    pub minimum: f64,
    /// A relative error bound of the mean lookups.
    pub counted: f64,
    /// Mean number of lookups of shadow rays; `None` where it is not computed.
    pub shadow_lookups: Option<f64>,
}

/// Relative rounding error of sums over panels.
const SUMS: f64 = 1e-14;
/// Relative rounding error of a density that is computed from σ_t, distances and exponentials.
pub const DENSITY: f64 = 4.0 * f64::EPSILON;
/// Smallest moment: below it some of its terms lose digits by underflow.
const LEAST: f64 = 1e-280;

impl TechniqueMoments {
    /// Moments of one technique, by panels that end at the kinks of its density and gain, too.
    pub fn of(scene: &RayScene, technique: &ScoredDensity, kinks: Vec<f64>) -> Self {
        let mut parts = [MOMENT; 14];
        parts[5..9].fill(LOOKUPS);
        parts[9..].fill(f64::INFINITY);
        let result = scene.integrate(parts, kinks, &|node| {
            let density = (technique.density)(node);
            if density <= 0.0 {
                return [0.0; 14];
            }
            let gain = (technique.gain)(node);
            let [camera, errors] = technique.camera(node);
            let shadow = node.shadow.powers;
            let factor = node.error[0] + (technique.blur)(node) + DENSITY;
            let (lookups, shadow_lookups) = match technique.by_collisions {
                Some(collisions) => (collisions.lookups_at(node), node.shadow.lookups[1]),
                None => (node.lookups(), node.shadow_lookups()),
            };
            let mut row = [0.0; 14];
            row[13] = density * shadow_lookups;
            for (i, k) in POWERS.into_iter().enumerate() {
                let gathered = density * gain.powi(k);
                row[i] = gathered * camera[i] * shadow[i];
                if i < 4 {
                    row[5 + i] = density * lookups[i + 1];
                    let blur = f64::from(k) * factor + node.shadow.error;
                    row[9 + i] = row[i].abs() * blur + (gathered * errors[i] * shadow[i]).abs();
                }
            }
            row
        });
        let [p1, p2, p3, p4, p8, n1, n2, n3, n4, r1, r2, r3, r4, cast] = result.value;
        let none = technique.by_collisions.map_or([0.0; 5], Collisions::lookups_of_escape);
        let off = result.error[..4]
            .iter()
            .zip([r1, r2, r3, r4])
            .map(|(apart, rounding)| apart + rounding);
        let mut raw = RawMoments([p1, p2, p3, p4, p8].map(|power| Known::estimated(power, 0.0)));
        for (known, off) in raw.0.iter_mut().zip(off) {
            known.error = off.max(SUMS * known.value.abs());
        }
        let lookups = [1.0, n1 + none[1], n2 + none[2], n3 + none[3], n4 + none[4]];
        // A walk that ends at its point may end before.
        let minimum = if technique.by_collisions.is_some() { 0.0 } else { 1.0 };
        Self {
            truth: scene.radiance(),
            raw,
            lookups: Some(lookups),
            minimum,
            counted: SUMS + result.error[5] / (minimum + lookups[1]),
            shadow_lookups: Some(cast),
        }
    }

    /// The sum of independent draws of two techniques.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            truth: self.truth,
            raw: self.raw.plus(&other.raw),
            minimum: self.minimum + other.minimum,
            counted: self.counted.max(other.counted),
            lookups: self.lookups.zip(other.lookups).map(|(a, b)| added(a, b)),
            shadow_lookups: self.shadow_lookups.zip(other.shadow_lookups).map(|(a, b)| a + b),
        }
    }

    /// Moments of a draw of either technique with probability ½, and with twice its score.
    #[must_use]
    pub fn either(&self, other: &Self) -> Self {
        let lookups = |one: &Self| {
            let minimum = one.minimum;
            let always = [1.0, minimum, minimum.powi(2), minimum.powi(3), minimum.powi(4)];
            one.lookups.map(|more| added(always, more))
        };
        let half = |a: f64, b: f64| 0.5 * (a + b);
        Self {
            truth: self.truth,
            raw: self.raw.either(&other.raw),
            minimum: 0.0,
            counted: self.counted.max(other.counted),
            lookups: lookups(self)
                .zip(lookups(other))
                .map(|(a, b)| std::array::from_fn(|k| half(a[k], b[k]))),
            shadow_lookups: self.shadow_lookups.zip(other.shadow_lookups).map(|(a, b)| half(a, b)),
        }
    }

    /// Prediction for the draws.
    pub fn prediction(&self) -> Prediction {
        let [mean, .., fourth, eighth] = self.raw.0;
        let moments = self.raw.in_units_of_their_mean().central(mean, BLURRED);
        // A variance may be resolved where the higher moments are not.
        let is_known = moments.error < BLURRED && mean.value.abs() < f64::INFINITY;
        let is_full = self.raw.0[..4].iter().all(|power| power.value.abs() >= LEAST);
        let moments = (is_known && is_full).then_some(moments);
        let eighth_moment_ratio = eighth.value / (fourth.value * fourth.value);
        // The rarity of the draws that make the variance is not computed.
        let tails = Tails { rare_event_size: f64::NAN, eighth_moment_ratio };
        let channels = vec![Channel::unbiased(self.truth, moments, tails)];
        let distribution = |raw| CountDistribution::of_raw(self.minimum, raw, self.counted);
        let (lookups, shadow_lookups) = (self.lookups.map(distribution), self.shadow_lookups);
        Prediction { channels, lookups, shadow_lookups, ..Prediction::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(powers: [f64; 4]) -> TechniqueMoments {
        let [a, b, c, d] = powers;
        TechniqueMoments {
            truth: Known::exact(a),
            raw: RawMoments::estimated([a, b, c, d, f64::NAN], [1e-14; 5]),
            lookups: Some([1.0, 0.5, 0.5, 0.5, 0.5]),
            minimum: 0.0,
            counted: 1e-14,
            shadow_lookups: None,
        }
    }

    #[test]
    fn two_coins_make_a_binomial_number() {
        // X = 0 or 1 with probability ½: variance ¼; two of them: mean 1, variance ½, kurtosis 2.
        let coin = points([0.5; 4]);
        let both = coin.plus(&coin);
        assert_eq!(both.raw.0.map(|known| known.value)[..4], [1.0, 1.5, 2.5, 4.5]);
        let prediction = both.prediction();
        let moments = prediction.channels[0].moments.expect("moments");
        assert!((moments.variance() - 0.5).abs() < 1e-15);
        assert!((moments.kurtosis().expect("spread") - 2.0).abs() < 1e-14);
        let lookups = prediction.lookups.expect("lookups");
        assert_eq!([lookups.mean, lookups.variance], [1.0, 0.5]);
    }

    #[test]
    fn either_of_two_coins_is_one_of_twice_the_worth() {
        // 0, or 2 with probability ½: mean 1, variance 1; lookups: 1 more than a coin, or a coin.
        let coin = points([0.5; 4]);
        let other = TechniqueMoments { minimum: 1.0, ..coin };
        let prediction = coin.either(&other).prediction();
        let moments = prediction.channels[0].moments.expect("moments");
        assert!((moments.scale - 1.0).abs() < 1e-15 && (moments.variance() - 1.0).abs() < 1e-15);
        let lookups = prediction.lookups.expect("lookups");
        assert_eq!([lookups.mean, lookups.variance], [1.0, 0.5]);
    }

    #[test]
    fn a_spread_that_rounding_hides_is_unknown() {
        let faint = points([1.0, 1.0 + 1e-16, 1.0, 1.0]);
        assert!(faint.prediction().channels[0].moments.is_none());
        // 1 ± 1e-5: the variance, 1e-10, is known to three digits, m₄ = 1e-20 to none.
        let narrow = points([1.0, 1.0 + 1e-10, 1.0 + 3e-10, 1.0 + 6e-10]);
        let moments = narrow.prediction().channels[0].moments.expect("a variance");
        assert!((moments.relative[0] - 1e-10).abs() <= 1e-10 * moments.error);
        assert!(moments.error < 1e-3 && moments.relative[2].is_infinite(), "{moments:?}");
    }
}
