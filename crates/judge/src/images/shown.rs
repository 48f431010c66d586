//! Deviations that the passes show by their own spread, whatever variance is claimed.
//!
//! ```text
//! mean      z = (x̄ − T)/√(Σ s_i²(1/N + 1/R))      over the pixels of the picture
//! variance  z = (1 − s²/V)/√(s²/V · s²/V (q − 1)/n + r)    over pairs of passes; q and r as in `variance`
//! ```
//!
//! Both are beyond the limit of obvious deviations of a session, which grows with the tails. Nothing fails by them: the
//! spread of a few passes is no ground, because rare values that were not drawn may carry it. A mean is named before a
//! variance that moves with it. A variance that is plainly too large does not pass.

use super::claim::Pixels;
use super::judgement::Tile;
use super::picture::Stack;
use super::variance;
use gate::session::plain_limit;
use gate::session::quantity::VARIANCE_CAP;
use gate::stats::verdict::Verdict;

/// Minimum number of values for a spread.
const MIN_VALUES: f64 = 32.0;

/// Returns the undecided picture with the most obvious bias of all channels; its standard error and z are by the
/// passes' own spread.
pub(super) fn mean(stack: &Stack, pixels: &Pixels, whole: &[Tile], is_free: bool) -> Option<Tile> {
    let open = whole.iter().filter(|tile| tile.verdict == Verdict::Inconclusive);
    let finding = open.filter_map(|tile| plain(stack, pixels, tile, is_free));
    let size = |tile: &Tile| tile.z.map_or(0.0, f64::abs);
    finding.max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// Returns the picture in a channel with its own standard error, if its bias is obvious.
fn plain(stack: &Stack, pixels: &Pixels, whole: &Tile, is_free: bool) -> Option<Tile> {
    let channels = stack.size.channels;
    let values = (whole.channel..stack.size.values()).step_by(channels);
    let places: Vec<usize> = values.filter(|&i| pixels.is_known(i)).collect();
    let (n, count) = (stack.passes as f64, places.len() as f64);
    let values: Vec<Vec<f64>> = if is_free {
        places
            .iter()
            .map(|&i| (0..stack.passes).map(|pass| stack.pass(pass)[i]).collect())
            .collect()
    } else {
        let average = |pass| places.iter().map(|&i| stack.pass(pass)[i]).sum::<f64>() / count;
        vec![(0..stack.passes).map(average).collect()]
    };
    let parts = values.len() as f64;
    let (mut squares, mut fourth) = (0.0, 0.0);
    for values in &values {
        let mean = values.iter().sum::<f64>() / n;
        for square in values.iter().map(|x| (x - mean) * (x - mean)) {
            squares += square;
            fourth += square * square;
        }
    }
    if n * parts < MIN_VALUES || squares <= 0.0 {
        return None;
    }
    let share = 1.0 + n * pixels.truth_share;
    let error = (squares / (n - 1.0) / n * share).sqrt() / parts;
    let z = (whole.mean - whole.truth) / error;
    let is_plain = z.is_finite() && z.abs() > plain_limit(squares * squares / fourth);
    is_plain.then(|| Tile { standard_error: error, z: Some(z), ..whole.clone() })
}

/// Returns whether passes of independent pixels plainly vary less than claimed. `ratio` is s²/V, and `error` is r of an
/// estimated variance.
pub(super) fn is_too_large(stack: &Stack, pixels: &Pixels, ratio: f64, error: f64) -> bool {
    let Some(variance) = pixels.variance.as_ref().filter(|_| ratio < 1.0 - VARIANCE_CAP) else {
        return false;
    };
    let unit = |i: usize| if pixels.estimate.is_some() { 1.0 } else { variance[i] };
    let is_judged = |&i: &usize| pixels.is_known(i) && !pixels.is_certain(i);
    let channels = stack.size.channels;
    let mut pairs = variance::Pairs::default();
    for first in (0..stack.passes - 1).step_by(2) {
        let (one, other) = (stack.pass(first), stack.pass(first + 1));
        for pixel in 0..stack.size.pixels() {
            // The channels of a pixel depend on each other: they are one value.
            let places = (pixel * channels..(pixel + 1) * channels).filter(is_judged);
            pairs.add_one(places.map(|i| 0.5 * (one[i] - other[i]).powi(2) / unit(i)).sum());
        }
    }
    let Some(q) = pairs.q().filter(|_| pairs.count >= MIN_VALUES) else { return false };
    let own = (q - 1.0).max(0.0) / pairs.count;
    let carry = (pairs.count / q).min(if error > 0.0 { 1.0 / error } else { f64::INFINITY });
    (1.0 - ratio) / (ratio * ratio * own + error).sqrt() > plain_limit(carry)
}
