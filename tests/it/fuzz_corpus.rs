//! Targets of `fuzz/`, here on the stable toolchain with mutations of good inputs: seconds in the tests, or as long as
//! `FUZZ_SECONDS` says.
//!
//! ```text
//! FUZZ_SECONDS=600 cargo test --release --test it fuzz_corpus
//! ```

use std::time::{Duration, Instant};

use crate::common::grids::{good, reads_or_refuses};
use crate::common::mutated::{Choices, mutated, reads_or_names_the_place};
use crate::common::shipped_texts;

/// Runs a target on the seeds 0, 1, … until the time is over; returns the number of inputs, and of those that were
/// read.
fn for_some_time(share: f64, mut target: impl FnMut(u64) -> bool) -> [u64; 2] {
    let asked = std::env::var("FUZZ_SECONDS").ok().and_then(|seconds| seconds.parse().ok());
    let limit = asked.map(|seconds: f64| Duration::from_secs_f64(seconds * share));
    let begin = Instant::now();
    let mut counts = [0, 0];
    // Without a time limit the number is fixed: the tests are the same on every machine.
    while limit.map_or(counts[0] < 2000, |limit| begin.elapsed() < limit) {
        counts[1] += u64::from(target(counts[0]));
        counts[0] += 1;
    }
    counts
}

#[test]
fn spoilt_case_files_are_read_or_refused() {
    let texts = shipped_texts();
    let [tried, read] = for_some_time(0.5, |seed| {
        let mut choices = Choices(seed);
        let text = &texts[choices.below(texts.len())];
        // From one to a dozen mistakes, each in the result of the last.
        let mut text = mutated(text, seed);
        for more in 0..choices.below(3) {
            text = mutated(&text, seed ^ more as u64 ^ 0xffff);
        }
        reads_or_names_the_place(&text).is_some()
    });
    println!("{tried} case files, {read} of them read");
    assert!(read > 0 && read < tried);
}

/// Inputs that the fuzzer of `fuzz/` has found.
#[test]
fn findings_stay_mended() {
    // A picture in place of a case was refused without the key.
    let picture = "title = \"t\"\n[picture.multiple-scattering]\nsize = [64, 64]\n";
    assert!(reads_or_names_the_place(picture).is_none());
    // npyz took minutes to read nested brackets in the header of an array.
    let nested = [b"\x93NUMPY\x01\x00\x28\x00", &[b'{'; 40][..]].concat();
    assert!(reads_or_refuses("npy", &nested).is_none());
}

#[test]
fn spoilt_grid_files_are_read_or_refused() {
    for (ending, share) in [("vol", 0.1), ("npy", 0.1), ("vdb", 0.1), ("nvdb", 0.1), ("pbrt", 0.1)]
    {
        assert!(reads_or_refuses(ending, &good(ending)).is_some(), "{ending}");
        let [tried, read] = for_some_time(share, |seed| {
            let mut choices = Choices(seed ^ 0x5eed);
            let mut bytes = good(ending);
            for _ in 0..=choices.below(4) {
                let at = choices.below(bytes.len());
                match choices.below(6) {
                    0 => bytes.truncate(at),
                    1 => bytes.insert(at, b"0123456789()',:{}\x00\xff"[choices.below(19)]),
                    2 if !bytes.is_empty() => {
                        bytes.remove(at);
                    }
                    3 if !bytes.is_empty() => bytes[at] ^= 1 << choices.below(8),
                    _ if !bytes.is_empty() => {
                        bytes[at] = [0, 1, 9, 0x7f, 0x80, 0xff, b'9', b'f'][choices.below(8)];
                    }
                    _ => {}
                }
            }
            reads_or_refuses(ending, &bytes).is_some()
        });
        println!("{tried} .{ending} files, {read} of them read");
        assert!(read > 0 && read < tried);
    }
}
