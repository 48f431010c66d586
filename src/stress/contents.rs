//! `∫σ_t dV` over balls and boxes, against closed forms in 32 digits and rules that are exact in every cell.
//!
//! ```text
//! over a ball of radius R, q = |k|R:  ∫ e^{−k·p} dV = e^{−k·c} 4π (q cosh q − sinh q)/|k|³
//!                                     ∫ sin(k·p + φ) dV = sin(k·c + φ) 4π (sin q − q cos q)/|k|³
//! layers, h the height over the centre:  ∫ (α + βh) π(R² − h²) dh
//! a Gaussian of width w, d from the centre:
//!     (2π)^{3/2} w³ [Φ(b) − Φ(−a) − (φ(b) − φ(a))/δ],   δ = d/w, b = R/w − δ, a = R/w + δ
//! radial:  Σ cₖ 4πR³/(2k + 3)
//! ```
//!
//! Over a box all but the radial field are products of integrals along its edges.

use super::bodies::{Body, dot, sinc, sine_over, sinh_over, sinhc};
use super::tails::normal_between;
use super::text;
use super::trial::{Dice, Trial, beyond_rounding};
use super::{Effort, Row, in_parts};
use media::Volume;
use numeric::geometry::Point;
use numeric::quadrature::GaussLegendre;
use numeric::{Span, Wide};
use theory::space::content;

/// Where fields jump across chords: so that a thousand of them take seconds, not minutes.
const FEW_CHORDS: f64 = 4e3;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(2, 64);
    in_parts(16, "contents", seed, |part| {
        let range = "smooth fields of five kinds, balls and boxes";
        part.run(trials, [Row::stated("∫σ_t dV, closed form", range)], smooth);
        let few = effort.of(u32::from(part.number == 0), 1);
        for (trials, chords, range) in [
            (trials, FEW_CHORDS, "layers at any angle, 4e3 chords"),
            (few, content::MOST_CHORDS, "layers at any angle, 3e5 chords"),
        ] {
            part.run(trials, [Row::stated("∫σ_t dV, layers", range)], |t| layers(t, chords));
        }
        let range = "grids and noise over boxes, 4e3 chords; by cells";
        part.run(trials, [Row::stated("∫σ_t dV, cells", range)], cells);
    })
}

fn exponential(dice: &mut Dice) -> (String, Wide) {
    let body = Body::of(dice);
    // Along z or across it: reading an oblique axis rounds it.
    let axis = dice.below(3);
    let (sigma, rate) = (dice.sized(-6.0, 6.0), dice.sign() * dice.sized(-6.0, 1.5) / body.size());
    let mut k = [0.0; 3];
    k[axis] = rate;
    let exact = (-dot(k, body.centre())).exp() * body.wave(k, sinhc, sinh_over);
    let mut along = [0; 3];
    along[axis] = 1;
    let field = format!(
        "volume.exponential = {{ extinction = {sigma:e}, rate = {rate:e}, axis = {along:?}, {} }}",
        body.text()
    );
    (field, exact * sigma)
}

fn sines(dice: &mut Dice) -> (String, Wide) {
    let body = Body::of(dice);
    let (base, size) = (dice.sized(-3.0, 3.0), dice.sized(-2.0, 1.3) / body.size());
    let (amplitude, phase) = (dice.between(-1.0, 1.0) * base, dice.between(-3.0, 3.0));
    let k = [0; 3].map(|_| size * dice.between(-1.0, 1.0));
    let [sine, _] = (dot(k, body.centre()) + phase).sin_cos();
    let waves = amplitude * sine * body.wave(k, sinc, sine_over);
    let even = base * body.wave([0.0; 3], sinc, sine_over);
    let field = format!(
        "volume.sines = {{ base = {base:e}, amplitudes = [{amplitude:e}], vectors = [{k:?}], \
         phases = [{phase:e}], {} }}",
        body.text()
    );
    (field, waves + even)
}

fn gaussian(dice: &mut Dice) -> (String, Wide) {
    let body = Body::of(dice);
    let (peak, width) = (dice.sized(-6.0, 6.0), dice.sized(-1.0, 1.5) * body.size());
    let centre = body.near(dice);
    let w = Wide::from(width);
    let offsets = [0, 1, 2].map(|i| Wide::from(centre[i]) - body.centre()[i]);
    let exact = match body {
        Body::Ball(_, radius) => {
            let delta = offsets.iter().map(|&x| x * x).sum::<Wide>().sqrt() / w;
            let reach = Wide::from(radius) / w;
            let (b, a) = (reach - delta, reach + delta);
            let density = |x: Wide| (-(x * x).scaled(-1)).exp() / Wide::PI.scaled(1).sqrt();
            let inside = normal_between(-a, b) - (density(b) - density(a)) / delta;
            inside * (Wide::PI.scaled(1).sqrt() * w).powi(3)
        }
        Body::Box(low, high) => {
            let edge = |i: usize| {
                let z = |x: f64| (Wide::from(x) - centre[i]) / w;
                normal_between(z(low[i]), z(high[i])) * Wide::PI.scaled(1).sqrt() * w
            };
            edge(0) * edge(1) * edge(2)
        }
    };
    let field = format!(
        "volume.gaussian = {{ peak = {peak:e}, centre = {centre:?}, width = {width:e}, {} }}",
        body.text()
    );
    (field, exact * peak)
}

