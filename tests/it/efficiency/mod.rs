//! What makes estimators comparable: all their lookups, what their best σ̂ is, and plots that show each of them.

mod costs;
mod legends;
mod optima;
