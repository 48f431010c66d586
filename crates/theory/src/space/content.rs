//! Content of a body, `∫σ_t dV`, by chords with exact optical depths.
//!
//! ```text
//! ball of radius R:  ∫₀^{2π} ∫₀^{π/2} τ(R sin θ, φ) R² sin θ cos θ dθ dφ,   half a chord is R cos θ
//! box:               ∫∫ τ(x, y) dx dy
//! ```
//!
//! Chords run along z, at even steps of φ and at Gauss nodes in panels of θ, or of x and y. For fields without
//! kinks both converge faster than any power of the number of chords. For grids and noise over a box the panels are
//! cut where cells meet, and the rule is exact. Resolutions are doubled until two agree twice, which cannot be an
//! accident, or the chords become too many. The differences of the last ones, and the errors of the optical depths,
//! make the error.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use media::{Medium, Smoothness, Volume};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::quadrature::GaussLegendre;
use numeric::sum::Sum;
use numeric::{Known, Span};

/// Relative difference of two resolutions at which no third is needed.
const AGREED: f64 = 1e-13;
/// Maximum number of chords of one resolution.
pub const MAX_CHORDS: f64 = 3e5;
/// Maximum number of pieces that all chords of one resolution may have: those of noise are many.
const MAX_PIECES: f64 = 6e5;
/// Minimum number of steps between resolutions: a single one has no information where there are kinks.
const LEAST_STEPS: usize = 2;
/// Nodes of a panel of θ.
const RINGS: usize = 8;
/// Nodes of a panel of x or y: exact up to the seventh power; the fade of noise needs the sixth.
const ROWS: usize = 4;

/// `∫σ_t dV` over a volume; `None` for one without bounds.
pub fn content(volume: &Volume) -> Option<Known> {
    by_chords(volume, MAX_CHORDS)
}

/// `∫σ_t dV` with a maximum number of chords in a resolution; `None` for a volume without bounds.
pub fn by_chords(volume: &Volume, maximum: f64) -> Option<Known> {
    let within = volume.bounds().enclosing_box()?;
    let height = within.high.0[2] - within.low.0[2];
    let maximum = maximum.min(MAX_PIECES / (1.0 + volume.facts().pieces_per_length * height));
    let mut chords = Chords::new(volume, &within);
    if matches!(chords, Chords::Box(_, true)) && chords.count(2) > maximum {
        // Cells that are finer than chords need no cuts.
        chords = Chords::whole(&within);
    }
    let is_exact = has_cells(volume) && matches!(chords, Chords::Box(_, true));
    let is_smooth = is_exact || !has_kinks(volume);
    // Twice, since one agreement may be an accident; an exact rule needs one.
    let needed = if is_exact { 1 } else { 2 };
    let at = |n: usize| chords.over(volume, &within, n);
    let mut n = 2;
    let mut before = at(1);
    let mut steps = Vec::new();
    loop {
        let here = at(n);
        steps.push((here.value - before.value).abs());
        // Kinks that no chord crosses leave any number of resolutions alike.
        let agree = |step: &f64| here.value > 0.0 && *step <= AGREED * here.value;
        let is_there =
            is_smooth && steps.len() >= needed && steps.iter().rev().take(needed).all(agree);
        if is_there || (steps.len() >= LEAST_STEPS && chords.count(2 * n) > maximum) {
            let error = if is_there {
                steps[steps.len() - 1]
            } else {
                // Noise bends so little that caps of it are negligible.
                let is_even = is_smooth || volume.facts().smoothness == Smoothness::SmoothCells;
                let maximum = if is_even { 0.0 } else { volume.majorant(&within) };
                settled(&steps, is_smooth) + maximum * chords.unseen(n)
            };
            let rounding = here.error + 8.0 * f64::EPSILON * here.value;
            return Some(Known::estimated(here.value, error + rounding));
        }
        (n, before) = (2 * n, here);
    }
}

/// Returns whether σ_t is a polynomial in cells along the axes.
fn has_cells(volume: &Volume) -> bool {
    matches!(volume.facts().smoothness, Smoothness::SmoothCells | Smoothness::Cells)
}

/// Returns whether σ_t jumps or bends.
fn has_kinks(volume: &Volume) -> bool {
    volume.facts().smoothness != Smoothness::Smooth
}

