//! Names of the checks of draws, and what each shows where it fails.
//!
//! The gate makes few of these checks itself. The others stand here because findings of all checks are compared and stored as
//! one type, and because this crate depends on none that makes them.

use std::fmt;

use crate::causes::Symptom;

/// Lists the checks: the variant, the name, and the symptom of a failure.
macro_rules! ids {
    ($($(#[$about:meta])* $Id:ident $name:literal => $symptom:ident,)*) => {
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

            /// Returns the symptom that a failure of the check is.
            pub fn symptom(self) -> Symptom {
                match self {
                    $(Self::$Id => Symptom::$symptom,)*
                }
            }
        }
    };
}

ids! {
    /// The mean.
    Mean "mean" => Mean,
    /// The variance.
    Variance "variance" => Variance,
    /// The mean number of lookups.
    Lookups "lookups" => Lookups,
    /// The covariance of two values of a draw.
    Covariance "covariance" => Correlation,
    /// The distribution of the number of lookups.
    Counts "counts" => LookupDistribution,
    /// The probabilities of single values.
    Atoms "atoms" => Distribution,
    /// The distribution of free flights.
    Distances "distances" => Distribution,
    /// The distribution of the largest optical depth.
    Depth "depth" => Distribution,
    /// The curve along one walk.
    Curve "curve" => Correlation,
    /// The spread of the sums of blocks.
    Dispersion "dispersion" => Dependence,
    /// The sums of random streams beside each other.
    Streams "streams" => Dependence,
    /// The random numbers themselves.
    Generator "generator" => Dependence,
    /// Bits that draws lack.
    Resolution "resolution" => Resolution,
    /// The balance of each walk.
    Invariant "invariant" => Balance,
    /// Draws that are no finite numbers.
    Numeric "numeric" => Number,
}

impl fmt::Display for CheckId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
