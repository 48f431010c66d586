//! Factors of a walk to its first scattering in several channels, which a known bug may replace.

use numeric::Lane;

/// Events of a walk, each of which a known bug may replace.
pub trait WalkEvents: Copy {
    /// True if collisions along the ray are counted separately, see [`WalkEvents::has_shadow_density`].
    const COUNTS: bool = false;

    /// True if length and collisions of a tracked shadow ray are in the densities.
    #[inline(always)]
    fn has_shadow_density(&self) -> bool {
        true
    }

    /// The factor of q at a null collision on the way to the scattering.
    #[inline(always)]
    fn passed<L: Lane>(&self, ratio: L) -> L {
        ratio.one_minus()
    }

    /// The factor of q at a scattering.
    #[inline(always)]
    fn scattered<L: Lane>(&self, ratio: L, albedo: f64) -> L {
        ratio * albedo
    }

    /// The transmittance of a channel's shadow ray, given that of the hero's.
    #[inline(always)]
    fn through<L: Lane>(&self, own: L, heros: impl Fn() -> L) -> L {
        let _ = heros;
        own
    }

    /// The probability of a hero in the mean density.
    #[inline(always)]
    fn share(&self, probability: f64, is_last: bool) -> f64 {
        let _ = is_last;
        probability
    }
}

/// The right steps.
#[derive(Clone, Copy)]
pub struct Right;

impl WalkEvents for Right {}
