//! `trueflight list` and `trueflight explain`: the catalogue, from the code's own documentation.

use std::ffi::OsStr;

use clap::builder::{EnumValueParser, PossibleValue, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Args, ValueEnum};

use super::Console;
use super::help::Names;
use super::listing::{ListingRow, print_pages, print_rows};
use super::output::RowFormat;
use crate::case::catalogue::{Catalogue, built_in};
use crate::case::suite;
use crate::render::{self, Picture};
use crate::{advise, phase, report};
use estimators::recipes::{controls, sampling};
use media::catalogue::{Page, suggestion};
use theory::problems::{self, MultipleScattering, Named};

/// Arguments of `list`.
#[derive(Debug, Args)]
pub struct List {
    /// One part of the catalogue; without it, all of it
    #[arg(value_parser = CataloguePart)]
    what: Option<What>,
    /// Form of the rows on stdout
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
}

/// A part of the catalogue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum What {
    #[value(alias = "medium")]
    Media,
    #[value(aliases = ["phase", "phase-function", "phase-functions"])]
    Phases,
    Sampling,
    #[value(alias = "control")]
    Controls,
    #[value(alias = "estimator")]
    Estimators,
    #[value(alias = "problem")]
    Problems,
    #[value(alias = "check")]
    Checks,
    #[value(alias = "report")]
    Reports,
    #[value(alias = "file")]
    Files,
    #[value(alias = "case")]
    Cases,
    #[value(alias = "picture")]
    Pictures,
}

impl What {
    /// Returns the name of the part: the first word of the first column of its rows.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}

/// Reads a part of the catalogue. The error about a name in the catalogue says which command shows its page.
#[derive(Debug, Clone)]
struct CataloguePart;

impl TypedValueParser for CataloguePart {
    type Value = What;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &OsStr,
    ) -> Result<What, clap::Error> {
        let result = EnumValueParser::<What>::new().parse_ref(command, argument, value);
        result.map_err(|error| {
            let name = value.to_string_lossy();
            let mut known = pages(&Catalogue::builtin()).into_iter();
            let Some((part, _)) = known.find(|(_, page)| page.name() == name) else { return error };
            let text = format!(
                "`{name}` is a page of the part {part}; `trueflight explain {name}` shows it\n"
            );
            command.clone().error(ErrorKind::InvalidValue, text)
        })
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(What::value_variants().iter().filter_map(ValueEnum::to_possible_value)))
    }
}

/// Returns every page with the name of its part; pages that the program adds come last in theirs.
pub fn pages(catalogue: &Catalogue) -> Vec<(String, Page)> {
    let mut lists = built_in();
    let named = |(part, pages): (&str, &'static [Page])| (part.to_owned(), pages);
    let recipes = [
        ("phases", phase::CATALOGUE.pages),
        ("sampling", sampling::CATALOGUE.pages),
        ("controls", controls::CATALOGUE.pages),
    ];
    lists.splice(1..1, recipes.map(named));
    let others = [
        ("problems", problems::CATALOGUE),
        ("checks", checks::CATALOGUE.pages),
        ("reports", report::run::CATALOGUE.pages),
        ("reports", report::run::OPTIONAL),
        ("files", crate::case::CATALOGUE),
        ("files", render::CATALOGUE),
        ("files", advise::CATALOGUE),
    ];
    lists.extend(others.map(named));
    let own_pages = catalogue.own_pages().all();
    let with_own = |(part, pages): (String, &'static [Page])| {
        let own = own_pages.iter().filter(|own| own.part == part).map(|own| own.page);
        let pages = pages.iter().copied().chain(own);
        pages.map(|page| (part.clone(), page)).collect::<Vec<_>>()
    };
    lists.into_iter().flat_map(with_own).collect()
}

/// Prints the names with one sentence each.
pub fn list(arguments: &List, catalogue: &Catalogue, console: &Console) -> anyhow::Result<u8> {
    print_rows(&rows(arguments.what, catalogue), arguments.format, console)
}

/// Returns the rows of one part of the catalogue, or of all of it.
fn rows(what: Option<What>, catalogue: &Catalogue) -> Vec<ListingRow> {
    let what = what.map(What::name);
    let expected =
        |part: &str| what.as_deref().is_none_or(|what| part.split(' ').next() == Some(what));
    let wanted_pages = pages(catalogue).into_iter().filter(|(part, _)| expected(part));
    let row = |(part, page): (String, Page)| {
        let (name, summary) = (page.name(), page.summary());
        ListingRow { part, name, summary }
    };
    let mut rows: Vec<ListingRow> = wanted_pages.map(row).collect();
    if expected("cases") {
        for source in suite::suite() {
            let title = catalogue.read(&source).map(|case| case.title).unwrap_or_default();
            rows.push(ListingRow { part: "cases".into(), name: source.name, summary: title });
        }
    }
    if expected("pictures") {
        for source in render::gallery() {
            let title = Picture::read(&source, catalogue.own_pages())
                .map(|picture| picture.title)
                .unwrap_or_default();
            rows.push(ListingRow { part: "pictures".into(), name: source.name, summary: title });
        }
    }
    rows
}

/// Arguments of `explain`.
#[derive(Debug, Args)]
pub struct Explain {
    /// A name that `trueflight list` shows, such as ratio, eq21 or pilot, or a part of the list, such as media
    #[arg(required = true, value_parser = Names::Pages, hide_possible_values = true)]
    name: Vec<String>,
}

/// Prints every page of a name, or the list of a part.
pub fn explain(
    arguments: &Explain,
    catalogue: &Catalogue,
    console: &Console,
) -> anyhow::Result<u8> {
    // `free flight`, `free_flight` and `Free-Flight` are `free-flight`.
    let written = arguments.name.join("-");
    let name = &written.to_lowercase().replace('_', "-");
    let result = explained(name, catalogue);
    if result.is_empty() {
        let Ok(what) = What::from_str(name, true) else {
            return Err(unknown(&written, name, catalogue));
        };
        return print_rows(&rows(Some(what), catalogue), RowFormat::Table, console);
    }
    print_pages(name, result, console)
}

/// Returns the pages of a name: for each the part of the catalogue, and the text in Markdown with a case to copy.
fn explained(name: &str, catalogue: &Catalogue) -> Vec<(String, String)> {
    let mut result = Vec::new();
    let pictures = format!("estimators of {}", MultipleScattering::title());
    for (part, page) in pages(catalogue).into_iter().filter(|(_, page)| page.name() == name) {
        let mut text = page.text().trim_end().to_owned();
        if let Some(example) = page.example() {
            text += if part == pictures {
                "\n\nA picture to copy; `trueflight render picture.toml` renders it:\n\n"
            } else {
                "\n\nA case to copy; `trueflight run case.toml` draws it:\n\n"
            };
            text += &fenced(&example);
        }
        result.push((part, text));
    }
    let files = [("cases", suite::find(name)), ("pictures", render::find(name))];
    for (part, source) in files {
        result.extend(source.map(|source| (part.to_owned(), fenced(&source.text))));
    }
    result
}

fn fenced(toml: &str) -> String {
    format!("```toml\n{}\n```", toml.trim_end())
}

/// Returns the error about an unknown name, with similar names.
fn unknown(written: &str, name: &str, catalogue: &Catalogue) -> anyhow::Error {
    let sources = suite::suite().into_iter().chain(render::gallery()).map(|source| source.name);
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
