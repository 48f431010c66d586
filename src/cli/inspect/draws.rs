//! Draws in tables of text and in raw numbers.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::item::{Item, Spread};
use crate::judge::files::{Column, Draws, Format};

/// Maximum number of columns of a table.
const MOST: usize = 64;
/// Draws that are read at a time.
const BLOCK: usize = 1 << 14;

/// The columns of a file.
pub fn items(path: &Path) -> anyhow::Result<Vec<Item>> {
    let file = path.display().to_string();
    let Some(Format::Csv { lookups, .. }) = Format::of_path(path) else {
        let format = Format::of_path(path).unwrap_or(Format::Raw);
        let item = column(Draws::open(path, format)?, &file)?;
        let kind = "float64, little-endian".to_owned();
        return Ok(vec![Item { format: "raw draws".to_owned(), kind, ..item }]);
    };
    let names = names(path)?;
    let mut items = Vec::new();
    for (place, name) in names.into_iter().enumerate().take(MOST) {
        let format = Format::Csv { column: Some(Column::Index(place)), lookups: lookups.clone() };
        let item = column(Draws::open(path, format)?, &file)?;
        let (format, kind) = ("table of draws".to_owned(), "text".to_owned());
        items.push(Item { format, name, kind, ..item });
    }
    Ok(items)
}

/// The names of a table's columns, or their places.
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

/// Reads draws through.
fn column(mut draws: Draws, file: &str) -> anyhow::Result<Item> {
    let (mut spread, mut count, mut buffer) = (Spread::default(), 0, Vec::new());
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