fn radial(dice: &mut Dice) -> (String, Wide) {
    let Body::Ball(centre, radius) = Body::ball(dice) else { return Default::default() };
    let size = dice.sized(-6.0, 6.0);
    let count = 1 + dice.below(4);
    let mut cs: Vec<f64> = (0..count).map(|_| size * dice.between(-0.3, 1.0)).collect();
    cs[0] = size;
    let powers = cs.iter().zip(1_i32..);
    let sum: Wide = powers.map(|(&c, k)| Wide::from(c) / f64::from(2 * k + 1)).sum();
    let field = format!(
        "volume.radial = {{ centre = {centre:?}, radius = {radius:e}, coefficients = {cs:?} }}"
    );
    (field, sum * Wide::PI.scaled(2) * Wide::from(radius).powi(3))
}

fn constant(dice: &mut Dice) -> (String, Wide) {
    let (body, sigma) = (Body::of(dice), dice.sized(-9.0, 9.0));
    let field = format!("volume.constant = {{ extinction = {sigma:e}, {} }}", body.text());
    (field, sigma * body.wave([0.0; 3], sinc, sine_over))
}

/// A random field as text with what it holds.
type Field = fn(&mut Dice) -> (String, Wide);

/// In units of the stated error, but for half a unit in the last place.
fn see(t: &mut Trial, field: String, exact: impl Fn(&Volume) -> Wide, chords: f64) -> Option<()> {
    t.place = field;
    let volume = text::volume(&t.place)?;
    let exact = exact(&*volume);
    let found = content::by_chords(&*volume, chords)?;
    if exact.high <= 1e-290 {
        return None;
    }
    t.see(0, beyond_rounding(found, exact));
    Some(())
}

fn smooth(t: &mut Trial) -> Option<()> {
    const FIELDS: [Field; 5] = [exponential, sines, gaussian, radial, constant];
    let (field, exact) = FIELDS[t.dice.below(FIELDS.len())](t.dice);
    see(t, field, |_| exact, content::MOST_CHORDS)
}

/// Layers that jump, or bend, at heights along, across and askew of the chords.
fn layers(t: &mut Trial, chords: f64) -> Option<()> {
    let dice = &mut *t.dice;
    let body = Body::of(dice);
    let tilt = dice.between(0.05, 1.5);
    let axis = match dice.below(3) {
        0 => [1.0, 0.0, 0.0],
        1 => [tilt.sin(), 0.1 * tilt.sin(), tilt.cos()],
        _ => [0; 3].map(|_| dice.sign() * dice.between(0.05, 1.0)),
    };
    let Some(Point(axis)) = Point(axis).normalised() else { return Some(()) };
    let middle = dot(axis, body.centre()).value();
    let count = 2 + dice.below(5);
    let reach = body.reach() * dice.between(1.0, 1.3);
    let at = |i: usize| middle + reach * (2.0 * i as f64 / count as f64 - 1.0);
    let knots: Vec<f64> = (0..=count).map(at).collect();
    let bends = dice.below(2);
    let values: Vec<f64> = (0..count + bends).map(|_| dice.between(0.0, 1.0)).collect();
    let mut exact = Wide::default();
    for (i, pair) in knots.windows(2).enumerate() {
        let [from, to] = [pair[0], pair[1]].map(Wide::from);
        let [low, high] = [values[i], values[i + bends]].map(Wide::from);
        let slope = (high - low) / (to - from);
        let [below, above] = [from, to].map(|h| body.under(axis, h));
        exact += (low - slope * from) * (above[0] - below[0]) + slope * (above[1] - below[1]);
    }
    let (name, breaks) = [("piecewise-constant", "breaks"), ("piecewise-linear", "knots")][bends];
    let field = format!(
        "volume.{name} = {{ {breaks} = {knots:?}, values = {values:?}, axis = {axis:?}, {} }}",
        body.text()
    );
    see(t, field, |_| exact, chords)
}

/// Grids and noise over boxes: polynomials in every cell, which Gauss' rule integrates from lookups.
fn cells(t: &mut Trial) -> Option<()> {
    let (field, planes) = if t.dice.below(2) == 0 { grid(t.dice) } else { noise(t.dice) };
    see(t, field, |volume| by_cells(volume, &planes), FEW_CHORDS)
}

