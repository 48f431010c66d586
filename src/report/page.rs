//! Manual page on a terminal: Markdown with headings, emphasis, lists and tables, wrapped to the width.

use std::fmt::Write;

use pulldown_cmark::{BrokenLink, CowStr, Event, Options, Parser, Tag, TagEnd};

use super::layout::{Paint, Pen, width};

/// Number of spaces in front of code.
const CODE: usize = 4;
/// Number of spaces between the columns of a table.
const GAP: usize = 2;
/// Smallest width of a column with wrapped words.
const MIN_WIDTH: usize = 8;

/// Letters without a space between them, in runs of one paint.
type Word = Vec<(Paint, String)>;

/// Returns the lines of a page without the signs of Markdown. Lines of code keep their length, all others fit.
pub fn rendered(markdown: &str, pen: Pen) -> String {
    let mut page = PageState { pen, ..PageState::default() };
    // Code in brackets is a link of rustdoc; other brackets are an interval, or a condition.
    let mut resolve = |link: BrokenLink| {
        link.reference.starts_with('`').then(|| (CowStr::from(""), CowStr::from("")))
    };
    let options = Options::ENABLE_TABLES;
    let parser = Parser::new_with_broken_link_callback(markdown, options, Some(&mut resolve));
    for event in parser {
        page.read(event);
    }
    page.text
}

/// State of reading: open lists, paints and words, and the lines so far.
#[derive(Default)]
struct PageState {
    pen: Pen,
    text: String,
    /// Words of the paragraph, heading, item or cell that is being read.
    words: Vec<Word>,
    /// True if the next letters belong to the last word.
    is_glued: bool,
    paints: Vec<Paint>,
    /// For each open list the number of its next item; `None` for bullets.
    lists: Vec<Option<u64>>,
    /// Bullet or number before the next line.
    bullet: String,
    in_code: bool,
    /// Rows of the table that is being read; the first one is its head.
    rows: Vec<Vec<Vec<Word>>>,
}

impl PageState {
    fn read(&mut self, event: Event) {
        match event {
            Event::Start(tag) => self.open(&tag),
            Event::End(tag) => self.close(tag),
            Event::Text(text) if self.in_code => self.code(&text),
            Event::Text(text) | Event::Html(text) | Event::InlineHtml(text) => self.add(&text),
            Event::Code(text) => {
                self.paints.push(Paint::Cyan);
                self.add(&text);
                self.paints.pop();
            }
            Event::SoftBreak | Event::HardBreak => self.is_glued = false,
            _ => {}
        }
    }

    fn open(&mut self, tag: &Tag) {
        match tag {
            Tag::Heading { .. } | Tag::Strong | Tag::TableHead => self.paints.push(Paint::Bold),
            Tag::Emphasis => self.paints.push(Paint::Italic),
            Tag::CodeBlock(_) => {
                self.gap();
                self.in_code = true;
            }
            Tag::List(first) => {
                self.flush();
                self.lists.push(*first);
                self.gap();
            }
            Tag::Item => self.bullet = self.next_bullet(),
            _ => {}
        }
        if matches!(tag, Tag::TableHead | Tag::TableRow) {
            self.rows.push(Vec::new());
        }
    }

    fn close(&mut self, tag: TagEnd) {
        match tag {
            TagEnd::Paragraph | TagEnd::Heading(_) | TagEnd::Item => self.flush(),
            TagEnd::List(_) => drop(self.lists.pop()),
            TagEnd::CodeBlock => self.in_code = false,
            TagEnd::TableCell => {
                let words = std::mem::take(&mut self.words);
                self.is_glued = false;
                self.rows.last_mut().into_iter().for_each(|row| row.push(words.clone()));
            }
            TagEnd::Table => self.table(),
            _ => {}
        }
        if matches!(tag, TagEnd::Heading(_) | TagEnd::Strong | TagEnd::TableHead | TagEnd::Emphasis)
        {
            self.paints.pop();
        }
    }

    fn next_bullet(&mut self) -> String {
        let indent = " ".repeat(2 * self.lists.len().saturating_sub(1));
        match self.lists.last_mut() {
            Some(Some(number)) => {
                *number += 1;
                format!("{indent}{}. ", *number - 1)
            }
            _ => format!("{indent}• "),
        }
    }

    /// Adds text to the words, in the paint that is on.
    fn add(&mut self, text: &str) {
        let paint = self.paints.last().copied().unwrap_or(Paint::Plain);
        for (i, part) in text.split(char::is_whitespace).enumerate() {
            self.is_glued &= i == 0;
            if part.is_empty() {
                continue;
            }
            let run = (paint, part.to_owned());
            match self.words.last_mut().filter(|_| self.is_glued) {
                Some(word) => word.push(run),
                None => self.words.push(vec![run]),
            }
            self.is_glued = true;
        }
    }

    /// Adds an empty line before a block, but not before the first one or between the items of a list.
    fn gap(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with("\n\n") {
            self.text.push('\n');
        }
    }

    /// Writes the words as a paragraph.
    fn flush(&mut self) {
        self.is_glued = false;
        if self.words.is_empty() {
            return;
        }
        let words = std::mem::take(&mut self.words);
        let first = std::mem::take(&mut self.bullet);
        if self.lists.is_empty() {
            self.gap();
        }
        let hanging =
            if self.lists.is_empty() { 0 } else { 2 * self.lists.len() }.max(width(&first));
        for (i, line) in lines(&words, self.pen.width.saturating_sub(hanging)).iter().enumerate() {
            let before =
                if i == 0 && !first.is_empty() { first.clone() } else { " ".repeat(hanging) };
            let _ = writeln!(self.text, "{before}{}", painted(line, self.pen));
        }
    }

