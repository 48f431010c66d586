//! Pictures, draws in tables of text and draws in raw numbers.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::{Item, NumberSummary};
use crate::judge::files::{Column, DrawSource, NumberFormat};
use media::files::exr::{self, ExrPart};
use media::files::{Pixels, Unreadable, pfm, wrong};

const PIXELS: &str = "pixels (columns, rows)";

/// Returns the parts of an `OpenEXR` file.
pub fn exr(bytes: Vec<u8>) -> Result<Vec<Item>, Unreadable> {
    let whole = "write it by OpenEXR, to its end";
    let parts = exr::parts(&bytes).or_else(|cause| wrong(cause, whole))?;
    let mut items: Vec<Item> = parts.iter().map(|part| item(part, parts.len() > 1)).collect();
    let is_simple = parts.iter().all(|part| !part.is_deep() && part.is_read);
    let first = items.first_mut();
    match (exr::read(bytes), first) {
        (Ok(pixels), Some(first)) => {
            NumberSummary::of(pixels.values).tell(first);
            let read = if pixels.channels == 3 { "R, G and B" } else { "Y, or the first channel" };
            first.details.push(format!("values are those of {read}"));
        }
        (Err(cause), _) if is_simple => return wrong(cause, whole),
        (Err(cause), Some(first)) => first.notes.push(format!("not read: {cause}")),
        _ => {}
    }
    for other in items.iter_mut().skip(1) {
        other.notes.push("not read: the first part is".to_owned());
    }
    Ok(items)
}

fn item(part: &ExrPart, is_one_of_several: bool) -> Item {
    let kinds: Vec<&str> = part.channels.iter().map(|channel| channel.kind).collect();
    let mut different = kinds.clone();
    different.dedup();
    let name = |channel: &exr::ExrChannel| match (different.len(), channel.sampling) {
        (1, [1, 1]) => channel.name.clone(),
        (_, [1, 1]) => format!("{} {}", channel.name, channel.kind),
        (_, [x, y]) => format!("{} {} (one of {x} × {y} pixels)", channel.name, channel.kind),
    };
    let names: Vec<String> = part.channels.iter().map(name).collect();
    let [columns, rows] = part.data.size();
    let mut details = vec![
        format!("channels {}", names.join(", ")),
        format!("{}, compression {}", part.kind, part.compression),
    ];
    if part.data == part.display {
        details.push(format!("data and display window {}", part.data));
    } else {
        details.push(format!("data window {}, display window {}", part.data, part.display));
    }
    Item {
        format: if is_one_of_several { "OpenEXR, several parts" } else { "OpenEXR" }.to_owned(),
        name: part.name.clone(),
        kind: if different.len() == 1 { different[0].to_owned() } else { "mixed".to_owned() },
        size: vec![columns as u64, rows as u64],
        counts: PIXELS,
        channels: Some(part.channels.len() as u64),
        details,
        ..Item::default()
    }
}

/// Returns the picture of a PFM file.
pub fn pfm(bytes: &[u8]) -> Result<Vec<Item>, Unreadable> {
    let cure = "write Pf or PF, columns, rows, -1 and all values as float32";
    let pixels = pfm::read(bytes).or_else(|cause| wrong(cause, cure))?;
    let Pixels { size: [columns, rows], channels, values, .. } = pixels;
    let mut item = Item {
        format: "portable float map".to_owned(),
        kind: "float32".to_owned(),
        size: vec![columns as u64, rows as u64],
        counts: PIXELS,
        channels: Some(channels as u64),
        ..Item::default()
    };
    NumberSummary::of(values).tell(&mut item);
    Ok(vec![item])
}

/// Maximum number of columns of a table.
const MAX_COLUMNS: usize = 64;
/// Number of draws that are read at a time.
const BLOCK: usize = 1 << 14;

/// Returns the columns of a file of draws, a table of text or raw numbers.
pub fn draws(path: &Path) -> anyhow::Result<Vec<Item>> {
    let file = path.display().to_string();
    let Some(NumberFormat::Csv { lookups, .. }) = NumberFormat::of_path(path) else {
        let format = NumberFormat::of_path(path).unwrap_or(NumberFormat::Raw);
        let kind =
            format!("float{}, little-endian", if format == NumberFormat::Raw { 64 } else { 32 });
        let item = column(DrawSource::open(path, format)?, &file)?;
        return Ok(vec![Item { format: "raw draws".to_owned(), kind, ..item }]);
    };
    let names = names(path)?;
    let mut items = Vec::new();
    for (place, name) in names.into_iter().enumerate().take(MAX_COLUMNS) {
        let format =
            NumberFormat::Csv { column: Some(Column::Index(place)), lookups: lookups.clone() };
        let item = column(DrawSource::open(path, format)?, &file)?;
        let (format, kind) = ("table of draws".to_owned(), "text".to_owned());
        items.push(Item { format, name, kind, ..item });
    }
    Ok(items)
}

/// Returns the names of a table's columns, or their indices.
fn names(path: &Path) -> anyhow::Result<Vec<String>> {
    let mut lines = BufReader::new(File::open(path)?).lines();
    let first = lines.find(|line| {
        line.as_ref().map_or(true, |line| !line.trim().is_empty() && !line.starts_with('#'))
    });
    let Some(first) = first.transpose()? else {
        anyhow::bail!("no draws; write at least one number")
    };
    let words: Vec<&str> = first.split(',').map(str::trim).collect();
    let has_names = words.iter().any(|word| word.parse::<f64>().is_err());
    let name = |(place, word): (usize, &&str)| {
        if has_names { (*word).trim_matches('"').to_owned() } else { format!("column {place}") }
    };
    Ok(words.iter().enumerate().map(name).collect())
}

/// Reads all draws of a column.
fn column(mut draws: DrawSource, file: &str) -> anyhow::Result<Item> {
    let (mut spread, mut count, mut buffer) = (NumberSummary::default(), 0, Vec::new());
    while draws.read(&mut buffer, BLOCK)? > 0 {
        count += buffer.len() as u64;
        for &draw in &buffer {
            spread.add(draw, 1.0);
        }
    }
    let mut item =
        Item { file: file.to_owned(), size: vec![count], counts: "draws", ..Item::default() };
    spread.tell(&mut item);
    Ok(item)
}
