//! Draws of sixteen lanes in step: all lanes use the same technique at the same time.
//!
//! Draw j is, bit for bit, the draw that [`super::walk::draw`] makes from stream j mod 16. A draw is a fixed list of
//! walks, so that lanes are not refilled. As walks of a bank, each step a whole draw, they took 1.2 times (AVX2) and
//! 1.6 times (AVX-512) as long: there each pack of eight waits for its own lookups.

use fearless_simd::Level;

use super::Method;
use super::subpath::{LaneFunctions, RodTracker};
use super::walk::draw_each;
use crate::setup::Setup;
use crate::walks::slots::{PackStreams, leave};
use crate::{DrawBuffer, Request};
use media::Lookups;
use media::sampling::FlightWithGaps;
use numeric::pack::{self, Hardware, Task, WIDTH};
use numeric::rng::{LANES, Random};
use numeric::{Lane, Pair};
use theory::problems::BidirectionalRod;
use theory::problems::bidirectional_rod::MAX_CHANNELS;

/// Makes the draws of a request on the hardware of a level. Returns the request where the hardware is too narrow,
/// or σ̂ has several values.
pub fn packets<'r>(
    level: Level,
    method: Method,
    setup: &Setup<BidirectionalRod>,
    medium: &Lookups,
    request: Request<'r>,
) -> Option<Request<'r>> {
    if setup.fields.sampling.with_gaps().is_none() {
        return Some(request);
    }
    let task = BatchDraws { method, setup, medium, request };
    pack::on(level, task).err().map(|task| task.request)
}

struct BatchDraws<'a, 'r> {
    method: Method,
    setup: &'a Setup<BidirectionalRod>,
    medium: &'a Lookups<'a>,
    request: Request<'r>,
}

impl Task for BatchDraws<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Hardware>(self, simd: S) {
        let Self { method, setup, medium, request: Request { streams, count, buffer } } = self;
        let Some(sampling) = setup.fields.sampling.with_gaps() else { return };
        buffer.make_room(count);
        buffer.defects.fill(0.0);
        let zero = Pair::splat(simd, 0.0);
        let begin = FlightWithGaps::new(zero, sampling);
        let ends = [begin, begin.from_end()];
        let [first, second] = streams.packs();
        let mut random = PackPair::<S>(first.awake(simd), second.awake(simd));
        let mut tracker = RodTracker::new(setup, zero, ends, InPairs { simd, medium });
        let mut rows = [[0.0; LANES]; MAX_CHANNELS];
        for base in (0..count).step_by(LANES) {
            let draws = LaneBatch { base, turn: streams.turn };
            let lives = draws.lives(count);
            let lives = Pair(simd.mask(lives & 0xff), simd.mask(lives >> WIDTH));
            let channels = draw_each(method, &mut tracker, lives, &mut random);
            for (row, value) in rows.iter_mut().zip(&tracker.values[..channels]) {
                value.store(row);
            }
            let mut lookups = [0.0; LANES];
            tracker.lookups.store(&mut lookups);
            draws.write(&rows[..channels], &lookups, buffer);
        }
        leave(streams, 0, u64::from(u8::MAX), random.0);
        leave(streams, 1, u64::from(u8::MAX), random.1);
        streams.turn = (streams.turn + count) % LANES;
    }
}

/// The lookups of both packs.
struct InPairs<'a, S> {
    simd: S,
    medium: &'a Lookups<'a>,
}

impl<S: Hardware> LaneFunctions<Pair<S::Pack>> for InPairs<'_, S> {
    #[inline(always)]
    fn extinction(&self, t: Pair<S::Pack>) -> Pair<S::Pack> {
        self.medium.pair(self.simd, t)
    }

    #[inline(always)]
    fn exp(&self, x: Pair<S::Pack>) -> Pair<S::Pack> {
        Pair(x.0.exp(), x.1.exp())
    }
}

/// The streams of both packs.
#[derive(Clone, Copy)]
struct PackPair<S: Hardware>(PackStreams<S>, PackStreams<S>);

impl<S: Hardware> Random<Pair<S::Pack>> for PackPair<S> {
    #[inline(always)]
    fn uniform(&mut self) -> Pair<S::Pack> {
        Pair(self.0.uniform(), self.1.uniform())
    }

    #[inline(always)]
    fn ln_uniform(&mut self) -> Pair<S::Pack> {
        Pair(self.0.ln_uniform(), self.1.ln_uniform())
    }

    #[inline(always)]
    fn uniform_where(&mut self, which: Pair<S::Mask>) -> Pair<S::Pack> {
        Pair(self.0.uniform_where(which.0), self.1.uniform_where(which.1))
    }

    #[inline(always)]
    fn ln_uniform_where(&mut self, which: Pair<S::Mask>) -> Pair<S::Pack> {
        Pair(self.0.ln_uniform_where(which.0), self.1.ln_uniform_where(which.1))
    }
}

/// Sixteen draws in a row, one from each lane in turn.
struct LaneBatch {
    base: usize,
    turn: usize,
}

impl LaneBatch {
    fn draw(&self, lane: usize) -> usize {
        self.base + (lane + LANES - self.turn) % LANES
    }

    /// Lanes that have one of `count` draws, as bits.
    fn lives(&self, count: usize) -> u64 {
        (0..LANES).fold(0, |bits, lane| bits | u64::from(self.draw(lane) < count) << lane)
    }

    /// Writes values and lookups of lanes into their draws.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a count
    fn write(&self, values: &[[f64; LANES]], lookups: &[f64; LANES], buffer: &mut DrawBuffer) {
        for lane in 0..LANES {
            let draw = self.draw(lane);
            let Some(own) = buffer.lookups.get_mut(draw) else { continue };
            *own = lookups[lane] as u32;
            for (row, value) in buffer.values.iter_mut().zip(values) {
                row[draw] = value[lane];
            }
        }
    }
}
