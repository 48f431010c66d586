//! The form of `slab` with `light`: what a camera sees of a light behind it by one scattering.

use std::f64::consts::{PI, TAU};
use std::slice;

use super::slab::read_cosine;
use super::{Problem, ProblemOption, default_albedo};
use media::catalogue::{Domain, Settings};
use media::phase::Phase;
use media::{Body, Medium};
use numeric::Lane;

/// Light behind the slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightBehind {
    /// All directions with at least this cosine with the normal.
    Cap(f64),
    /// A disc about the ray.
    Disc {
        /// Distance behind the slab.
        distance: f64,
        /// Radius.
        radius: f64,
    },
    /// A beam of irradiance 1, by its cosine with the normal.
    Distant(f64),
    /// A point of intensity 1 on the ray, at this distance behind the slab.
    Point(f64),
}

impl LightBehind {
    /// Returns whether a direction that is chosen by the phase function may meet it.
    pub fn can_be_hit(self) -> bool {
        matches!(self, Self::Cap(_) | Self::Disc { .. })
    }

    /// The lowest cosine at which its light arrives.
    pub fn lowest(self) -> f64 {
        match self {
            Self::Cap(cosine) | Self::Distant(cosine) => cosine,
            Self::Disc { distance, radius } => distance / distance.hypot(radius),
            Self::Point(_) => 1.0,
        }
    }

    /// A direction to it, chosen with a number in `[0, 1)`, from a point at a distance `before` the end of the slab:
    /// its cosine, and `1/p_nee`, sr; for a light that cannot be hit, the unit of its radiance.
    #[inline(always)]
    pub fn chosen<L: Lane>(self, number: L, before: L) -> [L; 2] {
        let one = number.each(1.0);
        match self {
            Self::Cap(lowest) => [number * (1.0 - lowest) + lowest, self.spread(one, before)],
            Self::Disc { distance, radius } => {
                let away = before + distance;
                let square = away * away + number * (radius * radius);
                // μ = D/√(D² + uR²), A μ³/D².
                let cubic = away / (square * square.root());
                [cubic * square, cubic * (PI * radius * radius)]
            }
            Self::Distant(cosine) => [one.each(cosine), one],
            Self::Point(distance) => {
                let away = before + distance;
                [one, one / (away * away)]
            }
        }
    }

    /// `1/p_nee` of a direction that meets the light; 0 for a light without a size, which no direction meets.
    #[inline(always)]
    pub fn spread<L: Lane>(self, cosine: L, before: L) -> L {
        match self {
            Self::Cap(lowest) => cosine.each(TAU * (1.0 - lowest)),
            Self::Disc { distance, radius } => {
                let away = before + distance;
                cosine * cosine * cosine * (PI * radius * radius) / (away * away)
            }
            Self::Distant(_) | Self::Point(_) => cosine.each(0.0),
        }
    }

    /// Returns whether a direction meets it.
    #[inline(always)]
    pub fn is_met<L: Lane>(self, cosine: L, before: L) -> L::Mask {
        let zero = cosine.each(0.0);
        match self {
            Self::Cap(lowest) => cosine.each(lowest).at_most(cosine),
            Self::Disc { distance, radius } => {
                let away = before + distance;
                let square = cosine * cosine;
                let across = (zero + 1.0 - square) * (away * away);
                zero.below(cosine) & across.at_most(square * (radius * radius))
            }
            Self::Distant(_) | Self::Point(_) => zero.below(zero),
        }
    }
}

/// A slab with a light behind it.
pub struct LitSlab {
    medium: Medium,
    /// a.
    pub albedo: f64,
    /// p.
    pub phase: Phase,
    /// Light behind the slab.
    pub light: LightBehind,
}

impl LitSlab {
    /// A slab with an albedo in `(0, 1]`; the distance along a medium is its depth.
    pub fn new(medium: Medium, albedo: f64, phase: Phase, light: LightBehind) -> Self {
        Self { medium, albedo, phase, light }
    }

