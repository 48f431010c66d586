//! Wrong ways to scatter once in several channels at once.
//!
//! ```text
//! X_λ = q_λ/Σ_h w_h q_h · p_λ(cos θ) Φ/(4π r²) T̂_λ
//! ```

use super::{Mutant, MutantRow, On, family, on, one_by_one};
use estimators::setup::heroes::Heroes;
use estimators::setup::walker::Walker;
use estimators::spectral_single_scattering::Shadow;
use estimators::spectral_single_scattering::events::WalkEvents;
use estimators::spectral_single_scattering::walk::draw;
use gate::CheckId;
use numeric::Lane;
use theory::colours::{Chance, Chances};
use theory::problems::SpectralSingleScattering;

/// Function that makes a walker, and shadow rays.
type Make = fn() -> (Walker, Shadow);

/// A point light, all channels by one walk, exact shadow rays.
const EXACT: On<Make> = on("single-scattering/spectral-known-bugs", 2, || {
    (Walker::Mis(Heroes::Uniform), Shadow::Exact)
});
/// Tracked shadow rays.
const RATIO: On<Make> = on("single-scattering/spectral-known-bugs", 3, || {
    (Walker::Mis(Heroes::Uniform), Shadow::Ratio)
});
/// The walk of a hero without multiple importance sampling, tracked shadow rays.
const HERO: On<Make> = on("single-scattering/spectral-without-mis", 1, || {
    (Walker::Hero(Heroes::Given(vec![0.3, 0.3, 0.4])), Shadow::Ratio)
});
/// All channels together, exact shadow rays.
const TRACKING: On<Make> = on("single-scattering/spectral-without-mis", 2, || {
    (Walker::SpectralTracking(Chances::Fixed(Chance::Average)), Shadow::Exact)
});

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bug {
    None,
    NullsLeftOut,
    AlbedoMissing,
    Dropped,
    ShadowOfHero,
    ShadowNotDense,
}

#[rustfmt::skip] // one mutant, one entry
const LINES: &[MutantRow<Make, Bug>] = &[
    ("spectral-single-nulls-left-out", "null collisions before the scattering are left out of all densities", EXACT, CheckId::Mean, Bug::NullsLeftOut),
    ("spectral-single-albedo-missing", "the densities lack the albedo", EXACT, CheckId::Mean, Bug::AlbedoMissing),
    ("spectral-single-dropped", "the last channel is missing from the denominator", EXACT, CheckId::Mean, Bug::Dropped),
    ("spectral-single-shadow-of-hero", "every channel has the transmittance of the hero's shadow ray", EXACT, CheckId::Mean, Bug::ShadowOfHero),
    ("spectral-single-tracked-by-hero", "on tracked shadow rays every channel has the weight of the hero", RATIO, CheckId::Mean, Bug::ShadowOfHero),
    ("spectral-single-shadow-not-dense", "the collisions of a shadow ray are left out of the densities of other heroes", RATIO, CheckId::Mean, Bug::ShadowNotDense),
    ("spectral-single-hero-shadow-not-dense", "a hero leaves the collisions of its shadow ray out of the other channels' weights", HERO, CheckId::Mean, Bug::ShadowNotDense),
    ("spectral-single-tracking-nulls-left-out", "spectral tracking divides by the chance of a null collision and multiplies by nothing", TRACKING, CheckId::Mean, Bug::NullsLeftOut),
    ("spectral-single-tracking-albedo-missing", "spectral tracking multiplies by r, not by r a, where it scatters", TRACKING, CheckId::Mean, Bug::AlbedoMissing),
];

/// The family.
pub fn mutants() -> Vec<Mutant<SpectralSingleScattering>> {
    family(LINES, &Bug::None, |make, &bug| {
        let (walker, shadow) = make();
        one_by_one(move |setup, medium, random| {
            draw::<true>(Wrong(bug), (&walker, shadow), setup, medium, random)
        })
    })
}

/// The steps of a walk, of which a bug makes one wrong.
#[derive(Clone, Copy)]
struct Wrong(Bug);

impl WalkEvents for Wrong {
    const COUNTS: bool = true;

    fn passed<L: Lane>(&self, ratio: L) -> L {
        if self.0 == Bug::NullsLeftOut { ratio.each(1.0) } else { ratio.one_minus() }
    }

    fn scattered<L: Lane>(&self, ratio: L, albedo: f64) -> L {
        if self.0 == Bug::AlbedoMissing { ratio } else { ratio * albedo }
    }

    fn through<L: Lane>(&self, own: L, heros: impl Fn() -> L) -> L {
        if self.0 == Bug::ShadowOfHero { heros() } else { own }
    }

    fn has_shadow_density(&self) -> bool {
        self.0 != Bug::ShadowNotDense
    }

    fn share(&self, probability: f64, is_last: bool) -> f64 {
        if is_last && self.0 == Bug::Dropped { 0.0 } else { probability }
    }
}
