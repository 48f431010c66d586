//! Free flights: the distance at which an optical depth is reached.

use super::depths::{knots, line};
use super::fields::FieldLine;
use super::prelude::*;

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let trials = [480, 48_000];
    let range = "all 1-D fields, 1e-12 of the whole and the grain of s";
    let mut rows = run.fill(
        trials,
        [TrialRow::stated("inverse of optical depth", range)],
        Flight::any,
        inverse,
    );
    let range = "1 … 12 pieces of 1e-9 … 1e6; 1e-12 and the grain of s";
    let row = TrialRow::stated("flight through pieces", range);
    rows.extend(run.fill(trials, [row], Pieces::any, pieces));
    let row = TrialRow::wrong("flights that end in gaps", "gaps of 1e-9 … 1e9 between pieces");
    rows.extend(run.fill(trials, [row], Gap::any, empty));
    rows
}

parameters! {
    /// A field, and the share of its depth that is flown.
    Flight {
        line: FieldLine = (0..6_usize).prop_flat_map(line),
        share: f64 = sized(-12.0, 0.0),
    }
    /// Straight pieces.
    Pieces {
        from: f64 = between(-1.0, 1.0),
        widths_and_values: Vec<(f64, f64)> = vec((sized(-3.0, 2.0), sized(-9.0, 6.0)), 2..=13),
        share: f64 = sized(-9.0, 0.0),
    }
    /// Two pieces with a gap between them.
    Gap {
        value: f64 = sized(-6.0, 6.0),
        widths: [f64; 3] = [sized(-3.0, 3.0), sized(-9.0, 9.0), sized(-3.0, 3.0)],
        share: f64 = between(0.0, 1.0),
    }
}

/// Tests that the optical depth of the sampled distance is the given depth, in any 1-D field, with and without a table.
fn inverse(Flight { line, share }: &Flight, seen: &mut Seen) -> Option<()> {
    let (medium, from) = (line.medium(), line.from);
    let whole = medium.optical_depth(medium.span());
    if !(1e-280..1e300).contains(&whole.value) {
        return None;
    }
    let depth = whole.value * share;
    for s in [medium.free_flight(depth), medium.inverse().free_flight(depth)] {
        let Some(s) = s else {
            let is_last = depth >= whole.value - whole.error;
            seen.see(0, if is_last { 0.0 } else { f64::NAN });
            continue;
        };
        let back = medium.optical_depth(Span::new(from, s));
        let grain = 2.0 * f64::EPSILON * s.abs().max(from.abs()) * medium.extinction(s);
        seen.see(0, (back.value - depth).abs() / (1e-12 * whole.value + back.error + grain));
    }
    Some(())
}

/// Straight pieces in 32 digits, through which every σ̂ is flown.
fn pieces(Pieces { from, widths_and_values, share }: &Pieces, seen: &mut Seen) -> Option<()> {
    let (widths, values): (Vec<f64>, Vec<f64>) = widths_and_values.iter().copied().unzip();
    let knots = knots(*from, &widths[1..]);
    let field = Piecewise::lines(&knots, &values);
    let depth_to = |end: f64| {
        let mut sum = DoubleDouble::default();
        for (pair, ends) in values.windows(2).zip(knots.windows(2)) {
            let [a, b, from, to] = [pair[0], pair[1], ends[0], ends[1]].map(DoubleDouble::from);
            let reach = if end < ends[1] { DoubleDouble::from(end) } else { to };
            if end > ends[0] {
                let width = reach - from;
                let slope = (b - a) / (to - from);
                sum += width * (a + (slope * width).scaled(-1));
            }
        }
        sum
    };
    let whole = depth_to(f64::INFINITY).value();
    let depth = whole * share;
    let mut cursor = field.begin();
    let value = cursor.fly(depth)?;
    let grain = 2.0 * f64::EPSILON * cursor.t().abs().max(1.0) * value;
    seen.see(0, off(depth, depth_to(cursor.t())) / (1e-12 * whole + grain));
    Some(())
}

/// A flight ends on no stretch where the field is zero.
fn empty(Gap { value, widths, share }: &Gap, seen: &mut Seen) -> Option<()> {
    let knots = knots(0.0, widths);
    if knots[2] <= knots[1] || knots[3] <= knots[2] {
        return None;
    }
    let field = Piecewise::steps(&knots, &[*value, 0.0, *value]);
    let mut cursor = field.begin();
    let there = cursor.fly(value * (widths[0] + widths[2]) * share)?;
    // A flight may end on the edge itself, where rounding puts it.
    let inside = Span::new(knots[1] * (1.0 + 1e-15), knots[2] * (1.0 - 1e-15));
    seen.wrong(0, inside.contains_inside(cursor.t()) || there != *value);
    Some(())
}
