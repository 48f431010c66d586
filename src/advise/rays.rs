//! Rays through a volume: those of a case, random ones, or those of a camera, see [`super`].

use std::f64::consts::TAU;

use crate::case::{Case, CaseError, Spec};
use crate::render::view::{Camera, furthest};
use media::catalogue::{Domain, Entry, Node, Settings, Value};
use media::{Body, Volume};
use numeric::geometry::{Aabb, Point, Ray};
use numeric::rng::{Address, Stream, name_hash};
use theory::problems;

/// Largest number of rays.
pub const MAX_RAYS: u64 = 4096;
/// Pixels of a camera in each direction, of which rays are chosen.
const PIXELS: [usize; 2] = [512, 512];
/// Number of lines that are tried for each ray.
const TRIES: u64 = 1000;

/// Reads a case and its rays; `count` random rays take the place of the case's own.
///
/// # Errors
///
/// Mistakes in the case.
pub fn read(spec: &Spec, count: Option<u64>, seed: u64) -> Result<(Case, Vec<Body>), CaseError> {
    let settings = spec.problem().map_or(&[][..], |(_, settings)| settings);
    if count.is_none() && !settings.iter().any(|entry| entry.key == "rays") {
        let case = Case::of(spec)?;
        let rays = vec![case.scenario.body().clone()];
        return Ok((case, rays));
    }
    let base = spec.with_problem(|settings| {
        settings.retain(|entry| entry.key != "rays");
        if !settings.iter().any(|entry| entry.key == "ray" || entry.key == "span") {
            // It stands for the others until these are known.
            let vector = |key: &str, of: f64| Entry::new(key, Value::numbers([of; 3]));
            let length = Entry::new("length", Value::Number(1.0));
            let any = vec![vector("origin", 0.0), vector("direction", 1.0), length];
            settings.push(Entry::new("ray", Value::Table(any)));
        }
    });
    let case = Case::of(&base)?;
    let body = case.scenario.body();
    let rays = spec.read(|root| {
        let names = problems::names();
        let (_, problem) = root.chosen("problem", &names)?;
        let Body::Volume { volume, .. } = &body.channels()[0] else {
            problem.fault(
                "rays",
                "rays cross volumes, and this is a field on a line",
                "leave them out",
            );
            return None;
        };
        let rays = problem.entry("rays").filter(|_| count.is_none());
        let about = enclosing(&problem, &**volume)?;
        let is_table = |node: &Node| matches!(node.value, Value::Table(_));
        let rays = match rays.map(|rays| &rays.node.value) {
            Some(Value::Array(list)) if !list.is_empty() && list.iter().all(is_table) => {
                listed(&problem, &**volume, &about)?
            }
            None | Some(Value::Table(_)) => random(&problem, &**volume, &about, (count, seed))?,
            Some(_) => {
                let help = "give `{ random = 64 }`, or a list of `{ origin, direction }`";
                problem.fault("rays", "`rays` has no rays", help);
                return None;
            }
        };
        Some(rays.into_iter().map(|ray| along(body, ray)).collect())
    })?;
    Ok((case, rays))
}

/// Returns the field of a body along another ray.
fn along(body: &Body, ray: Ray) -> Body {
    match body {
        Body::Line { .. } => body.clone(),
        Body::Volume { name, volume, .. } => {
            Body::Volume { name: name.clone(), volume: volume.clone(), ray }
        }
        Body::Spectral { name, channels } => {
            let channels = channels.iter().map(|channel| along(channel, ray)).collect();
            Body::Spectral { name: name.clone(), channels }
        }
    }
}

/// Returns the box around a volume; a volume that fills all of space is a mistake.
fn enclosing(problem: &Settings, volume: &Volume) -> Option<Aabb> {
    let about = volume.bounds().enclosing_box();
    if about.is_none() {
        let help = "give the volume `bounds`, or one `ray` with its length";
        problem.fault("volume", "rays through a volume that fills all of space do not end", help);
    }
    about
}

/// Reads a list of rays.
fn listed(problem: &Settings, volume: &Volume, about: &Aabb) -> Option<Vec<Ray>> {
    let read = |ray: &Settings| {
        let (origin, direction) = (ray.triple("origin"), ray.triple("direction"));
        let whole = furthest(about, Point(origin.unwrap_or_default()));
        let length = ray.number_or("length", Domain::Positive, whole);
        ray.close();
        let result = Ray::new(Point(origin?), Point(direction?), length?);
        let result = result.filter(|ray| !volume.bounds().clip(ray).is_empty());
        if result.is_none() {
            let help = "give a direction into the volume, and a length that reaches it";
            ray.fault_at(ray.span.clone(), "", "this ray misses the volume", help);
        }
        result
    };
    let rays: Vec<Option<Ray>> = problem.tables("rays")?.iter().map(read).collect();
    rays.into_iter().collect()
}

/// Returns random rays that hit the volume: a given number of lines, or by number and `camera` of the case.
fn random(
    problem: &Settings,
    volume: &Volume,
    about: &Aabb,
    (count, seed): (Option<u64>, u64),
) -> Option<Vec<Ray>> {
    let (count, camera) = if let Some(count) = count {
        (count, None)
    } else {
        let rays = problem.table("rays")?;
        let count = rays.count("random", 1..=MAX_RAYS);
        let camera = rays.optional("camera", |_| Camera::read(&rays, Some(PIXELS)));
        rays.close();
        (count?, camera.ok()?)
    };
    let address = Address { seed, experiment: name_hash("rays of advice"), block: 0, lane: 0 };
    let tries = (0..count * TRIES).map(|block| {
        let mut stream = Address { block, ..address }.stream();
        match &camera {
            Some(camera) => pixel(camera, about, &mut stream),
            None => line(about, &mut stream),
        }
    });
    let hits = tries.flatten().filter(|ray| !volume.bounds().clip(ray).is_empty());
    let rays: Vec<Ray> = hits.take(usize::try_from(count).unwrap_or(usize::MAX)).collect();
    if rays.len() as u64 == count {
        return Some(rays);
    }
    problem.fault("rays", "too few of the rays hit the volume", "aim the camera at the volume");
    None
}

/// Returns the ray of a random pixel.
fn pixel(camera: &Camera, about: &Aabb, stream: &mut Stream) -> Option<Ray> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below the size
    let [column, row] = PIXELS.map(|n| (stream.uniform() * n as f64) as usize);
    let length = furthest(about, camera.position());
    Ray::new(camera.position(), camera.direction(column, row)?, length)
}

/// Returns a random line through the sphere around a box, uniform and isotropic.
fn line(&Aabb { low, high }: &Aabb, stream: &mut Stream) -> Option<Ray> {
    let (centre, radius) = ((low + high) * 0.5, 0.5 * (high - low).norm());
    let (z, turn) = (2.0 * stream.uniform() - 1.0, TAU * stream.uniform());
    let across = (1.0 - z * z).sqrt();
    let direction = Point([across * turn.cos(), across * turn.sin(), z]);
    // Two unit vectors across the direction.
    let u = Point([-turn.sin(), turn.cos(), 0.0]);
    let v = Point([z * turn.cos(), z * turn.sin(), -across]);
    let (distance, angle) = (radius * stream.uniform().sqrt(), TAU * stream.uniform());
    let foot = centre + u * (distance * angle.cos()) + v * (distance * angle.sin());
    Ray::new(foot - direction * radius, direction, 2.0 * radius)
}
