//! `trueflight-lab list` and `trueflight-lab explain`: the known bugs.

use clap::Args;

use crate::mutants::{self, About};
use media::catalogue::{Page, suggestion};
use trueflight::case::{Case, suite};
use trueflight::cli::Console;
use trueflight::cli::listing::{ListingRow, print_pages, print_rows};
use trueflight::cli::output::RowFormat;

/// Name of the part of the catalogue that lists the known bugs.
const PART: &str = "known-bugs";

/// Arguments of `list`.
#[derive(Debug, Args)]
pub struct List {
    /// Form of the rows on stdout
    #[arg(long, value_enum, default_value_t)]
    format: RowFormat,
}

/// Prints the names with one sentence each.
pub(super) fn list(arguments: &List, console: &Console) -> anyhow::Result<u8> {
    let row = |(About { name, bug, .. }, _)| ListingRow {
        part: PART.into(),
        name: str::to_owned(name),
        summary: str::to_owned(bug),
    };
    print_rows(&known_bugs().map(row).collect::<Vec<_>>(), arguments.format, console)
}

/// Arguments of `explain`.
#[derive(Debug, Args)]
pub struct Explain {
    /// Name of a known bug
    name: String,
}

/// Prints the page of a known bug.
pub(super) fn explain(arguments: &Explain, console: &Console) -> anyhow::Result<u8> {
    let name = &arguments.name;
    let pages = known_bugs().filter(|(about, _)| about.name == name);
    let pages: Vec<_> = pages.map(|(about, page)| (PART.to_owned(), text(&about, &page))).collect();
    if pages.is_empty() {
        let names: Vec<&str> = known_bugs().map(|(about, _)| about.name).collect();
        let hint = suggestion(name, &names, "`trueflight-lab list` shows the names");
        anyhow::bail!("no known bug is called \"{name}\"; {hint}");
    }
    print_pages(name, pages, console)
}

/// Returns the known bugs with the pages of their families.
fn known_bugs() -> impl Iterator<Item = (About, Page)> {
    let families = mutants::families().into_iter();
    families.flat_map(|(page, abouts)| abouts.into_iter().map(move |about| (about, page)))
}

/// Returns the text about a known bug: what the code does, where it is caught, and the page of its family.
fn text(about: &About, page: &Page) -> String {
    let About { bug, target, check, .. } = about;
    let case = suite::find(target.case).and_then(|source| Case::read(&source).ok());
    let estimator = case.map(|case| case.id(target.index, None).estimator.to_string());
    let place =
        format!("`{}` of the built-in case `{}`", estimator.unwrap_or_default(), target.case);
    let page = page.text();
    format!(
        "Wrong code: {bug}.\n\n`trueflight-lab self-test` draws it in the place of {place}, and requires that the check \
         `{check}` fails it.\n\n{}",
        page.trim_end()
    )
}
