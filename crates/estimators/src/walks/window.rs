//! The driver of packs with the same random numbers in every step.
//!
//! Draw j is, bit for bit, the draw that [`super::plain`] makes from stream j mod 16.
//!
//! Steps have no branches: each stores a row with the values that walks have if they end here, and a bit for each
//! lane in which the walk does end here. After 64 steps these bits are searched, and every walk that ended becomes
//! the next draw of its lane. A walk that ends is replaced at once, so that no lane stands still.
//!
//! The number of draws of a lane is fixed beforehand. To stop when enough draws are done would prefer short walks,
//! which is a bias. A lane that has made its draws walks on until the others have; its stream is then reset to the
//! end of its last draw.
//!
//! A block has two packs of streams, and their steps alternate: a step depends on the one before it, and the step
//! of the other pack fills that latency.

use fearless_simd::{Simd, SimdBase, SimdMask, u8x64};

use super::{Route, TentativeCollision, Walk};
use crate::Request;
use media::sampling::BothWays;
use numeric::pack::{self, Hardware, Lanes, WIDTH};
use numeric::rng::{LANES, PACKS, Random, Stream, Xoshiro};
use numeric::{Lane, Mask, Pair};

/// Number of steps between two searches for walks that ended; the bits of a lane in them fit into a word.
const STEPS: usize = 64;

/// The streams of a pack.
type Streams<S> = Xoshiro<<S as Hardware>::Words>;

/// The value of each lane, and its defect or, where walks pause, its lookups.
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
struct LaneRow([[f64; WIDTH]; 2]);

/// The random numbers of a step.
#[derive(Clone, Copy)]
struct StepNumbers<L> {
    /// An optical depth of mean 1.
    depth: L,
    /// Uniform in `[0, 1)`.
    decision: L,
}

/// Walks with a fixed number of random numbers a step take no further ones.
impl<L: Lane> Random<L> for StepNumbers<L> {
    #[inline(always)]
    fn uniform(&mut self) -> L {
        self.decision
    }

    #[inline(always)]
    fn ln_uniform(&mut self) -> L {
        -self.depth
    }

    #[inline(always)]
    fn uniform_where(&mut self, _: L::Mask) -> L {
        self.decision
    }

    #[inline(always)]
    fn ln_uniform_where(&mut self, _: L::Mask) -> L {
        -self.depth
    }
}

/// Eight walks. The walk itself is outside the pack: a call may take its address, and would take that of the pack.
struct Pack<L: Lane, W: Walk, C> {
    route: Route<C>,
    state: W::State<L>,
    inside: L::Mask,
    /// Number of lookups of walks that pause.
    lookups: L,
    /// False before the first defect of a walk that [`Walk::IS_SURVIVAL`].
    stores_defects: bool,
}

impl<L: Lane, W: Walk, C: BothWays<L>> Pack<L, W, C> {
    #[inline(always)]
    fn new<S: Hardware<Pack = L>>(simd: S, walk: &W, course: C) -> Self {
        let zero = simd.splat(0.0);
        let all = zero.at_most(zero);
        let mut none = StepNumbers { depth: zero, decision: zero };
        let state = walk.begin(simd.splat(1.0), all, &mut none);
        let route = Route::new(course);
        Self { route, state, inside: all, lookups: zero, stores_defects: !W::IS_SURVIVAL }
    }

    /// The values of a walk that has left, and of another, if it [`Walk::IS_SURVIVAL`].
    #[inline(always)]
    fn survival(&self, walk: &W) -> [f64; 2] {
        let (all, mut rows) = (self.inside, [[0.0; WIDTH]; 2]);
        walk.value(&self.state, all, 0).store(&mut rows[0]);
        walk.value(&self.state, !all, 0).store(&mut rows[1]);
        [rows[0][0], rows[1][0]]
    }

    /// Flies; returns the distances at which σ_t is looked up. Distances of lanes without a collision may lie
    /// outside the medium.
    #[inline(always)]
    fn fly(&mut self, walk: &W, numbers: &StepNumbers<L>) -> L {
        self.inside = walk.fly(&mut self.state, &mut self.route, numbers.depth);
        walk.distance(&self.state, &self.route)
    }

