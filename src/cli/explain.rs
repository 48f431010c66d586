//! `trueflight explain`: the manual page of anything in the catalogue, with a case to copy.

use std::io::IsTerminal;

use clap::{Args, ValueEnum};

use super::Console;
use super::list::{self, What, pages};
use super::output;
use crate::case::Catalogue;
use crate::case::example;
use crate::case::suite;
use crate::render::gallery;
use crate::report::console::page;
use ::media::catalogue::suggestion;

/// Arguments of `explain`.
#[derive(Debug, Args)]
pub struct Arguments {
    /// A name that `trueflight list` shows, such as ratio, eq21 or pilot, or a part of the list, such as media
    #[arg(required = true)]
    name: Vec<String>,
}

/// Prints every page of a name, or the list of a part: for a terminal without the signs of Markdown and as wide as
/// it is, else as it is written.
pub fn main(arguments: &Arguments, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    // `free flight`, `free_flight` and `Free-Flight` are `free-flight`.
    let written = arguments.name.join("-");
    let name = &written.to_lowercase().replace('_', "-");
    let found = explained(name, catalogue);
    if found.is_empty() {
        let Ok(what) = What::from_str(name, true) else {
            return Err(unknown(&written, name, catalogue));
        };
        list::print(what, catalogue, console)?;
        return Ok(0);
    }
    let pen = output::pen(console);
    let is_shown = std::io::stdout().is_terminal() || pen.colour;
    let text = |(part, text): (String, String)| {
        if is_shown {
            page::rendered(&format!("# {name} ({part})\n\n{text}\n"), pen)
        } else {
            format!("{name} ({part})\n\n{text}\n")
        }
    };
    let texts: Vec<String> = found.into_iter().map(text).collect();
    output::print(&texts.join("\n"))?;
    Ok(0)
}

/// The pages of a name: for each the part of the catalogue, and the text in Markdown with a case to copy.
fn explained(name: &str, catalogue: &Catalogue) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (part, page) in pages(catalogue).into_iter().filter(|(_, page)| page.name() == name) {
        let mut text = page.text().trim_end().to_owned();
        if let Some(case) = example::of(&part, name) {
            text += "\n\nA case to copy; `trueflight run case.toml` draws it:\n\n";
            text += &fenced(&case);
        }
        found.push((part, text));
    }
    let files = [("cases", suite::find(name)), ("pictures", gallery::find(name))];
    for (part, source) in files {
        found.extend(source.map(|source| (part.to_owned(), fenced(&source.text))));
    }
    found
}

fn fenced(toml: &str) -> String {
    format!("```toml\n{}\n```", toml.trim_end())
}

/// The error about a name that nothing has, with what was probably meant.
fn unknown(written: &str, name: &str, catalogue: &Catalogue) -> anyhow::Error {
    let sources = suite::suite().into_iter().chain(gallery::gallery()).map(|source| source.name);
    let kinds = What::value_variants().iter().map(|what| what.name());
    let pages = pages(catalogue).into_iter().map(|(_, page)| page.name());
    let mut names: Vec<String> = pages.chain(kinds).chain(sources).collect();
    names.sort();
    names.dedup();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let all = "`trueflight list` shows the names";
    let mut hint = suggestion(name, &names, all);
    let near: Vec<&str> = names.into_iter().filter(|known| known.contains(name)).collect();
    if hint == all && !near.is_empty() {
        hint = format!("{all}: {}", near.join(", "));
    }
    anyhow::anyhow!("nothing is called \"{written}\"; {hint}")
}
