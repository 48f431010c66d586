//! Fields of tables: one definition of each gives the column of CSV, JSON, console and page, and its line in the manual.

use std::fmt::Write;

use serde::ser::{Serialize, Serializer};

use crate::report::layout::Column;
use crate::report::{Artifact, ReportError};
use numeric::digits::{count, enough, exact, fixed, percent, short, signed};

/// Content of one field.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Text; may be empty.
    Text(String),
    /// A word of a fixed list, if there is one.
    Word(Option<&'static str>),
    /// Number, if it is known.
    Number(Option<f64>),
    /// z-score, and whether it is to be read as normal.
    Score(Option<f64>, bool),
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
            Self::Number(number) | Self::Score(number, _) => number.map(exact).unwrap_or_default(),
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
            Self::Number(number) | Self::Score(number, _) => number.serialize(serializer),
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
    (Option<f64>, bool): |score| Self::Score(score.0, score.1);
    u64: |n| Self::Count(Some(n));
    usize: |n| Self::Count(Some(n as u64));
    Option<u64>: |n| Self::Count(n);
    bool: |is_so| Self::Text(is_so.to_string());
    &Vec<f64>: |list| Self::List(list.clone());
}

/// Form in which people read a field; files have every digit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Print {
    /// Words, and counts in full below a million.
    Plain,
    /// At most this number of significant digits.
    Short(usize),
    /// This number of significant digits.
    Fixed(usize),
    /// This number of decimals.
    Places(usize),
    /// A sign and two decimals, in parentheses for a score that is not to be read as normal.
    Signed,
    /// Percent.
    Percent,
    /// Two digits, rounded up.
    Enough,
}

impl Print {
    /// Returns the text of a cell; empty if unknown.
    pub fn text(self, cell: &Cell) -> String {
        match *cell {
            Cell::Number(Some(x)) => self.number(x),
            Cell::Score(Some(z), true) => self.number(z),
            Cell::Score(Some(z), false) => format!("({})", self.number(z)),
            Cell::Count(Some(n)) => count(n),
            _ => cell.csv(),
        }
    }

    fn number(self, x: f64) -> String {
        match self {
            _ if x.is_nan() => String::new(),
            _ if x.is_infinite() => (if x > 0.0 { "∞" } else { "-∞" }).to_owned(),
            Self::Plain => exact(x),
            Self::Short(digits) => short(x, digits),
            Self::Fixed(digits) => fixed(x, digits),
            Self::Places(places) => format!("{x:.places$}"),
            Self::Signed => signed(x),
            Self::Percent => percent(x),
            Self::Enough => enough(x),
        }
    }
}

/// Field of a table.
pub struct Field<T> {
    /// Name in files.
    pub name: &'static str,
    /// Heading on screens and pages.
    pub head: &'static str,
    /// Unit, as in `1/length`; empty for words, counts and ratios.
    pub unit: &'static str,
    /// Meaning, in one sentence.
    pub meaning: &'static str,
    /// Form for people.
    pub print: Print,
    /// Returns the content.
    pub cell: fn(&T) -> Cell,
}

impl<T> Field<T> {
    /// Returns the text for people; empty if unknown.
    pub fn text(&self, row: &T) -> String {
        self.print.text(&(self.cell)(row))
    }

    /// Returns the column of a console's table; columns of the highest rank leave a narrow console first.
    pub fn column(&self, rows: &[T], rank: u8) -> Column {
        let right = self.is_numeric(rows);
        Column::of(rows, (self.head, right, rank), |row| self.text(row))
    }

    /// Returns whether its texts are numbers, which are aligned to the right.
    pub fn is_numeric(&self, rows: &[T]) -> bool {
        let is_text = matches!(rows.first().map(self.cell), Some(Cell::Text(_) | Cell::Word(_)));
        !is_text || self.print != Print::Plain
    }

    /// Returns the meaning with the unit.
    pub fn tip(&self) -> String {
        let unit =
            if self.unit.is_empty() { String::new() } else { format!(" Unit: {}.", self.unit) };
        format!("{}.{unit}", self.meaning)
    }
}

/// Returns the field of this name; of an unknown name the first one.
pub fn named<'f, T>(fields: &'f [Field<T>], name: &str) -> &'f Field<T> {
    fields.iter().find(|field| field.name == name).unwrap_or(&fields[0])
}

/// Lists fields, as in `"seed": "Seed of the run" = |row| row.seed;`, or with heading, unit and form, as in
/// `"swept" ["σ̂", "1/length", Short(4)]: "Swept value" = |row| row.swept();`.
macro_rules! fields {
    ($($name:literal $([$head:literal, $unit:literal, $print:expr])?: $meaning:literal = |$row:pat_param| $cell:expr;)*) => {{
        #[allow(unused_imports)]
        use $crate::report::fields::Print::{Enough, Fixed, Percent, Places, Plain, Short, Signed};
        vec![$($crate::report::fields::fields!(
            @one $name [$($head, $unit, $print)?], $meaning, |$row| $cell
        )),*]
    }};
    (@one $name:literal [], $($rest:tt)*) => {
        $crate::report::fields::fields!(@one $name [$name, "", Plain], $($rest)*)
    };
    (@one $name:literal [$head:literal, $unit:literal, $print:expr], $meaning:literal, |$row:pat_param| $cell:expr) => {
        $crate::report::fields::Field {
            name: $name,
            head: $head,
            unit: $unit,
            meaning: $meaning,
            print: $print,
            cell: |$row| $crate::report::fields::Cell::from($cell),
        }
    };
}
pub(in crate::report) use fields;

/// Returns rows as CSV, with a first line of names; `name` is the file in an error.
///
/// # Errors
///
/// The encoder fails.
pub fn csv<T>(
    name: &str,
    fields: &[Field<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<String, ReportError> {
    let line = |row: T| fields.iter().map(|field| (field.cell)(&row).csv()).collect::<Vec<_>>();
    table(name, fields.iter().map(|field| field.name), rows.into_iter().map(line))
}

/// Returns rows as a JSON array of objects, one per line. Unknown is `null`, and so is an infinite number, which JSON
/// cannot write.
///
/// # Errors
///
/// The encoder fails.
pub fn json<T>(
    fields: &[Field<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<String, ReportError> {
    let object = |row: T| {
        let mut bytes = Vec::new();
        let cells = fields.iter().map(|field| (field.name, (field.cell)(&row)));
        serde_json::Serializer::new(&mut bytes).collect_map(cells)?;
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
    fields: &[Field<T>],
    rows: impl IntoIterator<Item = T>,
) -> Result<Artifact, ReportError> {
    Ok(Artifact::text(path, csv(path, fields, rows)?))
}

/// Returns fields as a table of Markdown: name, heading, unit, meaning.
pub fn markdown<T>(fields: &[Field<T>]) -> String {
    let mut text = String::from("| column | heading | unit | meaning |\n|---|---|---|---|\n");
    for Field { name, head, unit, meaning, .. } in fields {
        let head = if head == name { "" } else { *head };
        let meaning = meaning.replace('|', "\\|");
        let _ = writeln!(text, "| `{name}` | {head} | {unit} | {meaning} |");
    }
    text
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
