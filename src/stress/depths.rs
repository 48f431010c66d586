//! Optical depths of every field, thick and thin, long and short, against closed forms in 32 digits,
//! and those of 3-D fields without one against quadrature of their lookups.

use super::tails::normal_between;
use super::text::{self, one_line};
use super::trial::{Dice, Trial, beyond_rounding, of_allowed};
use super::{Effort, Row, in_parts};
use media::Medium;
use numeric::quadrature::GaussLegendre;
use numeric::sum::Sum;
use numeric::{Span, Wide};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(10, 300);
    in_parts(32, "depths", seed, |part| {
        for (name, range, draw) in FIELDS {
            let name = format!("optical depth, {name}");
            let rows = [Row::stated(&name, range), Row::relative(&name, range, 1e-9)];
            part.run(trials, rows, |t| closed(t, draw));
        }
        let range = "cuts at breaks, too; stated errors and 1e-13";
        part.run(trials, [Row::stated("optical depth, sum over splits", range)], splits);
        let range = "Eq. 21, noise, grids; from 0 … 1e4 away; stated and 1e-13";
        let rows = [Row::stated("optical depth in 3-D, quadrature", range)];
        part.run(trials / 9 + 1, rows, lookups);
    })
}

/// A random field as text with its exact depth.
type Field = fn(&mut Dice) -> (String, Wide);

const FIELDS: [(&str, &str, Field); 6] = [
    ("constant", "σ_t = 1e-12 … 1e6, length 1e-9 … 1e9", constant),
    ("piecewise constant", "1 … 30 pieces of 1e-9 … 1e6", piecewise_constant),
    ("piecewise linear", "1 … 30 pieces of 1e-9 … 1e6", piecewise_linear),
    ("exponential", "|rate·length| = 1e-12 … 600, length 1e-6 … 1e6", exponential),
    ("Gaussian", "width 1e-6 … 1e3, up to 30 widths away", gaussian),
    ("sines", "1e-6 … 1e5 periods", sines),
];

fn closed(t: &mut Trial, draw: Field) -> Option<()> {
    let (text, exact) = draw(t.dice);
    t.place = one_line(&text);
    let Some(medium) = text::medium(&text) else {
        t.see(0, f64::NAN);
        return Some(());
    };
    let depth = medium.optical_depth(medium.span());
    if exact.high.abs() < 1e-290 {
        return None;
    }
    // The nearest double to the truth is half a unit off at best.
    t.see(0, beyond_rounding(depth, exact));
    t.relative(1, depth.value, exact);
    Some(())
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
    let exact = (Wide::from(to) - from) * sigma;
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
    knots.windows(2).map(|pair| Wide::from(pair[1]) - pair[0])
}

fn piecewise_constant(dice: &mut Dice) -> (String, Wide) {
    let [knots, values] = pieces(dice, 0);
    let exact = widths(&knots).zip(&values).map(|(width, &value)| width * value).sum();
    let field = format!("piecewise-constant = {{ breaks = {knots:?}, values = {values:?} }}");
    (spanned(&field, ends(&knots)), exact)
}

fn piecewise_linear(dice: &mut Dice) -> (String, Wide) {
    let [knots, values] = pieces(dice, 1);
    let mean = |pair: &[f64]| (Wide::from(pair[0]) + pair[1]).scaled(-1);
    let exact = widths(&knots).zip(values.windows(2)).map(|(width, pair)| width * mean(pair)).sum();
    let field = format!("piecewise-linear = {{ knots = {knots:?}, values = {values:?} }}");
    (spanned(&field, ends(&knots)), exact)
}

fn exponential(dice: &mut Dice) -> (String, Wide) {
    let (sigma, length) = (dice.sized(-9.0, 6.0), dice.sized(-6.0, 6.0));
    let rate = dice.sign() * dice.sized(-12.0, 2.7) / length;
    let from = dice.between(-0.1, 0.1) * length;
    let to = from + length;
    let (slope, way) = (Wide::from(rate), Wide::from(to) - from);
    let first = (-(slope * from)).exp() * sigma;
    let exact = -(-(slope * way)).exp_m1() / slope * first;
    let field = format!("exponential = {{ extinction = {sigma:e}, rate = {rate:e} }}");
    (spanned(&field, [from, to]), exact)
}

