//! Plots of a page, each defined once and shown wherever it is needed.

use crate::report::html::template::{Markup, html};

use crate::report::plots::svg::{shapes, unit, view};
use drawing::Sheet;
use drawing::sheet::Tip;

/// Plot that the page defines.
pub struct Plot {
    /// Anchor in the page.
    id: String,
    /// Description for readers of the page that cannot show it.
    label: String,
    view: String,
    shapes: Markup,
    tips: String,
}

/// Returns the plot of a sheet.
pub fn plot(id: String, label: String, sheet: &Sheet) -> Plot {
    Plot { id, label, view: view(sheet), shapes: shapes(sheet), tips: tips(sheet) }
}

/// Returns a plot that the page shows once, as large as its place allows.
pub fn inline(sheet: &Sheet, label: &str) -> Markup {
    html! {
        div tabindex="0" role="group" aria-label="plot" {
            svg.plot viewBox=(view(sheet)) fill="none" role="img" aria-label=(label) data-tips=(tips(sheet)) { (shapes(sheet)) }
        }
    }
}

/// Returns the values of a sheet, one a line, each after its place.
fn tips(sheet: &Sheet) -> String {
    let line = |tip: &Tip| {
        let [x, y] = tip.at.map(unit);
        format!("{x} {y} {}", tip.text.replace('\n', " "))
    };
    sheet.tips.iter().map(line).collect::<Vec<_>>().join("\n")
}

impl Plot {
    /// Shows the plot, as large as its place allows.
    pub fn show(&self) -> Markup {
        html! {
            div.wide tabindex="0" role="group" aria-label="plot" {
                svg.plot viewBox=(self.view) role="img" aria-label=(self.label) {
                    use href={ "#" (self.id) } {}
                }
            }
        }
    }
}

/// Returns the shapes of all plots, hidden.
pub fn definitions(plots: &[Vec<Plot>]) -> Markup {
    html! {
        svg.hidden aria-hidden="true" focusable="false" {
            @for plot in plots.iter().flatten() {
                symbol id=(plot.id) viewBox=(plot.view) fill="none" data-tips=(plot.tips) { (plot.shapes) }
            }
        }
    }
}
