//! Page with a plain table that its script can filter and sort: of a bench, a stress test, advice, pictures.

use super::{document, words};
use crate::report::fields::{Field, Shown, Table};
use crate::report::html::template::{Markup, html};
use std::collections::BTreeSet;

/// Returns a page: the tool in words, a heading with its style class, what stands below it, and sections.
pub fn page(tool: &str, (class, line): (&str, &str), head: &Markup, sections: &Markup) -> String {
    let body = html! {
        header class={ "run " (class) } {
            p.tool { "Trueflight " (env!("CARGO_PKG_VERSION")) ", " (tool) }
            h1 { (line) }
            (head)
        }
        (sections)
    };
    document(&format!("Trueflight: {line}"), &body)
}

/// Returns the section with the table of rows, filtered by group. The first column has a heading, and of each row a style
/// class and a text.
pub fn section<T: Table>(
    title: &str,
    head: &str,
    first: fn(&T) -> (&'static str, String),
    columns: &[Shown],
    rows: &[T],
    group: fn(&T) -> String,
) -> Markup {
    let all = T::fields();
    let fields: Vec<_> = columns.iter().map(|column| &all[column.place]).collect();
    let class = |field: &Field<T>| field.is_numeric(rows).then_some("number");
    html! {
        section aria-labelledby="experiments" {
            h2 #experiments { (title) }
            (form(&[("group", rows.iter().map(group).collect())], rows.len()))
            div.wide tabindex="0" role="group" aria-labelledby="experiments" {
                table #table {
                    thead { tr {
                        th scope="col" { (head) }
                        @for field in &fields { th scope="col" class=[class(field)] title=(field.tip()) { (field.head) } }
                    } }
                    @for row in rows {
                        @let (word, text) = first(row);
                        tbody data-group=(group(row)) { tr {
                            th scope="row" class={ "verdict " (word) } { (text) }
                            @for field in &fields { td class=[class(field)] { (words::field(field, row)) } }
                        } }
                    }
                }
            }
        }
    }
}

/// Filter: a name, and its values. A row has its own value in `data-NAME` or in the column of that title.
pub type Choice = (&'static str, BTreeSet<String>);

/// Returns a text field, a list for each filter, and the number of shown rows of all `rows`.
pub fn form(choices: &[Choice], rows: usize) -> Markup {
    html! {
        form #filters hidden {
            label { "Text " input type="search" name="text" autocomplete="off"; }
            @for (name, values) in choices {
                label { (name) " "
                    select name=(name) {
                        option value="" { "all" }
                        @for value in values { option value={ "=" (value) } { (value) } }
                    }
                }
            }
            button type="reset" { "Show all" }
            output #shown role="status" { (rows) " of " (rows) }
        }
        p #chosen {}
        p #none hidden { "No row matches the filters." }
    }
}
