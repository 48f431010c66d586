//! The form of `rod` with `sensor`: light of each order of scattering.

use std::ops::RangeInclusive;
use std::slice;

use super::{Problem, ProblemOption, default_albedo, number};
use media::catalogue::Settings;
use media::{Body, Medium};

/// The highest number of scatterings.
pub const HIGHEST_ORDER: usize = 5;
/// The most channels of a draw: 3 + 4 + … + 8 techniques and their sum.
pub const MAX_CHANNELS: usize = 34;

/// The values of one draw, one per channel.
pub type BidirectionalValues = super::Values<MAX_CHANNELS>;

/// Place of the sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensor {
    /// Sensor at the end.
    Transmitted,
    /// Sensor at the beginning.
    Reflected,
}

/// A rod between a light and a sensor.
pub struct BidirectionalRod {
    medium: Medium,
    /// a.
    pub albedo: f64,
    /// `p_f`.
    pub forward: f64,
    /// Place of the sensor.
    pub sensor: Sensor,
    /// Numbers of scatterings, up to [`HIGHEST_ORDER`].
    pub orders: RangeInclusive<usize>,
    /// True if the contribution of each technique is a channel beside their sum.
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
    type Value = BidirectionalValues;

    const OPTIONS: &'static [ProblemOption] = &[ProblemOption::Sensor];

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
        let minimum = u64::from(sensor == Some(Sensor::Reflected));
        let highest = settings.count("orders", minimum..=HIGHEST_ORDER as u64);
        let lowest =
            settings.count_or("lowest", minimum..=highest.unwrap_or(HIGHEST_ORDER as u64), minimum);
        let has_shares = settings.flag_or("shares", true);
        let (medium, scattered) = (body?.medium(), [albedo?, forward?]);
        let orders = lowest? as usize..=highest? as usize;
        let rod = Self::new(medium, scattered, sensor?, orders);
        Some(Self { has_shares: has_shares?, ..rod })
    }

    fn media(&self) -> &[Medium] {
        slice::from_ref(&self.medium)
    }

    fn with_albedo(&self, albedo: f64) -> Option<Self> {
        let (medium, orders) = (self.medium.clone(), self.orders.clone());
        Some(Self { medium, albedo, orders, ..*self })
    }
}
