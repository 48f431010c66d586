//! What eight walks side by side leave behind, and the draws that are made of it.
//!
//! Steps have no branches: each notes a row of numbers and who ended in it. After [`STEPS`] of them
//! the notes are searched, in the order of the steps, and every walk that ended becomes the next
//! draw of its lane. What a lane ends beyond its number of draws is left out.

use super::DrawBuffer;
use crate::numeric::pack::WIDTH;
use crate::rng::LANES;

/// Steps between two searches; eight notes of who ended make a word.
pub const STEPS: usize = 64;

/// What is noted of a step: three numbers of each lane, before the step's outcome.
#[derive(Clone, Copy, Default)]
#[repr(align(64))]
pub struct Row(pub [[f64; WIDTH]; 3]);

/// What makes draws of rows.
pub trait Reader {
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

/// The draws so far.
pub struct Ledger<'a> {
    quotas: [Quota; WIDTH],
    /// How many lanes have draws left.
    open: usize,
    /// The number of the first step of the rows.
    first: u32,
    values: &'a mut [f64],
    lookups: &'a mut [u32],
    defects: &'a mut [f64],
}

/// Who ended in [`STEPS`] steps, and who of them escaped: eight steps to a word.
#[derive(Default)]
pub struct Notes {
    /// Who ended.
    pub ended: [[u8; 8]; STEPS / 8],
    /// Who of them reached the end.
    pub escaped: [[u8; 8]; STEPS / 8],
}

impl<'a> Ledger<'a> {
    /// Room for so many draws, of which the first comes from the lane whose turn it is; `None`
    /// where a draw has no channel.
    pub fn open(count: usize, turn: usize, buffer: &'a mut DrawBuffer) -> Option<Self> {
        let (values, lookups, defects) = buffer.one_channel(count)?;
        let mut quotas = [Quota::default(); WIDTH];
        for (lane, quota) in quotas.iter_mut().enumerate() {
            quota.place = (lane + LANES - turn) % LANES;
        }
        let open = quotas.iter().filter(|quota| quota.place < count).count();
        Some(Self { quotas, open, first: 0, values, lookups, defects })
    }

    /// Whether some lane has draws left.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.open > 0
    }

    /// Makes draws of the walks that ended. Answers for each lane after how many of the steps it
    /// had made its last draw, or 0.
    #[inline(never)]
    #[allow(clippy::cast_possible_truncation)] // at most STEPS
    pub fn collect<R: Reader>(
        &mut self,
        reader: &R,
        rows: &[Row; STEPS],
        notes: &Notes,
    ) -> [usize; WIDTH] {
        let mut over = [0; WIDTH];
        // All of one length, which the loop then knows.
        let count = self.values.len().min(self.lookups.len()).min(self.defects.len());
        let (values, lookups) = (&mut self.values[..count], &mut self.lookups[..count]);
        let defects = &mut self.defects[..count];
        for (group, (ended, escaped)) in notes.ended.iter().zip(&notes.escaped).enumerate() {
            let (mut ended, escaped) = (u64::from_le_bytes(*ended), u64::from_le_bytes(*escaped));
            while ended != 0 {
                let bit = ended.trailing_zeros() & 63;
                ended &= ended - 1;
                let (step, lane) = (8 * group + bit as usize / 8, bit as usize % 8);
                let quota = &mut self.quotas[lane];
                let place = quota.place;
                if place >= count {
                    continue; // This lane has made its draws.
                }
                let has_escaped = escaped >> bit & 1 == 1;
                let row = &rows[step % STEPS];
                (values[place], defects[place]) = reader.draw(row, lane, has_escaped);
                let now = self.first.wrapping_add(step as u32);
                let before = reader.lookups(row, lane, now.wrapping_sub(quota.began));
                // The step that leaves looks at nothing.
                lookups[place] = before + u32::from(!has_escaped);
                quota.began = now.wrapping_add(1);
                quota.place = place + LANES;
                if quota.place >= count {
                    self.open -= 1;
                    over[lane] = step + 1;
                }
            }
        }
        self.first = self.first.wrapping_add(STEPS as u32);
        over
    }
}