    fn code(&mut self, text: &str) {
        for line in text.lines() {
            let line = format!("{}{}", " ".repeat(CODE), line.replace('`', ""));
            let _ = writeln!(self.text, "{}", line.trim_end());
        }
    }

    /// Writes the rows of a table, in columns that fit together.
    fn table(&mut self) {
        let rows = std::mem::take(&mut self.rows);
        self.gap();
        let widths = widths(&rows, self.pen.width);
        for row in &rows {
            let cells: Vec<_> =
                row.iter().zip(&widths).map(|(words, &wide)| lines(words, wide)).collect();
            for at in 0..cells.iter().map(Vec::len).max().unwrap_or(0) {
                let mut shown = String::new();
                let mut missing = 0;
                for (cell, &wide) in cells.iter().zip(&widths) {
                    let line: &[Word] = cell.get(at).map_or(&[], Vec::as_slice);
                    let _ = write!(shown, "{}{}", " ".repeat(missing), painted(line, self.pen));
                    missing = wide + GAP - length(line).min(wide);
                }
                let _ = writeln!(self.text, "{shown}");
            }
        }
    }
}

/// Returns widths of columns that fit a page together: the widest become narrower first.
fn widths(rows: &[Vec<Vec<Word>>], room: usize) -> Vec<usize> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let natural =
        |at: usize| rows.iter().filter_map(|row| row.get(at)).map(|cell| length(cell)).max();
    let mut widths: Vec<usize> = (0..columns).map(|at| natural(at).unwrap_or(0)).collect();
    let room = room.saturating_sub(GAP * columns.saturating_sub(1));
    while widths.iter().sum::<usize>() > room {
        match widths.iter_mut().max() {
            Some(widest) if *widest > MIN_WIDTH => *widest -= 1,
            _ => break,
        }
    }
    widths
}

/// Returns the words in lines of at most this width, broken between words.
fn lines(words: &[Word], room: usize) -> Vec<Vec<Word>> {
    let mut lines: Vec<Vec<Word>> = vec![Vec::new()];
    for word in words {
        let fits = |line: &Vec<Word>| {
            line.is_empty() || length(line) + 1 + length(std::slice::from_ref(word)) <= room
        };
        match lines.last_mut().filter(|line| fits(line)) {
            Some(line) => line.push(word.clone()),
            None => lines.push(vec![word.clone()]),
        }
    }
    lines
}

/// Returns the width of words with a space between any two.
fn length(words: &[Word]) -> usize {
    let letters = words.iter().flatten().map(|(_, text)| width(text)).sum::<usize>();
    letters + words.len().saturating_sub(1)
}

/// Returns the words with a space between any two, which is painted like the words on both sides if these are alike.
fn painted(words: &[Word], pen: Pen) -> String {
    let mut runs: Vec<(Paint, String)> = Vec::new();
    for (i, word) in words.iter().enumerate() {
        for (k, (paint, letters)) in word.iter().enumerate() {
            let space = if i > 0 && k == 0 { " " } else { "" };
            match runs.last_mut() {
                Some((last, text)) if last == paint => {
                    text.push_str(space);
                    text.push_str(letters);
                }
                Some((Paint::Plain, text)) => {
                    text.push_str(space);
                    runs.push((*paint, letters.clone()));
                }
                Some(_) if *paint != Paint::Plain => {
                    runs.extend([(Paint::Plain, space.to_owned()), (*paint, letters.clone())]);
                }
                _ => runs.push((*paint, format!("{space}{letters}"))),
            }
        }
    }
    runs.iter().map(|(paint, text)| pen.paint(*paint, text)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# Head\n\nA `name` and *a title*, [`link`] and σ_t in [0, 1]:\nlines of words.\n\n\
                        ```text\nX = 1   (of `name`)\n```\n\n- one item that is long\n- two\n\n\
                        | setting | meaning |\n|---|---|\n| `rule` | which **rule** of several |\n";

    fn lines_of(width: usize, colour: bool) -> String {
        rendered(PAGE, Pen { width, colour })
    }

    #[test]
    fn signs_of_markdown_are_gone_and_lines_fit() {
        let text = lines_of(24, false);
        let expected = "Head\n\nA name and a title, link\nand σ_t in [0, 1]: lines\nof words.\n\n    X = 1   (of name)\n\n\
                        • one item that is long\n• two\n\nsetting  meaning\nrule     which rule of\n         several\n";
        assert_eq!(text, expected);
        assert!(text.lines().all(|line| width(line) <= 24));
    }

    #[test]
    fn colours_stand_for_the_signs_and_have_no_width() {
        let text = lines_of(24, true);
        for painted in ["\x1b[1mHead\x1b[0m", "\x1b[36mname\x1b[0m", "\x1b[3ma title\x1b[0m,"] {
            assert!(text.contains(painted), "no {painted:?} in {text:?}");
        }
        let mut plain = text.clone();
        for code in ["\x1b[0m", "\x1b[1m", "\x1b[3m", "\x1b[36m"] {
            plain = plain.replace(code, "");
        }
        assert_eq!(plain, lines_of(24, false));
    }

    #[test]
    fn numbered_lists_count_and_long_words_stay_whole() {
        let text =
            rendered("1. one\n2. a-very-long-word-indeed\n", Pen { width: 12, colour: false });
        assert_eq!(text, "1. one\n2. a-very-long-word-indeed\n");
    }
}
