//! Packs on AVX2: two registers of four elements each.

use std::arch::x86_64::{
    __m256d, __m256i, _CMP_LE_OQ, _CMP_LT_OQ, _MM_FROUND_NO_EXC, _MM_FROUND_TO_NEAREST_INT,
    _mm_cvtsi32_si128, _mm256_add_epi32, _mm256_add_epi64, _mm256_add_pd, _mm256_and_pd,
    _mm256_and_si256, _mm256_andnot_pd, _mm256_blendv_pd, _mm256_castpd_si256, _mm256_castsi256_pd,
    _mm256_cmp_pd, _mm256_cmpeq_epi64, _mm256_div_pd, _mm256_fmadd_pd, _mm256_max_pd,
    _mm256_min_epu32, _mm256_min_pd, _mm256_movemask_pd, _mm256_mul_pd, _mm256_mullo_epi32,
    _mm256_or_pd, _mm256_or_si256, _mm256_permute2f128_pd, _mm256_round_pd, _mm256_set1_epi32,
    _mm256_set1_epi64x, _mm256_set1_pd, _mm256_setr_epi64x, _mm256_sll_epi64, _mm256_slli_epi64,
    _mm256_sqrt_pd, _mm256_srl_epi32, _mm256_srl_epi64, _mm256_srli_epi64, _mm256_sub_epi64,
    _mm256_sub_pd, _mm256_unpackhi_pd, _mm256_unpacklo_pd, _mm256_xor_pd, _mm256_xor_si256,
};

use fearless_simd::{Avx2, SimdBase, SimdInto, f64x4, kernel, u64x4};

use super::lanes::lanes;
use super::{Hardware, WIDTH, ZERO, outlined, places};
use crate::scalar_lane::{ROOT_HALF, ROUNDER};
use crate::words::joined;
use crate::{CacheRow, Lane, Mask, Words32};

/// Eight doubles.
#[derive(Debug, Clone, Copy)]
pub struct Pack {
    low: __m256d,
    high: __m256d,
    simd: Avx2,
}

/// Eight times true or false: all bits of an element are set, or none.
#[derive(Debug, Clone, Copy)]
pub struct Bools {
    low: __m256d,
    high: __m256d,
    simd: Avx2,
}

/// Eight 64-bit words.
#[derive(Debug, Clone, Copy)]
pub struct Words {
    low: __m256i,
    high: __m256i,
    simd: Avx2,
}

/// Operations, by what they do to the lower four elements and then to the upper four.
macro_rules! halves {
    ($(fn $of:ident($($x:ident: $X:ident),* $(; $all:ident: $All:ty)?) -> $R:ident $half:block)*) => {
        $(kernel! {
            #[inline(always)]
            fn $of(simd: Avx2, $($x: $X,)* $($all: $All)?) -> $R {
                let low = { $(let $x = $x.low;)* $half };
                let high = { $(let $x = $x.high;)* $half };
                $R { low, high, simd }
            }
        })*
    };
}

