//! Eight doubles as a lane, on any vector hardware.
//!
//! A pack has eight elements whatever the hardware's registers hold: one register of AVX-512, two
//! of AVX2, four of SSE2. So the same draws come out of every machine that fuses multiplication and
//! addition, and what is drawn never depends on the width.

mod streams;
mod words;

use std::sync::atomic::{AtomicU64, Ordering};

use fearless_simd::{
    Bytes, ExtractToken, Level, Select, Simd, SimdBase, SimdFloat, SimdInt, SimdMask, f64x4, f64x8,
    i64x8, mask64x8, u32x16, u64x8,
};

use super::mask::Mask;
use super::scalar_lane::{ROOT_HALF, ROUNDER};
use super::words::apart;
use super::{Lane, Row};

pub use super::lane::WIDTH;
pub use streams::Lanes;

/// Returns true if the packs of a level multiply and add in one rounding.
#[inline(always)]
pub fn fuses(level: Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return level.as_avx2().is_some();
    #[cfg(target_arch = "aarch64")]
    return level.as_neon().is_some();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
    {
        let _ = level;
        false
    }
}

/// Returns true if a level converts 64-bit integers by one instruction.
#[inline(always)]
pub fn converts<S: Simd>(simd: S) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return simd.level().as_avx512().is_some();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    {
        let _ = simd;
        true
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
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    levels.extend(Level::new().as_avx2().map(Level::Avx2));
    levels.push(Level::baseline());
    levels.dedup_by_key(|level| word(*level));
    levels
}

/// A computation that is compiled once for each level of vector hardware.
pub trait Task {
    /// Result of the task.
    type Output;

    /// Runs the computation. All that it calls in loops is `#[inline(always)]`: other code would be compiled for the
    /// baseline of the architecture.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Runs a task on the hardware of a level: the one place where code for a machine is chosen.
///
/// SSE4.2 is left out, for few machines have it and not AVX2: they run the code for SSE2.
///
/// Inlined, so that each task is compiled in the codegen unit of its own module: one unit of all tasks would keep one core
/// busy, alone, for a minute at the end of a build.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn on<T: Task>(level: Level, task: T) -> T::Output {
    match (level.as_avx512(), level.as_avx2(), level.as_sse2()) {
        (Some(simd), ..) => vectorized(simd, task),
        (None, Some(simd), _) => vectorized(simd, task),
        (None, None, Some(simd)) => vectorized(simd, task),
        (None, None, None) => unreachable!("SSE2 is part of x86_64"),
    }
}

/// Runs a task that pays only on wide hardware, AVX2 or more; returns the task on other hardware.
///
/// # Errors
///
/// The task, on x86 without AVX2.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn on_wide<T: Task>(level: Level, task: T) -> Result<T::Output, T> {
    match (level.as_avx512(), level.as_avx2()) {
        (Some(simd), _) => Ok(vectorized(simd, task)),
        (None, Some(simd)) => Ok(vectorized(simd, task)),
        (None, None) => Err(task),
    }
}

/// Runs a task that pays only on wide hardware.
///
/// # Errors
///
/// None on this architecture.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub fn on_wide<T: Task>(level: Level, task: T) -> Result<T::Output, T> {
    Ok(on(level, task))
}

/// Runs a task on the hardware of a level: the one place where code for a machine is chosen.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub fn on<T: Task>(level: Level, task: T) -> T::Output {
    fearless_simd::dispatch!(level, simd => vectorized(simd, task))
}

