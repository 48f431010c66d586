//! Predictions for draws: moments, costs, distributions and optima, without drawing.
//!
//! Floor 3. Nothing here holds a generator of random numbers. All integrals run over one [`Mesh`]
//! per medium and ray, on which σ_t is looked up once and shared by every σ̂, control and rule.

pub mod bidirectional_rod;
pub mod chromatic_slab;
pub mod colours;
pub mod contour;
pub mod count;
pub mod curve;
pub mod flight;
pub mod heuristic;
pub mod lit_rod;
pub mod lit_slab;
pub mod lookups;
pub mod memo;
pub mod mesh;
pub mod moments;
pub mod optimum;
pub mod parallel;
pub mod particle;
pub mod prediction;
pub mod problems;
pub mod product;
pub mod raw;
pub mod rod;
pub mod rule;
pub mod rules;
pub mod single;
pub mod slab;
pub mod space;
pub mod spectral;
pub mod spectral_furnace;
pub mod spectral_lit_rod;
pub mod spectral_rod;
pub mod spectral_single_scattering;
pub mod spectral_slab;
pub mod sphere;
pub mod survival;
pub mod volterra;

pub use count::CountLaw;
pub use heuristic::Heuristic;
pub use mesh::Mesh;
pub use moments::Moments;
pub use particle::{Odds, ParticleRule};
pub use prediction::{Channel, Distribution, Increment, Prediction, Tails};
pub use rule::{Outcome, Rule};
