//! Comparable estimators: all lookups counted, best σ̂ named for what they are, plots that show each estimator.

mod costs;
mod legends;
mod optima;
