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
use super::prelude::*;
use theory::space::sphere::ball::Ball;
use theory::space::sphere::predict::BLURRED;
use theory::space::sphere::shells::{BallResolution, Centre};
use theory::space::sphere::{Lights, Observable, answers};

/// Directions of the ordinates.
const ORDINATES: usize = 64;
/// Places and rays in one ball.
const ASKED: usize = 32;

const SKY: Lights = Lights { environment: 1.0, core: 0.0 };

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "homogeneous, σ_t R = 1e-2 … 20; discrete ordinates, 32 digits";
    let of_even = ["mean intensity in a ball", "radiance of a ball"];
    let of_even = of_even.map(|what| TrialRow::stated(what, range));
    let mut rows = run.fill([1, 32], of_even, Asked::any, even);
    let range = "radial σ_t, black spheres 0.01 … 0.95 R, a = 1; J = 1";
    let row = TrialRow::stated("white ball in white light", range);
    rows.extend(run.fill([1, 16], [row], Scene::any, white));
    let range = "radial σ_t, black spheres 0.01 … 0.95 R, known to 1e-4; a finer solution";
    // One ball in ten is known too badly to be compared: three are enough for a row.
    rows.extend(run.fill(
        [3, 16],
        [TrialRow::stated("ball of any albedo", range)],
        Scene::any,
        finer,
    ));
    rows
}

parameters! {
    /// A homogeneous ball, with the places and offsets of rays at which it is tested.
    Asked {
        depth: f64 = sized(-2.0, 1.3),
        albedo: f64 = share(),
        places: Vec<f64> = vec(place(), ASKED),
        offsets: [f64; 4] = [(); 4].map(|()| place()),
    }
    /// A ball of radius 1, with the radius of a black core if any, and the places and rays at which it is tested. A
    /// ray has an offset from the centre, and begins inside if it has a share.
    Scene {
        field: Radial = radial(),
        core: Option<f64> = prop_oneof![
            2 => Just(None),
            2 => sized(-2.0, 0.0).prop_map(Some),
            2 => between(0.05, 0.95).prop_map(Some),
        ],
        albedo: f64 = share(),
        places: Vec<f64> = vec(place(), ASKED),
        rays: Vec<(f64, Option<f64>)> =
            vec((place(), proptest::option::of(between(0.0, 1.0))), 2 * ASKED),
    }
}

/// σ_t of a ball of radius 1.
#[derive(Debug, Clone, Copy)]
enum Radial {
    /// `size (1 + b r² + c r⁴)`.
    Polynomial { size: f64, b: f64, c: f64 },
    /// `size exp(−r²/(2 width²))`.
    Gaussian { size: f64, width: f64 },
}

fn radial() -> impl Strategy<Value = Radial> {
    let numbers = (sized(-2.0, 1.0), sized(-0.7, 0.5), between(-0.5, 1.0), between(-0.5, 1.0));
    (0..3, numbers).prop_map(|(kind, (size, width, b, c))| match kind {
        0 => Radial::Gaussian { size, width },
        _ => Radial::Polynomial { size, b, c },
    })
}

impl Radial {
    /// Returns σ_t at the square of a distance from the centre.
    fn extinction(self, r2: f64) -> f64 {
        match self {
            Self::Polynomial { size, b, c } => size * (1.0 + r2 * (b + r2 * c)),
            Self::Gaussian { size, width } => size * (-0.5 * r2 / (width * width)).exp(),
        }
    }
}

/// A distance from the centre, often next to the surface or the centre.
fn place() -> impl Strategy<Value = f64> {
    let near = sized(-6.0, 0.0);
    prop_oneof![1 => near, 1 => near.prop_map(|near| 1.0 - near), 2 => between(0.0, 1.0)]
}

impl Scene {
    fn core(&self) -> f64 {
        self.core.unwrap_or(0.0)
    }

    fn centre(&self) -> Centre {
        self.core.map_or(Centre::Medium, Centre::Black)
    }

    fn asked(&self) -> Vec<Observable> {
        let core = self.core();
        let place = |place: &f64| Observable::Mean(core + (1.0 - core) * place);
        let ray = |&(offset, inside): &(f64, Option<f64>)| {
            let half = ((1.0 - offset) * (1.0 + offset)).sqrt();
            let blocked =
                if offset < core { (core * core - offset * offset).sqrt() } else { -half };
            let from = inside.map_or(f64::NEG_INFINITY, |share| blocked + (half - blocked) * share);
            Observable::Radiance { offset, from }
        };
        self.places.iter().map(place).chain(self.rays.iter().map(ray)).collect()
    }
}

/// A homogeneous ball, lengths in mean free paths.
struct Even {
    radius: f64,
    albedo: DoubleDouble,
    /// k and α.
    parts: Vec<[DoubleDouble; 2]>,
}

