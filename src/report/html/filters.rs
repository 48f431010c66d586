//! The filters above a table: hidden where no script can serve them.

use std::collections::BTreeSet;

use maud::{Markup, html};

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
