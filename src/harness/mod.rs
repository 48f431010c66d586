//! Case → plan → draws → verdicts → record. Floor 5.
//!
//! The only place where names become types: a case file is read into a [`Case`], a [`Plan`] prepares
//! its experiments and shares out the error rate, [`run::draw`] draws them, and [`verdict`] turns what
//! was drawn into a [`Record`], which is all that reports see.

pub mod addresses;
pub mod baseline;
pub mod case;
pub mod checks;
mod computable;
pub mod counted;
pub mod curves;
pub mod draw;
pub mod filter;
pub mod findings;
pub mod mutation;
pub mod normality;
pub mod options;
pub mod plan;
pub mod record;
pub mod reuse;
pub mod run;
pub mod scenario;
mod shown;
pub mod source;
pub mod suite;
pub mod summary;
pub mod sweep;
mod theory_rows;
pub mod verdict;
pub(crate) mod written;

use crate::catalogue::Catalogue;

/// The manual of case files.
pub const CATALOGUE: Catalogue =
    Catalogue { name: "case files", pages: &[crate::page!(case), crate::page!(sweep)] };

pub use case::Case;
pub use filter::Filter;
pub use options::{Amount, Options};
pub use plan::Plan;
pub use record::Record;
pub use source::{CaseError, Source};
