//! The random stream of a callback.

use trueflight::rng::Stream;

/// A random stream: xoshiro256+, the generator of the Rust library. Read it by `tf_rng_uniform` and the like.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Rng {
    /// Where it stands; not all zero.
    pub state: [u64; 4],
}

impl Rng {
    /// The same stream.
    pub(crate) fn of(stream: &Stream) -> Self {
        Self { state: stream.state() }
    }
}
