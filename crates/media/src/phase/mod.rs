//! Phase functions, one page each: the distribution of scattered light over directions.
//!
//! Everywhere in this crate `cos θ` is that of the angle between the two directions of *travel*,
//! before and after: `cos θ = 1` is straight on, `cos θ = −1` straight back. Light that comes from a
//! point `l` to a point `p` and leaves against a ray of direction `d`, towards the ray's origin, has
//! `cos θ = ((p − l)/|p − l|) · (−d)`.
//!
//! A phase function is a density over solid angle, in 1/sr, and its Legendre moments are
//!
//! ```text
//! ∫ p(cos θ) dω = 1,   χ_l = ∫ p(cos θ) P_l(cos θ) dω,   χ_0 = 1,   χ_1 = g, the mean cosine
//! p(cos θ) = Σ_l (2l + 1)/(4π) χ_l P_l(cos θ)
//! ```
//!
//! A page implements [`PhaseFunction`] and is registered by its line in the list at the foot of this
//! file.

pub mod henyey_greenstein;
pub mod isotropic;
pub mod rayleigh;

use crate::catalogue::{Registry, Settings};
use numeric::Lane;

/// A page of the catalogue: a phase function that depends on `cos θ` only.
pub trait PhaseFunction: Sized + Copy + Send + Sync + 'static {
    /// Reads its own settings from `phase.NAME = { … }`.
    fn read(settings: &Settings) -> Option<Self>;

    /// Settings in words, such as `g=0.7`; empty if it has none.
    fn settings(&self) -> String {
        String::new()
    }

    /// `p(cos θ)`, 1/sr, for `cos θ` from −1 to 1.
    fn value<L: Lane>(&self, cosine: L) -> L;

    /// The Legendre moment `χ_l`.
    fn moment(&self, order: usize) -> f64;

    /// The cosine below which a share `u` of all light is scattered, `u` from 0 to 1: with `u` uniform, `cos θ` has
    /// its distribution. It never leaves −1 to 1.
    fn cosine<L: Lane>(&self, u: L) -> L;
}

/// Lists the pages, and makes [`Phase`] of them. Kernels inline the formulas of all pages, so that each line gives a variant of
/// an enum, and its arms below.
macro_rules! phases {
    ($($module:ident :: $Page:ident,)*) => {
        /// Every page, in the order of registration.
        pub static CATALOGUE: Registry<fn(&Settings) -> Option<Phase>> = Registry::new(
            &[$($crate::page!($module)),*],
            &[$(|page| $module::$Page::read(page).map(Phase::$Page)),*],
        );

        /// A phase function of the catalogue: one small type for kernels and theory alike.
        #[derive(Debug, Clone, Copy, PartialEq)]
        #[allow(missing_docs)] // each variant is its page
        pub enum Phase { $($Page($module::$Page)),* }

        impl Phase {
            /// The name in case files, and the settings if there are any.
            pub fn label(&self) -> String {
                let (module, settings) = match self {
                    $(Self::$Page(page) => (stringify!($module), page.settings())),*
                };
                let name = module.replace('_', "-");
                if settings.is_empty() { name } else { format!("{name}, {settings}") }
            }

            /// `p(cos θ)`, 1/sr, for `cos θ` from −1 to 1.
            #[inline(always)]
            pub fn value<L: Lane>(&self, cosine: L) -> L {
                match self { $(Self::$Page(page) => page.value(cosine)),* }
            }

            /// The Legendre moment `χ_l`.
            pub fn moment(&self, order: usize) -> f64 {
                match self { $(Self::$Page(page) => page.moment(order)),* }
            }

            /// The cosine below which a share `u` of all light is scattered; with `u` uniform in [0, 1], `cos θ`
            /// has its distribution.
            #[inline(always)]
            pub fn cosine<L: Lane>(&self, u: L) -> L {
                match self { $(Self::$Page(page) => page.cosine(u)),* }
            }
        }
    };
}

