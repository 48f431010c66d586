//! Numbers of a fixed width in rows, of which some columns are read.

use super::ForeignError;
use super::raw::Words;

/// Rows of numbers.
pub(super) struct Rows {
    words: Words,
    /// Number of numbers in a row.
    width: usize,
    /// The columns that are read.
    places: Vec<usize>,
    /// Numbers that were read and not yet given.
    row: Vec<f64>,
    /// Whether whole columns follow each other: then all numbers are read first.
    by_column: bool,
    /// All numbers, where whole columns follow each other, and how many rows of them were given.
    all: Option<(Vec<f64>, usize)>,
    /// Number of numbers that were read.
    numbers: u64,
}

impl Rows {
    pub(super) fn new(mut words: Words, width: usize, places: Vec<usize>, by_column: bool) -> Self {
        words.width = width as u64;
        Self { words, width, places, row: Vec::new(), by_column, all: None, numbers: 0 }
    }

    /// Number of rows, where it is known.
    pub(super) fn known_length(&self) -> Option<u64> {
        self.words.known_length().map(|numbers| numbers / self.width as u64)
    }

    /// Number of values of a draw.
    pub(super) fn values(&self) -> usize {
        self.places.len()
    }

    /// Appends the next draws to the columns, `at_most` of them.
    pub(super) fn read(
        &mut self,
        columns: &mut [Vec<f64>],
        at_most: usize,
    ) -> Result<(), ForeignError> {
        if let ([column], 1) = (&mut *columns, self.width) {
            return self.words.read(column, at_most);
        }
        if self.by_column {
            return self.read_by_column(columns, at_most);
        }
        self.row.clear();
        self.words.read(&mut self.row, at_most.saturating_mul(self.width))?;
        self.numbers += self.row.len() as u64;
        if !self.row.len().is_multiple_of(self.width) {
            return Err(self.words.partial_row(self.numbers, self.width));
        }
        for row in self.row.chunks_exact(self.width) {
            for (column, &place) in columns.iter_mut().zip(&self.places) {
                column.push(row[place]);
            }
        }
        Ok(())
    }

    fn read_by_column(
        &mut self,
        columns: &mut [Vec<f64>],
        at_most: usize,
    ) -> Result<(), ForeignError> {
        let (all, given) = match &mut self.all {
            Some((all, given)) => (all, given),
            none => {
                let mut all = Vec::new();
                self.words.read(&mut all, usize::MAX)?;
                // A second look finds what is missing, or what is too much.
                self.words.read(&mut Vec::new(), usize::MAX)?;
                let (all, given) = none.insert((all, 0));
                (all, given)
            }
        };
        let rows = all.len() / self.width;
        let count = at_most.min(rows - *given);
        for (column, &place) in columns.iter_mut().zip(&self.places) {
            let first = place * rows + *given;
            column.extend_from_slice(&all[first..first + count]);
        }
        *given += count;
        Ok(())
    }
}
