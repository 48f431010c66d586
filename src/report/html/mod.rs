//! Pages of HTML: head, style, script, tables, plots.

pub mod drawing;
pub mod listing;
pub mod template;
pub mod words;

use template::{Markup, html};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// Content policy: the page loads nothing, whatever it contains.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// Ends of elements that HTML does not need: a tenth of a page. Text of a record has no `<`, for it is escaped.
const OPTIONAL: [&str; 7] = ["</td>", "</th>", "</tr>", "</dt>", "</dd>", "</li>", "</option>"];

/// Returns a page of HTML with this title and these sections.
pub fn document(title: &str, sections: &Markup) -> String {
    let page = html! {
        (Markup::raw("<!DOCTYPE html>"))
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (Markup::raw(STYLE)) }
            }
            body {
                a.skip href="#experiments" { "To the table of experiments" }
                main { (sections) }
                script { (Markup::raw(SCRIPT)) }
            }
        }
    };
    OPTIONAL.iter().fold(page.into_string(), |page, end| page.replace(end, ""))
}

/// Returns the facts that are known, each with its name.
pub fn facts<'a>(facts: impl IntoIterator<Item = (&'a str, String)>) -> Markup {
    let is_known = |(_, value): &(&str, String)| !value.is_empty() && value != words::UNKNOWN;
    let facts = facts.into_iter().filter(is_known);
    html! {
        dl.facts { @for (name, value) in facts { div { dt { (name) } dd { (value) } } } }
    }
}

/// Returns likely causes of a failure, folded.
pub fn causes(lines: &[String]) -> Markup {
    let item = |line: &String| line.strip_prefix("- ").unwrap_or(line).to_owned();
    html! {
        @if let Some((first, rest)) = lines.split_first() {
            details {
                summary { (first) }
                ul { @for line in rest { li { (item(line)) } } }
            }
        }
    }
}

/// Returns a command to copy, after a word that describes it, if there is one: the page's script adds a button that copies it.
pub fn command(command: Option<(&str, &str)>) -> Markup {
    html! {
        @if let Some((word, command)) = command.filter(|command| !command.1.is_empty()) {
            p.command { @if !word.is_empty() { (word) ": " } code { (command) } }
        }
    }
}
