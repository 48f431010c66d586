//! Packs of eight draws side by side: what packet kernels share.
//!
//! Specification of each: draw j is, bit for bit, the draw that its page makes from stream j mod 16.

pub mod bank;
pub mod colours;
pub mod kept;
pub mod left;

pub use crate::walks::hero;

use super::DrawBuffer;
use media::{Control, Lookups, Piecewise};
use numeric::rng::Streams;

/// With more pieces of σ̂ or of the control than this, lanes that cross them hold the others up for longer than
/// eight lookups at once gain, unless lookups are costly or σ̂ is constant.
const MOST_PIECES: usize = 8;

/// Whether packets are faster than one draw after the other.
pub fn pays(medium: &Lookups, sampling: &Piecewise, control: &Control) -> bool {
    let controls = if let Control::Pieces(pieces) = control { pieces.count() } else { 0 };
    let few = sampling.count() <= MOST_PIECES && controls <= MOST_PIECES;
    medium.is_costly() || sampling.even().is_some() || few
}

/// What is to be drawn.
pub struct Request<'a> {
    /// The streams of the block, where the draws before left them.
    pub streams: &'a mut Streams,
    /// How many draws.
    pub count: usize,
    /// Where they go.
    pub buffer: &'a mut DrawBuffer,
}