fn gaussian(dice: &mut Dice) -> (String, Wide) {
    let (peak, width) = (dice.sized(-6.0, 6.0), dice.sized(-6.0, 3.0));
    let centre = dice.sign() * dice.sized(-3.0, 2.0);
    let from = centre + dice.between(-30.0, 30.0) * width;
    let to = from + dice.sized(-3.0, 1.5) * width;
    let z = |s: f64| (Wide::from(s) - centre) / width;
    let share = normal_between(z(from), z(to));
    let exact = share * Wide::PI.scaled(1).sqrt() * width * peak;
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
    let way = Wide::from(to) - from;
    let mut exact = way * base;
    for ((amplitude, frequency), phase) in amplitudes.into_iter().zip(frequencies).zip(phases) {
        let cosine = |s: f64| {
            let [_, cosine] = (Wide::product(frequency, s) + phase).sin_cos();
            cosine
        };
        exact += (cosine(from) - cosine(to)) * amplitude / frequency;
    }
    let field = format!(
        "sines = {{ base = {base:e}, amplitudes = {amplitudes:?}, frequencies = {frequencies:?}, phases = {phases:?} }}"
    );
    (spanned(&field, [from, to]), exact)
}

/// Stretches that follow each other add up, wherever the cuts are: at breaks, too.
fn splits(t: &mut Trial) -> Option<()> {
    let (_, _, draw) = FIELDS[t.dice.below(FIELDS.len())];
    let (text, _) = draw(t.dice);
    t.place = one_line(&text);
    let medium = text::medium(&text)?;
    let (span, breaks) = (medium.span(), medium.breaks());
    let whole = medium.optical_depth(span);
    let mut cuts = vec![span.from, span.to];
    for _ in 0..=t.dice.below(4) {
        cuts.push(span.from + t.dice.between(0.0, 1.0) * span.length());
        if !breaks.is_empty() {
            cuts.push(breaks[t.dice.below(breaks.len())]);
        }
    }
    cuts.sort_by(f64::total_cmp);
    let (mut sum, mut allowed) = (Sum::default(), whole.error + 1e-13 * whole.value);
    for part in Span::between(&cuts).map(|span| medium.optical_depth(span)) {
        sum.add(part.value);
        allowed += part.error;
    }
    t.see(0, of_allowed((sum.value() - whole.value).abs(), allowed));
    Some(())
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
fn lookups(t: &mut Trial) -> Option<()> {
    let dice = &mut *t.dice;
    let field = VOLUMES[dice.below(VOLUMES.len())];
    let target = [dice.between(-6.0, 6.0), dice.between(-6.0, 6.0), dice.between(2.0, 18.0)];
    let direction = [0; 3].map(|_| dice.between(-1.0, 1.0));
    let norm = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
    let back = if dice.below(2) == 0 { 12.0 } else { dice.sized(1.5, 4.0) };
    let origin = [0, 1, 2].map(|i| target[i] - back * direction[i] / norm);
    let length = 2.0 * back;
    let ray = format!("{{ origin = {origin:?}, direction = {direction:?}, length = {length} }}");
    let text = format!("volume.{field}\nray = {ray}");
    t.place = one_line(&text);
    let medium = text::medium(&text)?;
    let depth = medium.optical_depth(medium.span());
    // Lookups far from the origin are at places that are rounded.
    let grain = 4.0 * f64::EPSILON * back * medium.support().length();
    let allowed = depth.error + 1e-13 * depth.value + grain;
    // A ray that misses the field has no depth, and no error to measure it by.
    t.see(0, of_allowed((quadrature(&medium) - depth.value).abs(), allowed));
    Some(())
}

/// `∫σ_t` of lookups: panels between the breaks, halved until they agree.
fn quadrature(medium: &Medium) -> f64 {
    let (rule, support) = (GaussLegendre::new(20), medium.support());
    let mut ends = medium.breaks();
    ends.extend([support.from, support.to]);
    ends.sort_by(f64::total_cmp);
    let panel = |a: f64, b: f64| {
        let values = medium.extinctions(&rule.nodes_on(Span::new(a, b)));
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
