//! Real numbers of every width, as arrays store them.

use exr::prelude::f16;

/// A number's type, width and byte order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NumberType {
    kind: NumberKind,
    width: usize,
    is_big: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum NumberKind {
    Float,
    Signed,
    Unsigned,
}

impl NumberType {
    /// The number of an element type of `NumPy`, such as `<f4`, `>i2` or `|u1`; booleans are 0 and 1.
    pub fn named(name: &str) -> Option<Self> {
        let mut letters = name.chars();
        let order = letters.next()?;
        let (kind, width) = (letters.next()?, letters.as_str().parse::<usize>().ok()?);
        let kind = match (kind, width) {
            ('f', 2 | 4 | 8) => NumberKind::Float,
            ('i', 1 | 2 | 4 | 8) => NumberKind::Signed,
            ('u', 1 | 2 | 4 | 8) | ('b', 1) => NumberKind::Unsigned,
            _ => return None,
        };
        match order {
            '<' | '=' => Some(Self { kind, width, is_big: false }),
            '>' => Some(Self { kind, width, is_big: true }),
            '|' if width == 1 => Some(Self { kind, width, is_big: false }),
            _ => None,
        }
    }

    /// The number of an element type that is a float of 4 or 8 bytes.
    pub fn float(name: &str) -> Option<Self> {
        Self::named(name).filter(|number| number.kind == NumberKind::Float && number.width > 2)
    }

    /// A float of a width, with its low or its high byte first.
    pub const fn of_width(width: usize, is_big: bool) -> Self {
        Self { kind: NumberKind::Float, width, is_big }
    }

    /// Bytes.
    pub fn width(self) -> usize {
        self.width
    }

    /// The numbers in complete words of bytes. Integers beyond 2⁵³ are rounded.
    pub fn all(self, bytes: &[u8]) -> Vec<f64> {
        let mut numbers = Vec::with_capacity(bytes.len() / self.width);
        self.convert(bytes, &mut numbers);
        numbers
    }

    /// Appends the numbers in complete words of bytes.
    pub fn convert(self, bytes: &[u8], numbers: &mut Vec<f64>) {
        let doubles = bytes.as_chunks().0.iter();
        let singles = bytes.as_chunks().0.iter();
        match (self.kind, self.width, self.is_big) {
            (NumberKind::Float, 8, false) => {
                numbers.extend(doubles.map(|&word| f64::from_le_bytes(word)));
            }
            (NumberKind::Float, 8, true) => {
                numbers.extend(doubles.map(|&word| f64::from_be_bytes(word)));
            }
            (NumberKind::Float, 4, false) => {
                numbers.extend(singles.map(|&word| f64::from(f32::from_le_bytes(word))));
            }
            (NumberKind::Float, 4, true) => {
                numbers.extend(singles.map(|&word| f64::from(f32::from_be_bytes(word))));
            }
            _ => numbers.extend(bytes.chunks_exact(self.width).map(|word| self.one(word))),
        }
    }

    fn one(self, word: &[u8]) -> f64 {
        // High bytes first, so that a number is the end of its word.
        let mut bits = 0_u64;
        for place in 0..self.width {
            let byte = if self.is_big { word[place] } else { word[self.width - 1 - place] };
            bits = bits << 8 | u64::from(byte);
        }
        let unused = 64 - 8 * u32::try_from(self.width).unwrap_or(8);
        #[expect(clippy::cast_possible_truncation)] // wider floats are converted before
        match self.kind {
            NumberKind::Float => f16::from_bits(bits as u16).to_f64(),
            NumberKind::Signed => ((bits << unused).cast_signed() >> unused) as f64,
            NumberKind::Unsigned => bits as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type_are_read() {
        for (name, bytes, value) in [
            ("<f2", &[0x00, 0x3c][..], 1.0),
            (">f2", &[0xc0, 0x00], -2.0),
            ("<f4", &1.5_f32.to_le_bytes(), 1.5),
            (">f4", &1.5_f32.to_be_bytes(), 1.5),
            ("<f8", &(-0.1_f64).to_le_bytes(), -0.1),
            (">f8", &(-0.1_f64).to_be_bytes(), -0.1),
            ("|u1", &[255], 255.0),
            ("|i1", &[255], -1.0),
            ("|b1", &[1], 1.0),
            ("<i2", &[0xfe, 0xff], -2.0),
            (">u2", &[1, 2], 258.0),
            ("<i4", &(-7_i32).to_le_bytes(), -7.0),
            (">u4", &u32::MAX.to_be_bytes(), 4_294_967_295.0),
            ("<i8", &i64::MIN.to_le_bytes(), -9_223_372_036_854_775_808.0),
            ("<u8", &u64::MAX.to_le_bytes(), 18_446_744_073_709_551_615.0),
        ] {
            let number = NumberType::named(name).expect(name);
            assert_eq!((number.width(), number.all(bytes)), (bytes.len(), vec![value]), "{name}");
        }
        for name in
            ["", "<", "<f", "<f3", "<c16", "|f4", "<U1", "f4", "<f16", "[('a', '<f8')]", "|O"]
        {
            assert_eq!(NumberType::named(name), None, "{name}");
        }
    }
}
