//! Notes below a table: what the best σ̂ is, and the setup lookups and needs that have no column.

use crate::record::{Best, Row};
use crate::report::console::layout::{Paint, Pen};
use crate::report::console::views::{NEEDS, SETUP};
use numeric::digits::short;

/// Adds the notes, each once; `is_shown` says which columns the table has.
pub fn notes(text: &mut String, pen: Pen, rows: &[Row], is_shown: &dyn Fn(&str) -> bool) {
    let mut notes: Vec<String> = Vec::new();
    let mut say = |row: &Row, channel: &str, what: String| {
        let names = [row.experiment.label.as_str(), &row.experiment.id.control, channel];
        let names: Vec<&str> = names.into_iter().filter(|name| !name.is_empty()).collect();
        let note = format!("note {}: {what}", names.join(", "));
        if !notes.contains(&note) {
            notes.push(note);
        }
    };
    for row in rows {
        if let Some(best) = best(row) {
            say(row, &row.channel, best);
        }
        let setup = row.experiment.setup_lookups.unwrap_or(0);
        if setup > 0 && !is_shown(SETUP.0) {
            say(row, "", format!("{setup} setup lookups"));
        }
        if !row.experiment.needs.is_empty() && !is_shown(NEEDS.0) {
            say(row, "", format!("needs {}", row.experiment.needs));
        }
    }
    for note in notes {
        pen.note(text, &note, ("note", Paint::Plain));
    }
}

/// Words for the best σ̂ of a row; `None` where it was not searched.
fn best(row: &Row) -> Option<String> {
    let Best { sampling, fom, kind, limit } = row.best.as_ref()?;
    let fom = fom.map_or("∞".to_owned(), |fom| short(fom, 4));
    let best = format!("best σ\u{302} {}, best FoM {fom}", short(*sampling, 4));
    Some(match *limit {
        Some(limit) => {
            let limit = short(limit, 4);
            format!("{best} is {kind}; the limit is {limit}, FoM rises to it with σ\u{302}")
        }
        None => format!("{best} ({kind})"),
    })
}
