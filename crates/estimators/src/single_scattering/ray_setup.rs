//! Medium, σ̂, control and light, as all walks of single scattering see them.

use crate::Setup;
use crate::space::shadow::ShadowRays;
use media::sampling::PackedFlight;
use media::{Batches, Control, Lookups};
use numeric::{Lane, Mask, Span};
use theory::problems::{Problem, SingleScattering};

/// The ray with its medium, and shadow rays from it.
#[derive(Clone, Copy)]
pub struct RaySetup<'a> {
    /// Problem, σ̂ and control.
    pub setup: &'a Setup<SingleScattering>,
    /// Shadow rays.
    pub rays: &'a ShadowRays<'a>,
    /// The field on shadow rays, as packs look it up; empty for one lane.
    pub fields: &'a [Batches<'a>],
    /// Interval of the ray inside the medium.
    pub support: Span,
    /// σ_t, if it has one value.
    pub extinction: Option<f64>,
    /// `1 − (σ_t − σ_c)/σ̂`, if it has one value.
    kept: Option<f64>,
}

impl<'a> RaySetup<'a> {
    /// The ground of a setup.
    #[inline(always)]
    pub fn new(
        setup: &'a Setup<SingleScattering>,
        medium: &Lookups,
        rays: &'a ShadowRays<'a>,
        fields: &'a [Batches<'a>],
    ) -> Self {
        let (support, extinction) = (setup.problem.medium().support(), medium.single_value());
        let kept = || {
            let (extinction, control) = (extinction?, setup.fields.control.single_value()?);
            Some(1.0 - (extinction - control) / setup.fields.sampling.with_gaps()?.value)
        };
        Self { setup, rays, fields, support, extinction, kept: kept() }
    }

    /// The points from the light that uniform numbers choose.
    #[inline(always)]
    pub fn from_light<L: Lane>(&self, number: L) -> L {
        let (problem, angles) = (&*self.setup.problem, self.setup.problem.angles());
        problem.at_angle(number * angles.length() + angles.from)
    }

    /// The transmittance from the ray's origin to distances, for the lanes in `which`.
    #[inline(always)]
    pub fn transmittance<L: Lane>(&self, to: L, which: L::Mask) -> L {
        let from = self.support.from;
        let depth = if let Some(value) = self.extinction {
            (to.or_less(to.each(self.support.to)) - from).or_more(to.each(0.0)) * value
        } else {
            let (bits, medium) = (which.bits(), self.setup.problem.medium());
            to.replaced(|elements| {
                for (lane, to) in elements.iter_mut().enumerate() {
                    if bits >> lane & 1 == 1 {
                        *to = medium.optical_depth(Span::new(from, *to)).value;
                    }
                }
            })
        };
        (-depth).exp()
    }

    /// The transmittance of the control from the ray's origin to distances.
    #[inline(always)]
    pub fn controlled<L: Lane>(&self, to: L) -> L {
        match &self.setup.fields.control {
            Control::None => to.each(1.0),
            control => (-control.depths(self.support.from, to)).exp(),
        }
    }

    /// `1 − (σ_t − σ_c)/σ̂` at a tentative collision.
    #[inline(always)]
    pub fn kept<L: Lane>(&self, here: &impl PackedFlight<L>, t: L, extinction: L) -> L {
        if let Some(kept) = self.kept {
            return t.each(kept);
        }
        let control = self.setup.fields.control.extinction(t);
        ((extinction - control) / here.sampling()).one_minus()
    }
}
