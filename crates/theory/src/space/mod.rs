//! Walks in space: bounds on the variance of their scores, and exact answers where they exist.

pub mod content;
pub mod energy;
pub mod furnace;
pub mod infinite;
pub mod predict;
pub mod sphere;

pub use energy::WalkBound;
pub use predict::energy_channel;
