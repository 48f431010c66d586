//! `trueflight explain`: the manual page of anything in the catalogue.

use clap::Args;

use super::Console;
use super::list::pages;
use super::output;
use crate::harness::{Catalogue, suite};
use crate::render::gallery;

/// Arguments of `explain`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A name that `trueflight list` shows, such as ratio, eq21 or pilot
    name: String,
}

/// Prints every page of that name; `console` has no say in it.
pub fn main(
    arguments: &Arguments,
    catalogue: &Catalogue,
    _console: &Console,
) -> anyhow::Result<u8> {
    let name = &arguments.name;
    let mut found = Vec::new();
    let mut names = Vec::new();
    for (part, page) in pages(catalogue) {
        if page.name() == *name {
            found.push(format!("{name} ({part})\n\n{}\n", page.text().trim_end()));
        }
        names.push(page.name());
    }
    if let Some(source) = suite::find(name) {
        found.push(format!("{name} (cases)\n\n{}\n", source.text.trim_end()));
    }
    if let Some(source) = gallery::find(name) {
        found.push(format!("{name} (pictures)\n\n{}\n", source.text.trim_end()));
    }
    if found.is_empty() {
        let sources = suite::suite().into_iter().chain(gallery::gallery());
        names.extend(sources.map(|source| source.name));
        let near = names.iter().filter(|known| known.contains(name.as_str()));
        let near: Vec<&str> = near.map(String::as_str).collect();
        let hint = if near.is_empty() { String::new() } else { format!(": {}", near.join(", ")) };
        anyhow::bail!("nothing is called \"{name}\"; `trueflight list` shows the names{hint}");
    }
    output::print(&found.join("\n"))?;
    Ok(0)
}
