//! Spectral and next-event multiple importance sampling with errors of its source as printed: biased, so that the
//! gate must fail it.
//!
//! Unbiased for: never: it is here to be caught.
//!
//! | `error` | as printed | what is right |
//! |---|---|---|
//! | `"last-piece"` | Algorithm 2, line 9 returns before f and both densities have the transmittance of the last piece | it multiplies all three |
//! | `"average"` | Algorithm 2, line 9 averages over 2N techniques, and both samples are added | the sum over N |
//! | `"hits-alone"` | Algorithm 1 divides hits by `p_uni` alone, beside shadow rays | by `p_uni + p_nee` |
//! | `"one-phase"` | Algorithm 1, line 14 and Algorithm 2, lines 3 and 5 have one phase function for all channels | that of each channel |
//! | `"all"` | all of them | |
//!
//! | setting | meaning | default |
//! |---|---|---|
//! | `error` | which | `"all"` |
//! | `sampling` | a constant σ̂ ≥ σ_t in each channel | required here or in the case |
//!
//! Otherwise it is `next-event-mis`, with the exit that Algorithm 1 lacks. A case that lists it declares
//! `expect = "biased"`, and the record contains the bias of each channel.
//!
//! Source: B. Miller, I. Georgiev, W. Jarosz, *A null-scattering path integral formulation of light
//! transport*, ACM Transactions on Graphics 38 (2019), Algorithms 1 and 2.
//!
//! ```toml
//! title = "An example of as-printed"
//! expect = "biased"
//!
//! [problem.rod]
//! medium = [1.1, 1, 0.9]
//! span = [0, 2]
//! albedos = [0.8, 0.75, 0.7]
//! forward = [0.75, 0.75, 0.75]
//! light = "emitter"
//! sampling = 1.6
//! estimators = [{ as-printed.error = "all" }]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::events::{PathTechnique, WalkEvents};
use super::pages;
use crate::Estimator;
use crate::Traits;
use crate::setup::heroes::Heroes;
use crate::walks::hero::{LastPiece, Weighing};
use media::catalogue::Settings;
use theory::problems::SpectralLitRod;
use theory::rod::lit::spectral::LitTracker;

/// Error of the printed algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Error {
    /// All errors below.
    All,
    /// f and densities lack the transmittance of a shadow ray's last piece.
    LastPiece,
    /// Shadow rays are divided by the mean over both techniques.
    Average,
    /// Hits are divided by the densities of hits alone.
    HitsAlone,
    /// The phase function is that of the hero in all channels.
    OnePhase,
}

/// The errors by their words.
const WORDS: [(&str, Error); 5] = [
    ("all", Error::All),
    ("last-piece", Error::LastPiece),
    ("average", Error::Average),
    ("hits-alone", Error::HitsAlone),
    ("one-phase", Error::OnePhase),
];

/// The algorithm with an error.
#[derive(Debug, Clone)]
pub struct AsPrinted {
    /// Error of the printed algorithm.
    pub error: Error,
}

impl AsPrinted {
    #[inline(always)]
    fn has(&self, error: Error) -> bool {
        self.error == error || self.error == Error::All
    }
}

impl WalkEvents for AsPrinted {
    #[inline(always)]
    fn heroes(&self) -> &Heroes {
        &Heroes::Uniform
    }

    #[inline(always)]
    fn has_shadow_rays(&self) -> bool {
        true
    }

    #[inline(always)]
    fn weighing(&self, light: PathTechnique) -> Weighing {
        let right = Weighing::RIGHT;
        if light == PathTechnique::Connected {
            let is_early = self.has(Error::LastPiece);
            let last_piece = if is_early { LastPiece::Nowhere } else { LastPiece::Everywhere };
            let share = if self.has(Error::Average) { 0.5 } else { 1.0 };
            Weighing { last_piece, share, ..right }
        } else {
            let has_next_event = light == PathTechnique::Hit && !self.has(Error::HitsAlone);
            Weighing { has_next_event, ..right }
        }
    }

    #[inline(always)]
    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        if self.has(Error::OnePhase) { hero } else { channel }
    }
}

impl Estimator<SpectralLitRod> for AsPrinted {
    fn read(settings: &Settings) -> Option<Self> {
        let words = WORDS.map(|(word, _)| word);
        let word = settings.word_or("error", &words, words[0])?;
        let error = WORDS.iter().find(|(known, _)| *known == word).map(|(_, error)| *error);
        error.map(|error| Self { error })
    }

    fn traits(&self) -> Traits {
        let word = WORDS.iter().find(|(_, error)| *error == self.error);
        let settings = word.map_or_else(String::new, |(word, _)| (*word).to_owned());
        Traits { settings, ..Traits::of(Self::INPUTS) }
    }

    pages!(self => Heroes::Uniform, LitTracker::Mis { casts: true });
}
