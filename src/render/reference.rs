//! What an image is compared with.

use super::budget::PixelValues;
use super::pixel::Label;
use super::subject::Subject;
use crate::case::estimator::{self, Defaults, ParsedEstimator};
use estimators::trial::Entry;
use media::Body;
use media::catalogue::Settings;
use numeric::Known;

/// How the reference is found.
pub enum Reference {
    /// In closed form.
    Exact,
    /// By Gauss quadrature.
    Quadrature {
        /// How many panels of 16 nodes; twice as many are used.
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

/// Reference for problem `P`, and what makes its draws.
pub type ReferenceOf<P> = (Reference, Option<Box<dyn Entry<P>>>);

impl Reference {
    /// Reads `reference`, with what makes its draws if it is drawn; its estimator finds a σ̂ that it needs in the picture
    /// if it has one.
    pub fn read<P: Subject>(
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

    /// How it was found, in words, and what was found: from the answers of all covered pixels, or as
    /// the last of the images.
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
                    Some((label, Ok(found))) => {
                        (format!("many draws of {}", label.estimator), found)
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
