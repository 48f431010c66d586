//! Balls: Peierls' equation against discrete ordinates, a finer solution, and where everything is white.
//!
//! In a homogeneous ball `rS(r)`, S the sources, is what it is in a slab of the same radius on both sides of
//! its middle, odd about it. With the roots k of `ordinates`, lengths in mean free paths, an
//! environment of radiance 1 makes
//!
//! ```text
//! J(r) = −(1/(ar)) Σ αⱼ (e^{−kⱼ(R−r)} − e^{−kⱼ(R+r)})
//! Σⱼ αⱼ [1/(1 − kⱼμ) − e^{−2kⱼR}/(1 + kⱼμ)] = −(R + μ)     at every μ
//! ```
//!
//! Where nothing is absorbed and the black sphere is as bright as the sky, J = 1 everywhere, whatever σ_t.

use super::ordinates::{directions, roots, solved_pivoted};
use super::trial::{Dice, Trial, share};
use super::{Effort, Row, in_parts};
use estimators::sphere::BLURRED;
use numeric::quadrature::GaussLegendre;
use numeric::{Span, Wide};
use theory::sphere::ball::Ball;
use theory::sphere::shells::{Centre, Resolution};
use theory::sphere::{Lights, Observable, answers, point};

/// Directions of the ordinates.
const ORDINATES: usize = 64;
/// Places and rays in one ball.
const ASKED: usize = 32;

const SKY: Lights = Lights { environment: 1.0, core: 0.0 };

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(16, "balls", seed, |part| {
        let number = part.number;
        let few = |full: bool, quick: bool| u32::from(effort.of(quick, full));
        let range = "homogeneous, σ_t R = 1e-2 … 20; discrete ordinates, 32 digits";
        let rows = ["mean intensity in a ball", "radiance of a ball"];
        let trials = effort.of(u32::from(number == 0), 2);
        part.run(trials, rows.map(|what| Row::stated(what, range)), even);
        let range = "radial σ_t, black spheres 0.01 … 0.95 R, a = 1; J = 1";
        part.run(few(true, number == 1), [Row::stated("white ball in white light", range)], white);
        // One ball in ten is known too badly to be compared: three are enough for a row.
        let trials = few(number % 2 == 0, (1..4).contains(&number));
        let range = "radial σ_t, black spheres 0.01 … 0.95 R, known to 1e-4; a finer solution";
        part.run(trials, [Row::stated("ball of any albedo", range)], finer);
        let trials = few(number % 8 == 3, number == 3);
        let range = "σ_t R = 1e-2 … 3; a finer solution";
        part.run(trials, [Row::stated("point source in a ball, by order", range)], sources);
    })
}

/// A homogeneous ball, lengths in mean free paths.
struct Even {
    radius: f64,
    albedo: Wide,
    /// k and α.
    parts: Vec<[Wide; 2]>,
}

impl Even {
    fn new(radius: f64, albedo: Wide, count: usize) -> Option<Self> {
        let (cosines, weights) = directions(count);
        let roots = roots(albedo, &cosines, &weights);
        let reach = Wide::from(radius);
        let faint: Vec<Wide> = roots.iter().map(|&k| (-(k * reach).scaled(1)).exp()).collect();
        let row = |&mu: &Wide| {
            let entries = roots
                .iter()
                .zip(&faint)
                .map(|(&k, &faint)| 1.0 / (1.0 - k * mu) - faint / (1.0 + k * mu));
            entries.chain([-(reach + mu)]).collect()
        };
        let alphas = solved_pivoted(cosines.iter().map(row).collect())?;
        let parts = roots.into_iter().zip(alphas).map(|(k, alpha)| [k, alpha]).collect();
        Some(Self { radius, albedo, parts })
    }

    /// J.
    fn mean(&self, r: f64) -> Wide {
        let (place, reach) = (Wide::from(r), Wide::from(self.radius));
        let term = |&[k, alpha]: &[Wide; 2]| {
            let near = (-(k * (reach - place))).exp();
            alpha * near * -(-(k * place).scaled(1)).exp_m1()
        };
        -(self.parts.iter().map(term).sum::<Wide>() / (self.albedo * place))
    }

