//! Case → plan → draws → verdicts → record. Floor 5.
//!
//! The only place where names become types: a case file is read into a [`Case`], a [`Plan`] prepares
//! its experiments and shares out the error rate, [`run::draw`] draws them, and [`verdict`] turns what
//! was drawn into a [`Record`], which is all that reports see.
//!
//! A file imports only files before it in this list:
//!
//! ```text
//! words       shorthand  source  rewrite  sweep  names  filter  options  addresses  normality  suite  example
//! case        ready  estimator  problem  plot_data  course  scenario  case  catalogue
//! plan        checks  levels  plan  foreseen  mutation
//! draws       progress  draw  drawn  cache  share  workers  frames  blocks  store  run
//! record      comparison  record
//! verdict     qualify  evaluate  theory_rows  measured  repeat  anatomy  curves  summary  verdict
//! ```

pub mod addresses;
mod anatomy;
pub mod blocks;
pub mod cache;
pub mod case;
pub mod catalogue;
pub mod checks;
pub mod comparison;
mod course;
pub mod curves;
pub mod draw;
pub mod drawn;
pub mod estimator;
pub mod evaluate;
pub mod example;
pub mod filter;
pub mod foreseen;
mod frames;
pub mod levels;
mod measured;
pub mod mutation;
pub mod names;
pub mod normality;
pub mod options;
pub mod plan;
mod plot_data;
pub mod problem;
pub mod progress;
pub mod qualify;
pub mod ready;
pub mod record;
mod repeat;
pub mod rewrite;
pub mod run;
pub mod scenario;
pub mod share;
mod shorthand;
pub mod source;
pub mod store;
pub mod suite;
pub mod summary;
pub mod sweep;
mod theory_rows;
pub mod verdict;
pub mod workers;

use media::catalogue::PageList;

/// The manual of case files.
pub const CATALOGUE: PageList =
    PageList { name: "case files", pages: &[media::page!(case), media::page!(sweep)] };

pub use case::Case;
pub use catalogue::Catalogue;
pub use filter::Filter;
pub use options::{Amount, Options};
pub use plan::Plan;
pub use record::Record;
pub use source::{CaseError, Source};
