//! Names of the checks of draws.

use std::fmt;

macro_rules! ids {
    ($($(#[$about:meta])* $Id:ident $name:literal)*) => {
        /// A check, as `trueflight list checks` explains it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
        pub enum CheckId {
            $($(#[$about])* $Id,)*
        }

        impl CheckId {
            /// All checks, in the order of the catalogue.
            pub const ALL: &'static [Self] = &[$(Self::$Id),*];

            /// The name in lists, tables and records.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$Id => $name,)*
                }
            }
        }
    };
}

ids! {
    /// The mean.
    Mean "mean"
    /// The variance.
    Variance "variance"
    /// The mean number of lookups.
    Lookups "lookups"
    /// The covariance of two values of a draw.
    Covariance "covariance"
    /// The distribution of the number of lookups.
    Counts "counts"
    /// The probabilities of single values.
    Atoms "atoms"
    /// The distribution of free flights.
    Distances "distances"
    /// The distribution of the largest optical depth.
    Depth "depth"
    /// The curve along one walk.
    Curve "curve"
    /// The spread of the sums of blocks.
    Dispersion "dispersion"
    /// The sums of random streams beside each other.
    Streams "streams"
    /// The random numbers themselves.
    Generator "generator"
    /// Bits that draws lack.
    Resolution "resolution"
    /// The balance of each walk.
    Invariant "invariant"
    /// Draws that are no finite numbers.
    Numeric "numeric"
}

impl fmt::Display for CheckId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
