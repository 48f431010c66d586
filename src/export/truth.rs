//! `truth.json`: expected values of the pixels of each picture.
//!
//! ```text
//! version              1; it grows when a key changes its meaning
//! case, problem        the exported case
//! target               "mitsuba" or "pbrt"
//! camera_in_medium     whether the ray begins within the medium
//! field                file, size, low, high, interpolation, border and peak of the samples; null for a ball
//! notes                parts of the case that are not in the scene, in sentences
//! questions            one for each picture:
//!   name, scene        the quantity, and the scene file
//!   channel            one of several, from 1: in Mitsuba's pixels 1 is red, 2 green, 3 blue; in pbrt each channel has
//!                      a scene of its own
//!   mean, error        the mean of one sample of any pixel, and a bound on the error of this number
//!   rounding           effect of single precision on a sample, relative to the mean: an allowance, not a bound
//!   without_emitter_sampling, with_emitter_sampling
//!                      the distribution of one sample, for integrators that find lights by scattering only, and for
//!                      those that cast shadow rays: null where light cannot be found that way, and for pbrt, which
//!                      draws wavelengths. With several channels only the range is known: it is up to the renderer
//!                      for which channel it samples
//!     low, high        range of all samples; null for no end
//!     variance, variance_error, kurtosis
//!                      of an integrator that tracks through the largest sample, and weights by the albedo;
//!                      variance_error is relative; null where theory does not know
//! ```

use std::fmt::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::fields::{FILE as GRID, file_of};
use super::scene::{ExportedField, ExportedLight, ExportedScene, ExportedView};
use super::{ExportError, Target};
use crate::case::{Case, CaseText};
use crate::json;
use media::phase::Phase;
use numeric::geometry::{Aabb, Bounds, Point};
use theory::{self, Prediction};

/// Name of the file.
pub const FILE: &str = "truth.json";
/// Name of the case file from which theory predicts the answer.
pub const CASE: &str = "case.toml";
/// Version of the file's format.
pub const VERSION: u32 = 1;
/// Number of rounding errors of single precision that are allowed for each of the mean collisions of a straight ray.
const ROUNDINGS: f64 = 16.0;

/// Expected values of pixels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Version of the format, [`VERSION`].
    pub version: u32,
    /// The name of the case.
    pub case: String,
    /// The name of its problem.
    pub problem: String,
    /// The renderer.
    pub target: String,
    /// True if the camera is in the medium.
    pub camera_in_medium: bool,
    /// The samples.
    pub field: Option<Samples>,
    /// Sentences about parts of the case that are not in the scene.
    pub notes: Vec<String>,
    /// Expected samples, one entry per picture.
    pub questions: Vec<ExpectedSamples>,
}

/// The samples of a field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// The file.
    pub file: String,
    /// Numbers of samples along x, y and z.
    pub size: [usize; 3],
    /// A corner of the box.
    pub low: [f64; 3],
    /// The other corner.
    pub high: [f64; 3],
    /// `"trilinear"` or `"nearest"`.
    pub interpolation: String,
    /// Value beyond the outermost samples: `"clamp"` or `"zero"`.
    pub border: String,
    /// Largest sample, 1/length.
    pub peak: f64,
}

/// Expected samples of a picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExpectedSamples {
    /// Name of the quantity.
    pub name: String,
    /// Scene file.
    pub scene: String,
    /// Channel, from 1, if there are several.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<usize>,
    /// Mean of one sample.
    pub mean: f64,
    /// Bound on the error of the mean.
    pub error: f64,
    /// Effect of single precision on a sample, relative to the mean.
    pub rounding: f64,
    /// Distribution for integrators that find lights by scattering only.
    pub without_emitter_sampling: Option<SampleProperties>,
    /// Distribution for integrators that cast shadow rays.
    pub with_emitter_sampling: Option<SampleProperties>,
}

/// Known properties of the distribution of one sample.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SampleProperties {
    /// Lower bound of all samples.
    pub low: Option<f64>,
    /// Upper bound of all samples.
    pub high: Option<f64>,
    /// Variance.
    pub variance: Option<f64>,
    /// Bound on the relative error of the variance.
    pub variance_error: Option<f64>,
    /// Kurtosis.
    pub kurtosis: Option<f64>,
}

impl Truth {
    /// Returns the text of the file.
    ///
    /// # Errors
    ///
    /// The encoder fails.
    pub fn json(&self) -> Result<String, ExportError> {
        Ok(json::pretty(self)? + "\n")
    }
}

