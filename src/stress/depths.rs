//! Optical depths of every field, thick and thin, long and short, against closed forms in 32 digits,
//! and those of 3-D fields without one against quadrature of their lookups.

use super::tails::normal_tail;
use super::{Dice, Effort, Measure, Row, beyond, in_parts, text};
use crate::media::Medium;
use crate::numeric::quadrature::GaussLegendre;
use crate::numeric::sum::Sum;
use crate::numeric::{Span, Wide};

const PARTS: u64 = 32;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(10, 300);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "depths", part);
        let mut rows: Vec<Row> =
            FIELDS.iter().flat_map(|field| closed(dice, trials, field)).collect();
        rows.push(splits(dice, trials));
        rows.push(lookups(dice, trials / 9 + 1));
        rows
    })
}

/// A random field as text with its exact depth.
type Field = (&'static str, &'static str, fn(&mut Dice) -> (String, Wide));

const FIELDS: [Field; 6] = [
    ("constant", "σ_t = 1e-12 … 1e6, length 1e-9 … 1e9", constant),
    ("piecewise constant", "1 … 30 pieces of 1e-9 … 1e6", piecewise_constant),
    ("piecewise linear", "1 … 30 pieces of 1e-9 … 1e6", piecewise_linear),
    ("exponential", "|rate·length| = 1e-12 … 600, length 1e-6 … 1e6", exponential),
    ("Gaussian", "width 1e-6 … 1e3, up to 30 widths away", gaussian),
    ("sines", "1e-6 … 1e5 periods", sines),
];

fn closed(dice: &mut Dice, trials: u32, &(name, range, draw): &Field) -> [Row; 2] {
    let name = format!("optical depth, {name}");
    let mut stated = Row::new(&name, range, Measure::OfStated, 1.0);
    let mut relative = Row::new(&name, range, Measure::Relative, 1e-9);
    for _ in 0..trials {
        let (text, exact) = draw(dice);
        let Some(medium) = text::medium(&text) else {
            stated.see(f64::NAN, || text.clone());
            continue;
        };
        let depth = medium.optical_depth(medium.span());
        if exact.high.abs() < 1e-290 {
            stated.skip(|| one_line(&text));
            relative.skip(|| one_line(&text));
            continue;
        }
        // The nearest double to the truth is half a unit off at best.
        let rounding = 0.5 * f64::EPSILON * exact.high;
        let off = (Wide::from(depth.value) - exact).abs().value();
        stated.see(beyond(off, rounding) / depth.error, || one_line(&text));
        relative.see(exact.relative_error(depth.value), || one_line(&text));
    }
    [stated, relative]
}

fn one_line(text: &str) -> String {
    text.replace('\n', ", ")
}

fn span(dice: &mut Dice, length: f64) -> [f64; 2] {
    let from = dice.sign() * dice.sized(-3.0, 1.0) * length;
    [from, from + length]
}

fn spanned(field: &str, [from, to]: [f64; 2]) -> String {
    format!("medium.{field}\nspan = [{from:e}, {to:e}]")
}

fn constant(dice: &mut Dice) -> (String, Wide) {
    let sigma = dice.sized(-12.0, 6.0);
    let length = dice.sized(-9.0, 9.0);
    let [from, to] = span(dice, length);
    let exact = (Wide::from(to) - Wide::from(from)) * Wide::from(sigma);
    (spanned(&format!("constant.extinction = {sigma:e}"), [from, to]), exact)
}

/// Knots and values of 1 to 30 pieces, some of them empty.
fn pieces(dice: &mut Dice, more: usize) -> [Vec<f64>; 2] {
    let count = 1 + dice.below(30);
    let mut knots = vec![dice.between(-1.0, 1.0)];
    let mut values = Vec::new();
    for _ in 0..count {
        knots.push(knots[knots.len() - 1] + dice.sized(-4.0, 3.0));
    }
    for _ in 0..count + more {
        values.push(if dice.below(4) == 0 { 0.0 } else { dice.sized(-9.0, 6.0) });
    }
    [knots, values]
}

fn ends(knots: &[f64]) -> [f64; 2] {
    [knots[0], knots[knots.len() - 1]]
}

fn widths(knots: &[f64]) -> impl Iterator<Item = Wide> + '_ {
    knots.windows(2).map(|pair| Wide::from(pair[1]) - Wide::from(pair[0]))
}

