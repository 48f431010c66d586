//! Evidence on the average of a tile of pixels, in one channel.
//!
//! ```text
//! y     = (x − T)/u     for every pixel of every pass;  u the picture's mean |T| in that channel
//! V     the mean of the pixels' V/u²:  Σ ln(1 + λ²V_i/2) ≤ n ln(1 + λ²V/2)
//! range from low less the largest T of the tile to high less its smallest
//! E, P± as of any quantity of a session, at the end of all passes
//! ε     as asked; else √(s²V/n), s² such that a correct picture passes in all of its K tiles with probability 0.95:
//!       0.402 s² − 0.6 z s = ln(1/β),   z the normal quantile of 1 − 0.025/K;   27 for K = 1
//! ```
//!
//! If the pixels of a pass depend on each other, a draw is the average over a pass, which has no known variance: only a
//! range is then a ground. Single pixels are not affected.

use super::claim::Pixels;
use super::judgement::Tile;
use super::picture::{Size, Stack};
use crate::{AT_THE_END, Levels, Quantity, Scalar, VarianceBound};
use gate::session::quantity::MEAN_CAP;
use gate::stats::gate::{HORIZON, PLANNED};
use gate::stats::normal::{upper_quantile, upper_tail};
use gate::stats::verdict::{MISS, Verdict};

/// Rectangle of pixels, in one channel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub size: usize,
    pub row: usize,
    pub column: usize,
    pub height: usize,
    pub width: usize,
    pub channel: usize,
}

/// Grounds of the evidence, and options of the verdict.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terms {
    /// True if the pixels of a pass count as independent.
    pub is_free: bool,
    /// True if the variance may be relied on.
    pub has_variance: bool,
    /// ε in units of u.
    pub tolerance: Option<f64>,
    /// True if ε has the cap of a mean unless a tolerance is given.
    pub is_capped: bool,
    /// K, the number of tiles that must pass.
    pub count: usize,
    /// Levels of a part by itself: a bound on the variance by a kurtosis takes a share of them.
    pub levels: Levels,
}

/// Returns s², the number of draws in units of V/ε² that a part is planned for, so that all `count` parts pass.
fn planned_units(count: usize) -> f64 {
    let z = upper_quantile(0.025 / count.max(1) as f64);
    // Mean and spread of ln P± of n normal draws, in units of s: κ − κ²ρ/2 and κ, κ = 0.6, ρ = 1.1.
    let (gain, noise, needed) = (0.402, 0.6 * z, -MISS.ln());
    let s = (noise + (noise * noise + 4.0 * gain * needed).sqrt()) / (2.0 * gain);
    (s * s).max(PLANNED)
}

impl Terms {
    /// Returns the mean of a part, with the ground for its spread and δ.
    pub(super) fn mean(self, ground: Option<VarianceBound>, floor: f64) -> Quantity {
        let cap = if self.is_capped { MEAN_CAP } else { 1e3 };
        Quantity { cap, ..Quantity::mean(ground, floor).within(self.tolerance) }
    }

    /// Returns the number of draws that a part with `draws` draws is planned for.
    pub(super) fn planned(self, draws: f64) -> f64 {
        draws * PLANNED / planned_units(self.count)
    }
}

impl Part {
    /// Returns the indices of its values in a pass, row after row.
    pub(super) fn places(self, stack: &Stack) -> impl Iterator<Item = usize> + Clone + use<> {
        let (columns, channels) = (stack.size.columns, stack.size.channels);
        let Self { row, column, height, width, channel, .. } = self;
        (row..row + height).flat_map(move |row| {
            (column..column + width)
                .map(move |column| (row * columns + column) * channels + channel)
        })
    }
}

/// Returns the mean of numbers at some indices.
pub(super) fn mean_at(places: &[usize], of: impl Fn(usize) -> f64) -> f64 {
    places.iter().map(|&i| of(i)).sum::<f64>() / places.len() as f64
}