    /// The radiance at the end of a chord that passes the centre at a distance.
    fn radiance(&self, offset: f64) -> Wide {
        let half = ((self.radius - offset) * (self.radius + offset)).sqrt();
        let rule = GaussLegendre::new(12);
        // J bends like x ln x at the surface.
        let mut ends = vec![0.0];
        let mut left = half;
        while left > 1e-7 * half || ends.len() < 4 {
            left *= 0.5;
            ends.push(half - left.min(half - ends[ends.len() - 1]));
            let from = ends[ends.len() - 2];
            let last = ends[ends.len() - 1];
            if last - from > 1.0 {
                ends.pop();
                ends.push(from + 1.0);
                left = half - (from + 1.0);
            }
        }
        ends.push(half);
        let mut sum = (-(Wide::from(half).scaled(1))).exp();
        for (t, weight) in Span::between(&ends).flat_map(|panel| rule.on(panel)) {
            let mean = self.mean((offset * offset + t * t).sqrt().min(self.radius));
            // From both sides of the foot.
            let seen = (Wide::from(t - half)).exp() + (-Wide::from(t + half)).exp();
            sum += self.albedo * mean * seen * weight;
        }
        sum
    }
}

/// A distance from the centre, often next to the surface or the centre.
fn place(dice: &mut Dice, core: f64) -> f64 {
    let share = match dice.below(4) {
        0 => dice.sized(-6.0, 0.0),
        1 => 1.0 - dice.sized(-6.0, 0.0),
        _ => dice.between(0.0, 1.0),
    };
    core + (1.0 - core) * share
}

/// Homogeneous balls under the sky.
fn even(t: &mut Trial) {
    let (depth, albedo) = (t.dice.sized(-2.0, 1.3), share(t.dice).max(1e-9));
    let mut asked: Vec<Observable> =
        (0..ASKED).map(|_| Observable::Mean(place(t.dice, 0.0))).collect();
    for _ in 0..4 {
        asked.push(Observable::Radiance { offset: place(t.dice, 0.0), from: f64::NEG_INFINITY });
    }
    let extinction = move |_: f64| depth;
    let ball = Ball { radius: 1.0, centre: Centre::Medium, extinction: &extinction };
    let found = answers(&ball, albedo, SKY, Resolution::COARSE, &asked);
    // At a = 1 two solutions are one: a grain beside it, 1e-20, nobody sees.
    let near = if albedo == 1.0 { 1.0 - Wide::from(1e-20) } else { Wide::from(albedo) };
    let solutions = found.zip(Even::new(depth, near, ORDINATES));
    for (i, asked) in asked.iter().enumerate() {
        t.place = format!("σ_t R = {depth:e}, a = {albedo:e}, {asked:?}");
        let row = usize::from(i >= ASKED);
        let Some((found, exact)) = &solutions else {
            t.see(row, f64::NAN);
            continue;
        };
        let exact = match *asked {
            Observable::Mean(r) => exact.mean(r * depth),
            Observable::Radiance { offset, .. } => exact.radiance(offset * depth),
        };
        t.stated(row, found[i], exact);
    }
}

/// σ_t of a ball of radius 1: a polynomial of r², or a Gaussian.
fn field(dice: &mut Dice) -> (String, Box<dyn Fn(f64) -> f64>) {
    let size = dice.sized(-2.0, 1.0);
    if dice.below(3) == 0 {
        let width = dice.sized(-0.7, 0.5);
        let said = format!("{size:e} exp(−r²/2/{width:e}²)");
        return (said, Box::new(move |r2| size * (-0.5 * r2 / (width * width)).exp()));
    }
    let [b, c] = [dice.between(-0.5, 1.0), dice.between(-0.5, 1.0)];
    let said = format!("{size:e} (1 + {b:e} r² + {c:e} r⁴)");
    (said, Box::new(move |r2| size * (1.0 + r2 * (b + r2 * c))))
}

/// The medium, or a black sphere of some size, at the centre.
fn centre(dice: &mut Dice) -> (Centre, f64) {
    if dice.below(3) == 0 {
        return (Centre::Medium, 0.0);
    }
    let core = if dice.below(2) == 0 { dice.sized(-2.0, 0.0) } else { dice.between(0.05, 0.95) };
    (Centre::Black(core), core)
}

fn questions(dice: &mut Dice, core: f64) -> Vec<Observable> {
    let mut asked: Vec<Observable> =
        (0..ASKED).map(|_| Observable::Mean(place(dice, core))).collect();
    for _ in 0..2 * ASKED {
        let offset = place(dice, 0.0);
        let half = ((1.0 - offset) * (1.0 + offset)).sqrt();
        let blocked = if offset < core { (core * core - offset * offset).sqrt() } else { -half };
        let inside = dice.between(blocked, half);
        let from = if dice.below(2) == 0 { f64::NEG_INFINITY } else { inside };
        asked.push(Observable::Radiance { offset, from });
    }
    asked
}

