//! Pictures and stacks of them: numbers in rows from the top, each pixel with all its channels.

use super::error::ImageError;

/// How large a picture is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct Size {
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub columns: usize,
    /// Values of a pixel.
    pub channels: usize,
}

impl Size {
    /// How many pixels there are.
    pub fn pixels(self) -> usize {
        self.rows * self.columns
    }

    /// How many values there are.
    pub fn values(self) -> usize {
        self.pixels() * self.channels
    }
}

impl std::fmt::Display for Size {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { rows, columns, channels } = *self;
        write!(f, "{rows} × {columns} pixels")?;
        if channels > 1 { write!(f, " of {channels} channels") } else { Ok(()) }
    }
}

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub(super) size: Size,
    pub(super) values: Vec<f64>,
    /// The relative rounding of the format that the values were stored in.
    pub(super) rounding: f64,
}

impl Picture {
    /// A picture of values in rows from the top, each pixel with its channels one after the other.
    ///
    /// # Errors
    ///
    /// The values are none, or not as many as the size says.
    pub fn new(size: Size, values: Vec<f64>) -> Result<Self, ImageError> {
        if values.is_empty() || values.len() != size.values() {
            let (expected, found) = (size, values.len());
            return Err(ImageError::Count { expected, passes: 1, found });
        }
        Ok(Self { size, values, rounding: 0.0 })
    }

    /// How large it is.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Its values.
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
    /// Passes one after the other, each in the order of a [`Picture`].
    ///
    /// # Errors
    ///
    /// There are fewer than two passes, or the values are none or not as many as the size says.
    pub fn new(passes: usize, size: Size, values: Vec<f64>) -> Result<Self, ImageError> {
        if values.is_empty() || Some(values.len()) != passes.checked_mul(size.values()) {
            return Err(ImageError::Count { expected: size, passes, found: values.len() });
        }
        if passes < 2 {
            return Err(ImageError::OnePass);
        }
        Ok(Self { size, passes, values, rounding: 0.0 })
    }

    /// How large each pass is.
    pub fn size(&self) -> Size {
        self.size
    }

    /// How many passes there are.
    pub fn passes(&self) -> usize {
        self.passes
    }

    /// One pass.
    pub(super) fn pass(&self, pass: usize) -> &[f64] {
        let length = self.size.values();
        &self.values[pass * length..(pass + 1) * length]
    }

    /// The sum of a pixel's channels in a pass.
    pub(super) fn grey(&self, pass: usize, pixel: usize) -> f64 {
        let channels = self.size.channels;
        self.pass(pass)[pixel * channels..(pixel + 1) * channels].iter().sum()
    }
}