/// Returns the expected values of the pictures, by theory's prediction of the exported case.
pub fn of(scene: &ExportedScene, prediction: &Prediction) -> Truth {
    let diagonal = (scene.bounds().high - scene.bounds().low).norm();
    let rounding = ROUNDINGS * f64::from(f32::EPSILON) * (1.0 + scene.peak() * diagonal);
    let question = |(view, number): (&ExportedView, Option<usize>), channel: &theory::Channel| {
        let [without, with] = samples(scene, view.light);
        let known = channel.moments.filter(|moments| moments.variance().is_finite());
        let fill = |sample: SampleProperties| SampleProperties {
            variance: sample.variance.or(known.map(|moments| moments.variance())),
            variance_error: sample.variance_error.or(known.and_then(|_| channel.moments_error())),
            kurtosis: known.and_then(|moments| moments.kurtosis()).filter(|k| k.is_finite()),
            ..sample
        };
        let is_of = |sample: Option<(SampleProperties, bool)>| {
            sample.map(|(sample, is_known)| if is_known { fill(sample) } else { sample })
        };
        ExpectedSamples {
            name: if number.is_some() { channel.name.clone() } else { view.name.to_owned() },
            scene: scene.file(view, number),
            channel: number,
            mean: channel.truth.value,
            error: channel.truth.error,
            rounding,
            without_emitter_sampling: is_of(without),
            with_emitter_sampling: is_of(with),
        }
    };
    let views = scene.asked();
    let questions = views.into_iter().filter_map(|(view, number)| {
        let channel = channel_of(prediction, scene, view, number)?;
        Some(question((view, number), channel))
    });
    let field = scene.grids().first().map(|grid| Samples {
        file: GRID.into(),
        size: grid.size,
        low: grid.bounds.low.0,
        high: grid.bounds.high.0,
        interpolation: if grid.nearest { "nearest" } else { "trilinear" }.into(),
        border: scene.target.border().into(),
        peak: scene.peak(),
    });
    Truth {
        version: VERSION,
        case: scene.case.clone(),
        problem: scene.problem.to_owned(),
        target: scene.target.name().to_owned(),
        camera_in_medium: scene.is_inside,
        field,
        notes: scene.notes.clone(),
        questions: questions.collect(),
    }
}

/// Returns the predicted channel of a picture. Theory lists the channels of one quantity after those of another, and
/// omits channels that are always 0.
fn channel_of<'a>(
    prediction: &'a Prediction,
    scene: &ExportedScene,
    view: &ExportedView,
    number: Option<usize>,
) -> Option<&'a theory::Channel> {
    let Some(number) = number else {
        let place = scene.views.iter().position(|one| one.name == view.name)?;
        return prediction.channels.get(place);
    };
    let several = scene.views.len() > 1;
    let name = if several {
        format!("{}, channel {number}", view.name)
    } else {
        format!("channel {number}")
    };
    prediction.channels.iter().find(|channel| channel.name == name)
}

/// Returns the range of samples without and with shadow rays, and whether theory's moments apply to them.
///
/// Without shadow rays a sample is `aⁿ` or 0. With them and weights that add up to at most 1, every scattering
/// contributes at most `aⁿ`: `Σ aⁿ = 1/(1 − a)`.
fn samples(scene: &ExportedScene, light: ExportedLight) -> [Option<(SampleProperties, bool)>; 2] {
    let within = |high: Option<f64>| SampleProperties {
        low: Some(0.0),
        high,
        ..SampleProperties::default()
    };
    let sure = SampleProperties {
        variance: Some(0.0),
        variance_error: Some(0.0),
        ..SampleProperties::default()
    };
    let albedo = scene.channels[0].albedo;
    let sum = (albedo < 1.0).then(|| 1.0 / (1.0 - albedo));
    if scene.target == Target::Pbrt {
        return [None, None];
    }
    if scene.is_coloured() {
        let extinctions = !matches!(light, ExportedLight::Point { .. });
        return [extinctions.then(|| (within(None), false)), Some((within(None), false))];
    }
    match (scene.problem, light) {
        ("transmittance", _) => [Some((within(Some(1.0)), true)); 2],
        ("furnace", _) => [Some((sure, false)), Some((within(None), false))],
        (_, ExportedLight::Point { .. }) => [None, Some((within(None), true))],
        ("slab", _) => [Some((within(Some(1.0)), true)), Some((within(sum), false))],
        _ => [Some((within(Some(1.0)), false)), Some((within(sum), false))],
    }
}

