//! Decisions of a walk in double precision, repeated in single precision.
//!
//! Two walks that decide differently separate for good, and their difference carries little information. Single
//! precision therefore repeats the decisions of the doubles, and its draw is weighted by their likelihood:
//!
//! ```text
//! X₂₄ · ∏ P₂₄(decision)/Q(decision),   P₂₄(u < y) = ⌈2²⁴ y⌉/2²⁴
//! Q   probability by which doubles decide: P₅₃, or 1 where walks are kept from their end and weighted by P₅₃ themselves
//! ```
//!
//! The mean is exactly that of walks that decide in single precision.
//!
//! A walk in doubles runs on a new [`Trail`], which writes its decisions down. A walk in single precision runs on the
//! trail [`again`](Trail::again), with the decisions as its script. A [`Traced`] number is a lane for the walks of the
//! estimators. It stores that it is `a u + b` of a uniform number u, and a comparison with such a number is a decision:
//! the side of a bound on which u is. Leaving the medium is no decision. If rounding separates two walks there, the next
//! decision is about another word than in the script, and single precision makes its own decisions from then on.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::ops::{Add, Div, Mul, Neg, Sub};

use numeric::fused::compiled_once;
use numeric::rng::{Random, Stream};
use numeric::{CacheRow, F32, Lane, ScalarLane};

/// Double or single precision.
pub trait Precision: ScalarLane {
    /// 2ⁿ: uniform numbers are the upper n bits of a word, as renderers make them.
    const LATTICE: f64;
}

impl Precision for f64 {
    const LATTICE: f64 = 9_007_199_254_740_992.0;
}

impl Precision for F32 {
    const LATTICE: f64 = 16_777_216.0;
}

/// A side of a bound on which a uniform number is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BoundSide {
    Below,
    Above,
}

impl BoundSide {
    fn other(self) -> Self {
        match self {
            Self::Below => Self::Above,
            Self::Above => Self::Below,
        }
    }
}

/// A decision: the side of a bound that the uniform number of a word counts to be on.
#[derive(Debug, Clone, Copy)]
struct Decision {
    word: u32,
    side: BoundSide,
    /// Q.
    probability: f64,
}

#[derive(Debug)]
struct TrailState {
    stream: Stream,
    /// True if comparisons, which would end the walk, are false.
    is_kept: bool,
    /// Number of words that were taken.
    words: u32,
    /// Decisions of an earlier walk that are still to be repeated; none once the walks have separated.
    script: VecDeque<Decision>,
    /// Decisions of this walk.
    made: VecDeque<Decision>,
    likelihood: f64,
    /// Number of the last word with a decision, and the interval to which its decisions restrict its uniform number.
    interval: (u32, [f64; 2]),
}

/// The random numbers and decisions of a walk.
#[derive(Debug)]
pub struct Trail(RefCell<TrailState>);

impl Trail {
    /// Trail of a walk. It decides by random numbers; if `is_kept`, its comparisons, which would end it, are false.
    pub fn new(stream: Stream, is_kept: bool) -> Self {
        let (script, made, interval) = (VecDeque::new(), VecDeque::new(), (0, [0.0, 1.0]));
        let likelihood = 1.0;
        Self(RefCell::new(TrailState {
            stream,
            is_kept,
            words: 0,
            script,
            made,
            likelihood,
            interval,
        }))
    }

    /// The trail of a walk that repeats the decisions, with the words of the same stream.
    #[must_use]
    pub fn again(self, stream: Stream) -> Self {
        let TrailState { is_kept, made, .. } = self.0.into_inner();
        let fresh = Self::new(stream, is_kept);
        fresh.0.borrow_mut().script = made;
        fresh
    }

    /// Factor of the draw: the product of `P(decision)/Q(decision)`.
    pub fn likelihood(&self) -> f64 {
        self.0.borrow().likelihood
    }

    /// Number of random words that the walk took.
    pub fn words(&self) -> f64 {
        f64::from(self.0.borrow().words)
    }

