//! Single scattering of a point light: the radiance against other quadratures.
//!
//! ```text
//! homogeneous, s = foot + D sinh x:  L = a σ_t Φ/(16π² D) ∫ exp(−σ_t (foot + D eˣ)) dx/cosh x
//! ```
//!
//! Both distances are one exponential, and nothing cancels. Elsewhere panels of s double away from the light,
//! where theory halves panels of x.

use std::f64::consts::TAU;

use super::chains::arsinh;
use super::text;
use super::trial::{Dice, Trial, beyond_rounding};
use super::{Effort, Row, in_parts};
use ::theory::Mesh;
use ::theory::problems::single_scattering::Lamp;
use ::theory::problems::{Problem, SingleScattering};
use ::theory::single::{Camera, CameraTracking, Scene, Tracking};
use media::phase::Phase;
use media::phase::henyey_greenstein::HenyeyGreenstein;
use media::phase::isotropic::Isotropic;
use media::{Control, Piecewise};
use numeric::geometry::{Point, Ray};
use numeric::quadrature::GaussLegendre;
use numeric::sum::Sum;
use numeric::{Known, Span, Wide};

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = effort.of(1, 80);
    in_parts(16, "scattering", seed, |part| {
        let range = "homogeneous, light 1e-6 … 10 away, σ_t ℓ = 1e-4 … 300; 32 digits";
        part.run(trials, [Row::stated("single scattering, radiance", range)], homogeneous);
        let trials = effort.of(u32::from(part.number % 4 == 0), 63);
        let range = "four fields, light 1e-3 … 10 away, g to 0.8; panels of s";
        part.run(trials, [Row::stated("single scattering, fields", range)], fields);
    })
}

/// The radiance as theory finds it.
fn radiance(problem: &SingleScattering) -> Known {
    let mesh = Mesh::even(problem.medium().clone(), 1);
    let (nothing, none) = (Piecewise::constant(0.0, mesh.support()), Control::None);
    let camera = Camera::new(&mesh, &nothing, &none, CameraTracking::Exact);
    Scene::new(problem, camera, Tracking::Exact, Vec::new()).radiance()
}

/// A light of power 1 beside a ray through a homogeneous medium that scatters evenly.
pub(super) fn lit(
    sigma: f64,
    distance: f64,
    foot: f64,
    length: f64,
    albedo: f64,
) -> Option<SingleScattering> {
    let field = text::volume(&format!("volume.constant.extinction = {sigma:e}"))?;
    let ray = Ray::new(Point([0.0; 3]), Point([0.0, 0.0, 1.0]), length)?;
    let lamp = Lamp { position: Point([distance, 0.0, foot]), power: 1.0 };
    let phase = Phase::Isotropic(Isotropic);
    SingleScattering::new(field, ray, lamp, albedo, phase).ok()
}

fn homogeneous(t: &mut Trial) -> Option<()> {
    let (albedo, length) = (t.dice.between(0.1, 1.0), t.dice.sized(-1.0, 1.5));
    let sigma = t.dice.sized(-4.0, 2.4) / length;
    let (distance, foot) = (t.dice.sized(-6.0, 1.0), t.dice.between(-0.3, 1.3) * length);
    t.place = format!("σ_t = {sigma:e}, D = {distance:e}, ℓ = {length:e}, foot {foot:e}");
    let found = radiance(&lit(sigma, distance, foot, length, albedo)?);
    let [sigma, distance, foot] = [sigma, distance, foot].map(Wide::from);
    let ends = [0.0, length].map(|s| arsinh((s - foot) / distance));
    let width = ends[1] - ends[0];
    let grown = sigma * distance * (ends[1].exp() - ends[0].exp());
    let panels = (3.0 * width.high + grown.high / 6.0).ceil().max(1.0);
    let (rule, step) = (GaussLegendre::new(20), width / panels);
    let (mut integral, mut panel) = (Wide::default(), 0.0);
    while panel < panels {
        for (&node, &weight) in rule.nodes.iter().zip(&rule.weights) {
            let grown = (ends[0] + step * (Wide::from(panel) + node)).exp();
            let twice = grown + 1.0 / grown;
            let left = (-(sigma * (foot + distance * grown))).exp();
            integral += left.scaled(1) / twice * step * weight;
        }
        panel += 1.0;
    }
    let exact = integral * (albedo * sigma / (Wide::PI * Wide::PI * distance).scaled(4));
    if exact.high < 1e-290 {
        return None;
    }
    t.see(0, beyond_rounding(found, exact));
    Some(())
}

