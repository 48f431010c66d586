//! Eight doubles as a lane, on vector hardware that multiplies and adds in one rounding.
//!
//! A pack has eight elements whatever the hardware's registers hold: one register of AVX-512, two of AVX2, four of NEON. So
//! every machine makes the same draws, and what is drawn never depends on the width.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(target_arch = "x86_64")]
mod lanes;
#[cfg(target_arch = "aarch64")]
mod neon;
mod streams;

use std::sync::atomic::AtomicU64;

use fearless_simd::{Level, Simd};

use super::Lane;
use super::mask::Mask;
use super::rng::xoshiro;
use super::words::{Words32, apart};

pub use super::lane::WIDTH;
pub use streams::Lanes;

/// Vector hardware, and the pack that it computes with.
pub trait Hardware: Simd {
    /// Eight doubles.
    type Pack: Lane<Mask = Self::Mask, Words = Self::Words>;
    /// Results of a comparison.
    type Mask: Mask;
    /// Eight 64-bit words.
    type Words: PackedWords<Numbers = Self::Pack, Mask = Self::Mask> + Words32;

    /// True if a pack fits into one register.
    const IS_ONE_REGISTER: bool;

    /// Returns a pack with the value in every element.
    fn splat(self, value: f64) -> Self::Pack;
    /// Returns the elements of a row as a pack.
    fn load(self, row: &[f64; WIDTH]) -> Self::Pack;
    /// Returns the mask of eight bits; the lowest bit is the first element.
    fn mask(self, bits: u64) -> Self::Mask;
    /// Returns the words of a row.
    fn words(self, row: &[u64; WIDTH]) -> Self::Words;
}

/// Eight words of streams of random numbers.
pub trait PackedWords: xoshiro::Words<Numbers: Lane<Mask = Self::Mask>> {
    /// Results of a comparison of their numbers.
    type Mask: Mask;

    /// Returns `yes` in selected elements and `no` in the others.
    #[must_use]
    fn select(which: Self::Mask, yes: Self, no: Self) -> Self;
    /// Uniform numbers for the elements that a mask selects, and the state of the streams after them.
    fn uniform_where(which: Self::Mask, state: [Self; 4]) -> ([Self; 4], Self::Numbers);
    /// Writes the words to a row.
    fn store(self, row: &mut [u64; WIDTH]);
}

/// Returns whether a level has packs.
#[inline(always)]
pub fn has_packs(level: Level) -> bool {
    #[cfg(target_arch = "x86_64")]
    return level.as_avx2().is_some();
    #[cfg(target_arch = "aarch64")]
    return level.as_neon().is_some();
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    {
        let _ = level;
        false
    }
}

/// A level in a word, as in `avx512`.
pub fn word(level: Level) -> String {
    let name = format!("{level:?}");
    name.split('(').next().unwrap_or_default().to_lowercase()
}

/// The levels that there is code for on this machine, the best first.
pub fn levels() -> Vec<Level> {
    let mut levels = vec![Level::new()];
    #[cfg(target_arch = "x86_64")]
    levels.extend(Level::new().as_avx2().map(Level::Avx2));
    levels.dedup_by_key(|level| word(*level));
    levels
}

/// A computation that is compiled once for each level of vector hardware.
pub trait Task {
    /// Result of the task.
    type Output;

    /// Runs the computation. All that it calls in loops is `#[inline(always)]`: other code would be compiled for the
    /// baseline of the architecture.
    fn run<S: Hardware>(self, simd: S) -> Self::Output;
}

/// Runs a task on the hardware of a level: the one place where packs are compiled for a machine.
///
/// Inlined, so that each task is compiled in the codegen unit of its own module: one unit of all tasks would keep one core
/// busy, alone, for a minute at the end of a build.
///
/// # Errors
///
/// The task, where the hardware has no packs.
#[inline(always)]
pub fn on<T: Task>(level: Level, task: T) -> Result<T::Output, T> {
    #[cfg(target_arch = "x86_64")]
    return match (level.as_avx512(), level.as_avx2()) {
        (Some(simd), _) => Ok(vectorized(simd, task)),
        (None, Some(simd)) => Ok(vectorized(simd, task)),
        (None, None) => Err(task),
    };
    #[cfg(target_arch = "aarch64")]
    return match level.as_neon() {
        Some(simd) => Ok(vectorized(simd, task)),
        None => Err(task),
    };
    #[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
    {
        let _ = level;
        Err(task)
    }
}

