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

use super::costs::stated;
use super::scattering::lit;
use super::techniques::{Case, Wanted};
use super::trial::{Dice, Trial, central};
use super::{Effort, Row, in_parts};
use media::{Control, Piecewise};
use numeric::Wide;
use theory::Mesh;
use theory::problems::Problem;
use theory::single::predict::DENSITY;
use theory::single::{Camera, CameraTracking, Node, Scene, Tracking};

/// Techniques that take turns where rays are deep.
const TECHNIQUES: u64 = 6;

/// All rows.
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    let trials = |part: u64, rest: u64| effort.of(u32::from(part % 2 == rest), 6);
    let shallow = in_parts(16, "scattered", seed, |part| {
        let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 1e-12 … 10, σ̂/σ_t = 0.5 … 1e4, \
                     light 1e-6 … 10 ℓ away";
        part.run(trials(part.number, 0), kinds(range), |t| {
            let setting = Setting::shallow(t.dice);
            trial(t, &setting, &|_| true)
        });
    });
    let deep = in_parts(16, "scattered, deep", seed, |part| {
        let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 10 … 1e3, σ̂/σ_t = 0.3 … 1e3, \
                     light 1e-4 … 100 mean free paths away";
        part.run(trials(part.number, 1), kinds(range), |t| {
            let setting = Setting::deep(t.dice);
            // A chain through many mean free paths takes seconds for all techniques.
            let turn = (t.part / 2 + u64::from(t.number)) % TECHNIQUES;
            trial(t, &setting, &|technique| technique == turn)
        });
    });
    shallow.into_iter().chain(deep).collect()
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
struct Setting {
    sigma: f64,
    length: f64,
    distance: f64,
    foot: f64,
    /// `σ̂/σ_t`.
    ratio: f64,
}

impl Setting {
    fn shallow(dice: &mut Dice) -> Self {
        let length = dice.sized(-1.0, 1.0);
        let depth =
            if dice.below(4) == 0 { dice.sized(-12.0, -3.0) } else { dice.sized(-3.0, 1.0) };
        let away = if dice.below(4) == 0 { dice.sized(-6.0, -2.0) } else { dice.sized(-2.0, 1.0) };
        let foot = dice.between(-0.3, 1.3) * length;
        let most = if dice.below(4) == 0 { 4.0 } else { 1.0 };
        let ratio = dice.sized(-0.3, most);
        Self { sigma: depth / length, length, distance: away * length, foot, ratio }
    }

    /// With a light that is not too many mean free paths away.
    fn deep(dice: &mut Dice) -> Self {
        let (length, depth) = (dice.sized(-1.0, 1.0), dice.sized(1.0, 3.0));
        let path = length / depth;
        let distance = dice.sized(-4.0, 2.0) * path;
        let foot = (dice.sized(-2.0, 2.0) * path).min(1.3 * length) * dice.sign();
        let ratio = if dice.below(4) == 0 { dice.sized(1.0, 3.0) } else { dice.sized(-0.5, 1.0) };
        Self { sigma: depth / length, length, distance, foot, ratio }
    }
}

fn trial(t: &mut Trial, setting: &Setting, is_wanted: &dyn Fn(u64) -> bool) -> Option<()> {
    let dice = &mut *t.dice;
    let &Setting { sigma, length, distance, foot, ratio } = setting;
    let albedo = dice.between(0.1, 1.0);
    let mut residual = || if dice.below(2) == 0 { 0.0 } else { sigma * dice.between(0.0, 1.2) };
    let (control, shadow_control) = (residual(), residual());
    let sampling = sigma * ratio;
    let tracking = match dice.below(3) {
        0 => Tracking::Exact,
        1 => Tracking::Ratio { sampling: sigma * dice.sized(-0.3, 1.0), control: shadow_control },
        _ => Tracking::Delta { sampling: sigma * dice.sized(0.0, 1.0) },
    };
    let count = 1 + dice.below(8);
    let place = format!(
        "σ_t = {sigma:e}, σ̂ = {sampling:e}, σ_c = {control:e}, {tracking:?}, D = {distance:e}, \
         foot {foot:e}, ℓ = {length:e}"
    );
    t.place.clone_from(&place);
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
    let [by_angle, by_depth] = [(); 2].map(|()| alongs[dice.below(alongs.len())]);
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
    for Wanted { name, is_walk, found, moments, lookups } in wanted {
        t.place = format!("{name}, {place}");
        let row = 3 * usize::from(is_walk);
        let prediction = found.prediction();
        // A spread that rounding hides is not told.
        t.moments(row, prediction.channels[0].moments, |scale| {
            central(moments(&values), Wide::from(scale))
        });
        match prediction.lookups.zip(lookups) {
            Some((law, lookups)) => t.stated(row + 2, stated(&law), lookups(&values)),
            None => t.skip(row + 2),
        }
    }
    Some(())
}
