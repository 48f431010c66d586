//! Packs on AVX-512: one register, and a mask of eight bits.

use std::arch::x86_64::{
    __m512d, __m512i, _CMP_LE_OQ, _CMP_LT_OQ, _MM_FROUND_NO_EXC, _MM_FROUND_TO_NEAREST_INT,
    _mm_cvtsi32_si128, _mm512_add_epi32, _mm512_add_epi64, _mm512_add_pd, _mm512_and_pd,
    _mm512_and_si512, _mm512_andnot_pd, _mm512_castpd_si512, _mm512_castpd256_pd512,
    _mm512_castsi512_pd, _mm512_cmp_pd_mask, _mm512_cmpeq_epi64_mask, _mm512_cvtepi64_pd,
    _mm512_cvtepu64_pd, _mm512_div_pd, _mm512_fmadd_pd, _mm512_insertf64x4,
    _mm512_mask_blend_epi64, _mm512_mask_blend_pd, _mm512_max_pd, _mm512_min_epu32, _mm512_min_pd,
    _mm512_mul_pd, _mm512_mullo_epi32, _mm512_or_si512, _mm512_permutex2var_pd,
    _mm512_roundscale_pd, _mm512_set1_epi32, _mm512_set1_epi64, _mm512_set1_pd, _mm512_setr_epi64,
    _mm512_sll_epi64, _mm512_slli_epi64, _mm512_sqrt_pd, _mm512_srai_epi64, _mm512_srl_epi32,
    _mm512_srl_epi64, _mm512_srli_epi64, _mm512_sub_epi64, _mm512_sub_pd, _mm512_unpackhi_pd,
    _mm512_unpacklo_pd, _mm512_xor_pd, _mm512_xor_si512,
};

use fearless_simd::{Avx512, SimdBase, SimdInto, f64x4, f64x8, kernel, u64x8};

use super::lanes::lanes;
use super::{Hardware, WIDTH, outlined, places};
use crate::scalar_lane::{ROOT_HALF, ROUNDER};
use crate::words::joined;
use crate::{CacheRow, Lane, Mask, Words32};

/// Eight doubles.
#[derive(Debug, Clone, Copy)]
pub struct Pack {
    all: __m512d,
    simd: Avx512,
}

/// Eight times true or false.
#[derive(Debug, Clone, Copy)]
pub struct Bools {
    all: u8,
    simd: Avx512,
}

/// Eight 64-bit words.
#[derive(Debug, Clone, Copy)]
pub struct Words {
    all: __m512i,
    simd: Avx512,
}

/// Operations on registers.
macro_rules! whole {
    ($(fn $of:ident($($x:ident: $X:ident),* $(; $all:ident: $All:ty)?) -> $R:ident $whole:block)*) => {
        $(kernel! {
            #[inline(always)]
            fn $of(simd: Avx512, $($x: $X,)* $($all: $All)?) -> $R {
                $(let $x = $x.all;)*
                $R { all: $whole, simd }
            }
        })*
    };
}

