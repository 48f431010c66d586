//! The driver of packs that take as many random numbers as they need: a particle bank.
//!
//! Draw j is, bit for bit, the draw that [`super::plain`] makes from stream j mod 16. A step takes all walks together
//! through their flights, lookups and collisions: event-based tracking.
//!
//! A walk that ends is replaced at once, so that no lane stands still. The number of draws of a lane is fixed
//! beforehand. A lane that has made them walks on until the others have; its stream is reset to the end of its last
//! draw.

use std::hint::black_box;

use super::outcomes::{self, Events, Groups, Outcomes};
use super::slots::{Slot, Slots, leave};
use super::{Route, SOME_LEFT, Scores, TentativeCollision, Walk};
use crate::{DrawBuffer, Request};
use media::body::MAX_CHANNELS;
use media::sampling::BothWays;
use numeric::pack::{self, Hardware, WIDTH};
use numeric::pair::PAIR_WIDTH;
use numeric::rng::{LANES, Random};
use numeric::{Lane, Mask, Pair};

/// Eight walks. The walk itself is outside the pack: a call may take its address, and would take that of the pack.
/// The state is outside, too: an index into a list of it would keep everything in memory.
struct Pack<L: Lane, C> {
    /// A distance inside the medium, for lanes that have no distance to look up.
    from: L,
    route: Route<C>,
    number: L,
    t: L,
    inside: L::Mask,
    goes_on: L::Mask,
    /// Number of lookups of walks that pause.
    lookups: L,
}

/// Numbers of eight finished draws. They are outside the pack: a compiler keeps the pack in registers only if none
/// of its fields needs a drop.
struct FinishedDraws {
    values: Vec<[f64; WIDTH]>,
    /// Numbers that eight walks leave, of which some have ended.
    left: Vec<[f64; WIDTH]>,
    defects: [f64; WIDTH],
    lookups: [f64; WIDTH],
    /// See [`Walk::PAUSES`].
    pause: bool,
    /// Outcomes of draws that are scored later, and of walks that score often.
    outcomes: Outcomes,
    events: Events,
}

impl<L: Lane, C: BothWays<L>> Pack<L, C> {
    #[inline(always)]
    fn new<W: Walk, S: Hardware<Pack = L>>(simd: S, course: C) -> Self {
        let zero = simd.splat(0.0);
        let all = zero.at_most(zero);
        Self {
            from: if W::ON_RAY { course.reached() } else { zero },
            route: Route::new(course),
            number: zero,
            t: zero,
            inside: all,
            goes_on: all,
            lookups: zero,
        }
    }

    /// Flies; returns the distances at which σ_t is looked up.
    #[inline(always)]
    fn fly<W: Walk>(
        &mut self,
        walk: &W,
        state: &mut W::State<L>,
        random: &mut impl Random<L>,
    ) -> L {
        let [depth, number] = walk.numbers(state, random);
        self.number = number;
        if W::ON_RAY && W::IS_CHROMATIC {
            self.route.here.change(walk.mean_free_path(state, &self.route));
        }
        self.inside = walk.fly(state, &mut self.route, depth);
        if W::ON_RAY {
            self.t = Lane::select(self.inside, walk.distance(state, &self.route), self.from);
        }
        self.t
    }

    /// Collides; returns the lanes with walks that end, as bits.
    #[inline(always)]
    fn collide<W: Walk>(
        &mut self,
        walk: &W,
        state: &mut W::State<L>,
        extinction: L,
        [extinctions, in_space]: [&[L]; 2],
        random: &mut impl Random<L>,
    ) -> u64 {
        let Self { inside, t, number, .. } = *self;
        let mean_free_path = if W::ON_RAY { walk.mean_free_path(state, &self.route) } else { t };
        let collided = TentativeCollision {
            inside,
            t,
            mean_free_path,
            extinction,
            extinctions,
            in_space,
            number,
        };
        if W::PAUSES {
            let mut counted = inside;
            if W::IN_SPACE {
                counted |= walk.in_space(state).0;
            }
            self.lookups.count_where(counted);
        }
        self.goes_on = walk.collide(state, &mut self.route, &collided, random);
        (!self.goes_on).bits()
    }

