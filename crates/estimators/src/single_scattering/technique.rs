//! What techniques are: all that packets and pages both know of them.

use crate::Setup;
use media::catalogue::Settings;
use numeric::Lane;
use theory::Heuristic;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Collisions};

/// The most points on one walk.
pub const MOST: usize = 16;

/// A technique.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Points from the light, from the main part of the control, or from both, each with a camera.
    Points {
        /// How the transmittance from the ray's origin is found.
        camera: CameraTracking,
        /// Whether points come from the light.
        from_source: bool,
        /// Whether points come from the main part.
        from_main: bool,
    },
    /// The first real collision.
    Collision(Absorption),
    /// A point from the light, the first real collision, or both.
    SourceAndCollision(Sharing),
    /// All interaction points.
    Interactions,
    /// One of them.
    Resampled,
    /// So many points on one walk.
    Shared(usize),
}

/// How a point from the light and a real collision share what they find.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sharing {
    /// x, exact or by null collisions.
    pub camera: CameraTracking,
    /// What absorption does to delta tracking.
    pub absorption: Absorption,
    /// Whether a draw is of one technique.
    pub is_one: bool,
    /// β.
    pub heuristic: Heuristic,
}

/// What absorption does to a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Absorption {
    /// It is a factor of what a real collision brings.
    Weight,
    /// It ends walks.
    Analog,
}

impl Absorption {
    /// Reads `absorption`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("absorption", &["weight", "analog"], "weight")?;
        Some(if word == "analog" { Self::Analog } else { Self::Weight })
    }

    /// The chance that a real collision scatters.
    #[inline(always)]
    pub fn scatters(self, albedo: f64) -> f64 {
        if self == Self::Analog { albedo } else { 1.0 }
    }

    /// For theory.
    pub fn collisions(self, setup: &Setup<SingleScattering>) -> Collisions<'_> {
        let scatters = self.scatters(setup.problem.albedo());
        Collisions { medium: setup.problem.medium(), sampling: &setup.sampling, scatters }
    }
}

/// The point from the light that a uniform number finds.
#[inline(always)]
pub fn point<L: Lane>(problem: &SingleScattering, u: L) -> L {
    let angles = problem.angles();
    problem.at_angle(u * angles.length() + angles.from)
}
