//! Comparable estimators: all lookups are counted, best σ̂ are optima or shares of limits, plots show each estimator.

mod costs;
mod legends;
mod optima;