    /// Stores the events of a pack's walks that score often.
    #[inline(always)]
    fn score<W: Walk>(&self, walk: &W, state: &W::State<L>, pack: usize, rows: &mut FinishedDraws) {
        let which = walk.scores(state, !self.goes_on);
        if which.any() {
            let mut some = [self.from; SOME_LEFT];
            rows.leave(walk.leaves(state, &mut some));
            rows.events.push(pack, which.bits(), &rows.left);
        }
    }

    /// Makes draws of the walks of a pack that end, as bits; returns the lanes that have made their last one.
    #[inline(always)]
    fn collect<W: Walk>(
        &self,
        walk: &W,
        state: &W::State<L>,
        (pack, ended): (usize, u64),
        rows: &mut FinishedDraws,
        (slots, buffer): (&mut Slots, &mut DrawBuffer),
    ) -> u64 {
        if W::SCORES == Scores::AtOnce {
            for (channel, row) in rows.values.iter_mut().enumerate() {
                walk.value(state, !self.inside, channel).store(row);
            }
        }
        if W::HAS_DEFECT {
            walk.defect(state, self.t.each(0.0)).store(&mut rows.defects);
        }
        if W::PAUSES {
            let lookups = walk.lookups(state, self.lookups);
            lookups.store(&mut rows.lookups);
        }
        let inside = self.inside.bits();
        match W::SCORES {
            Scores::AtOnce => rows.write([ended, inside], slots, buffer),
            Scores::Later => {
                let mut some = [self.from; SOME_LEFT];
                rows.leave(walk.leaves(state, &mut some));
                rows.write_outcomes([ended, inside], slots, buffer)
            }
            Scores::Often => rows.write_events(pack, [ended, inside], slots, buffer),
        }
    }

    /// Replaces the walks that ended.
    #[inline(always)]
    fn restart<W: Walk>(&mut self, walk: &W, state: &mut W::State<L>, random: &mut impl Random<L>) {
        let ended = !self.goes_on;
        walk.restart(state, ended, self.from.each(1.0), random);
        self.route.here.restart(ended);
        if W::PAUSES {
            self.lookups.set_where(ended, self.from.each(0.0));
        }
    }
}

impl FinishedDraws {
    /// Memory for the numbers that the walks of a request leave.
    #[inline(always)]
    fn new<L: Lane, W: Walk>(
        walk: &W,
        state: &W::State<L>,
        one: L,
        (draws, buffer): (usize, &mut DrawBuffer),
    ) -> Self {
        let numbers = outcomes::count(walk.leaves(state, &mut [one; SOME_LEFT]));
        let rows = [walk.channels(), numbers];
        Self::with_room((W::SCORES, W::PAUSES), rows, draws, &mut buffer.outcomes)
    }

    #[inline(never)]
    fn with_room(
        (scored, pause): (Scores, bool),
        [channels, numbers]: [usize; 2],
        draws: usize,
        room: &mut Vec<f64>,
    ) -> Self {
        let none = [0.0; WIDTH];
        let of = |scores, count: usize| if scored == scores { count } else { 0 };
        Self {
            values: vec![none; of(Scores::AtOnce, channels)],
            left: vec![none; numbers - 1],
            defects: none,
            lookups: none,
            pause,
            outcomes: Outcomes::new(numbers, of(Scores::Later, draws), room),
            events: Events::new(numbers, of(Scores::Often, draws), room),
        }
    }

    /// Stores the numbers that walks leave, of all lanes.
    #[inline(always)]
    fn leave<L: Lane>(&mut self, groups: Groups<L>) {
        let mut rows = self.left.iter_mut();
        for group in groups {
            for (lanes, row) in group.iter().zip(&mut rows) {
                lanes.store(row);
            }
        }
    }

