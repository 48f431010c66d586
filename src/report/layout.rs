//! Columns that fit a screen: alignment, elision, wrapping and colour, independent of records.

use std::fmt::Write;

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Gap between two columns.
const GAP: &str = "  ";
/// Width to which names are cut before columns are dropped; they get shorter only when all columns are dropped.
const USUAL_NAME: usize = 24;
const MIN_NAME: usize = 10;

/// Width and colours of the screen.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pen {
    /// Number of columns of the screen.
    pub width: usize,
    /// True if it shows colours.
    pub colour: bool,
}

/// Colour or weight of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paint {
    /// Plain text.
    Plain,
    /// Headings.
    Bold,
    /// Less important text.
    Dim,
    /// Good result.
    Green,
    /// Bad result.
    Red,
    /// Undecided result.
    Yellow,
    /// Titles of works, and emphasised words.
    Italic,
    /// Names, settings and code.
    Cyan,
}

impl Pen {
    /// Returns the text in a colour, if the screen shows colours.
    pub fn paint(self, paint: Paint, text: &str) -> String {
        let code = match paint {
            Paint::Plain => return text.to_owned(),
            Paint::Bold => "1",
            Paint::Dim => "2",
            Paint::Green => "32",
            Paint::Red => "1;31",
            Paint::Yellow => "33",
            Paint::Italic => "3",
            Paint::Cyan => "36",
        };
        if self.colour { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_owned() }
    }

    /// Adds text in lines as wide as the screen.
    pub fn say(self, text: &mut String, paint: Paint, what: &str) {
        for line in wrapped(what, self.width) {
            let _ = writeln!(text, "{}", self.paint(paint, &line));
        }
    }

    /// Adds indented text, with its first word painted; its further lines are indented more.
    pub fn note(self, text: &mut String, what: &str, (word, paint): (&str, Paint)) {
        for (i, line) in wrapped(what, self.width - 4).into_iter().enumerate() {
            // The word is coloured after the text is wrapped, for colours have no width.
            let line = match line.strip_prefix(word).filter(|_| i == 0) {
                Some(rest) => format!("{}{rest}", self.paint(paint, word)),
                None => line,
            };
            let _ = writeln!(text, "{}{line}", if i == 0 { "  " } else { "    " });
        }
    }

    /// Adds a name with its title, on one line.
    pub fn heading(self, text: &mut String, name: &str, title: &str) {
        let name = end_elided(name, self.width);
        let room = self.width.saturating_sub(width(&name) + 2);
        let title = if room > 8 { end_elided(title, room) } else { String::new() };
        let _ = writeln!(text, "{}  {title}", self.paint(Paint::Bold, &name));
    }
}

/// Field of a table.
#[derive(Debug, Clone)]
pub struct LayoutField {
    /// Text.
    pub text: String,
    /// Colour.
    pub paint: Paint,
}

impl LayoutField {
    /// Returns a field without colour.
    pub fn plain(text: String) -> Self {
        Self { text, paint: Paint::Plain }
    }

    /// Returns a word in green or red.
    pub fn judged(is_good: bool, [good, bad]: [&str; 2]) -> Self {
        let (text, paint) = if is_good { (good, Paint::Green) } else { (bad, Paint::Red) };
        Self { text: text.to_owned(), paint }
    }
}

/// Column of a table.
#[derive(Debug, Clone)]
pub struct Column {
    /// Heading.
    pub head: &'static str,
    /// True if its fields are aligned to the right, as numbers are.
    pub right: bool,
    /// Rank: columns of the highest rank are dropped first; rank 0 stays.
    pub rank: u8,
    /// Fields, one per row.
    pub fields: Vec<LayoutField>,
}