    /// Collides; returns the lanes with walks that end, and those inside, as bits.
    #[inline(always)]
    fn collide(
        &mut self,
        walk: &W,
        (t, extinction): (L, L),
        numbers: &StepNumbers<L>,
        row: &mut LaneRow,
    ) -> [u64; 2] {
        let inside = self.inside;
        if !W::IS_SURVIVAL {
            walk.value(&self.state, !inside, 0).store(&mut row.0[0]);
        }
        if W::HAS_DEFECT {
            let (zero, defect) = (t.each(0.0), walk.defect(&self.state, t.each(0.0)));
            // NaN is a defect.
            self.stores_defects |= !W::IS_SURVIVAL || (!defect.at_most(zero)).any();
            if self.stores_defects {
                defect.store(&mut row.0[1]);
            }
        }
        let mean_free_path = walk.mean_free_path(&self.state, &self.route);
        let number = numbers.decision;
        let (extinctions, in_space): (&[L], &[L]) = (&[], &[]);
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
            self.lookups.count_where(inside);
        }
        let goes_on = walk.collide(&mut self.state, &mut self.route, &collided, &mut { *numbers });
        if W::PAUSES {
            self.lookups.store(&mut row.0[1]);
            self.lookups.set_where(!goes_on, t.each(0.0));
        }
        walk.restart(&mut self.state, !goes_on, t.each(1.0), &mut { *numbers });
        self.route.here.restart(!goes_on);
        [(!goes_on).bits(), inside.bits()]
    }
}

/// The random numbers of [`STEPS`] steps.
struct Ahead<S: Hardware> {
    logarithms: [S::Pack; STEPS],
    /// Not filled for walks without [`Walk::DECIDES`].
    decisions: [S::Pack; STEPS],
}

impl<S: Hardware> Ahead<S> {
    #[inline(always)]
    fn find(&mut self, step: usize, streams: &mut Streams<S>, decides: bool) {
        self.logarithms[step] = streams.ln_uniform();
        if decides {
            self.decisions[step] = streams.uniform();
        }
    }

    /// Finds all numbers; returns the streams after them. A reference to the streams would keep them in memory.
    #[inline(always)]
    fn find_all(&mut self, simd: S, mut streams: Streams<S>, decides: bool) -> Streams<S> {
        pack::outlined(
            simd,
            #[inline(always)]
            move || {
                for step in 0..STEPS {
                    self.find(step, &mut streams, decides);
                }
                streams
            },
        )
    }
}

/// [`STEPS`] steps of a pack. Walks and streams are outside: beside arrays with an index a compiler would not keep
/// them in registers.
struct Window<S: Hardware> {
    ahead: Ahead<S>,
    rows: [LaneRow; STEPS],
    /// A bit for each lane in which a walk ended in the step.
    ended: [u8; STEPS],
    /// A bit for each lane that looked σ_t up in the step.
    inside: [u8; STEPS],
    /// The streams at the first step.
    before: Streams<S>,
}

impl<S: Hardware> Window<S> {
    #[inline(always)]
    fn open(simd: S, streams: &mut Streams<S>, decides: bool) -> Self {
        let (before, none) = (*streams, [simd.splat(0.0); STEPS]);
        let mut ahead = Ahead { logarithms: none, decisions: none };
        *streams = ahead.find_all(simd, before, decides);
        let rows = [LaneRow::default(); STEPS];
        Self { ahead, rows, ended: [0; STEPS], inside: [0; STEPS], before }
    }

