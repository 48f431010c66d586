//! Scattering points that are chosen one after the other: which, and how.

use crate::{Inputs, Setup};
use media::catalogue::Settings;
use theory::light::Heuristic;
use theory::problems::{Problem, SingleScattering};
use theory::single::{CameraTracking, Collisions};

/// Scattering points that are chosen one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vertices {
    /// Tracking of the transmittance from the ray's origin.
    pub camera: CameraTracking,
    /// True if there is a point from the light.
    pub light: bool,
    /// True if there is a point from the main part of the control.
    pub main: bool,
    /// Treatment of absorption on the way to the first real collision; `None` without such a point.
    pub collision: Option<Absorption>,
    /// True if a draw has only one of these points, chosen at random.
    pub is_one: bool,
    /// Heuristic that weights a point from the light and a collision.
    pub heuristic: Heuristic,
}

/// Effect of absorption on a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Absorption {
    /// The albedo is a factor of the score of a real collision.
    Weight,
    /// Absorption ends walks.
    Analog,
}

impl Absorption {
    /// Reads `absorption`.
    pub fn read(settings: &Settings) -> Option<Self> {
        let word = settings.word_or("absorption", &["weight", "analog"], "weight")?;
        Some(if word == "analog" { Self::Analog } else { Self::Weight })
    }

    /// The probability that a real collision scatters.
    #[inline(always)]
    pub fn scatters(self, albedo: f64) -> f64 {
        if self == Self::Analog { albedo } else { 1.0 }
    }

    /// Real collisions, as theory takes them.
    pub fn collisions(self, setup: &Setup<SingleScattering>) -> Collisions<'_> {
        let scatters = self.scatters(setup.problem.albedo());
        Collisions { medium: setup.problem.medium(), sampling: &setup.fields.sampling, scatters }
    }
}

impl Vertices {
    /// A point from the light with an exact transmittance from the ray's origin.
    pub const FROM_LIGHT: Self = Self {
        camera: CameraTracking::Exact,
        light: true,
        main: false,
        collision: None,
        is_one: false,
        heuristic: Heuristic::Balance,
    };

    /// Reads `camera`, one of `words`.
    pub fn read(self, settings: &Settings, words: &[&'static str]) -> Option<Self> {
        let camera = match settings.word_or("camera", words, "exact")? {
            "ratio" => CameraTracking::Ratio,
            "delta" => CameraTracking::Delta,
            _ => CameraTracking::Exact,
        };
        Some(Self { camera, ..self })
    }

    /// True if there is a point from the light or from the main part.
    pub fn is_chosen(self) -> bool {
        self.light || self.main
    }

    /// Returns the settings in words.
    pub fn label(self) -> String {
        let Self { camera, is_one, heuristic, .. } = self;
        let Some(absorption) = self.collision else {
            let word = match camera {
                CameraTracking::Exact => "exact",
                CameraTracking::Ratio => "ratio",
                CameraTracking::Delta => "delta",
            };
            return format!("{word} camera, ");
        };
        let said = [
            (camera == CameraTracking::Ratio, "null paths, "),
            (absorption == Absorption::Analog, "analog, "),
            (is_one, "one sample, "),
            (heuristic == Heuristic::Power, "power, "),
        ];
        said.iter().filter(|(is, _)| *is).map(|(_, word)| *word).collect()
    }

    /// Returns the inputs that the points need.
    pub fn inputs(self) -> Inputs {
        if self.collision.is_some() {
            return Inputs::SAMPLING;
        }
        let along = match self.camera {
            CameraTracking::Exact => Inputs::NONE,
            CameraTracking::Ratio => Inputs::BOTH,
            CameraTracking::Delta => Inputs::SAMPLING,
        };
        Inputs { control: along.control || self.main, ..along }
    }
}
