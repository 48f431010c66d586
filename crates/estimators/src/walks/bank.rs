//! The driver of packs that take as many random numbers as they need: a particle bank.
//!
//! Draw j is, bit for bit, the draw that [`super::plain`] makes from stream j mod 16.
//!
//! A walk that ends is replaced at once, so that no lane waits. How many draws a lane makes is fixed beforehand. A lane that
//! has made them walks on until the others have; its stream stays where its last draw left it.

use std::hint::black_box;

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Met, Route, Walk};
use crate::kernels::DrawBuffer;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{Numbers, Slot, Slots, leave};
use media::body::MOST_CHANNELS;
use media::course::BothWays;
use numeric::pack::WIDTH;
use numeric::rng::LANES;
use numeric::twin::PAIR;
use numeric::{Lane, Mask, Twin};

/// Eight walks. The walk itself is no part of it: a call may take its address, and would take that of the pack.
struct Pack<L: Lane, W: Walk, C> {
    /// A distance inside the medium, where lanes look σ_t up that need it nowhere.
    from: L,
    route: Route<C>,
    state: W::State<L>,
    number: L,
    t: L,
    inside: L::Mask,
    goes_on: L::Mask,
    /// Lookups, where walks pause.
    lookups: L,
}

/// Numbers that eight draws are made of. They are no part of the pack, which a compiler keeps in registers only where nothing of it needs to
/// be dropped.
struct Rows {
    values: Vec<[f64; WIDTH]>,
    defects: [f64; WIDTH],
    lookups: [f64; WIDTH],
}

impl<S: Simd, W: Walk, C: BothWays<f64x8<S>>> Pack<f64x8<S>, W, C> {
    #[inline(always)]
    fn new(simd: S, walk: &W, course: C, random: &mut Numbers<S>) -> Self {
        let (zero, all) = (f64x8::splat(simd, 0.0), mask64x8::splat(simd, true));
        let state = walk.begin(f64x8::splat(simd, 1.0), all, random);
        Self {
            from: course.reached(),
            route: Route::new(course),
            state,
            number: zero,
            t: zero,
            inside: all,
            goes_on: all,
            lookups: zero,
        }
    }

    /// Flies; answers the distances at which σ_t is looked up.
    #[inline(always)]
    fn fly(&mut self, walk: &W, random: &mut Numbers<S>) -> f64x8<S> {
        let [depth, number] = walk.numbers(&mut self.state, random);
        self.number = number;
        self.inside = walk.fly(&mut self.state, &mut self.route, depth);
        self.t = Lane::select(self.inside, walk.distance(&self.state, &self.route), self.from);
        self.t
    }

    /// Collides; answers as bits which walks end.
    #[inline(always)]
    fn collide(
        &mut self,
        walk: &W,
        extinction: f64x8<S>,
        on_shadow: &[f64x8<S>],
        random: &mut Numbers<S>,
    ) -> u64 {
        let Self { inside, t, number, .. } = *self;
        let mean_free_path = walk.mean_free_path(&self.state, &self.route);
        let met = Met { inside, t, mean_free_path, extinction, on_shadow, number };
        if W::PAUSES {
            let mut counted = inside;
            if W::CASTS {
                counted |= walk.on_shadow_rays(&self.state).0;
            }
            self.lookups.count_where(counted);
        }
        self.goes_on = walk.collide(&mut self.state, &mut self.route, &met, random);
        (!self.goes_on).bits()
    }

    /// Makes draws of the walks that end, as bits; answers the lanes that have made their last one.
    #[inline(always)]
    fn collect(
        &self,
        walk: &W,
        ended: u64,
        rows: &mut Rows,
        slots: &mut Slots,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        for (channel, row) in rows.values.iter_mut().enumerate() {
            walk.value(&self.state, !self.inside, channel).store_slice(row);
        }
        if W::HAS_DEFECT {
            walk.defect(&self.state, self.t.each(0.0)).store_slice(&mut rows.defects);
        }
        if W::PAUSES {
            let lookups = walk.lookups(&self.state, self.lookups);
            lookups.store_slice(&mut rows.lookups);
        }
        rows.write::<W>(ended, self.inside.bits(), slots, buffer)
    }

    /// Replaces the walks that ended.
    #[inline(always)]
    fn restart(&mut self, walk: &W, random: &mut Numbers<S>) {
        let ended = !self.goes_on;
        walk.restart(&mut self.state, ended, self.from.each(1.0), random);
        self.route.here.restart(ended);
        if W::PAUSES {
            self.lookups.set_where(ended, self.from.each(0.0));
        }
    }
}

