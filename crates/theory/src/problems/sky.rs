//! Light from all around.
//!
//! ```text
//! constant:  L(d) = radiance
//! gradient:  L(d) = horizon + (end − horizon) √|c| + glare · exp(sharpness (d·sun − 1)),   c = d·up,
//!            end = zenith where c ≥ 0, else ground
//! ```

use media::catalogue::{Domain, Settings};
use numeric::Lane;
use numeric::geometry::Point;

/// Light from outside, a function of the direction of looking.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sky {
    /// One radiance in all directions.
    Constant {
        /// Radiance.
        radiance: f64,
    },
    /// Gradient from the ground over the horizon to the zenith, and a soft sun.
    Gradient {
        /// Radiance straight below.
        ground: f64,
        /// Radiance at the horizon.
        horizon: f64,
        /// Radiance straight above.
        zenith: f64,
        /// Upwards.
        up: Point,
        /// Towards the sun.
        sun: Point,
        /// The radiance of the sun's middle.
        glare: f64,
        /// Sharpness of the sun: `glare · exp(sharpness (cos − 1))`.
        sharpness: f64,
    },
}

impl Sky {
    /// Reads `sky`; without it the same light of radiance 1 comes from everywhere.
    pub fn read(settings: &Settings) -> Option<Self> {
        if !settings.has("sky") {
            return Some(Self::Constant { radiance: 1.0 });
        }
        let (index, sky) = settings.chosen("sky", &["constant".into(), "gradient".into()])?;
        let radiance = |key, default| sky.number_or(key, Domain::NonNegative, default);
        let read = if index == 0 {
            radiance("radiance", 1.0).map(|radiance| Self::Constant { radiance })
        } else {
            let (ground, horizon, zenith) =
                (radiance("ground", 0.2), radiance("horizon", 1.0), radiance("zenith", 0.5));
            let (glare, sharpness) = (radiance("glare", 0.0), radiance("sharpness", 50.0));
            let up = direction(&sky, "up", [0.0, 1.0, 0.0]);
            let sun = direction(&sky, "sun", [0.0, 1.0, 0.0]);
            let (ground, horizon, zenith) = (ground?, horizon?, zenith?);
            let (up, sun, glare, sharpness) = (up?, sun?, glare?, sharpness?);
            Some(Self::Gradient { ground, horizon, zenith, up, sun, glare, sharpness })
        };
        sky.close();
        read
    }

    /// The radiance that comes against a direction of looking.
    pub fn radiance(&self, direction: Point) -> f64 {
        self.radiance_lanes(direction.0)
    }

    /// Radiances that come against packs of directions.
    #[inline(always)]
    pub fn radiance_lanes<L: Lane>(&self, direction: [L; 3]) -> L {
        let like = direction[0];
        match *self {
            Self::Constant { radiance } => like.each(radiance),
            Self::Gradient { ground, horizon, zenith, up, sun, glare, sharpness } => {
                let height = up.along(direction);
                let is_below = height.below(like.each(0.0));
                let end = L::select(is_below, like.each(ground), like.each(zenith));
                let share = height.size().root();
                let shine = ((sun.along(direction) - 1.0) * sharpness).exp();
                (end - horizon) * share + horizon + shine * glare
            }
        }
    }
}

fn direction(settings: &Settings, key: &'static str, default: [f64; 3]) -> Option<Point> {
    let direction = Point(settings.triple_or(key, default)?).normalised();
    if direction.is_none() {
        settings.fault(key, format!("`{key}` has no direction"), "it is a vector, as [0, 1, 0]");
    }
    direction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_meets_itself_at_the_horizon() {
        let (up, sun) = (Point([0.0, 1.0, 0.0]), Point([1.0, 0.0, 0.0]));
        let sky = Sky::Gradient {
            ground: 0.2,
            horizon: 0.9,
            zenith: 0.5,
            up,
            sun,
            glare: 3.0,
            sharpness: 100.0,
        };
        let radiance =
            |x: f64, y: f64| sky.radiance(Point([x, y, 0.0]).normalised().expect("a direction"));
        assert!((radiance(-1.0, 0.0) - 0.9).abs() < 1e-12);
        assert!((radiance(0.0, 1.0) - 0.5).abs() < 1e-12);
        assert!((radiance(0.0, -1.0) - 0.2).abs() < 1e-12);
        assert!((radiance(1.0, 0.0) - 3.9).abs() < 1e-12);
    }
}