whole! {
    fn add(x: Pack, y: Pack) -> Pack { _mm512_add_pd(x, y) }
    fn subtract(x: Pack, y: Pack) -> Pack { _mm512_sub_pd(x, y) }
    fn multiply(x: Pack, y: Pack) -> Pack { _mm512_mul_pd(x, y) }
    fn divide(x: Pack, y: Pack) -> Pack { _mm512_div_pd(x, y) }
    fn add_number(x: Pack; y: f64) -> Pack { _mm512_add_pd(x, _mm512_set1_pd(y)) }
    fn subtract_number(x: Pack; y: f64) -> Pack { _mm512_sub_pd(x, _mm512_set1_pd(y)) }
    fn multiply_number(x: Pack; y: f64) -> Pack { _mm512_mul_pd(x, _mm512_set1_pd(y)) }
    fn subtract_from_one(x: Pack) -> Pack { _mm512_sub_pd(_mm512_set1_pd(1.0), x) }
    fn negate(x: Pack) -> Pack { _mm512_xor_pd(x, _mm512_set1_pd(-0.0)) }
    fn times_plus(x: Pack, y: Pack, z: Pack) -> Pack { _mm512_fmadd_pd(x, y, z) }
    fn linear(x: Pack; c: [f64; 2]) -> Pack {
        _mm512_fmadd_pd(_mm512_set1_pd(c[0]), x, _mm512_set1_pd(c[1]))
    }
    fn root(x: Pack) -> Pack { _mm512_sqrt_pd(x) }
    fn size(x: Pack) -> Pack { _mm512_andnot_pd(_mm512_set1_pd(-0.0), x) }
    fn maximum(x: Pack, y: Pack) -> Pack { _mm512_max_pd(x, y) }
    fn minimum(x: Pack, y: Pack) -> Pack { _mm512_min_pd(x, y) }
    fn nearest(x: Pack) -> Pack {
        _mm512_roundscale_pd::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(x)
    }

    fn below(x: Pack, y: Pack) -> Bools { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(x, y) }
    fn at_most(x: Pack, y: Pack) -> Bools { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(x, y) }
    fn select(which: Bools, yes: Pack, no: Pack) -> Pack { _mm512_mask_blend_pd(which, no, yes) }
    fn add_where(which: Bools, x: Pack, y: Pack) -> Pack {
        _mm512_mask_blend_pd(which, x, _mm512_add_pd(x, y))
    }
    fn multiply_where(which: Bools, x: Pack, y: Pack) -> Pack {
        _mm512_mask_blend_pd(which, x, _mm512_mul_pd(x, y))
    }

    fn both(x: Bools, y: Bools) -> Bools { x & y }
    fn either(x: Bools, y: Bools) -> Bools { x | y }
    fn one_of_two(x: Bools, y: Bools) -> Bools { x ^ y }
    fn not(x: Bools) -> Bools { !x }
    fn select_bools(which: Bools, yes: Bools, no: Bools) -> Bools { (which & yes) | (!which & no) }

    fn power_of_two(x: Pack) -> Pack {
        let exponent = _mm512_add_epi64(integer(x), _mm512_set1_epi64(1023));
        _mm512_castsi512_pd(_mm512_slli_epi64::<52>(exponent))
    }
    fn alternate(x: Pack, k: Pack) -> Pack {
        let sign = _mm512_castsi512_pd(_mm512_slli_epi64::<63>(integer(k)));
        _mm512_xor_pd(x, sign)
    }
    fn words_of(x: Pack) -> Words {
        let bits = integer(x);
        let low = _mm512_and_si512(bits, _mm512_set1_epi64(0xffff_ffff));
        _mm512_or_si512(low, _mm512_slli_epi64::<32>(bits))
    }
    fn places_of(x: Pack; last: u32) -> Words {
        _mm512_min_epu32(integer(x), _mm512_set1_epi32(last.cast_signed()))
    }
    fn are_bits(words: Words; bits: [u64; 2]) -> Bools {
        let result = _mm512_and_si512(words, _mm512_set1_epi64(bits[0].cast_signed()));
        _mm512_cmpeq_epi64_mask(result, _mm512_set1_epi64(bits[1].cast_signed()))
    }
    fn negate_where(x: Pack, words: Words; bit: u32) -> Pack {
        let shifted = _mm512_sll_epi64(words, count(63 - bit));
        _mm512_xor_pd(x, _mm512_and_pd(_mm512_castsi512_pd(shifted), _mm512_set1_pd(-0.0)))
    }

    fn add_words(x: Words, y: Words) -> Words { _mm512_add_epi64(x, y) }
    fn exclusive_or(x: Words, y: Words) -> Words { _mm512_xor_si512(x, y) }
    fn inclusive_or(x: Words, y: Words) -> Words { _mm512_or_si512(x, y) }
    fn shift_left(x: Words; bits: u32) -> Words { _mm512_sll_epi64(x, count(bits)) }
    fn shift_right(x: Words; bits: u32) -> Words { _mm512_srl_epi64(x, count(bits)) }
    fn select_words(which: Bools, yes: Words, no: Words) -> Words {
        _mm512_mask_blend_epi64(which, no, yes)
    }
    fn upper(words: Words) -> Pack { _mm512_cvtepu64_pd(_mm512_srli_epi64::<11>(words)) }
    fn add_each(x: Words, y: Words) -> Words { _mm512_add_epi32(x, y) }
    fn multiply_each(x: Words; factor: u32) -> Words {
        _mm512_mullo_epi32(x, _mm512_set1_epi32(factor.cast_signed()))
    }
    fn fold_each(x: Words; bits: u32) -> Words {
        _mm512_xor_si512(x, _mm512_srl_epi32(x, count(bits)))
    }

    fn splat(; value: f64) -> Pack { _mm512_set1_pd(value) }
    fn splat_words(; word: u64) -> Words { _mm512_set1_epi64(word.cast_signed()) }
}

