//! Any bytes as a grid in a scene file of pbrt: read as finite samples that are not negative, or refused.

#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/it/common/grids.rs"]
mod grids;

fuzz_target!(|bytes: &[u8]| {
    grids::reads_or_refuses("pbrt", bytes);
});