fn piecewise_constant(dice: &mut Dice) -> (String, Wide) {
    let [knots, values] = pieces(dice, 0);
    let exact = widths(&knots).zip(&values).map(|(width, &value)| width * Wide::from(value)).sum();
    let field = format!("piecewise-constant = {{ breaks = {knots:?}, values = {values:?} }}");
    (spanned(&field, ends(&knots)), exact)
}

fn piecewise_linear(dice: &mut Dice) -> (String, Wide) {
    let [knots, values] = pieces(dice, 1);
    let mean = |pair: &[f64]| (Wide::from(pair[0]) + Wide::from(pair[1])).scaled(-1);
    let exact = widths(&knots).zip(values.windows(2)).map(|(width, pair)| width * mean(pair)).sum();
    let field = format!("piecewise-linear = {{ knots = {knots:?}, values = {values:?} }}");
    (spanned(&field, ends(&knots)), exact)
}

fn exponential(dice: &mut Dice) -> (String, Wide) {
    let (sigma, length) = (dice.sized(-9.0, 6.0), dice.sized(-6.0, 6.0));
    let rate = dice.sign() * dice.sized(-12.0, 2.7) / length;
    let from = dice.between(-0.1, 0.1) * length;
    let to = from + length;
    let (slope, way) = (Wide::from(rate), Wide::from(to) - Wide::from(from));
    let first = (-(slope * Wide::from(from))).exp() * Wide::from(sigma);
    let exact = -(-(slope * way)).exp_m1() / slope * first;
    (
        spanned(
            &format!("exponential = {{ extinction = {sigma:e}, rate = {rate:e} }}"),
            [from, to],
        ),
        exact,
    )
}

fn gaussian(dice: &mut Dice) -> (String, Wide) {
    let (peak, width) = (dice.sized(-6.0, 6.0), dice.sized(-6.0, 3.0));
    let centre = dice.sign() * dice.sized(-3.0, 2.0);
    let from = centre + dice.between(-30.0, 30.0) * width;
    let to = from + dice.sized(-3.0, 1.5) * width;
    // Q on both sides of the foot, by reflection.
    let tail = |s: f64| {
        let z = (Wide::from(s) - Wide::from(centre)) / Wide::from(width);
        if z.high < 0.0 { (normal_tail(-z), true) } else { (normal_tail(z), false) }
    };
    let share = match (tail(from), tail(to)) {
        ((a, false), (b, _)) => a - b,
        ((a, true), (b, true)) => b - a,
        ((a, true), (b, false)) => Wide::ONE - a - b,
    };
    let exact = share * Wide::PI.scaled(1).sqrt() * Wide::from(width) * Wide::from(peak);
    let field = format!("gaussian = {{ peak = {peak:e}, centre = {centre:e}, width = {width:e} }}");
    (spanned(&field, [from, to]), exact)
}

fn sines(dice: &mut Dice) -> (String, Wide) {
    let base = dice.sized(-3.0, 3.0);
    let amplitudes = [dice.between(-0.6, 0.6) * base, dice.between(-0.4, 0.4) * base];
    let length = dice.sized(-3.0, 3.0);
    let [from, to] = span(dice, length);
    let frequencies = [dice.sized(-6.0, 3.0) / length, dice.sized(-1.0, 5.0) / length];
    let phases = [dice.between(0.0, 6.3), dice.between(-6.3, 0.0)];
    let way = Wide::from(to) - Wide::from(from);
    let mut exact = way * Wide::from(base);
    for ((amplitude, frequency), phase) in amplitudes.into_iter().zip(frequencies).zip(phases) {
        let cosine = |s: f64| {
            let [_, cosine] = (Wide::product(frequency, s) + Wide::from(phase)).sin_cos();
            cosine
        };
        exact += (cosine(from) - cosine(to)) * Wide::from(amplitude) / Wide::from(frequency);
    }
    let field = format!(
        "sines = {{ base = {base:e}, amplitudes = {amplitudes:?}, frequencies = {frequencies:?}, phases = {phases:?} }}"
    );
    (spanned(&field, [from, to]), exact)
}

