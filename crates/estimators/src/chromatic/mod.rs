//! Walks through a body in which every channel has a medium of its own: common parts of furnaces and slabs.
//!
//! A walk of one walker carries the densities of all channels, and scores where it ends.

pub mod densities;
pub mod page;

use fearless_simd::Level;

use crate::setup::ChannelMedia;
use crate::setup::walker::Walker;
use crate::walks::hero::Weighing;
use crate::walks::{self, Walk};
use crate::{Draw, Estimated, Kernel, Refusal, Request, Setup};
use media::{Batches, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::collisions::particle::Event;
use theory::{Prediction, problems};

/// Events of a walk, each of which a known bug may replace.
pub trait WalkEvents: Copy {
    /// Factor of f in a channel at an event, given `σ_t/σ̂`, the albedo, and the density of the new direction in
    /// this channel.
    #[inline(always)]
    fn factor<L: Lane>(&self, event: Event, ratio: L, albedo: L, density: L) -> L {
        match event {
            Event::Transmitted => ratio.one_minus(),
            Event::Scattered => ratio * albedo * density,
            Event::Absorbed => ratio * albedo.one_minus(),
        }
    }

    /// True if the ratios of all channels are computed with the hero's σ̂.
    #[inline(always)]
    fn has_heros_majorant(&self) -> bool {
        false
    }

    /// True if all channels use the hero's phase function.
    #[inline(always)]
    fn has_heros_phase(&self) -> bool {
        false
    }

    /// Length of a flight through a slab that goes to a `depth`.
    #[inline(always)]
    fn flown<L: Lane>(&self, depth: L, cosine: L) -> L {
        depth / cosine
    }
}

/// The right steps.
#[derive(Clone, Copy)]
pub struct Right;

impl WalkEvents for Right {}

/// A walker, and the channels that its walks score.
#[derive(Clone, Copy)]
pub struct WalkerWeights<'a> {
    /// The walker.
    pub walker: &'a Walker,
    /// The weighting of walks by the balance heuristic.
    pub weighing: Weighing,
    /// True if all channels are scored; false if the hero's alone is.
    pub scores_all: bool,
}

impl<'a> WalkerWeights<'a> {
    /// A walker with the right weighting.
    pub fn new(walker: &'a Walker, scores_all: bool) -> Self {
        Self { walker, weighing: WEIGHING, scores_all }
    }
}

/// A body in which every channel has a medium of its own; its estimators have one [`page`].
pub trait Chromatic: Estimated<Fields = ChannelMedia, Value: problems::Channels> {
    /// The walk by steps; packs provide their [`Chromatic::fields`].
    fn walk<'a>(
        steps: impl WalkEvents,
        by: WalkerWeights<'a>,
        setup: &'a Setup<Self>,
        fields: &'a [Batches<'a>],
    ) -> impl Walk;

    /// The fields in space that packs look up.
    fn fields(setup: &Setup<Self>, level: Level) -> Vec<Batches<'_>> {
        let _ = (setup, level);
        Vec::new()
    }

    /// Makes one draw.
    #[inline(always)]
    fn draw(
        steps: impl WalkEvents,
        by: WalkerWeights,
        setup: &Setup<Self>,
        medium: &Lookups,
        random: &mut Stream,
    ) -> Draw<Self::Value> {
        let walk = Self::walk(steps, by, setup, &[]);
        walks::draw(&walk, setup.residual().sampling, medium, random)
    }

    /// Checks that σ̂ fits a walker, and that theory covers the body.
    ///
    /// # Errors
    ///
    /// What is violated, and where.
    fn require(setup: &Setup<Self>, walker: &Walker) -> Result<(), Refusal>;

    /// Bounds on the second moments of channels where draws are relative to the density of one walker.
    ///
    /// # Errors
    ///
    /// Why bounds do not exist, or how the draws are biased.
    fn second_moment_bounds(setup: &Setup<Self>, walker: &Walker) -> Result<Vec<f64>, Refusal>;

    /// Prediction for one channel a draw.
    fn predict_independent(setup: &Setup<Self>, heroes: &[f64]) -> Prediction;

    /// Prediction for all channels by the balance heuristic.
    fn predict_balanced(setup: &Setup<Self>, heroes: &[f64]) -> Prediction;

    /// Prediction for all channels relative to the density of one walker, given bounds on their second moments.
    fn predict_relative(
        setup: &Setup<Self>,
        walker: &Walker,
        second_moment_bounds: &[f64],
    ) -> Prediction;
}

/// Weighting by the balance heuristic without shadow rays.
pub const WEIGHING: Weighing = Weighing { has_next_event: false, ..Weighing::RIGHT };

/// Makes the draws of a request: compiled once for all walkers.
pub fn fill<P: Chromatic>(by: WalkerWeights, kernel: Kernel, setup: &Setup<P>, request: Request) {
    walks::by(
        kernel,
        setup,
        request,
        |level, medium, request| {
            let fields = P::fields(setup, level);
            walks::packets(level, &P::walk(Right, by, setup, &fields), setup, medium, request)
        },
        #[inline(always)]
        |medium, random| P::draw(Right, by, setup, medium, random),
    );
}