    /// Writes the draws of some lanes, as bits; returns the lanes that have made their last one.
    #[inline(never)]
    fn write(&self, [ended, inside]: [u64; 2], slots: &mut Slots, buffer: &mut DrawBuffer) -> u64 {
        let DrawBuffer { values, lookups, defects, .. } = buffer;
        // One value, and reflectance with transmittance, are what most walks have.
        match (&mut values[..], &self.values[..]) {
            ([values], [row]) => {
                return slots.fill(ended, |slot| {
                    values[slot.draw] = row[slot.lane];
                    defects[slot.draw] = self.defects[slot.lane];
                    lookups[slot.draw] = self.lookups(inside, slot);
                });
            }
            ([values, others], [row, other]) => {
                return slots.fill(ended, |slot| {
                    values[slot.draw] = row[slot.lane];
                    others[slot.draw] = other[slot.lane];
                    defects[slot.draw] = self.defects[slot.lane];
                    lookups[slot.draw] = self.lookups(inside, slot);
                });
            }
            _ => {}
        }
        slots.fill(ended, |slot| {
            for (channel, row) in values.iter_mut().zip(&self.values) {
                channel[slot.draw] = row[slot.lane];
            }
            defects[slot.draw] = self.defects[slot.lane];
            lookups[slot.draw] = self.lookups(inside, slot);
        })
    }

    /// Writes the numbers from which draws are scored later.
    #[inline(never)]
    fn write_outcomes(
        &mut self,
        [ended, inside]: [u64; 2],
        slots: &mut Slots,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        slots.fill(ended, |slot| {
            let left = if inside >> slot.lane & 1 == 1 { 0.0 } else { 1.0 };
            self.outcomes.write(slot.draw, left, &self.left, slot.lane);
            buffer.lookups[slot.draw] = self.lookups(inside, slot);
        })
    }

