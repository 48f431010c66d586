//! Portable float maps: an image with all its digits, to single precision.
//!
//! ```text
//! Pf\n columns rows\n -1.0\n   then 4 bytes a value, little-endian, row after row from the BOTTOM
//! PF\n …                         the same with red, green and blue of each pixel
//! ```
//!
//! Source: P. Debevec, *PFM Portable `FloatMap` Image Format*.

/// The bytes of an image of one or three channels whose rows come from the top.
pub fn encode([columns, rows]: [usize; 2], channels: usize, image: &[f64]) -> Vec<u8> {
    let kind = if channels > 1 { "PF" } else { "Pf" };
    let mut bytes = format!("{kind}\n{columns} {rows}\n-1.0\n").into_bytes();
    for row in image.chunks_exact((columns * channels).max(1)).rev() {
        #[expect(clippy::cast_possible_truncation)] // the format's precision
        bytes.extend(row.iter().flat_map(|&x| (x as f32).to_le_bytes()));
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_row_comes_first_and_the_low_byte_too() {
        let bytes = encode([2, 2], 1, &[1.0, 2.0, 3.0, -0.5]);
        let header = b"Pf\n2 2\n-1.0\n";
        assert_eq!(&bytes[..header.len()], header);
        // 3 = 0x40400000, −0.5 = 0xBF000000, 1 = 0x3F800000, 2 = 0x40000000.
        let pixels = [0, 0, 0x40, 0x40, 0, 0, 0, 0xBF, 0, 0, 0x80, 0x3F, 0, 0, 0, 0x40];
        assert_eq!(&bytes[header.len()..], pixels);
    }

    #[test]
    fn a_coloured_pixel_has_three_values() {
        let bytes = encode([1, 2], 3, &[1.0, 2.0, 3.0, -0.5, 1.0, 1.0]);
        assert_eq!(bytes[..12], *b"PF\n1 2\n-1.0\n");
        // The lower row, which begins with −0.5, comes first; then 1, 2, 3.
        assert_eq!([&bytes[12..16], &bytes[24..28]], [[0, 0, 0, 0xBF], [0, 0, 0x80, 0x3F]]);
    }
}