/// Error of a sequence of resolutions, from its last steps. Where the field is smooth, it is the last step if the
/// sequence settles fast, and four times that if it settles slowly. Kinks make steps of any size, and two
/// resolutions may be alike by accident: the largest of three steps, or of two, has more information, see
/// [`safety_factor`].
fn settled(steps: &[f64], is_smooth: bool) -> f64 {
    let last = &steps[steps.len().saturating_sub(3)..];
    let shrinks = |factor: f64| {
        is_smooth && last.len() == 3 && last.windows(2).all(|two| factor * two[1] <= two[0])
    };
    if shrinks(16.0) {
        last[2]
    } else if shrinks(4.0) {
        4.0 * last[2]
    } else {
        safety_factor(last.len()) * last.iter().copied().fold(0.0, f64::max)
    }
}

/// Probability that all steps are small beside the error of the last resolution.
const MISS_PROBABILITY: f64 = 3e-5;

/// Factor K by which the error of the last resolution may exceed the largest of m steps, except with probability
/// [`MISS_PROBABILITY`].
///
/// The position of a plane of kinks among the chords is random. The errors of resolutions are about independent and
/// normal, and at worst halved from one to the next. Let x be the last error in units of its standard deviation,
/// and yⱼ the errors before, with standard deviations 2ʲ. All steps are below |x|/K if every yⱼ is that near to the
/// one after it:
///
/// ```text
/// P = ∫ φ(x) ∏ⱼ (2|x|/K) φ(x/2ʲ)/2ʲ dx = (2/(πK²))^{m/2} E|z|^m 2^{−m(m+1)/2} q^{−(m+1)/2},
/// q = 1 + 1/4 + … + 4^{−m},  E|z|² = 1, E|z|³ = √(8/π)
/// ```
fn safety_factor(steps: usize) -> f64 {
    let (m, moment, q) =
        if steps < 3 { (2.0, 1.0, 1.3125_f64) } else { (3.0, (8.0 / PI).sqrt(), 1.328_125) };
    let rest = moment / (2f64.powf(0.5 * m * (m + 1.0)) * q.powf(0.5 * (m + 1.0)));
    (2.0 / PI).sqrt() * (rest / MISS_PROBABILITY).powf(1.0 / m)
}

/// Positions of chords: about the axis of a ball, or in panels of x and y.
enum Chords {
    /// Centre and radius of a ball.
    Ball(Point, f64),
    /// Ends of panels along x and y; true if they lie where kinks intersect the edges.
    Box([Vec<f64>; 2], bool),
}

impl Chords {
    fn new(volume: &Volume, within: &Aabb) -> Self {
        match volume.bounds() {
            Bounds::Sphere { centre, radius } => Self::Ball(centre, radius),
            Bounds::Box(_) | Bounds::Everywhere if has_kinks(volume) => {
                Self::Box([0, 1].map(|axis| cuts(volume, within, axis)), true)
            }
            Bounds::Box(_) | Bounds::Everywhere => Self::whole(within),
        }
    }

    fn whole(within: &Aabb) -> Self {
        Self::Box([0, 1].map(|i| vec![within.low.0[i], within.high.0[i]]), false)
    }

    /// The volume that a plane may cut off a ball without crossing any chord: between chords there is room for a
    /// cap of the radius ρ = 0.4 R/n and the volume πρ⁴/(4R); twice that is returned.
    fn unseen(&self, n: usize) -> f64 {
        match self {
            Self::Ball(_, radius) => 0.04 * radius.powi(3) / (n as f64).powi(4),
            Self::Box(..) => 0.0,
        }
    }

    /// Number of chords at a resolution of n.
    fn count(&self, n: usize) -> f64 {
        let square = (n * n) as f64;
        match self {
            Self::Ball(..) => (8 * RINGS) as f64 * square,
            Self::Box([xs, ys], _) => {
                ((xs.len() - 1) * (ys.len() - 1) * ROWS * ROWS) as f64 * square
            }
        }
    }

