//! Order-free draws: the walks of a request side by side, one collision after the other.
//!
//! Specification: the draws of a request, in no order, have the law of as many draws of
//! [`crate::transmittance::product`]; their numbers of lookups have the law of [`CountLaw::in_layers`].
//!
//! A product estimator does not care in which order its collisions come, and they lie as they like:
//!
//! ```text
//! X = T_c ∏ Wᵢ,  N ~ Poisson(Λ),  Λ = ∫σ̂,  t₁ … t_N independent with density σ̂/Λ
//! ```
//!
//! So a request is made in layers. Of the m walks that have had i collisions,
//! Binomial(m, P(N = i)/P(N ≥ i)) have no more of them: they have escaped. All others have one more
//! collision, anywhere, and those that survive it are moved together. No logarithm, no lane that
//! waits, no branch that depends on a walk; the price is that the draws of a request come sorted by
//! their lookups, that a walk keeps no invariant, and that one that is killed had seen not the first
//! collisions of its ray but any.
//!
//! Where the collisions of a layer lie is the same for every σ̂ that is constant, whatever control
//! and rule. Experiments that find their random numbers at one address can so share all lookups:
//! each makes the draws that it would make alone ([`draw`]). One that is alone, with one σ̂ and one
//! σ_c, keeps 256 of its collisions at hand only (`layer.rs`).
//!
//! Source: the layers are the multinomial histogram of N, drawn bin by bin; binomial numbers by
//! `rand_distr`.
//!
//! [`CountLaw::in_layers`]: theory::CountLaw::in_layers

pub mod collisions;
mod layer;
pub mod walks;

use fearless_simd::{Level, Simd, SimdBase, u64x8};

use media::{Lookups, Placement};
use numeric::Twin;
use numeric::pack::{self, Task, WIDTH};
use numeric::rng::{Lanes, Xoshiro};
use numeric::twin::PAIR;
pub use walks::{OrderFree, Request, product};

/// Collisions that are looked up together: their numbers stay in the first-level cache.
pub const BATCH: usize = 512;

/// The streams of a layer.
#[derive(Clone, Copy)]
pub struct Streams<'a> {
    /// Where collisions lie.
    pub places: &'a Lanes,
    /// What becomes of the walks; not looked at where chance does not decide.
    pub decisions: &'a Lanes,
}

/// What is known of each collision of a batch.
#[repr(align(64))]
pub struct Sites {
    /// The distances.
    pub t: [f64; BATCH],
    /// `σ_t` there.
    pub extinction: [f64; BATCH],
    /// `σ̂` there, where it varies.
    pub sampling: [f64; BATCH],
    /// The numbers in `[0, 1)` that decide what becomes of the walks.
    pub decision: [f64; BATCH],
    /// How many there are, in whole pairs of packs.
    pub length: usize,
}

impl Sites {
    fn empty() -> Box<Self> {
        let none = [0.0; BATCH];
        Box::new(Self { t: none, extinction: none, sampling: none, decision: none, length: 0 })
    }
}

/// Makes the draws of requests that share their places, on the hardware of a level: one by itself, or
/// several whose σ̂ is constant. Each makes the draws that it would make alone.
pub fn draw(
    level: Level,
    medium: &Lookups,
    placement: &Placement,
    places: &Lanes,
    requests: &mut [&mut dyn OrderFree],
) {
    let mut sites: Option<Box<Sites>> = None;
    let decides = requests.iter().any(|walks| walks.decides());
    for layer in 0.. {
        for walks in requests.iter_mut() {
            walks.escape(layer);
        }
        let most = requests.iter().map(|walks| walks.walking()).max().unwrap_or(0);
        if most == 0 {
            return;
        }
        // Streams of the layer: how far others went in the one before does not matter.
        let mut chance = places.branch(level, 2 * layer);
        let mut fate = if decides { places.branch(level, 2 * layer + 1) } else { chance };
        let is_done = if let [alone] = requests {
            let streams = Streams { places: &chance, decisions: &fate };
            alone.collide_alone(level, medium, placement, streams)
        } else {
            false
        };
        if !is_done {
            let sites = sites.get_or_insert_with(Sites::empty);
            for first in (0..most).step_by(BATCH) {
                sites.length = BATCH.min((most - first).next_multiple_of(PAIR));
                let (chance, sites) = (&mut chance, &mut **sites);
                pack::on(level, Place { placement, chance, sites: &mut *sites });
                let length = sites.length;
                sites.extinction[..length].copy_from_slice(&sites.t[..length]);
                medium.replace_all(&mut sites.extinction[..length]);
                if decides {
                    pack::on(level, Decide { fate: &mut fate, sites });
                }
                for walks in requests.iter_mut() {
                    walks.collide(level, sites, first);
                }
            }
        }
        for walks in requests.iter_mut() {
            walks.close(layer);
        }
    }
}

/// Finds places of collisions, and σ̂ there.
struct Place<'a> {
    placement: &'a Placement<'a>,
    chance: &'a mut Lanes,
    sites: &'a mut Sites,
}

impl Task for Place<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { placement, chance, sites } = self;
        let mut stream: Xoshiro<u64x8<S>> = chance.awake(simd);
        let varies = placement.single_value().is_none();
        let [all_t, all_sampling] = [&mut sites.t, &mut sites.sampling].map(pairs);
        for number in 0..sites.length / PAIR {
            let (t, sampling) = placement.at(Twin(stream.uniform(), stream.uniform()));
            t.store_slice(&mut all_t[number]);
            if varies {
                sampling.store_slice(&mut all_sampling[number]);
            }
        }
        *chance = stream.at_rest();
    }
}

#[inline(always)]
fn pairs(row: &mut [f64; BATCH]) -> &mut [[f64; PAIR]] {
    row.as_chunks_mut().0
}

struct Decide<'a> {
    fate: &'a mut Lanes,
    sites: &'a mut Sites,
}

impl Task for Decide<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let mut stream: Xoshiro<u64x8<S>> = self.fate.awake(simd);
        for decision in self.sites.decision[..self.sites.length].as_chunks_mut::<WIDTH>().0 {
            stream.uniform().store_slice(decision);
        }
        *self.fate = stream.at_rest();
    }
}
