//! `NumPy`'s array file: a header, then numbers of one width.
//!
//! ```text
//! magic "\x93NUMPY", version, length, and a text such as
//! {'descr': '<f4', 'fortran_order': False, 'shape': (2, 3, 4), }
//! ```
//!
//! The reader supports the header of an array of numbers: three entries, in any order, without nested brackets
//! other than those of an element type that is not a number, which is not parsed further.
//!
//! Source: `NumPy` Enhancement Proposal 1, *A simple file format for `NumPy` arrays*.

use std::io::{self, ErrorKind, Read};

/// Header of an array.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header {
    /// The element type, such as `<f8`; of a type with fields the text between its brackets.
    pub kind: String,
    /// True if the first axis varies fastest.
    pub fortran_order: bool,
    /// The length of each axis.
    pub shape: Vec<u64>,
}

impl Header {
    /// Number of elements, if their bytes can be counted, also with axes of length 0.
    pub fn count(&self) -> Option<u64> {
        let maximum = |bytes: u64, &size: &u64| bytes.checked_mul(size.max(1));
        self.shape.iter().try_fold(16, maximum).map(|_| self.shape.iter().product())
    }

    /// The shape as Python writes it.
    pub fn written_shape(&self) -> String {
        let sizes: Vec<String> = self.shape.iter().map(u64::to_string).collect();
        format!("({}{})", sizes.join(", "), if sizes.len() == 1 { "," } else { "" })
    }
}

/// The bytes of a header, from the magic number on; fewer where the source ends before.
///
/// # Errors
///
/// The errors of the source.
pub fn bytes(source: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut header = Vec::new();
    source.take(10).read_to_end(&mut header)?;
    let Some(&[major, _, low, high]) = header.get(6..10) else { return Ok(header) };
    let mut rest = u64::from(u16::from_le_bytes([low, high]));
    if major > 1 {
        // From version 2 on the length has four bytes.
        source.take(2).read_to_end(&mut header)?;
        if let Some(&[low, high]) = header.get(10..12) {
            rest += u64::from(u16::from_le_bytes([low, high])) << 16;
        }
    }
    source.take(rest).read_to_end(&mut header)?;
    Ok(header)
}

/// Parses the bytes of a header.
///
/// # Errors
///
/// They are no header of an array.
pub fn parse(header: &[u8]) -> io::Result<Header> {
    let wrong = |what: &str| io::Error::new(ErrorKind::InvalidData, what);
    if header.get(..6) != Some(b"\x93NUMPY") {
        return Err(wrong("it does not begin with \\x93NUMPY"));
    }
    let from = match header.get(6) {
        Some(1) => 10,
        Some(2 | 3) => 12,
        _ => return Err(wrong("its version is none of 1, 2 and 3")),
    };
    let text = String::from_utf8_lossy(header.get(from..).unwrap_or_default());
    let entries = text.trim().strip_prefix('{').and_then(|text| text.strip_suffix('}'));
    let mut rest = entries.ok_or_else(|| wrong("its text is not within { and }"))?.trim();
    let (mut kind, mut order, mut shape) = (None, None, None);
    while !rest.is_empty() {
        let (key, value, after) =
            entry(rest).ok_or_else(|| wrong("its entries are not `'key': value`"))?;
        match key {
            "descr" => kind = Some(unquoted(value).unwrap_or(value).to_owned()),
            "fortran_order" => order = boolean(value),
            "shape" => shape = sizes(value),
            _ => return Err(wrong("it has an entry other than descr, fortran_order and shape")),
        }
        rest = after;
    }
    match (kind, order, shape) {
        (Some(kind), Some(fortran_order), Some(shape)) => Ok(Header { kind, fortran_order, shape }),
        _ => Err(wrong("it lacks descr, fortran_order or shape, or says none that there is")),
    }
}

