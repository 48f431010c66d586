//! Draws that lanes have to make, and the streams that they leave.

use numeric::pack::{Hardware, Lanes, PackedWords, WIDTH};
use numeric::rng::{LANES, Stream, Streams, Xoshiro};

/// The streams of a pack.
pub type PackStreams<S> = Xoshiro<<S as Hardware>::Words>;

/// Draws that each lane has made and has to make.
pub struct Slots {
    /// The number of each lane's next draw.
    next: [usize; WIDTH],
    /// The number of the step in which its walk began.
    began: [u32; WIDTH],
    /// The number of this step.
    now: u32,
    /// Number of lanes with draws left.
    open: usize,
    count: usize,
}

/// A draw of a lane.
#[derive(Clone, Copy)]
pub struct Slot {
    /// The lane.
    pub lane: usize,
    /// The draw's number in the buffer.
    pub draw: usize,
    /// Number of steps that the walk made before this one.
    pub steps: u32,
}

impl Slots {
    /// Slots of a pack for a number of draws; the first draw comes from the lane `turn`.
    pub fn new(count: usize, turn: usize, pack: usize) -> Self {
        let mut next = [0; WIDTH];
        for (lane, draw) in (pack * WIDTH..).zip(&mut next) {
            *draw = (lane + LANES - turn) % LANES;
        }
        let open = next.iter().filter(|&&draw| draw < count).count();
        Self { next, began: [0; WIDTH], now: 0, open, count }
    }

    /// Returns whether a lane has draws left.
    #[inline(always)]
    pub fn are_open(&self) -> bool {
        self.open > 0
    }

    /// Ends the step.
    #[inline(always)]
    pub fn step(&mut self) {
        self.now = self.now.wrapping_add(1);
    }

    /// Passes the slots of the walks that end in this step to `write`. Returns the lanes that made their last draw.
    /// Both are bits.
    #[inline(always)]
    pub fn fill(&mut self, mut ended: u64, mut write: impl FnMut(Slot)) -> u64 {
        let mut over = 0;
        while ended != 0 {
            let lane = (ended.trailing_zeros() & 7) as usize;
            ended &= ended - 1;
            let draw = self.next[lane];
            if draw >= self.count {
                continue; // This lane has made its draws.
            }
            write(Slot { lane, draw, steps: self.now.wrapping_sub(self.began[lane]) });
            self.began[lane] = self.now.wrapping_add(1);
            self.next[lane] = draw + LANES;
            if self.next[lane] >= self.count {
                self.open -= 1;
                over |= 1 << lane;
            }
        }
        over
    }
}

/// Sets the stored streams of some lanes of a pack, as bits, to their present state.
#[inline(always)]
pub fn leave(streams: &mut Streams, pack: usize, which: u64, now: Xoshiro<impl PackedWords>) {
    if which != 0 {
        set(&mut streams.lanes[pack * WIDTH..], which, &now.at_rest());
    }
}

/// Sets some of the streams, as bits.
#[inline(never)]
fn set(streams: &mut [Stream], which: u64, now: &Lanes) {
    for (lane, (stream, now)) in streams.iter_mut().zip(now.apart()).enumerate() {
        if which >> lane & 1 == 1 {
            *stream = now;
        }
    }
}
