//! Media and cases written as text, as users write them.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use crate::case::Case;
use crate::case::Source;
use media::catalogue::Settings;
use media::reader::read_volume;
use media::{Body, Medium, Volume};

fn source(text: &str) -> Source {
    Source { name: "stress".into(), path: PathBuf::from("stress.toml"), text: text.to_owned() }
}

/// The field along a line or ray; `None` where the text is refused.
pub(super) fn medium(text: &str) -> Option<Medium> {
    let faults = RefCell::default();
    let root = source(text).parse(&faults);
    let body = Body::read(&Settings::new(&root, Path::new("."), &faults));
    body.filter(|_| faults.borrow().is_empty()).map(|body| body.medium())
}

/// A case; `None` where it is refused.
pub(super) fn case(text: &str) -> Option<Case> {
    Case::read(&source(text)).ok()
}

/// A field in space; `None` where the text is refused.
pub(super) fn volume(text: &str) -> Option<std::sync::Arc<Volume>> {
    let faults = RefCell::default();
    let root = source(text).parse(&faults);
    let volume = read_volume(&Settings::new(&root, Path::new("."), &faults));
    volume.map(|(_, volume)| volume).filter(|_| faults.borrow().is_empty())
}

/// A homogeneous medium from 0 on.
pub(super) fn homogeneous(extinction: f64, length: f64) -> Option<Medium> {
    medium(&format!("medium.constant.extinction = {extinction:e}\nspan = [0, {length:e}]"))
}

/// As a place in a table.
pub(super) fn one_line(text: &str) -> String {
    text.replace('\n', ", ")
}

/// Layers from 0 on, as text.
pub(super) fn layers(breaks: &[f64], values: &[f64]) -> String {
    let end = breaks[breaks.len() - 1];
    format!(
        "medium.piecewise-constant = {{ breaks = {breaks:?}, values = {values:?} }}\n\
         span = [0, {end:e}]"
    )
}
