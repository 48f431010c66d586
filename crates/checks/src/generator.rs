//! The streams of random numbers themselves: no overlap, all bits, no correlation.
//!
//! ```text
//! overlap      no 64-bit word occurs twice among the marked words of all streams of 16 blocks
//! resolution   each of the 53 bits of a uniform number is set somewhere in 256 words
//! correlation  |z| of Σ (u_{b,i} − ½)(u_{b+1,i+l} − ½) over lags |l| ≤ 16, all neighbours b
//! ```
//!
//! A word is marked when its upper eight bits are zero: two streams that overlap by any shift share
//! all marked words of the overlap, and few words need to be compared. The first two are certain;
//! the third gives the p-value. The words of a block are those of its lanes in turn, so that lanes
//! are compared with each other as blocks are.

use super::check::{Question, Subject};
use super::distribution::{Inspected, Inspection};
use crate::CheckKind;
use gate::CheckId;
use gate::stats::{correlation, ties};

/// Number of blocks with streams that are compared.
const BLOCKS: u64 = 16;
/// Number of words of each block that are searched for overlaps.
const WORDS: usize = 1 << 14;
/// Number of uniform numbers of each block in the correlations.
const NUMBERS: usize = 1024;
/// Largest lag.
const LAG: i32 = 16;
/// Number of words that must show all bits.
const SHORT: usize = 256;

/// The check.
pub const CHECK: CheckKind = CheckKind::new(CheckId::Generator, questions).not_uniform();

/// Returns the questions of this check.
fn questions(subject: &Subject) -> Vec<Question> {
    // Streams are inspected only if draws use them.
    let random = subject
        .prediction
        .channels
        .iter()
        .any(|channel| channel.moments.is_some_and(|moments| moments.relative[0] > 0.0));
    if !random {
        return Vec::new();
    }
    vec![Question::whole(CheckId::Generator, "the streams of random numbers", Inspection(p_value))]
}

/// Returns the words of a block as the draws use them.
fn words(inspected: &Inspected, block: u64) -> Box<dyn Iterator<Item = u64>> {
    Box::new((inspected.streams)(block).words())
}

fn p_value(inspected: &Inspected) -> f64 {
    // Compares consecutive blocks, and blocks far apart.
    let blocks = inspected.blocks.clamp(2, BLOCKS);
    let mut marked = Vec::new();
    for block in 0..blocks {
        let words: Vec<u64> = words(inspected, block).take(WORDS).collect();
        let bits = ties::or_of_words(words[..SHORT].iter().map(|word| word >> 11));
        if bits != (1 << 53) - 1 {
            return 0.0;
        }
        marked.extend(words.into_iter().filter(|word| word >> 56 == 0));
    }
    marked.sort_unstable();
    if marked.windows(2).any(|pair| pair[0] == pair[1]) {
        return 0.0;
    }
    let numbers = |block| -> Vec<f64> {
        let words = (inspected.streams)(block).words();
        words.map(|word| 12f64.sqrt() * (word as f64 / 2f64.powi(64) - 0.5)).take(NUMBERS).collect()
    };
    let mut minimum: f64 = 1.0;
    let mut before = numbers(0);
    for block in 1..blocks {
        let here = numbers(block);
        let lagged = correlation::lagged(&before, &here, -LAG..=LAG);
        minimum = lagged.map_or(minimum, |lagged| minimum.min(lagged.p_value));
        before = here;
    }
    (minimum * (blocks - 1) as f64).min(1.0)
}
