//! `trueflight inspect`: what files of volumes, images and draws hold.

mod arrays;
mod draws;
mod images;
mod item;
mod volumes;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use self::item::Item;
use super::output::{self, Errors, Format};
use super::{Console, USAGE};
use crate::judge::files as draws_files;
use media::files::Fault;
use media::grid_file;

/// Arguments of `inspect`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Volumes (vol, npy, vdb, nvdb, pbrt), images (exr, pfm, npy) and draws (npy, csv, txt, f64, bin, raw)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Format of the grids, images and columns that are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// Prints what each file holds; a file that cannot be read is an error, and the others are shown all the same.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let (mut items, mut errors) = (Vec::new(), Errors::default());
    for path in &arguments.files {
        let found = inspected(path).with_context(|| format!("cannot inspect {}", path.display()));
        items.extend(errors.keep(found));
    }
    let text = match arguments.format {
        Format::Table if console.quiet => String::new(),
        Format::Table => table(&items),
        Format::Csv => item::csv(&items)?,
        Format::Json => serde_json::to_string_pretty(&items)? + "\n",
    };
    output::print(&text)?;
    Ok(if errors.is_empty() { 0 } else { errors.close(USAGE) })
}

/// The grids, images or columns of a file, by its ending.
fn inspected(path: &Path) -> anyhow::Result<Vec<Item>> {
    if std::fs::metadata(path)?.is_dir() {
        bail!("it is a folder; give the files in it");
    }
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let ending = ending.to_ascii_lowercase();
    let items = match ending.as_str() {
        "npy" => arrays::items(&std::fs::read(path)?),
        "exr" => images::exr(std::fs::read(path)?),
        "pfm" => images::pfm(&std::fs::read(path)?),
        _ => match grid_file::Format::of(path) {
            Some(format) => volumes::items(format, &std::fs::read(path)?),
            None if draws_files::Format::of_path(path).is_some() => return draws::items(path),
            None => bail!(
                "its ending is none that is read: vol, npy, vdb, nvdb, pbrt, exr, pfm, csv, txt, f64, bin, raw; rename \
                 or convert it"
            ),
        },
    };
    let items = items.map_err(|Fault { message, help }| anyhow::anyhow!("{message}; {help}"))?;
    let file = path.display().to_string();
    Ok(items.into_iter().map(|item| Item { file: file.clone(), ..item }).collect())
}

/// A block for each file, a paragraph for each of its items.
fn table(items: &[Item]) -> String {
    let mut text = String::new();
    for (place, item) in items.iter().enumerate() {
        if place == 0 || items[place - 1].file != item.file {
            let gap = if place == 0 { "" } else { "\n" };
            let _ = writeln!(text, "{gap}{}: {}", item.file, item.format);
        }
        text.push_str(&item.paragraph());
    }
    text
}