/// Returns the case file: the exported field, ray and light, and the estimator closest to a renderer's integrator.
/// `trueflight run` and `trueflight bench` read it, so that both can be timed on the same field.
pub fn case(scene: &ExportedScene) -> String {
    let ExportedScene { direction, .. } = scene;
    let (problem, is_coloured) = (scene.problem, scene.is_coloured());
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
    // σ_t of a slab is a function of depth, whatever the angle of its light.
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
        Some(ExportedLight::Point { position, power }) => {
            line(format!("light = {{ position = {:?}, power = {power:?} }}", position.0));
        }
        Some(ExportedLight::Core { radius }) => {
            line(format!("light.black-sphere = {{ radius = {radius:?} }}"));
        }
        Some(ExportedLight::Everywhere) if problem == "ball" => {
            line("light.environment = {}".into());
        }
        _ => {}
    }
    if scene.has_mirrors {
        line(format!("incidence.collimated = {{ cosine = {:?} }}", scene.direction.0[2]));
    }
    let peak = scene.peak();
    line(format!("sampling.constant = {{ value = {peak:?} }}"));
    let estimator = match (problem, is_coloured) {
        // With several channels an estimator that can take the largest σ_t of all channels as σ̂.
        ("transmittance", true) => "{ independent = { collisions = \"delta\" } }".to_owned(),
        ("single-scattering", true) => "{ independent = { shadow = \"ratio\" } }".to_owned(),
        (_, true) => "{ independent = {} }".to_owned(),
        ("transmittance", _) => "{ woodcock = {} }".to_owned(),
        ("slab", _) => "{ weighted = {} }".to_owned(),
        ("single-scattering", _) => {
            format!("{{ delta-tracking = {{ shadow.ratio = {{ sampling = {peak:?} }} }} }}")
        }
        _ => "{ particle = { rule = \"weighted\" } }".to_owned(),
    };
    line(format!("estimators = [{estimator}]"));
    text
}

/// Returns the volume of a channel in the case file.
fn volume(scene: &ExportedScene, channel: usize) -> String {
    let field = match &scene.channels[channel].field {
        ExportedField::Grid(grid) => {
            let rest = if grid.nearest {
                "interpolation = \"nearest\"".to_owned()
            } else {
                format!("border = {:?}", scene.target.border())
            };
            let own = scene.grids().len() > 1;
            let file = if own { file_of(channel) } else { GRID.to_owned() };
            format!("grid = {{ file = {file:?}, {rest}")
        }
        ExportedField::Even(extinction) => format!("constant = {{ extinction = {extinction:?}"),
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

/// Returns the phase function of the case file.
fn phase(phase: Phase) -> String {
    match phase {
        Phase::Isotropic(_) => "isotropic = {}".into(),
        Phase::Rayleigh(_) => "rayleigh = {}".into(),
        Phase::HenyeyGreenstein(lobe) => format!("henyey-greenstein = {{ g = {:?} }}", lobe.g()),
    }
}

/// Returns the reason why some renderers are biased or have infinite variance here, as far as theory knows one: those
/// that track for one channel through the largest σ_t of all, without multiple importance sampling.
pub fn remark(scene: &ExportedScene, folder: &Path) -> Option<String> {
    if !scene.is_coloured() || scene.is_homogeneous() || scene.problem != "transmittance" {
        return None;
    }
    let text = case(scene).replace("{ independent =", "{ hero =");
    let source = CaseText { name: scene.case.clone(), path: folder.join(CASE), text };
    let case = Case::read(&source).ok()?;
    let refusal = case.at(None).and_then(|at| at.prepare(0, case.pilots(1, 0))).err()?;
    Some(format!(
        "tracking for one channel, without multiple importance sampling of the others, {refusal}"
    ))
}

/// Predicts the case file in a folder.
///
/// # Errors
///
/// The reason why theory has no answer.
pub fn ask(scene: &ExportedScene, folder: &Path) -> Result<Prediction, ExportError> {
    let case = Case::read(&CaseText::read(&folder.join(CASE))?)?;
    let ready = case.at(None).and_then(|at| at.prepare(0, case.pilots(1, 0)));
    let unknown = |why: String| ExportError::Unknown { case: scene.case.clone(), why };
    Ok(ready.map_err(|refusal| unknown(refusal.to_string()))?.prediction)
}
