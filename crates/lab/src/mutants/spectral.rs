//! Wrong transmittances of chromatic media: heroes, densities and weights that do not fit together.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h p_h,  f and p of the whole null-collision path
//! ```
//!
//! Source of what goes wrong: the algorithms of B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path
//! Integral Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019), as printed and as they
//! are misread.
//!
//! `spectral-own-density`, a wrong density for each channel, is issue 323 of Mitsuba 2.

use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::Setup;
use estimators::setup::heroes::Heroes;
use estimators::spectral_transmittance::events::{Right, WalkEvents};
use estimators::spectral_transmittance::walk::AlongRay;
use estimators::walks::hero::HeroDistribution;
use gate::CheckId;
use numeric::Lane;
use numeric::rng::Random;
use theory::colours::Chance;
use theory::problems::SpectralTransmittance;
use theory::ray::spectral::Tracker;

/// A tracker; true if all channels have one σ̂.
type TrackerPlan = (Tracker, bool);

/// Three layers in three channels, one channel a draw.
const INDEPENDENT: On<TrackerPlan> =
    on("transmittance/spectral-layers", 0, (Tracker::Independent { delta: true }, false));
/// All channels by one walk, `σ̂ = 1.6, 1.1, 1.9`.
const MIS_RATIO: On<TrackerPlan> =
    on("transmittance/spectral-layers", 4, (Tracker::Mis { delta: false }, false));
/// All channels by delta tracking.
const MIS_DELTA: On<TrackerPlan> =
    on("transmittance/spectral-layers", 5, (Tracker::Mis { delta: true }, false));
/// Spectral tracking, `σ̂ = 1.9` for all channels, by the largest probabilities.
const MAXIMUM: On<TrackerPlan> =
    on("transmittance/spectral-layers", 9, (Tracker::Tracking(Chance::Maximum), true));
/// Spectral tracking, `σ̂ = 1.9` for all channels, by the history.
const HISTORY: On<TrackerPlan> =
    on("transmittance/spectral-layers", 10, (Tracker::Mis { delta: true }, true));

#[derive(Clone, Copy, PartialEq)]
enum Bug {
    None,
    ChoiceFree,
    Grey,
    Dropped,
    TwiceAsMany,
    ByLuminance,
    Anew,
    HerosMajorant,
    LastStretch,
    NullsInContributionOnly,
    OwnDensity,
    Raw,
    Forgotten,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<TrackerPlan, Bug>] = &[
    ("spectral-choice-free", "the one channel that is drawn is not divided by its probability", INDEPENDENT, CheckId::Mean, Bug::ChoiceFree),
    ("spectral-grey", "what the hero finds is scored for all channels", INDEPENDENT, CheckId::Mean, Bug::Grey),
    ("spectral-channel-dropped", "the last channel is missing from the denominator", MIS_RATIO, CheckId::Mean, Bug::Dropped),
    ("spectral-twice-as-many", "the densities are averaged over 2N techniques, of which N are drawn", MIS_RATIO, CheckId::Mean, Bug::TwiceAsMany),
    ("spectral-hero-luminance", "the hero is chosen by the luminance, and weighted as if all were alike", MIS_RATIO, CheckId::Mean, Bug::ByLuminance),
    ("spectral-hero-anew", "every collision has a new hero", MIS_DELTA, CheckId::Mean, Bug::Anew),
    ("spectral-heros-majorant", "the nulls of all channels are those of the hero's σ̂", MIS_RATIO, CheckId::Mean, Bug::HerosMajorant),
    ("spectral-last-stretch", "f and p lack the transmittance of the last stretch (Algorithm 2, line 9, as printed)", MIS_RATIO, CheckId::Mean, Bug::LastStretch),
    ("spectral-nulls-in-f-only", "the densities of delta tracking lack the probabilities of null collisions", MIS_DELTA, CheckId::Mean, Bug::NullsInContributionOnly),
    ("spectral-own-density", "each channel is divided by its own density", MIS_RATIO, CheckId::Mean, Bug::OwnDensity),
    ("spectral-maximum-raw", "the chance max n/μ̄ is not normalised where weights are divided by it", MAXIMUM, CheckId::Mean, Bug::Raw),
    ("spectral-history-forgotten", "the chance of history-aware tracking forgets the weights", HISTORY, CheckId::Variance, Bug::Forgotten),
];

/// The family.
pub fn mutants() -> Vec<Mutant<SpectralTransmittance>> {
    family(LINES, &Bug::None, |&(tracker, is_common), &bug| {
        one_by_one(move |setup: &Setup<SpectralTransmittance>, medium, random| {
            let count = setup.fields.len();
            let make = if is_common { AlongRay::common } else { AlongRay::new };
            let mut walk = make(setup, &Heroes::Uniform, tracker, Wrong { bug, count });
            if bug == Bug::ByLuminance {
                walk.distribution = HeroDistribution::new(&Heroes::Luminance, count);
            }
            walk.draw(medium, random)
        })
    })
}

/// The steps of a walk, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong {
    bug: Bug,
    /// The number of channels.
    count: usize,
}

impl WalkEvents for Wrong {
    const KEEPS_LAST: bool = true;

    fn decides<L: Lane>(&self, hero: L, inside: L::Mask, random: &mut impl Random<L>) -> L {
        if self.bug != Bug::Anew {
            return hero;
        }
        HeroDistribution::new(&Heroes::Uniform, self.count).choose(random.uniform_where(inside))
    }

    fn majorant<L: Lane>(&self, own: L, heros: impl Fn() -> L) -> L {
        if self.bug == Bug::HerosMajorant { heros() } else { own }
    }

    fn tracked<L: Lane>(&self, right: L, shares: &[L]) -> [L; 2] {
        match self.bug {
            Bug::Raw => {
                let largest =
                    shares.iter().fold(right.each(0.0), |maximum, &share| maximum.or_more(share));
                [right, largest]
            }
            Bug::Forgotten => [Chance::Average.of_null(shares); 2],
            _ => [right; 2],
        }
    }

    fn alone<L: Lane>(&self, is_hero: L::Mask, value: L, probability: f64) -> L {
        match self.bug {
            Bug::Grey => value,
            Bug::ChoiceFree => L::select(is_hero, value, value.each(0.0)),
            _ => Right.alone(is_hero, value, probability),
        }
    }

    fn density<L: Lane>(&self, delta: bool, contribution: L, relative: L) -> L {
        Right.density(delta && self.bug != Bug::NullsInContributionOnly, contribution, relative)
    }

    fn share(&self, probability: f64, is_last: bool) -> f64 {
        if self.bug == Bug::Dropped && is_last { 0.0 } else { probability }
    }

    fn divisor<L: Lane>(&self, mean: L, own: L) -> L {
        match self.bug {
            Bug::TwiceAsMany => mean * 0.5,
            Bug::OwnDensity => own,
            _ => mean,
        }
    }

    fn relative<L: Lane>(&self, right: L, [own, heros]: [L; 2], last: impl Fn() -> L) -> L {
        if self.bug == Bug::LastStretch { right * ((own - heros) * last()).exp() } else { right }
    }
}
