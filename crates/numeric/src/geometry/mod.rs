//! Points, rays and the bodies that bound a medium.

pub mod bounds;
pub mod exit;
pub mod frame;
mod grazing;
pub mod point;
pub mod ray;

pub use bounds::{Aabb, Bounds};
pub use point::Point;
pub use ray::Ray;
