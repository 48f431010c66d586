//! Draws that scatter at one point, or at one point of each of two techniques.

use super::passage::added;
use super::scene::{Node, Scene};
use crate::numeric::Known;
use crate::theory::{Channel, CountLaw, Moments, Prediction, Tails};

/// The agreement that is asked of two resolutions, relative to the whole: of moments.
pub const MOMENT: f64 = 1e-11;
/// Moments with a larger relative error are not told.
const BLURRED: f64 = 1e-3;
/// Of lookups.
pub const LOOKUPS: f64 = 1e-12;

/// How a scattering point is found and what it is worth.
pub struct Technique<'a> {
    /// The density of the point, 1/length; it may leave a chance that there is none.
    pub density: &'a dyn Fn(&Node) -> f64,
    /// The draw without both estimated transmittances.
    pub gain: &'a dyn Fn(&Node) -> f64,
    /// Whether the point was found by a walk that came through: then the transmittance from the
    /// origin is no factor of the draw, and what comes is its lookups given the point.
    pub found: Option<Found<'a>>,
}

/// The lookups of a walk that ends at its scattering point.
pub struct Found<'a> {
    /// `E[N^k]` of a walk that ends at the point, shadow ray included.
    pub at: &'a dyn Fn(&Node) -> [f64; 5],
    /// `E[N^k; none]` of walks that find none.
    pub none: [f64; 5],
}

/// The raw moments of the draws of a technique.
#[derive(Debug, Clone, Copy)]
pub struct Points {
    /// The radiance by quadrature.
    pub truth: Known,
    /// `E[X^k]`, k = 0 … 4.
    pub powers: [f64; 5],
    /// Relative error bounds of the powers.
    pub error: f64,
    /// `E[X⁸]`, where it is known.
    pub eighth: Option<f64>,
    /// `E[N^k]`, k = 0 … 4; `None` where it is not worked out.
    pub lookups: Option<[f64; 5]>,
}

impl Points {
    /// Of one technique.
    #[must_use]
    pub fn of(scene: &Scene, technique: &Technique) -> Self {
        let mut parts = [MOMENT; 9];
        parts[5..].fill(LOOKUPS);
        let found = scene.integrate(parts, &|node| {
            let density = (technique.density)(node);
            if density <= 0.0 {
                return [0.0; 9];
            }
            let gain = (technique.gain)(node);
            let walked = technique.found.is_some();
            let power = |k: i32, camera: f64, shadow: f64| {
                let camera = if walked { 1.0 } else { camera };
                density * gain.powi(k) * camera * shadow
            };
            let [_, c1, c2, c3, c4] = node.camera.powers;
            let [_, s1, s2, s3, s4] = node.shadow.powers;
            let lookups = match &technique.found {
                Some(found) => (found.at)(node),
                None => node.lookups(),
            };
            [
                power(1, c1, s1),
                power(2, c2, s2),
                power(3, c3, s3),
                power(4, c4, s4),
                power(8, node.camera.eighth, node.shadow.eighth),
                density * lookups[1],
                density * lookups[2],
                density * lookups[3],
                density * lookups[4],
            ]
        });
        let [p1, p2, p3, p4, eighth, n1, n2, n3, n4] = found.value;
        let none = technique.found.as_ref().map_or([0.0; 5], |found| found.none);
        let relative = found.error[..4].iter().zip([p1, p2, p3, p4]).map(|(e, p)| e / p.abs());
        Self {
            truth: scene.radiance(),
            powers: [1.0, p1, p2, p3, p4],
            error: relative.fold(1e-14, f64::max),
            eighth: Some(eighth),
            lookups: Some([1.0, n1 + none[1], n2 + none[2], n3 + none[3], n4 + none[4]]),
        }
    }

    /// The sum of independent draws of two techniques.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            truth: self.truth,
            powers: added(self.powers, other.powers),
            error: self.error.max(other.error),
            eighth: None,
            lookups: self.lookups.zip(other.lookups).map(|(a, b)| added(a, b)),
        }
    }

    /// What theory says of the draws.
    #[must_use]
    pub fn prediction(&self) -> Prediction {
        let [_, mean, second, third, fourth] = self.powers;
        let [r2, r3, r4] = [second / mean.powi(2), third / mean.powi(3), fourth / mean.powi(4)];
        let m2 = (r2 - 1.0).max(0.0);
        let m4 = r4 - 4.0 * r3 + 6.0 * r2 - 3.0;
        // Errors of the raw moments, and of the powers of the mean, where they nearly cancel.
        let sensitivity = (3.0 * r2 / m2).max((5.0 * r4 + 24.0 * r3.abs() + 24.0 * r2) / m4);
        let moments = Moments {
            scale: mean,
            relative: [m2, r3 - 3.0 * r2 + 2.0, m4.max(m2 * m2)],
            error: self.error * sensitivity,
        };
        // A spread that rounding hides is not known to be none, nor one beyond the range of doubles.
        let moments = (moments.error < BLURRED && !m4.is_nan()).then_some(moments);
        let eighth = self.eighth.map_or(f64::NAN, |eighth| eighth / (fourth * fourth));
        // How rare the draws are that make the variance is not worked out.
        let tails = Tails { rare_event_size: f64::NAN, eighth_moment_ratio: eighth };
        let certain = Channel::unbiased(self.truth, Moments::certain(mean), tails);
        let channel = Channel { moments, ..certain };
        let prediction = Prediction::single(channel, CountLaw::always(0.0));
        let lookups = self.lookups.map(|raw| CountLaw { error: self.error, ..count(raw) });
        Prediction { lookups, ..prediction }
    }
}

/// The law of a count with the given raw moments, without probabilities.
#[must_use]
pub fn count([_, mean, second, third, fourth]: [f64; 5]) -> CountLaw {
    let square = mean * mean;
    let variance = second - square;
    if variance <= 1e-9 * second {
        return CountLaw::always(mean.round());
    }
    let central = fourth - 4.0 * third * mean + 6.0 * second * square - 3.0 * square * square;
    let kurtosis = central / (variance * variance);
    CountLaw { mean, variance, kurtosis, error: 0.0, poisson: false, pmf: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(powers: [f64; 5]) -> Points {
        Points {
            truth: Known::exact(powers[1]),
            powers,
            error: 1e-14,
            eighth: None,
            lookups: Some([1.0, 0.5, 0.5, 0.5, 0.5]),
        }
    }

    #[test]
    fn two_coins_make_a_binomial_number() {
        // X = 0 or 1 with chance ½: variance ¼; two of them: mean 1, variance ½, kurtosis 2.
        let coin = points([1.0, 0.5, 0.5, 0.5, 0.5]);
        let both = coin.plus(&coin);
        assert_eq!(both.powers, [1.0, 1.0, 1.5, 2.5, 4.5]);
        let prediction = both.prediction();
        let moments = prediction.channels[0].moments.expect("moments");
        assert!((moments.variance() - 0.5).abs() < 1e-15);
        assert!((moments.kurtosis().expect("spread") - 2.0).abs() < 1e-14);
        let lookups = prediction.lookups.expect("lookups");
        assert_eq!([lookups.mean, lookups.variance], [1.0, 0.5]);
    }

    #[test]
    fn a_spread_that_rounding_hides_is_unknown() {
        let faint = points([1.0, 1.0, 1.0 + 1e-16, 1.0, 1.0]);
        assert!(faint.prediction().channels[0].moments.is_none());
    }
}
