//! Columns that CSV and JSON share: a number has the same name everywhere.

use serde::ser::{Serialize, Serializer};

use crate::report::{Artifact, ReportError};
use numeric::digits::exact;

/// Content of one field.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Text; may be empty.
    Text(String),
    /// A word of a fixed list, if there is one.
    Word(Option<&'static str>),
    /// Number, if it is known.
    Number(Option<f64>),
    /// Count, if it is known.
    Count(Option<u64>),
    /// List of numbers; may be empty.
    List(Vec<f64>),
}

impl Cell {
    /// Returns the field in a CSV file; empty if unknown.
    pub fn csv(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Word(word) => word.unwrap_or_default().to_owned(),
            Self::Number(number) => number.map(exact).unwrap_or_default(),
            Self::Count(count) => count.map(|n| n.to_string()).unwrap_or_default(),
            Self::List(list) => list.iter().map(|&x| exact(x)).collect::<Vec<_>>().join(" "),
        }
    }
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Text(text) => serializer.serialize_str(text),
            Self::Word(word) => word.serialize(serializer),
            Self::Number(number) => number.serialize(serializer),
            Self::Count(count) => count.serialize(serializer),
            Self::List(list) => list.serialize(serializer),
        }
    }
}

macro_rules! cells {
    ($($from:ty: |$x:ident| $cell:expr;)*) => {
        $(impl From<$from> for Cell {
            fn from($x: $from) -> Self {
                $cell
            }
        })*
    };
}

cells! {
    &str: |text| Self::Text(text.to_owned());
    &String: |text| Self::Text(text.clone());
    String: |text| Self::Text(text);
    Option<&'static str>: |word| Self::Word(word);
    f64: |x| Self::Number(Some(x));
    Option<f64>: |x| Self::Number(x);
    u64: |n| Self::Count(Some(n));
    usize: |n| Self::Count(Some(n as u64));
    Option<u64>: |n| Self::Count(n);
    bool: |is_so| Self::Text(is_so.to_string());
    &Vec<f64>: |list| Self::List(list.clone());
}

/// Column: its name in files and the content of its fields.
pub struct Column<T> {
    /// Name in the first line.
    pub name: &'static str,
    /// Returns the field.
    pub cell: fn(&T) -> Cell,
}

/// Lists columns, as in `"seed" = |row| row.seed;`.
macro_rules! columns {
    ($($name:literal = |$row:ident| $cell:expr;)*) => {
        vec![$($crate::report::columns::Column {
            name: $name,
            cell: |$row| $crate::report::columns::Cell::from($cell),
        }),*]
    };
}
pub(in crate::report) use columns;

/// Returns rows as CSV, with a first line of names; `name` is the file in an error.
///
/// # Errors
///
/// The encoder fails.
pub fn csv<T>(
    name: &str,
    columns: &[Column<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<String, ReportError> {
    let line = |row: T| columns.iter().map(|column| (column.cell)(&row).csv()).collect::<Vec<_>>();
    table(name, columns.iter().map(|column| column.name), rows.into_iter().map(line))
}

/// Returns rows as a JSON array of objects, one per line. Unknown is `null`, and so is an infinite number, which JSON
/// cannot write.
///
/// # Errors
///
/// The encoder fails.
pub fn json<T>(
    columns: &[Column<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<String, ReportError> {
    let object = |row: T| {
        let mut bytes = Vec::new();
        let fields = columns.iter().map(|column| (column.name, (column.cell)(&row)));
        serde_json::Serializer::new(&mut bytes).collect_map(fields)?;
        Ok::<_, serde_json::Error>(String::from_utf8_lossy(&bytes).into_owned())
    };
    let objects: Result<Vec<_>, _> = rows.into_iter().map(object).collect();
    let objects = objects?.join(",\n");
    Ok(if objects.is_empty() { "[]\n".to_owned() } else { format!("[\n{objects}\n]\n") })
}

/// Returns a file of rows as CSV.
///
/// # Errors
///
/// The encoder fails.
pub fn artifact<T>(
    path: &str,
    columns: &[Column<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<Artifact, ReportError> {
    Ok(Artifact::text(path, csv(path, columns, rows)?))
}

/// Returns the CSV text of a header and lines; `name` is the file in an error.
pub(in crate::report) fn table<H, L, F>(
    name: &str,
    header: H,
    lines: L,
) -> Result<String, ReportError>
where
    H: IntoIterator<Item = &'static str>,
    L: IntoIterator<Item = F>,
    F: IntoIterator<Item = String>,
{
    let wrong = |source| ReportError::Csv { name: name.to_owned(), source };
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header).map_err(wrong)?;
    for line in lines {
        writer.write_record(line).map_err(wrong)?;
    }
    let bytes = writer.into_inner().map_err(|error| wrong(error.into_error().into()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
