//! Portable float maps.
//!
//! ```text
//! Pf or PF, columns, rows, scale    words apart from each other by white space; one such byte after the last
//! 4 bytes a value                   little-endian where the scale is negative; rows from the BOTTOM
//! ```
//!
//! The absolute value of the scale has no agreed meaning: values are read as they are, and −1 is written.
//!
//! Source: P. Debevec, *PFM Portable `FloatMap` Image Format*.

use super::Pixels;
use super::number::NumberType;

/// The bytes of an image of one or three channels; its rows are given from the top.
pub fn write([columns, rows]: [usize; 2], channels: usize, image: &[f64]) -> Vec<u8> {
    let kind = if channels > 1 { "PF" } else { "Pf" };
    let mut bytes = format!("{kind}\n{columns} {rows}\n-1.0\n").into_bytes();
    for row in image.chunks_exact((columns * channels).max(1)).rev() {
        #[expect(clippy::cast_possible_truncation)] // the format's precision
        bytes.extend(row.iter().flat_map(|&x| (x as f32).to_le_bytes()));
    }
    bytes
}

/// Reads a map.
///
/// # Errors
///
/// What is wrong with it.
pub fn read(bytes: &[u8]) -> Result<Pixels, String> {
    let mut at = 0;
    let mut word = || {
        let word = word(bytes, &mut at);
        word.ok_or_else(|| "its header is not of 4 words".to_owned())
    };
    let channels = match word()? {
        "Pf" => 1,
        "PF" => 3,
        other => return Err(format!("it begins with `{other}`")),
    };
    let mut number = || {
        let word = word()?;
        word.parse::<f64>().map_err(|_| format!("`{word}` in its header is not a number"))
    };
    let [columns, rows, scale] = [number()?, number()?, number()?];
    let length = |x: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked first
        let length =
            (x >= 1.0 && x <= f64::from(u32::MAX) && x.fract() == 0.0).then_some(x as usize);
        length.ok_or_else(|| format!("{x} is no number of rows or columns"))
    };
    let (rows, columns) = (length(rows)?, length(columns)?);
    if scale == 0.0 || !scale.is_finite() {
        return Err(format!("its scale is {scale}, whose sign tells no byte order"));
    }
    let values = bytes.get(at..).unwrap_or_default();
    let count = rows.checked_mul(columns).and_then(|pixels| pixels.checked_mul(4 * channels));
    if Some(values.len()) != count {
        let actual = values.len();
        return Err(format!(
            "{actual} bytes follow its header, not 4 for each of {channels} × {columns} × {rows} values"
        ));
    }
    let word = NumberType::of_width(4, scale > 0.0);
    let mut numbers = Vec::with_capacity(values.len() / 4);
    for row in values.chunks_exact(4 * columns * channels).rev() {
        word.convert(row, &mut numbers);
    }
    Ok(Pixels { size: [columns, rows], channels, values: numbers, has_halves: false })
}

/// The next word of the header, of at most 64 bytes: no program writes longer ones.
fn word<'a>(bytes: &'a [u8], at: &mut usize) -> Option<&'a str> {
    let rest = bytes.get(*at..)?;
    let begin = rest.iter().take(64).position(|byte| !byte.is_ascii_whitespace())?;
    let length = rest[begin..].iter().take(64).position(u8::is_ascii_whitespace)?;
    *at += begin + length + 1;
    std::str::from_utf8(&rest[begin..begin + length]).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_byte_orders_and_the_lowest_row_first() {
        let (low, high) = ([1.0_f32, 2.0], [3.0_f32, -0.5]);
        let little = low.iter().chain(&high).flat_map(|x| x.to_le_bytes());
        let big = low.iter().chain(&high).flat_map(|x| x.to_be_bytes());
        let little: Vec<u8> = b"Pf\n2 2\n-1.0\n".iter().copied().chain(little).collect();
        let big: Vec<u8> = b"Pf 2 2 1e0\n".iter().copied().chain(big).collect();
        assert_eq!(little, write([2, 2], 1, &[3.0, -0.5, 1.0, 2.0]));
        for bytes in [little, big] {
            let picture = read(&bytes).expect("a picture");
            assert_eq!(picture.values, [3.0, -0.5, 1.0, 2.0]);
            assert_eq!((picture.size, picture.channels), ([2, 2], 1));
        }
    }

    #[test]
    fn a_coloured_pixel_has_three_values() {
        let image = [1.0, 2.0, 3.0, -0.5, 1.0, 1.0];
        let bytes = write([1, 2], 3, &image);
        assert_eq!(bytes[..12], *b"PF\n1 2\n-1.0\n");
        // The lower row, which begins with −0.5 = 0xBF000000, comes first; then 1 = 0x3F800000, 2, 3.
        assert_eq!([&bytes[12..16], &bytes[24..28]], [[0, 0, 0, 0xBF], [0, 0, 0x80, 0x3F]]);
        let picture = read(&bytes).expect("a picture");
        assert_eq!((picture.size, picture.channels, &picture.values[..]), ([1, 2], 3, &image[..]));
    }

    #[test]
    fn what_is_no_map_is_refused_with_what_is_wrong() {
        for (bytes, words) in [
            (&b""[..], "header is not of 4 words"),
            (b"P6\n2 2\n255\n", "begins with `P6`"),
            (b"Pf\n2\n", "header is not of 4 words"),
            (b"Pf\nx 2\n-1\n", "`x` in its header"),
            (b"Pf\n0 2\n-1\n", "0 is no number of rows"),
            (b"Pf\n2.5 2\n-1\n", "2.5 is no number"),
            (b"Pf\n1 1\n0\n1234", "scale is 0"),
            (b"Pf\n1 1\n-1\n123", "3 bytes follow"),
            (b"Pf\n1 1\n-1\n12345", "5 bytes follow"),
            (b"PF\n4000000000 4000000000\n-1\n1234", "4 bytes follow"),
        ] {
            let error = read(bytes).expect_err("no picture");
            assert!(error.contains(words), "{error}");
        }
    }
}
