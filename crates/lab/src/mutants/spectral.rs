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
use super::{About, Mutant, with};
use estimators::setup::heroes::Heroes;
use estimators::spectral_transmittance::walk::{Passed, relative_density};
use estimators::{Draw, Setup};
use media::body::MOST_CHANNELS;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::problems::SpectralTransmittance;
use theory::problems::spectral_transmittance::Values;

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralTransmittance>> {
    let of = |name, bug, target, check, honest: Kind, slip| {
        let by = |slip| with((honest, slip), |&(kind, slip), setup, medium, rng| draw(kind, slip, setup, medium, rng));
        Mutant::new(About { name, bug, target, check }, by(slip), by(Slip::None))
    };
    let (ratio, delta) = (Kind::Mis { delta: false }, Kind::Mis { delta: true });
    vec![
        of("spectral-choice-free", "the one channel that is drawn is not divided by its probability", SPECTRAL_INDEPENDENT, "mean", Kind::Independent, Slip::ChoiceFree),
        of("spectral-grey", "what the hero finds is scored for all channels", SPECTRAL_INDEPENDENT, "mean", Kind::Independent, Slip::Grey),
        of("spectral-channel-dropped", "the last channel is missing from the denominator", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::Dropped),
        of("spectral-twice-as-many", "the densities are averaged over 2N techniques, of which N are drawn", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::TwiceAsMany),
        of("spectral-hero-luminance", "the hero is chosen by the luminance, and weighted as if all were alike", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::ByLuminance),
        of("spectral-hero-anew", "every collision has a new hero", SPECTRAL_MIS_DELTA, "mean", delta, Slip::Anew),
        of("spectral-heros-majorant", "the nulls of all channels are those of the hero's σ̂", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::HerosMajorant),
        of("spectral-last-stretch", "f and p lack the transmittance of the last stretch (Algorithm 2, line 9, as printed)", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::LastStretch),
        of("spectral-nulls-in-f-only", "the densities of delta tracking lack the probabilities of null collisions", SPECTRAL_MIS_DELTA, "mean", delta, Slip::NullsInContributionOnly),
        of("spectral-own-density", "each channel is divided by its own density", SPECTRAL_MIS_RATIO, "mean", ratio, Slip::OwnDensity),
        of("spectral-maximum-raw", "the chance max n/μ̄ is not normalised where weights are divided by it", SPECTRAL_MAXIMUM, "mean", Kind::Maximum, Slip::Raw),
        of("spectral-history-forgotten", "the chance of history-aware tracking forgets the weights", SPECTRAL_HISTORY, "variance", Kind::History, Slip::Forgotten),
    ]
}

/// Which estimator has the bug.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Independent,
    Mis { delta: bool },
    Maximum,
    History,
}

