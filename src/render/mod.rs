//! Pictures: estimators of one problem for every pixel, side by side at an equal number of lookups.
//!
//! A picture file is read into a [`Picture`] and rendered into a [`PictureRecord`], which is all that
//! reports see. Every pixel of every estimator has random numbers of its own, found by name and
//! number, so that pictures do not depend on the number of threads.

pub mod budget;
pub mod gallery;
pub mod picture;
pub mod pixel;
pub mod record;
pub mod reference;
pub mod scene;
pub mod subject;
pub mod view;

pub use picture::Picture;
pub use record::PictureRecord;

/// The manual of picture files.
pub const CATALOGUE: media::catalogue::PageList =
    media::catalogue::PageList { name: "picture files", pages: &[media::page!(picture)] };
