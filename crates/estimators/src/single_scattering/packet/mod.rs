//! Single scattering by packets: event-based tracking of sixteen walks.
//!
//! Specification: draw j is, bit for bit, the draw that the estimator's page makes from stream j mod 16.
//!
//! ```text
//! fly       each walk flies −ln u through its σ̂: along the ray, or along its shadow ray
//! look up   one call answers σ_t on the ray, another one on the shadow rays
//! collide   the page says what becomes of each: who casts a shadow ray, who has made its draw
//! ```
//!
//! A page is what distinguishes a technique; it never flies a shadow ray. A walk that has made its draw begins
//! the next one at once.

mod bank;
mod collisions;
mod interactions;
mod mis;
mod points;
mod shared;
mod walk;

pub use bank::walks;

use fearless_simd::{Simd, f64x8, mask64x8};

use self::walk::{Walk, World};
use crate::kernels::packet::bank::Numbers;
use crate::space::shadow::Found;

/// What eight draws have come to.
#[derive(Clone, Copy)]
pub struct Sums<S: Simd> {
    /// Their values.
    pub value: f64x8<S>,
    /// Their lookups.
    pub lookups: f64x8<S>,
}

/// What a technique does with eight walks.
pub trait Page<S: Simd> {
    /// So many that have found light go on together: more than one where that costs more than a step.
    const LIT: u32 = 1;
    /// So many that have made their draws begin the next ones together. Who waits does not move: of eight lanes at most
    /// (4 − 1) aim, (LIT − 1) have found light and (DONE − 1) have ended, which must leave one.
    const DONE: u32 = 1;

    /// The draws that a mask names begin, and those that go on with another point.
    fn begin(&mut self, numbers: &mut Numbers<S>, which: mask64x8<S>, sums: &mut Sums<S>);

    /// Who flies along the ray in this step, unless it casts a shadow ray.
    fn flies(&self) -> mask64x8<S>;

    /// These fly an optical depth; answers where σ_t is asked for, inside the support.
    fn fly(&mut self, numbers: &mut Numbers<S>, flies: mask64x8<S>, depth: f64x8<S>) -> f64x8<S>;

    /// What becomes of those that a mask names, who cast no shadow rays, given σ_t; answers who casts one, and
    /// from which distances.
    fn collide(
        &mut self,
        numbers: &mut Numbers<S>,
        active: mask64x8<S>,
        extinction: f64x8<S>,
        sums: &mut Sums<S>,
    ) -> (mask64x8<S>, f64x8<S>);

    /// The transmittances of shadow rays have been found.
    fn lit(&mut self, found: Found<S>, sums: &mut Sums<S>);

    /// Who waits to begin: it has made its draw, or goes on with another point.
    fn done(&mut self) -> &mut mask64x8<S>;

    /// Who has made its draw, and who has to begin: nobody waits from now on.
    #[inline(always)]
    fn finish(&mut self) -> [mask64x8<S>; 2] {
        let done = *self.done();
        *self.done() = done & !done;
        [done, done]
    }
}

/// The pages of a technique.
pub trait Pages<'a>: Copy {
    /// The page of eight walks.
    type Page<S: Simd>: Page<S>;

    /// A page of which none has begun.
    fn page<S: Simd>(self, simd: S, world: World<'a>, walk: Walk<'a, S>) -> Self::Page<S>;
}
