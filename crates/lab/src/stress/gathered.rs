//! Single scattering in fields that vary: moments at one point, at every collision and at points that share a
//! walk, with a control or without, by panels of s.
//!
//! Theory halves panels of the stretched variable and finds the losses of the way in panels of their own. Here
//! panels of s double away from the light and from both ends of the ray, losses are sums over the same nodes,
//! and functionals are summed from the ray's end, as if nothing were lost before:
//!
//! ```text
//! E[X^k] = ∫ p (σ_t S/p)^k e^{−A_k} e^{−B_k} ds,   V_k = ∫ₛ Σⱼ (k over j) σ̂ (σ_t S/σ̂)ʲ e^{−Bⱼ} w^{k−j} V_{k−j} e^{A_{k−j} − A_k} ds
//! ```

use super::prelude::*;
use super::scattering::{Lit, lit_field, panels};
use super::series::binomial;
use super::shared_walk::{ORDERS, degree, of_mean};
use theory::problems::{Problem, SingleScattering};
use theory::single::predict::DENSITY;
use theory::single::{Camera, CameraTracking, Node, Points, Scene, Technique, Tracking, walks};

/// Panels of s, at least.
const STEPS: u32 = 40;

/// All rows.
pub fn rows(run: Run) -> Vec<Row> {
    let range = "four fields, controls, light 1e-3 … 10 away, g to 0.8, σ̂ = 0.6 … 5 of the largest; panels of s";
    let rows = ["variance", "fourth moment"]
        .map(|what| Row::stated(format!("single scattering in fields, {what}"), range));
    run.fill([8, 144], rows, Choices::any, trial)
}

parameters! {
    /// A scene, and how it is estimated; σ̂ and the control are in units of the largest σ_t.
    Choices {
        lit: Lit = lit_field(),
        scale: f64 = sized(-0.2, 0.7),
        shadow_scale: f64 = sized(-0.2, 0.7),
        kind: usize = 0..12_usize,
        held: f64 = prop_oneof![Just(0.0), between(0.0, 0.8)],
        count: usize = 1..=8_usize,
    }
}

/// What is known at a node.
struct At {
    /// `ds` there.
    weight: f64,
    /// σ_t, S, and the density by angle.
    extinction: f64,
    source: f64,
    density: f64,
    /// τ, and A of the walk for k = 0 … 4, of which the first is τ.
    depth: f64,
    losses: [f64; 5],
    /// Factor of a weight at a collision, `1 − (σ_t − σ_c)/σ̂`.
    left: f64,
    /// `e^{−B}`.
    shadow: [f64; 5],
}

fn trial(choices: &Choices, seen: &mut Seen) -> Option<()> {
    let &Choices { ref lit, scale, shadow_scale, kind, held, count } = choices;
    let problem = lit.problem().filter(|problem| !problem.medium().support().is_empty())?;
    let support = problem.medium().support();
    let mesh = Mesh::new(problem.medium().clone());
    let largest = mesh.largest(|_, sigma| sigma).map_or(1.0, |(_, largest)| largest);
    let (sampling, most) = (scale * largest, problem.shadow_majorant());
    let tracking = match kind % 3 {
        0 => Tracking::Exact,
        1 => Tracking::Ratio { sampling: shadow_scale * most, control: 0.0 },
        _ => Tracking::Delta { sampling: shadow_scale.max(1.0) * most },
    };
    let flown = Piecewise::constant(sampling, support);
    let held = held * largest;
    let control = match held {
        0.0 => Control::None,
        held => Control::Pieces(Piecewise::constant(held, support)),
    };
    let scene = |along| {
        let camera = Camera::new(&mesh, &flown, &control, along);
        Scene::new(&problem, camera, tracking, Vec::new())
    };
    let density = |node: &Node| problem.equiangular_density_beyond(node.along);
    let gain = |node: &Node| node.extinction * node.source / density(node);
    let by_angle = |along| {
        let blur = |_: &Node| DENSITY;
        Points::of(
            &scene(along),
            &Technique { density: &density, gain: &gain, blur: &blur, found: None, weighted: None },
        )
    };
    let nodes = nodes(&problem, [sampling, held], tracking);
    let (name, points, raw) = match kind / 3 {
        0 => ("by angle, exact", by_angle(CameraTracking::Exact), at_point(&nodes, false)),
        1 => ("by angle, ratio", by_angle(CameraTracking::Ratio), at_point(&nodes, true)),
        2 => {
            let points = walks::at_collisions(&scene(CameraTracking::Ratio));
            ("at collisions", points, at_collisions(&nodes, sampling))
        }
        _ => {
            let points = walks::at_points(&scene(CameraTracking::Ratio), count, &density);
            ("shared walk", points, shared(&nodes, count))
        }
    };
    seen.at(format_args!("{name}, {tracking:?}"));
    let known = points.prediction().channels[0].moments;
    seen.moments(0, known, |scale| central(raw.map(Wide::from), Wide::from(scale)));
    Some(())
}

