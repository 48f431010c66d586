//! The header of a `NumPy` array file, guarded against what npyz cannot take.
//!
//! ```text
//! magic "\x93NUMPY", version, length, and a text such as
//! {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }
//! ```
//!
//! npyz parses the text by trial and error, in a time that grows exponentially with the depth of its
//! brackets, and multiplies the shape without looking. The header of an array of numbers has two levels.
//!
//! Source: `NumPy` Enhancement Proposal 1, *A simple file format for `NumPy` arrays*.

use std::io::{self, ErrorKind, Read};

use npyz::NpyHeader;

/// Deeper brackets than this are no header of numbers.
const DEEPEST: usize = 4;

/// The bytes of a header, magic and all; fewer where the source ends before.
///
/// # Errors
///
/// Those of the source.
pub fn bytes(source: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut header = Vec::new();
    source.take(10).read_to_end(&mut header)?;
    let Some(&[major, _, low, high]) = header.get(6..10) else { return Ok(header) };
    let mut rest = u64::from(u16::from_le_bytes([low, high]));
    if major > 1 {
        // Version 2 has a length of four bytes.
        source.take(2).read_to_end(&mut header)?;
        if let Some(&[low, high]) = header.get(10..12) {
            rest += u64::from(u16::from_le_bytes([low, high])) << 16;
        }
    }
    source.take(rest).read_to_end(&mut header)?;
    Ok(header)
}

/// What the bytes of a header say.
///
/// # Errors
///
/// Where they are no header, or one that is nested too deeply for an array of numbers.
pub fn parse(header: &[u8]) -> io::Result<NpyHeader> {
    if depth(header) > DEEPEST {
        return Err(io::Error::new(ErrorKind::InvalidData, "its brackets are nested too deeply"));
    }
    if let Some(shape) = uncountable(header) {
        let message = format!("an array of shape {shape} has more elements than can be counted");
        return Err(io::Error::new(ErrorKind::InvalidData, message));
    }
    NpyHeader::from_reader(header)
}

/// The shape in a header's text, if it has more elements than can be counted.
pub fn uncountable(header: &[u8]) -> Option<String> {
    let text = String::from_utf8_lossy(header);
    let (_, shape) = text.split_once("'shape'")?;
    let (shape, _) = shape.split_once('(')?.1.split_once(')')?;
    let mut sizes = shape.split(',').filter_map(|size| size.trim().parse::<u64>().ok());
    let bytes = sizes.try_fold(16, |bytes: u64, size| bytes.checked_mul(size.max(1)));
    bytes.is_none().then(|| format!("({shape})"))
}

/// How deep brackets are nested, whatever their kind.
fn depth(header: &[u8]) -> usize {
    let (mut depth, mut deepest) = (0_usize, 0);
    for byte in header {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(text: &str) -> Vec<u8> {
        let length = u16::try_from(text.len()).expect("short");
        [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], text.as_bytes()].concat()
    }

    #[test]
    fn a_header_is_read_and_no_byte_more() {
        let text = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
        let file = [header(text), vec![7; 24]].concat();
        let mut source = &file[..];
        let found = bytes(&mut source).expect("a slice has no errors");
        assert_eq!((found.len(), source.len()), (10 + text.len(), 24));
        assert_eq!(parse(&found).expect("a header").shape(), [2, 3]);
        assert!(parse(&found[..30]).is_err(), "cut");
    }

    /// It took npyz minutes; the fuzzer found it.
    #[test]
    fn deep_brackets_are_refused_at_once() {
        for bracket in ["{", "[", "("] {
            let error = parse(&header(&bracket.repeat(40))).map(drop).expect_err("no header");
            assert!(error.to_string().contains("nested too deeply"));
        }
    }

    #[test]
    fn what_cannot_be_counted_is_not_multiplied() {
        let shape = "(4294967296, 4294967296, 4294967296)";
        let text = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n");
        let error = parse(&header(&text)).map(drop).expect_err("too many").to_string();
        assert!(error.contains(shape) && error.contains("counted"), "{error}");
    }
}