impl Even {
    fn new(radius: f64, albedo: DoubleDouble, count: usize) -> Option<Self> {
        let (cosines, weights) = directions(count);
        let roots = roots(albedo, &cosines, &weights);
        let reach = DoubleDouble::from(radius);
        let faint: Vec<DoubleDouble> =
            roots.iter().map(|&k| (-(k * reach).scaled(1)).exp()).collect();
        let row = |&mu: &DoubleDouble| {
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
    fn mean(&self, r: f64) -> DoubleDouble {
        let (place, reach) = (DoubleDouble::from(r), DoubleDouble::from(self.radius));
        let term = |&[k, alpha]: &[DoubleDouble; 2]| {
            let near = (-(k * (reach - place))).exp();
            alpha * near * -(-(k * place).scaled(1)).exp_m1()
        };
        -(self.parts.iter().map(term).sum::<DoubleDouble>() / (self.albedo * place))
    }

    /// The radiance at the end of a chord that passes the centre at a distance.
    fn radiance(&self, offset: f64) -> DoubleDouble {
        let half = ((self.radius - offset) * (self.radius + offset)).sqrt();
        let rule = GaussLegendre::new(12);
        // J bends like x ln x at the surface.
        let near = (0..24).map(|i| half * (1.0 - 0.5f64.powi(i)));
        let steps = (1..).map(f64::from).take_while(|&step| step < half);
        let mut ends: Vec<f64> = near.chain(steps).chain([half]).collect();
        ends.sort_by(f64::total_cmp);
        let mut sum = (-(DoubleDouble::from(half).scaled(1))).exp();
        for (t, weight) in Span::between(&ends).flat_map(|panel| rule.on(panel)) {
            let mean = self.mean((offset * offset + t * t).sqrt().min(self.radius));
            // From both sides of the foot.
            let seen = (DoubleDouble::from(t - half)).exp() + (-DoubleDouble::from(t + half)).exp();
            sum += self.albedo * mean * seen * weight;
        }
        sum
    }
}

/// Homogeneous balls under the sky.
fn even(requested: &Asked, seen: &mut Seen) -> Option<()> {
    let (depth, albedo) = (requested.depth, requested.albedo.max(1e-9));
    let places = requested.places.iter().map(|&place| Observable::Mean(place));
    let ray = |offset| Observable::Radiance { offset, from: f64::NEG_INFINITY };
    let requested: Vec<Observable> = places.chain(requested.offsets.map(ray)).collect();
    let extinction = move |_: f64| depth;
    let ball = Ball { radius: 1.0, centre: Centre::Medium, extinction: &extinction };
    let computed = answers(&ball, albedo, SKY, BallResolution::COARSE, &requested);
    // At a = 1 two solutions are one: a grain beside it, 1e-20, nobody sees.
    let near =
        if albedo == 1.0 { 1.0 - DoubleDouble::from(1e-20) } else { DoubleDouble::from(albedo) };
    let (computed, even) = (seen.computed(0, computed)?, Even::new(depth, near, ORDINATES)?);
    for (requested, computed) in requested.iter().zip(computed) {
        seen.at(format_args!("{requested:?}"));
        match *requested {
            Observable::Mean(r) => seen.stated(0, computed, even.mean(r * depth)),
            Observable::Radiance { offset, .. } => {
                seen.stated(1, computed, even.radiance(offset * depth));
            }
        }
    }
    Some(())
}

/// White balls in white light: J = 1.
fn white(scene: &Scene, seen: &mut Seen) -> Option<()> {
    let (requested, extinction) = (scene.asked(), |r2| scene.field.extinction(r2));
    let ball = Ball { radius: 1.0, centre: scene.centre(), extinction: &extinction };
    let lights = Lights { environment: 1.0, core: 1.0 };
    let computed = answers(&ball, 1.0, lights, BallResolution::COARSE, &requested);
    for (requested, computed) in requested.iter().zip(seen.computed(0, computed)?) {
        seen.at(format_args!("{requested:?}"));
        seen.stated(0, computed, DoubleDouble::ONE);
    }
    Some(())
}

/// Nodes, directions and grading of which the answers are good to a small part of what is stated.
pub const FINER: BallResolution =
    BallResolution { nodes: 9, directions: 9, surface: 11, core: 14, probability: 1e-10 };

/// Other albedos and lights, by a finer solution.
fn finer(scene: &Scene, seen: &mut Seen) -> Option<()> {
    let (requested, extinction) = (scene.asked(), |r2| scene.field.extinction(r2));
    let is_dark = scene.core() > 0.0;
    let lights = if is_dark { Lights { environment: 0.0, core: 1.0 } } else { SKY };
    let ball = Ball { radius: 1.0, centre: scene.centre(), extinction: &extinction };
    let of = |resolution| answers(&ball, scene.albedo, lights, resolution, &requested);
    let (computed, fine) = seen.computed(0, of(BallResolution::COARSE).zip(of(FINER)))?;
    for ((requested, computed), fine) in requested.iter().zip(computed).zip(fine) {
        seen.at(format_args!("{requested:?}"));
        // Nobody draws against an answer that is known no better.
        if computed.error > BLURRED * computed.value {
            seen.skip(0);
        } else {
            seen.stated(0, computed, DoubleDouble::from(fine.value));
        }
    }
    Some(())
}