/// All nodes, panel by panel.
fn nodes(
    problem: &SingleScattering,
    [sampling, control]: [f64; 2],
    tracking: Tracking,
) -> Vec<Vec<At>> {
    let (medium, rule) = (problem.medium(), GaussLegendre::new(16));
    let from = medium.support().from;
    let mut passed = [0.0; 5];
    let panel = |ends: &[f64]| {
        let width = ends[1] - ends[0];
        let places: Vec<f64> = rule.nodes.iter().map(|x| ends[0] + width * x).collect();
        let extinctions = medium.extinctions(&places);
        let left = |sigma: f64| 1.0 - (sigma - control) / sampling;
        let lost =
            |k: i32, sigma: f64| f64::from(k) * control + sampling * (1.0 - left(sigma).powi(k));
        let so_far = |weights: &[f64]| -> [f64; 5] {
            std::array::from_fn(|k| {
                let rates =
                    extinctions.iter().map(|&sigma| lost(i32::try_from(k).unwrap_or(0), sigma));
                passed[k] + width * weights.iter().zip(rates).map(|(w, rate)| w * rate).sum::<f64>()
            })
        };
        let at = |(i, &s): (usize, &f64)| At {
            weight: width * rule.weights[i],
            extinction: extinctions[i],
            source: problem.source(s),
            density: problem.equiangular_density(s),
            depth: medium.optical_depth(Span::new(from, s)).value,
            losses: so_far(&rule.running[i]),
            left: left(extinctions[i]),
            shadow: shadow(problem.shadow_medium(s).as_ref(), tracking, &rule),
        };
        let found = places.iter().enumerate().map(at).collect();
        passed = so_far(&rule.weights);
        found
    };
    panels(problem, STEPS).windows(2).map(panel).collect()
}

/// `e^{−B}` for k = 0 … 4.
fn shadow(medium: Option<&Medium>, tracking: Tracking, rule: &GaussLegendre) -> [f64; 5] {
    let Some(medium) = medium else { return [1.0; 5] };
    let support = medium.support();
    let depth = medium.optical_depth(support).value;
    let mut ends = medium.breaks();
    ends.retain(|&t| support.contains_inside(t));
    ends.extend([support.from, support.middle(), support.to]);
    ends.sort_by(f64::total_cmp);
    let lost = |sampling: f64, k: i32| -> f64 {
        let rate = |t: f64| sampling * (1.0 - (1.0 - medium.extinction(t) / sampling).powi(k));
        ends.windows(2).map(|ends| rule.integrate(ends[0], ends[1], rate)).sum()
    };
    [0, 1, 2, 3, 4].map(|k| match tracking {
        _ if k == 0 => 1.0,
        Tracking::Ratio { sampling, .. } if k > 1 => (-lost(sampling, k)).exp(),
        Tracking::Exact => (-f64::from(k) * depth).exp(),
        _ => (-depth).exp(),
    })
}

