//! Single scattering: moments and lookups of what estimates it, in homogeneous media.
//!
//! All are chains of linear equations, see `chains`, with `c = aΦ/(16π²)`, rates `A_k` of the transmittance
//! from the ray's origin to the power k, and `B_k` of that of the shadow ray.
//!
//! ```text
//! at a point of density p       E[X^k] = ∫ p (σ_t c/(p r²))^k e^{−A_k s − B_k r} ds
//! at every collision            −U_k' = Σⱼ (k over j) σ̂ (σ_t c/(σ̂ r²))ʲ e^{−Bⱼ r} w^{k−j} U_{k−j} − A_k U_k
//! resampled                     E[F^{k−1} G_k], see `theory::single::walks`
//! at n points, one walk         E[A₁^{n₁} A₂^{n₂} …], likewise
//! ```

use super::prelude::*;
use super::rods::lookups;
use super::scattering::lit;
use super::techniques::{Case, Wanted};
use theory::problems::Problem;
use theory::single::predict::DENSITY;
use theory::single::{Camera, CameraTracking, Node, Scene, Tracking};

/// Techniques that take turns where rays are deep.
const TECHNIQUES: usize = 6;

/// All rows.
pub fn rows(run: Run) -> Vec<Row> {
    let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 1e-12 … 10, σ̂/σ_t = 0.5 … 1e4, \
                 light 1e-6 … 10 ℓ away";
    let both = || (shallow(), Choices::any());
    let mut rows = run.fill([8, 96], kinds(range), both, |(setting, choices), seen| {
        trial(setting, choices, &|_| true, seen)
    });
    let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 10 … 1e3, σ̂/σ_t = 0.3 … 1e3, \
                 light 1e-4 … 100 mean free paths away";
    // A chain through many mean free paths takes seconds for all techniques.
    let both = || (deep(), Choices::any());
    rows.extend(run.fill([8, 96], kinds(range), both, |(setting, choices), seen| {
        trial(setting, choices, &|technique| technique == choices.technique, seen)
    }));
    rows
}

/// Rows of techniques that scatter at one point, and at many of a walk.
fn kinds(range: &str) -> [Row; 6] {
    let whats = ["variance", "fourth moment", "lookups"];
    std::array::from_fn(|i| {
        let kind = ["at one point", "of walks"][i / 3];
        Row::stated(format!("single scattering {kind}, {}", whats[i % 3]), range)
    })
}

/// A ray and a light beside it.
#[derive(Debug, Clone, Copy)]
struct Setting {
    sigma: f64,
    length: f64,
    distance: f64,
    foot: f64,
    /// `σ̂/σ_t`.
    ratio: f64,
}

fn shallow() -> impl Strategy<Value = Setting> {
    let depth = prop_oneof![1 => sized(-12.0, -3.0), 3 => sized(-3.0, 1.0)];
    let away = prop_oneof![1 => sized(-6.0, -2.0), 3 => sized(-2.0, 1.0)];
    let ratio = prop_oneof![1 => sized(-0.3, 4.0), 3 => sized(-0.3, 1.0)];
    (sized(-1.0, 1.0), depth, away, between(-0.3, 1.3), ratio).prop_map(
        |(length, depth, away, foot, ratio)| {
            let (sigma, distance, foot) = (depth / length, away * length, foot * length);
            Setting { sigma, length, distance, foot, ratio }
        },
    )
}

/// With a light that is not too many mean free paths away.
fn deep() -> impl Strategy<Value = Setting> {
    let ratio = prop_oneof![1 => sized(1.0, 3.0), 3 => sized(-0.5, 1.0)];
    let light = (sized(-4.0, 2.0), sized(-2.0, 2.0), sign());
    (sized(-1.0, 1.0), sized(1.0, 3.0), light, ratio).prop_map(
        |(length, depth, (away, foot, sign), ratio)| {
            let path = length / depth;
            let foot = (foot * path).min(1.3 * length) * sign;
            Setting { sigma: depth / length, length, distance: away * path, foot, ratio }
        },
    )
}

