//! Plain table that the page's script can filter and sort: of a bench, of a stress test.

use super::words;
use crate::report::fields::{Field, Table};
use maud::{Markup, html};
use std::collections::BTreeSet;

/// Returns the table of rows with these columns, by their places. The first column has a heading, and of each row a style class and a text; `data` has the values that
/// filters select by.
pub fn table<T: Table>(
    head: &str,
    first: fn(&T) -> (&'static str, String),
    columns: &[usize],
    rows: &[T],
    data: fn(&T) -> String,
) -> Markup {
    let all = T::fields();
    let fields: Vec<_> = columns.iter().map(|&place| &all[place]).collect();
    let class = |field: &Field<T>| field.is_numeric(rows).then_some("number");
    html! {
        div.wide tabindex="0" role="group" aria-labelledby="experiments" {
            table #table {
                thead { tr {
                    th scope="col" { (head) }
                    @for field in &fields { th scope="col" class=[class(field)] title=(field.tip()) { (field.head) } }
                } }
                @for row in rows {
                    @let (word, text) = first(row);
                    tbody data-group=(data(row)) { tr {
                        th scope="row" class={ "verdict " (word) } { (text) }
                        @for field in &fields { td class=[class(field)] { (words::field(field, row)) } }
                    } }
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