/// Where nothing can be seen.
fn white(t: &mut Trial) {
    let ((said, extinction), (centre, core)) = (field(t.dice), centre(t.dice));
    let asked = questions(t.dice, core);
    let ball = Ball { radius: 1.0, centre, extinction: &*extinction };
    let lights = Lights { environment: 1.0, core: 1.0 };
    let found = answers(&ball, 1.0, lights, Resolution::COARSE, &asked);
    for (i, asked) in asked.iter().enumerate() {
        t.place = format!("σ_t = {said}, {centre:?}, {asked:?}");
        match &found {
            Some(found) => t.stated(0, found[i], Wide::ONE),
            None => t.see(0, f64::NAN),
        }
    }
}

/// Nodes, directions and grading of which the answers are good to a small part of what is stated.
const FINER: Resolution =
    Resolution { nodes: 9, directions: 9, surface: 11, core: 14, centre: 23, chance: 1e-10 };

/// Other albedos and lights, by a finer solution.
fn finer(t: &mut Trial) {
    let ((said, extinction), (centre, core)) = (field(t.dice), centre(t.dice));
    let albedo = share(t.dice);
    let mut asked = questions(t.dice, core);
    asked.extend(questions(t.dice, core));
    let lights = if core > 0.0 { Lights { environment: 0.0, core: 1.0 } } else { SKY };
    let ball = Ball { radius: 1.0, centre, extinction: &*extinction };
    let of = |resolution| answers(&ball, albedo, lights, resolution, &asked);
    let said = format!("σ_t = {said}, a = {albedo:e}, {centre:?}");
    let Some((found, fine)) = of(Resolution::COARSE).zip(of(FINER)) else {
        t.place = said;
        t.see(0, f64::NAN);
        return;
    };
    for ((asked, found), fine) in asked.iter().zip(found).zip(fine) {
        t.place = format!("{said}, {asked:?}");
        // Nobody draws against an answer that is known no better.
        if found.error > BLURRED * found.value {
            t.skip(0);
        } else {
            t.stated(0, found, Wide::from(fine.value));
        }
    }
}

/// A point source at the centre, order by order.
fn sources(t: &mut Trial) -> Option<()> {
    let (depth, albedo) = (t.dice.sized(-2.0, 0.5), t.dice.between(0.1, 1.0));
    let extinction = move |_: f64| depth;
    let ball = Ball { radius: 1.0, centre: Centre::Medium, extinction: &extinction };
    let offsets: Vec<f64> = (0..4 * ASKED).map(|_| t.dice.sized(-2.0, -0.01)).collect();
    t.place = format!("σ_t R = {depth:e}");
    let of = |resolution| point::orders(&ball, albedo, &offsets, 3, resolution);
    let all = of(Resolution::COARSE)?.into_iter().zip(of(FINER)?);
    for (offset, (found, fine)) in offsets.iter().zip(all) {
        for (order, (found, fine)) in found.into_iter().zip(fine).enumerate() {
            t.place = format!("order {order}, σ_t R = {depth:e}, at {offset:e}");
            t.stated(0, found, Wide::from(fine.value));
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stress::trial::of_stated;

    #[test]
    fn ordinates_see_nothing_in_a_white_ball() {
        let even = Even::new(2.0, 1.0 - Wide::from(1e-20), ORDINATES).expect("solved");
        for r in [1e-3, 1.0, 1.999_999] {
            assert!((even.mean(r).value() - 1.0).abs() < 1e-11, "{r}");
        }
        assert!((even.radiance(0.7).value() - 1.0).abs() < 1e-10);
    }

    /// Two answers that agreed by chance stated an error a hundred times too small.
    #[test]
    fn a_difference_of_two_would_break_the_row() {
        let width = 5.009_185_299_915_946e-1;
        let extinction = move |r2: f64| 4.491_279_127_719_145 * (-0.5 * r2 / (width * width)).exp();
        let centre = Centre::Black(0.152_548_266_190_216_4);
        let ball = Ball { radius: 1.0, centre, extinction: &extinction };
        let lights = Lights { environment: 0.0, core: 1.0 };
        let asked =
            [Observable::Radiance { offset: 0.624_808_847_846_952, from: f64::NEG_INFINITY }];
        let of = |resolution| {
            let found = answers(&ball, 0.392_282_540_822_851_2, lights, resolution, &asked);
            found.expect("a medium")[0]
        };
        let (found, exact) = (of(Resolution::COARSE), Wide::from(of(FINER).value));
        assert!(of_stated(found, exact) <= 1.0, "{found:?}");
        let two = numeric::Known::new(found.value, 0.01 * found.error);
        assert!(of_stated(two, exact) > 1.0, "{found:?}");
    }
}
