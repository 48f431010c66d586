//! What comparisons of lanes say, and what is replaced where they say so.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Not};

use super::Lane;

/// What a comparison says of each element of a lane.
pub trait Mask:
    Copy
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
    + BitAndAssign
    + BitOrAssign
    + BitXorAssign
{
    /// Whether it names an element.
    fn any(self) -> bool;

    /// Whether it may name one. A scalar knows, and skips what is not asked for; a pack says yes without looking:
    /// of eight walks some will be, and what is done for the others changes nothing.
    fn maybe(self) -> bool;

    /// Whether it names so many elements of a pack that what is done for them together pays; a scalar never waits.
    fn are_enough(self, of_pack: u32) -> bool;

    /// Which elements it names, as bits.
    fn bits(self) -> u64;

    /// Takes another's place where a mask says so.
    fn set_where(&mut self, which: Self, other: Self);
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn maybe(self) -> bool {
        self
    }

    #[inline(always)]
    fn are_enough(self, _: u32) -> bool {
        self
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        u64::from(self)
    }

    #[inline(always)]
    fn set_where(&mut self, which: bool, other: bool) {
        if which {
            *self = other;
        }
    }
}

/// What is kept of each element, and can be replaced where a mask says so: lists of lanes, structs of lanes and masks.
pub trait Kept<M>: Copy {
    /// Takes another's place where the mask says so.
    fn set_where(&mut self, which: M, other: Self);
}

impl<L: Lane, const N: usize> Kept<L::Mask> for [L; N] {
    #[inline(always)]
    fn set_where(&mut self, which: L::Mask, other: Self) {
        for (number, kept) in self.iter_mut().enumerate() {
            kept.set_where(which, other[number]);
        }
    }
}

/// A struct of what is kept, as in `kept! { /// A particle. pub struct Particle<L> { weight: L } }`.
#[macro_export]
macro_rules! kept {
    (
        $(#[$about:meta])*
        $visible:vis struct $Name:ident<$L:ident> {
            $($(#[$says:meta])* $shown:vis $field:ident: $Type:ty,)*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        $visible struct $Name<$L: $crate::Lane> {
            $($(#[$says])* $shown $field: $Type,)*
        }

        impl<$L: $crate::Lane> $crate::Kept<$L::Mask> for $Name<$L> {
            #[inline(always)]
            fn set_where(&mut self, which: $L::Mask, other: Self) {
                #[allow(unused_imports)]
                use $crate::{Kept as _, Mask as _};
                $(self.$field.set_where(which, other.$field);)*
            }
        }
    };
}