parameters! {
    /// An estimator of a scene; controls and σ̂ of shadow rays are in units of σ_t.
    Choices {
        albedo: f64 = between(0.1, 1.0),
        control: f64 = residual(),
        shadow: Tracking = prop_oneof![
            Just(Tracking::Exact),
            (sized(-0.3, 1.0), residual())
                .prop_map(|(sampling, control)| Tracking::Ratio { sampling, control }),
            sized(0.0, 1.0).prop_map(|sampling| Tracking::Delta { sampling }),
        ],
        count: usize = 1..=8_usize,
        alongs: [usize; 2] = [0..6_usize, 0..6_usize],
        technique: usize = 0..TECHNIQUES,
    }
}

/// A control in one of two.
fn residual() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), between(0.0, 1.2)]
}

fn trial(
    setting: &Setting,
    choices: &Choices,
    is_wanted: &dyn Fn(usize) -> bool,
    seen: &mut Seen,
) -> Option<()> {
    let &Setting { sigma, length, distance, foot, ratio } = setting;
    let &Choices { albedo, control, shadow, count, alongs: chosen, .. } = choices;
    let (sampling, control) = (sigma * ratio, sigma * control);
    let tracking = match shadow {
        Tracking::Exact => Tracking::Exact,
        Tracking::Ratio { sampling, control } => {
            Tracking::Ratio { sampling: sigma * sampling, control: sigma * control }
        }
        Tracking::Delta { sampling } => Tracking::Delta { sampling: sigma * sampling },
    };
    let problem = lit(sigma, distance, foot, length, albedo)?;
    let mut case = Case::new(&problem, (sigma, length), [sampling, control], tracking);
    let mesh = Mesh::new(problem.medium().clone());
    let flown = Piecewise::constant(sampling, mesh.support());
    let main = match control {
        0.0 => Control::None,
        control => Control::Pieces(Piecewise::constant(control, mesh.support())),
    };
    let scene = |along| {
        // Delta tracking has no control.
        let control = if along == CameraTracking::Ratio { &main } else { &Control::None };
        Scene::new(&problem, Camera::new(&mesh, &flown, control, along), tracking, Vec::new())
    };
    let walk = scene(CameraTracking::Ratio);
    let mut wanted = Vec::new();
    if is_wanted(0) {
        wanted.push(case.at_collisions(&walk));
    }
    if is_wanted(1) {
        wanted.push(case.resampled(&walk, tracking));
    }
    if is_wanted(2) {
        wanted.push(case.at_points(&walk, &problem, count));
    }
    let mut alongs = vec![CameraTracking::Exact, CameraTracking::Ratio];
    if sampling >= sigma {
        alongs.push(CameraTracking::Delta);
        if is_wanted(3) {
            wanted.push(case.found(&scene(CameraTracking::Exact)));
        }
    }
    let [by_angle, by_depth] = chosen.map(|number| alongs[number % alongs.len()]);
    if is_wanted(4) {
        let density = |node: &Node| problem.equiangular_density_beyond(node.along);
        let from = ("by angle", &scene(by_angle), by_angle);
        wanted.push(case.at_point(from, [&density, &|_| DENSITY], (-2, Wide::default())));
    }
    if is_wanted(5) {
        // Points are found in closed form: no deeper than −ln 2⁻⁵³ = 37.
        let rate = sampling.min(30.0 / length);
        let found = -(-rate * length).exp_m1();
        let density = |node: &Node| rate * (-rate * node.s).exp() / found;
        let blur = |node: &Node| DENSITY + f64::EPSILON * rate * node.s;
        let from = ("by depth", &scene(by_depth), by_depth);
        wanted.push(case.at_point(from, [&density, &blur], (0, Wide::from(rate))));
    }
    let values = case.chain.solve();
    for Wanted { name, is_walk, found, moments, lookups: exact } in wanted {
        seen.at(name);
        let row = 3 * usize::from(is_walk);
        let prediction = found.prediction();
        // A spread that rounding hides is not told.
        seen.moments(row, prediction.channels[0].moments, |scale| {
            central(moments(&values), Wide::from(scale))
        });
        match prediction.lookups.zip(exact) {
            Some((law, exact)) => seen.stated(row + 2, lookups(&law), exact(&values)),
            None => seen.skip(row + 2),
        }
    }
    Some(())
}