/// What goes wrong.
#[derive(Clone, Copy, PartialEq)]
enum Slip {
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

fn draw(
    kind: Kind,
    slip: Slip,
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    match kind {
        Kind::Independent => independent(slip, setup, medium, rng),
        Kind::Mis { delta } => balanced(delta, slip, setup, medium, rng),
        Kind::Maximum | Kind::History => tracked(kind == Kind::History, slip, setup, medium, rng),
    }
}

/// Delta tracking of one channel, see `estimators/spectral_transmittance/independent.rs`.
fn independent(
    slip: Slip,
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let count = setup.channels.len();
    let hero = Heroes::Uniform.choose(setup.channels.len(), rng.uniform());
    let (passed, _) = walk(slip, setup, medium, rng, (hero, true));
    let weight = if slip == Slip::ChoiceFree { 1.0 } else { count as f64 };
    let value = if passed.is_alive { weight } else { 0.0 };
    let mut found = [0.0; MOST_CHANNELS];
    match slip {
        Slip::Grey => found[..count].fill(value / count as f64),
        _ => found[hero] = value,
    }
    Draw::free(setup.problem.values(&found[..count]), passed.lookups)
}

/// The balance heuristic, see `estimators/spectral_transmittance/spectral_mis.rs`.
fn balanced(
    delta: bool,
    slip: Slip,
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let count = setup.channels.len();
    let chosen = if slip == Slip::ByLuminance { Heroes::Luminance } else { Heroes::Uniform };
    let hero = chosen.choose(setup.channels.len(), rng.uniform());
    let (passed, last) = walk(slip, setup, medium, rng, (hero, delta));
    let mut found = [0.0; MOST_CHANNELS];
    if passed.is_alive {
        let (mut density, mut own) = (0.0, [0.0; MOST_CHANNELS]);
        for channel in 0..count {
            let mut relative = relative_density(setup, channel, hero, passed.lookups);
            if slip == Slip::LastStretch {
                let length = setup.mesh.support().to - last;
                let [mine, heros] = [channel, hero].map(|c| setup.channels[c].majorant);
                relative *= Lane::exp((mine - heros) * length);
            }
            found[channel] = relative * passed.ratios[channel];
            let nulls = delta && slip != Slip::NullsInContributionOnly;
            let by_hero = if nulls { found[channel] } else { relative };
            own[channel] = by_hero;
            if slip != Slip::Dropped || channel + 1 < count {
                density += Heroes::Uniform.probability(count, channel) * by_hero;
            }
        }
        if slip == Slip::TwiceAsMany {
            density *= 0.5;
        }
        for (found, own) in found[..count].iter_mut().zip(own) {
            *found /= if slip == Slip::OwnDensity { own } else { density };
        }
    }
    Draw::free(setup.problem.values(&found[..count]), passed.lookups)
}

/// The walk of a hero, and the place of its last collision; see
/// `estimators/spectral_transmittance/walk.rs`.
fn walk(
    slip: Slip,
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
    (mut hero, delta): (usize, bool),
) -> (Passed, f64) {
    let sampling = &setup.channels[hero].sampling;
    let mut cursor = sampling.begin();
    let mut passed = Passed { lookups: 0, ratios: [1.0; MOST_CHANNELS], is_alive: true };
    loop {
        let last = cursor.t;
        let depth = -rng.ln_uniform();
        let number = if delta { rng.uniform() } else { 0.0 };
        if sampling.fly(&mut cursor, depth).is_none() {
            return (passed, last);
        }
        passed.lookups += 1;
        if slip == Slip::Anew {
            hero = Heroes::Uniform.choose(setup.channels.len(), rng.uniform());
        }
        let mut survival = 1.0;
        for (channel, own) in setup.channels.iter().enumerate() {
            let is_heros = slip == Slip::HerosMajorant;
            let majorant = if is_heros { setup.channels[hero].majorant } else { own.majorant };
            let null = 1.0 - medium.channel(channel).extinction(cursor.t) / majorant;
            passed.ratios[channel] *= null;
            if channel == hero {
                survival = null;
            }
        }
        if delta && number >= survival {
            passed.is_alive = false;
            return (passed, cursor.t);
        }
    }
}

/// Spectral tracking, see `estimators/spectral_transmittance/spectral_tracking.rs`.
fn tracked(
    remembers: bool,
    slip: Slip,
    setup: &Setup<SpectralTransmittance>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    use theory::spectral::Chance;
    let count = setup.channels.len();
    let common = &setup.channels[0];
    let mut cursor = common.sampling.begin();
    let (mut weights, mut shares) = ([1.0; MOST_CHANNELS], [0.0; MOST_CHANNELS]);
    let (weights, shares) = (&mut weights[..count], &mut shares[..count]);
    let mut lookups = 0;
    loop {
        let (depth, number) = (-rng.ln_uniform(), rng.uniform());
        if common.sampling.fly(&mut cursor, depth).is_none() {
            return Draw::free(setup.problem.values(weights), lookups);
        }
        lookups += 1;
        for (channel, share) in shares.iter_mut().enumerate() {
            let extinction = medium.channel(channel).extinction(cursor.t);
            *share = 1.0 - extinction / common.majorant;
        }
        let null = if remembers && slip != Slip::Forgotten {
            let (mut nulls, mut all) = (0.0, 0.0);
            for (weight, share) in weights.iter().zip(shares.iter()) {
                nulls += weight * share;
                all += weight;
            }
            nulls / all
        } else {
            (if remembers { Chance::Average } else { Chance::Maximum }).of_null(shares)
        };
        if number >= null {
            return Draw::free(setup.problem.values(&[0.0; MOST_CHANNELS][..count]), lookups);
        }
        let largest = shares.iter().fold(0.0f64, |most, &share| most.max(share));
        let divisor = if slip == Slip::Raw { largest } else { null };
        for (weight, share) in weights.iter_mut().zip(shares.iter()) {
            *weight *= share / divisor;
        }
    }
}
