//! Random stream of a callback.

use numeric::rng::Stream;

/// Random stream: xoshiro256+, the generator of the Rust library. Draw numbers from it by `tf_rng_uniform`,
/// `tf_rng_positive_uniform` and `tf_rng_word`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Rng {
    /// State of the generator; not all zero.
    pub state: [u64; 4],
}

impl From<&Stream> for Rng {
    fn from(stream: &Stream) -> Self {
        Self { state: stream.state() }
    }
}
