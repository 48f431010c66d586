//! Drivers of walks in space: two packs of eight walks, and one walk alone.
//!
//! Both make the same draws, bit for bit: draw j of a request comes from stream j mod 16.
//!
//! ```text
//! fly       each walk flies to its next collision
//! look up   one call for all sixteen places
//! collide   some walks end: they make draws and are replaced at once
//! go on     expensive events are delayed until several lanes need them
//! ```
//!
//! A step has no branches: the events of walks are masks, and streams without a requested number do not move.
//!
//! Source: F. B. Brown, W. R. Martin, *Monte Carlo methods for radiation transport analysis on vector computers*, Progress in
//! Nuclear Energy 14 (1984).

use fearless_simd::{Simd, SimdBase, f64x8};

use crate::DrawBuffer;
use crate::kernels::Request;
use crate::kernels::bank::{Numbers, Slot, Slots, leave};
use numeric::pack::WIDTH;
use numeric::rng::{LANES, Random};
use numeric::twin::PAIR;
use numeric::{Lane, Mask, Single};

/// A walk in space, as one formula for every lane type.
pub trait Walk {
    /// The state of a walk, its place included.
    type State<L: Lane>: Copy;

    /// A flight.
    type Flight<L: Lane>: Copy;

    /// The fields at a place.
    type Met<L: Lane>: Copy;

    /// Lanes of a pack that [`Walk::go_on`] together.
    const TOGETHER: u32 = 1;

    /// Walks that have all ended.
    fn none<L: Lane>(&self, one: L) -> Self::State<L>;

    /// Replaces walks that have ended.
    fn restart<L: Lane>(&self, state: &mut Self::State<L>, random: &mut impl Random<L>);

    /// Flies; returns the places at which fields are looked up.
    fn fly<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        random: &mut impl Random<L>,
    ) -> (Self::Flight<L>, [L; 3]);

    /// Lanes that need the fields at the end of a flight.
    fn inside<L: Lane>(flight: &Self::Flight<L>) -> L::Mask;

    /// Collides; returns the lanes with walks that end.
    fn collide<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        flight: &Self::Flight<L>,
        met: Self::Met<L>,
        random: &mut impl Random<L>,
    ) -> L::Mask;

    /// Handles expensive events, once at least `together` lanes need them.
    #[inline(always)]
    fn go_on<L: Lane>(
        &self,
        state: &mut Self::State<L>,
        together: u32,
        random: &mut impl Random<L>,
    ) {
        let _ = (state, together, random);
    }

    /// The number of numbers that walks leave.
    fn count(&self) -> usize;

    /// Writes the numbers that walks leave, number by number.
    fn store<L: Lane>(&self, state: &Self::State<L>, rows: &mut [[f64; WIDTH]]);

    /// Lookups of a walk.
    fn lookups<L: Lane>(state: &Self::State<L>) -> L;
}

/// Makes one draw: follows a walk to its end.
#[inline(always)]
pub fn one<L: Single, W: Walk>(
    walk: &W,
    look_up: impl Fn(Option<[L; 3]>) -> W::Met<L>,
    random: &mut impl Random<L>,
) -> W::State<L> {
    let mut state = walk.none(L::of(1.0));
    walk.restart(&mut state, random);
    loop {
        walk.go_on(&mut state, 1, random);
        let (flight, place) = walk.fly(&mut state, random);
        let met = look_up(W::inside(&flight).then_some(place));
        if walk.collide(&mut state, &flight, met, random) {
            return state;
        }
    }
}

/// The numbers that eight walks leave. They are outside the pack: a compiler keeps the pack in registers only if no
/// index reaches it.
pub struct Rows {
    /// Rows, number by number.
    pub numbers: Vec<[f64; WIDTH]>,
    /// Lookups.
    pub lookups: [f64; WIDTH],
}

