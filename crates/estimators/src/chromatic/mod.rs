//! Walks through a body in which every channel has a medium of its own: what furnaces and slabs share.
//!
//! A walk of one walker carries the densities of all channels, and scores where it ends.

pub mod all_channels;
pub mod independent;

use fearless_simd::Level;

use crate::kernels::hero::{Path, Weighing};
use crate::kernels::packet::Request;
use crate::setup::heroes::Heroes;
use crate::setup::walker::Walker;
use crate::{Draw, Refusal, Setup};
use media::Lookups;
use media::body::MOST_CHANNELS;
use numeric::pack::in_fused_code;
use numeric::rng::Stream;
use theory::Prediction;
use theory::particle::Event;
use theory::problems::Problem;

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// What an event multiplies f by in a channel: the ratio `σ_t/σ̂`, the albedo, and the density of the new
    /// direction are those of this channel.
    #[inline(always)]
    fn factor(&self, event: Event, ratio: f64, albedo: f64, density: f64) -> f64 {
        match event {
            Event::Transmitted => 1.0 - ratio,
            Event::Scattered => ratio * albedo * density,
            Event::Absorbed => ratio * (1.0 - albedo),
        }
    }

    /// The channel whose σ̂ counts in a channel's ratio.
    #[inline(always)]
    fn majorant_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// The channel whose phase function counts in a channel.
    #[inline(always)]
    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// The length of a flight through a slab that goes so deep.
    #[inline(always)]
    fn flown(&self, depth: f64, cosine: f64) -> f64 {
        depth / cosine
    }
}

/// The right steps.
pub struct Right;

impl Steps for Right {}

/// What became of a walk.
pub struct Left<E> {
    /// Where it scores; `None` where it scores nothing.
    pub end: Option<E>,
    /// Its path.
    pub path: Path,
    /// Its tentative collisions.
    pub lookups: u32,
}

/// A body in which every channel has a medium of its own: the pages of its estimators are the same.
pub trait Chromatic: Problem {
    /// Where walks score.
    type End: Copy;

    /// Walks.
    fn walk(
        steps: &impl Steps,
        setup: &Setup<Self>,
        walker: (&Walker, usize),
        medium: &Lookups,
        rng: &mut Stream,
    ) -> Left<Self::End>;

    /// What a draw scores that ends somewhere.
    fn values(&self, end: Option<Self::End>, scores: &[f64; MOST_CHANNELS]) -> Self::Value;

    /// What every walker asks of σ̂, and whether theory knows the body.
    ///
    /// # Errors
    ///
    /// What is violated, and where.
    fn require(setup: &Setup<Self>, walker: &Walker) -> Result<(), Refusal>;

    /// Bounds on the second moments of channels where draws are relative to the density of one walker.
    ///
    /// # Errors
    ///
    /// Why there are none, or how the draws are biased.
    fn second_moment_bounds(setup: &Setup<Self>, walker: &Walker) -> Result<Vec<f64>, Refusal>;

    /// What theory says of one channel a draw.
    fn predict_independent(setup: &Setup<Self>, heroes: &[f64]) -> Prediction;

    /// Of all channels by the balance heuristic.
    fn predict_balanced(setup: &Setup<Self>, heroes: &[f64]) -> Prediction;

    /// Of all channels relative to the density of one walker, given bounds on their second moments.
    fn predict_relative(
        setup: &Setup<Self>,
        walker: &Walker,
        second_moment_bounds: &[f64],
    ) -> Prediction;

    /// The draws of a page on the hardware of a level, which score all channels or the hero's alone; a request is handed
    /// back where the hardware is too narrow.
    fn packets<'a, const ALL: bool>(
        level: Level,
        walker: &Walker,
        setup: &Setup<Self>,
        medium: &Lookups,
        request: Request<'a>,
    ) -> Option<Request<'a>>;
}

/// How the balance heuristic weights a walk: there are no shadow rays.
pub const WEIGHING: Weighing = Weighing { has_next_event: false, ..Weighing::RIGHT };

/// Makes one draw that scores all channels: compiled once for all walkers.
#[inline(never)]
pub fn draw_all<P: Chromatic>(
    walker: &Walker,
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<P::Value> {
    in_fused_code(
        #[inline(always)]
        || draw(&Right, (walker, WEIGHING), setup, medium, rng),
    )
}

/// Makes one draw that scores all channels, by the steps of a walk.
#[inline(always)]
pub fn draw<P: Chromatic>(
    steps: &impl Steps,
    (walker, weighing): (&Walker, Weighing),
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<P::Value> {
    let (problem, count) = (&*setup.problem, setup.channels.len());
    let hero = walker.choose(count, || rng.uniform());
    let Left { end, path, lookups } = P::walk(steps, setup, (walker, hero), medium, rng);
    if end.is_none() {
        return Draw::free(problem.values(None, &[0.0; MOST_CHANNELS]), lookups);
    }
    let Walker::Mis(heroes) = walker else {
        return Draw::free(problem.values(end, &path.relative(setup)), lookups);
    };
    let scores = path.score(setup, heroes, weighing);
    let weighted = scores[..count].iter().enumerate();
    let sum: f64 = weighted.map(|(channel, x)| heroes.probability(count, channel) * x).sum();
    Draw { value: problem.values(end, &scores), lookups, defect: (sum - 1.0).abs() }
}

/// Makes one draw that scores the channel of its hero.
#[inline(always)]
fn draw_alone<P: Chromatic>(
    (walker, heroes): (&Walker, &Heroes),
    setup: &Setup<P>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<P::Value> {
    let count = setup.channels.len();
    let hero = heroes.choose(count, rng.uniform());
    let Left { end, lookups, .. } = P::walk(&Right, setup, (walker, hero), medium, rng);
    let mut scores = [0.0; MOST_CHANNELS];
    scores[hero] = 1.0 / heroes.probability(count, hero);
    Draw::free(setup.problem.values(end, &scores), lookups)
}
