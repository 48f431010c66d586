//! Fields of tables: one definition of each gives the column of CSV, JSON, console and page, and its line in the manual.

mod files;

use serde::Serialize;
use serde::ser::Serializer;

use crate::report::layout::{self, Column, Pen, TableLayout};
use crate::report::run::summary_csv::SummaryRow;
pub use files::{NamedPairs, artifact, columns, csv, described, json, markdown, object, objects};
use numeric::digits::{count, enough, fixed, number, percent, short, signed, time};

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
    /// Yes or no, if it is known.
    Flag(Option<bool>),
}

impl Cell {
    /// Returns the field in a CSV file; empty if unknown.
    pub fn csv(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Word(word) => word.unwrap_or_default().to_owned(),
            Self::Number(x) | Self::Score(x, _) => x.map(number).unwrap_or_default(),
            Self::Count(count) => count.map(|n| n.to_string()).unwrap_or_default(),
            Self::List(list) => list.iter().map(|&x| number(x)).collect::<Vec<_>>().join(" "),
            Self::Flag(flag) => flag.map(|is_so| is_so.to_string()).unwrap_or_default(),
        }
    }

    fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) | Self::Word(_) | Self::Flag(_) => "text",
            Self::Number(_) | Self::Score(..) => "number",
            Self::Count(_) => "count",
            Self::List(_) => "list",
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
            Self::Flag(flag) => flag.serialize(serializer),
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
    Option<usize>: |n| Self::Count(n.map(|n| n as u64));
    Option<bool>: |flag| Self::Flag(flag);
    bool: |is_so| Self::Text(is_so.to_string());
    &Vec<f64>: |list| Self::List(list.clone());
}

/// Form in which people read a field; files have every digit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Print {
    /// Words, and counts in full below a million.
    Plain,
    /// Words made of numbers, which are aligned like numbers.
    Right,
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
    /// Three digits of a time in s, in the unit that suits it.
    Time,
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
            Self::Plain | Self::Right => number(x),
            Self::Short(digits) => short(x, digits),
            Self::Fixed(digits) => fixed(x, digits),
            Self::Places(places) => format!("{x:.places$}"),
            Self::Signed => signed(x),
            Self::Percent => percent(x),
            Self::Enough => enough(x),
            Self::Time => time(x),
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
    /// Meaning, in one sentence; empty for that of the field with this name in rows of a run.
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
        let mut fields = Vec::with_capacity(rows.len());
        for row in rows {
            fields.push(layout::LayoutField::plain(self.text(row)));
        }
        Column { head: self.head, right: self.is_numeric(rows), rank, fields }
    }

    /// Returns whether its texts are numbers, which are aligned to the right.
    pub fn is_numeric(&self, rows: &[T]) -> bool {
        let Some(row) = rows.first() else { return true };
        self.print != Print::Plain || !matches!((self.cell)(row), Cell::Text(_) | Cell::Word(_))
    }

    /// Returns the meaning with the unit.
    pub fn tip(&self) -> String {
        tip(self.name, self.unit, self.meaning)
    }
}

/// Returns the meaning of a field with its unit.
fn tip(name: &str, unit: &str, own: &'static str) -> String {
    let mut meaning = own;
    if meaning.is_empty() {
        let of_run = SummaryRow::fields().into_iter().find(|field| field.name == name);
        meaning = of_run.map_or("", |field| field.meaning);
    }
    let unit = if unit.is_empty() { String::new() } else { format!(" Unit: {unit}.") };
    format!("{meaning}.{unit}")
}

/// Type of rows with its fields.
pub trait Table: Sized {
    /// Names of all fields, in the order of [`Table::fields`].
    const NAMES: &'static [&'static str];

    /// Number of fields of files; further fields are on screens and pages only.
    const FILES: usize;

    /// Returns all fields.
    fn fields() -> Vec<Field<Self>>;

    /// Returns the fields of files, in their order.
    fn of_files() -> Vec<Field<Self>> {
        let mut fields = Self::fields();
        fields.truncate(Self::FILES);
        fields
    }
}

/// Column of a screen or a page.
#[derive(Debug, Clone, Copy)]
pub struct Shown {
    /// Place of its field in the table.
    pub place: usize,
    /// Rank: columns of the highest rank leave a narrow console first.
    pub rank: u8,
}