    /// The random numbers of a step.
    #[inline(always)]
    fn numbers(
        &mut self,
        step: usize,
        streams: &mut Streams<S>,
        decides: bool,
    ) -> StepNumbers<S::Pack> {
        let depth = -self.ahead.logarithms[step];
        if !decides {
            return StepNumbers { depth, decision: depth };
        }
        let now = StepNumbers { depth, decision: self.ahead.decisions[step] };
        // A step depends on the one before it. The numbers of the next window depend on nothing and fill the
        // latency.
        self.ahead.find(step, streams, true);
        now
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // eight bits of a mask
    fn note(&mut self, step: usize, [ended, inside]: [u64; 2], decides: bool) {
        self.ended[step] = ended as u8;
        if decides {
            self.inside[step] = inside as u8;
        }
    }

    /// Makes draws of the walks that ended, and begins the next window. The streams made its first numbers at `next`.
    #[inline(always)]
    fn turn<W: Walk>(
        &mut self,
        simd: S,
        next: Streams<S>,
        streams: &mut Streams<S>,
        (draws, lanes): (&mut WindowDraws<'_>, &mut [Stream]),
        (pack, stores_defects): (usize, bool),
    ) {
        let steps = by_lanes(simd, &self.ended, &self.inside);
        let over = draws.collect::<W>((pack, stores_defects), &self.rows, &steps);
        if over != [0; WIDTH] {
            let words = if W::DECIDES { 2 } else { 1 };
            leave(
                &mut lanes[pack * WIDTH..],
                &self.before.at_rest(),
                &over.map(|steps| steps * words),
            );
        }
        self.before = next;
        if !W::DECIDES {
            // In a separate loop, so that all values of a step stay in registers.
            *streams = self.ahead.find_all(simd, *streams, false);
        }
    }
}

/// Sets streams of a pack to where they are after some words. Streams of no words stay as they are.
#[inline(never)]
fn leave(streams: &mut [Stream], before: &Lanes, words: &[usize; WIDTH]) {
    for ((stream, before), &words) in streams.iter_mut().zip(before.apart()).zip(words) {
        if words > 0 {
            *stream = before;
            for _ in 0..words {
                stream.word();
            }
        }
    }
}

/// The steps in which a lane ended a walk, and the steps in which it looked σ_t up, as bits.
#[derive(Clone, Copy, Default)]
struct StepBits {
    ended: u64,
    inside: u64,
}

/// Bits of lanes by steps, as bits of steps by lanes.
#[inline(always)]
fn by_lanes<S: Simd>(simd: S, ended: &[u8; STEPS], inside: &[u8; STEPS]) -> [StepBits; WIDTH] {
    pack::outlined(
        simd,
        #[inline(always)]
        move || {
            let (ended, inside) = (u8x64::from_slice(simd, ended), u8x64::from_slice(simd, inside));
            let mut steps = [StepBits::default(); WIDTH];
            for (lane, steps) in steps.iter_mut().enumerate() {
                let bit = 1 << lane;
                steps.ended = (ended & bit).simd_eq(bit).to_bitmask();
                steps.inside = (inside & bit).simd_eq(bit).to_bitmask();
            }
            steps
        },
    )
}

/// The number of draws that a lane has made, and the begin of its walk.
#[derive(Clone, Copy, Default)]
struct Quota {
    /// The number of its next draw.
    draw: usize,
    /// The number of the step in which its walk began.
    began: u32,
}

/// The quotas of the lanes of a pack.
#[derive(Clone, Copy, Default)]
struct Account {
    quotas: [Quota; WIDTH],
    /// The number of lanes that have draws left.
    open: usize,
    /// The number of the first step of the window.
    first: u32,
}

/// The draws so far.
struct WindowDraws<'a> {
    accounts: [Account; PACKS],
    values: &'a mut [f64],
    lookups: &'a mut [u32],
    defects: &'a mut [f64],
    /// The values of a walk that has left, and of another, if it [`Walk::IS_SURVIVAL`].
    survival: [f64; 2],
}

impl WindowDraws<'_> {
    /// Makes draws of the walks of a pack that ended. Returns for each lane the number of steps up to the end of its last
    /// draw, or 0 if that draw does not end here.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // counts
    fn collect<W: Walk>(
        &mut self,
        (pack, stores_defects): (usize, bool),
        rows: &[LaneRow; STEPS],
        steps: &[StepBits; WIDTH],
    ) -> [usize; WIDTH] {
        let (mut over, survival) = ([0; WIDTH], self.survival);
        let Account { quotas, open, first } = &mut self.accounts[pack];
        // All slices get one length, which the compiler can use in the loop.
        let count = self.values.len().min(self.lookups.len()).min(self.defects.len());
        let (values, lookups) = (&mut self.values[..count], &mut self.lookups[..count]);
        let defects = &mut self.defects[..count];
        for (lane, (quota, steps)) in quotas.iter_mut().zip(steps).enumerate() {
            let Quota { mut draw, mut began } = *quota;
            let mut ended = steps.ended;
            // A lane that has made its draws walks on without effect.
            while ended != 0 && draw < count {
                let step = ended.trailing_zeros() & (STEPS as u32 - 1);
                ended &= ended - 1;
                let [value, other] = &rows[step as usize].0;
                let inside = steps.inside >> step & 1;
                // No branch: it would be mispredicted, for ends are random.
                values[draw] = if W::IS_SURVIVAL { survival[inside as usize] } else { value[lane] };
                let has_defect = W::HAS_DEFECT && stores_defects;
                defects[draw] = if has_defect { other[lane] } else { 0.0 };
                let now = first.wrapping_add(step);
                lookups[draw] = if W::PAUSES {
                    other[lane] as u32
                } else {
                    now.wrapping_sub(began) + inside as u32
                };
                began = now.wrapping_add(1);
                draw += LANES;
                if draw >= count {
                    *open -= 1;
                    over[lane] = step as usize + 1;
                }
            }
            *quota = Quota { draw, began };
        }
        *first = first.wrapping_add(STEPS as u32);
        over
    }