impl Tile {
    /// Returns a tile with its truth, its mean and the standard error of the mean, before any test.
    pub(super) fn new(part: Part, [truth, mean, standard_error]: [f64; 3]) -> Self {
        let z = if mean == truth { 0.0 } else { (mean - truth) / standard_error };
        let z = Some(z).filter(|z| z.is_finite());
        Self {
            size: part.size,
            row: part.row,
            column: part.column,
            height: part.height,
            width: part.width,
            channel: part.channel,
            truth,
            mean,
            standard_error,
            z,
            p: z.map(|z| 2.0 * upper_tail(z.abs())),
            ln_e: 0.0,
            ln_p: [f64::NEG_INFINITY; 2],
            tolerance: None,
            needed: None,
            is_listed: false,
            verdict: Verdict::Inconclusive,
        }
    }

    /// Sets ε and P± of a tile without spread if all of its values equal the truth within `tolerance`.
    pub(super) fn without_doubt(self, tolerance: f64) -> Self {
        Self { tolerance: Some(tolerance), ln_p: [f64::INFINITY; 2], ..self }
    }

    /// Returns −ln of the tails of a distribution beyond a bias of +ε and of −ε, for a mean with this standard error;
    /// all in units of `unit`.
    pub(super) fn sides(
        &self,
        tolerance: f64,
        [error, unit]: [f64; 2],
        tail: impl Fn(f64) -> f64,
    ) -> [f64; 2] {
        let off = (self.mean - self.truth) / unit;
        [tolerance - off, tolerance + off].map(|room| -tail(room / error).ln())
    }

    /// Sets ε, by default `quantiles` standard errors, and P± by the tails of a distribution.
    pub(super) fn promise(
        &mut self,
        requested: Option<f64>,
        is_capped: bool,
        quantiles: f64,
        [error, unit]: [f64; 2],
        tail: impl Fn(f64) -> f64,
    ) {
        let cap = if is_capped { MEAN_CAP } else { f64::INFINITY };
        let tolerance = requested.unwrap_or((quantiles * error).min(cap));
        (self.tolerance, self.ln_p) = (Some(tolerance), self.sides(tolerance, [error, unit], tail));
    }

    /// Plans by the widest deviation that the standard error of these passes leaves open.
    pub(super) fn plan_by_error(&mut self, passes: usize, parts: [f64; 2], widest: f64) {
        let ratio = self.tolerance.map_or(1.0, |tolerance| (tolerance / widest).powi(2));
        self.plan(passes, parts, ratio);
    }

    /// Sets the number of passes after which the part is decided, by the rule of draws: what ε is planned for or, with as
    /// many, `HORIZON`/`PLANNED` of that. `ratio` is the squared error that ε takes over that of these passes, and the two
    /// parts of it come from these passes and from the truth, which more passes do not reduce.
    pub(super) fn plan(&mut self, passes: usize, [own, other]: [f64; 2], ratio: f64) {
        let ratio = if ratio < 1.0 - 1e-6 { ratio } else { PLANNED / HORIZON };
        let left = ratio * (own + other) - other;
        self.needed = (left > 0.0).then(|| (passes as f64 * own / left).ceil());
    }
}