    /// The next uniform number of a precision, and the number of its word.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a power of two
    fn uniform<N: Precision>(&self) -> (f64, u32) {
        let state = &mut *self.0.borrow_mut();
        state.words += 1;
        let lattice = N::LATTICE as u64;
        let upper = state.stream.word() >> (64 - lattice.trailing_zeros());
        (upper as f64 / N::LATTICE, state.words)
    }
}

impl TrailState {
    /// Decides on which side of a bound the uniform number of a word counts to be: as the script has it, else on the
    /// side of the number that was `drawn`, or, in a walk that is kept, on the `surviving` side. The number is below
    /// the bound with the probability `bound`.
    fn decide(
        &mut self,
        word: u32,
        bound: f64,
        drawn: BoundSide,
        surviving: BoundSide,
    ) -> BoundSide {
        let [low, high] = if self.interval.0 == word { self.interval.1 } else { [0.0, 1.0] };
        let below = ((bound - low) / (high - low)).clamp(0.0, 1.0);
        let own = |side| if side == BoundSide::Below { below } else { 1.0 - below };
        let decision = match self.script.pop_front() {
            Some(earlier) if earlier.word == word => earlier,
            _ => {
                self.script.clear();
                let side = if self.is_kept { surviving } else { drawn };
                Decision { word, side, probability: if self.is_kept { 1.0 } else { own(side) } }
            }
        };
        self.made.push_back(decision);
        let Decision { side, probability, .. } = decision;
        // By rounding, a number may be where the probability is 0.
        if probability > 0.0 {
            self.likelihood *= own(side) / probability;
        }
        let rest =
            if side == BoundSide::Below { [low, bound.min(high)] } else { [bound.max(low), high] };
        self.interval = (word, rest);
        side
    }
}

/// `scale · u + shift`, of the uniform number u of a word.
#[derive(Debug, Clone, Copy)]
struct ScaledWord<'a> {
    trail: &'a Trail,
    word: u32,
    scale: f64,
    shift: f64,
}

/// A number of a walk that follows a trail.
#[derive(Debug, Clone, Copy)]
pub struct Traced<'a, N> {
    number: N,
    drawn: Option<ScaledWord<'a>>,
}

impl<N: Precision> Traced<'_, N> {
    #[inline(always)]
    fn plain(number: N) -> Self {
        Self { number, drawn: None }
    }

    /// This number times a factor plus a term.
    #[inline(always)]
    fn on_line(self, factor: f64, term: f64, number: N) -> Self {
        let Some(drawn) = self.drawn else { return Self::plain(number) };
        let (scale, shift) = (drawn.scale * factor, drawn.shift * factor + term);
        Self { number, drawn: Some(ScaledWord { scale, shift, ..drawn }) }
    }

    /// Returns the result of a comparison `self < other`, which is `plainly` for the plain numbers. With a drawn number
    /// it is a decision.
    #[inline(never)]
    fn is_less(self, other: Self, plainly: bool) -> bool {
        let (drawn, bound, is_smaller) = match (self.drawn, other.drawn) {
            (Some(drawn), _) => (drawn, other.number, true),
            (_, Some(drawn)) => (drawn, self.number, false),
            _ => return plainly,
        };
        let bound = (bound.double() - drawn.shift) / drawn.scale;
        let bound = ((bound * N::LATTICE).ceil() / N::LATTICE).clamp(0.0, 1.0);
        // The side of the uniform number on which the comparison is true.
        let less =
            if is_smaller == (drawn.scale > 0.0) { BoundSide::Below } else { BoundSide::Above };
        let side = if plainly { less } else { less.other() };
        let state = &mut *drawn.trail.0.borrow_mut();
        state.decide(drawn.word, bound, side, less.other()) == less
    }
}

