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

use super::collided::central;
use super::costs::stated;
use super::rods::of_stated;
use super::scattering::lit;
use super::techniques::{Case, Wanted};
use super::{Dice, Effort, Measure, Row, in_parts};
use crate::media::{Control, Piecewise};
use crate::numeric::Wide;
use crate::problems::Problem;
use crate::theory::Mesh;
use crate::theory::single::{Along, Camera, Node, Scene, Tracking};

const PARTS: u64 = 16;

/// All rows.
#[must_use]
pub fn rows(effort: Effort, seed: u64) -> Vec<Row> {
    in_parts(PARTS, |part| {
        let dice = &mut Dice::new(seed, "scattered", part);
        let range = "homogeneous, 3 shadows, residuals, σ_t ℓ = 1e-3 … 10, σ̂/σ_t = 0.5 … 10, \
                     light 1e-2 … 10 ℓ away";
        let row = |what: &str| Row::new(what, range, Measure::OfStated, 1.0);
        let mut kinds = ["at one point", "of walks"].map(|kind| {
            ["variance", "fourth moment", "lookups"]
                .map(|what| row(&format!("single scattering {kind}, {what}")))
        });
        for _ in 0..effort.of(u32::from(part % 2 == 0), 6) {
            trial(dice, &mut kinds);
        }
        kinds.into_iter().flatten().collect()
    })
}

fn trial(dice: &mut Dice, kinds: &mut [[Row; 3]; 2]) {
    let (albedo, length) = (dice.between(0.1, 1.0), dice.sized(-1.0, 1.0));
    let sigma = dice.sized(-3.0, 1.0) / length;
    let distance = dice.sized(-2.0, 1.0) * length;
    let foot = dice.between(-0.3, 1.3) * length;
    let ratio = dice.sized(-0.3, 1.0);
    let mut residual = || if dice.below(2) == 0 { 0.0 } else { sigma * dice.between(0.0, 1.2) };
    let (control, shadow_control) = (residual(), residual());
    let sampling = sigma * ratio;
    let tracking = match dice.below(3) {
        0 => Tracking::Exact,
        1 => Tracking::Ratio { sampling: sigma * dice.sized(-0.3, 1.0), control: shadow_control },
        _ => Tracking::Delta { sampling: sigma * dice.sized(0.0, 1.0) },
    };
    let count = 1 + dice.below(8);
    let place = || {
        format!(
            "σ_t = {sigma:e}, σ̂ = {sampling:e}, σ_c = {control:e}, {tracking:?}, D = {distance:e}, \
             foot {foot:e}, ℓ = {length:e}"
        )
    };
    let Some(problem) = lit(sigma, distance, foot, length, albedo) else {
        for row in kinds.iter_mut().flatten() {
            row.skip(place);
        }
        return;
    };
    let mut case = Case::new(&problem, (sigma, length), [sampling, control], tracking);
    let mesh = Mesh::even(problem.medium().clone(), 1);
    let flown = Piecewise::constant(sampling, mesh.support());
    let main = match control {
        0.0 => Control::None,
        control => Control::Pieces(Piecewise::constant(control, mesh.support())),
    };
    let scene = |along| {
        // Delta tracking has no control.
        let control = if along == Along::Ratio { &main } else { &Control::None };
        Scene::new(&problem, Camera::new(&mesh, &flown, control, along), tracking, Vec::new())
    };
    let mut wanted = vec![case.at_collisions(&scene(Along::Ratio))];
    wanted.push(case.resampled(&scene(Along::Ratio), tracking));
    wanted.push(case.at_points(&scene(Along::Ratio), &problem, count));
    let mut alongs = vec![Along::Exact, Along::Ratio];
    if sampling >= sigma {
        alongs.push(Along::Delta);
        wanted.push(case.found(&scene(Along::Exact)));
    }
    let along = alongs[dice.below(alongs.len())];
    let by_angle = |node: &Node| problem.equiangular_density(node.s);
    let from = ("by angle", &scene(along), along);
    wanted.push(case.at_point(from, &by_angle, (-2, Wide::default())));
    let found = -(-sampling * length).exp_m1();
    let by_depth = |node: &Node| sampling * (-sampling * node.s).exp() / found;
    let along = alongs[dice.below(alongs.len())];
    let from = ("by depth", &scene(along), along);
    wanted.push(case.at_point(from, &by_depth, (0, Wide::from(sampling))));
    let values = case.chain.solve();
    for Wanted { name, is_walk, found, moments, lookups } in wanted {
        let place = || format!("{name}, {}", place());
        let [second, fourth, counts] = &mut kinds[usize::from(is_walk)];
        let prediction = found.prediction();
        if let Some(known) = prediction.channels[0].moments {
            let exact = central(moments(&values), Wide::from(known.scale));
            second.see(exact[0].relative_error(known.relative[0]) / known.error, place);
            fourth.see(exact[1].relative_error(known.relative[2]) / known.error, place);
        } else {
            // A spread that rounding hides is not told.
            second.skip(place);
            fourth.skip(place);
        }
        match prediction.lookups.zip(lookups) {
            Some((law, lookups)) => counts.see(of_stated(stated(&law), lookups(&values)), place),
            None => counts.skip(place),
        }
    }
}
