//! Portable float maps: an image with all its digits, to single precision.
//!
//! ```text
//! Pf\n columns rows\n -1.0\n   then 4 bytes a pixel, little-endian, row after row from the BOTTOM
//! ```
//!
//! Source: P. Debevec, *PFM Portable `FloatMap` Image Format*.

/// The bytes of a grey image whose rows come from the top.
pub fn encode([columns, rows]: [usize; 2], image: &[f64]) -> Vec<u8> {
    let mut bytes = format!("Pf\n{columns} {rows}\n-1.0\n").into_bytes();
    for row in image.chunks_exact(columns.max(1)).rev() {
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
        let bytes = encode([2, 2], &[1.0, 2.0, 3.0, -0.5]);
        let header = b"Pf\n2 2\n-1.0\n";
        assert_eq!(&bytes[..header.len()], header);
        // 3 = 0x40400000, −0.5 = 0xBF000000, 1 = 0x3F800000, 2 = 0x40000000.
        let pixels = [0, 0, 0x40, 0x40, 0, 0, 0, 0xBF, 0, 0, 0x80, 0x3F, 0, 0, 0, 0x40];
        assert_eq!(&bytes[header.len()..], pixels);
    }
}