impl Rows {
    /// Writes the draws of some lanes, as bits; answers the lanes that have made their last one.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
    fn write<W: Walk>(
        &self,
        ended: u64,
        inside: u64,
        slots: &mut Slots,
        buffer: &mut DrawBuffer,
    ) -> u64 {
        slots.fill(ended, |Slot { lane, draw, steps }| {
            for (channel, row) in buffer.values.iter_mut().zip(&self.values) {
                channel[draw] = row[lane];
            }
            buffer.defects[draw] = self.defects[lane];
            buffer.lookups[draw] = if W::PAUSES {
                self.lookups[lane] as u32
            } else {
                // The step that leaves looks nothing up.
                steps + (inside >> lane & 1) as u32
            };
        })
    }
}

/// Makes the draws of a request. Both packs take each step together: `look_up` answers for sixteen lanes.
#[inline(always)]
pub fn run<S: Simd, W: Walk, C: BothWays<f64x8<S>>>(
    simd: S,
    walk: W,
    course: C,
    look_up: impl Fn(Twin<f64x8<S>>) -> Twin<f64x8<S>>,
    request: Request,
) {
    let Request { streams, count, buffer } = request;
    buffer.make_room(count);
    let turn = streams.turn;
    let [mut first, mut second] = streams.packs().map(
        #[inline(always)]
        |lanes| lanes.awake(simd),
    );
    // Two names, no array: what an index reaches lies in memory, and AVX2 then chooses by masked stores.
    let mut pack = Pack::new(simd, &walk, course, &mut first);
    let mut other = Pack::new(simd, &walk, course, &mut second);
    let mut on_shadow = [[f64x8::splat(simd, 0.0); MOST_CHANNELS]; 2];
    let none = [0.0; WIDTH];
    let mut rows = Rows { values: vec![none; walk.channels()], defects: none, lookups: none };
    let (mut slots, mut other_slots) = (Slots::new(count, turn, 0), Slots::new(count, turn, 1));
    let own = &walk;
    while slots.are_open() || other_slots.are_open() {
        // LLVM copies a loop for each of its constant conditions, of which these walks have many.
        let walk = if const { W::CASTS } { black_box(own) } else { own };
        let found = look_up(Twin(pack.fly(walk, &mut first), other.fly(walk, &mut second)));
        if W::CASTS {
            look_up_shadows(simd, walk, [&pack.state, &other.state], &mut on_shadow);
        }
        let [here, there] = &on_shadow;
        let ended = pack.collide(walk, found.0, here, &mut first);
        let other_ended = other.collide(walk, found.1, there, &mut second);
        if ended != 0 {
            let over = pack.collect(walk, ended, &mut rows, &mut slots, buffer);
            leave(streams, 0, over, first);
            pack.restart(walk, &mut first);
        }
        if other_ended != 0 {
            let over = other.collect(walk, other_ended, &mut rows, &mut other_slots, buffer);
            leave(streams, 1, over, second);
            other.restart(walk, &mut second);
        }
        slots.step();
        other_slots.step();
    }
    streams.turn = (turn + count) % LANES;
}

/// Looks σ_t up on the shadow rays of both packs, if there are any.
#[inline(always)]
fn look_up_shadows<S: Simd, W: Walk>(
    simd: S,
    walk: &W,
    [here, there]: [&W::State<f64x8<S>>; 2],
    [found, other]: &mut [[f64x8<S>; MOST_CHANNELS]; 2],
) {
    let ((inside, place), (other_inside, other_place)) =
        (walk.on_shadow_rays(here), walk.on_shadow_rays(there));
    if !(inside | other_inside).any_true() {
        return;
    }
    let mut places = [[0.0; PAIR]; 3];
    for (axis, row) in places.iter_mut().enumerate() {
        Twin(place[axis], other_place[axis]).store_slice(row);
    }
    if !W::IS_CHROMATIC {
        // No index: the loop keeps one pack in registers.
        let fields = walk.shadow_fields();
        Twin(found[0], other[0]) = fields[0].pair(simd, &places);
        return;
    }
    for (channel, field) in walk.shadow_fields().iter().enumerate() {
        Twin(found[channel], other[channel]) = field.pair(simd, &places);
    }
}
