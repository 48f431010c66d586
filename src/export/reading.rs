//! From a case to a scene, problem by problem.
//!
//! | problem | scene |
//! |---|---|
//! | `transmittance` | the field as layers along the ray, or the grid itself, black, in front of light from all sides |
//! | `furnace` | the field in a box, white, in light from all sides; the ray begins outside |
//! | `slab` | layers between mirrors, which is an infinite slab; light from above (reflectance) or below (transmittance) |
//! | `single-scattering` | the field in a box with a point light; the ray goes on to where it leaves the box |
//! | `sphere` | a homogeneous ball in light from all sides, or about a black sphere that shines |

use super::error::ExportError;
use super::sampled::Sampled;
use super::scene::{Body, Light, Scene, View};
use super::{Target, single};
use crate::catalogue::Settings;
use crate::geometry::{Aabb, Bounds, Point, Ray};
use crate::harness::sweep::What;
use crate::harness::{Catalogue, Source};
use crate::media::{self, Volume, grid_file};
use crate::phase::Phase;
use crate::phase::henyey_greenstein::HenyeyGreenstein;
use crate::phase::isotropic::Isotropic;
use crate::problems::single_scattering::Lamp;
use crate::problems::slab::Light as Incidence;
use crate::problems::sphere::{Light as BallLight, Sought};
use crate::problems::{Furnace, Problem, SingleScattering, Slab, Sphere, Transmittance};

/// Cells along the longest side of a field in space, and along a line.
const CELLS: [usize; 2] = [32, 256];