/// Makes the draws of a request. Both packs take each step together: `look_up` returns σ_t of sixteen places, and
/// `write` writes the draws of finished walks of a pack.
#[inline(always)]
pub fn run<S: Simd, W: Walk>(
    simd: S,
    walk: &W,
    look_up: impl Fn(&[[f64; PAIR]; 3]) -> [W::Met<f64x8<S>>; 2],
    request: Request,
    mut write: impl FnMut(&Rows, Slot, &mut DrawBuffer),
) {
    let Request { streams, count, buffer } = request;
    buffer.make_room(count);
    let (turn, one) = (streams.turn, f64x8::splat(simd, 1.0));
    let [first, second] = streams.packs();
    let (mut slots, mut other_slots) = (Slots::new(count, turn, 0), Slots::new(count, turn, 1));
    // Two names, no array: an index keeps an array in memory, and AVX2 then uses masked stores.
    let (mut pack, mut first) = begin(walk, one, first.awake(simd));
    let (mut other, mut second) = begin(walk, one, second.awake(simd));
    let mut rows = Rows { numbers: vec![[0.0; WIDTH]; walk.count()], lookups: [0.0; WIDTH] };
    while slots.are_open() || other_slots.are_open() {
        let mut points = [[0.0; PAIR]; 3];
        let flight = fly(walk, &mut pack, &mut first, 0, &mut points);
        let other_flight = fly(walk, &mut other, &mut second, WIDTH, &mut points);
        let [met, other_met] = look_up(&points);
        let ended = walk.collide(&mut pack, &flight, met, &mut first);
        if ended.any() {
            rows.store(walk, &pack);
            let over = rows.write(ended.bits(), &mut slots, buffer, &mut write);
            leave(streams, 0, over, first);
            walk.restart(&mut pack, &mut first);
        }
        walk.go_on(&mut pack, W::TOGETHER, &mut first);
        let ended = walk.collide(&mut other, &other_flight, other_met, &mut second);
        if ended.any() {
            rows.store(walk, &other);
            let over = rows.write(ended.bits(), &mut other_slots, buffer, &mut write);
            leave(streams, 1, over, second);
            walk.restart(&mut other, &mut second);
        }
        walk.go_on(&mut other, W::TOGETHER, &mut second);
    }
    streams.turn = (turn + count) % LANES;
}

/// Begins eight walks and their streams. It returns values, because references would keep both in memory.
#[inline(always)]
fn begin<S: Simd, W: Walk>(
    walk: &W,
    one: f64x8<S>,
    mut random: Numbers<S>,
) -> (W::State<f64x8<S>>, Numbers<S>) {
    one.outlined_if_narrow(
        #[inline(always)]
        move || {
            let mut pack = walk.none(one);
            walk.restart(&mut pack, &mut random);
            walk.go_on(&mut pack, W::TOGETHER, &mut random);
            (pack, random)
        },
    )
}

#[inline(always)]
fn fly<S: Simd, W: Walk>(
    walk: &W,
    pack: &mut W::State<f64x8<S>>,
    random: &mut Numbers<S>,
    from: usize,
    points: &mut [[f64; PAIR]; 3],
) -> W::Flight<f64x8<S>> {
    let (flight, place) = walk.fly(pack, random);
    for (axis, row) in points.iter_mut().enumerate() {
        place[axis].store_slice(&mut row[from..][..WIDTH]);
    }
    flight
}

impl Rows {
    #[inline(always)]
    fn store<S: Simd, W: Walk>(&mut self, walk: &W, pack: &W::State<f64x8<S>>) {
        walk.store(pack, &mut self.numbers);
        W::lookups(pack).store_slice(&mut self.lookups);
    }

    /// Writes the draws of some lanes, as bits; returns the lanes that have made their last one.
    #[inline(never)]
    fn write(
        &self,
        ended: u64,
        slots: &mut Slots,
        buffer: &mut DrawBuffer,
        write: &mut impl FnMut(&Self, Slot, &mut DrawBuffer),
    ) -> u64 {
        slots.fill(ended, |slot| write(self, slot, buffer))
    }
}