    /// `∫σ_t dV` at a resolution, with the error from the optical depths.
    fn over(&self, volume: &Volume, within: &Aabb, n: usize) -> Known {
        let (mut sum, mut error) = (Sum::default(), 0.0);
        let mut add = |x: f64, y: f64, area: f64| {
            let depth = depth(volume, within, x, y);
            sum.add(area * depth.value);
            error += area * depth.error;
        };
        match self {
            &Self::Ball(Point([x, y, _]), radius) => {
                let turns = 8 * n;
                for [tilt, width] in nodes(RINGS, n, &[0.0, FRAC_PI_2]) {
                    let across = radius * tilt.sin();
                    let area = width * TAU / turns as f64 * across * radius * tilt.cos();
                    for turn in 0..turns {
                        // An offset of half a step, so that no chord runs through a plane of symmetry.
                        let angle = TAU * (turn as f64 + 0.5) / turns as f64;
                        add(x + across * angle.cos(), y + across * angle.sin(), area);
                    }
                }
            }
            Self::Box([xs, ys], _) => {
                let rows = nodes(ROWS, n, ys);
                for [x, width] in nodes(ROWS, n, xs) {
                    for &[y, height] in &rows {
                        add(x, y, width * height);
                    }
                }
            }
        }
        Known::estimated(sum.value(), error)
    }
}

/// The ends of a box along an axis, and the places where edges along it intersect kinks: a part that a plane cuts
/// off a box lies about one of its corners.
fn cuts(volume: &Volume, within: &Aabb, axis: usize) -> Vec<f64> {
    let (low, high) = (within.low.0, within.high.0);
    let mut direction = Point([0.0; 3]);
    direction.0[axis] = 1.0;
    let mut ends = Vec::new();
    // Cells are equal along all edges.
    for edge in 0..if has_cells(volume) { 1 } else { 4 } {
        let mut origin = low;
        for (bit, i) in [(axis + 1) % 3, (axis + 2) % 3].into_iter().enumerate() {
            if edge >> bit & 1 == 1 {
                origin[i] = high[i];
            }
        }
        let ray = Ray { origin: Point(origin), direction, length: high[axis] - low[axis] };
        let profile = volume.along(&ray, ray.span());
        let breaks = Medium::new(profile, ray.span(), ray.span()).breaks();
        ends.extend(breaks.into_iter().map(|t| low[axis] + t));
    }
    Span::new(low[axis], high[axis]).cut(ends)
}

/// Nodes and weights of Gauss' rule in n panels between each two ends.
fn nodes(count: usize, n: usize, ends: &[f64]) -> Vec<[f64; 2]> {
    let rule = GaussLegendre::new(count);
    // The difference of two rounded ends would have fewer digits than the width.
    let panels = Span::between(ends).flat_map(|span| {
        let width = span.length() / n as f64;
        (0..n).map(move |i| (span.from + width * i as f64, Span::new(0.0, width)))
    });
    let of_panel = |(from, panel)| rule.on(panel).map(move |(x, weight)| [from + x, weight]);
    panels.flat_map(of_panel).collect()
}

/// The optical depth of a chord.
fn depth(volume: &Volume, within: &Aabb, x: f64, y: f64) -> Known {
    let origin = Point([x, y, within.low.0[2]]);
    let length = within.high.0[2] - within.low.0[2];
    let ray = Ray { origin, direction: Point([0.0, 0.0, 1.0]), length };
    let inside = volume.bounds().clip(&ray);
    if inside.is_empty() {
        return Known::new(0.0, 0.0);
    }
    let profile = volume.along(&ray, inside);
    Medium::new(profile, ray.span(), inside).optical_depth(inside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_safety_factor_has_the_probability_that_is_asked_for() {
        // The integral over x, by even steps, with the factor that it was solved for.
        for (m, about) in [(2, 42.0), (3, 6.2)] {
            let factor = safety_factor(m);
            assert!((factor / about - 1.0).abs() < 0.01, "{factor}");
            let density = |x: f64| (-0.5 * x * x).exp() / TAU.sqrt();
            let mut probability = 0.0;
            for i in 0..4000 {
                let x = 4e-3 * (f64::from(i) + 0.5);
                let near = |j: usize| {
                    let size = 2f64.powf(j as f64);
                    2.0 * x / factor * density(x / size) / size
                };
                probability += 2.0 * 4e-3 * density(x) * (1..=m).map(near).product::<f64>();
            }
            assert!((probability / MISS_PROBABILITY - 1.0).abs() < 1e-6, "{probability:e}");
        }
    }
}
