//! Walkers that score all channels, and the densities by which their draws are divided.

use super::channels::{self, require_common, require_room};
use super::heroes::Heroes;
use super::{ChannelFields, Refusal};
use media::catalogue::Settings;
use media::phase::Phase;
use numeric::digits::rounded;
use theory::colours::bound::{self, Reason, Unbounded};
use theory::colours::rates::Proposal;
use theory::colours::{Chance, Chances};

/// The walk that scores all channels.
#[derive(Debug, Clone, PartialEq)]
pub enum Walker {
    /// Walk of a hero, divided by its density alone.
    Hero(Heroes),
    /// Walk of a hero, divided by the mean density of all heroes: multiple importance sampling.
    Mis(Heroes),
    /// One walk of all channels, divided by the probabilities of its events: spectral tracking.
    SpectralTracking(Chances),
}

/// Kind of estimators that score one channel a draw, by the walk of a hero.
pub const INDEPENDENT: u8 = 0;
/// Kind of estimators by [`Walker::Hero`].
pub const HERO: u8 = 1;
/// Kind of estimators by [`Walker::Mis`].
pub const MIS: u8 = 2;
/// Kind of estimators by [`Walker::SpectralTracking`].
pub const SPECTRAL_TRACKING: u8 = 3;

/// Reads `probabilities`, by which spectral tracking chooses events.
pub fn read_chances(settings: &Settings) -> Option<Chances> {
    let words = ["average", "maximum", "history"];
    Some(match settings.word_or("probabilities", &words, "average")? {
        "average" => Chances::Fixed(Chance::Average),
        "maximum" => Chances::Fixed(Chance::Maximum),
        _ => Chances::History,
    })
}

impl Walker {
    /// Reads the settings of an estimator of a kind: `hero`, or `probabilities`.
    pub fn read(kind: u8, settings: &Settings) -> Option<Self> {
        if kind != SPECTRAL_TRACKING {
            let heroes = Heroes::read(settings)?;
            return Some(if kind == MIS { Self::Mis(heroes) } else { Self::Hero(heroes) });
        }
        Some(Self::SpectralTracking(read_chances(settings)?))
    }

    /// Label of the settings.
    pub fn label(&self) -> String {
        match self {
            Self::Hero(heroes) | Self::Mis(heroes) => heroes.label(),
            Self::SpectralTracking(chances) => chances.label().into(),
        }
    }

    /// Distribution of the hero; `None` where all channels walk together.
    #[inline(always)]
    pub fn heroes(&self) -> Option<&Heroes> {
        match self {
            Self::Hero(heroes) | Self::Mis(heroes) => Some(heroes),
            Self::SpectralTracking(_) => None,
        }
    }

    /// Probabilities of heroes; where all channels walk together, 1 for the first.
    pub fn probabilities(&self, count: usize) -> Vec<f64> {
        match self.heroes() {
            Some(heroes) => heroes.of(count),
            None => (0..count).map(|channel| if channel == 0 { 1.0 } else { 0.0 }).collect(),
        }
    }

    /// Choice of events where all channels walk together.
    #[inline(always)]
    pub fn together(&self) -> Option<Chances> {
        match self {
            Self::SpectralTracking(chances) => Some(*chances),
            _ => None,
        }
    }

    /// Requires a hero probability for each channel, or one σ̂ for all.
    ///
    /// # Errors
    ///
    /// The requirement that is violated, and its place.
    pub fn require(&self, of: &[ChannelFields]) -> Result<(), Refusal> {
        match self {
            Self::Hero(heroes) | Self::Mis(heroes) => heroes.require(of.len()),
            Self::SpectralTracking(_) => require_common(of),
        }
    }

    /// Requires also `σ̂ ≥ σ_t` on the ray. The hero of [`Self::Hero`] must also have the events of all channels.
    ///
    /// # Errors
    ///
    /// The requirement that is violated, and its place.
    pub fn require_on_ray(&self, of: &[ChannelFields]) -> Result<(), Refusal> {
        self.require(of)?;
        channels::require_majorants(of)?;
        match self {
            Self::Hero(_) => require_room(of, true),
            _ => Ok(()),
        }
    }

    /// Requires one phase function for all channels where they walk together: a walk has one direction.
    ///
    /// # Errors
    ///
    /// Two phase functions that differ.
    pub fn require_phases(&self, phases: &[Phase]) -> Result<(), Refusal> {
        let other = phases.iter().find(|phase| **phase != phases[0]);
        match (self, other) {
            (Self::SpectralTracking(_), Some(other)) => {
                let actual = format!("{} and {}", phases[0].label(), other.label());
                Err(Refusal::mismatch("one phase function for all channels", actual))
            }
            _ => Ok(()),
        }
    }

    /// Bounds on `E[X²]` of all channels. `of` returns the bound of a walk for a channel and its Φ. Its error is
    /// the factor, 1 or more, by which the second moment grows from one scattering to the next.
    ///
    /// # Errors
    ///
    /// The walk and the channel that have no bound.
    pub fn second_moment_bounds(
        &self,
        phases: &[Phase],
        of: impl Fn(Proposal, usize, f64) -> Result<f64, f64>,
    ) -> Result<Vec<f64>, Refusal> {
        let walks: Vec<(f64, Proposal)> = match self {
            Self::Hero(heroes) | Self::Mis(heroes) => {
                let heroes = heroes.of(phases.len());
                heroes.into_iter().enumerate().map(|(hero, w)| (w, Proposal::Hero(hero))).collect()
            }
            Self::SpectralTracking(Chances::Fixed(probability)) => {
                vec![(1.0, Proposal::Together(*probability))]
            }
            // Not needed: these walks are bounded as multiple importance sampling is.
            Self::SpectralTracking(Chances::History) => {
                return Ok(vec![f64::INFINITY; phases.len()]);
            }
        };
        bound::of_walks(&walks, phases, of).map_err(|unbounded| {
            let Unbounded { walk, channel, reason } = unbounded;
            let times = match reason {
                Reason::Grows(factor) => {
                    let factor = rounded(factor);
                    format!("multiply E[X²] by {factor}, not by less than 1, from one scattering to the next")
                }
                Reason::Unlimited => {
                    "lack what happens in another channel, which biases them, or gain without limit".into()
                }
                Reason::TooPeaked => "turn by a phase function too peaked for a bound".into(),
            };
            let walks = match walk {
                Proposal::Hero(hero) => format!("walks of hero {}", hero + 1),
                Proposal::Together(_) => "walks".into(),
            };
            let actual = format!("{walks} {times} in channel {}", channel + 1);
            Refusal::mismatch("a second moment that theory bounds", actual)
        })
    }
}