    fn are_open(&self) -> bool {
        self.accounts.iter().any(|account| account.open > 0)
    }
}

/// Makes the draws of a request. Both packs take each step together: `look_up` returns σ_t of sixteen lanes.
#[inline(always)]
pub fn run<S: Hardware, W: Walk, C: BothWays<S::Pack>>(
    simd: S,
    walk: W,
    course: C,
    look_up: impl Fn(Pair<S::Pack>) -> Pair<S::Pack>,
    request: Request,
) {
    // Not in `const`: branches of other walks mention this function, too.
    debug_assert!(W::IS_FIXED && !(W::HAS_DEFECT && W::PAUSES), "a row has one place for both");
    let Request { streams, count, buffer } = request;
    let Some((values, lookups, defects)) = buffer.one_channel(count) else { return };
    let mut accounts = [Account::default(); PACKS];
    for lane in 0..LANES {
        let account = &mut accounts[lane / WIDTH];
        let draw = (lane + LANES - streams.turn) % LANES;
        account.quotas[lane % WIDTH].draw = draw;
        account.open += usize::from(draw < count);
    }
    let [first, second] = streams.packs();
    streams.turn = (streams.turn + count) % LANES;
    let lanes = &mut streams.lanes[..];
    let (mut pack, mut other) = (Pack::new(simd, &walk, course), Pack::new(simd, &walk, course));
    let survival = if W::IS_SURVIVAL { pack.survival(&walk) } else { [0.0; 2] };
    let mut draws = WindowDraws { accounts, values, lookups, defects, survival };
    let (mut streams, mut other_streams) = (first.awake(simd), second.awake(simd));
    let mut window = Window::open(simd, &mut streams, W::DECIDES);
    let mut other_window = Window::open(simd, &mut other_streams, W::DECIDES);
    while draws.are_open() {
        let (next, other_next) = (streams, other_streams);
        for step in 0..STEPS {
            let numbers = window.numbers(step, &mut streams, W::DECIDES);
            let other_numbers = other_window.numbers(step, &mut other_streams, W::DECIDES);
            let t = Pair(pack.fly(&walk, &numbers), other.fly(&walk, &other_numbers));
            let result = look_up(t);
            let bits = pack.collide(&walk, (t.0, result.0), &numbers, &mut window.rows[step]);
            window.note(step, bits, W::DECIDES);
            let bits =
                other.collide(&walk, (t.1, result.1), &other_numbers, &mut other_window.rows[step]);
            other_window.note(step, bits, W::DECIDES);
        }
        let (first, second) = ((0, pack.stores_defects), (1, other.stores_defects));
        window.turn::<W>(simd, next, &mut streams, (&mut draws, &mut *lanes), first);
        let to = (&mut draws, &mut *lanes);
        other_window.turn::<W>(simd, other_next, &mut other_streams, to, second);
    }
}
