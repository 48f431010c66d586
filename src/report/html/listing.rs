//! A plain table that the page's script can filter and sort: of a bench, of a stress test.

use maud::{Markup, html};

use super::words;

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
