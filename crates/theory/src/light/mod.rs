//! Techniques that find a light, and the weights of their samples.

pub mod contour;
pub mod heuristic;
pub mod techniques;
pub mod vertex;

pub use heuristic::Heuristic;
pub use techniques::{Combination, Densities, Shadow, Techniques};
