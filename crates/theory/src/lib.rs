//! Predictions for draws: moments, costs, distributions and optima, without drawing.
//!
//! | module | contents |
//! |---|---|
//! | [`problems`] | quantities that cases ask for, with their settings |
//! | [`prediction`] | from raw moments to channels; distributions of counts; the best σ̂ |
//! | [`collisions`] | events at a collision: rules for product estimators and for particles |
//! | [`light`] | techniques that find a light, and the weights of their samples |
//! | [`colours`] | draws that score several channels: heroes, event probabilities, bounds |
//! | [`ray`] | the [`Mesh`]; transmittances, curves and free flights |
//! | [`rod`] | two-stream equations by collocation; rods that are lit, spectral, bidirectional |
//! | [`slab`] | adding and doubling; slabs that are lit, spectral, chromatic |
//! | [`single`] | one scattering of a point light, by all combinations of techniques |
//! | [`space`] | balls by Peierls' equation, infinite media, furnaces; bounds on variances |
//!
//! A folder of a geometry has its solver and its predictions. The other folders are shared by all geometries.
//! Nothing here draws a random number. All integrals of a medium along a ray run over one [`Mesh`], on which σ_t is
//! looked up once and shared by every σ̂, control and rule.

pub mod collisions;
pub mod colours;
pub mod light;
pub mod memo;
pub mod parallel;
pub mod prediction;
pub mod problems;
pub mod ray;
pub mod rod;
pub mod single;
pub mod slab;
pub mod space;

pub use collisions::kernel::Kernel;
pub use collisions::particle::ParticleRule;
pub use prediction::count::CountDistribution;
pub use prediction::moments::Moments;
pub use prediction::{Channel, Distribution, Increment, Prediction, Tails};
pub use ray::mesh::Mesh;
