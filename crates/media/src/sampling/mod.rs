//! Sampling extinctions σ̂, controls, and flights through them, along a ray and in space.

mod control;
mod cursor;
mod flight;
mod gaps;
mod inverse;
mod majorants;
mod piecewise;
mod search;

pub use control::Control;
pub use cursor::Cursor;
pub use flight::{BothWays, FlightOverPieces, FlightWithGaps, PackedFlight};
pub use gaps::ConstantWithGaps;
pub use inverse::Inverse;
pub(super) use inverse::InverseTable;
pub use majorants::Majorants;
pub use majorants::flights::{Flights, Flown, MajorantView, Reach};
pub use piecewise::Piecewise;
