//! Any bytes as a case file: read, or refused with the place of every mistake.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/it/common/mutated.rs"]
mod mutated;

fuzz_target!(|text: &str| {
    mutated::reads_or_names_the_place(text);
});