/// Lists columns by the names of their fields, each with its rank where that is not 0, as in
/// `shown!(Line: "mean" 6, "z_mean" 1, "truth")`. An unknown name is an error of the compiler.
#[macro_export]
#[doc(hidden)]
macro_rules! shown {
    ($row:ty: $($name:literal $($rank:literal)?),*) => {
        const { &[$($crate::report::fields::Shown {
            place: $crate::report::fields::place::<$row>($name),
            rank: 0 $(+ $rank)?,
        }),*] }
    };
}
pub use shown;

/// Returns the place of a field in its table.
pub const fn place<T: Table>(name: &str) -> usize {
    let mut place = 0;
    while !is_same(name, T::NAMES[place]) {
        place += 1;
    }
    place
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    a.len() == b.len() && i == a.len()
}

/// Returns the table of rows for a console, with these columns.
pub fn grid<T: Table>(rows: &[T], columns: &[Shown]) -> TableLayout {
    let fields = T::fields();
    let mut grid = TableLayout { columns: Vec::with_capacity(columns.len()) };
    for shown in columns {
        grid.columns.push(fields[shown.place].column(rows, shown.rank));
    }
    grid
}

/// Returns that table with a last column of words about the rows, in green and red, as text that fits the console.
pub fn judged<T: Table>(
    rows: &[T],
    columns: &[Shown],
    (head, words): (&'static str, [&str; 2]),
    is_good: impl Fn(&T) -> bool,
    pen: Pen,
) -> String {
    let mut grid = grid(rows, columns);
    let mut judged = Vec::with_capacity(rows.len());
    for row in rows {
        judged.push(layout::LayoutField::judged(is_good(row), words));
    }
    grid.push(head, judged);
    grid.fit(pen.width);
    grid.render(pen)
}

/// Lists fields, as in `"seed": "Seed of the run" = |row| row.seed;`, or with heading, unit and form, as in
/// `"swept" ["σ̂", "1/length", Short(4)]: "Swept value" = |row| row.swept();`.
#[macro_export]
#[doc(hidden)]
macro_rules! fields {
    ($($name:literal $([$head:literal, $unit:literal, $print:expr])? $(: $meaning:literal)? = |$row:pat_param| $cell:expr;)*) => {{
        #[allow(unused_imports)]
        use $crate::report::fields::Print::{
            Enough, Fixed, Percent, Places, Plain, Right, Short, Signed, Time,
        };
        vec![$($crate::report::fields::fields!(
            @one $name [$($head, $unit, $print)?], [$($meaning)?], |$row| $cell
        )),*]
    }};
    (@one $name:literal [], $($rest:tt)*) => {
        $crate::report::fields::fields!(@one $name [$name, "", Plain], $($rest)*)
    };
    (@one $name:literal [$head:literal, $unit:literal, $print:expr], [$($meaning:literal)?], |$row:pat_param| $cell:expr) => {
        $crate::report::fields::Field {
            name: $name,
            head: $head,
            unit: $unit,
            meaning: concat!($($meaning)?),
            print: $print,
            cell: |$row| $crate::report::fields::Cell::from($cell),
        }
    };
}
pub use fields;

/// Makes a type of rows a [`Table`] of fields: those of files, then those of screens and pages only.
#[macro_export]
#[doc(hidden)]
macro_rules! table {
    (impl $(<$life:lifetime>)? for $row:ty {
        $($name:literal $([$($form:tt)*])? $(: $meaning:literal)? = |$arg:pat_param| $cell:expr;)*
    } $(screens {
        $($other:literal $([$($shape:tt)*])? $(: $sense:literal)? = |$one:pat_param| $content:expr;)*
    })?) => {
        impl $(<$life>)? $crate::report::fields::Table for $row {
            const NAMES: &'static [&'static str] = &[$($name,)* $($($other,)*)?];
            const FILES: usize = [$($name),*].len();

            fn fields() -> Vec<$crate::report::fields::Field<Self>> {
                $crate::report::fields::fields! {
                    $($name $([$($form)*])? $(: $meaning)? = |$arg| $cell;)*
                    $($($other $([$($shape)*])? $(: $sense)? = |$one| $content;)*)?
                }
            }
        }
    };
}
pub use table;