/// The first entry's key and value, and the entries after it.
fn entry(text: &str) -> Option<(&str, &str, &str)> {
    let (key, rest) = text.split_once(':')?;
    let (mut depth, mut quoted) = (0_usize, false);
    let end = rest.find(|letter| {
        match letter {
            '\'' => quoted = !quoted,
            '(' | '[' | '{' if !quoted => depth += 1,
            ')' | ']' | '}' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
        letter == ',' && depth == 0 && !quoted
    });
    let (value, rest) = rest.split_at(end.unwrap_or(rest.len()));
    let rest = rest.strip_prefix(',').unwrap_or(rest);
    Some((unquoted(key.trim())?, value.trim(), rest.trim()))
}

fn unquoted(text: &str) -> Option<&str> {
    text.strip_prefix('\'')?.strip_suffix('\'')
}

fn boolean(text: &str) -> Option<bool> {
    match text {
        "True" => Some(true),
        "False" => Some(false),
        _ => None,
    }
}

/// A tuple of lengths, with or without a comma at its end.
fn sizes(text: &str) -> Option<Vec<u64>> {
    let inner = text.strip_prefix('(')?.strip_suffix(')')?.trim();
    if inner.is_empty() {
        return Some(Vec::new());
    }
    let axes = inner.strip_suffix(',').unwrap_or(inner).split(',');
    axes.map(|size| size.trim().parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A header as `numpy.save` writes it.
    fn header(kind: &str, order: &str, shape: &str) -> Vec<u8> {
        let text = format!("{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let length = u16::try_from(text.len()).expect("short");
        [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn of(text: &str) -> io::Result<Header> {
        let length = u32::try_from(text.len()).expect("short");
        parse(&[b"\x93NUMPY\x02\x00", &length.to_le_bytes()[..], text.as_bytes()].concat())
    }

    #[test]
    fn a_header_is_read_and_no_byte_more() {
        let whole = header("'<f4'", "False", "(2, 3)");
        let file = [whole.clone(), vec![7; 24]].concat();
        let mut source = &file[..];
        let result = bytes(&mut source).expect("a slice has no errors");
        assert_eq!((&result, source.len()), (&whole, 24));
        let read = parse(&result).expect("a header");
        assert_eq!(read, Header { kind: "<f4".into(), fortran_order: false, shape: vec![2, 3] });
        assert!(parse(&result[..30]).is_err(), "cut");
    }

    #[test]
    fn entries_stand_in_any_order() {
        let read =
            of("{'shape':(7,),'fortran_order':True,'descr':[('a','<f8'),('b, c','<f4')]} \n");
        let read = read.expect("a header");
        assert_eq!((read.shape, read.fortran_order), (vec![7], true));
        assert_eq!(read.kind, "[('a','<f8'),('b, c','<f4')]");
        let scalar = of("{'descr': '>f8', 'fortran_order': False, 'shape': ()}").expect("a header");
        assert_eq!((scalar.count(), scalar.written_shape().as_str()), (Some(1), "()"));
    }

    #[test]
    fn what_is_no_header_is_refused() {
        let three = "'descr': '<f8', 'fortran_order': False, 'shape'";
        for text in [
            "",
            "{}",
            "{'descr': '<f8', 'shape': (3,), }",
            "{'descr': '<f8', 'fortran_order': 0, 'shape': (3,), }",
            "{'descr': '<f8', 'fortran_order': False, 'shape': (3,), 'more': 1}",
            "descr: 3",
        ] {
            assert!(of(text).is_err(), "{text}");
        }
        for shape in
            ["7", "(-1,)", "(1.5,)", "(,)", "(99999999999999999999,)", "(2, 3", "[2]", "((2,))"]
        {
            assert!(of(&format!("{{{three}: {shape}, }}")).is_err(), "{shape}");
        }
        assert!(parse(b"\x93NUMPY\x04\x00\x00\x00\x00\x00{}").is_err(), "version 4");
        for bracket in ["{", "[", "("] {
            assert!(of(&bracket.repeat(60_000)).is_err(), "{bracket}");
        }
    }

    #[test]
    fn what_cannot_be_counted_is_not_multiplied() {
        let huge = 1 << 32;
        let of = |shape| Header { kind: "<f4".into(), fortran_order: false, shape };
        assert_eq!(of(vec![huge, huge, huge]).count(), None);
        assert_eq!(of(vec![0, u64::MAX]).count(), None);
        assert_eq!(of(vec![0, huge]).count(), Some(0));
        assert_eq!(of(vec![2, 3]).written_shape(), "(2, 3)");
    }
}