const VOLUMES: [&str; 4] = [
    "eq21 = {}",
    "radial = { centre = [0, 0, 10], radius = 8, coefficients = [0.6, -0.6] }",
    "gaussian = { peak = 1, centre = [1, 0, 9], width = 2, bounds.sphere = { centre = [0, 0, 10], radius = 9 } }",
    "exponential = { extinction = 1, rate = 0.3, bounds.sphere = { centre = [0, 0, 10], radius = 9 } }",
];

/// A ray through a field that varies, and a light beside it.
pub(super) fn field(dice: &mut Dice) -> (String, Option<SingleScattering>) {
    let field = VOLUMES[dice.below(VOLUMES.len())];
    let origin = Point([dice.between(-3.0, 3.0), dice.between(-3.0, 3.0), -5.0]);
    let target = Point([dice.between(-3.0, 3.0), dice.between(-3.0, 3.0), 15.0]);
    let (away, along, turn) =
        (dice.sized(-3.0, 1.0), dice.between(0.1, 0.9), dice.between(0.0, TAU));
    let forward = HenyeyGreenstein::new(dice.between(-0.8, 0.8));
    let phase = forward.map_or(Phase::Isotropic(Isotropic), Phase::HenyeyGreenstein);
    let what = format!(
        "{field}, from {origin:?} to {target:?}, D = {away:e} at {along:e}, {turn:e}, {phase:?}"
    );
    let ray = Ray::new(origin, target - origin, 26.0);
    let problem = text::volume(&format!("volume.{field}")).zip(ray).and_then(|(field, ray)| {
        let side = ray.direction.cross(Point([0.0, 1.0, 0.0])).normalised()?;
        let up = ray.direction.cross(side);
        let aside = side * turn.cos() + up * turn.sin();
        let position = ray.at(26.0 * along) + aside * away;
        let lamp = Lamp { position, power: 1.0 };
        SingleScattering::new(field, ray, lamp, 0.7, phase).ok()
    });
    (what, problem)
}

fn fields(t: &mut Trial) -> Option<()> {
    let (what, problem) = field(t.dice);
    t.place = what;
    let problem = problem?;
    let found = radiance(&problem);
    t.see(0, (found.value - graded(&problem)).abs() / found.error);
    Some(())
}

/// The ends of so many panels of s and more, which grow away from the light's foot and from both ends.
pub(super) fn panels(problem: &SingleScattering, steps: u32) -> Vec<f64> {
    let (support, foot) = (problem.medium().support(), problem.foot());
    let mut ends = problem.medium().breaks();
    let step = support.length() / f64::from(steps);
    ends.extend((0..=steps).map(|i| support.from + step * f64::from(i)));
    let mut away = 0.25 * problem.distance();
    while away < support.length() {
        ends.extend([foot - away, foot + away]);
        away *= 1.5;
    }
    // A light just outside sees the ends of the support at a glance: roots of the distance from them.
    let mut near = step;
    while near > 1e-13 * support.length() {
        near *= 0.5;
        ends.extend([support.from + near, support.to - near]);
    }
    ends.push(foot);
    ends.retain(|&s| support.contains_inside(s));
    ends.extend([support.from, support.to]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    ends
}

fn graded(problem: &SingleScattering) -> f64 {
    let (medium, rule) = (problem.medium(), GaussLegendre::new(16));
    let support = medium.support();
    let gathered = |s: f64| {
        let before = medium.optical_depth(Span::new(support.from, s)).value;
        let beyond = problem.shadow_medium(s);
        let beyond = beyond.map_or(0.0, |m| m.optical_depth(m.support()).value);
        medium.extinction(s) * problem.source(s) * (-(before + beyond)).exp()
    };
    let mut sum = Sum::default();
    for pair in panels(problem, 320).windows(2) {
        sum.add(rule.integrate(pair[0], pair[1], gathered));
    }
    sum.value()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_of_s_are_those_of_x() {
        let field = text::volume("volume.constant.extinction = 0.4").expect("read");
        let ray = Ray::new(Point([0.0; 3]), Point([0.0, 0.0, 1.0]), 3.0).expect("a direction");
        let lamp = Lamp { position: Point([0.01, 0.0, 1.0]), power: 1.0 };
        let phase = Phase::Isotropic(Isotropic);
        let problem = SingleScattering::new(field, ray, lamp, 0.7, phase).expect("off");
        let (found, other) = (radiance(&problem), graded(&problem));
        assert!((found.value - other).abs() <= found.error);
        assert!((found.value * (1.0 + 1e-11) - other).abs() > found.error, "{found:?}");
    }
}
