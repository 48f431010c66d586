//! Free flights: the distance at which an optical depth is reached.

use super::{Dice, Effort, Measure, Row, in_parts, text};
use crate::media::Piecewise;
use crate::numeric::{Span, Wide};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(30, 3000);
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "flights", part);
        vec![inverse(dice, trials), pieces(dice, trials), empty(dice, trials)]
    })
}

/// Any 1-D field, with and without a table: the depth of the distance is the depth that was asked for.
fn inverse(dice: &mut Dice, trials: u32) -> Row {
    let range = "all 1-D fields, 1e-12 of the whole and the grain of s";
    let mut row = Row::new("inverse of optical depth", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let (sigma, length) = (dice.sized(-9.0, 4.0), dice.sized(-6.0, 6.0));
        let from = dice.between(-2.0, 2.0) * length;
        let span = format!("span = [{from:e}, {:e}]", from + length);
        let steep = dice.sign() * dice.sized(-6.0, 2.6) / length;
        let centre = from + dice.between(-0.2, 1.2) * length;
        let field = match dice.below(4) {
            0 => format!("constant.extinction = {sigma:e}"),
            1 => {
                let scale = sigma * (steep * from).max(-600.0).exp().min(1e200);
                format!("exponential = {{ extinction = {scale:e}, rate = {steep:e} }}")
            }
            2 => {
                let width = dice.sized(-3.0, 1.0) * length;
                format!("gaussian = {{ peak = {sigma:e}, centre = {centre:e}, width = {width:e} }}")
            }
            _ => {
                let waves = dice.sized(-1.0, 3.0) / length;
                format!(
                    "sines = {{ base = {sigma:e}, amplitudes = [{:e}], frequencies = [{waves:e}], \
                     phases = [{:e}] }}",
                    sigma * dice.sign(),
                    dice.between(0.0, 6.2)
                )
            }
        };
        let text = format!("medium.{field}\n{span}");
        let Some(medium) = text::medium(&text) else {
            row.skip(|| text.replace('\n', ", "));
            continue;
        };
        let whole = medium.optical_depth(medium.span());
        if !(1e-280..1e300).contains(&whole.value) {
            row.skip(|| text.replace('\n', ", "));
            continue;
        }
        let depth = whole.value * dice.sized(-12.0, 0.0);
        for s in [medium.free_flight(depth), medium.inverse().free_flight(depth)] {
            let Some(s) = s else {
                let is_last = depth >= whole.value - whole.error;
                row.see(if is_last { 0.0 } else { f64::NAN }, || text.replace('\n', ", "));
                continue;
            };
            let back = medium.optical_depth(Span::new(from, s));
            let grain = 2.0 * f64::EPSILON * s.abs().max(from.abs()) * medium.extinction(s);
            let off = (back.value - depth).abs();
            let allowed = 1e-12 * whole.value + back.error + grain;
            row.see(off / allowed, || format!("depth {depth:e}, {}", text.replace('\n', ", ")));
        }
    }
    row
}

/// Straight pieces in 32 digits: what every σ̂ is flown through by.
fn pieces(dice: &mut Dice, trials: u32) -> Row {
    let range = "1 … 12 pieces of 1e-9 … 1e6; 1e-12 and the grain of s";
    let mut row = Row::new("flight through pieces", range, Measure::OfStated, 1.0);
    for _ in 0..trials {
        let count = 2 + dice.below(12);
        let mut knots = vec![dice.between(-1.0, 1.0)];
        for _ in 1..count {
            knots.push(knots[knots.len() - 1] + dice.sized(-3.0, 2.0));
        }
        let values: Vec<f64> = (0..count).map(|_| dice.sized(-9.0, 6.0)).collect();
        let field = Piecewise::lines(&knots, &values);
        let depth_to = |end: f64| {
            let mut sum = Wide::default();
            for (pair, ends) in values.windows(2).zip(knots.windows(2)) {
                let [a, b, from, to] = [pair[0], pair[1], ends[0], ends[1]].map(Wide::from);
                let reach = if end < ends[1] { Wide::from(end) } else { to };
                if end > ends[0] {
                    let width = reach - from;
                    let slope = (b - a) / (to - from);
                    sum += width * (a + (slope * width).scaled(-1));
                }
            }
            sum
        };
        let whole = depth_to(f64::INFINITY).value();
        let depth = whole * dice.sized(-9.0, 0.0);
        let mut cursor = field.begin();
        let place = || format!("{knots:?} {values:?} to {depth:e}");
        let Some(value) = field.fly(&mut cursor, depth) else {
            row.skip(place);
            continue;
        };
        let off = (depth_to(cursor.t) - Wide::from(depth)).abs().value();
        let grain = 2.0 * f64::EPSILON * cursor.t.abs().max(1.0) * value;
        row.see(off / (1e-12 * whole + grain), place);
    }
    row
}

/// Stretches on which nothing is: a flight ends on none of them.
fn empty(dice: &mut Dice, trials: u32) -> Row {
    let range = "gaps of 1e-9 … 1e9 between pieces";
    let mut row = Row::new("flights that end in gaps", range, Measure::Count, 0.0);
    for _ in 0..trials {
        let value = dice.sized(-6.0, 6.0);
        let (first, gap, last) =
            (dice.sized(-3.0, 3.0), dice.sized(-9.0, 9.0), dice.sized(-3.0, 3.0));
        let knots = [0.0, first, first + gap, first + gap + last];
        if knots[2] <= knots[1] || knots[3] <= knots[2] {
            row.skip(|| format!("{knots:?}"));
            continue;
        }
        let field = Piecewise::steps(&knots, &[value, 0.0, value]);
        let depth = value * (first + last) * dice.between(0.0, 1.0);
        let mut cursor = field.begin();
        let Some(there) = field.fly(&mut cursor, depth) else {
            row.skip(|| format!("{knots:?}, depth {depth:e}"));
            continue;
        };
        // A flight may end on the edge itself, where rounding puts it.
        let inside = Span::new(knots[1] * (1.0 + 1e-15), knots[2] * (1.0 - 1e-15));
        let is_wrong = inside.contains_inside(cursor.t) || there != value;
        row.count(is_wrong, || format!("{knots:?}, depth {depth:e}: {:e}", cursor.t));
    }
    row
}
