//! Files of `OpenVDB` that are cut or have flipped bits: one error with its cure, or a grid of finite samples that are
//! not negative; never a panic.

use super::path;
use crate::common::grids::reads_or_refuses;
use crate::common::mutated::Choices;

/// Packings, and a grid that is moved.
const FILES: [&str; 8] = [
    "mixed-blosc",
    "mixed-blosc-all",
    "mixed-zip",
    "mixed-zip-mask",
    "mixed-mask",
    "half-blosc",
    "half-zip-mask",
    "moved",
];

fn bytes(file: &str) -> Vec<u8> {
    std::fs::read(path(&format!("{file}.vdb"))).expect("a file")
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    for file in FILES {
        let whole = bytes(file);
        assert!(reads_or_refuses("vdb", &whole).is_some(), "{file}");
        let mut choices = Choices(7);
        let header = 0..600.min(whole.len());
        let ends = (1..60).map(|n| whole.len() - n);
        for length in header.chain(ends).chain((0..100).map(|_| choices.below(whole.len()))) {
            assert!(
                reads_or_refuses("vdb", &whole[..length]).is_none(),
                "{file} of {length} bytes"
            );
        }
        assert!(reads_or_refuses("vdb", &[&whole[..], b"more"].concat()).is_some(), "{file}");
    }
}

/// Flips a bit of each of the first 700 bytes, which have counts, names and places, and of 500 anywhere.
#[test]
fn a_file_with_another_bit_is_read_or_refused() {
    for file in FILES {
        let whole = bytes(file);
        let samples = reads_or_refuses("vdb", &whole).expect("a grid");
        let mut choices = Choices(11);
        let header: Vec<usize> = (0..700).map(|byte| 8 * byte + choices.below(8)).collect();
        let mut counts = [0; 3];
        let others = (0..500).map(|_| choices.below(8 * whole.len())).collect();
        for bit in [header, others].concat() {
            let mut spoilt = whole.clone();
            spoilt[bit / 8] ^= 1 << (bit % 8);
            let kind = match reads_or_refuses("vdb", &spoilt) {
                None => 0,
                Some(same) if same == samples => 1,
                Some(_) => 2,
            };
            counts[kind] += 1;
        }
        println!(
            "{file}: {} refused, {} the same, {} of other values",
            counts[0], counts[1], counts[2]
        );
        assert!(counts[0] > 100 && counts[1] > 100, "{file}: {counts:?}");
    }
}

/// Voxels so far from the origin that doubles do not resolve their size.
#[test]
fn a_grid_that_is_nowhere_is_refused() {
    let whole = bytes("moved");
    let name = b"UniformScaleTranslateMap";
    let at = whole.windows(name.len()).position(|word| word == name).expect("a transform");
    for (shift, is_read) in [(1e5, true), (1e9, false), (1e300, false), (f64::NAN, false)] {
        let mut spoilt = whole.clone();
        spoilt[at + name.len()..][..8].copy_from_slice(&f64::to_le_bytes(shift));
        assert_eq!(reads_or_refuses("vdb", &spoilt).is_some(), is_read, "{shift}");
    }
}

/// Counts of four bytes that exceed the content by far.
#[test]
fn large_counts_are_read_or_refused() {
    for file in ["mixed-blosc", "mixed-zip", "half-zip-mask"] {
        let whole = bytes(file);
        for at in 0..700 {
            for count in [u32::MAX, 1 << 30] {
                let mut spoilt = whole.clone();
                spoilt[at..at + 4].copy_from_slice(&count.to_le_bytes());
                reads_or_refuses("vdb", &spoilt);
            }
        }
    }
}
