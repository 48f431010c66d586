//! Volume, camera, estimators and reference of a picture: both passes over all pixels.

use std::sync::OnceLock;

use super::budget::{PixelDraws, PixelPlan, PixelValues};
use super::pixel::{Label, Listed, Pixel};
use super::subject::{PictureSubject, RayOf, SubjectKind};
use super::view::View;
use crate::case::estimator::{self, Defaults, Estimators, ParsedEstimator};
use estimators::trial::Entry;
use media::Body;
use media::catalogue::Settings;
use numeric::Known;
use numeric::rng::{Address, name_hash};
use theory::parallel;

/// Options of a rendering.
pub struct RenderRequest<'a> {
    /// The seed of all random numbers.
    pub seed: u64,
    /// The picture's name.
    pub name: &'a str,
    /// Called after every row of the first pass and of the second.
    pub progress: &'a (dyn Fn() + Sync),
}

/// Results for all covered pixels.
pub struct Rendered {
    /// Budget of lookups per covered pixel.
    pub budget: u64,
    /// Number of channels of a pixel.
    pub channels: usize,
    /// The numbers of the covered pixels.
    pub covered: Vec<usize>,
    /// Method of the reference in words, and its values.
    pub reference: (String, PixelValues),
    /// Values of each estimator, or the reason why it has no image.
    pub images: Vec<(Label, Result<PixelValues, String>)>,
}

/// Volume, camera and estimators of one problem.
pub struct PictureScene {
    /// The camera's view.
    pub view: View,
    kind: &'static SubjectKind,
    ray_of: RayOf,
    estimators: Estimators,
    lookups: u64,
    reference: Reference,
}

impl PictureScene {
    /// Reads the settings of `[picture.NAME]`.
    pub fn read(kind: &'static SubjectKind, settings: &Settings) -> Option<Self> {
        let view = View::read(settings, kind.shows_sky, kind.channels > 1);
        // Recipes are read for the ray of the first pixel, and prepared for each.
        let body = view.as_ref().and_then(|view| {
            let mut channels = view.bodies(view.ray(0)?);
            let name = view.medium.clone();
            let is_one = channels.len() == 1;
            Some(if is_one { channels.remove(0) } else { Body::Spectral { name, channels } })
        });
        let body = body.as_ref();
        let lookups = settings.count("lookups", 1..=1_000_000_000);
        // Lookups of pilot rays would not be charged: pictures compare at equal lookups.
        let sampling = settings.has("sampling");
        let defaults = Defaults { sampling, counts_lookups: true, ..Defaults::default() };
        let (ray_of, estimators, reference) = (kind.read)(settings, view.as_ref(), body, defaults)?;
        Some(Self { view: view?, kind, ray_of, estimators, lookups: lookups?, reference })
    }

    fn label(&self, parsed: &ParsedEstimator) -> Label {
        let sampling = self.estimators.sampling_of(parsed).map(|recipe| match recipe.constant() {
            Some(value) => value.to_string(),
            None => recipe.label(),
        });
        Label {
            estimator: parsed.label(true),
            sampling: sampling.unwrap_or_default(),
            control: self.estimators.control_of(parsed).label(),
        }
    }

    /// Calls `f` for every covered pixel, on all threads, and returns the results in the order of the pixels.
    fn over<T: Send>(
        &self,
        covered: &[usize],
        progress: &(dyn Fn() + Sync),
        f: impl Fn(usize, &Pixel) -> T + Sync,
    ) -> Vec<T> {
        let [width, height] = self.view.size;
        let row = |row: usize| {
            let first = covered.partition_point(|&pixel| pixel < row * width);
            let end = covered.partition_point(|&pixel| pixel < (row + 1) * width);
            let pixels = (first..end).filter_map(|i| {
                let pixel = Pixel::new(&self.view, self.kind, &self.ray_of, covered[i])?;
                Some(f(i, &pixel))
            });
            let answers: Vec<T> = pixels.collect();
            progress();
            answers
        };
        parallel::range(height, row).into_iter().flatten().collect()
    }

