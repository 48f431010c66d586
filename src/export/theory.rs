//! What theory says of the scene, asked as anybody would: by a case file.
//!
//! `case.toml` holds the exported field, ray and light, and the estimator that a renderer's integrator is nearest
//! to. `trueflight run` and `trueflight bench` take it, so that both can be timed on the same field.

use std::fmt::Write;
use std::path::Path;

use super::error::ExportError;
use super::sampled::{FILE as GRID, file_of};
use super::scene::{Field, Light, Scene};
use crate::case::Case;
use crate::case::Source;
use ::theory::Prediction;
use media::phase::Phase;
use numeric::geometry::{Aabb, Bounds, Point};

/// The name of the file.
pub const FILE: &str = "case.toml";

/// The case file.
pub fn case(scene: &Scene) -> String {
    let Scene { direction, .. } = scene;
    let (problem, is_coloured) = (scene.problem_of_theory(), scene.is_coloured());
    let mut text = format!(
        "# {}, as `trueflight export --to {}` sampled it.\ntitle = {:?}\ndraws = 1_000_000\n\
         underpowered = \"allow\"\n\n[problem.{problem}]\n",
        scene.case,
        scene.target.name(),
        format!("{}, as exported", scene.case),
    );
    let mut line = |words: String| {
        let _ = writeln!(text, "{words}");
    };
    let fields: Vec<String> = (0..scene.channels.len()).map(|n| volume(scene, n)).collect();
    line(match fields.as_slice() {
        [one] => format!("volume.{one}"),
        all => format!("volume = [\n  {{ {} }},\n]", all.join(" },\n  { ")),
    });
    let Aabb { low, high } = scene.bounds();
    let length = 2.0 * ((high - low).norm() + (scene.eye - low).norm());
    // A slab's σ_t is a function of the depth, whatever the angle of its light.
    let (eye, direction) = if scene.has_mirrors {
        (Point([0.0; 3]), Point([0.0, 0.0, 1.0]))
    } else {
        (scene.eye, *direction)
    };
    let length = if scene.has_mirrors { high.0[2] } else { length };
    line(format!(
        "ray = {{ origin = {:?}, direction = {:?}, length = {length:?} }}",
        eye.0, direction.0
    ));
    let (albedos, lobe) = (scene.albedos(), phase(scene.phase));
    if scene.problem != "transmittance" && is_coloured {
        line(format!("albedos = {albedos:?}"));
        let phases = vec![format!("{{ {lobe} }}"); albedos.len()];
        line(format!("phases = [{}]", phases.join(", ")));
    } else if scene.problem != "transmittance" {
        line(format!("albedo = {:?}", albedos[0]));
        line(format!("phase.{lobe}"));
    }
    match scene.views.first().map(|view| view.light) {
        Some(Light::Point { position, power }) => {
            line(format!("light = {{ position = {:?}, power = {power:?} }}", position.0));
        }
        Some(Light::Core { radius }) => {
            line(format!("light.black-sphere = {{ radius = {radius:?} }}"));
        }
        Some(Light::Everywhere) if problem == "sphere" => line("light.environment = {}".into()),
        _ => {}
    }
    if scene.has_mirrors {
        line(format!("incidence.collimated = {{ cosine = {:?} }}", scene.direction.0[2]));
    }
    let peak = scene.peak();
    line(format!("sampling.constant = {{ value = {peak:?} }}"));
    let estimator = match problem {
        // Of several channels one whose σ̂ may be the largest σ_t of all.
        "spectral-transmittance" => "{ independent = { collisions = \"delta\" } }".to_owned(),
        "spectral-single-scattering" => "{ independent = { shadow = \"ratio\" } }".to_owned(),
        "spectral-furnace" | "chromatic-slab" => "{ independent = {} }".to_owned(),
        "transmittance" => "{ woodcock = {} }".to_owned(),
        "slab" => "{ weighted = {} }".to_owned(),
        "single-scattering" => {
            format!("{{ delta-tracking = {{ shadow.ratio = {{ sampling = {peak:?} }} }} }}")
        }
        _ => "{ particle = { rule = \"weighted\" } }".to_owned(),
    };
    line(format!("estimators = [{estimator}]"));
    text
}

/// The volume of a channel in the case file.
fn volume(scene: &Scene, channel: usize) -> String {
    let field = match &scene.channels[channel].field {
        Field::Grid(grid) => {
            let rest = if grid.nearest {
                "interpolation = \"nearest\"".to_owned()
            } else {
                format!("border = {:?}", scene.target.border())
            };
            let own = scene.grids().len() > 1;
            let file = if own { file_of(channel) } else { GRID.to_owned() };
            format!("grid = {{ file = {file:?}, {rest}")
        }
        Field::Even(extinction) => format!("constant = {{ extinction = {extinction:?}"),
    };
    let bounds = match scene.shape {
        Bounds::Sphere { centre, radius } => {
            format!("sphere = {{ centre = {:?}, radius = {radius:?} }}", centre.0)
        }
        Bounds::Box(_) | Bounds::Everywhere => {
            let Aabb { low, high } = scene.bounds();
            format!("box = {{ low = {:?}, high = {:?} }}", low.0, high.0)
        }
    };
    format!("{field}, bounds.{bounds} }}")
}

/// The phase function of the case file.
fn phase(phase: Phase) -> String {
    match phase {
        Phase::Isotropic(_) => "isotropic = {}".into(),
        Phase::Rayleigh(_) => "rayleigh = {}".into(),
        Phase::HenyeyGreenstein(lobe) => format!("henyey-greenstein = {{ g = {:?} }}", lobe.g()),
    }
}

/// The reason why a renderer is biased, or has no variance, that tracks for one channel through the largest σ_t of all
/// without multiple importance sampling, as far as theory knows one.
pub fn remark(scene: &Scene, folder: &Path) -> Option<String> {
    if !scene.is_coloured() || scene.is_homogeneous() || scene.problem != "transmittance" {
        return None;
    }
    let text = case(scene).replace("{ independent =", "{ hero =");
    let source = Source { name: scene.case.clone(), path: folder.join(FILE), text };
    let case = Case::read(&source).ok()?;
    let refusal = case.at(None).and_then(|at| at.prepare(0, case.pilots(1, 0))).err()?;
    Some(format!(
        "tracking for one channel, without multiple importance sampling of the others, {refusal}"
    ))
}

/// What theory predicts of the case file in a folder.
///
/// # Errors
///
/// Why theory has no answer.
pub fn ask(scene: &Scene, folder: &Path) -> Result<Prediction, ExportError> {
    let case = Case::read(&Source::read(&folder.join(FILE))?)?;
    let ready = case.at(None).and_then(|at| at.prepare(0, case.pilots(1, 0)));
    let unknown = |why: String| ExportError::Unknown { case: scene.case.clone(), why };
    Ok(ready.map_err(|refusal| unknown(refusal.to_string()))?.prediction)
}
