//! The traits of packs, from the operations of a level.

/// Makes lanes of the types `Pack`, `Bools` and `Words` of a module and of its functions.
///
/// Types of one's own, and each operation a function of its own for the level: operators of `fearless_simd` are some twenty
/// functions for each on AVX2 and three on AVX-512, with copies of their numbers in memory. To remove all these again took
/// most of the time of compiling a kernel.
macro_rules! lanes {
    ($Level:ident, is one register: $is_one_register:literal) => {
        // Of several operations each: the compiler then simplifies them before it inlines them, once for all kernels.
        lanes!(functions at $Level: ln exp cos sin);

        fearless_simd::kernel! {
            #[inline(always)]
            fn next(simd: $Level, state: [Words; 4]) -> ([Words; 4], Words) {
                crate::rng::xoshiro::next(state)
            }
        }

        fearless_simd::kernel! {
            #[inline(always)]
            fn uniform_where(simd: $Level, which: Bools, state: [Words; 4]) -> ([Words; 4], Pack) {
                super::streams::uniform_where(which, state)
            }
        }

        impl Hardware for $Level {
            type Pack = Pack;
            type Mask = Bools;
            type Words = Words;

            const IS_ONE_REGISTER: bool = $is_one_register;

            #[inline(always)]
            fn splat(self, value: f64) -> Pack {
                splat(self, value)
            }

            #[inline(always)]
            fn load(self, row: &[f64; WIDTH]) -> Pack {
                load(self, row)
            }

            #[inline(always)]
            fn mask(self, bits: u64) -> Bools {
                bools(self, bits)
            }

            #[inline(always)]
            fn words(self, row: &[u64; WIDTH]) -> Words {
                load_words(self, row)
            }
        }

        lanes!(operators of Pack:
            Add::add = add, Sub::sub = subtract, Mul::mul = multiply, Div::div = divide);
        lanes!(operators of Bools:
            BitAnd::bitand = both, BitOr::bitor = either, BitXor::bitxor = one_of_two);
        lanes!(operators of Words: BitOr::bitor = inclusive_or, BitXor::bitxor = exclusive_or);
        lanes!(operators of Pack by f64:
            Add::add = add_number, Sub::sub = subtract_number, Mul::mul = multiply_number);
        lanes!(operators of Words by u32: Shl::shl = shift_left, Shr::shr = shift_right);
        lanes!(assignments of Bools: BitAndAssign::bitand_assign = both,
            BitOrAssign::bitor_assign = either, BitXorAssign::bitxor_assign = one_of_two);

        impl std::ops::Neg for Pack {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                negate(self.simd, self)
            }
        }

        impl std::ops::Not for Bools {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                not(self.simd, self)
            }
        }

        impl Mask for Bools {
            #[inline(always)]
            fn any(self) -> bool {
                any(self.simd, self)
            }

            #[inline(always)]
            fn maybe(self) -> bool {
                true
            }

            #[inline(always)]
            fn are_enough(self, of_pack: u32) -> bool {
                bits(self.simd, self).count_ones() >= of_pack
            }

            #[inline(always)]
            fn bits(self) -> u64 {
                bits(self.simd, self)
            }

            #[inline(always)]
            fn set_where(&mut self, which: Self, other: Self) {
                *self = select_bools(self.simd, which, other, *self);
            }
        }

        impl crate::rng::xoshiro::Words for Words {
            type Numbers = Pack;

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                add_words(self.simd, self, other)
            }

            #[inline(always)]
            fn upper(self) -> Pack {
                upper(self.simd, self)
            }

            #[inline(always)]
            fn next(state: [Self; 4]) -> ([Self; 4], Self) {
                next(state[0].simd, state)
            }
        }

        impl super::PackedWords for Words {
            type Mask = Bools;

            #[inline(always)]
            fn select(which: Bools, yes: Self, no: Self) -> Self {
                select_words(which.simd, which, yes, no)
            }

            #[inline(always)]
            fn uniform_where(which: Bools, state: [Self; 4]) -> ([Self; 4], Pack) {
                uniform_where(which.simd, which, state)
            }

            #[inline(always)]
            fn store(self, row: &mut [u64; WIDTH]) {
                store_words(self.simd, self, row);
            }
        }

        impl Words32 for Words {
            #[inline(always)]
            fn each(self, words: [u32; 2]) -> Self {
                splat_words(self.simd, joined(words))
            }

            #[inline(always)]
            fn plus(self, other: Self) -> Self {
                add_each(self.simd, self, other)
            }

            #[inline(always)]
            fn times(self, factor: u32) -> Self {
                multiply_each(self.simd, self, factor)
            }

            #[inline(always)]
            fn folded(self, bits: u32) -> Self {
                fold_each(self.simd, self, bits)
            }
        }

        impl Lane for Pack {
            type Mask = Bools;
            type Words = Words;

            lanes! { methods of Pack:
                times_plus(factor, term) = times_plus;
                root() = root;
                size() = size;
                nearest() = nearest;
                power_of_two() = power_of_two;
                alternate(k) = alternate;
                or_more(other) = maximum;
                or_less(other) = minimum;
                one_minus() = subtract_from_one;
                sealed() = sealed;
                ln() = ln;
                exp() = exp;
                cos() = cos;
                sin() = sin;
            }

            #[inline(always)]
            fn linear(self, slope: f64, offset: f64) -> Self {
                linear(self.simd, self, [slope, offset])
            }

            #[inline(always)]
            fn each(self, value: f64) -> Self {
                splat(self.simd, value)
            }

            #[inline(always)]
            fn replaced(self, mut replace: impl FnMut(&mut [f64])) -> Self {
                let mut row = [0.0; WIDTH];
                store(self.simd, self, &mut row);
                replace(&mut row);
                load(self.simd, &row)
            }

            #[inline(always)]
            fn store(self, row: &mut [f64]) {
                store(self.simd, self, row.first_chunk_mut().expect("a row of a pack"));
            }

            #[inline(always)]
            fn load(self, row: &[f64]) -> Self {
                load(self.simd, row.first_chunk().expect("a row of a pack"))
            }

            #[inline(always)]
            fn outlined<R>(self, compute: impl FnOnce() -> R) -> R {
                outlined(self.simd, compute)
            }

            #[inline(always)]
            fn outlined_if_narrow<R>(self, compute: impl FnOnce() -> R) -> R {
                if $is_one_register { compute() } else { outlined(self.simd, compute) }
            }

            #[inline(always)]
            fn below(self, other: Self) -> Bools {
                below(self.simd, self, other)
            }

            #[inline(always)]
            fn at_most(self, other: Self) -> Bools {
                at_most(self.simd, self, other)
            }

            #[inline(always)]
            fn select(which: Bools, yes: Self, no: Self) -> Self {
                select(which.simd, which, yes, no)
            }

            #[inline(always)]
            fn set_where(&mut self, which: Bools, other: Self) {
                *self = select(self.simd, which, other, *self);
            }

            #[inline(always)]
            fn add_where(&mut self, which: Bools, term: Self) {
                *self = add_where(self.simd, which, *self, term);
            }

            #[inline(always)]
            fn scale_where(&mut self, which: Bools, factor: Self) {
                *self = multiply_where(self.simd, which, *self, factor);
            }

            #[inline(always)]
            fn split(self) -> (Self, Self) {
                let [m, k] = split(self.simd, self);
                (m, k)
            }

            #[inline(always)]
            fn words(self) -> Words {
                words_of(self.simd, self)
            }

            #[inline(always)]
            fn where_bits(words: Words, bits: u64, expected: u64, yes: Self, no: Self) -> Self {
                let which = are_bits(words.simd, words, [bits, expected]);
                select(words.simd, which, yes, no)
            }

            #[inline(always)]
            fn negated_where(self, words: Words, bit: u32) -> Self {
                negate_where(self.simd, self, words, bit)
            }

            #[inline(always)]
            fn entry(self, list: &[f64]) -> Self {
                let numbers = places_of(self.simd, self, super::last(list.len()));
                let [a, b, c, d, e, f, g, h] = places(numbers);
                let row = [list[a], list[b], list[c], list[d], list[e], list[f], list[g], list[h]];
                load(self.simd, &row)
            }

            #[inline(always)]
            fn columns(self, table: &[CacheRow]) -> [Self; 5] {
                let numbers = places_of(self.simd, self, super::last(table.len()));
                let [a, b, c, d, e, f, g, h] = places(numbers);
                let (a, b, c, d) = (&table[a], &table[b], &table[c], &table[d]);
                let (e, f, g, h) = (&table[e], &table[f], &table[g], &table[h]);
                let fifth = [a.0[4], b.0[4], c.0[4], d.0[4], e.0[4], f.0[4], g.0[4], h.0[4]];
                let [first, second, third, fourth] = columns(self.simd, [a, b, c, d, e, f, g, h]);
                [first, second, third, fourth, load(self.simd, &fifth)]
            }
        }
    };
    (functions at $Level:ident: $($function:ident)*) => {
        $(fearless_simd::kernel! {
            #[inline(always)]
            fn $function(simd: $Level, x: Pack) -> Pack {
                crate::elementary::$function(x)
            }
        })*
    };
    (operators of $Type:ident: $($Operator:ident::$of:ident = $function:ident),*) => {
        $(impl std::ops::$Operator for $Type {
            type Output = Self;
            #[inline(always)]
            fn $of(self, other: Self) -> Self {
                $function(self.simd, self, other)
            }
        })*
    };
    (operators of $Type:ident by $Number:ty: $($Operator:ident::$of:ident = $function:ident),*) => {
        $(impl std::ops::$Operator<$Number> for $Type {
            type Output = Self;
            #[inline(always)]
            fn $of(self, number: $Number) -> Self {
                $function(self.simd, self, number)
            }
        })*
    };
    (assignments of $Type:ident: $($Operator:ident::$of:ident = $function:ident),*) => {
        $(impl std::ops::$Operator for $Type {
            #[inline(always)]
            fn $of(&mut self, other: Self) {
                *self = $function(self.simd, *self, other);
            }
        })*
    };
    (methods of Pack: $($of:ident($($other:ident),*) = $function:ident;)*) => {
        $(
            #[inline(always)]
            fn $of(self $(, $other: Self)*) -> Self {
                $function(self.simd, self $(, $other)*)
            }
        )*
    };
}

pub(super) use lanes;