/// Stretches that follow each other add up, wherever the cuts are: at breaks, too.
fn splits(dice: &mut Dice, trials: u32) -> Row {
    let range = "cuts at breaks, too; stated errors and 1e-13";
    let mut row = Row::new("optical depth, sum over splits", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (text, _) = FIELDS[dice.below(FIELDS.len())].2(dice);
        let Some(medium) = text::medium(&text) else {
            row.skip(|| one_line(&text));
            continue;
        };
        let (span, breaks) = (medium.span(), medium.breaks());
        let whole = medium.optical_depth(span);
        let mut cuts = vec![span.from, span.to];
        for _ in 0..=dice.below(4) {
            cuts.push(span.from + dice.between(0.0, 1.0) * span.length());
            if !breaks.is_empty() {
                cuts.push(breaks[dice.below(breaks.len())]);
            }
        }
        cuts.sort_by(f64::total_cmp);
        let (mut sum, mut allowed) = (Sum::default(), whole.error + 1e-13 * whole.value);
        for pair in cuts.windows(2) {
            let part = medium.optical_depth(Span::new(pair[0], pair[1]));
            sum.add(part.value);
            allowed += part.error;
        }
        let off = (sum.value() - whole.value).abs();
        row.see(if off == 0.0 { 0.0 } else { off / allowed }, || one_line(&text));
    }
    row
}

const VOLUMES: [&str; 6] = [
    "eq21 = {}",
    "noise = { extinction = 2, octaves = 3, bounds.sphere = { centre = [0, 0, 10], radius = 10 } }",
    "noise = { extinction = 1, octaves = 1, frequency = 0.3 }",
    "grid = { random = { size = [7, 4, 9] }, bounds.box = { low = [-8, -8, 0], high = [8, 8, 20] } }",
    "grid = { random = { size = [5, 6, 3] }, interpolation = \"nearest\", bounds.box = { low = [-8, -8, 0], high = [8, 8, 20] } }",
    "gaussian = { peak = 3, centre = [1, 0, 9], width = 0.6, bounds.sphere = { centre = [0, 0, 10], radius = 10 } }",
];

/// Rays from near and far through fields in space.
fn lookups(dice: &mut Dice, trials: u32) -> Row {
    let range = "Eq. 21, noise, grids; from 0 … 1e4 away; stated and 1e-13";
    let mut row = Row::new("optical depth in 3-D, quadrature", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let field = VOLUMES[dice.below(VOLUMES.len())];
        let target = [dice.between(-6.0, 6.0), dice.between(-6.0, 6.0), dice.between(2.0, 18.0)];
        let direction = [0; 3].map(|_| dice.between(-1.0, 1.0));
        let norm = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        let back = if dice.below(2) == 0 { 12.0 } else { dice.sized(1.5, 4.0) };
        let origin: Vec<f64> =
            target.iter().zip(direction).map(|(at, along)| at - back * along / norm).collect();
        let ray = format!(
            "{{ origin = {origin:?}, direction = {direction:?}, length = {} }}",
            2.0 * back
        );
        let text = format!("volume.{field}\nray = {ray}");
        let Some(medium) = text::medium(&text) else {
            row.skip(|| one_line(&text));
            continue;
        };
        let depth = medium.optical_depth(medium.span());
        let found = quadrature(&medium);
        // Lookups far from the origin are at places that are rounded.
        let grain = 4.0 * f64::EPSILON * back * medium.support().length();
        let allowed = depth.error + 1e-13 * depth.value + grain;
        // A ray that misses the field has no depth, and no error to measure it by.
        let off = (found - depth.value).abs();
        row.see(if off == 0.0 { 0.0 } else { off / allowed }, || one_line(&text));
    }
    row
}

/// `∫σ_t` of lookups: panels between the breaks, halved until they agree.
fn quadrature(medium: &Medium) -> f64 {
    let (rule, support) = (GaussLegendre::new(20), medium.support());
    let mut ends = medium.breaks();
    ends.extend([support.from, support.to]);
    ends.sort_by(f64::total_cmp);
    let panel = |a: f64, b: f64| {
        let at: Vec<f64> = rule.nodes.iter().map(|x| a + (b - a) * x).collect();
        let values = medium.extinctions(&at);
        (b - a) * rule.weights.iter().zip(values).map(|(w, v)| w * v).sum::<f64>()
    };
    let mut sum = Sum::default();
    let mut open: Vec<(f64, f64, u32)> = ends.windows(2).map(|e| (e[0], e[1], 0)).collect();
    while let Some((a, b, depth)) = open.pop() {
        let middle = 0.5 * (a + b);
        let (whole, halves) = (panel(a, b), panel(a, middle) + panel(middle, b));
        if (whole - halves).abs() <= 1e-14 * halves || depth == 8 {
            sum.add(halves);
        } else {
            open.extend([(a, middle, depth + 1), (middle, b, depth + 1)]);
        }
    }
    sum.value()
}
