//! `trueflight report`: the page of a stored record.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;

use super::output::{self, Errors};
use super::{Console, journal};
use crate::report::{html, record_json};

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder with the record.json of a run; the page is written beside it
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Reads the record, writes the page.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let folder = &arguments.folder;
    let path = folder.join("record.json");
    let text = std::fs::read(&path).with_context(|| {
        format!(
            "cannot read {}; give the folder that `trueflight run --out DIR` wrote",
            path.display()
        )
    })?;
    let record = record_json::read(&text).with_context(|| {
        format!("{}: make it anew with `trueflight run --out DIR`", path.display())
    })?;
    if journal::blocks(folder).exists() {
        let cure = journal::resume(folder);
        output::warn(&format!(
            "the run in {} is not finished: the page is of what was judged; {cure} goes on",
            folder.display()
        ));
    }
    let mut errors = Errors::default();
    let written = errors.write(html::render(&record), folder);
    if written.is_some_and(|files| files > 0) && !console.quiet {
        errors.keep(output::print(&format!("{}\n", folder.join("report.html").display())));
    }
    Ok(errors.close(0))
}
