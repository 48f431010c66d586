//! Optical depths of every field, thick and thin, long and short, against closed forms in 32 digits,
//! and those of 3-D fields without one against quadrature of their lookups.

use super::fields::{FieldLine, LineField, Space, crossed};
use super::prelude::*;
use media::voxels::Interpolation::{Nearest, Trilinear};
use numeric::geometry::{Point, Ray};
use numeric::sum::Sum;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let fields = FIELDS.into_iter().enumerate().flat_map(|(kind, (name, range))| {
        let name = format!("optical depth, {name}");
        let rows = [TrialRow::stated(&name, range), TrialRow::relative(&name, range, 1e-9)];
        run.fill([320, 9600], rows, || line(kind), closed)
    });
    let mut rows: Vec<TrialRow> = fields.collect();
    let range = "cuts at breaks, too; stated errors and 1e-13";
    let sums = TrialRow::stated("optical depth, sum over splits", range);
    rows.extend(run.fill([320, 9600], [sums], Cut::any, splits));
    let range = "Eq. 21, noise, grids; from 0 … 1e4 away; stated and 1e-13";
    let lookups = TrialRow::stated("optical depth in 3-D, quadrature", range);
    rows.extend(run.fill([64, 1100], [lookups], Crossing::any, quadrature));
    rows
}

const FIELDS: [(&str, &str); 6] = [
    ("constant", "σ_t = 1e-12 … 1e6, length 1e-9 … 1e9"),
    ("piecewise constant", "1 … 30 pieces of 1e-9 … 1e6"),
    ("piecewise linear", "1 … 30 pieces of 1e-9 … 1e6"),
    ("exponential", "|rate·length| = 1e-12 … 600, length 1e-6 … 1e6"),
    ("Gaussian", "width 1e-6 … 1e3, up to 30 widths away"),
    ("sines", "1e-6 … 1e5 periods"),
];

/// A field of one of the kinds.
pub(super) fn line(kind: usize) -> proptest::strategy::SBoxedStrategy<FieldLine> {
    let knotted = |more: usize| {
        let values = (1..=30_usize).prop_flat_map(move |count| {
            let value =
                (sized(-9.0, 6.0), 0..4).prop_map(|(x, kind)| if kind == 0 { 0.0 } else { x });
            (between(-1.0, 1.0), vec(sized(-4.0, 3.0), count), vec(value, count + more))
        });
        values.prop_map(move |(from, widths, values)| {
            let knots = knots(from, &widths);
            let to = knots[widths.len()];
            let steps = |breaks, values| LineField::Steps { breaks, values };
            let lines = |knots, values| LineField::Lines { knots, values };
            FieldLine {
                field: if more == 0 { steps(knots, values) } else { lines(knots, values) },
                from,
                to,
            }
        })
    };
    match kind {
        0 => (sized(-12.0, 6.0), sized(-9.0, 9.0), begin())
            .prop_map(|(extinction, length, begin)| {
                let from = begin * length;
                FieldLine { field: LineField::Constant { extinction }, from, to: from + length }
            })
            .sboxed(),
        1 => knotted(0).sboxed(),
        2 => knotted(1).sboxed(),
        3 => (sized(-9.0, 6.0), sized(-6.0, 6.0), sign(), sized(-12.0, 2.7), between(-0.1, 0.1))
            .prop_map(|(extinction, length, sign, rate, begin)| {
                let (rate, from) = (sign * rate / length, begin * length);
                FieldLine {
                    field: LineField::Exponential { extinction, rate },
                    from,
                    to: from + length,
                }
            })
            .sboxed(),
        4 => (
            sized(-6.0, 6.0),
            sized(-6.0, 3.0),
            sign(),
            sized(-3.0, 2.0),
            between(-30.0, 30.0),
            sized(-3.0, 1.5),
        )
            .prop_map(|(peak, width, sign, centre, begin, length)| {
                let centre = sign * centre;
                let from = centre + begin * width;
                FieldLine {
                    field: LineField::Gaussian { peak, centre, width },
                    from,
                    to: from + length * width,
                }
            })
            .sboxed(),
        _ => (sized(-3.0, 3.0), sized(-3.0, 3.0), begin(), waves())
            .prop_map(|(base, length, begin, waves)| {
                let from = begin * length;
                let waves = waves.map(|[a, f, phase]| [a * base, f / length, phase]).to_vec();
                FieldLine { field: LineField::Sines { base, waves }, from, to: from + length }
            })
            .sboxed(),
    }
}

