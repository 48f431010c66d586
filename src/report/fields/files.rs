//! Rows of tables as files, and their fields as a table of the manual. All but the loops over rows is compiled once for all
//! tables.

use std::borrow::Borrow;

use serde::Serialize;
use serde::ser::Serializer;

use super::{Cell, Field};
use crate::report::{Artifact, ReportError};

/// Returns rows as CSV, with a first line of names; `name` is the file in an error.
pub fn csv<T>(
    name: &str,
    fields: &[Field<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<String, ReportError> {
    let mut names = Vec::with_capacity(fields.len());
    for field in fields {
        names.push(field.name);
    }
    csv_of(&names, &objects(fields, rows))
        .map_err(|source| ReportError::Csv { name: name.to_owned(), source })
}

fn csv_of(names: &[&str], rows: &[NamedPairs<Cell>]) -> csv::Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(names)?;
    for NamedPairs(cells) in rows {
        writer.write_record(cells.iter().map(|(_, cell)| cell.csv()))?;
    }
    let bytes = writer.into_inner().map_err(csv::IntoInnerError::into_error)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Pairs as an object of JSON, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPairs<V>(Vec<(&'static str, V)>);

impl<V: Serialize> Serialize for NamedPairs<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// Returns a row as an object of JSON.
pub fn object<T>(fields: &[Field<T>], row: &T) -> NamedPairs<Cell> {
    let mut cells = Vec::with_capacity(fields.len());
    for field in fields {
        cells.push((field.name, (field.cell)(row)));
    }
    NamedPairs(cells)
}

/// Returns rows as objects.
pub fn objects<T>(
    fields: &[Field<T>],
    rows: impl IntoIterator<Item: Borrow<T>>,
) -> Vec<NamedPairs<Cell>> {
    let mut objects = Vec::new();
    for row in rows {
        objects.push(object(fields, row.borrow()));
    }
    objects
}

/// Returns rows as a JSON array of objects, one per line. Unknown is `null`, and so is an infinite number, which JSON
/// cannot write.
pub fn json<T>(
    fields: &[Field<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<String, ReportError> {
    Ok(json_of(&objects(fields, rows))?)
}

fn json_of(objects: &[NamedPairs<Cell>]) -> serde_json::Result<String> {
    let lines: Result<Vec<_>, _> = objects.iter().map(serde_json::to_string).collect();
    let objects = lines?.join(",\n");
    Ok(if objects.is_empty() { "[]\n".to_owned() } else { format!("[\n{objects}\n]\n") })
}

/// Returns rows as a JSON object of columns, each its kind (`text`, `number`, `count` or `list`) and its values. Unknown is
/// `null`; without rows there are no columns.
pub fn columns<T>(fields: &[Field<T>], rows: &[T]) -> Result<String, ReportError> {
    let mut columns: Vec<(&'static str, (&'static str, Vec<Cell>))> = Vec::new();
    for field in fields {
        let mut values = Vec::with_capacity(rows.len());
        for row in rows {
            values.push((field.cell)(row));
        }
        if let Some(first) = values.first() {
            columns.push((field.name, (first.kind(), values)));
        }
    }
    Ok(serde_json::to_string(&NamedPairs(columns))?)
}

/// Returns a file of rows as CSV.
pub fn artifact<T>(
    path: &str,
    fields: &[Field<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<Artifact, ReportError> {
    Ok(Artifact::text(path, csv(path, fields, rows)?))
}

/// Returns fields as a table of Markdown: name, heading, unit, meaning.
pub fn markdown<T>(fields: &[Field<T>]) -> String {
    let (mut shared, mut own) = (Vec::new(), String::new());
    for Field { name, head, unit, meaning, .. } in fields {
        if meaning.is_empty() {
            shared.push(*name);
        } else {
            own += &line(name, head, unit, meaning);
        }
    }
    shared_words(&shared) + HEAD + &own
}

/// Returns names with their meanings as the same table.
pub fn described(meanings: &[(&str, &str)]) -> String {
    let lines: String =
        meanings.iter().map(|(name, meaning)| line(name, name, "", meaning)).collect();
    HEAD.to_owned() + &lines
}

/// First lines of the tables of fields.
const HEAD: &str = "| column | heading | unit | meaning |\n|---|---|---|---|\n";

/// Returns the words about fields that rows of a run have, too.
fn shared_words(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    if names.is_empty() {
        return String::new();
    }
    format!("As in rows of a run: {}.\n\n", names.join(", "))
}

/// Returns the row of a field in the table of Markdown.
fn line(name: &str, head: &str, unit: &str, meaning: &str) -> String {
    let head = if head == name { "" } else { head };
    format!("| `{name}` | {head} | {unit} | {} |\n", meaning.replace('|', "\\|"))
}
