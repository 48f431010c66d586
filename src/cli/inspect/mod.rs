//! `trueflight inspect`: the content of files of volumes, images and draws.

mod images;
mod volumes;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;

use super::output::{self, Errors};
use super::{Console, USAGE};
use crate::json;
use media::files::Unreadable;
use media::formats::Format;
use numeric::digits::{count, short};

/// Arguments of `inspect`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Volumes (vol, npy, vdb, nvdb, pbrt), images (exr, pfm, npy) and draws (npy, csv, txt, f64, f32, bin, raw)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Format of the grids, images and columns that are printed
    #[arg(long, value_enum, default_value_t)]
    format: output::RowFormat,
}

/// Prints the content of each file. A file that cannot be read is an error, and the others are still printed.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let (mut items, mut errors) = (Vec::new(), Errors::default());
    for path in &arguments.files {
        let result = inspected(path).with_context(|| format!("cannot inspect {}", path.display()));
        items.extend(errors.keep(result));
    }
    let text = match arguments.format {
        output::RowFormat::Table if console.quiet => String::new(),
        output::RowFormat::Table => table(&items),
        output::RowFormat::Csv => csv(&items)?,
        output::RowFormat::Json => json::pretty(&items)? + "\n",
    };
    output::print(&text)?;
    Ok(if errors.is_empty() { 0 } else { errors.close(USAGE) })
}

/// Returns the grids, images or columns of a file, by its ending.
fn inspected(path: &Path) -> anyhow::Result<Vec<Item>> {
    if std::fs::metadata(path)?.is_dir() {
        bail!("it is a folder; give the files in it");
    }
    let Some(format) = Format::of(path) else {
        let all = Format::list(|_| true);
        bail!("its ending is none that is read: {all}; rename or convert it");
    };
    let bytes = || std::fs::read(path);
    let items = match format {
        Format::Vol => volumes::of_vol(&bytes()?),
        Format::Npy => volumes::array(&bytes()?),
        Format::Vdb => volumes::of_vdb(&bytes()?),
        Format::Nvdb => volumes::of_nvdb(&bytes()?),
        Format::Pbrt => volumes::of_pbrt(&bytes()?),
        Format::Exr => images::exr(bytes()?),
        Format::Pfm => images::pfm(&bytes()?),
        Format::Table | Format::Doubles | Format::Singles => return images::draws(path),
    };
    let items =
        items.map_err(|Unreadable { message, help }| anyhow::anyhow!("{message}; {help}"))?;
    let file = path.display().to_string();
    Ok(items.into_iter().map(|item| Item { file: file.clone(), ..item }).collect())
}

/// Returns the table for people: a block for each file, a paragraph for each of its items.
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

/// Part of a file. Facts that are unknown or do not apply are `None`, or empty.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize)]
pub struct Item {
    /// The file.
    pub file: String,
    /// Format of the file.
    pub format: String,
    /// Name of the grid, the medium, the part or the column.
    pub name: String,
    /// Type of its numbers.
    pub kind: String,
    /// Class of a grid, such as `fog volume`.
    pub class: String,
    /// Lengths of its axes.
    pub size: Vec<u64>,
    /// Meaning of the numbers of `size`, such as `voxels (x, y, z)`.
    pub counts: &'static str,
    /// Number of values of a voxel or a pixel.
    pub channels: Option<u64>,
    /// Lowest corner of its box in the world.
    pub low: Option<[f64; 3]>,
    /// Highest corner.
    pub high: Option<[f64; 3]>,
    /// Edges of a voxel in the world.
    pub voxel: Option<[f64; 3]>,
    /// Smallest finite value.
    pub least: Option<f64>,
    /// Largest finite value.
    pub most: Option<f64>,
    /// Mean of the finite values.
    pub mean: Option<f64>,
    /// Value outside the voxels that are stored.
    pub background: Option<f64>,
    /// Number of active voxels.
    pub active: Option<u64>,
    /// Further facts of the file: compression, windows, channels, version.
    pub details: Vec<String>,
    /// Notes on doubtful content, such as why a grid cannot be a medium.
    pub notes: Vec<String>,
}

