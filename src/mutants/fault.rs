//! The steps of a walk, one method each: a fault overrides one of them.

use crate::estimators::Setup;
use crate::media::{Control, Cursor, Extinction, Lookups, Piecewise};
use crate::numeric::Span;
use crate::problems::Problem;
use crate::rng::{Stream, exponential, unit};
use crate::theory::{Outcome, Rule};

/// What a walk remembers, whether it should or not.
pub struct Memory {
    /// The stretch that is walked.
    pub support: Span,
    /// Where the flight began: the collision before, or the beginning of the support.
    pub from: f64,
    /// How many lookups were made.
    pub lookups: u32,
    /// The weight before the last collision.
    pub before: f64,
    /// The generator as it stood at the beginning of the draw.
    pub beginning: Stream,
    /// A random number kept for later.
    pub number: Option<f64>,
    /// Another one.
    pub older: Option<f64>,
}

impl Memory {
    /// At the beginning of a draw.
    #[inline(always)]
    #[must_use]
    pub fn new(support: Span, weight: f64, rng: &Stream) -> Self {
        Self {
            support,
            from: support.from,
            lookups: 0,
            before: weight,
            beginning: *rng,
            number: None,
            older: None,
        }
    }
}

/// A mistake in one step of a walk; the default of every step is right.
pub trait Fault: Copy + Send + Sync + 'static {
    /// See [`super::Draws::REPLAYS`].
    const REPLAYS: bool = false;

    /// What is prepared once: σ̂ on the support, `T_c = exp(−∫σ_c)`.
    fn prepare<P: Problem>(&self, setup: Setup<P>) -> Setup<P> {
        setup
    }

    /// The optical depth of a flight through σ̂: exponential with mean 1.
    #[inline(always)]
    fn flight(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        let _ = memory;
        exponential(rng)
    }

    /// Flies to the next tentative collision and answers σ̂ there; `None` beyond the end.
    #[inline(always)]
    fn fly(&self, sampling: &Piecewise, cursor: &mut Cursor, depth: f64) -> Option<f64> {
        sampling.fly(cursor, depth)
    }

    /// `σ_t` at the collision.
    #[inline(always)]
    fn look(&self, memory: &Memory, medium: &Lookups, t: f64) -> f64 {
        let _ = memory;
        medium.extinction(t)
    }

    /// `σ_c` at the collision.
    #[inline(always)]
    fn control(&self, memory: &Memory, control: &Control, t: f64) -> f64 {
        let _ = memory;
        control.extinction(t)
    }

    /// `r = (σ_t − σ_c)/σ̂`.
    #[inline(always)]
    fn ratio(&self, sampling: &Piecewise, residual: f64, here: f64) -> f64 {
        let _ = sampling;
        residual * (1.0 / here)
    }

    /// `q` and the weight of a survivor, with `q · weight = 1 − r`.
    #[inline(always)]
    fn outcome<R: Rule>(&self, rule: &R, ratio: f64) -> Outcome {
        rule.outcome(ratio)
    }

    /// The number that decides: uniform, and independent of all others.
    #[inline(always)]
    fn number(&self, memory: &mut Memory, rng: &mut Stream) -> f64 {
        let _ = memory;
        unit(rng)
    }

    /// Whether a collision is real, given that the number says so.
    #[inline(always)]
    fn real(&self, memory: &Memory, real: bool) -> bool {
        let _ = memory;
        real
    }

    /// The weight after a collision.
    #[inline(always)]
    fn weigh(&self, memory: &Memory, weight: f64, factor: f64) -> f64 {
        let _ = memory;
        weight * factor
    }

    /// A walk ends nowhere but at the end or at a collision; `Some` ends it here with that value.
    #[inline(always)]
    fn stop(&self, memory: &Memory, weight: f64, rng: &mut Stream) -> Option<f64> {
        let _ = (memory, weight, rng);
        None
    }

    /// The draw of a walk that reached the end: its weight.
    #[inline(always)]
    fn end(&self, memory: &mut Memory, control: &Control, weight: f64) -> f64 {
        let _ = (memory, control);
        weight
    }

    /// The distance of a real collision, from the beginning of the ray.
    #[inline(always)]
    fn distance(&self, ray: Span, t: f64) -> f64 {
        t - ray.from
    }

    /// The distance of a flight that escapes: the length of the ray.
    #[inline(always)]
    fn escape(&self, memory: &Memory, ray: Span) -> f64 {
        let _ = memory;
        ray.length()
    }
}

/// No fault.
#[derive(Clone, Copy)]
pub struct Honest;

impl Fault for Honest {}
