//! Numbers: lanes and their elementary functions, power series, exact sums, quadrature, roots.
//!
//! Floor 0. Nothing here depends on light, media or statistics.

pub mod cumulative;
pub mod digits;
pub mod double_double;
pub mod elementary;
pub mod exponential_integral;
pub mod fused;
pub mod geometry;
pub mod jet;
pub mod known;
pub mod lane;
pub mod mask;
pub mod matrix;
#[cfg(feature = "packs")]
pub mod pack;
pub mod quadrature;
pub mod rng;
pub mod roots;
pub mod single;
pub mod sum;
#[cfg(feature = "packs")]
pub mod twin;
pub mod words;

pub use cumulative::Cumulative;
pub use double_double::Wide;
pub use exponential_integral::exponential_integrals;
pub use jet::{Jet, Scalar};
pub use known::{Grade, Known, Span};
pub use lane::{Lane, Row};
pub use mask::{Kept, Mask};
pub use single::{Fused, Narrow, Plain, Single};
#[cfg(feature = "packs")]
pub use twin::Twin;
pub use words::Words32;
