//! A constant σ̂ learned from pilot rays: the largest |residual| seen so far, times a safety factor.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `rays` | number of pilot rays | | 8 |
//! | `safety` | factor on the largest `abs(σ_t − σ_c)` seen | | 1.2 |
//! | `start` | σ̂ of the first pilot ray | 1/length | 10 / length of the support |
//!
//! Each pilot ray walks with the σ̂ learned from those before it and looks σ_t up where it collides.
//! The result is never assumed to be a majorant: where it is too small, estimators that need a majorant are refused.
//! Pilot rays have their own random numbers, and their result is part of the plan. Their lookups are counted as
//! setup lookups of the ray.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4.3 ("we set it to the maximum obtained during casting
//! the last few neighboring rays").
//!
//! ```toml
//! title = "An example of pilot"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling.pilot.rays = 100
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::{Domain, Settings};
use media::{Body, Control, Piecewise};
use numeric::rng::{Address, exponential};

/// Largest expected number of collisions of a pilot ray; more are a mistake in the case.
const MAX_COLLISIONS: f64 = 1e6;

/// Recipe for a constant σ̂ from the lookups of pilot rays.
#[derive(Debug, Clone, Copy)]
pub struct Pilot {
    rays: u64,
    safety: f64,
    start: Option<f64>,
}

impl FromSettings for Pilot {
    const EXTINCTIONS: &'static [&'static str] = &["start"];

    fn read(settings: &Settings, _: Option<&Body>) -> Option<Self> {
        let rays = settings.count_or("rays", 1..=10_000, 8);
        let safety = settings.number_or("safety", Domain::Positive, 1.2);
        let start = settings.optional("start", |key| settings.number(key, Domain::Positive));
        Some(Self { rays: rays?, safety: safety?, start: start.ok()? })
    }
}

impl Recipe for Pilot {
    fn label(&self) -> String {
        format!("pilot, {} rays", self.rays)
    }

    fn learns(&self) -> bool {
        true
    }

    fn prepare(&self, site: &Site, control: &Control) -> Result<Piecewise, Refusal> {
        self.prepare_counted(site, control).map(|(sampling, _)| sampling)
    }

    fn prepare_counted(&self, site: &Site, control: &Control) -> Result<(Piecewise, u64), Refusal> {
        let support = site.mesh.support();
        if support.is_empty() {
            return Ok((Piecewise::constant(0.0, support), 0));
        }
        let medium = site.mesh.medium();
        let mut sampling = self.start.unwrap_or(10.0 / support.length());
        let (mut largest, mut lookups) = (0.0f64, 0);
        for ray in 0..self.rays {
            let mut rng = Address { block: ray, ..site.address }.pilot();
            let collisions = sampling * support.length();
            if collisions.is_nan() || collisions > MAX_COLLISIONS {
                let needs = "at most a million collisions of a pilot ray";
                return Err(Refusal::mismatch(needs, format!("{collisions:.1e} are expected")));
            }
            let flown = Piecewise::constant(sampling, support);
            let mut cursor = flown.begin();
            while cursor.fly(exponential(&mut rng)).is_some() {
                let residual = medium.extinction(cursor.t()) - control.extinction(cursor.t());
                largest = largest.max(residual.abs());
                lookups += 1;
            }
            if largest > 0.0 {
                sampling = self.safety * largest;
            }
        }
        Ok((Piecewise::constant(sampling, support), lookups))
    }
}
