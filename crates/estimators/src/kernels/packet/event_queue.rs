//! What packs of walks side by side leave behind, and the draws that are made of it.
//!
//! Steps have no branches: each notes a row of numbers and who ended in it. After [`STEPS`] of them
//! the notes are searched, lane by lane, and every walk that ended becomes the next draw of its lane.
//! What a lane ends beyond its number of draws is left out.

use fearless_simd::{Simd, SimdBase, SimdMask, u8x64};

use super::DrawBuffer;
use numeric::pack::WIDTH;
use numeric::rng::{LANES, PACKS};

/// Steps between two searches; what a lane did in them makes a word.
pub const STEPS: usize = 64;

/// What is noted of a step: two numbers of each lane, before the step's outcome.
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
pub struct Row(pub [[f64; WIDTH]; 2]);

/// What makes draws of rows.
pub trait Reader {
    /// Whether chance decides what becomes of walks: a step then takes a word for that, too. Elsewhere all
    /// go on to the end, and steps need not note who escaped.
    const DECIDES: bool;

    /// The value and the defect of a walk that ended in the step of a row.
    fn draw(&self, row: &Row, lane: usize, escaped: bool) -> (f64, f64);

    /// The lookups that it had made before that step, after so many others.
    #[inline(always)]
    fn lookups(&self, row: &Row, lane: usize, steps: u32) -> u32 {
        let _ = (row, lane);
        steps
    }
}

/// What one lane has to do and has done.
#[derive(Clone, Copy, Default)]
struct Quota {
    /// Where its next draw goes.
    place: usize,
    /// The number of the step in which its walk began.
    began: u32,
}

/// Who ended in [`STEPS`] steps of a pack, and who of them escaped: the lanes of a step are the bits of its
/// byte.
pub struct Notes {
    /// Who ended.
    pub ended: [u8; STEPS],
    /// Who of them reached the end.
    pub escaped: [u8; STEPS],
}

impl Notes {
    /// Nothing yet.
    pub fn empty() -> Self {
        Self { ended: [0; STEPS], escaped: [0; STEPS] }
    }

    /// The same by lanes.
    #[inline(always)]
    pub fn by_lanes<S: Simd, R: Reader>(&self, simd: S) -> [Endings; WIDTH] {
        let (ended, escaped) =
            (u8x64::from_slice(simd, &self.ended), u8x64::from_slice(simd, &self.escaped));
        let mut endings = [Endings::default(); WIDTH];
        for (lane, ending) in endings.iter_mut().enumerate() {
            let bit = 1 << lane;
            ending.ended = (ended & bit).simd_eq(bit).to_bitmask();
            if R::DECIDES {
                ending.escaped = (escaped & bit).simd_eq(bit).to_bitmask();
            }
        }
        endings
    }
}

/// In which of [`STEPS`] steps a lane ended a walk, and in which of them because it reached the end, as
/// bits.
#[derive(Clone, Copy, Default)]
pub struct Endings {
    ended: u64,
    escaped: u64,
}

/// What a pack has to do and has done.
#[derive(Clone, Copy, Default)]
struct Account {
    quotas: [Quota; WIDTH],
    /// How many lanes have draws left.
    open: usize,
    /// The number of the first step of the rows.
    first: u32,
}

/// The draws so far.
pub struct EventQueue<'a> {
    accounts: [Account; PACKS],
    values: &'a mut [f64],
    lookups: &'a mut [u32],
    defects: &'a mut [f64],
}

impl<'a> EventQueue<'a> {
    /// Room for so many draws, of which the first comes from the lane whose turn it is; `None`
    /// where a draw has no channel.
    pub fn open(count: usize, turn: usize, buffer: &'a mut DrawBuffer) -> Option<Self> {
        let (values, lookups, defects) = buffer.one_channel(count)?;
        let mut accounts = [Account::default(); PACKS];
        for lane in 0..LANES {
            let account = &mut accounts[lane / WIDTH];
            let place = (lane + LANES - turn) % LANES;
            account.quotas[lane % WIDTH].place = place;
            account.open += usize::from(place < count);
        }
        Some(Self { accounts, values, lookups, defects })
    }

    /// Whether some lane of a pack has draws left.
    pub fn is_open(&self, pack: usize) -> bool {
        self.accounts[pack].open > 0
    }

    /// Makes draws of the walks of a pack that ended. Answers for each lane after how many of the steps it
    /// had made its last draw, or 0.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation)] // at most STEPS
    pub fn collect<R: Reader>(
        &mut self,
        pack: usize,
        reader: &R,
        rows: &[Row; STEPS],
        endings: &[Endings; WIDTH],
    ) -> [usize; WIDTH] {
        let mut over = [0; WIDTH];
        let Account { quotas, open, first } = &mut self.accounts[pack];
        // All of one length, which the loop then knows.
        let count = self.values.len().min(self.lookups.len()).min(self.defects.len());
        let (values, lookups) = (&mut self.values[..count], &mut self.lookups[..count]);
        let defects = &mut self.defects[..count];
        for (lane, (quota, ending)) in quotas.iter_mut().zip(endings).enumerate() {
            let Quota { mut place, mut began } = *quota;
            let mut ended = ending.ended;
            // A lane that has made its draws walks on for nothing.
            while ended != 0 && place < count {
                let step = ended.trailing_zeros() & (STEPS as u32 - 1);
                ended &= ended - 1;
                let has_escaped = !R::DECIDES || ending.escaped >> step & 1 == 1;
                let row = &rows[step as usize];
                (values[place], defects[place]) = reader.draw(row, lane, has_escaped);
                let now = first.wrapping_add(step);
                let before = reader.lookups(row, lane, now.wrapping_sub(began));
                // The step that leaves looks at nothing.
                lookups[place] = before + u32::from(!has_escaped);
                began = now.wrapping_add(1);
                place += LANES;
                if place >= count {
                    *open -= 1;
                    over[lane] = step as usize + 1;
                }
            }
            *quota = Quota { place, began };
        }
        *first = first.wrapping_add(STEPS as u32);
        over
    }
}