/// Bits that end in an integer, `|x| < 2^51`.
#[inline]
#[target_feature(enable = "avx512f")]
fn integer(x: __m512d) -> __m512i {
    _mm512_castpd_si512(_mm512_add_pd(x, _mm512_set1_pd(ROUNDER)))
}

/// A number of bits to shift by.
#[inline]
#[target_feature(enable = "avx512f")]
fn count(bits: u32) -> std::arch::x86_64::__m128i {
    _mm_cvtsi32_si128(bits.cast_signed())
}

kernel! {
    #[inline(always)]
    fn split(simd: Avx512, x: Pack) -> [Pack; 2] {
        let bits = _mm512_castpd_si512(x.all);
        let shifted = _mm512_sub_epi64(bits, _mm512_set1_epi64(ROOT_HALF.cast_signed()));
        let exponent = _mm512_srai_epi64::<52>(shifted);
        let m = _mm512_sub_epi64(bits, _mm512_slli_epi64::<52>(exponent));
        let pack = |all| Pack { all, simd };
        [pack(_mm512_castsi512_pd(m)), pack(_mm512_cvtepi64_pd(exponent))]
    }
}

#[inline(always)]
fn any(_: Avx512, x: Bools) -> bool {
    x.all != 0
}

#[inline(always)]
fn bits(_: Avx512, x: Bools) -> u64 {
    u64::from(x.all)
}

#[inline(always)]
#[allow(clippy::cast_possible_truncation)] // eight bits
fn bools(simd: Avx512, bits: u64) -> Bools {
    Bools { all: bits as u8, simd }
}

kernel! {
    #[inline(always)]
    fn load(simd: Avx512, row: &[f64; WIDTH]) -> Pack {
        Pack { all: f64x8::from_slice(simd, row).into(), simd }
    }
}

kernel! {
    #[inline(always)]
    fn store(simd: Avx512, x: Pack, row: &mut [f64; WIDTH]) {
        let all: f64x8<Avx512> = x.all.simd_into(simd);
        all.store_slice(row);
    }
}

kernel! {
    #[inline(always)]
    fn load_words(simd: Avx512, row: &[u64; WIDTH]) -> Words {
        Words { all: u64x8::from_slice(simd, row).into(), simd }
    }
}

kernel! {
    #[inline(always)]
    fn store_words(simd: Avx512, x: Words, row: &mut [u64; WIDTH]) {
        let all: u64x8<Avx512> = x.all.simd_into(simd);
        all.store_slice(row);
    }
}

kernel! {
    #[inline(always)]
    fn columns(simd: Avx512, rows: [&CacheRow; WIDTH]) -> [Pack; 4] {
        let half = |row: &CacheRow| f64x4::from_slice(simd, &row.0[..4]).into();
        let two = |low, high| {
            _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(half(low)), half(high))
        };
        let [a, b, c, d, e, f, g, h] = rows;
        let (a, b, c, d) = (two(a, e), two(b, f), two(c, g), two(d, h));
        let (even_low, odd_low) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
        let (even_high, odd_high) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
        let first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
        let second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
        let pack = |low, which, high| Pack { all: _mm512_permutex2var_pd(low, which, high), simd };
        [
            pack(even_low, first, even_high),
            pack(odd_low, first, odd_high),
            pack(even_low, second, even_high),
            pack(odd_low, second, odd_high),
        ]
    }
}

/// A choice between numbers is stored as fast as a number.
#[inline(always)]
fn sealed(_: Avx512, x: Pack) -> Pack {
    x
}

lanes!(Avx512, is one register: true);