halves! {
    fn add(x: Pack, y: Pack) -> Pack { _mm256_add_pd(x, y) }
    fn subtract(x: Pack, y: Pack) -> Pack { _mm256_sub_pd(x, y) }
    fn multiply(x: Pack, y: Pack) -> Pack { _mm256_mul_pd(x, y) }
    fn divide(x: Pack, y: Pack) -> Pack { _mm256_div_pd(x, y) }
    fn add_number(x: Pack; y: f64) -> Pack { _mm256_add_pd(x, _mm256_set1_pd(y)) }
    fn subtract_number(x: Pack; y: f64) -> Pack { _mm256_sub_pd(x, _mm256_set1_pd(y)) }
    fn multiply_number(x: Pack; y: f64) -> Pack { _mm256_mul_pd(x, _mm256_set1_pd(y)) }
    fn subtract_from_one(x: Pack) -> Pack { _mm256_sub_pd(_mm256_set1_pd(1.0), x) }
    fn negate(x: Pack) -> Pack { _mm256_xor_pd(x, _mm256_set1_pd(-0.0)) }
    fn times_plus(x: Pack, y: Pack, z: Pack) -> Pack { _mm256_fmadd_pd(x, y, z) }
    fn linear(x: Pack; c: [f64; 2]) -> Pack {
        _mm256_fmadd_pd(_mm256_set1_pd(c[0]), x, _mm256_set1_pd(c[1]))
    }
    fn root(x: Pack) -> Pack { _mm256_sqrt_pd(x) }
    fn size(x: Pack) -> Pack { _mm256_andnot_pd(_mm256_set1_pd(-0.0), x) }
    fn maximum(x: Pack, y: Pack) -> Pack { _mm256_max_pd(x, y) }
    fn minimum(x: Pack, y: Pack) -> Pack { _mm256_min_pd(x, y) }
    fn nearest(x: Pack) -> Pack {
        _mm256_round_pd::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(x)
    }

    fn below(x: Pack, y: Pack) -> Bools { _mm256_cmp_pd::<_CMP_LT_OQ>(x, y) }
    fn at_most(x: Pack, y: Pack) -> Bools { _mm256_cmp_pd::<_CMP_LE_OQ>(x, y) }
    fn select(which: Bools, yes: Pack, no: Pack) -> Pack { _mm256_blendv_pd(no, yes, which) }
    fn add_where(which: Bools, x: Pack, y: Pack) -> Pack {
        _mm256_blendv_pd(x, _mm256_add_pd(x, y), which)
    }
    fn multiply_where(which: Bools, x: Pack, y: Pack) -> Pack {
        _mm256_blendv_pd(x, _mm256_mul_pd(x, y), which)
    }

    fn both(x: Bools, y: Bools) -> Bools { _mm256_and_pd(x, y) }
    fn either(x: Bools, y: Bools) -> Bools { _mm256_or_pd(x, y) }
    fn one_of_two(x: Bools, y: Bools) -> Bools { _mm256_xor_pd(x, y) }
    fn not(x: Bools) -> Bools { _mm256_xor_pd(x, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))) }
    fn select_bools(which: Bools, yes: Bools, no: Bools) -> Bools {
        _mm256_blendv_pd(no, yes, which)
    }

    fn power_of_two(x: Pack) -> Pack {
        let exponent = _mm256_add_epi64(integer(x), _mm256_set1_epi64x(1023));
        _mm256_castsi256_pd(_mm256_slli_epi64::<52>(exponent))
    }
    fn alternate(x: Pack, k: Pack) -> Pack {
        let sign = _mm256_castsi256_pd(_mm256_slli_epi64::<63>(integer(k)));
        _mm256_xor_pd(x, sign)
    }
    fn words_of(x: Pack) -> Words {
        let bits = integer(x);
        let low = _mm256_and_si256(bits, _mm256_set1_epi64x(0xffff_ffff));
        _mm256_or_si256(low, _mm256_slli_epi64::<32>(bits))
    }
    fn places_of(x: Pack; last: u32) -> Words {
        _mm256_min_epu32(integer(x), _mm256_set1_epi32(last.cast_signed()))
    }
    fn or_bits(x: Pack; bits: u64) -> Pack {
        _mm256_or_pd(x, _mm256_castsi256_pd(_mm256_set1_epi64x(bits.cast_signed())))
    }
    fn are_bits(words: Words; bits: [u64; 2]) -> Bools {
        let result = _mm256_and_si256(words, _mm256_set1_epi64x(bits[0].cast_signed()));
        _mm256_castsi256_pd(_mm256_cmpeq_epi64(result, _mm256_set1_epi64x(bits[1].cast_signed())))
    }
    fn negate_where(x: Pack, words: Words; bit: u32) -> Pack {
        let shifted = _mm256_sll_epi64(words, count(63 - bit));
        _mm256_xor_pd(x, _mm256_and_pd(_mm256_castsi256_pd(shifted), _mm256_set1_pd(-0.0)))
    }

    fn add_words(x: Words, y: Words) -> Words { _mm256_add_epi64(x, y) }
    fn exclusive_or(x: Words, y: Words) -> Words { _mm256_xor_si256(x, y) }
    fn inclusive_or(x: Words, y: Words) -> Words { _mm256_or_si256(x, y) }
    fn shift_left(x: Words; bits: u32) -> Words { _mm256_sll_epi64(x, count(bits)) }
    fn shift_right(x: Words; bits: u32) -> Words { _mm256_srl_epi64(x, count(bits)) }
    fn select_words(which: Bools, yes: Words, no: Words) -> Words {
        let (yes, no) = (_mm256_castsi256_pd(yes), _mm256_castsi256_pd(no));
        _mm256_castpd_si256(_mm256_blendv_pd(no, yes, which))
    }
    fn upper(words: Words) -> Pack {
        // Each half becomes the last bits of a double, above 2^84 and 2^52; all steps are exact.
        let (above, below) = (_mm256_set1_pd(ABOVE), _mm256_set1_pd(BELOW));
        let word = _mm256_srli_epi64::<11>(words);
        let high = _mm256_or_si256(_mm256_srli_epi64::<32>(word), _mm256_castpd_si256(above));
        let low = _mm256_and_si256(word, _mm256_set1_epi64x(0xffff_ffff));
        let low = _mm256_castsi256_pd(_mm256_or_si256(low, _mm256_castpd_si256(below)));
        let high = _mm256_sub_pd(_mm256_castsi256_pd(high), _mm256_set1_pd(ABOVE + BELOW));
        _mm256_add_pd(high, low)
    }
    fn add_each(x: Words, y: Words) -> Words { _mm256_add_epi32(x, y) }
    fn multiply_each(x: Words; factor: u32) -> Words {
        _mm256_mullo_epi32(x, _mm256_set1_epi32(factor.cast_signed()))
    }
    fn fold_each(x: Words; bits: u32) -> Words {
        _mm256_xor_si256(x, _mm256_srl_epi32(x, count(bits)))
    }

    fn splat(; value: f64) -> Pack { _mm256_set1_pd(value) }
    fn splat_words(; word: u64) -> Words { _mm256_set1_epi64x(word.cast_signed()) }
}