    /// Assigns the stored events of finished walks to their draws.
    #[inline(never)]
    fn write_events(
        &mut self,
        pack: usize,
        [ended, inside]: [u64; 2],
        slots: &mut Slots,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        let over = slots.fill(ended, |slot| {
            self.events.belong(pack, slot.lane, slot.draw);
            buffer.defects[slot.draw] = 0.0;
            buffer.lookups[slot.draw] = self.lookups(inside, slot);
        });
        self.events.forget(pack, ended);
        over
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
    fn lookups(&self, inside: u64, Slot { lane, steps, .. }: Slot) -> u32 {
        if self.pause {
            self.lookups[lane] as u32
        } else {
            // The last step of a walk that leaves makes no lookup.
            steps + (inside >> lane & 1) as u32
        }
    }

    /// Returns the memory for numbers to the buffer.
    fn give_back(self, scored: Scores, buffer: &mut DrawBuffer) {
        match scored {
            Scores::AtOnce => {}
            Scores::Later => buffer.outcomes = self.outcomes.into_room(),
            Scores::Often => buffer.outcomes = self.events.into_room(),
        }
    }

    /// Computes values from the numbers that walks left.
    #[inline(always)]
    fn score<S: Hardware, W: Walk>(&self, simd: S, walk: W, draws: usize, buffer: &mut DrawBuffer) {
        match W::SCORES {
            Scores::AtOnce => {}
            Scores::Later => pack::outlined(
                simd,
                #[inline(always)]
                move || self.outcomes.score(simd, &walk, draws, buffer),
            ),
            Scores::Often => pack::outlined(
                simd,
                #[inline(always)]
                move || self.events.score(simd, &walk, buffer),
            ),
        }
    }
}

/// Makes the draws of a request. Both packs take each step together: `look_up` returns σ_t of sixteen lanes in a
/// channel.
#[inline(always)]
pub fn run<S: Hardware, W: Walk, C: BothWays<S::Pack>>(
    simd: S,
    walk: W,
    course: C,
    look_up: impl Fn(usize, Pair<S::Pack>) -> Pair<S::Pack>,
    request: Request,
) {
    let Request { streams, count, buffer } = request;
    buffer.make_room(count);
    let turn = streams.turn;
    let [mut first, mut second] = streams.packs().map(
        #[inline(always)]
        |lanes| lanes.awake(simd),
    );
    // Two names, no array: an index keeps an array in memory, and AVX2 then uses masked stores.
    let (mut pack, mut other) = (Pack::new::<W, S>(simd, course), Pack::new::<W, S>(simd, course));
    let (one, all) = (simd.splat(1.0), simd.mask(u64::MAX));
    let mut state = walk.begin(one, all, &mut first);
    let mut other_state = walk.begin(one, all, &mut second);
    let mut rows = FinishedDraws::new::<S::Pack, W>(&walk, &state, one, (count, &mut *buffer));
    let (mut slots, mut other_slots) = (Slots::new(count, turn, 0), Slots::new(count, turn, 1));
    let none = [simd.splat(0.0); MAX_CHANNELS];
    let (mut channels, mut other_channels) = (none, none);
    let mut in_space = [none; 2];
    let media = if W::IS_CHROMATIC { walk.media() } else { 0 };
    let there = if W::IS_CHROMATIC { media } else { MAX_CHANNELS };
    let own = &walk;
    while slots.are_open() || other_slots.are_open() {
        // LLVM copies a loop for each of its constant conditions, and these walks have many.
        let is_branched =
            const { W::IN_SPACE || W::IS_CHROMATIC && !matches!(W::SCORES, Scores::AtOnce) };
        let walk = if is_branched { black_box(own) } else { own };
        let t = Pair(
            pack.fly(walk, &mut state, &mut first),
            other.fly(walk, &mut other_state, &mut second),
        );
        let mut result = Pair(none[0], none[0]);
        if W::ON_RAY && W::IS_CHROMATIC {
            for channel in 0..media {
                let Pair(here, there) = look_up(channel, t);
                (channels[channel], other_channels[channel]) = (here, there);
            }
        } else if W::ON_RAY {
            result = look_up(0, t);
        }
        if W::IN_SPACE {
            look_up_in_space(simd, walk, [&state, &other_state], &mut in_space);
        }
        let others = [&channels[..media], &in_space[0][..there]];
        let ended = pack.collide(walk, &mut state, result.0, others, &mut first);
        let others = [&other_channels[..media], &in_space[1][..there]];
        let other_ended = other.collide(walk, &mut other_state, result.1, others, &mut second);
        if W::SCORES == Scores::Often {
            pack.score(walk, &state, 0, &mut rows);
            other.score(walk, &other_state, 1, &mut rows);
        }
        if ended != 0 {
            let draws = (&mut slots, &mut *buffer);
            let over = pack.collect(walk, &state, (0, ended), &mut rows, draws);
            leave(streams, 0, over, first);
            pack.restart(walk, &mut state, &mut first);
        }
        if other_ended != 0 {
            let draws = (&mut other_slots, &mut *buffer);
            let over = other.collect(walk, &other_state, (1, other_ended), &mut rows, draws);
            leave(streams, 1, over, second);
            other.restart(walk, &mut other_state, &mut second);
        }
        slots.step();
        other_slots.step();
    }
    rows.score(simd, walk, count, buffer);
    rows.give_back(W::SCORES, buffer);
    streams.turn = (turn + count) % LANES;
}

/// Looks fields up in space for both packs, if a lane has a collision there.
#[inline(always)]
fn look_up_in_space<S: Hardware, W: Walk>(
    simd: S,
    walk: &W,
    [here, there]: [&W::State<S::Pack>; 2],
    [result, other]: &mut [[S::Pack; MAX_CHANNELS]; 2],
) {
    let ((inside, place), (other_inside, other_place)) =
        (walk.in_space(here), walk.in_space(there));
    if !(inside | other_inside).any() {
        return;
    }
    let mut places = [[0.0; PAIR_WIDTH]; 3];
    for (axis, row) in places.iter_mut().enumerate() {
        Pair(place[axis], other_place[axis]).store(row);
    }
    let fields = walk.fields();
    if W::IS_CHROMATIC {
        for (number, field) in fields.iter().enumerate() {
            Pair(result[number], other[number]) = field.pair(simd, &places);
        }
        return;
    }
    // No index: the loop keeps one pack in registers.
    Pair(result[0], other[0]) = fields[0].pair(simd, &places);
    if let Some(second) = fields.get(1) {
        Pair(result[1], other[1]) = second.pair(simd, &places);
    }
}
