//! Numbers of a row that are a draw.
//!
//! ```text
//! no case, or a case of one channel   the only column, or the one that is chosen
//! a case of k channels                k columns, or k − 1 without the luminance: by the names of a table's first line,
//!                                     where these are the channels', else in the order of the channels
//! one channel of such a case          its column, or the only one
//! ```

use super::{Column, ForeignError};

/// Columns of a draw.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layout {
    /// Column that is read, if one was chosen.
    pub column: Option<Column>,
    /// Names of a draw's channels, if it has several.
    pub channels: Vec<String>,
    /// Number of channels at the end that may be missing.
    pub derived: usize,
    /// Index of the channel that is read, if one was chosen.
    pub channel: Option<usize>,
}

impl Layout {
    /// Returns the layout of one column, the only one if none is chosen.
    pub fn column(column: Option<Column>) -> Self {
        Self { column, ..Self::default() }
    }

    /// Returns whether all channels of a draw are read.
    pub(super) fn takes_all(&self) -> bool {
        self.channels.len() > 1 && self.channel.is_none() && self.column.is_none()
    }

    /// Returns whether the number of columns is that of a draw's channels.
    fn fits(&self, width: usize) -> bool {
        let all = self.channels.len();
        all > 1 && (all - self.derived..=all).contains(&width)
    }

    /// Returns the possible numbers of columns of a draw with all its channels, in words.
    pub(super) fn widths(&self) -> String {
        let all = self.channels.len();
        match self.channels.last() {
            Some(last) if self.derived == 1 => {
                format!("{all} values, or {} without the {last}", all - 1)
            }
            _ => format!("{all} values"),
        }
    }

    /// Returns the indices of a draw's values in a row of `width` numbers without names; `none` is the error of an open
    /// choice.
    pub(super) fn places(
        &self,
        file: &str,
        width: usize,
        none: impl FnOnce() -> ForeignError,
    ) -> Result<Vec<usize>, ForeignError> {
        match (&self.column, self.channel) {
            (Some(Column::Index(index)), _) if *index < width => Ok(vec![*index]),
            (Some(column), _) => {
                let (file, column) = (file.to_owned(), column.clone());
                let columns = (0..width.min(super::csv::LISTED)).map(|k| k.to_string()).collect();
                Err(ForeignError::NoColumn { file, column, columns })
            }
            (None, Some(_)) if width == 1 => Ok(vec![0]),
            (None, Some(channel)) if self.fits(width) && channel < width => Ok(vec![channel]),
            (None, None) if self.fits(width) => Ok((0..width).collect()),
            (None, None) if width == 1 && self.channels.len() < 2 => Ok(vec![0]),
            (None, _) if self.channels.len() > 1 => Err(self.mismatch(file, width)),
            (None, _) => Err(none()),
        }
    }

    /// Returns the indices in a row with a first line of names; `None` if it does not name the channels.
    pub(super) fn named(&self, names: &[String]) -> Option<Vec<usize>> {
        let of = |channel: &String| names.iter().position(|name| name == channel);
        if let Some(channel) = self.channel {
            return of(&self.channels[channel]).map(|place| vec![place]);
        }
        let all = self.channels.len();
        let actual =
            |count: usize| self.channels[..count].iter().map(of).collect::<Option<Vec<_>>>();
        (all - self.derived..=all).rev().find_map(actual).filter(|places| !places.is_empty())
    }

    /// Returns the error of rows with another number of columns than the case has channels.
    pub(super) fn mismatch(&self, file: &str, actual: usize) -> ForeignError {
        let channels = self.channels.join(", ");
        ForeignError::Channels { file: file.to_owned(), actual, channels, required: self.widths() }
    }
}
