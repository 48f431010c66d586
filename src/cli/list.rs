//! `trueflight list`: the catalogue, from the code's own documentation.

use std::fmt::Write;
use std::io::IsTerminal;

use clap::{Args, ValueEnum};

use super::Console;
use super::output::{self, Format};
use crate::catalogue::{Page, PageList};
use crate::harness::catalogue::{Catalogue, built_in};
use crate::harness::{self, checks, suite};
use crate::problems;
use crate::recipes::{controls, sampling};
use crate::render::{self, Picture, gallery};
use crate::{phase, report};

/// Arguments of `list`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// One part of the catalogue; without it, all of it
    #[arg(value_enum)]
    what: Option<What>,
    /// How the rows are printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// A part of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum What {
    Media,
    Phases,
    Sampling,
    Controls,
    Estimators,
    Problems,
    Checks,
    Reports,
    Files,
    Cases,
    Pictures,
}

/// One row: a part of the catalogue, a name and one sentence.
#[derive(serde::Serialize)]
struct Row {
    part: String,
    name: String,
    summary: String,
}

/// Every page with the name of its part; those of the program's own come last in theirs.
pub fn pages(catalogue: &Catalogue) -> Vec<(String, Page)> {
    let mut lists = built_in();
    let own = [("phases", phase::CATALOGUE), ("sampling", sampling::CATALOGUE)];
    let own = own.into_iter().chain([("controls", controls::CATALOGUE)]);
    lists.splice(1..1, own.map(|(part, list)| (part.to_owned(), list)));
    lists.extend([
        ("problems".to_owned(), problems::CATALOGUE),
        ("checks".to_owned(), checks::CATALOGUE),
        ("reports".to_owned(), report::CATALOGUE),
        ("files".to_owned(), harness::CATALOGUE),
        ("files".to_owned(), render::CATALOGUE),
    ]);
    let additions = catalogue.additions().all();
    let with_own = |(part, list): (String, PageList)| {
        let own = additions.iter().filter(|own| own.part == part).map(|own| own.page);
        let pages = list.pages.iter().copied().chain(own);
        pages.map(|page| (part.clone(), page)).collect::<Vec<_>>()
    };
    lists.into_iter().flat_map(with_own).collect()
}

/// Prints the names with one sentence each.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    let wanted = |part: &str| {
        let what = arguments.what.and_then(|what| what.to_possible_value());
        what.is_none_or(|what| part.split(' ').next() == Some(what.get_name()))
    };
    let wanted_pages = pages(catalogue).into_iter().filter(|(part, _)| wanted(part));
    let row = |(part, page): (String, Page)| {
        let (name, summary) = (page.name(), page.summary());
        Row { part, name, summary }
    };
    let mut rows: Vec<Row> = wanted_pages.map(row).collect();
    if wanted("cases") {
        for source in suite::suite() {
            let title = catalogue.read(&source).map(|case| case.title).unwrap_or_default();
            rows.push(Row { part: "cases".into(), name: source.name, summary: title });
        }
    }
    if wanted("pictures") {
        for source in gallery::gallery() {
            let title = Picture::read(&source, catalogue.additions())
                .map(|picture| picture.title)
                .unwrap_or_default();
            rows.push(Row { part: "pictures".into(), name: source.name, summary: title });
        }
    }
    output::print(&match arguments.format {
        Format::Table => table(&rows, console),
        Format::Csv => csv(&rows)?,
        Format::Json => serde_json::to_string_pretty(&rows)? + "\n",
    })?;
    Ok(0)
}

fn table(rows: &[Row], console: &Console) -> String {
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

fn csv(rows: &[Row]) -> anyhow::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}