fn at_point(nodes: &[Vec<At>], walks: bool) -> [f64; 4] {
    let mut sums = [0.0; 4];
    for at in nodes.iter().flatten() {
        let gain = at.extinction * at.source / at.density;
        for (sum, k) in sums.iter_mut().zip(1..) {
            let power = usize::try_from(k).unwrap_or(0);
            let lost = match (walks, k) {
                (true, 2..) => at.losses[power],
                (true, _) => at.depth,
                _ => f64::from(k) * at.depth,
            };
            *sum += at.weight * at.density * gain.powi(k) * (-lost).exp() * at.shadow[power];
        }
    }
    sums
}

/// `∫ₛ f dt` at every node and over all, f told the panel and the place.
fn running(nodes: &[Vec<At>], f: impl Fn(&At, usize, usize) -> f64) -> (Vec<Vec<f64>>, f64) {
    let rule = GaussLegendre::new(16);
    let mut whole = 0.0;
    let mut after: Vec<Vec<f64>> = Vec::with_capacity(nodes.len());
    for (p, panel) in nodes.iter().enumerate().rev() {
        let rates: Vec<f64> = panel.iter().enumerate().map(|(i, at)| f(at, p, i)).collect();
        let width: f64 = panel.iter().map(|at| at.weight).sum();
        let sum = |weights: &[f64]| -> f64 {
            width * weights.iter().zip(&rates).map(|(w, rate)| w * rate).sum::<f64>()
        };
        let here = sum(&rule.weights);
        after.push((0..panel.len()).map(|i| whole + here - sum(&rule.running[i])).collect());
        whole += here;
    }
    after.reverse();
    (after, whole)
}

fn lost(at: &At, k: usize) -> f64 {
    if k == 1 { at.depth } else { at.losses[k] }
}

fn at_collisions(nodes: &[Vec<At>], sampling: f64) -> [f64; 4] {
    // V_0 … V_4 at all nodes.
    let mut known: Vec<Vec<Vec<f64>>> =
        vec![nodes.iter().map(|panel| vec![1.0; panel.len()]).collect()];
    let mut powers = [0.0; 4];
    for (k, whole) in (1..5).zip(&mut powers) {
        let (after, all) = running(nodes, |at, p, i| {
            let gain = at.extinction * at.source / sampling;
            let term = |j: usize| {
                let [up, left] = [j, k - j].map(|k| i32::try_from(k).unwrap_or(0));
                let apart = (lost(at, k - j) - lost(at, k)).exp();
                let scored = gain.powi(up) * at.shadow[j] * at.left.powi(left);
                binomial(k, j) * scored * apart * known[k - j][p][i]
            };
            sampling * (1..=k).map(term).sum::<f64>()
        });
        *whole = all;
        known.push(after);
    }
    powers
}

/// Moments at points that share a walk: from `E[A₁^{n₁} A₂^{n₂} …]`, `A_m = ∫ p (T̂ σ_t S/p)^m E[T̂_shadow^m] ds`,
/// by how many ways points coincide.
fn shared(nodes: &[Vec<At>], count: usize) -> [f64; 4] {
    let mut known: Vec<([usize; 4], Vec<Vec<f64>>, f64)> = Vec::new();
    for order in ORDERS {
        let degree = degree(&order);
        let (after, whole) = running(nodes, |at, p, i| {
            let gain = at.extinction * at.source / at.density;
            let term = |m: usize| {
                let mut lower = order;
                lower[m - 1] -= 1;
                let rest = known.iter().find(|(order, ..)| *order == lower);
                let rest = rest.map_or(1.0, |(_, after, _)| after[p][i]);
                let apart = (lost(at, degree - m) - lost(at, degree)).exp();
                let scored = gain.powi(i32::try_from(m).unwrap_or(0)) * at.shadow[m];
                order[m - 1] as f64 * at.density * scored * apart * rest
            };
            (1..5).filter(|&m| order[m - 1] > 0).map(term).sum()
        });
        known.push((order, after, whole));
    }
    of_mean(count, |i| known[i].2)
}
