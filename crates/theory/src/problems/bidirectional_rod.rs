//! Light that is scattered a given number of times along a rod, by bidirectional path tracing.
//!
//! ```text
//! a light at the beginning shines forward; a sensor at the end of the rod, or at its beginning, sees what
//! leaves there after r scatterings:  I_r = ∫ ∏ᵢ a ρᵢ e^{−Σ dⱼ} du₁ … du_r,  u the optical depths of the scatterings
//! ```
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `medium` with `span = [from, to]` | a field in 1-D and where it is asked about | one of the two |
//! | `volume` with `ray = { origin, direction, length }` | a field in 3-D and a ray through it: the rod | is required |
//! | `albedo` | a in [0, 1], the same everywhere | required unless swept |
//! | `forward` | `p_f` in [0, 1], the probability that scattering keeps the direction | 0.5 |
//! | `sensor` | `"transmitted"`: at the end; `"reflected"`: at the beginning, beside the light | required |
//! | `orders` | the highest number of scatterings r, up to 5 | required |
//! | `lowest` | the lowest | 0, or 1 of reflected light |
//! | `shares` | whether the contribution of each technique is a channel beside their sum | true |
//! | `sampling` | σ̂ of every estimator without its own | required unless swept |
//! | `sweep` | one of `sampling`, `sampling-scale`, `albedo`, `density`, `albedo-scale` | none |
//! | `estimators` | what is tested | required |
//!
//! A path of r scatterings has r + 2 vertices, light and sensor included, and can be made in r + 3 ways: its
//! first s vertices from the light, s = 0 … r + 2, the others from the sensor. Channels are what each technique
//! contributes, `s = 0` to `s = r + 2` (of several orders `r = …, s = …`), and `sum`; the estimator `technique`
//! has one technique only, and no shares. A record therefore holds shares and second moments by technique.
//!
//! The light of one order is exact, and so are the shares, by integrals over the places of the scatterings: see
//! the theory of bidirectional rods. An experiment with a channel whose answer is 0 is refused: r > 0 where
//! a = 0, one scattering backward where `p_f = 1`, an odd number of scatterings forward where `p_f = 0`.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path Integral Formulation of Light Transport*,
//! ACM Transactions on Graphics 38 (2019), sections 5.2 and 5.5; the rod: that of `rod`.

use std::ops::RangeInclusive;

use super::{Problem, default_albedo, number};
use media::catalogue::Settings;
use media::{Body, Medium};

/// The highest number of scatterings.
pub const HIGHEST_ORDER: usize = 5;
/// The most channels of a draw: 3 + 4 + … + 8 techniques and their sum.
pub const MOST: usize = 34;

/// The values of one draw, one per channel.
pub type Values = super::Values<MOST>;

/// Where light is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    /// At the end.
    Transmitted,
    /// At the beginning.
    Reflected,
}

/// A rod between a light and a sensor.
pub struct BidirectionalRod {
    medium: Medium,
    /// a.
    pub albedo: f64,
    /// `p_f`.
    pub forward: f64,
    /// Where light is seen.
    pub sensor: Sensor,
    /// Numbers of scatterings, up to [`HIGHEST_ORDER`].
    pub orders: RangeInclusive<usize>,
    /// Whether the contribution of each technique is a channel beside their sum.
    pub has_shares: bool,
}

impl BidirectionalRod {
    /// A rod with an albedo and a probability to scatter forward, both in `[0, 1]`; techniques are channels.
    pub fn new(
        medium: Medium,
        [albedo, forward]: [f64; 2],
        sensor: Sensor,
        orders: RangeInclusive<usize>,
    ) -> Self {
        Self { medium, albedo, forward, sensor, orders, has_shares: true }
    }
}

impl Problem for BidirectionalRod {
    type Value = Values;

    #[allow(clippy::cast_possible_truncation)] // at most five
    fn read(body: Option<&Body>, settings: &Settings) -> Option<Self> {
        let albedo = number(settings, "albedo", default_albedo(settings));
        let forward = number(settings, "forward", Some(0.5));
        let sensor =
            settings.word("sensor", &["transmitted", "reflected"]).map(|word| match word {
                "reflected" => Sensor::Reflected,
                _ => Sensor::Transmitted,
            });
        // Light that comes back is scattered at least once.
        let least = u64::from(sensor == Some(Sensor::Reflected));
        let highest = settings.count("orders", least..=HIGHEST_ORDER as u64);
        let lowest =
            settings.count_or("lowest", least..=highest.unwrap_or(HIGHEST_ORDER as u64), least);
        let has_shares = settings.flag_or("shares", true);
        let (medium, scattered) = (body?.medium(), [albedo?, forward?]);
        let orders = lowest? as usize..=highest? as usize;
        let rod = Self::new(medium, scattered, sensor?, orders);
        Some(Self { has_shares: has_shares?, ..rod })
    }

    fn medium(&self) -> &Medium {
        &self.medium
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        let (medium, orders) = (self.medium.clone(), self.orders.clone());
        Some(Self { medium, albedo, orders, ..*self })
    }
}
