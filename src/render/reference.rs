//! What an image is compared with.

use super::subject::Subject;
use crate::catalogue::Settings;
use crate::harness::written::{Usual, Written};
use crate::media::Body;

/// How the reference is found.
pub enum Reference<P> {
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
        written: Box<Written<P>>,
    },
}

impl<P: Subject> Reference<P> {
    /// Reads `reference`; estimators find a σ̂ that they need in the picture if it has one.
    pub fn read(
        settings: &Settings,
        shared: Option<&P::Shared>,
        body: Option<&Body>,
        usual: Usual,
    ) -> Option<Self> {
        let names = ["closed-form", "quadrature", "draws"].map(str::to_owned);
        let (index, reference) = settings.chosen("reference", &names)?;
        let read = match index {
            // What cannot be read has been told.
            0 if shared.is_none_or(P::has_exact) => Some(Self::Exact),
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
                panels.and_then(|n| usize::try_from(n).ok()).map(|n| Self::Quadrature { panels: n })
            }
            _ => {
                let lookups = reference.count("lookups", 1..=1_000_000_000);
                let estimator = reference.table("estimator");
                let written = estimator.and_then(|table| Written::read(&table, body, usual));
                let (lookups, written) = (lookups?, Box::new(written?));
                Some(Self::Draws { lookups, written })
            }
        };
        reference.close();
        read
    }
}
