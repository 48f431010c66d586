//! Single scattering of a point light: the radiance against nodes of the ray, see `rays`.

use std::f64::consts::TAU;

use super::fields::Space;
use super::prelude::*;
use super::rays::{even, varying};
use super::techniques::Estimator;
use crate::stress::slabs::henyey_greenstein;
use media::phase::Phase;
use media::phase::isotropic::Isotropic;
use numeric::geometry::{Point, Ray};
use theory::light::Heuristic;
use theory::problems::single_scattering::Lamp;
use theory::problems::{Problem, SingleScattering};
use theory::single::{Camera, CameraTracking, Collisions, Mis, NullPaths, RayScene, Tracking};

/// All rows.
pub fn rows(run: Run) -> Vec<TrialRow> {
    let range = "homogeneous, light 1e-6 … 10 away, σ_t ℓ = 1e-4 … 300; 32 digits";
    let row = TrialRow::stated("single scattering, radiance", range);
    let mut rows = run.fill([16, 1280], [row], Even::any, homogeneous);
    let range = "four fields, light 1e-3 … 10 away, g to 0.8; panels of s";
    let row = TrialRow::stated("single scattering, fields", range);
    rows.extend(run.fill([4, 1008], [row], lit_field, |field, seen| {
        let problem = field.problem()?;
        let (computed, exact) = (radiance(&problem), varying(&alone(&problem, 1.0)).radiance());
        seen.stated(0, computed, exact);
        Some(())
    }));
    let range =
        "four fields, points by angle and delta tracking, σ̂ = 1 … 5 of the largest; radiance";
    let row = TrialRow::stated("equiangular and delta tracking share the light", range);
    rows.extend(run.fill([4, 256], [row], Shared::any, shares));
    rows
}

parameters! {
    /// A homogeneous medium and a light beside a ray; the foot is in lengths.
    Even {
        albedo: f64 = between(0.1, 1.0),
        length: f64 = sized(-1.0, 1.5),
        depth: f64 = sized(-4.0, 2.4),
        distance: f64 = sized(-6.0, 1.0),
        foot: f64 = between(-0.3, 1.3),
    }
    /// Points by angle and delta tracking in a field; σ̂ is in units of the largest σ_t.
    Shared {
        lit: LitRay = lit_field(),
        scale: f64 = sized(0.01, 0.7),
        heuristic: Heuristic = any_of(&[Heuristic::Balance, Heuristic::Power]),
        has_nulls: bool = proptest::bool::ANY,
    }
}

/// The weighted means of both techniques add up to the radiance.
fn shares(case: &Shared, seen: &mut Seen) -> Option<()> {
    let &Shared { lit, scale, heuristic, has_nulls } = case;
    let problem = lit.problem().filter(|problem| !problem.medium().support().is_empty())?;
    let (medium, mesh) = (problem.medium(), Mesh::new(problem.medium().clone()));
    let largest = mesh.largest(&|_, sigma| sigma).map_or(1.0, |(_, largest)| largest);
    let sampling = &Piecewise::constant(scale * largest, mesh.support());
    let along = if has_nulls { CameraTracking::Ratio } else { CameraTracking::Exact };
    let camera = Camera::new(&mesh, sampling, &Control::None, along);
    let scene = &RayScene::new(&problem, camera, Tracking::Exact);
    let collisions = Collisions { medium, sampling, scatters: problem.albedo() };
    let nulls = has_nulls.then(|| NullPaths::new(&mesh, sampling, heuristic));
    let [light, walk] = Mis { scene, collisions, heuristic, nulls }.points();
    let truth = radiance(&problem);
    let mean = light.raw.0[0] + walk.raw.0[0];
    seen.see(0, over((mean.value - truth.value).abs(), mean.error + truth.error));
    Some(())
}

/// The radiance as theory finds it.
fn radiance(problem: &SingleScattering) -> Known {
    let mesh = Mesh::even(problem.medium().clone(), 1);
    let (nothing, none) = (Piecewise::constant(0.0, mesh.support()), Control::None);
    let camera = Camera::new(&mesh, &nothing, &none, CameraTracking::Exact);
    RayScene::new(problem, camera, Tracking::Exact).radiance()
}

/// An estimator without lookups of shadow rays.
fn alone(problem: &SingleScattering, sampling: f64) -> Estimator<'_> {
    Estimator { problem, walk: [sampling, 0.0], tracking: Tracking::Exact, count: 1 }
}

/// A light of power 1 beside a ray through a homogeneous medium that scatters evenly.
pub(super) fn lit(
    sigma: f64,
    distance: f64,
    foot: f64,
    length: f64,
    albedo: f64,
) -> Option<SingleScattering> {
    let field = Space::Constant(sigma).volume();
    let ray = Ray::new(Point([0.0; 3]), Point([0.0, 0.0, 1.0]), length)?;
    let lamp = Lamp { position: Point([distance, 0.0, foot]), power: 1.0 };
    let phase = Phase::Isotropic(Isotropic);
    SingleScattering::new(field, ray, lamp, albedo, phase).ok()
}

fn homogeneous(
    &Even { albedo, length, depth, distance, foot }: &Even,
    seen: &mut Seen,
) -> Option<()> {
    let (sigma, foot) = (depth / length, foot * length);
    let problem = lit(sigma, distance, foot, length, albedo)?;
    let (computed, exact) =
        (radiance(&problem), even(&alone(&problem, sigma), sigma, 1).radiance());
    if exact.high < 1e-290 {
        return None;
    }
    seen.beyond_rounding(0, computed, exact);
    Some(())
}

/// A ray through a field that varies, and a light beside it.
#[derive(Debug, Clone, Copy)]
pub(super) struct LitRay {
    field: Space,
    from: [f64; 2],
    to: [f64; 2],
    away: f64,
    along: f64,
    turn: f64,
    phase: Phase,
}

pub(super) fn lit_field() -> impl Strategy<Value = LitRay> {
    let field = any_of(&[
        Space::Eq21,
        Space::Radial,
        Space::Gaussian(1.0, 2.0, 9.0),
        Space::Exponential(0.3, 9.0),
    ]);
    let light = (sized(-3.0, 1.0), between(0.1, 0.9), between(0.0, TAU));
    let ends = [[between(-3.0, 3.0); 2]; 2];
    (field, ends, light, between(-0.8, 0.8)).prop_map(|(field, [from, to], light, asymmetry)| {
        let (away, along, turn) = light;
        LitRay { field, from, to, away, along, turn, phase: henyey_greenstein(asymmetry) }
    })
}

impl LitRay {
    pub fn problem(&self) -> Option<SingleScattering> {
        let &Self { field, from: [x, y], to: [u, v], away, along, turn, phase } = self;
        let origin = Point([x, y, -5.0]);
        let ray = Ray::new(origin, Point([u, v, 15.0]) - origin, 26.0)?;
        let side = ray.direction.cross(Point([0.0, 1.0, 0.0])).normalised()?;
        let up = ray.direction.cross(side);
        let aside = side * turn.cos() + up * turn.sin();
        let lamp = Lamp { position: ray.at(26.0 * along) + aside * away, power: 1.0 };
        SingleScattering::new(field.volume(), ray, lamp, 0.7, phase).ok()
    }
}
