//! Cases: verdicts, visible bias, plots.

use crate::record::{CaseRecord, Record};
use crate::report::html as page;
use crate::report::html::drawing::Plot;
use crate::report::html::template::{Markup, html};
use crate::report::html::words;
use crate::report::run::totals;
use numeric::digits::range;

/// Returns a line for each case; those with plots open.
pub fn section(record: &Record, plots: &[Vec<Plot>]) -> Markup {
    let cases = &record.results.cases;
    html! {
        section aria-labelledby="cases" {
            h2 #cases { "Cases" }
            p.quiet { "Each opens to its title, what it could have seen, and its plots." }
            div.cases { @for (place, (case, plots)) in cases.iter().zip(plots).enumerate() {
                details.case #{ "case-" (place) } data-problem=(case.problem) data-medium=(case.medium) {
                    summary { b { (case.name) } " " span.quiet { (totals::words(case)) } }
                    p { (case.title) }
                    @for note in &case.notes { p { b { "Note: " } (note) } }
                    @for fact in &case.facts { p.quiet { (fact) } }
                    (page::facts(facts(case)))
                    @for plot in plots { (plot.show()) }
                }
            } }
        }
    }
}

fn facts(case: &CaseRecord) -> [(&'static str, String); 6] {
    [
        ("Problem", case.problem.clone()),
        ("Medium", case.medium.clone()),
        ("File", case.path.clone()),
        ("Draws", totals::draws(case)),
        ("Visible bias", case.visible_bias.filter(words::is_known).map(range).unwrap_or_default()),
        ("Time to verdict, in units of 17 V/ε² draws", words::number(case.pace, 3)),
    ]
}
