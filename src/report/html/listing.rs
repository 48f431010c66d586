//! Plain table that the page's script can filter and sort: of a bench, of a stress test.

use super::words;
use maud::{Markup, html};
use std::collections::BTreeSet;

/// Column: its title and its cells.
pub struct Column<T> {
    /// The title.
    pub title: &'static str,
    /// Content of its cells.
    pub cell: Cell<T>,
}

/// Content of a cell, by its row.
pub enum Cell<T> {
    /// Text.
    Text(fn(&T) -> String),
    /// Number in three digits.
    Number(fn(&T) -> Option<f64>),
}

/// Returns the table; `class` is that of a row's first cell, `data` has the values that filters select by.
pub fn table<T>(
    columns: &[Column<T>],
    rows: &[T],
    class: fn(&T) -> &'static str,
    data: fn(&T) -> String,
) -> Markup {
    html! {
        div.wide tabindex="0" role="group" aria-labelledby="experiments" {
            table #table {
                thead { tr { @for Column { title, cell } in columns {
                    th scope="col" class=[matches!(cell, Cell::Number(_)).then_some("number")] { (title) }
                } } }
                @for row in rows {
                    tbody data-group=(data(row)) { tr {
                        @for (place, Column { cell, .. }) in columns.iter().enumerate() {
                            @match cell {
                                Cell::Text(text) if place == 0 => {
                                    th scope="row" class={ "verdict " (class(row)) } { (text(row)) }
                                }
                                Cell::Text(text) => td { (text(row)) }
                                Cell::Number(number) => td.number {
                                    (words::number(number(row), 3))
                                }
                            }
                        }
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