impl Phase {
    /// Reads the required `phase.NAME = { … }`.
    pub fn read(settings: &Settings) -> Option<Self> {
        CATALOGUE.read_key(settings, "phase", |read, page| read(page))
    }

    /// Reads `{ NAME = { … } }` of a list.
    pub fn read_listed(table: &Settings) -> Option<Self> {
        CATALOGUE.read(table, |read, page| read(page))
    }
}

phases! {
    isotropic::Isotropic,
    rayleigh::Rayleigh,
    henyey_greenstein::HenyeyGreenstein,
}

/// Clamps a cosine that rounding may have carried past 1 or −1, by a few units in the last place.
#[inline(always)]
fn unit<L: Lane>(cosine: L) -> L {
    cosine.or_more(cosine.each(-1.0)).or_less(cosine.each(1.0))
}

#[cfg(test)]
mod tests {
    use super::henyey_greenstein::HenyeyGreenstein;
    use super::*;
    use numeric::quadrature::{GaussLegendre, legendre};

    fn all() -> Vec<Phase> {
        let of = |g: f64| Phase::HenyeyGreenstein(HenyeyGreenstein::new(g).expect("|g| < 1"));
        let mut phases =
            vec![Phase::Isotropic(isotropic::Isotropic), Phase::Rayleigh(rayleigh::Rayleigh)];
        phases.extend([-0.9, -0.3, -1e-9, 0.0, 1e-9, 0.3, 0.9, 0.99].map(of));
        phases
    }

    /// `2π ∫ f(cos θ) p(cos θ) dcos θ` from −1 on, in panels that narrow towards both ends.
    fn integral(phase: Phase, to: f64, f: impl Fn(f64) -> f64) -> f64 {
        let rule = GaussLegendre::new(24);
        let halves = (0..=40).map(|k| 0.5f64.powi(k));
        let mut knots: Vec<f64> = halves.flat_map(|h| [h - 1.0, 1.0 - h]).collect();
        knots.extend([-1.0, 1.0]);
        knots.retain(|&x| x < to);
        knots.push(to);
        knots.sort_by(f64::total_cmp);
        let panel = |ends: &[f64]| rule.integrate(ends[0], ends[1], |x| f(x) * phase.value(x));
        std::f64::consts::TAU * knots.windows(2).map(panel).sum::<f64>()
    }

    #[test]
    fn every_phase_function_spreads_all_light_and_no_more() {
        for phase in all() {
            let whole = integral(phase, 1.0, |_| 1.0);
            assert!((whole - 1.0).abs() < 1e-13, "{}: {whole}", phase.label());
            assert_eq!(phase.moment(0), 1.0);
        }
    }

    #[test]
    fn moments_are_those_of_the_values() {
        for phase in all() {
            for order in 0..12 {
                let actual = integral(phase, 1.0, |x| legendre(x).nth(order).unwrap_or_default());
                let stated = phase.moment(order);
                assert!((actual - stated).abs() < 1e-12, "{} χ_{order}: {actual}", phase.label());
            }
        }
    }

    #[test]
    fn sampling_inverts_the_distribution() {
        for phase in all() {
            for k in 0..=200 {
                let u = f64::from(k) / 200.0;
                let cosine = phase.cosine(u);
                assert!((-1.0..=1.0).contains(&cosine), "{}: {cosine}", phase.label());
                let share = integral(phase, cosine, |_| 1.0);
                // Eight roundings between u and its cosine: the probability that they amount to.
                let bits = std::f64::consts::TAU * phase.value(cosine) * 8.0 * 0.5 * f64::EPSILON;
                assert!((share - u).abs() < 2e-14 + bits, "{} at {u}: {share}", phase.label());
            }
        }
    }

    #[test]
    fn all_light_lies_between_straight_back_and_straight_on() {
        for phase in all() {
            assert!((phase.cosine(0.0) + 1.0).abs() < 1e-15, "{}", phase.label());
            assert!((phase.cosine(1.0) - 1.0).abs() < 1e-15, "{}", phase.label());
        }
    }
}