impl Column {
    /// Makes a column of texts of rows.
    pub fn of<'a, T: 'a>(
        rows: impl IntoIterator<Item = &'a T>,
        (head, right, rank): (&'static str, bool, u8),
        text: impl Fn(&'a T) -> String,
    ) -> Self {
        let fields = rows.into_iter().map(|row| LayoutField::plain(text(row))).collect();
        Self { head, right, rank, fields }
    }

    fn width(&self) -> usize {
        let fields = self.fields.iter().map(|field| width(&field.text)).max().unwrap_or(0);
        fields.max(width(self.head))
    }

    /// Marks unknown fields, if the column has known ones.
    fn fill(&mut self) {
        for field in self.fields.iter_mut().filter(|field| field.text.is_empty()) {
            *field = LayoutField { text: "–".to_owned(), paint: Paint::Dim };
        }
    }
}

/// Table.
#[derive(Debug, Clone)]
pub struct TableLayout {
    /// Columns; the first holds the names.
    pub columns: Vec<Column>,
}

impl TableLayout {
    /// Returns the width of its lines.
    pub fn width(&self) -> usize {
        let gaps = GAP.len() * self.columns.len().saturating_sub(1);
        self.columns.iter().map(Column::width).sum::<usize>() + gaps
    }

    /// Makes it fit: shortens names somewhat, then drops columns, then shortens names further. Returns the headings of the
    /// dropped columns.
    pub fn fit(&mut self, width: usize) -> Vec<&'static str> {
        let mut dropped = Vec::new();
        self.columns.retain(|column| column.fields.iter().any(|field| !field.text.is_empty()));
        self.shorten(width, USUAL_NAME);
        while self.width() > width {
            let ranks = self.columns.iter().map(|column| column.rank);
            let Some(highest) = ranks.max().filter(|&rank| rank > 0) else { break };
            let leaving = self.columns.iter().filter(|column| column.rank == highest);
            dropped.extend(leaving.map(|column| column.head));
            self.columns.retain(|column| column.rank != highest);
        }
        self.shorten(width, MIN_NAME);
        self.columns.iter_mut().for_each(Column::fill);
        dropped
    }

    fn shorten(&mut self, limit: usize, minimum: usize) {
        let excess = self.width().saturating_sub(limit);
        if let Some(names) = self.columns.first_mut().filter(|_| excess > 0) {
            let room = names.width().saturating_sub(excess).max(minimum);
            for field in &mut names.fields {
                field.text = middle_elided(&field.text, room);
            }
        }
    }

    /// Adds a column of words at the right.
    pub fn push(&mut self, head: &'static str, fields: Vec<LayoutField>) {
        self.columns.push(Column { head, right: false, rank: 0, fields });
    }

    /// Returns the lines, with headings.
    pub fn render(&self, pen: Pen) -> String {
        let rows = self.columns.iter().map(|column| column.fields.len()).max().unwrap_or(0);
        let widths: Vec<usize> = self.columns.iter().map(Column::width).collect();
        let mut text = String::new();
        let mut line = |field: &dyn Fn(&Column) -> LayoutField| {
            let mut line = String::new();
            for (i, (column, &wide)) in self.columns.iter().zip(&widths).enumerate() {
                let field = field(column);
                let pad = " ".repeat(wide.saturating_sub(width(&field.text)));
                let shown = pen.paint(field.paint, &field.text);
                line.push_str(if i == 0 { "" } else { GAP });
                line.push_str(&if column.right { pad + &shown } else { shown + &pad });
            }
            text.push_str(line.trim_end());
            text.push('\n');
        };
        line(&|column| LayoutField { text: column.head.to_owned(), paint: Paint::Dim });
        for row in 0..rows {
            line(&|column| {
                let field = column.fields.get(row).cloned();
                field.unwrap_or_else(|| LayoutField::plain(String::new()))
            });
        }
        text
    }
}

/// Returns columns that all stay, in as many tables as needed, one below the other, each with the names.
pub fn blocks(names: Vec<Column>, mut rest: Vec<Column>, width: usize) -> Vec<TableLayout> {
    rest.retain(|column| column.fields.iter().any(|field| !field.text.is_empty()));
    rest.iter_mut().for_each(Column::fill);
    let widest = rest.iter().map(Column::width).max().unwrap_or(0);
    let mut names = TableLayout { columns: names };
    names.fit(width.saturating_sub(widest + GAP.len()));
    let mut blocks = vec![names.clone()];
    for column in rest {
        let last = blocks.len() - 1;
        let is_fresh = blocks[last].columns.len() == names.columns.len();
        if !is_fresh && blocks[last].width() + GAP.len() + column.width() > width {
            blocks.push(names.clone());
        }
        let last = blocks.len() - 1;
        blocks[last].columns.push(column);
    }
    blocks
}

/// Returns the number of columns of the screen that a text takes.
pub fn width(text: &str) -> usize {
    text.width()
}

/// Returns the text cut at its end to a width, with an ellipsis.
pub fn end_elided(text: &str, room: usize) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    let kept = head(text, room.saturating_sub(1));
    format!("{}…", kept.trim_end())
}

/// Returns the text with its middle cut out, so that its beginning and its end stay readable.
pub fn middle_elided(text: &str, room: usize) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    let room = room.saturating_sub(1);
    let front = head(text, room.div_ceil(2));
    let reversed: String = text.chars().rev().collect();
    let back: String = head(&reversed, room / 2).chars().rev().collect();
    format!("{front}…{back}")
}

fn head(text: &str, room: usize) -> String {
    let mut used = 0;
    let fits = |c: &char| {
        used += c.width().unwrap_or(0);
        used <= room
    };
    text.chars().take_while(fits).collect()
}

/// Returns the text in lines of at most this width, broken between words.
pub fn wrapped(text: &str, room: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let line = &mut lines[last];
        if line.is_empty() {
            line.push_str(word);
        } else if width(line) + 1 + width(word) <= room {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elision_keeps_to_the_width() {
        assert_eq!(middle_elided("single(non-terminating)", 11), "singl…ting)");
        assert_eq!(end_elided("a reason with words", 9), "a reason…");
        assert_eq!(width("σ\u{302}"), 1);
    }

    #[test]
    fn columns_leave_by_rank() {
        let column = |head, rank, text: &str| Column {
            head,
            right: true,
            rank,
            fields: vec![LayoutField::plain(text.to_owned())],
        };
        let mut grid = TableLayout {
            columns: vec![column("name", 0, "x"), column("b", 2, "12345678"), column("c", 1, "1")],
        };
        assert_eq!(grid.fit(12), ["b"]);
        let heads: Vec<_> = grid.columns.iter().map(|column| column.head).collect();
        assert_eq!(heads, ["name", "c"]);
    }

    #[test]
    fn words_are_never_broken() {
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
    }
}
