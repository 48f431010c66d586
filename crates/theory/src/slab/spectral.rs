//! Slabs of coloured scatterers: adding and doubling for albedos above 1, and orders of scattering.
//!
//! Moments are those of [`crate::colours::scatterers`]. An albedo above 1 may be too large for the depth of the slab: the
//! slab is critical, and the moment infinite. With anisotropic phase functions, albedos above 1 are solved to 1e-4.
//! Orders of scattering are known for isotropic scattering. With other phase functions multiple importance sampling
//! has a mean, and a bound on the variance, as its draws never exceed 1/w.

use super::{Pieces, Resolution, Walk};
use crate::colours::scatterers::{Body, Divergence, Orders};
use crate::memo::Memo;
use crate::problems::SpectralSlab;
use crate::problems::slab::{Incidence, Light};
use crate::{CountDistribution, Kernel, Mesh, ParticleRule, slab};
use media::Piecewise;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::Known;

/// Relative error of orders of scattering beyond that which their sum shows.
const OF_ORDERS: f64 = 2e-12;
/// Relative distance to a critical depth within which theory does not resolve on which side of it a slab is.
const NEAR: f64 = 1e-3;
/// Relative error of critical albedos.
const SHARP: f64 = 1e-7;

/// A slab with its mesh and σ̂.
pub struct Slabs<'a> {
    slab: &'a SpectralSlab,
    mesh: &'a Mesh,
    sampling: &'a Piecewise,
    laws: bool,
}

impl<'a> Slabs<'a> {
    /// Joins the parts; without `laws` lookups have a mean only.
    pub fn new(
        slab: &'a SpectralSlab,
        (mesh, sampling): (&'a Mesh, &'a Piecewise),
        laws: bool,
    ) -> Self {
        Self { slab, mesh, sampling, laws }
    }

    fn depth(&self) -> Known {
        self.mesh.optical_depth()
    }
}

/// An answer of moderate precision, `None` where it is infinite: with sharp phase functions an exact one takes
/// seconds.
fn coarse(incidence: &Incidence, depth: f64, albedo: f64) -> Option<[Known; 2]> {
    let slice = Kernel { rate: depth, straight: 0.0, scattered: albedo, score: 0.0 };
    let found = slab::solve(&incidence.phase, &[incidence.light], &[slice], Resolution::COARSE)?;
    Some([found[0].reflected, found[0].transmitted])
}

fn is_isotropic(incidence: &Incidence) -> bool {
    incidence.phase == Phase::Isotropic(Isotropic)
}

/// Returns true if a slab of an optical depth has a finite answer.
fn is_finite(incidence: &Incidence, depth: f64, albedo: f64) -> bool {
    let light = Incidence { light: Light::Diffuse, ..*incidence };
    if is_isotropic(incidence) {
        slab::cached(&light, Known::exact(depth), albedo).is_some()
    } else {
        coarse(&light, depth, albedo).is_some()
    }
}

/// Albedo from which on a slab has no finite answer.
fn critical(incidence: &Incidence, depth: f64) -> f64 {
    let (mut low, mut high) = (1.0, 2.0);
    while is_finite(incidence, depth, high) && high < 1e6 {
        (low, high) = (high, 2.0 * high);
    }
    while high - low > SHARP * low {
        let middle = 0.5 * (low + high);
        if is_finite(incidence, depth, middle) { low = middle } else { high = middle }
    }
    high
}

static CRITICAL: Memo<(String, u64), f64> = Memo::new(256);

impl Body for Slabs<'_> {
    fn leaving(&self, albedo: f64) -> Option<[Known; 2]> {
        let answer = slab::cached(&self.slab.incidence, self.depth(), albedo)?;
        Some([answer.reflected, answer.transmitted])
    }

    fn power(&self, albedo: f64) -> Option<[Known; 2]> {
        if is_isotropic(&self.slab.incidence) || albedo <= 1.0 {
            return self.leaving(albedo);
        }
        coarse(&self.slab.incidence, self.depth().value, albedo)
    }

    fn divergence(&self, albedo: f64) -> Option<Divergence> {
        let (incidence, depth) = (&self.slab.incidence, self.depth().value);
        if albedo <= 1.0 {
            return None;
        }
        let near = depth * (1.0 + NEAR);
        if is_finite(incidence, near, albedo) && self.power(albedo).is_some() {
            return None;
        }
        let key = (incidence.phase.label(), depth.to_bits());
        let critical = CRITICAL.get(key, || critical(incidence, depth));
        // With its peak cut off, light along the slab may grow that the whole phase function turns away.
        let is_cut = Resolution::COARSE.cuts(&incidence.phase);
        let is_infinite = !is_cut && !is_finite(incidence, depth * (1.0 - NEAR), albedo);
        Some(if is_infinite {
            Divergence::BeyondAlbedo { critical, albedo }
        } else {
            Divergence::NearAlbedo { critical, albedo }
        })
    }

    fn orders(&self) -> Option<Orders> {
        if !is_isotropic(&self.slab.incidence) {
            return None;
        }
        let depth = self.depth();
        let found = slab::orders::orders(self.slab.incidence.light, depth.value)?;
        let steepest = self.slab.incidence.light.cosine().map_or(6.0, |cosine| 4.0 + 1.0 / cosine);
        let all: f64 = found.iter().flatten().sum();
        let error = OF_ORDERS + (all - 1.0).abs();
        Some(Orders { found, error, each: 0.0, blur: steepest * depth.error })
    }

    fn lookups(&self, heroes: &[(f64, f64)]) -> Option<CountDistribution> {
        let (incidence, depth) = (self.slab.incidence, self.depth().value);
        let kinks = ParticleRule::Analog.kinks(1.0);
        let pieces = Pieces::new(self.mesh, self.sampling, &kinks, &[incidence.light]);
        Walk::mixed_lookups(heroes.iter().map(|&(weight, albedo)| {
            (weight, Walk::analog(incidence, albedo, pieces.clone(), depth, self.laws))
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use media::Medium;
    use media::constant::Constant;
    use media::phase::henyey_greenstein::HenyeyGreenstein;
    use numeric::Span;
    use std::sync::Arc;

    /// Next to the critical albedo theory does not tell on which side a slab is, on either side of it.
    #[test]
    fn next_to_the_critical_albedo_nothing_is_said_to_be_infinite() {
        let peaked = HenyeyGreenstein::new(0.5).map(Phase::HenyeyGreenstein).expect("in range");
        for phase in [Phase::Isotropic(Isotropic), peaked] {
            let incidence = Incidence { light: Light::Collimated(0.6), phase };
            let span = Span::new(0.0, 1.7);
            let medium = Medium::new(Arc::new(Constant { extinction: 1.0 }), span, span);
            let problem = SpectralSlab::new(medium.clone(), vec![0.5], incidence);
            let (mesh, sampling) = (Mesh::new(medium), Piecewise::constant(1.0, span));
            let slabs = Slabs::new(&problem, (&mesh, &sampling), false);
            let at = critical(&incidence, 1.7);
            assert_eq!(slabs.divergence(0.99 * at), None);
            for share in [1.0 - 1e-4, 1.0 - 1e-6, 1.0 + 1e-6, 1.0 + 1e-4] {
                let albedo = share * at;
                let near = Divergence::NearAlbedo { critical: at, albedo };
                assert_eq!(slabs.divergence(albedo), Some(near), "{share}");
            }
            let albedo = 1.01 * at;
            let beyond = Divergence::BeyondAlbedo { critical: at, albedo };
            assert_eq!(slabs.divergence(albedo), Some(beyond));
        }
    }
}
