//! The words of a scene file.

use super::super::{Unreadable, shown, wrong};

/// A word with its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Word<'a> {
    /// A directive, or a number.
    Plain(&'a str),
    /// A text in quotes.
    Text(&'a str),
    /// `[`.
    Open,
    /// `]`.
    Close,
}

/// The words of a text, one after the other.
pub(super) struct Words<'a> {
    rest: &'a str,
    /// The line of the last word; the first is 1.
    pub(super) line: usize,
    peeked: Option<Word<'a>>,
}

impl<'a> Words<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, line: 1, peeked: None }
    }

    /// Returns the next word without consuming it; `None` at the end.
    pub(super) fn peek(&mut self) -> Result<Option<Word<'a>>, Unreadable> {
        if self.peeked.is_none() {
            self.peeked = self.read()?;
        }
        Ok(self.peeked)
    }

    /// Returns the next word; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<Word<'a>>, Unreadable> {
        match self.peeked.take() {
            Some(word) => Ok(Some(word)),
            None => self.read(),
        }
    }

    /// A fault in the line of the last word.
    pub(super) fn wrong<T>(&self, message: &str, help: &str) -> Result<T, Unreadable> {
        wrong(format!("line {}: {message}", self.line), help)
    }

    /// Takes a number of bytes.
    fn take(&mut self, count: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(count);
        self.line += taken.bytes().filter(|&byte| byte == b'\n').count();
        self.rest = rest;
        taken
    }

    fn read(&mut self) -> Result<Option<Word<'a>>, Unreadable> {
        loop {
            let blank = self.rest.len() - self.rest.trim_start().len();
            self.take(blank);
            if !self.rest.starts_with('#') {
                break;
            }
            self.take(self.rest.find('\n').unwrap_or(self.rest.len()));
        }
        Ok(Some(match self.rest.bytes().next() {
            None => return Ok(None),
            Some(b'[') => {
                self.take(1);
                Word::Open
            }
            Some(b']') => {
                self.take(1);
                Word::Close
            }
            Some(b'"') => {
                let Some(end) = self.rest[1..].find('"') else {
                    return self.wrong("a text does not end", "close it by a quotation mark");
                };
                let text = self.take(end + 2);
                Word::Text(&text[1..=end])
            }
            Some(_) => {
                let ends = |c: char| c.is_whitespace() || matches!(c, '[' | ']' | '"' | '#');
                let end = self.rest.find(ends).unwrap_or(self.rest.len());
                Word::Plain(self.take(end))
            }
        }))
    }

    /// The value of a parameter: a word, or those in brackets.
    pub(super) fn values(
        &mut self,
        mut take: impl FnMut(&Self, Word<'a>) -> Result<(), Unreadable>,
    ) -> Result<(), Unreadable> {
        match self.next()? {
            Some(Word::Open) => loop {
                match self.next()? {
                    Some(Word::Close) => return Ok(()),
                    Some(word) => take(self, word)?,
                    None => return self.wrong("a list does not end", "close it by `]`"),
                }
            },
            Some(word @ (Word::Plain(_) | Word::Text(_))) => take(self, word),
            _ => self.wrong("a parameter has no value", "give one, as in \"integer nx\" [ 64 ]"),
        }
    }

    /// The numbers of a parameter.
    pub(super) fn numbers(&mut self) -> Result<Vec<f64>, Unreadable> {
        let mut numbers = Vec::new();
        self.values(|words, word| {
            let number = match word {
                Word::Plain(text) => text.parse().ok(),
                _ => None,
            };
            match (number, word) {
                (Some(number), _) => numbers.push(number),
                (None, Word::Plain(text) | Word::Text(text)) => {
                    return words
                        .wrong(&format!("{} is not a number", shown(text)), "write it as 1.25e-3");
                }
                _ => return words.wrong("a list is within a list", "give numbers alone"),
            }
            Ok(())
        })?;
        Ok(numbers)
    }
}
