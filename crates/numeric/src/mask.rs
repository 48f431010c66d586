//! Masks: results of comparisons of lanes, and values of which a mask replaces elements.

use std::ops::{BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, BitXorAssign, Not};

use super::Lane;

/// Result of a comparison of lanes: true or false for each element.
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
    /// Returns whether an element is true.
    fn any(self) -> bool;

    /// Returns whether an element may be true. A scalar tests it, to skip work. A pack returns true without a test: of
    /// eight walks, some usually need the work, and it changes nothing in the others.
    fn maybe(self) -> bool;

    /// Returns whether at least `of_pack` elements of a pack are true, so that common work pays; a scalar never waits.
    fn are_enough(self, of_pack: u32) -> bool;

    /// Returns the elements as bits, the first one lowest.
    fn bits(self) -> u64;

    /// Replaces the elements where a mask is true by those of another.
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

/// Values with elements that a mask can replace: lists of lanes, and structs of lanes and masks.
pub trait Kept<M>: Copy {
    /// Replaces the elements where the mask is true by those of another.
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

/// A struct of kept values, as in `kept! { /// A particle. pub struct Particle<L> { weight: L } }`. It may have a field
/// of another type of kept values, its second parameter.
#[macro_export]
macro_rules! kept {
    (
        $(#[$about:meta])*
        $visible:vis struct $Name:ident<$L:ident $(, $F:ident)?> {
            $($(#[$says:meta])* $shown:vis $field:ident: $Type:ty,)*
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        $visible struct $Name<$L: $crate::Lane $(, $F)?> {
            $($(#[$says])* $shown $field: $Type,)*
        }

        impl<$L: $crate::Lane $(, $F: $crate::Kept<$L::Mask>)?> $crate::Kept<$L::Mask>
            for $Name<$L $(, $F)?>
        {
            #[inline(always)]
            fn set_where(&mut self, which: $L::Mask, other: Self) {
                #[allow(unused_imports)]
                use $crate::{Kept as _, Mask as _};
                $(self.$field.set_where(which, other.$field);)*
            }
        }
    };
}
