//! `trueflight list`: the catalogue, from the code's own documentation.

use std::fmt::Write;
use std::io::IsTerminal;

use clap::{Args, ValueEnum};
use trueflight::catalogue::{Catalogue, Page};
use trueflight::estimators::{self, Estimated};
use trueflight::harness::{self, case::Case, checks, suite};
use trueflight::problems::{self, MultipleScattering};
use trueflight::recipes::{controls, sampling};
use trueflight::render::{self, Picture, gallery};
use trueflight::{media, phase, report};

use super::Console;
use super::output::{self, Format};

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

/// Every catalogue of the library with the name of its part.
pub fn catalogues() -> Vec<(String, Catalogue)> {
    let mut all = vec![
        ("media".to_owned(), media::CATALOGUE),
        ("phases".to_owned(), phase::CATALOGUE),
        ("sampling".to_owned(), sampling::CATALOGUE),
        ("controls".to_owned(), controls::CATALOGUE),
    ];
    let of_problems = problems::CATALOGUE.pages.iter().zip(estimators::catalogues());
    all.extend(
        of_problems
            .map(|(problem, catalogue)| (format!("estimators of {}", problem.name()), catalogue)),
    );
    let of_pictures = <MultipleScattering as Estimated>::CATALOGUE;
    all.push(("estimators of pictures of multiple-scattering".to_owned(), of_pictures));
    all.extend([
        ("problems".to_owned(), problems::CATALOGUE),
        ("checks".to_owned(), checks::CATALOGUE),
        ("reports".to_owned(), report::CATALOGUE),
        ("files".to_owned(), harness::CATALOGUE),
        ("files".to_owned(), render::CATALOGUE),
    ]);
    all
}

/// Prints the names with one sentence each.
pub fn main(arguments: &Arguments, console: &Console) -> anyhow::Result<u8> {
    let wanted = |part: &str| {
        let what = arguments.what.and_then(|what| what.to_possible_value());
        what.is_none_or(|what| part.split(' ').next() == Some(what.get_name()))
    };
    let mut rows: Vec<Row> = catalogues()
        .into_iter()
        .filter(|(part, _)| wanted(part))
        .flat_map(|(part, catalogue)| {
            catalogue.pages.iter().map(move |page: &Page| Row {
                part: part.clone(),
                name: page.name(),
                summary: page.summary(),
            })
        })
        .collect();
    if wanted("cases") {
        for source in suite::suite() {
            let title = Case::read(&source).map(|case| case.title).unwrap_or_default();
            rows.push(Row { part: "cases".into(), name: source.name, summary: title });
        }
    }
    if wanted("pictures") {
        for source in gallery::gallery() {
            let title = Picture::read(&source).map(|picture| picture.title).unwrap_or_default();
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
