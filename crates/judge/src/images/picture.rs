//! Pictures and stacks of them: numbers in rows from the top, each pixel with all its channels.

use std::num::NonZeroUsize;

use super::claim::ImageError;
use serde::Serialize;

/// Size of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Size {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Number of values of a pixel.
    pub channels: usize,
}

impl Size {
    /// Returns the number of pixels.
    pub fn pixels(self) -> usize {
        self.rows * self.columns
    }

    /// Returns the number of values.
    pub fn values(self) -> usize {
        self.pixels() * self.channels
    }

    /// Returns row, column and channel of a value, each from 0.
    pub(super) fn place(self, index: usize) -> [usize; 3] {
        let (pixel, channel) = (index / self.channels, index % self.channels);
        [pixel / self.columns, pixel % self.columns, channel]
    }
}

/// Returns averages of blocks of `block` × `block` pixels, smaller ones at the right and at the foot.
fn averages(size: Size, values: &[f64], block: usize) -> (Size, Vec<f64>) {
    let (rows, columns) = (size.rows.div_ceil(block), size.columns.div_ceil(block));
    let actual = Size { rows, columns, channels: size.channels };
    let span = |first: usize, length: usize| first * block..((first + 1) * block).min(length);
    let mut averages = Vec::with_capacity(actual.values());
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let (down, across) = (span(row, size.rows), span(column, size.columns));
        let count = (down.len() * across.len()) as f64;
        for channel in 0..size.channels {
            let of = |row: usize, column: usize| {
                values[(row * size.columns + column) * size.channels + channel]
            };
            let sum: f64 = down
                .clone()
                .flat_map(|row| across.clone().map(move |column| (row, column)))
                .map(|(row, column)| of(row, column))
                .sum();
            averages.push(sum / count);
        }
    }
    (actual, averages)
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { rows, columns, channels } = *self;
        write!(f, "{rows} × {columns} pixels")?;
        if channels > 1 { write!(f, " of {channels} channels") } else { Ok(()) }
    }
}

/// Picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub(super) size: Size,
    pub(super) values: Vec<f64>,
    /// Relative rounding error of the format that the values were stored in.
    pub(super) rounding: f64,
}

impl Picture {
    /// Makes a picture from values in rows from the top, each pixel with its channels one after the other.
    ///
    /// # Errors
    ///
    /// There are no values, or their number is not that of the size.
    pub fn new(size: Size, values: Vec<f64>) -> Result<Self, ImageError> {
        if values.is_empty() || values.len() != size.values() {
            let (expected, actual) = (size, values.len());
            return Err(ImageError::Count { expected, passes: 1, actual });
        }
        Ok(Self { size, values, rounding: 0.0 })
    }

    /// Returns the averages of blocks of `block` × `block` pixels; those at the right and at the foot may be smaller.
    #[must_use]
    pub fn averaged(&self, block: NonZeroUsize) -> Self {
        let (size, values) = averages(self.size, &self.values, block.get());
        Self { size, values, rounding: self.rounding }
    }

    /// Returns the size.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Returns the values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }
}

/// Passes: independent renders of one picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Stack {
    pub(super) size: Size,
    pub(super) passes: usize,
    pub(super) values: Vec<f64>,
    pub(super) rounding: f64,
}

impl Stack {
    /// Takes passes one after the other, each in the order of a [`Picture`].
    ///
    /// # Errors
    ///
    /// There are fewer than two passes or no values, or the number of values is not that of the size.
    pub fn new(passes: usize, size: Size, values: Vec<f64>) -> Result<Self, ImageError> {
        if values.is_empty() || Some(values.len()) != passes.checked_mul(size.values()) {
            return Err(ImageError::Count { expected: size, passes, actual: values.len() });
        }
        if passes < 2 {
            return Err(ImageError::OnePass);
        }
        Ok(Self { size, passes, values, rounding: 0.0 })
    }

    /// Returns passes of averages of blocks of `block` × `block` pixels. If a filter blends pixels, averages of blocks
    /// wider than it are nearly independent of each other, as pixels are without it.
    #[must_use]
    pub fn averaged(&self, block: NonZeroUsize) -> Self {
        let (size, passes, rounding) = (self.size, self.passes, self.rounding);
        let of = |pass: usize| averages(size, self.pass(pass), block.get());
        let values = (0..passes).flat_map(|pass| of(pass).1).collect();
        Self { size: averages(size, self.pass(0), block.get()).0, passes, values, rounding }
    }

    /// Returns the size of each pass.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Returns the number of passes.
    pub fn passes(&self) -> usize {
        self.passes
    }

    /// Returns one pass.
    pub(super) fn pass(&self, pass: usize) -> &[f64] {
        let length = self.size.values();
        &self.values[pass * length..(pass + 1) * length]
    }

    /// Returns a value in all passes.
    fn all(&self, index: usize) -> impl Iterator<Item = f64> {
        (0..self.passes).map(move |pass| self.pass(pass)[index])
    }

    /// Returns the mean of a value over the passes.
    pub(super) fn mean(&self, index: usize) -> f64 {
        self.all(index).sum::<f64>() / self.passes as f64
    }

    /// Returns the sample variance of a value over the passes.
    pub(super) fn variance(&self, index: usize) -> f64 {
        let mean = self.mean(index);
        self.all(index).map(|x| (x - mean).powi(2)).sum::<f64>() / (self.passes as f64 - 1.0)
    }

    /// Returns the sum of a pixel's channels in a pass.
    pub(super) fn grey(&self, pass: usize, pixel: usize) -> f64 {
        let channels = self.size.channels;
        self.pass(pass)[pixel * channels..(pixel + 1) * channels].iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_averaged_each_channel_by_itself() {
        let size = Size { rows: 2, columns: 3, channels: 2 };
        let values: Vec<f64> = (0..24).map(f64::from).collect();
        let stack = Stack::new(2, size, values).expect("a stack");
        let block = NonZeroUsize::new(2).expect("two");
        let actual = stack.averaged(block);
        assert_eq!(actual.size(), Size { rows: 1, columns: 2, channels: 2 });
        // (0 + 2 + 6 + 8)/4, each channel one more; then the last column, (4 + 10)/2; the second pass has 12 more.
        assert_eq!(actual.values, [4.0, 5.0, 7.0, 8.0, 16.0, 17.0, 19.0, 20.0]);
    }
}
