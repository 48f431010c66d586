//! One ray: the mesh of its integrals; transmittances, curves and free flights.

pub mod atoms;
pub mod curve;
pub mod free_flight;
pub mod lookups;
pub mod marching;
pub mod mesh;
pub mod product;
pub mod spectral;
pub mod survival;
pub mod volterra;