/// What is in the way, and which case would do.
type Unsuitable = (String, &'static str);

/// Reads a case as a scene.
///
/// # Errors
///
/// Mistakes in the case file, or what is in the way.
pub fn read(
    catalogue: &Catalogue,
    source: &Source,
    target: Target,
    cells: Option<usize>,
) -> Result<Scene, ExportError> {
    let case = catalogue.read(source)?;
    let reader = Reader { name: source.name.clone(), target, cells };
    let scene = source.read_as(catalogue.additions(), |root| {
        let problem = root.table("problem")?;
        Some(match case.problem.as_str() {
            "transmittance" => reader.transmittance(&problem.table("transmittance")?),
            "furnace" => reader.furnace(&problem.table("furnace")?),
            "slab" => reader.slab(&problem.table("slab")?),
            "single-scattering" => reader.single_scattering(&problem.table("single-scattering")?),
            "sphere" => reader.sphere(&problem.table("sphere")?),
            _ => Err((
                format!("renderers do not answer what `{}` asks", case.problem),
                "take a case of transmittance, furnace, slab, single-scattering or sphere",
            )),
        })
    })?;
    let swept = case.sweep.as_ref().map(|axis| axis.what);
    let varies = match swept {
        Some(What::Albedo) => !["transmittance", "furnace"].contains(&case.problem.as_str()),
        Some(What::Density | What::AlbedoScale | What::Contrast) => true,
        _ => false,
    };
    let checked = scene.and_then(|scene| {
        if varies {
            return Err(("it sweeps its medium".into(), "leave `sweep` out of a copy of the case"));
        }
        if !scene.grid().is_none_or(Sampled::is_extinction) {
            let why = "a sample of σ_t is no number of single precision from 0 to 3e38";
            return Err((why.into(), "take other units of length"));
        }
        if scene.peak() == 0.0 {
            return Err(("the sampled field is empty".into(), "take more --cells, or another ray"));
        }
        if scene.has_mirrors && target == Target::Pbrt {
            let why =
                "mirrors make a box an infinite slab, and those of pbrt reflect 0.9999 at most";
            return Err((why.into(), "take a case of another problem, such as furnace/eq21"));
        }
        if target == Target::Pbrt && matches!(scene.phase, Phase::Rayleigh(_)) {
            let cure = "take a case with `phase.isotropic` or `phase.henyey-greenstein`";
            return Err(("pbrt has no Rayleigh scattering".into(), cure));
        }
        Ok(scene)
    });
    checked.map_err(|(why, cure)| ExportError::Unsuitable {
        case: source.name.clone(),
        target: target.name(),
        why,
        cure: cure.into(),
    })
}

/// What all scenes of a case have in common.
struct Reader {
    name: String,
    target: Target,
    cells: Option<usize>,
}

impl Reader {
    /// A scene with one picture.
    fn scene(&self, problem: &'static str, body: Body, ray: [Point; 2], light: Light) -> Scene {
        let [eye, direction] = ray.map(|point| Point(point.0.map(single)));
        let (name, notes) = ("radiance", Vec::new());
        let name = if problem == "transmittance" { problem } else { name };
        let mut scene = Scene {
            case: self.name.clone(),
            problem,
            target: self.target,
            body,
            albedo: 1.0,
            phase: Phase::Isotropic(Isotropic),
            eye,
            direction,
            is_inside: false,
            has_mirrors: false,
            scatterings: None,
            views: vec![View { name, light }],
            notes,
        };
        scene.is_inside = match &scene.body {
            Body::Grid(grid) => Bounds::Box(grid.bounds).contains(eye),
            &Body::Ball { centre, radius, .. } => Bounds::Sphere { centre, radius }.contains(eye),
        };
        scene
    }

    /// A volume in a box, or a homogeneous ball.
    fn body(&self, volume: &Volume, settings: &Settings) -> Result<Body, Unsuitable> {
        if let (Bounds::Sphere { centre, radius }, Some(extinction)) =
            (volume.bounds(), volume.single_value())
        {
            let centre = Point(centre.0.map(single));
            return Ok(Body::Ball {
                centre,
                radius: single(radius),
                extinction: single(extinction),
            });
        }
        let Some(bounds) = volume.bounds().enclosing_box() else {
            let cure = "give it `bounds.box = { low, high }`";
            return Err(("its medium fills all of space".into(), cure));
        };
        let own = own_grid(settings);
        let size = own.map_or_else(|| cells(bounds, self.cells.unwrap_or(CELLS[0])), |own| own.0);
        let nearest = own.is_some_and(|own| own.1) && self.target == Target::Mitsuba;
        Ok(Body::Grid(Sampled::of_volume(volume, bounds, size, nearest)))
    }

    fn transmittance(&self, settings: &Settings) -> Result<Scene, Unsuitable> {
        let body = media::Body::read_for(settings, Transmittance::RAY);
        let body = body.ok_or_else(unread)?;
        let medium = body.medium();
        if medium.support().is_empty() {
            return Err(("the ray misses the medium".into(), "take a ray that meets it"));
        }
        let crossing = match &body {
            media::Body::Volume { volume, ray, .. } if own_grid(settings).is_some() => {
                let [low, high] = [ray.origin, ray.at(ray.length)];
                let ends_outside = [low, high].iter().all(|&end| !volume.bounds().contains(end));
                ends_outside.then_some((volume, ray))
            }
            _ => None,
        };
        let light = Light::Everywhere;
        let scene = if let Some((volume, ray)) = crossing {
            let body = self.body(&**volume, settings)?;
            self.scene("transmittance", body, [ray.origin, ray.direction], light)
        } else {
            let grid = Sampled::of_line(&medium, self.cells.unwrap_or(CELLS[1]));
            let eye = Point([0.0, 0.0, -grid.bounds.high.0[2] / 8.0]);
            let ray = [eye, Point([0.0, 0.0, 1.0])];
            self.scene("transmittance", Body::Grid(grid), ray, light)
        };
        Ok(Scene { albedo: 0.0, ..scene })
    }

    fn furnace(&self, settings: &Settings) -> Result<Scene, Unsuitable> {
        let body = media::Body::read_for(settings, Furnace::RAY).ok_or_else(unread)?;
        let furnace = Furnace::read(Some(&body), settings).ok_or_else(unread)?;
        let body = self.body(&*furnace.scene.volume, settings)?;
        let scene =
            self.scene("furnace", body, [furnace.entry, furnace.direction], Light::Everywhere);
        let bounds = scene.bounds();
        let diagonal = (bounds.high - bounds.low).norm();
        let way = scene.direction * (2.0 * diagonal);
        let ray =
            Ray { origin: scene.eye - way, direction: scene.direction, length: f64::INFINITY };
        let entry = ray.at(Bounds::Box(bounds).clip(&ray).from);
        let eye = Point((entry - scene.direction * (0.25 * diagonal)).0.map(single));
        let mut notes = vec!["the ray begins outside the box".to_owned()];
        if furnace.scene.albedo.even() != Some(1.0) {
            notes.push("the medium is white here: absorbing ones would have to emit light".into());
        }
        let phase = lobe(furnace.scene.phase);
        Ok(Scene { eye, is_inside: false, phase, notes, ..scene })
    }

    fn slab(&self, settings: &Settings) -> Result<Scene, Unsuitable> {
        let body = media::Body::read_for(settings, Slab::RAY).ok_or_else(unread)?;
        let slab = Slab::read(Some(&body), settings).ok_or_else(unread)?;
        let Incidence::Collimated(cosine) = slab.incidence.light else {
            let cure = "take one with `incidence.collimated`, such as slab/known-bugs";
            return Err(("its light is diffuse, and a pixel has one direction".into(), cure));
        };
        let grid = Sampled::of_line(slab.medium(), self.cells.unwrap_or(CELLS[1]));
        let direction = Point([(1.0 - cosine * cosine).sqrt(), 0.0, cosine]);
        let eye = direction * (-grid.bounds.high.0[2] / 8.0);
        let scene = self.scene("slab", Body::Grid(grid), [eye, direction], Light::Above);
        let views = [("reflectance", Light::Above), ("transmittance", Light::Below)];
        Ok(Scene {
            albedo: single(slab.albedo),
            phase: lobe(slab.incidence.phase),
            has_mirrors: true,
            views: views.map(|(name, light)| View { name, light }).into(),
            ..scene
        })
    }

    fn single_scattering(&self, settings: &Settings) -> Result<Scene, Unsuitable> {
        let body = media::Body::read_for(settings, SingleScattering::RAY).ok_or_else(unread)?;
        let problem = SingleScattering::read(Some(&body), settings).ok_or_else(unread)?;
        let (lamp, phase) = (Lamp::read(settings), Phase::read(settings));
        let (lamp, phase) = (lamp.ok_or_else(unread)?, phase.ok_or_else(unread)?);
        let media::Body::Volume { ray, .. } = &body else { return Err(unread()) };
        let light = Light::Point {
            position: Point(lamp.position.0.map(single)),
            power: single(lamp.power),
        };
        let body = self.body(problem.volume(), settings)?;
        let scene = self.scene("single-scattering", body, [ray.origin, ray.direction], light);
        let mut notes = Vec::new();
        if Bounds::Box(scene.bounds()).contains(ray.at(ray.length)) {
            notes.push("the ray goes on to where it leaves the box".into());
        }
        let albedo = single(problem.albedo());
        Ok(Scene { albedo, phase: lobe(phase), scatterings: Some(1), notes, ..scene })
    }

    fn sphere(&self, settings: &Settings) -> Result<Scene, Unsuitable> {
        let body = media::Body::read_for(settings, Sphere::RAY).ok_or_else(unread)?;
        let sphere = Sphere::read(Some(&body), settings).ok_or_else(unread)?;
        let media::Body::Volume { ray, .. } = &body else { return Err(unread()) };
        let cure = "take a homogeneous one that asks for the radiance, such as sphere/black-light";
        if sphere.sought == Sought::MeanIntensity {
            return Err((
                "a pixel is a radiance, and the case asks for all directions".into(),
                cure,
            ));
        }
        let ball = self.body(&*sphere.scene.volume, settings)?;
        if matches!(ball, Body::Grid(_)) {
            let why = "a ball whose σ_t varies is none once it is sampled to a grid";
            return Err((why.into(), cure));
        }
        let light = match sphere.light {
            BallLight::BlackSphere(radius) => Light::Core { radius: single(radius) },
            BallLight::Environment | BallLight::Distant(_) => Light::Everywhere,
        };
        let albedo = sphere.scene.albedo.even().unwrap_or_default();
        let scene = self.scene("sphere", ball, [ray.origin, ray.direction], light);
        Ok(Scene { albedo: single(albedo), ..scene })
    }
}

/// Mistakes in case files are found before.
fn unread() -> Unsuitable {
    ("it cannot be read".into(), "run `trueflight plan` on it")
}

/// A phase function whose number is of single precision.
fn lobe(phase: Phase) -> Phase {
    match phase {
        Phase::HenyeyGreenstein(lobe) => {
            HenyeyGreenstein::new(single(lobe.g())).map_or(phase, Phase::HenyeyGreenstein)
        }
        other => other,
    }
}

/// How many cubic cells a box has along each axis, with so many along the longest.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 1 to `most`
fn cells(bounds: Aabb, most: usize) -> [usize; 3] {
    let edges: [f64; 3] = std::array::from_fn(|axis| bounds.high.0[axis] - bounds.low.0[axis]);
    let longest = edges.iter().copied().fold(0.0, f64::max);
    edges.map(|edge| ((edge / longest * most as f64).round() as usize).max(1))
}

/// The size of a grid of samples in the middle of cells, and whether the nearest is taken.
fn own_grid(settings: &Settings) -> Option<([usize; 3], bool)> {
    let grid = settings.table_if("volume")?.table_if("grid")?;
    if grid.word_or("samples", &["centres", "vertices"], "centres")? == "vertices" {
        return None;
    }
    let nearest = grid.word_or("interpolation", &["trilinear", "nearest"], "trilinear")?;
    let size = if let Some(random) = grid.table_if("random") {
        random.counts("size", 1..=4096)?
    } else {
        let path = grid.folder.join(grid.text("file")?);
        if grid_file::is_vdb(&path) {
            return None;
        }
        grid_file::read(&path, None).ok()?.size
    };
    Some((size, nearest == "nearest"))
}