impl<'a, N: Precision> Random<Traced<'a, N>> for &'a Trail {
    fn uniform(&mut self) -> Traced<'a, N> {
        let (u, word) = Trail::uniform::<N>(self);
        let drawn = ScaledWord { trail: self, word, scale: 1.0, shift: 0.0 };
        Traced { number: N::of(u), drawn: Some(drawn) }
    }

    fn ln_uniform(&mut self) -> Traced<'a, N> {
        // `1 − u` is exact.
        Traced::plain(N::of(1.0 - Trail::uniform::<N>(self).0).ln())
    }

    fn uniform_where(&mut self, which: bool) -> Traced<'a, N> {
        if which { Random::uniform(self) } else { Traced::of(0.0) }
    }

    fn ln_uniform_where(&mut self, which: bool) -> Traced<'a, N> {
        if which { Random::<Traced<N>>::ln_uniform(self) } else { Traced::of(0.0) }
    }
}

/// Operations of the number. Only products stay linear in a uniform number.
macro_rules! as_number {
    ($($Trait:ident::$method:ident($Other:ty): |$a:ident, $b:ident| $result:expr;)*) => {
        $(impl<N: Precision> $Trait<$Other> for Traced<'_, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, $b: $Other) -> Self {
                let $a = self;
                $result
            }
        })*
    };
    ($($method:ident($($other:ident)?))*) => {
        $(#[inline(always)]
        fn $method(self $(, $other: Self)?) -> Self {
            Self::plain(self.number.$method($($other.number)?))
        })*
    };
}

as_number! {
    Add::add(Self): |a, b| Self::plain(a.number + b.number);
    Sub::sub(Self): |a, b| Self::plain(a.number - b.number);
    Mul::mul(Self): |a, b| a.on_line(b.double(), 0.0, a.number * b.number);
    Div::div(Self): |a, b| Self::plain(a.number / b.number);
    Add::add(f64): |a, b| Self::plain(a.number + b);
    Sub::sub(f64): |a, b| Self::plain(a.number - b);
    Mul::mul(f64): |a, b| a.on_line(b, 0.0, a.number * b);
}

/// Functions of the number, compiled once and not in every walk, which takes a third off the compilation of this crate.
macro_rules! apart {
    ($($method:ident)*) => {
        $(#[inline(never)]
        fn $method(self) -> Self {
            Self::plain(compiled_once(
                #[inline(always)]
                || self.number.$method(),
            ))
        })*
    };
}

impl<N: Precision> Neg for Traced<'_, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::plain(-self.number)
    }
}

impl<N: Precision> ScalarLane for Traced<'_, N> {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self::plain(N::of(x))
    }

    #[inline(always)]
    fn double(self) -> f64 {
        self.number.double()
    }
}

impl<N: Precision> Lane for Traced<'_, N> {
    type Mask = bool;
    type Words = N::Words;

    as_number! {
        root() size() nearest() power_of_two() alternate(k)
    }

    apart! { ln exp cos sin cos_pi_size }

    #[inline(always)]
    fn each(self, value: f64) -> Self {
        Self::of(value)
    }

    #[inline(always)]
    fn replaced(self, replace: impl FnMut(&mut [f64])) -> Self {
        Self::plain(self.number.replaced(replace))
    }

    #[inline(always)]
    fn times_plus(self, factor: Self, term: Self) -> Self {
        let number = self.number.times_plus(factor.number, term.number);
        self.on_line(factor.double(), term.double(), number)
    }

    #[inline(always)]
    fn below(self, other: Self) -> bool {
        self.is_less(other, self.number.below(other.number))
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self.is_less(other, self.number.at_most(other.number))
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let (m, k) = self.number.split();
        (Self::plain(m), Self::plain(k))
    }

    #[inline(always)]
    fn words(self) -> N::Words {
        self.number.words()
    }

    #[inline(always)]
    fn where_bits(words: N::Words, bits: u64, expected: u64, yes: Self, no: Self) -> Self {
        Self::plain(N::where_bits(words, bits, expected, yes.number, no.number))
    }

    #[inline(always)]
    fn negated_where(self, words: N::Words, bit: u32) -> Self {
        Self::plain(self.number.negated_where(words, bit))
    }

    #[inline(always)]
    fn entry(self, list: &[f64]) -> Self {
        Self::plain(self.number.entry(list))
    }

    #[inline(always)]
    fn columns(self, table: &[CacheRow]) -> [Self; 5] {
        self.number.columns(table).map(Self::plain)
    }
}