/// Planes between which a field is a polynomial, axis by axis.
type Planes = [Vec<f64>; 3];

fn grid(dice: &mut Dice) -> (String, Planes) {
    let size = [0; 3].map(|_| 2 + dice.below(3));
    let low = [0; 3].map(|_| dice.between(-2.0, 2.0));
    let high = low.map(|low| low + dice.between(0.2, 3.0));
    let interpolation = ["nearest", "trilinear"][dice.below(2)];
    let samples = ["vertices", "centres"][dice.below(2)];
    let field = format!(
        "volume.grid = {{ random = {{ size = {size:?}, seed = {} }}, samples = \"{samples}\", \
         interpolation = \"{interpolation}\", bounds.box = {{ low = {low:?}, high = {high:?} }} }}",
        dice.below(1000)
    );
    // All that samples of either kind, or their neighbourhoods, may begin and end at.
    let planes = [0, 1, 2].map(|i| {
        let cells = if samples == "vertices" { size[i] - 1 } else { size[i] };
        let halves = 2 * cells;
        let at = |j: usize| low[i] + (high[i] - low[i]) * j as f64 / halves as f64;
        (0..=halves).map(at).collect()
    });
    (field, planes)
}

fn noise(dice: &mut Dice) -> (String, Planes) {
    let (octaves, frequency) = (1 + dice.below(2), dice.sized(-0.5, 0.3));
    let low = [0; 3].map(|_| dice.between(-2.0, 2.0));
    let high = low.map(|low| low + dice.between(0.2, 1.5));
    let field = format!(
        "volume.noise = {{ extinction = 2, octaves = {octaves}, frequency = {frequency:e}, \
         seed = {}, bounds.box = {{ low = {low:?}, high = {high:?} }} }}",
        dice.below(1000)
    );
    let width = 0.5f64.powi(i32::try_from(octaves).unwrap_or(1) - 1) / frequency;
    let planes = [0, 1, 2].map(|i| {
        let first = (low[i] / width).ceil();
        let mut planes = vec![low[i]];
        let inner = (0..64).map(|j| (first + f64::from(j)) * width);
        planes.extend(inner.filter(|&x| low[i] < x && x < high[i]));
        planes.push(high[i]);
        planes
    });
    (field, planes)
}

fn by_cells(volume: &Volume, planes: &Planes) -> Wide {
    let rule = GaussLegendre::new(4);
    let [xs, ys, zs] = planes.each_ref().map(|planes| -> Vec<(f64, f64)> {
        Span::between(planes).flat_map(|span| rule.on(span).collect::<Vec<_>>()).collect()
    });
    let mut sum = Wide::default();
    for &(x, of_x) in &xs {
        for &(y, of_y) in &ys {
            let at = |&(z, of_z): &(f64, f64)| {
                Wide::product(of_z, volume.extinction_at(Point([x, y, z])))
            };
            sum += zs.iter().map(at).sum::<Wide>() * Wide::product(of_x, of_y);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps of the angle that a field about the axis does not see were taken for agreement.
    #[test]
    fn an_atmosphere_along_the_chords_is_resolved_and_a_wrong_one_is_seen() {
        let body = Body::Ball([0.25, -0.5, 0.125], 1.5);
        let k = [0.0, 0.0, -13.5];
        let exact = (-dot(k, body.centre())).exp() * body.wave(k, sinhc, sinh_over);
        let field =
            format!("volume.exponential = {{ extinction = 1, rate = -13.5, {} }}", body.text());
        for (factor, holds) in [(1.0, true), (1.0 + 1e-12, false)] {
            let rows = in_parts(1, "q", 1, |part| {
                part.run(1, [Row::stated("q", "r")], |t| {
                    see(t, field.clone(), |_| exact * factor, content::MOST_CHORDS)
                });
            });
            assert_eq!(rows[0].holds(), holds, "{rows:?}");
        }
    }

    #[test]
    fn what_lies_below_a_plane_is_all_of_it_in_the_end() {
        let cuboid = Body::Box([0.0, 1.0, 2.0], [1.0, 3.0, 2.5]);
        let ball = Body::Ball([0.0, 0.0, 1.0], 2.0);
        let [volume, first] = cuboid.under([0.6, 0.48, 0.64], Wide::from(9.0));
        // The mean height is that of the centre.
        assert!((volume.value() - 1.0).abs() < 1e-14);
        assert!((first.value() - (0.3 + 0.96 + 0.64 * 2.25)).abs() < 1e-14);
        let [volume, first] = ball.under([0.0, 0.0, 1.0], Wide::from(9.0));
        let whole = 32.0 / 3.0 * std::f64::consts::PI;
        assert!((volume.value() - whole).abs() < 1e-13 && (first.value() - whole).abs() < 1e-13);
    }
}