#[inline(always)]
fn vectorized<S: Simd, T: Task>(simd: S, task: T) -> T::Output {
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

/// Returns true if a pack fits into one register.
pub const fn is_one_register<S: Simd>() -> bool {
    size_of::<S::f64s>() >= size_of::<f64x8<S>>()
}

/// Computes [`outlined`] where a pack takes several registers, and in place elsewhere.
#[inline(always)]
pub fn outlined_if_narrow<S: Simd, R>(simd: S, compute: impl FnOnce() -> R) -> R {
    if const { is_one_register::<S>() } {
        return compute();
    }
    outlined(simd, compute)
}

/// The places in a list that the elements are the numbers of.
#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // places are 32-bit integers
fn places<S: Simd>(numbers: f64x8<S>, length: usize) -> [usize; WIDTH] {
    let words: u32x16<S> = (numbers + ROUNDER).bitcast();
    let within: u64x8<S> = words.min(length as u32 - 1).bitcast();
    let mut row = [0; WIDTH];
    within.store_slice(&mut row);
    let [a, b, c, d, e, f, g, h] = row;
    [low(a), low(b), low(c), low(d), low(e), low(f), low(g), low(h)]
}

#[inline(always)]
fn low(element: u64) -> usize {
    apart(element)[0] as usize
}

/// The first four entries of two rows side by side.
#[inline(always)]
fn two_rows<S: Simd>(simd: S, first: &Row, second: &Row) -> f64x8<S> {
    let low = f64x4::from_slice(simd, &first.0[..4]);
    simd.combine_f64x4(low, f64x4::from_slice(simd, &second.0[..4]))
}

impl<S: Simd> Mask for mask64x8<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.any_true()
    }

    #[inline(always)]
    fn maybe(self) -> bool {
        true
    }

    #[inline(always)]
    fn are_enough(self, of_pack: u32) -> bool {
        self.to_bitmask().count_ones() >= of_pack
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.to_bitmask()
    }

    #[inline(always)]
    fn set_where(&mut self, which: Self, other: Self) {
        *self = which.select(other, *self);
    }
}

/// 0, hidden from the compiler: other crates could write it.
pub static ZERO: AtomicU64 = AtomicU64::new(0);

impl<S: Simd> Lane for f64x8<S> {
    type Mask = mask64x8<S>;
    type Words = u64x8<S>;

