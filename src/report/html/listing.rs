//! A plain table that the page's script can filter and sort: of a bench, of a stress test.

use super::words;
use maud::{Markup, html};
use std::collections::BTreeSet;

/// A column: its title, and what its cells are.
pub struct Column<T> {
    /// The title.
    pub title: &'static str,
    /// What stands in a cell.
    pub cell: Cell<T>,
}

/// What stands in a cell of a row.
pub enum Cell<T> {
    /// Words.
    Text(fn(&T) -> String),
    /// A number in three digits.
    Number(fn(&T) -> Option<f64>),
}

/// The table; `class` is that of a row's first cell, `data` what a row is chosen by.
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

/// What a row is chosen by, and the values that there are: a row has its own in `data-NAME` or in the column of that title.
pub type Choice = (&'static str, BTreeSet<String>);

/// A field for words, a list for each choice, and how many rows of so many are shown.
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
        p #none hidden { "Nothing is as the filters want it." }
    }
}
