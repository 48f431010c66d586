//! Local-majorant Woodcock tracking: a walk that starts again at every segment boundary.
//!
//! Unbiased for: a σ̂ ≥ σ_t that is constant in pieces; refused elsewhere.
//!
//! ```text
//! in segment j: fly with the constant σ̄ⱼ; beyond its end, go to the boundary and start again
//! ```
//!
//! The exponential distribution has no memory. Draws and lookups are therefore distributed as those of `woodcock`
//! with the same piecewise-constant σ̂, which inverts the piecewise optical depth instead. Only the random numbers
//! differ: a boundary that is crossed takes those of one more step. Segments without extinction are left out.
//!
//! Draws are 0 or 1. Moments and cost are those of
//! `woodcock`.
//!
//! Source: Y. Yue, K. Iwasaki, B.-Y. Chen, Y. Dobashi, T. Nishita, *Unbiased, adaptive stochastic
//! sampling for rendering inhomogeneous participating media*, ACM Transactions on Graphics 29
//! (2010).
//!
//! ```toml
//! title = "An example of local-majorant"
//!
//! [problem.transmittance]
//! medium.exponential = { extinction = 1.6, rate = 0.8 }
//! span = [0, 5]
//! sampling.local-majorants.segments = 10
//! estimators = ["local-majorant"]
//! ```
#![cfg_attr(not(doctest), doc = media::draw_in_rust!())]

use super::woodcock::ZERO_OR_ONE;
use crate::walks::{self, Route, TentativeCollision, Walk};
use crate::{Draw, Estimator, Inputs, Kernel, Refusal, Request, Setup, Traits};
use media::sampling::BothWays;
use numeric::rng::Random;
use numeric::{CacheRow, Kept, Lane, kept};
use theory::Prediction;
use theory::collisions::rules::Null;
use theory::problems::Transmittance;
use theory::ray::atoms::zero_or_one;

/// Local-majorant tracking; a piecewise-constant σ̂ is its only input.
#[derive(Debug, Clone)]
pub struct LocalMajorant;

impl Estimator<Transmittance> for LocalMajorant {
    const INPUTS: Inputs = Inputs::SAMPLING;
    const PLAIN: Option<Self> = Some(Self);

    fn traits(&self) -> Traits {
        Traits { skips: true, ..Traits::of(Self::INPUTS) }
    }

    fn domain(&self, setup: &Setup<Transmittance>) -> Result<(), Refusal> {
        setup.fields.require_plain_unit(ZERO_OR_ONE)?;
        if !setup.fields.sampling.is_steps() {
            return Err(Refusal::mismatch("a piecewise-constant σ̂", "σ̂ has a slope"));
        }
        setup.residual().require_ratio_at_most(1.0, "σ̄ ≥ σ_t in every segment")
    }

    fn predict(&self, setup: &Setup<Transmittance>) -> Prediction {
        zero_or_one(setup.product(&Null).predict())
    }

    fn fill(&self, kernel: Kernel, setup: &Setup<Transmittance>, request: Request) {
        match Segments::of(setup) {
            Some(walk) => walks::fill(&walk, kernel, setup, request),
            None => walks::one_by_one(
                setup,
                request,
                #[inline(always)]
                |_, _| Draw::free([setup.fields.control_transmittance()], 0),
            ),
        }
    }
}

kept! {
    /// A walk in its segment.
    pub struct Hop<L> {
        segment: L,
        t: L,
        end: L,
        mean_free_path: L,
    }
}

/// Woodcock tracking from segment to segment. A step is a flight within a segment: no lane is delayed by lanes that
/// cross several.
#[derive(Clone, Copy)]
pub struct Segments<'a> {
    /// Beginning, end and mean free path of each segment.
    rows: &'a [CacheRow],
    /// The value of walks that pass.
    unit: f64,
}

impl<'a> Segments<'a> {
    /// The walk on a setup; `None` where no segment has an extinction: there are no collisions.
    #[inline(always)]
    pub fn of(setup: &'a Setup<Transmittance>) -> Option<Self> {
        let rows = setup.fields.sampling.stretches();
        (!rows.is_empty()).then_some(Self { rows, unit: setup.fields.control_transmittance() })
    }

    /// State at the beginning of a segment.
    #[inline(always)]
    fn enter<L: Lane>(&self, segment: L) -> Hop<L> {
        let [t, end, mean_free_path, ..] = segment.columns(self.rows);
        Hop { segment, t, end, mean_free_path }
    }
}

impl Walk for Segments<'_> {
    type State<L: Lane> = Hop<L>;

    const IS_NOWHERE: bool = true;
    const IS_FIXED: bool = true;
    const PAUSES: bool = true;

    #[inline(always)]
    fn begin<L: Lane>(&self, one: L, _: L::Mask, _: &mut impl Random<L>) -> Hop<L> {
        self.enter(one.each(0.0))
    }

    #[inline(always)]
    fn fly<L: Lane>(&self, hop: &mut Hop<L>, _: &mut Route<impl BothWays<L>>, depth: L) -> L::Mask {
        let t = depth.times_plus(hop.mean_free_path, hop.t);
        let inside = t.below(hop.end);
        hop.t.set_where(inside, t);
        inside
    }

    #[inline(always)]
    fn distance<L: Lane>(&self, hop: &Hop<L>, _: &Route<impl BothWays<L>>) -> L {
        hop.t
    }

    #[inline(always)]
    fn mean_free_path<L: Lane>(&self, hop: &Hop<L>, _: &Route<impl BothWays<L>>) -> L {
        hop.mean_free_path
    }

    #[inline(always)]
    fn collide<L: Lane>(
        &self,
        hop: &mut Hop<L>,
        _: &mut Route<impl BothWays<L>>,
        extinctions: &TentativeCollision<L>,
        _: &mut impl Random<L>,
    ) -> L::Mask {
        let TentativeCollision { inside, number, .. } = *extinctions;
        let is_real = number.below(extinctions.ratio());
        let last = hop.segment.each((self.rows.len() - 1) as f64);
        let crosses = !inside & hop.segment.below(last);
        hop.set_where(crosses, self.enter(hop.segment + 1.0));
        crosses | (inside & !is_real)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, hop: &Hop<L>, left: L::Mask, _: usize) -> L {
        L::select(left, hop.t.each(self.unit), hop.t.each(0.0))
    }
}
