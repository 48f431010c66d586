//! What the walks of all techniques share.

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use crate::Setup;
use media::Control;
use media::course::{Course, Even};
use numeric::{Lane, Span};
use theory::problems::{Problem, SingleScattering};

/// The ray and what is on it.
#[derive(Clone, Copy)]
pub struct World<'a> {
    /// What the estimator works on.
    pub setup: &'a Setup<SingleScattering>,
    /// Where the medium is.
    pub support: Span,
    /// σ_t, where it has one value.
    pub extinction: Option<f64>,
    /// `1 − (σ_t − σ_c)/σ̂`, where it has one value: no step has to divide.
    pub kept: Option<f64>,
}

impl World<'_> {
    /// The transmittance from the ray's origin, for those that a mask names.
    #[inline(always)]
    pub fn transmittance<S: Simd>(&self, to: f64x8<S>, which: mask64x8<S>) -> f64x8<S> {
        let from = self.support.from;
        let depth = if let Some(value) = self.extinction {
            (to.or_less(to.each(self.support.to)) - from).or_more(to.each(0.0)) * value
        } else {
            let (bits, medium) = (which.to_bitmask(), self.setup.problem.medium());
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

    /// That of the control.
    #[inline(always)]
    pub fn controlled<S: Simd>(&self, to: f64x8<S>) -> f64x8<S> {
        match &self.setup.control {
            Control::None => to.each(1.0),
            control => (-control.depths(self.support.from, to)).exp(),
        }
    }
}

/// Eight walks through σ̂ along the ray.
#[derive(Clone, Copy)]
pub struct Walk<'a, S: Simd> {
    course: Even<'a, f64x8<S>>,
    from: f64x8<S>,
    /// Who is on its way.
    pub on: mask64x8<S>,
    /// Who flew in this step.
    pub flew: mask64x8<S>,
    /// Who of them is still on the ray.
    pub inside: mask64x8<S>,
    /// Where.
    pub t: f64x8<S>,
}

impl<'a, S: Simd> Walk<'a, S> {
    /// None is on its way.
    #[inline(always)]
    pub fn new(simd: S, course: Even<'a, f64x8<S>>, from: f64) -> Self {
        let (from, none) = (f64x8::splat(simd, from), mask64x8::splat(simd, false));
        Self { course, from, on: none, flew: none, inside: none, t: from }
    }

    /// These set out.
    #[inline(always)]
    pub fn begin(&mut self, which: mask64x8<S>) {
        self.on |= which;
        self.course.restart(which);
    }

    /// Those that a mask names fly an optical depth; answers where they are, inside the support.
    #[inline(always)]
    pub fn fly(&mut self, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S> {
        let still = depth.each(0.0);
        let inside = self.course.fly(Lane::select(flies, depth, still));
        self.flew = flies;
        self.inside = flies & inside;
        self.t = Lane::select(self.inside, self.course.reached(), self.from);
        self.t
    }

    /// `1 − (σ_t − σ_c)/σ̂` there.
    #[inline(always)]
    pub fn kept(&self, world: &World, extinction: f64x8<S>) -> f64x8<S> {
        if let Some(kept) = world.kept {
            return extinction.each(kept);
        }
        let control = world.setup.control.extinction(self.t);
        extinction.each(1.0) - (extinction - control) / self.course.sampling()
    }

    /// σ̂ there.
    #[inline(always)]
    pub fn sampling(&self) -> f64x8<S> {
        self.course.sampling()
    }
}