/// Minimum, maximum and mean of numbers, and the number of those that are not finite.
#[derive(Debug, Clone, Copy, Default)]
pub struct NumberSummary {
    ends: Option<[f64; 2]>,
    sum: f64,
    finite: f64,
    /// Number of values that are not finite.
    pub wrong: f64,
    /// Number of negative values.
    pub negative: f64,
}

impl NumberSummary {
    /// Adds a value that occurs a number of times.
    pub fn add(&mut self, value: f64, times: f64) {
        if !value.is_finite() {
            self.wrong += times;
            return;
        }
        let [low, high] = self.ends.unwrap_or([value; 2]);
        self.ends = Some([low.min(value), high.max(value)]);
        self.sum += value * times;
        self.finite += times;
        if value < 0.0 {
            self.negative += times;
        }
    }

    /// Returns the spread of a list.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut spread = Self::default();
        values.into_iter().for_each(|value| spread.add(value, 1.0));
        spread
    }

    /// Fills in an item.
    pub fn tell(&self, item: &mut Item) {
        if let Some([least, most]) = self.ends {
            (item.least, item.most) = (Some(least), Some(most));
            item.mean = Some(self.sum / self.finite);
        }
        if self.wrong > 0.0 {
            item.notes.push(format!("{} values are NaN or infinite", self.wrong));
        }
    }
}

fn point(point: [f64; 3]) -> String {
    format!("[{}]", point.map(|x| short(x, 6)).join(", "))
}

impl Item {
    /// Returns the item as a few lines.
    pub fn paragraph(&self) -> String {
        let kind = [self.kind.as_str(), self.class.as_str()];
        let kind = kind.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(", ");
        let name = if self.name.is_empty() { "" } else { &format!("{}  ", self.name) };
        let mut text = format!("  {name}{kind}\n");
        let mut line = |parts: &[Option<String>]| {
            let parts: Vec<&str> = parts.iter().flatten().map(String::as_str).collect();
            if !parts.is_empty() {
                let _ = writeln!(text, "    {}", parts.join(", "));
            }
        };
        let sizes: Vec<String> = self.size.iter().map(u64::to_string).collect();
        line(&[
            (!sizes.is_empty()).then(|| format!("{} {}", sizes.join(" × "), self.counts)),
            self.channels.filter(|&n| n != 1).map(|n| format!("{n} channels")),
            self.active.map(|n| format!("{} active", count(n))),
        ]);
        let corners = self.low.zip(self.high);
        line(&[
            corners.map(|(low, high)| format!("box {} to {}", point(low), point(high))),
            self.voxel.map(|edges| format!("voxel {}", edges.map(|x| short(x, 6)).join(" × "))),
        ]);
        let range = self.least.zip(self.most);
        line(&[
            range.map(|(least, most)| format!("values {} to {}", short(least, 6), short(most, 6))),
            self.mean.map(|mean| format!("mean {}", short(mean, 6))),
            self.background.map(|x| format!("background {}", short(x, 6))),
        ]);
        self.details.iter().for_each(|detail| line(&[Some(detail.clone())]));
        self.notes.iter().for_each(|note| line(&[Some(format!("note {note}"))]));
        text
    }
}

/// Returns the items as a table of text: lists are in one field each.
pub fn csv(items: &[Item]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([
        "file",
        "format",
        "name",
        "kind",
        "class",
        "size",
        "counts",
        "channels",
        "low",
        "high",
        "voxel",
        "least",
        "most",
        "mean",
        "background",
        "active",
        "details",
        "notes",
    ])?;
    let number = |x: Option<f64>| x.map(|x| x.to_string()).unwrap_or_default();
    let triple =
        |x: Option<[f64; 3]>| x.map(|x| x.map(|x| x.to_string()).join(" ")).unwrap_or_default();
    let whole = |n: Option<u64>| n.map(|n| n.to_string()).unwrap_or_default();
    for item in items {
        let size: Vec<String> = item.size.iter().map(u64::to_string).collect();
        writer.write_record([
            item.file.clone(),
            item.format.clone(),
            item.name.clone(),
            item.kind.clone(),
            item.class.clone(),
            size.join(" "),
            item.counts.to_owned(),
            whole(item.channels),
            triple(item.low),
            triple(item.high),
            triple(item.voxel),
            number(item.least),
            number(item.most),
            number(item.mean),
            number(item.background),
            whole(item.active),
            item.details.join("; "),
            item.notes.join("; "),
        ])?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}
