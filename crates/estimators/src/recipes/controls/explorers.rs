//! A straight line through σ_t at each of n explorer points.
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `points` | n ≥ 2 points, equally spaced over the support, its ends included | required |
//! | `octaves` | for noise: look only the first k octaves up at the points | all: exact |
//!
//! The n lookups are made once for each ray: they are its setup lookups.
//!
//! Between the points σ_t may lie above or below the control: the residual has both signs.
//!
//! Source: Szirmay-Kalos et al. 2017, section 4, Figure 5.
//!
//! ```toml
//! title = "An example of explorers"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling = 0.5
//! control.explorers.points = 5
//! estimators = ["double"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::Recipe;
use crate::recipes::{FromSettings, Refusal, Site};
use media::catalogue::Settings;
use media::{Body, Control, Piecewise};

/// A control through explorer points.
#[derive(Debug, Clone, Copy)]
pub struct Explorers {
    points: usize,
    octaves: Option<usize>,
}

impl FromSettings for Explorers {
    /// Reads `{ points, octaves }`.
    #[allow(clippy::cast_possible_truncation)] // at most 100000
    fn read(settings: &Settings, body: Option<&Body>) -> Option<Self> {
        let points = settings.count("points", 2..=100_000);
        let octaves = settings.optional("octaves", |key| {
            let octaves = settings.count(key, 1..=16)? as usize;
            let unknown = body.filter(|body| match body {
                Body::Volume { volume, .. } => volume.coarsened(octaves).is_none(),
                Body::Line { .. } | Body::Spectral { .. } => true,
            });
            if let Some(body) = unknown {
                let message = format!("`{}` has no octaves", body.name());
                settings.fault(key, message, "leave it out, or use the field `noise`");
                return None;
            }
            Some(octaves)
        });
        Some(Self { points: points? as usize, octaves: octaves.ok()? })
    }
}

impl Recipe for Explorers {
    fn label(&self) -> String {
        match self.octaves {
            None => format!("explorers {}", self.points),
            Some(octaves) => format!("explorers {}, {octaves} octaves", self.points),
        }
    }

    fn prepare(&self, site: &Site) -> Result<Control, Refusal> {
        let support = site.mesh.support();
        if support.is_empty() {
            return Ok(Control::None);
        }
        let (knots, values): (Vec<f64>, Vec<f64>) =
            self.points(site).into_iter().map(|[t, value]| (t, value)).unzip();
        Ok(Control::Pieces(Piecewise::lines(&knots, &values)))
    }

    fn with_points(&self, points: usize) -> Option<Box<dyn Recipe>> {
        (points >= 2).then(|| Box::new(Self { points, ..*self }) as Box<dyn Recipe>)
    }

    fn lookups(&self) -> usize {
        self.points
    }

    fn points(&self, site: &Site) -> Vec<[f64; 2]> {
        let support = site.mesh.support();
        if support.is_empty() {
            return Vec::new();
        }
        let last = self.points - 1;
        let mut knots: Vec<f64> =
            (0..last).map(|i| support.from + support.length() * (i as f64 / last as f64)).collect();
        knots.push(support.to);
        let coarse = match (site.body, self.octaves) {
            (Body::Volume { volume, .. }, Some(octaves)) => volume.coarsened(octaves),
            _ => None,
        };
        let look = |t: f64| match (&coarse, site.body) {
            (Some(volume), Body::Volume { ray, .. }) => volume.extinction_at(ray.at(t)),
            _ => site.mesh.medium().extinction(t),
        };
        knots.into_iter().map(|t| [t, look(t)]).collect()
    }
}
