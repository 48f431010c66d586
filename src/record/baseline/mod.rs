//! Stored runs: what a later run is compared with. Floor 6.
//!
//! A baseline is a file `NAME.json` with one entry per experiment and channel. A later run is compared
//! with it (`compare`): has the variance, the number of lookups or the time grown? And on unchanged
//! code and cases the e-values of runs with different seeds multiply: a bias too small for one night
//! is found over many.
//!
//! A baseline that is missing, broken or of another form is an error; a file is written under a
//! temporary name and renamed.
//!
//! From bottom to top: [`file`](mod@file), [`stored`], [`scope`], [`compare`](mod@compare).

pub mod compare;
pub mod file;
pub mod scope;
pub mod stored;

pub use crate::record::comparison::{Change, Comparison, Drift, LeftOut, Quantity, Rules, Sequel};
pub use compare::compare;
pub use file::BaselineError;
pub use stored::{Baseline, Entry, Evidence, fingerprint};