    #[inline(always)]
    fn sealed(self) -> Self {
        if converts(self.token()) {
            return self;
        }
        let zero = u64x8::splat(self.token(), ZERO.load(Ordering::Relaxed));
        let bits: u64x8<S> = self.bitcast();
        (bits | zero).bitcast()
    }

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        SimdBase::splat(self.token(), value)
    }

    #[inline(always)]
    fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
        let mut elements = [0.0; WIDTH];
        self.store_slice(&mut elements);
        replace(&mut elements);
        Self::from_slice(self.token(), &elements)
    }

    #[inline(always)]
    fn store(self, row: &mut [f64]) {
        self.store_slice(&mut row[..WIDTH]);
    }

    #[inline(always)]
    fn load(self, row: &[f64]) -> Self {
        Self::from_slice(self.token(), &row[..WIDTH])
    }

    #[inline(always)]
    fn outlined<R>(self, compute: impl FnOnce() -> R) -> R {
        outlined(self.token(), compute)
    }

    #[inline(always)]
    fn outlined_if_narrow<R>(self, compute: impl FnOnce() -> R) -> R {
        outlined_if_narrow(self.token(), compute)
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        self.mul_add(factor, term)
    }

    #[inline(always)]
    fn root(self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn size(self) -> Self {
        self.abs()
    }

    #[inline(always)]
    fn below(self, other: Self) -> mask64x8<S> {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> mask64x8<S> {
        self.simd_le(other)
    }

    #[inline(always)]
    fn select(mask: mask64x8<S>, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }

    #[inline(always)]
    fn nearest(self) -> Self {
        // Machines without the instruction would call a function for each element.
        if fuses(self.token().level()) {
            self.round_ties_even()
        } else {
            (self + ROUNDER) - ROUNDER
        }
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits: u64x8<S> = self.bitcast();
        let shifted: i64x8<S> = (bits - ROOT_HALF).bitcast();
        let exponent = shifted >> 52;
        let k: u64x8<S> = exponent.bitcast();
        let m: Self = (bits - (k << 52)).bitcast();
        if converts(self.token()) {
            return (m, exponent.to_float());
        }
        // A small integer added to the bits of 1.5·2^52 is added to its value.
        let sum: Self = (k + ROUNDER.to_bits()).bitcast();
        (m, sum - ROUNDER)
    }

    #[inline(always)]
    fn power_of_two(self) -> Self {
        let bits: u64x8<S> = (self + ROUNDER).bitcast();
        ((bits + 1023) << 52).bitcast()
    }

    #[inline(always)]
    fn alternate(self, k: Self) -> Self {
        let (sum, bits): (u64x8<S>, u64x8<S>) = ((k + ROUNDER).bitcast(), self.bitcast());
        (bits ^ (sum << 63)).bitcast()
    }

    #[inline(always)]
    fn words(self) -> u64x8<S> {
        let bits: u64x8<S> = (self + ROUNDER).bitcast();
        (bits & 0xffff_ffff) | (bits << 32)
    }

    #[inline(always)]
    fn where_bits(words: u64x8<S>, bits: u64, wanted: u64, yes: Self, no: Self) -> Self {
        (words & bits).simd_eq(wanted).select(yes, no)
    }

    #[inline(always)]
    fn negated_where(self, words: u64x8<S>, bit: u32) -> Self {
        let bits: u64x8<S> = self.bitcast();
        (bits ^ ((words << (63 - bit)) & 1 << 63)).bitcast()
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        let [a, b, c, d, e, f, g, h] = places(self, list.len());
        let row = [list[a], list[b], list[c], list[d], list[e], list[f], list[g], list[h]];
        Self::from_slice(self.token(), &row)
    }

    #[inline(always)]
    fn columns(self, table: &[Row]) -> [Self; 5] {
        let (simd, [a, b, c, d, e, f, g, h]) = (self.token(), places(self, table.len()));
        let (a, b, c, d) = (&table[a], &table[b], &table[c], &table[d]);
        let (e, f, g, h) = (&table[e], &table[f], &table[g], &table[h]);
        let fifth = [a.0[4], b.0[4], c.0[4], d.0[4], e.0[4], f.0[4], g.0[4], h.0[4]];
        let (a, b) = (two_rows(simd, a, b), two_rows(simd, c, d));
        let (c, d) = (two_rows(simd, e, f), two_rows(simd, g, h));
        // Columns 0 and 2 from columns 1 and 3, then each by itself.
        let (even_low, odd_low) = simd.deinterleave_f64x8(a, b);
        let (even_high, odd_high) = simd.deinterleave_f64x8(c, d);
        let (first, third) = simd.deinterleave_f64x8(even_low, even_high);
        let (second, fourth) = simd.deinterleave_f64x8(odd_low, odd_high);
        [first, second, third, fourth, Self::from_slice(simd, &fifth)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::words::Words32;
    use super::*;

    /// Entries, columns and choices by the bits of a hash.
    #[inline(always)]
    fn looked_up<L: Lane>(numbers: L, list: &[f64], table: &[Row]) -> [L; 8] {
        let [a, b, c, d, e] = numbers.columns(table);
        let words = numbers.words();
        let words = words.plus(words.each([7, 0xffff_fff0])).times(0x85eb_ca6b).folded(13);
        let chosen = L::where_bits(words, 5 << 32, 4 << 32, a, b);
        let negated = c.negated_where(words ^ words.folded(3), 40);
        [numbers.entry(list), a, b, c, d, e, chosen, negated]
    }

    struct LookedUp<'a>([f64; WIDTH], &'a [f64], &'a [Row]);
    impl Task for LookedUp<'_> {
        type Output = [[f64; WIDTH]; 8];
        #[inline(always)]
        fn run<S: Simd>(self, simd: S) -> Self::Output {
            let mut rows = [[0.0; WIDTH]; 8];
            let values = looked_up(f64x8::from_slice(simd, &self.0), self.1, self.2);
            for (row, value) in rows.iter_mut().zip(values) {
                value.store_slice(row);
            }
            rows
        }
    }

    #[test]
    fn tables_and_words_are_those_of_scalars() {
        let list: Vec<f64> = (0..100).map(|n| 0.5 + f64::from(n)).collect();
        let row = |x: &f64| Row(std::array::from_fn(|n| x + 1e3 * n as f64));
        let table: Vec<Row> = list.iter().map(row).collect();
        let levels = levels();
        for first in 0..100 {
            // The last places are beyond the lists.
            let numbers = std::array::from_fn(|lane| f64::from(first) + 3.0 * lane as f64);
            for &level in &levels {
                let packs = on(level, LookedUp(numbers, &list, &table));
                for (lane, &number) in numbers.iter().enumerate() {
                    let alone = looked_up(number, &list, &table);
                    assert_eq!(packs.map(|row| row[lane]), alone, "{number} at {level:?}");
                }
            }
        }
    }
}
