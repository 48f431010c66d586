//! Free flights: the distance at which an optical depth is reached.

use super::text::{self, one_line};
use super::trial::{Trial, off};
use super::{Effort, Row, in_parts};
use media::Piecewise;
use numeric::{Span, Wide};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(30, 3000);
    in_parts(16, "flights", seed, |part| {
        let range = "all 1-D fields, 1e-12 of the whole and the grain of s";
        part.run(trials, [Row::stated("inverse of optical depth", range)], inverse);
        let range = "1 … 12 pieces of 1e-9 … 1e6; 1e-12 and the grain of s";
        part.run(trials, [Row::stated("flight through pieces", range)], pieces);
        let range = "gaps of 1e-9 … 1e9 between pieces";
        part.run(trials, [Row::wrong("flights that end in gaps", range)], empty);
    })
}

/// Any 1-D field, with and without a table: the depth of the distance is the depth that was asked for.
fn inverse(t: &mut Trial) -> Option<()> {
    let dice = &mut *t.dice;
    let (sigma, length) = (dice.sized(-9.0, 4.0), dice.sized(-6.0, 6.0));
    let from = dice.between(-2.0, 2.0) * length;
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
            let (amplitude, phase) = (sigma * dice.sign(), dice.between(0.0, 6.2));
            format!(
                "sines = {{ base = {sigma:e}, amplitudes = [{amplitude:e}], \
                 frequencies = [{waves:e}], phases = [{phase:e}] }}"
            )
        }
    };
    let text = format!("medium.{field}\nspan = [{from:e}, {:e}]", from + length);
    t.place = one_line(&text);
    let medium = text::medium(&text)?;
    let whole = medium.optical_depth(medium.span());
    if !(1e-280..1e300).contains(&whole.value) {
        return None;
    }
    let depth = whole.value * t.dice.sized(-12.0, 0.0);
    for s in [medium.free_flight(depth), medium.inverse().free_flight(depth)] {
        t.place = one_line(&text);
        let Some(s) = s else {
            let is_last = depth >= whole.value - whole.error;
            t.see(0, if is_last { 0.0 } else { f64::NAN });
            continue;
        };
        let back = medium.optical_depth(Span::new(from, s));
        let grain = 2.0 * f64::EPSILON * s.abs().max(from.abs()) * medium.extinction(s);
        let allowed = 1e-12 * whole.value + back.error + grain;
        t.place.insert_str(0, &format!("depth {depth:e}, "));
        t.see(0, (back.value - depth).abs() / allowed);
    }
    Some(())
}

/// Straight pieces in 32 digits: what every σ̂ is flown through by.
fn pieces(t: &mut Trial) -> Option<()> {
    let count = 2 + t.dice.below(12);
    let mut knots = vec![t.dice.between(-1.0, 1.0)];
    for _ in 1..count {
        knots.push(knots[knots.len() - 1] + t.dice.sized(-3.0, 2.0));
    }
    let values: Vec<f64> = (0..count).map(|_| t.dice.sized(-9.0, 6.0)).collect();
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
    let depth = whole * t.dice.sized(-9.0, 0.0);
    t.place = format!("{knots:?} {values:?} to {depth:e}");
    let mut cursor = field.begin();
    let value = field.fly(&mut cursor, depth)?;
    let grain = 2.0 * f64::EPSILON * cursor.t.abs().max(1.0) * value;
    t.see(0, off(depth, depth_to(cursor.t)) / (1e-12 * whole + grain));
    Some(())
}

/// Stretches on which nothing is: a flight ends on none of them.
fn empty(t: &mut Trial) -> Option<()> {
    let value = t.dice.sized(-6.0, 6.0);
    let [first, gap, last] =
        [(-3.0, 3.0), (-9.0, 9.0), (-3.0, 3.0)].map(|(a, b)| t.dice.sized(a, b));
    let knots = [0.0, first, first + gap, first + gap + last];
    t.place = format!("{knots:?}");
    if knots[2] <= knots[1] || knots[3] <= knots[2] {
        return None;
    }
    let field = Piecewise::steps(&knots, &[value, 0.0, value]);
    let depth = value * (first + last) * t.dice.between(0.0, 1.0);
    t.place = format!("{knots:?}, depth {depth:e}");
    let mut cursor = field.begin();
    let there = field.fly(&mut cursor, depth)?;
    // A flight may end on the edge itself, where rounding puts it.
    let inside = Span::new(knots[1] * (1.0 + 1e-15), knots[2] * (1.0 - 1e-15));
    t.place = format!("{}: {:e}", t.place, cursor.t);
    t.count(0, inside.contains_inside(cursor.t) || there != value);
    Some(())
}
