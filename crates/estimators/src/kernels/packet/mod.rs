//! Packs of eight draws side by side: what packet kernels share.
//!
//! Specification of each: draw j is, bit for bit, the draw that its page makes from stream j mod 16.
//!
//! Each lane walks its own walk. A walk that ends begins anew at once, so that no lane waits, and
//! every lane makes a number of draws that was fixed beforehand: to stop when enough draws are done
//! would prefer short walks, which is a bias. Steps have no branches. They are noted row by row; after
//! [`STEPS`] of them the rows are searched for walks that ended, and those become draws. A lane that
//! has made its draws walks on until the others have; its stream is then set back to where its last
//! draw left it.
//!
//! A block has two packs of streams. On hardware with registers for both their steps alternate: a step
//! waits for the one before it, and those of the other pack fill the time.

pub mod bank;
pub mod bidirectional;
pub mod colours;
pub mod decomposition;
pub mod event_queue;
pub mod flight;
pub mod hero;
pub mod kept;
pub mod left;
pub mod line;
pub mod majorants;
pub mod paths;
pub mod product;
pub mod score;
pub mod spectral;
mod survival;

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8, u64x8};

use super::DrawBuffer;
use event_queue::{EventQueue, Notes, Reader, Row, STEPS};
use media::{Control, Extinction, Lookups, Piecewise};
use numeric::Twin;
use numeric::pack::WIDTH;
use numeric::rng::{LANES, Stream, Streams, Xoshiro};

pub use decomposition::decomposition;
pub use flight::flight;
pub use majorants::majorants;
pub use product::product;
pub use score::score;

/// With more pieces of σ̂ or of the control than this, lanes that cross them hold the others up for longer than
/// eight lookups at once gain, unless lookups are costly or σ̂ is constant.
const MOST_PIECES: usize = 8;

/// Whether packets are faster than one draw after the other.
pub fn pays(medium: &Lookups, sampling: &Piecewise, control: &Control) -> bool {
    let controls = if let Control::Pieces(pieces) = control { pieces.count() } else { 0 };
    let few = sampling.count() <= MOST_PIECES && controls <= MOST_PIECES;
    medium.is_costly() || sampling.even().is_some() || few
}

/// What is to be drawn.
pub struct Request<'a> {
    /// The streams of the block, where the draws before left them.
    pub streams: &'a mut Streams,
    /// How many draws.
    pub count: usize,
    /// Where they go.
    pub buffer: &'a mut DrawBuffer,
}

/// Which walks ended in a step, as bits, and which of them because they reached the end.
struct Ends {
    ended: u64,
    escaped: u64,
}

/// The random numbers of a step.
#[derive(Clone, Copy)]
struct Numbers<S: Simd> {
    /// The optical depth to the next collision, of mean 1.
    depth: f64x8<S>,
    /// Uniform in `[0, 1)`, where chance decides.
    decision: f64x8<S>,
}

/// The random numbers of [`STEPS`] steps.
struct Ahead<S: Simd> {
    /// Minus the optical depths: the sign is part of the flight.
    logarithms: [f64x8<S>; STEPS],
    /// Not looked at where chance does not decide.
    decisions: [f64x8<S>; STEPS],
}

impl<S: Simd> Ahead<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let none = [f64x8::splat(simd, 0.0); STEPS];
        Self { logarithms: none, decisions: none }
    }

    /// Hands out the numbers of a step and finds those of the same step in the next window.
    #[inline(always)]
    fn exchange(&mut self, step: usize, streams: &mut Xoshiro<u64x8<S>>) -> Numbers<S> {
        let now = Numbers { depth: -self.logarithms[step], decision: self.decisions[step] };
        self.find(step, streams, true);
        now
    }

    #[inline(always)]
    fn find(&mut self, step: usize, streams: &mut Xoshiro<u64x8<S>>, decides: bool) {
        self.logarithms[step] = streams.ln_uniform();
        if decides {
            self.decisions[step] = streams.uniform();
        }
    }

    #[inline(always)]
    fn find_all(&mut self, streams: &mut Xoshiro<u64x8<S>>, decides: bool) {
        for step in 0..STEPS {
            self.find(step, streams, decides);
        }
    }
}

/// Eight walks. A step flies all of them, has σ_t looked up where they come to, and lets them collide.
trait Walks<S: Simd> {
    /// What reads their rows.
    type Reader: Reader;

    /// What reads their rows.
    fn reader(&self) -> Self::Reader;

    /// Each flies on; answers where σ_t is asked for.
    fn fly(&mut self, numbers: &Numbers<S>) -> f64x8<S>;

    /// What becomes of each, given what was looked up there; walks that end begin anew.
    fn collide(&mut self, found: f64x8<S>, numbers: &Numbers<S>, row: &mut Row) -> Ends;

    /// Whether all that happened so far is what these walks are made for.
    #[inline(always)]
    fn are_sound(&self) -> bool {
        true
    }
}

#[inline(always)]
fn ends<S: Simd>(inside: mask64x8<S>, goes_on: mask64x8<S>) -> Ends {
    Ends { ended: (!goes_on).to_bitmask(), escaped: (!inside).to_bitmask() }
}

