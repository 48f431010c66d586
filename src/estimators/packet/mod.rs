//! Eight draws side by side: what packet kernels share.
//!
//! Specification of each: draw j is, bit for bit, the draw that its page makes from stream j mod 8.
//!
//! Each lane walks its own walk. A walk that ends begins anew at once, so that no lane waits, and
//! every lane makes a number of draws that was fixed beforehand: to stop when enough draws are done
//! would prefer short walks, which is a bias. Steps have no branches. They are noted row by row; after
//! [`STEPS`] of them the rows are searched for walks that ended, and those become draws. A lane that
//! has made its draws walks on until the others have; its stream is then set back to where its last
//! draw left it.

pub mod decomposition;
pub mod flight;
pub mod majorants;
pub mod product;
pub mod score;
mod survival;

use fearless_simd::{Simd, SimdBase, SimdMask, f64x8, mask64x8, u64x8};

use super::DrawBuffer;
use super::ledger::{Ledger, Notes, Reader, Row, STEPS};
use crate::media::{Control, Extinction, Piecewise};
use crate::numeric::pack::WIDTH;
use crate::rng::{LANES, Lanes, Streams, Xoshiro};

pub use decomposition::decomposition;
pub use flight::flight;
pub use majorants::majorants;
pub use product::product;
pub use score::score;

/// With more pieces of σ̂ than this, lanes that cross them hold the others up for longer than eight
/// lookups at once gain, unless lookups are costly.
const MOST_PIECES: usize = 12;
/// The same of the control, where σ̂ has several pieces, too.
const MOST_CONTROL_PIECES: usize = 8;

/// Whether packets are faster than one draw after the other.
pub(super) fn pays<M: Extinction>(sampling: &Piecewise, control: &Control) -> bool {
    let controls = if let Control::Pieces(pieces) = control { pieces.count() } else { 0 };
    let few = sampling.count() <= MOST_PIECES && controls <= MOST_CONTROL_PIECES;
    M::IS_COSTLY || sampling.even().is_some() || few
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
    depths: [f64x8<S>; STEPS],
    /// Not looked at where chance does not decide.
    decisions: [f64x8<S>; STEPS],
}

impl<S: Simd> Ahead<S> {
    #[inline(always)]
    fn new(simd: S) -> Self {
        let none = [f64x8::splat(simd, 0.0); STEPS];
        Self { depths: none, decisions: none }
    }

    /// Hands out the numbers of a step and finds those of the same step in the next window.
    #[inline(always)]
    fn exchange(&mut self, step: usize, streams: &mut Xoshiro<u64x8<S>>) -> Numbers<S> {
        let now = Numbers { depth: self.depths[step], decision: self.decisions[step] };
        self.find(step, streams, true);
        now
    }

    #[inline(always)]
    fn find(&mut self, step: usize, streams: &mut Xoshiro<u64x8<S>>, decides: bool) {
        self.depths[step] = -streams.ln_uniform();
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

/// Eight walks.
trait Walks<S: Simd> {
    /// Whether chance decides what becomes of them: a step then takes a word for that, too.
    const DECIDES: bool;

    /// What reads their rows.
    type Reader: Reader;

    /// What reads their rows.
    fn reader(&self) -> Self::Reader;

    /// One step of each; walks that end begin anew.
    fn step(&mut self, numbers: Numbers<S>, row: &mut Row) -> Ends;
}

#[inline(always)]
fn ends<S: Simd>(inside: mask64x8<S>, goes_on: mask64x8<S>) -> Ends {
    Ends { ended: (!goes_on).to_bitmask(), escaped: (!inside).to_bitmask() }
}

/// Walks until every lane has made its draws; answers where the walks stand then.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // eight bits of a mask
fn run<S: Simd, W: Walks<S>>(simd: S, mut walks: W, request: Request) -> W {
    let Request { streams, count, buffer } = request;
    let Some(mut ledger) = Ledger::open(count, streams.turn, buffer) else { return walks };
    let reader = walks.reader();
    let mut awake = Lanes::of(&streams.lanes).awake(simd);
    let words = if W::DECIDES { 2 } else { 1 };
    let mut rows = [Row::default(); STEPS];
    let (mut before, mut ahead) = (awake, Ahead::new(simd));
    ahead.find_all(&mut awake, W::DECIDES);
    while ledger.is_open() {
        let after = awake;
        let mut notes = Notes::default();
        for (step, row) in rows.iter_mut().enumerate() {
            let now = if W::DECIDES {
                // A step waits for the one before: logarithms, which wait for nothing, fill the time.
                ahead.exchange(step, &mut awake)
            } else {
                Numbers { depth: ahead.depths[step], decision: ahead.depths[step] }
            };
            let ends = walks.step(now, row);
            notes.ended[step / 8][step % 8] = ends.ended as u8;
            notes.escaped[step / 8][step % 8] = ends.escaped as u8;
        }
        let over = ledger.collect(&reader, &rows, &notes);
        if over != [0; WIDTH] {
            let before = before.at_rest().apart();
            for ((stream, before), steps) in streams.lanes.iter_mut().zip(before).zip(over) {
                if steps > 0 {
                    *stream = before;
                    for _ in 0..steps * words {
                        stream.word();
                    }
                }
            }
        }
        if !W::DECIDES {
            // By themselves: then all that a step needs stays in registers.
            ahead.find_all(&mut awake, false);
        }
        before = after;
    }
    streams.turn = (streams.turn + count) % LANES;
    walks
}
