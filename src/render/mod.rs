//! Picture as written: a volume, a camera, and estimators that are compared pixel by pixel.
//!
//! | key | meaning | default |
//! |---|---|---|
//! | `title` | one line above the picture | required |
//! | `caption` | what to see in it, in a few sentences below the title | none |
//! | `picture.NAME` | the subject: `transmittance` (before the sky; in colour where `volume` is a list of three), `single-scattering` (of a point light) or `multiple-scattering` (of the sky) | required |
//!
//! Within `[picture.NAME]`:
//!
//! | key | meaning | default |
//! |---|---|---|
//! | `size = [columns, rows]` | pixels, one ray through the middle of each | required |
//! | `lookups` | lookups of σ_t per pixel that the volume covers, for every estimator | required |
//! | `volume.NAME = { … }` | a field in space, bounded; in colour a list of three, for red, green and blue: `[{ NAME = { … } }, …]` | required |
//! | `camera = { position, target, up, angle }` | pinhole camera; degrees from the lower to the upper edge | up `[0, 1, 0]`, angle 40 |
//! | `sky.constant = { radiance }` | the sky behind the volume | radiance 1 |
//! | `sky.gradient = { ground, horizon, zenith, up, sun, glare, sharpness }` | radiances straight below, at the horizon and above, and `glare · exp(sharpness (cos − 1))` about the sun | .2, 1, .5, y, y, 0, 50 |
//! | `sampling`, `control`, `estimators` | as in a case; an estimator may have its own `expect = "biased"` | |
//! | `shared-control` | number of columns and rows of pixels that share the control fitted to the ray in their middle | 1 |
//! | `reference.closed-form = {}` | from the exact optical depth, or for a white furnace | |
//! | `reference.quadrature = { panels }` | Gauss quadrature along the ray, not for multiple scattering; its error is the difference to half as many panels | 16 panels |
//! | `reference.draws = { lookups, estimator }` | many draws of one estimator, with their measured error | |
//! | `light`, `albedo`, `phase` | as in the problem `single-scattering`; multiple scattering takes no light | |
//!
//! Every pixel gets the same number of draws, to within one, such that the estimator takes `lookups` per covered pixel
//! on average, as the paper compares. The number is fixed before the first draw, from the expected lookups by theory
//! (`transmittance`) or by pilot draws with random numbers of their own, which are counted separately. Explorer points
//! count as lookups, once for each ray that a control is fitted to; the controls `mean` and `minimum` come from theory
//! and cost none. A pixel that the volume does not cover costs neither lookups nor random numbers. RMSE and figure of
//! merit are over the covered pixels, and over their channels:
//!
//! ```text
//! MSE = mean of (image − reference)²,   figure of merit = 1/(MSE · lookups per pixel)
//! ```
//!
//! Source: L. Szirmay-Kalos, I. Georgiev, M. Magdics, B. Molnár, D. Légrády, *Unbiased Light
//! Transport Estimators for Inhomogeneous Participating Media*, Computer Graphics Forum 36 (2017),
//! section 4.

mod budget;
mod pixel;
pub mod record;
mod scene;
mod subject;
pub(crate) mod view;

use std::path::Path;

use self::scene::{PictureScene, RenderRequest};
use self::subject::SUBJECTS;
use crate::case::spec::BuiltIn;
use crate::case::{CaseError, CaseText, Spec};
use media::catalogue::{OwnPages, Page, Settings};

pub use record::PictureRecord;

/// Manual of picture files.
pub const CATALOGUE: &[Page] = &[Page { module: "picture", source: include_str!("mod.rs") }];

/// Picture file that was read.
pub struct Picture {
    /// Its name.
    pub name: String,
    /// One line above it.
    pub title: String,
    /// Sentences below the title that say what to see; may be empty.
    pub caption: String,
    /// The problem's name in the catalogue.
    pub problem: String,
    scene: PictureScene,
}

impl Picture {
    /// Reads a picture, with pages that the program adds.
    ///
    /// # Errors
    ///
    /// Every mistake in the file.
    pub fn read(source: &CaseText, own_pages: &OwnPages) -> Result<Self, CaseError> {
        Spec::parse(source, own_pages)?.read(|root| Self::from_root(source, root))
    }

    fn from_root(source: &CaseText, root: &Settings) -> Option<Self> {
        if let (Some(case), false) = (root.entry("problem"), root.has("picture")) {
            let help = "run it with `trueflight run`; a picture has `[picture.NAME]`";
            root.fault_at(case.key_span.clone(), "", "this is a case, not a picture", help);
            return None;
        }
        let title = root.text("title");
        let caption = if root.has("caption") { root.text("caption") } else { Some(String::new()) };
        let mut names = SUBJECTS.each_ref().map(|kind| kind.name.to_owned()).to_vec();
        names.dedup();
        let chosen = root.chosen("picture", &names);
        let scene = chosen.and_then(|(index, settings)| {
            let scene = PictureScene::read(subject::kind(&names[index], &settings)?, &settings);
            settings.close();
            Some((names[index].clone(), scene?))
        });
        root.close();
        let (problem, scene) = scene?;
        Some(Self { name: source.name.clone(), title: title?, caption: caption?, problem, scene })
    }

    /// Reads a picture file, or a built-in picture.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or has mistakes, all of which are listed.
    pub fn open(name: &str, own_pages: &OwnPages) -> Result<Self, CaseError> {
        match find(name) {
            Some(source) if !Path::new(name).exists() => Self::read(&source, own_pages),
            _ => Self::read(&CaseText::read(Path::new(name))?, own_pages),
        }
    }

    /// Returns the number of rows of pixels.
    pub fn rows(&self) -> usize {
        self.scene.view.size[1]
    }

    /// Renders the picture with a seed; `progress` is called after every row, twice.
    pub fn render(&self, seed: u64, progress: &(dyn Fn() + Sync)) -> PictureRecord {
        let rendered = self.scene.render(&RenderRequest { seed, name: &self.name, progress });
        let words = [&self.name, &self.title, &self.caption, &self.problem];
        PictureRecord::new(words, &self.scene.view, rendered)
    }
}

macro_rules! pictures {
    ($($name:literal,)*) => {
        BuiltIn {
            folder: "pictures/",
            files: &[$(($name, include_str!(concat!("../../pictures/", $name, ".toml")))),*],
        }
    };
}

/// The built-in pictures, in the order of the gallery.
const PICTURES: BuiltIn = pictures![
    "figure-6",
    "figure-7",
    "figure-9",
    "figure-10",
    "figure-12-300",
    "figure-12-50",
    "white-furnace",
    "spectral-noise",
    "spectral-density",
];

/// Returns every built-in picture, in the order of the gallery.
pub fn gallery() -> Vec<CaseText> {
    PICTURES.all()
}

/// Returns the built-in picture of a name.
pub fn find(name: &str) -> Option<CaseText> {
    PICTURES.find(name)
}