/// `2^84`.
const ABOVE: f64 = 19_342_813_113_834_066_795_298_816.0;
/// `2^52`.
const BELOW: f64 = 4_503_599_627_370_496.0;

/// Bits that end in an integer, `|x| < 2^51`.
#[inline]
#[target_feature(enable = "avx2")]
fn integer(x: __m256d) -> __m256i {
    _mm256_castpd_si256(_mm256_add_pd(x, _mm256_set1_pd(ROUNDER)))
}

/// A number of bits to shift by.
#[inline]
#[target_feature(enable = "avx2")]
fn count(bits: u32) -> std::arch::x86_64::__m128i {
    _mm_cvtsi32_si128(bits.cast_signed())
}

/// See [`Lane::split`].
#[inline]
#[target_feature(enable = "avx2")]
fn split_half(x: __m256d) -> [__m256d; 2] {
    let bits = _mm256_castpd_si256(x);
    let shifted = _mm256_sub_epi64(bits, _mm256_set1_epi64x(ROOT_HALF.cast_signed()));
    let exponent = _mm256_and_si256(shifted, _mm256_set1_epi64x(-1 << 52));
    let m = _mm256_castsi256_pd(_mm256_sub_epi64(bits, exponent));
    // There is no shift that keeps the sign: it is the highest of twelve bits, which stands for −2048 once it is turned and
    // 2048 subtracted. A small integer added to the bits of 1.5·2^52 is added to its value.
    let turned = _mm256_xor_si256(_mm256_srli_epi64::<52>(shifted), _mm256_set1_epi64x(2048));
    let rounder = _mm256_set1_epi64x((ROUNDER.to_bits() - 2048).cast_signed());
    let sum = _mm256_castsi256_pd(_mm256_add_epi64(turned, rounder));
    [m, _mm256_sub_pd(sum, _mm256_set1_pd(ROUNDER))]
}