    /// The end of the slab, which lights are behind.
    #[inline(always)]
    pub fn end(&self) -> f64 {
        self.medium.span().to
    }
}

impl Problem for LitSlab {
    type Value = [f64; 1];

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Light];

    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedo = super::number(settings, "albedo", default_albedo(settings));
        let phase = Phase::read(settings);
        let light = read_light(settings);
        let (key, medium) = match body? {
            body @ Body::Volume { .. } => ("ray", body.medium()),
            body => ("medium", body.medium()),
        };
        if medium.optical_depth(medium.support()).value <= 0.0 {
            let actual = "nothing scatters: σ_t = 0 along the ray";
            settings.fault(key, actual, "give the slab some extinction");
            return None;
        }
        if albedo == Some(0.0) {
            let actual = "nothing scatters: `albedo` is 0";
            settings.fault("albedo", actual, "it takes a number above 0 and up to 1");
            return None;
        }
        Some(Self::new(medium, albedo?, phase?, light?))
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        Some(Self::new(self.medium.clone(), albedo, self.phase, self.light))
    }
}

fn read_light(settings: &Settings) -> Option<LightBehind> {
    let names = ["cap", "disc", "distant", "point"].map(str::to_owned);
    let (index, light) = settings.chosen("light", &names)?;
    let length = |key: &'static str| light.number(key, Domain::Positive);
    let read = match index {
        0 => {
            let help = "the light is behind the slab, and has a size: 0 < cosine < 1";
            read_cosine(&light, |cosine| cosine < 1.0, help).map(LightBehind::Cap)
        }
        1 => {
            let (distance, radius) = (length("distance"), length("radius"));
            distance.zip(radius).map(|(distance, radius)| LightBehind::Disc { distance, radius })
        }
        2 => {
            let help = "the light is behind the slab: 0 < cosine ≤ 1";
            read_cosine(&light, |cosine| cosine <= 1.0, help).map(LightBehind::Distant)
        }
        _ => length("distance").map(LightBehind::Point),
    };
    light.close();
    read
}

#[cfg(test)]
mod tests {
    use super::*;
    use numeric::quadrature::GaussLegendre;

    #[test]
    fn chosen_directions_meet_the_light_and_have_its_density() {
        // ∫ dω = ∫ 2π dμ over the light is ∫ du/p_nee: Ω of a cap, 2π(1 − D/√(D² + R²)) of a disc.
        let rule = GaussLegendre::new(40);
        let disc = LightBehind::Disc { distance: 0.5, radius: 0.7 };
        for (light, before) in [(LightBehind::Cap(0.3), 0.2), (disc, 0.4)] {
            let lowest = if light == disc { 0.9 / 0.9f64.hypot(0.7) } else { 0.3 };
            let actual = rule.integrate(0.0, 1.0, |u| {
                let [cosine, spread] = light.chosen(u, before);
                assert!(light.is_met(cosine, before));
                assert!(!light.is_met(lowest - 1e-9, before) && !light.is_met(-cosine, before));
                assert!((light.spread(cosine, before) / spread - 1.0).abs() < 1e-14);
                spread
            });
            assert!((actual - TAU * (1.0 - lowest)).abs() < 1e-13, "{light:?}: {actual}");
        }
        assert_eq!(disc.lowest(), 0.5 / 0.5f64.hypot(0.7));
    }

    #[test]
    fn lights_without_size_are_met_by_shadow_rays_only() {
        for light in [LightBehind::Distant(0.8), LightBehind::Point(2.0)] {
            let [cosine, _] = light.chosen(0.4, 1.0);
            assert!(!light.can_be_hit() && !light.is_met(cosine, 1.0));
            assert_eq!(light.spread(cosine, 1.0), 0.0);
        }
        assert_eq!(LightBehind::Distant(0.8).chosen(0.4, 3.0), [0.8, 1.0]);
        assert_eq!(LightBehind::Point(2.0).chosen(0.4, 3.0), [1.0, 0.04]);
    }
}