    /// Returns the estimators, and after them that of the reference if it is drawn.
    fn listed(&self, request: &RenderRequest) -> Vec<Listed<'_>> {
        let mut listed: Vec<Listed> = Vec::new();
        let reference = match &self.reference {
            Reference::Draws { lookups, parsed } => Some((&**parsed, *lookups, "reference")),
            _ => None,
        };
        let images = self.estimators.list.iter().map(|parsed| (parsed, self.lookups, "image"));
        for (index, (parsed, lookups, kind)) in images.chain(reference).enumerate() {
            let label = self.label(parsed);
            let namesakes = listed.iter().filter(|other| other.label == label).count();
            let Label { estimator, sampling, control } = &label;
            let words = format!("{estimator}|{sampling}|{control}|{namesakes}|{kind}");
            let address = |what: &str| {
                let experiment = name_hash(&format!("picture|{}|{words}|{what}", request.name));
                Address { seed: request.seed, experiment, block: 0, lane: 0 }
            };
            let space = OnceLock::new();
            let addresses = ["pilot", "draws"].map(address);
            listed.push(Listed { parsed, index, label, lookups, space, addresses });
        }
        listed
    }

    /// Plans and draws.
    pub fn render(&self, request: &RenderRequest) -> Rendered {
        let covered: Vec<usize> =
            (0..self.view.pixels()).filter(|&pixel| self.view.covered(pixel).is_some()).collect();
        let (listed, estimators) = (self.listed(request), &self.estimators);
        // First pass: cost and spread of a draw at every pixel.
        let forecasts = self.over(&covered, request.progress, |number, pixel| {
            let forecast = |listed: &Listed| pixel.forecast(number, estimators, listed);
            listed.iter().map(forecast).collect::<Vec<_>>()
        });
        let plan = |(index, listed): (usize, &Listed)| {
            let points = estimators.control_of(listed.parsed).lookups();
            PixelPlan::new(forecasts.iter().map(|all| &all[index]), points, listed.lookups)
        };
        let plans: Vec<Result<PixelPlan, String>> = listed.iter().enumerate().map(plan).collect();
        // Second pass: the draws.
        let pixels = self.over(&covered, request.progress, |number, pixel| {
            let draw = |(listed, plan): (&Listed, &Result<PixelPlan, String>)| {
                let draws = plan.as_ref().ok()?.draws_of(number);
                pixel.draw(number, estimators, listed, draws)
            };
            let drawn: Vec<Option<PixelDraws>> = listed.iter().zip(&plans).map(draw).collect();
            let answer = match self.reference {
                Reference::Exact => pixel.answer(None),
                Reference::Quadrature { panels } => pixel.answer(Some(panels)),
                Reference::Draws { .. } => None,
            };
            (drawn, answer)
        });
        let (pixels, answers): (Vec<_>, Vec<_>) = pixels.into_iter().unzip();
        let mut images: Vec<(Label, Result<PixelValues, String>)> = Vec::new();
        for (index, (listed, plan)) in listed.into_iter().zip(plans).enumerate() {
            let actual = plan.and_then(|plan| {
                let of_pixel = |all: &Vec<Option<PixelDraws>>| all[index];
                let pixels: Option<Vec<PixelDraws>> = pixels.iter().map(of_pixel).collect();
                pixels
                    .map(|pixels| plan.gather(self.kind.channels, &pixels))
                    .ok_or_else(|| "no image".to_owned())
            });
            images.push((listed.label, actual));
        }
        let reference = self.reference.of(&mut images, &answers);
        Rendered { budget: self.lookups, channels: self.kind.channels, covered, reference, images }
    }
}

/// Method of the reference.
pub enum Reference {
    /// In closed form.
    Exact,
    /// By Gauss quadrature.
    Quadrature {
        /// Number of panels of 16 nodes; twice as many are used.
        panels: usize,
    },
    /// By many draws of an estimator.
    Draws {
        /// Lookups per covered pixel.
        lookups: u64,
        /// The estimator.
        parsed: Box<ParsedEstimator>,
    },
}

/// Reference for problem `P`, and the entry that makes its draws.
pub type ReferenceOf<P> = (Reference, Option<Box<dyn Entry<P>>>);

impl Reference {
    /// Reads `reference`, with the entry that makes its draws if it is drawn. Its estimator takes the picture's σ̂ if
    /// it needs one.
    pub fn read<P: PictureSubject>(
        settings: &Settings,
        has_exact: bool,
        body: Option<&Body>,
        defaults: Defaults,
    ) -> Option<ReferenceOf<P>> {
        let names = ["closed-form", "quadrature", "draws"].map(str::to_owned);
        let (index, reference) = settings.chosen("reference", &names)?;
        let read = match index {
            0 if has_exact => Some((Self::Exact, None)),
            0 => {
                let help = "use `quadrature = {}` or `draws = { lookups, estimator }`";
                reference.fault_at(reference.span.clone(), "", "there is no closed form", help);
                None
            }
            1 if !P::ALONG_RAY => {
                let help = "use `draws = { lookups, estimator }`";
                reference.fault_at(reference.span.clone(), "", "there is no quadrature", help);
                reference.has("panels");
                None
            }
            1 => {
                let panels = reference.count_or("panels", 1..=100_000, 16);
                let panels = panels.and_then(|n| usize::try_from(n).ok());
                panels.map(|panels| (Self::Quadrature { panels }, None))
            }
            _ => {
                let lookups = reference.count("lookups", 1..=1_000_000_000);
                let read = reference
                    .naming("estimator", "the name of an estimator, or a table that it names")
                    .and_then(|table| estimator::read::<P>(&table, body, defaults));
                let (lookups, (parsed, entry)) = (lookups?, read?);
                Some((Self::Draws { lookups, parsed: Box::new(parsed) }, Some(entry)))
            }
        };
        reference.close();
        read
    }

    /// Returns the method in words, and the values: from the answers of all covered pixels, or the last of the images.
    pub fn of(
        &self,
        images: &mut Vec<(Label, Result<PixelValues, String>)>,
        answers: &[Option<Vec<Known>>],
    ) -> (String, PixelValues) {
        let how = match self {
            Self::Exact => "closed form".to_owned(),
            Self::Quadrature { panels } => format!("Gauss quadrature, {} nodes", 32 * panels),
            Self::Draws { .. } => {
                return match images.pop() {
                    Some((label, Ok(actual))) => {
                        (format!("many draws of {}", label.estimator), actual)
                    }
                    Some((_, Err(refusal))) => (format!("none: {refusal}"), PixelValues::default()),
                    None => Default::default(),
                };
            }
        };
        let answers = || answers.iter().flatten().flatten();
        let values = answers().map(|known| known.value).collect();
        let square_errors = answers().map(|known| known.error * known.error).collect();
        (how, PixelValues { values, square_errors, ..PixelValues::default() })
    }
}
