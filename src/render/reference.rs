//! What an image is compared with.

use super::budget::PixelValues;
use super::pixel::Label;
use super::subject::SubjectKind;
use crate::case::estimator::{Defaults, EntryReader, ParsedEstimator};
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

impl Reference {
    /// Reads `reference`; estimators find a σ̂ that they need in the picture if it has one.
    pub fn read(
        settings: &Settings,
        (kind, has_exact): (&SubjectKind, bool),
        body: Option<&Body>,
        reader: &mut dyn EntryReader,
        defaults: Defaults,
    ) -> Option<Self> {
        let names = ["closed-form", "quadrature", "draws"].map(str::to_owned);
        let (index, reference) = settings.chosen("reference", &names)?;
        let read = match index {
            0 if has_exact => Some(Self::Exact),
            0 => {
                let help = "use `quadrature = {}` or `draws = { lookups, estimator }`";
                reference.fault_at(reference.span.clone(), "", "there is no closed form", help);
                None
            }
            1 if !kind.along_ray => {
                let help = "use `draws = { lookups, estimator }`";
                reference.fault_at(reference.span.clone(), "", "there is no quadrature", help);
                reference.has("panels");
                None
            }
            1 => {
                let panels = reference.count_or("panels", 1..=100_000, 16);
                panels.and_then(|n| usize::try_from(n).ok()).map(|n| Self::Quadrature { panels: n })
            }
            _ => {
                let lookups = reference.count("lookups", 1..=1_000_000_000);
                let parsed = reference
                    .naming("estimator", "the name of an estimator, or a table that it names")
                    .and_then(|table| ParsedEstimator::read(&table, body, defaults, reader));
                let (lookups, parsed) = (lookups?, Box::new(parsed?));
                Some(Self::Draws { lookups, parsed })
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
