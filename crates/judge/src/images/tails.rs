//! Size of the smallest tiles where the variance is an estimate, by the tails that the passes show.
//!
//! An estimate bounds the variance of a tile only if enough squares carry it (`variance::of_tile`). In small tiles of
//! heavy tails a few bright values carry all. Then a tile can neither pass nor fail, and more passes with smaller tiles
//! would turn a pass into no verdict. So the smallest tiles are the first power of 2 by which every tile has a bound.
//!
//! The choice uses the passes that are judged. To keep the level, a size of K tiles has the share K/ΣK of it, ΣK over
//! all sizes that might have been chosen.

use super::picture::{Size, Stack};
use super::tiles;
use super::variance;
use gate::stats::verdict::MISS;

/// Smallest tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chosen {
    /// Rows and columns.
    pub tile: usize,
    /// Share of the level of all tiles.
    pub share: f64,
}

/// Returns the smallest tiles from `minimum` on, for a variance of `passes` passes. `stacks` show the tails.
pub(super) fn chosen(stacks: &[&Stack], size: Size, minimum: usize, passes: usize) -> Chosen {
    let longest = size.rows.max(size.columns);
    let sizes = std::iter::successors(Some(minimum), |size| Some((2 * size).min(longest)));
    let mut sizes: Vec<usize> = sizes.take(usize::BITS as usize).collect();
    sizes.dedup();
    let has_bounds = |tile: &usize| {
        let mut parts = tiles::parts(size, *tile, true);
        parts.retain(|part| part.size == *tile);
        let q = variance::all_q(stacks, &parts, None);
        parts.iter().zip(q).all(|(part, q)| {
            let pixels = (part.height * part.width) as f64;
            variance::of_tile(1.0, q, passes, pixels).upper(MISS).is_some()
        })
    };
    let count = |tile: usize| tiles::parts(size, tile, true).len() as f64;
    let all: f64 = sizes.iter().map(|&tile| count(tile)).sum();
    let tile = sizes.iter().copied().find(has_bounds).unwrap_or(minimum);
    Chosen { tile, share: count(tile) / all }
}
