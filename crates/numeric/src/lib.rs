//! Numbers: lanes and their elementary functions, power series, exact sums, quadrature, roots.
//!
//! Nothing here depends on light, media or statistics.

pub mod adaptive;
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
pub mod order;
#[cfg(feature = "packs")]
pub mod pack;
#[cfg(feature = "packs")]
pub mod pair;
pub mod quadrature;
pub mod rng;
pub mod roots;
pub mod scalar_lane;
pub mod sum;
pub mod words;

pub use cumulative::Cumulative;
pub use double_double::DoubleDouble;
pub use exponential_integral::exponential_integrals;
pub use jet::{Jet, Scalar};
pub use known::{Grade, Known, Span};
pub use lane::{CacheRow, Lane};
pub use mask::{Kept, Mask};
#[cfg(feature = "packs")]
pub use pair::Pair;
pub use scalar_lane::{F32, ScalarLane};
pub use words::Words32;
