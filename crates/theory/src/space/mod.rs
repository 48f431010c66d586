//! Walks in space: bounds on what they bring, and the exact answers that there are.

pub mod content;
pub mod energy;
pub mod infinite;

pub use energy::Walks;
