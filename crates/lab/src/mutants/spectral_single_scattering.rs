//! Wrong ways to scatter once in several channels at once.
//!
//! ```text
//! X_λ = q_λ/Σ_h w_h q_h · p_λ(cos θ) Φ/(4π r²) T̂_λ
//! ```

use super::target::{
    SPECTRAL_SINGLE_EXACT, SPECTRAL_SINGLE_HERO, SPECTRAL_SINGLE_RATIO, SPECTRAL_SINGLE_TRACKING,
};
use super::{About, Mutant, Target, with};
use estimators::setup::heroes::Heroes;
use estimators::setup::walker::Walker;
use estimators::spectral_single_scattering::Shadow;
use estimators::spectral_single_scattering::walk::{Right, Steps, draw};
use numeric::Lane;
use theory::problems::SpectralSingleScattering;
use theory::spectral::{Chance, Chances};

/// The family.
#[rustfmt::skip] // one mutant, one entry
pub fn mutants() -> Vec<Mutant<SpectralSingleScattering>> {
    let of = |name, bug, target: Target, slip: Slip| {
        let about = About { name, bug, target, check: "mean" };
        let (walker, shadow) = if target == SPECTRAL_SINGLE_EXACT {
            (Walker::Mis(Heroes::Uniform), Shadow::Exact)
        } else if target == SPECTRAL_SINGLE_TRACKING {
            (Walker::SpectralTracking(Chances::Fixed(Chance::Average)), Shadow::Exact)
        } else if target == SPECTRAL_SINGLE_HERO {
            (Walker::Hero(Heroes::Given(vec![0.3, 0.3, 0.4])), Shadow::Ratio)
        } else {
            (Walker::Mis(Heroes::Uniform), Shadow::Ratio)
        };
        let right = walker.clone();
        Mutant::new(
            about,
            with(walker, move |walker, setup, medium, rng| draw::<true>(Wrong(slip), (walker, shadow), setup, medium, rng)),
            with(right, move |walker, setup, medium, rng| draw::<true>(Right, (walker, shadow), setup, medium, rng)),
        )
    };
    vec![
        of("spectral-single-nulls-left-out", "null collisions before the scattering are left out of all densities", SPECTRAL_SINGLE_EXACT, Slip::NullsLeftOut),
        of("spectral-single-albedo-missing", "the densities lack the albedo", SPECTRAL_SINGLE_EXACT, Slip::AlbedoMissing),
        of("spectral-single-dropped", "the last channel is missing from the denominator", SPECTRAL_SINGLE_EXACT, Slip::Dropped),
        of("spectral-single-shadow-of-hero", "every channel has the transmittance of the hero's shadow ray", SPECTRAL_SINGLE_EXACT, Slip::ShadowOfHero),
        of("spectral-single-tracked-by-hero", "on tracked shadow rays every channel has the weight of the hero", SPECTRAL_SINGLE_RATIO, Slip::ShadowOfHero),
        of("spectral-single-shadow-not-dense", "the collisions of a shadow ray are left out of the densities of other heroes", SPECTRAL_SINGLE_RATIO, Slip::ShadowNotDense),
        of("spectral-single-hero-shadow-not-dense", "a hero leaves the collisions of its shadow ray out of the other channels' weights", SPECTRAL_SINGLE_HERO, Slip::ShadowNotDense),
        of("spectral-single-tracking-nulls-left-out", "spectral tracking divides by the chance of a null collision and multiplies by nothing", SPECTRAL_SINGLE_TRACKING, Slip::NullsLeftOut),
        of("spectral-single-tracking-albedo-missing", "spectral tracking multiplies by r, not by r a, where it scatters", SPECTRAL_SINGLE_TRACKING, Slip::AlbedoMissing),
    ]
}

/// What goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Slip {
    NullsLeftOut,
    AlbedoMissing,
    Dropped,
    ShadowOfHero,
    ShadowNotDense,
}

/// The steps of a walk with one slip.
#[derive(Clone, Copy)]
struct Wrong(Slip);

impl Steps for Wrong {
    const COUNTS: bool = true;

    #[inline(always)]
    fn passed<L: Lane>(&self, ratio: L) -> L {
        if self.0 == Slip::NullsLeftOut { ratio.each(1.0) } else { ratio.one_minus() }
    }

    #[inline(always)]
    fn scattered<L: Lane>(&self, ratio: L, albedo: f64) -> L {
        if self.0 == Slip::AlbedoMissing { ratio } else { ratio * albedo }
    }

    #[inline(always)]
    fn through<L: Lane>(&self, own: L, heros: impl Fn() -> L) -> L {
        if self.0 == Slip::ShadowOfHero { heros() } else { own }
    }

    #[inline(always)]
    fn has_shadow_density(&self) -> bool {
        self.0 != Slip::ShadowNotDense
    }

    #[inline(always)]
    fn share(&self, probability: f64, is_last: bool) -> f64 {
        if is_last && self.0 == Slip::Dropped { 0.0 } else { probability }
    }
}
