//! Rows and pages of a catalogue on stdout.

use std::fmt::Write;
use std::io::IsTerminal;

use super::Console;
use super::output::{self, RowFormat};
use crate::report::page;

/// Row of the catalogue.
#[derive(serde::Serialize)]
pub struct ListingRow {
    /// Part of the catalogue.
    pub part: String,
    /// Name.
    pub name: String,
    /// One sentence.
    pub summary: String,
}

/// Prints rows of a catalogue.
pub fn print_rows(rows: &[ListingRow], format: RowFormat, console: &Console) -> anyhow::Result<u8> {
    output::print(&match format {
        RowFormat::Table => table(rows, console),
        RowFormat::Csv => csv(rows)?,
        RowFormat::Json => serde_json::to_string_pretty(rows)? + "\n",
    })?;
    Ok(0)
}

/// Prints the pages of a name, each with its part of the catalogue and its text in Markdown: on a terminal without the signs of
/// Markdown and within its width, elsewhere as written.
pub fn print_pages(
    name: &str,
    pages: Vec<(String, String)>,
    console: &Console,
) -> anyhow::Result<u8> {
    let pen = output::pen(console);
    let is_shown = std::io::stdout().is_terminal() || pen.colour;
    let text = |(part, text): (String, String)| {
        if is_shown {
            page::rendered(&format!("# {name} ({part})\n\n{text}\n"), pen)
        } else {
            format!("{name} ({part})\n\n{text}\n")
        }
    };
    let texts: Vec<String> = pages.into_iter().map(text).collect();
    output::print(&texts.join("\n"))?;
    Ok(0)
}

fn table(rows: &[ListingRow], console: &Console) -> String {
    let colour = console.color.colours(std::io::stdout().is_terminal());
    let widest = rows.iter().map(|row| row.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    let mut part = "";
    for row in rows {
        if row.part != part {
            let gap = if part.is_empty() { "" } else { "\n" };
            let (bold, plain) = if colour { ("\x1b[1m", "\x1b[0m") } else { ("", "") };
            let _ = writeln!(text, "{gap}{bold}{}{plain}", row.part);
            part = &row.part;
        }
        let _ = writeln!(text, "  {:widest$}  {}", row.name, row.summary);
    }
    text
}

fn csv(rows: &[ListingRow]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}