kernel! {
    #[inline(always)]
    fn split(simd: Avx2, x: Pack) -> [Pack; 2] {
        let ([m, k], [n, l]) = (split_half(x.low), split_half(x.high));
        [Pack { low: m, high: n, simd }, Pack { low: k, high: l, simd }]
    }
}

kernel! {
    #[inline(always)]
    fn any(simd: Avx2, x: Bools) -> bool {
        _mm256_movemask_pd(_mm256_or_pd(x.low, x.high)) != 0
    }
}

kernel! {
    #[inline(always)]
    fn bits(simd: Avx2, x: Bools) -> u64 {
        let half = |half| u64::from(_mm256_movemask_pd(half).cast_unsigned());
        half(x.low) | half(x.high) << 4
    }
}

kernel! {
    #[inline(always)]
    fn bools(simd: Avx2, bits: u64) -> Bools {
        let all = _mm256_set1_epi64x(bits.cast_signed());
        let half = |own| _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(all, own), own));
        let low = half(_mm256_setr_epi64x(1, 2, 4, 8));
        Bools { low, high: half(_mm256_setr_epi64x(16, 32, 64, 128)), simd }
    }
}

kernel! {
    #[inline(always)]
    fn load(simd: Avx2, row: &[f64; WIDTH]) -> Pack {
        let low = f64x4::from_slice(simd, &row[..4]).into();
        Pack { low, high: f64x4::from_slice(simd, &row[4..]).into(), simd }
    }
}

kernel! {
    #[inline(always)]
    fn store(simd: Avx2, x: Pack, row: &mut [f64; WIDTH]) {
        let (low, high): (f64x4<Avx2>, f64x4<Avx2>) = (x.low.simd_into(simd), x.high.simd_into(simd));
        low.store_slice(&mut row[..4]);
        high.store_slice(&mut row[4..]);
    }
}

kernel! {
    #[inline(always)]
    fn load_words(simd: Avx2, row: &[u64; WIDTH]) -> Words {
        let low = u64x4::from_slice(simd, &row[..4]).into();
        Words { low, high: u64x4::from_slice(simd, &row[4..]).into(), simd }
    }
}

kernel! {
    #[inline(always)]
    fn store_words(simd: Avx2, x: Words, row: &mut [u64; WIDTH]) {
        let (low, high): (u64x4<Avx2>, u64x4<Avx2>) = (x.low.simd_into(simd), x.high.simd_into(simd));
        low.store_slice(&mut row[..4]);
        high.store_slice(&mut row[4..]);
    }
}

/// The first four columns of four rows.
#[inline]
#[target_feature(enable = "avx2")]
fn transposed([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    let (even_low, odd_low) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let (even_high, odd_high) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    [
        _mm256_permute2f128_pd::<0x20>(even_low, even_high),
        _mm256_permute2f128_pd::<0x20>(odd_low, odd_high),
        _mm256_permute2f128_pd::<0x31>(even_low, even_high),
        _mm256_permute2f128_pd::<0x31>(odd_low, odd_high),
    ]
}

kernel! {
    #[inline(always)]
    fn columns(simd: Avx2, rows: [&CacheRow; WIDTH]) -> [Pack; 4] {
        let low = |row: &CacheRow| f64x4::from_slice(simd, &row.0[..4]).into();
        let [a, b, c, d, e, f, g, h] = rows;
        let [a, b, c, d] = transposed([low(a), low(b), low(c), low(d)]);
        let [e, f, g, h] = transposed([low(e), low(f), low(g), low(h)]);
        let pack = |low, high| Pack { low, high, simd };
        [pack(a, e), pack(b, f), pack(c, g), pack(d, h)]
    }
}

/// Hides from the compiler that a pack is unchanged.
#[inline(always)]
fn sealed(simd: Avx2, x: Pack) -> Pack {
    or_bits(simd, x, ZERO.load(std::sync::atomic::Ordering::Relaxed))
}

lanes!(Avx2, is one register: false);
