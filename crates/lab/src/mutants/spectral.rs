//! Wrong transmittances of chromatic media: heroes, densities and weights that do not fit together.
//!
//! ```text
//! X_λ = f_λ/Σ_h w_h p_h,  f and p of the whole null-collision path
//! ```
//!
//! Source of what goes wrong: the algorithms of B. Miller, I. Georgiev, W. Jarosz, *A Null-Scattering Path
//! Integral Formulation of Light Transport*, ACM Transactions on Graphics 38 (2019), as printed and as they
//! are misread.

use super::target::{
    SPECTRAL_HISTORY, SPECTRAL_INDEPENDENT, SPECTRAL_MAXIMUM, SPECTRAL_MIS_DELTA,
    SPECTRAL_MIS_RATIO,
};
use super::{About, Mutant, Target, with};
use estimators::setup::heroes::Heroes;
use estimators::spectral_transmittance::steps::{Right, Steps};
use estimators::spectral_transmittance::walk::AlongRay;
use estimators::walks::hero::Law;
use estimators::{Draw, Setup};
use media::Lookups;
use numeric::Lane;
use numeric::rng::{Random, Stream};
use theory::problems::SpectralTransmittance;
use theory::problems::spectral_transmittance::Values;
use theory::spectral::{Chance, Tracker};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralTransmittance>> {
    let of = |name, bug, target: Target, check, tracker: Tracker, slip| {
        let walker = (tracker, [SPECTRAL_MAXIMUM, SPECTRAL_HISTORY].contains(&target));
        let wrong = with((walker, slip), |&(walker, slip), setup, medium, rng| draw(walker, slip, setup, medium, rng));
        let right = with(walker, |&walker, setup, medium, rng| walk(walker, setup, Right).draw(medium, rng));
        Mutant::new(About { name, bug, target, check }, wrong, right)
    };
    let (ratio, delta) = (Tracker::Mis { delta: false }, Tracker::Mis { delta: true });
    let (independent, maximum) = (Tracker::Independent { delta: true }, Tracker::Tracking(Chance::Maximum));
    vec![
        of("spectral-choice-free", "the one channel that is drawn is not divided by its probability", SPECTRAL_INDEPENDENT, "mean", independent, Slip::ChoiceFree),
        of("spectral-grey", "what the hero finds is scored for all channels", SPECTRAL_INDEPENDENT, "mean", independent, Slip::Grey),
        of("spectral-channel-dropped", "the last channel is missing from the denominator", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::Dropped),
        of("spectral-twice-as-many", "the densities are averaged over 2N techniques, of which N are drawn", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::TwiceAsMany),
        of("spectral-hero-luminance", "the hero is chosen by the luminance, and weighted as if all were alike", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::ByLuminance),
        of("spectral-hero-anew", "every collision has a new hero", SPECTRAL_MIS_DELTA, "mean", delta, Slip::Anew),
        of("spectral-heros-majorant", "the nulls of all channels are those of the hero's σ̂", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::HerosMajorant),
        of("spectral-last-stretch", "f and p lack the transmittance of the last stretch (Algorithm 2, line 9, as printed)", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::LastStretch),
        of("spectral-nulls-in-f-only", "the densities of delta tracking lack the probabilities of null collisions", SPECTRAL_MIS_DELTA, "mean", delta, Slip::NullsInContributionOnly),
        of("spectral-own-density", "each channel is divided by its own density", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::OwnDensity),
        of("spectral-maximum-raw", "the chance max n/μ̄ is not normalised where weights are divided by it", SPECTRAL_MAXIMUM, "mean", maximum, Slip::Raw),
        of("spectral-history-forgotten", "the chance of history-aware tracking forgets the weights", SPECTRAL_HISTORY, "variance", delta, Slip::Forgotten),
    ]
}

/// What goes wrong.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
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

/// A tracker, and whether all channels walk together.
type Walker = (Tracker, bool);

fn draw(
    walker: Walker,
    slip: Slip,
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    if slip == Slip::LastStretch {
        return walk(walker, setup, LastStretch).draw(medium, rng);
    }
    let count = setup.channels.len();
    let mut walk = walk(walker, setup, Wrong { slip, count });
    if slip == Slip::ByLuminance {
        walk.law = Law::new(&Heroes::Luminance, count);
    }
    walk.draw(medium, rng)
}

fn walk<S: Steps>(
    (tracker, is_common): Walker,
    setup: &Setup<SpectralTransmittance>,
    steps: S,
) -> AlongRay<'_, S> {
    let make = if is_common { AlongRay::common } else { AlongRay::new };
    make(setup, &Heroes::Uniform, tracker, steps)
}

/// The steps of a walk with a slip.
#[derive(Clone, Copy)]
struct Wrong {
    slip: Slip,
    /// The number of channels.
    count: usize,
}

impl Steps for Wrong {
    fn decides<L: Lane>(&self, hero: L, inside: L::Mask, random: &mut impl Random<L>) -> L {
        if self.slip != Slip::Anew {
            return hero;
        }
        Law::new(&Heroes::Uniform, self.count).choose(random.uniform_where(inside))
    }

    fn majorant<L: Lane>(&self, own: L, heros: impl Fn() -> L) -> L {
        if self.slip == Slip::HerosMajorant { heros() } else { own }
    }

    fn tracked<L: Lane>(&self, right: L, shares: &[L]) -> [L; 2] {
        match self.slip {
            Slip::Raw => {
                let largest =
                    shares.iter().fold(right.each(0.0), |most, &share| most.or_more(share));
                [right, largest]
            }
            Slip::Forgotten => [Chance::Average.of_null(shares); 2],
            _ => [right; 2],
        }
    }

    fn alone<L: Lane>(&self, is_hero: L::Mask, value: L, probability: f64) -> L {
        match self.slip {
            Slip::Grey => value,
            Slip::ChoiceFree => L::select(is_hero, value, value.each(0.0)),
            _ => Right.alone(is_hero, value, probability),
        }
    }

    fn density<L: Lane>(&self, delta: bool, contribution: L, relative: L) -> L {
        Right.density(delta && self.slip != Slip::NullsInContributionOnly, contribution, relative)
    }

    fn share(&self, probability: f64, is_last: bool) -> f64 {
        if self.slip == Slip::Dropped && is_last { 0.0 } else { probability }
    }

    fn divisor<L: Lane>(&self, mean: L, own: L) -> L {
        match self.slip {
            Slip::TwiceAsMany => mean * 0.5,
            Slip::OwnDensity => own,
            _ => mean,
        }
    }
}

/// [`Slip::LastStretch`].
#[derive(Clone, Copy)]
struct LastStretch;

impl Steps for LastStretch {
    const KEEPS_LAST: bool = true;

    fn relative<L: Lane>(&self, right: L, [own, heros]: [L; 2], last: impl Fn() -> L) -> L {
        right * ((own - heros) * last()).exp()
    }
}