/// `σ_t` of a field whose type is known, with the bits of [`Lookups::pair`].
#[inline(always)]
fn extinctions<S: Simd>(field: &impl Extinction, places: Twin<f64x8<S>>) -> Twin<f64x8<S>> {
    Twin(field.extinction(places.0), field.extinction(places.1))
}

/// What a pack of walks does in [`STEPS`] steps. The walks and their streams are not part of it: beside
/// arrays that are looked at by number a compiler would not keep them in registers.
struct Window<S: Simd> {
    ahead: Ahead<S>,
    rows: [Row; STEPS],
    notes: Notes,
    /// Where the streams were when it began.
    before: Xoshiro<u64x8<S>>,
}

impl<S: Simd> Window<S> {
    /// The first of walks whose streams are here.
    #[inline(always)]
    fn open(simd: S, streams: &mut Xoshiro<u64x8<S>>, decides: bool) -> Self {
        let (before, mut ahead) = (*streams, Ahead::new(simd));
        ahead.find_all(streams, decides);
        Self { ahead, rows: [Row::default(); STEPS], notes: Notes::empty(), before }
    }

    /// The random numbers of a step.
    #[inline(always)]
    fn numbers(
        &mut self,
        step: usize,
        streams: &mut Xoshiro<u64x8<S>>,
        decides: bool,
    ) -> Numbers<S> {
        if decides {
            // A step waits for the one before: logarithms, which wait for nothing, fill the time.
            self.ahead.exchange(step, streams)
        } else {
            let logarithm = self.ahead.logarithms[step];
            Numbers { depth: -logarithm, decision: logarithm }
        }
    }

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation)] // eight bits of a mask
    fn note(&mut self, step: usize, ends: &Ends, decides: bool) {
        self.notes.ended[step] = ends.ended as u8;
        if decides {
            self.notes.escaped[step] = ends.escaped as u8;
        }
    }

    /// Makes draws of the walks of a pack that ended, and begins the next window, for which the streams were
    /// at `next`. A lane that has made its draws leaves its stream where the last one left it.
    #[inline(always)]
    fn turn<R: Reader>(
        &mut self,
        simd: S,
        pack: usize,
        next: Xoshiro<u64x8<S>>,
        streams: &mut Xoshiro<u64x8<S>>,
        draws: &mut Draws<R>,
    ) {
        let words = if R::DECIDES { 2 } else { 1 };
        let endings = self.notes.by_lanes::<S, R>(simd);
        let over = draws.event_queue.collect(pack, &draws.reader, &self.rows, &endings);
        if over != [0; WIDTH] {
            let before = self.before.at_rest().apart();
            let left = &mut draws.lanes[pack * WIDTH..];
            for ((stream, before), steps) in left.iter_mut().zip(before).zip(over) {
                if steps > 0 {
                    *stream = before;
                    for _ in 0..steps * words {
                        stream.word();
                    }
                }
            }
        }
        self.before = next;
        if !R::DECIDES {
            // By themselves: then all that a step needs stays in registers.
            self.ahead.find_all(streams, false);
        }
    }
}

/// Where the draws and their streams go.
struct Draws<'a, R> {
    event_queue: EventQueue<'a>,
    reader: R,
    lanes: &'a mut [Stream; LANES],
}

/// Walks until every lane has made its draws; answers whether they are of use, see [`Walks::are_sound`].
///
/// Both packs of streams take each step together: `look_up` answers for sixteen lanes, σ_t by [`Lookups::pair`] or
/// what a walk makes of it.
#[inline(always)]
fn run<S: Simd, W: Walks<S>>(
    simd: S,
    begin: impl Fn() -> W,
    look_up: impl Fn(Twin<f64x8<S>>) -> Twin<f64x8<S>>,
    request: Request,
) -> bool {
    let decides = W::Reader::DECIDES;
    let Request { streams, count, buffer } = request;
    let Some(event_queue) = EventQueue::open(count, streams.turn, buffer) else { return true };
    let [first, second] = streams.packs();
    streams.turn = (streams.turn + count) % LANES;
    let (mut walks, mut others) = (begin(), begin());
    let mut draws = Draws { event_queue, reader: walks.reader(), lanes: &mut streams.lanes };
    let (mut streams, mut other_streams) = (first.awake(simd), second.awake(simd));
    let mut window = Window::open(simd, &mut streams, decides);
    let mut other_window = Window::open(simd, &mut other_streams, decides);
    while draws.event_queue.is_open(0) || draws.event_queue.is_open(1) {
        let (next, other_next) = (streams, other_streams);
        for step in 0..STEPS {
            let numbers = window.numbers(step, &mut streams, decides);
            let other_numbers = other_window.numbers(step, &mut other_streams, decides);
            let places = Twin(walks.fly(&numbers), others.fly(&other_numbers));
            let Twin(here, there) = look_up(places);
            let ends = walks.collide(here, &numbers, &mut window.rows[step]);
            window.note(step, &ends, decides);
            let ends = others.collide(there, &other_numbers, &mut other_window.rows[step]);
            other_window.note(step, &ends, decides);
        }
        window.turn(simd, 0, next, &mut streams, &mut draws);
        other_window.turn(simd, 1, other_next, &mut other_streams, &mut draws);
    }
    walks.are_sound() && others.are_sound()
}