#[inline(always)]
fn vectorized<S: Hardware, T: Task>(simd: S, task: T) -> T::Output {
    simd.vectorize(
        #[inline(always)]
        || task.run(simd),
    )
}

/// Computes in a function of its own: what is computed from is moved into the closure, so that the loop around it keeps its
/// own in registers.
///
/// A compiler replaces arrays of registers in a time that grows as the square of a function's length, before it looks at
/// anything else: a kernel of which each part is inlined takes it 20 s. So what a kernel does only now and then is outlined, and
/// what many kernels do is compiled once, if the function that calls this one is generic over nothing else but the hardware.
#[inline(never)]
pub fn outlined<S: Simd, R>(simd: S, compute: impl FnOnce() -> R) -> R {
    simd.vectorize(compute)
}

/// The places in a list that the lower halves of words are.
#[inline(always)]
fn places(numbers: impl PackedWords) -> [usize; WIDTH] {
    let mut row = [0; WIDTH];
    numbers.store(&mut row);
    let [a, b, c, d, e, f, g, h] = row;
    [low(a), low(b), low(c), low(d), low(e), low(f), low(g), low(h)]
}

#[inline(always)]
fn low(element: u64) -> usize {
    apart(element)[0] as usize
}

/// The last place of a list.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // places are 32-bit integers
fn last(length: usize) -> u32 {
    length as u32 - 1
}

/// 0, hidden from the compiler: other crates could write it.
pub static ZERO: AtomicU64 = AtomicU64::new(0);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CacheRow;

    /// Entries, columns and choices by the bits of a hash.
    #[inline(always)]
    fn looked_up<L: Lane>(numbers: L, list: &[f64], table: &[CacheRow]) -> [L; 8] {
        let [a, b, c, d, e] = numbers.columns(table);
        let words = numbers.words();
        let words = words.plus(words.each([7, 0xffff_fff0])).times(0x85eb_ca6b).folded(13);
        let chosen = L::where_bits(words, 5 << 32, 4 << 32, a, b);
        let negated = c.negated_where(words ^ words.folded(3), 40);
        [numbers.entry(list), a, b, c, d, e, chosen, negated]
    }

    struct LookedUp<'a>([f64; WIDTH], &'a [f64], &'a [CacheRow]);
    impl Task for LookedUp<'_> {
        type Output = [[f64; WIDTH]; 8];
        #[inline(always)]
        fn run<S: Hardware>(self, simd: S) -> Self::Output {
            let mut rows = [[0.0; WIDTH]; 8];
            let values = looked_up(simd.load(&self.0), self.1, self.2);
            for (row, value) in rows.iter_mut().zip(values) {
                value.store(row);
            }
            rows
        }
    }

    #[test]
    fn tables_and_words_are_those_of_scalars() {
        let list: Vec<f64> = (0..100).map(|n| 0.5 + f64::from(n)).collect();
        let row = |x: &f64| CacheRow(std::array::from_fn(|n| x + 1e3 * n as f64));
        let table: Vec<CacheRow> = list.iter().map(row).collect();
        let levels = levels();
        for first in 0..100 {
            // The last places are beyond the lists.
            let numbers = std::array::from_fn(|lane| f64::from(first) + 3.0 * lane as f64);
            for &level in &levels {
                let Ok(packs) = on(level, LookedUp(numbers, &list, &table)) else { continue };
                for (lane, &number) in numbers.iter().enumerate() {
                    let alone = looked_up(number, &list, &table);
                    assert_eq!(packs.map(|row| row[lane]), alone, "{number} at {level:?}");
                }
            }
        }
    }
}
