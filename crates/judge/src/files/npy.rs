//! `NumPy`'s array file: a header, then words, in rows if the array has two axes.

use super::raw::{NumberRows, Words};
use super::{Bytes, ForeignError, Layout};
use media::files::npy;
use media::files::number::NumberType;

/// Opens an array; `length` counts the bytes of the file.
pub(super) fn open(
    mut bytes: Bytes,
    file: &str,
    length: Option<u64>,
    layout: &Layout,
) -> Result<NumberRows, ForeignError> {
    let header = npy::bytes(&mut bytes).map_err(|cause| ForeignError::unreadable(file, cause))?;
    if header.is_empty() {
        return Err(ForeignError::Empty { file: file.to_owned() });
    }
    let array = npy::parse(&header)
        .map_err(|cause| ForeignError::NotNpy { file: file.to_owned(), cause })?;
    let shape = || ForeignError::Shape { file: file.to_owned(), shape: array.written_shape() };
    let expected = array.count().ok_or_else(shape)?;
    let word = NumberType::float(&array.kind).ok_or_else(|| ForeignError::ElementType {
        file: file.to_owned(),
        actual: array.kind.clone(),
    })?;
    let axes: Vec<u64> = array.shape.iter().copied().filter(|&size| size != 1).collect();
    let [draws, width] = match axes[..] {
        [] => [1, 1],
        [draws] => [draws, 1],
        [draws, width] => [draws, width],
        _ => return Err(shape()),
    };
    let width = usize::try_from(width).map_err(|_| shape())?;
    if layout.takes_all() && u128::from(draws) < width as u128 {
        let (file, shape) = (file.to_owned(), array.written_shape());
        return Err(ForeignError::Transposed { file, shape });
    }
    let places = layout.places(file, width, shape)?;
    if expected == 0 {
        return Err(ForeignError::Empty { file: file.to_owned() });
    }
    let header = header.len() as u64;
    if let Some(length) = length {
        let actual = length.saturating_sub(header) / word.width() as u64;
        let (file, row) = (file.to_owned(), width.max(1) as u64);
        if actual < expected {
            let (actual, expected) = (actual / row, expected / row);
            return Err(ForeignError::Truncated { file, actual, expected });
        }
        if Some(length - header) != expected.checked_mul(word.width() as u64) {
            return Err(ForeignError::Overlong { file, expected: expected / row });
        }
    }
    let words = Words::new(bytes, file, word, Some(expected));
    // With one axis the order of C and that of Fortran are the same.
    let by_column = array.fortran_order && width > 1;
    Ok(NumberRows::new(words, width, places, by_column))
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};

    use super::super::{Column, DrawSource, NumberFormat, all};
    use super::*;
    use crate::{Block, Source};

    /// Returns a header as `numpy.save` writes it.
    fn whole_header(kind: &str, order: &str, shape: &str) -> Vec<u8> {
        let text = format!("{{'descr': {kind}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
        let length = u16::try_from(text.len()).expect("short");
        [b"\x93NUMPY\x01\x00", &length.to_le_bytes()[..], text.as_bytes()].concat()
    }

    fn array<const N: usize>(
        kind: &str,
        shape: &str,
        words: impl Iterator<Item = [u8; N]>,
    ) -> Vec<u8> {
        let header = whole_header(&format!("'{kind}'"), "False", shape);
        header.into_iter().chain(words.flatten()).collect()
    }

    fn doubles(shape: &str, values: &[f64]) -> Vec<u8> {
        array("<f8", shape, values.iter().map(|x| x.to_le_bytes()))
    }

    fn pipe(bytes: Vec<u8>) -> Result<DrawSource, ForeignError> {
        DrawSource::from_reader(Cursor::new(bytes), "x.npy", NumberFormat::Npy)
    }

    fn open(bytes: &[u8]) -> Result<DrawSource, ForeignError> {
        let mut file = tempfile::NamedTempFile::new().expect("a file");
        file.write_all(bytes).expect("written");
        DrawSource::open(file.path(), NumberFormat::Npy)
    }

    #[test]
    fn every_width_and_byte_order_comes_back() {
        let values: Vec<f64> = (0..40_000).map(|i| f64::from(i) / 64.0 - 3.0).collect();
        let singles: Vec<f32> = (0..40_000u16).map(|i| f32::from(i) / 64.0 - 3.0).collect();
        let shape = "(40000,)";
        let fortran = whole_header("'<f8'", "True", "(1, 40000, 1)").into_iter();
        for bytes in [
            doubles(shape, &values),
            array(">f8", shape, values.iter().map(|x| x.to_be_bytes())),
            array("<f4", shape, singles.iter().map(|x| x.to_le_bytes())),
            array(">f4", shape, singles.iter().map(|x| x.to_be_bytes())),
            fortran.chain(values.iter().flat_map(|x| x.to_le_bytes())).collect(),
        ] {
            let draws = open(&bytes).expect("draws");
            assert_eq!(draws.known_length(), Some(40_000));
            assert_eq!(all(draws).expect("draws"), values);
            assert_eq!(all(pipe(bytes).expect("draws")).expect("draws"), values);
        }
        let one = doubles("()", &[2.5]);
        assert_eq!(all(pipe(one).expect("a draw")).expect("a draw"), [2.5]);
    }

    #[test]
    fn columns_come_back_in_both_orders() {
        // Row i has i, i + 0.25 and i + 0.5.
        let n = 20_000_u32;
        let value = |i: u32, k: u32| f64::from(i) + 0.25 * f64::from(k);
        let rows: Vec<f64> = (0..n).flat_map(|i| (0..3).map(move |k| value(i, k))).collect();
        let columns: Vec<f64> = (0..3).flat_map(|k| (0..n).map(move |i| value(i, k))).collect();
        let fortran = whole_header("'<f8'", "True", "(20000, 3)").into_iter();
        let fortran = fortran.chain(columns.iter().flat_map(|x| x.to_le_bytes())).collect();
        for bytes in [doubles("(20000, 3)", &rows), fortran] {
            let layout = |column: &str| Layout::column(column.parse().ok());
            let open = |layout: &Layout| {
                DrawSource::from_reader_as(
                    Cursor::new(bytes.clone()),
                    "x.npy",
                    NumberFormat::Npy,
                    layout,
                )
            };
            for k in 0..3 {
                let draws = open(&layout(&k.to_string())).expect("a column");
                assert_eq!(draws.known_length(), Some(20_000));
                let expected: Vec<f64> = (0..n).map(|i| value(i, k)).collect();
                assert_eq!(all(draws).expect("draws"), expected);
            }
            assert!(matches!(open(&layout("3")), Err(ForeignError::NoColumn { .. })));
            assert!(matches!(open(&layout("red")), Err(ForeignError::NoColumn { .. })));
            let channels = ["a", "b", "c", "luminance"].map(str::to_owned).to_vec();
            let three = Layout { channels, derived: 1, ..Layout::default() };
            let mut draws = open(&three).expect("three channels");
            assert_eq!(draws.values(), 3);
            let mut block = Block::new(3);
            let (mut at, mut seen) = (0, 0);
            loop {
                block.clear();
                draws.fill(&mut block, 997).expect("draws");
                let read = &block.columns;
                if read[0].is_empty() {
                    break;
                }
                for (k, column) in (0..).zip(read) {
                    let expected: Vec<f64> =
                        (at..).take(column.len()).map(|i| value(i, k)).collect();
                    assert_eq!(column, &expected);
                }
                at += u32::try_from(read[0].len()).expect("few");
                seen += read[0].len();
            }
            assert_eq!(seen, 20_000);
        }
    }

    fn refused(bytes: Vec<u8>, layout: &Layout) -> ForeignError {
        let draws =
            DrawSource::from_reader_as(Cursor::new(bytes), "x.npy", NumberFormat::Npy, layout);
        draws.and_then(all).expect_err("an error")
    }

    #[test]
    fn other_shapes_and_types_are_refused() {
        let header = |kind: &str, shape: &str| whole_header(kind, "False", shape);
        let (one, channels) = (Layout::default(), ["a", "b", "c"].map(str::to_owned).to_vec());
        let first = Layout::column(Some(Column::Index(0)));
        let three = Layout { channels, ..Layout::default() };
        for (bytes, layout) in [
            (doubles("(2, 1, 3)", &[0.0; 6]), &one),
            (whole_header("'<f8'", "True", "(2, 3)"), &one),
            (doubles("(2, 1, 3, 2)", &[0.0; 12]), &first),
            (header("'<f8'", "(9223372036854775807, 9223372036854775807, 4)"), &one),
            (header("'<f8'", "(0, 9223372036854775807, 9223372036854775807)"), &one),
            (header("'<f8'", "(18446744073709551615,)"), &one),
        ] {
            assert!(matches!(refused(bytes, layout), ForeignError::Shape { .. }));
        }
        for (values, shape) in [(2, "(4, 2)"), (1, "(4,)")] {
            let error = refused(doubles(shape, &vec![0.0; 4 * values]), &three);
            assert!(matches!(error, ForeignError::Channels { actual, .. } if actual == values));
        }
        let turned = refused(doubles("(3, 8)", &[0.0; 24]), &three);
        assert!(matches!(turned, ForeignError::Transposed { .. }));
        for kind in ["'<i4'", "'<c16'", "'<f2'", "'|b1'", "[('a', '<f8'), ('b', '<f8')]"] {
            let error = refused(header(kind, "(3,)"), &one);
            assert!(matches!(error, ForeignError::ElementType { .. }), "{kind}");
        }
        for shape in ["(99999999999999999999,)", "(-1,)", "7"] {
            let error = refused(header("'<f8'", shape), &one);
            assert!(matches!(error, ForeignError::NotNpy { .. }), "{shape}");
        }
        let huge = refused(header("'<f8'", "(1000000000000,)"), &one);
        assert!(matches!(huge, ForeignError::Truncated { actual: 0, .. }));
    }

    #[test]
    fn files_of_another_length_are_refused() {
        let whole = doubles("(5,)", &[0.5; 5]);
        let is_cut =
            |error| matches!(error, ForeignError::Truncated { actual: 3, expected: 5, .. });
        let is_long = |error| matches!(error, ForeignError::Overlong { expected: 5, .. });
        let cut = whole[..whole.len() - 9].to_vec();
        assert!(is_cut(open(&cut).expect_err("cut")) && is_cut(refused(cut, &Layout::default())));
        let twice = whole.repeat(2);
        assert!(is_long(open(&twice).expect_err("two arrays")));
        assert!(is_long(refused(twice, &Layout::default())));
        for bytes in [whole[..40].to_vec(), b"T,X\n0.5,0.25\n".to_vec()] {
            let error = refused(bytes, &Layout::default());
            assert!(matches!(error, ForeignError::NotNpy { .. }), "{error}");
        }
        for bytes in [Vec::new(), doubles("(0,)", &[])] {
            assert!(matches!(refused(bytes, &Layout::default()), ForeignError::Empty { .. }));
        }
    }
}