/// Beginning of a stretch, in lengths.
fn begin() -> impl Strategy<Value = f64> {
    (sign(), sized(-3.0, 1.0)).prop_map(|(sign, size)| sign * size)
}

fn waves() -> impl Strategy<Value = [[f64; 3]; 2]> {
    let slow = [between(-0.6, 0.6), sized(-6.0, 3.0), between(0.0, 6.3)];
    [slow, [between(-0.4, 0.4), sized(-1.0, 5.0), between(-6.3, 0.0)]]
}

/// Places from one on, with these widths between them.
pub(super) fn knots(from: f64, widths: &[f64]) -> Vec<f64> {
    let mut knots = vec![from];
    knots.extend(widths.iter().scan(from, |at, width| {
        *at += width;
        Some(*at)
    }));
    knots
}

fn closed(line: &FieldLine, seen: &mut Seen) -> Option<()> {
    let (exact, medium) = (line.depth(), line.medium());
    let depth = medium.optical_depth(medium.span());
    if exact.high.abs() < 1e-290 {
        return None;
    }
    seen.beyond_rounding(0, depth, exact);
    seen.relative(1, depth.value, exact);
    Some(())
}

parameters! {
    /// A field, and where it is cut: at places and at some of its breaks.
    Cut {
        line: FieldLine = (0..6_usize).prop_flat_map(line),
        places: Vec<f64> = vec(between(0.0, 1.0), 1..=4),
        breaks: Vec<f64> = vec(between(0.0, 1.0), 1..=4),
    }
    /// A ray through a field in space, from near and far.
    Crossing {
        field: Space = any_of(&[
            Space::Eq21,
            Space::Noise(2.0, 1.0, 3, Some(10.0)),
            Space::Noise(1.0, 0.3, 1, None),
            Space::Grid([7, 4, 9], Trilinear),
            Space::Grid([5, 6, 3], Nearest),
            Space::Gaussian(3.0, 0.6, 10.0),
        ]),
        target: [f64; 3] = [between(-6.0, 6.0), between(-6.0, 6.0), between(2.0, 18.0)],
        direction: [f64; 3] = [between(-1.0, 1.0); 3],
        away: f64 = prop_oneof![Just(12.0), sized(1.5, 4.0)],
    }
}

/// Stretches that follow each other add up, wherever the cuts are.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below the number of breaks
fn splits(Cut { line, places, breaks: chosen }: &Cut, seen: &mut Seen) {
    let medium = line.medium();
    let (span, breaks) = (medium.span(), medium.breaks());
    let whole = medium.optical_depth(span);
    let mut cuts = vec![span.from, span.to];
    cuts.extend(places.iter().map(|place| span.from + place * span.length()));
    if !breaks.is_empty() {
        cuts.extend(chosen.iter().map(|share| breaks[(share * breaks.len() as f64) as usize]));
    }
    cuts.sort_by(f64::total_cmp);
    let (mut sum, mut allowed) = (Sum::default(), whole.error + 1e-13 * whole.value);
    for part in Span::between(&cuts).map(|span| medium.optical_depth(span)) {
        sum.add(part.value);
        allowed += part.error;
    }
    seen.see(0, over((sum.value() - whole.value).abs(), allowed));
}

/// Rays from near and far through fields in space.
fn quadrature(crossing: &Crossing, seen: &mut Seen) -> Option<()> {
    let &Crossing { field, target, direction, away } = crossing;
    let direction = Point(direction).normalised()?;
    let ray = Ray::new(Point(target) - direction * away, direction, 2.0 * away)?;
    let medium = crossed(field.volume(), ray);
    let depth = medium.optical_depth(medium.span());
    // Lookups far from the origin are at places that are rounded.
    let grain = 4.0 * f64::EPSILON * away * medium.support().length();
    // A ray that misses the field has no depth, and no error to measure it by.
    let off = (by_lookups(&medium) - depth.value).abs();
    seen.see(0, over(off, depth.error + 1e-13 * depth.value + grain));
    Some(())
}

/// `∫σ_t` of lookups: panels between the breaks, halved until they agree.
fn by_lookups(medium: &Medium) -> f64 {
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
