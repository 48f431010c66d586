//! What theory says of the scene, asked as anybody would: by a case file.
//!
//! `case.toml` holds the exported field, ray and light, and the estimator that a renderer's integrator is nearest
//! to. `trueflight run` and `trueflight bench` take it, so that both can be timed on the same field.

use std::fmt::Write;
use std::path::Path;

use super::error::ExportError;
use super::sampled::FILE as GRID;
use super::scene::{Body, Light, Scene};
use crate::geometry::{Aabb, Point};
use crate::harness::{Case, Source};
use crate::phase::Phase;
use crate::theory::Prediction;

/// The name of the file.
pub const FILE: &str = "case.toml";

/// The case file.
pub fn case(scene: &Scene) -> String {
    let Scene { problem, direction, albedo, .. } = scene;
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
    line(volume(scene));
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
    if *problem != "transmittance" {
        line(format!("albedo = {albedo:?}"));
        line(format!("phase.{}", phase(scene.phase)));
    }
    match scene.views.first().map(|view| view.light) {
        Some(Light::Point { position, power }) => {
            line(format!("light = {{ position = {:?}, power = {power:?} }}", position.0));
        }
        Some(Light::Core { radius }) => {
            line(format!("light.black-sphere = {{ radius = {radius:?} }}"));
        }
        Some(Light::Everywhere) if *problem == "sphere" => line("light.environment = {}".into()),
        _ => {}
    }
    if scene.has_mirrors {
        line(format!("incidence.collimated = {{ cosine = {:?} }}", scene.direction.0[2]));
    }
    let peak = scene.peak();
    line(format!("sampling.constant = {{ value = {peak:?} }}"));
    let estimator = match *problem {
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

/// The volume of the case file.
fn volume(scene: &Scene) -> String {
    match &scene.body {
        Body::Grid(grid) => {
            let Aabb { low, high } = grid.bounds;
            let rest = if grid.nearest {
                "interpolation = \"nearest\"".to_owned()
            } else {
                format!("border = {:?}", scene.target.border())
            };
            format!(
                "volume.grid = {{ file = {GRID:?}, {rest}, bounds.box = {{ low = {:?}, high = {:?} }} }}",
                low.0, high.0
            )
        }
        Body::Ball { centre, radius, extinction } => format!(
            "volume.constant = {{ extinction = {extinction:?}, bounds.sphere = {{ centre = {:?}, radius = \
             {radius:?} }} }}",
            centre.0
        ),
    }
}

/// The phase function of the case file.
fn phase(phase: Phase) -> String {
    match phase {
        Phase::Isotropic(_) => "isotropic = {}".into(),
        Phase::Rayleigh(_) => "rayleigh = {}".into(),
        Phase::HenyeyGreenstein(lobe) => format!("henyey-greenstein = {{ g = {:?} }}", lobe.g()),
    }
}

/// What theory predicts of the case file in a folder.
///
/// # Errors
///
/// Why theory has no answer.
pub fn ask(scene: &Scene, folder: &Path) -> Result<Prediction, ExportError> {
    let case = Case::read(&Source::read(&folder.join(FILE))?)?;
    let ready = case.scenario.prepare(0, None, case.pilots(1, 0));
    let unknown = |why: String| ExportError::Unknown { case: scene.case.clone(), why };
    Ok(ready.map_err(|refusal| unknown(refusal.to_string()))?.prediction)
}