/// Returns the evidence of the passes on a part. All of its values are finite.
pub(super) fn tile(stack: &Stack, pixels: &Pixels, part: Part, terms: Terms) -> Tile {
    let places: Vec<usize> = part.places(stack).collect();
    let count = places.len() as f64;
    let unit = pixels.units[part.channel];
    let truth = mean_at(&places, |i| pixels.truth[i]);
    let is_single = places.len() == 1;
    let is_free = terms.is_free || is_single;
    let variance = pixels.variance.as_ref().filter(|_| terms.has_variance && is_free);
    let variance = variance.map(|variance| mean_at(&places, |i| variance[i]));
    let averages: Vec<f64> =
        (0..stack.passes).map(|pass| mean_at(&places, |i| stack.pass(pass)[i])).collect();
    let n = stack.passes as f64;
    let mean = averages.iter().sum::<f64>() / n;
    let shown = averages.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
    let standard_error = (variance.map_or(shown, |variance| variance / count) / n).sqrt();
    let mut finding = Tile::new(part, [truth, mean, standard_error]);
    if places.iter().all(|&i| pixels.is_certain(i)) {
        // Values without spread were compared with their truth one by one.
        return finding.without_doubt(0.0);
    }
    let draws = if is_free { n * count } else { n };
    let known = variance.map(|variance| VarianceBound::Variance(variance / unit / unit));
    let bounded = pixels.kurtosis.filter(|_| pixels.variance.is_none() && is_free);
    let bounded = bounded.map(VarianceBound::Kurtosis);
    let levels = if known.is_none() && bounded.is_some() { terms.levels } else { AT_THE_END };
    let truths = if is_free { pixels.truths(&places) } else { vec![truth] };
    let mean_quantity = Quantity {
        range: pixels.range_about(&truths, unit),
        ..terms.mean(known.or(bounded), mean_at(&places, |i| pixels.floor(i)) / unit)
    };
    let of_block = |first: usize, last: usize, y: &mut Vec<f64>| {
        if is_free {
            for pass in first..last {
                let values = stack.pass(pass);
                y.extend(places.iter().map(|&i| (values[i] - pixels.truth[i]) / unit));
            }
        } else {
            y.extend(averages[first..last].iter().map(|x| (x - truth) / unit));
        }
    };
    let planned = Some(terms.planned(draws));
    let scalar = Scalar::of_all(mean_quantity, planned, levels, stack.passes, of_block);
    (finding.ln_e, finding.ln_p) = (scalar.evidence.ln_e, scalar.evidence.ln_pass);
    if let Some(design) = scalar.design {
        finding.tolerance = Some(design.tolerance);
        finding.plan(stack.passes, [1.0, 0.0], terms.planned(draws) / design.draws());
    }
    if let (Some(tolerance), true, false) = (finding.tolerance, variance.is_some(), is_single) {
        // Catoni's function hardly detects a bias in one pixel of many; the plain mean does.
        let sides = finding.sides(tolerance, [standard_error / unit, unit], upper_tail);
        finding.ln_p = [0, 1].map(|side| finding.ln_p[side].min(sides[side]));
    }
    finding
}

/// Returns the tiles, the smallest first, row after row, each with all its channels. Larger tiles detect a bias that is
/// spread out. With `is_joined`, a remainder of less than half a tile at the right or at the foot joins the last tile.
pub(super) fn parts(
    Size { rows, columns, channels }: Size,
    tile: usize,
    is_joined: bool,
) -> Vec<Part> {
    let sizes = std::iter::successors(Some(tile), |size| Some(2 * size));
    let mut parts = Vec::new();
    for size in sizes.take_while(|&size| size == tile || size < rows.max(columns)) {
        for (row, height) in spans(rows, size, is_joined) {
            for (column, width) in spans(columns, size, is_joined) {
                let part = |channel| Part { size, row, column, height, width, channel };
                parts.extend((0..channels).map(part));
            }
        }
    }
    parts
}

/// Returns the first row or column and the length of each tile of that size.
fn spans(length: usize, size: usize, is_joined: bool) -> Vec<(usize, usize)> {
    let mut spans: Vec<(usize, usize)> =
        (0..length).step_by(size).map(|first| (first, size.min(length - first))).collect();
    if let (true, [.., last, rest]) = (is_joined, &mut *spans)
        && 2 * rest.1 < size
    {
        last.1 += rest.1;
        spans.pop();
    }
    spans
}

/// Returns the whole picture, one part per channel.
pub(super) fn wholes(Size { rows, columns, channels }: Size) -> Vec<Part> {
    let size = rows.max(columns);
    let part = |channel| Part { size, row: 0, column: 0, height: rows, width: columns, channel };
    (0..channels).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_tiles_are_planned_for_more_passes() {
        assert_eq!(planned_units(1), 27.0);
        // z = 4.33 and 4.95 for 0.025/K: 0.402 s² − 0.6 z s − 4.605 = 0.
        for (count, s) in [(4096, 7.966), (65_536, 8.697)] {
            assert!((planned_units(count).sqrt() - s).abs() < 1e-3, "{count}");
        }
    }

    #[test]
    fn small_rests_are_joined_where_asked() {
        assert_eq!(spans(18, 8, false), [(0, 8), (8, 8), (16, 2)]);
        assert_eq!(spans(18, 8, true), [(0, 8), (8, 10)]);
        assert_eq!(spans(20, 8, true), [(0, 8), (8, 8), (16, 4)]);
        assert_eq!(spans(3, 8, true), [(0, 3)]);
    }
}
