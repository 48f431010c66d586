//! The settings of a grid: source and positions of its samples.

use std::path::Path;

use super::axes::Axes;
use super::grid_file::{self, GridChoice, MAX_SAMPLES, Samples};
use super::voxels::Placement;
use super::{body, lattice};
use crate::catalogue::{Settings, Value};
use crate::formats::Format;
use numeric::digits::short;
use numeric::geometry::{Aabb, Bounds, Point};

/// The format of the file, if the samples are from one.
pub(super) fn format(settings: &Settings) -> Option<Format> {
    match settings.entry("file").map(|entry| &entry.node.value) {
        Some(Value::Text(name)) => Format::of(Path::new(name)),
        _ => None,
    }
}

pub(super) fn read_samples(settings: &Settings) -> Option<Samples> {
    match (settings.has("file"), settings.has("random")) {
        (true, false) => {
            let name = settings.text("file")?;
            let choice = read_choice(settings);
            let read = grid_file::read(&settings.folder.join(&name), &choice?);
            read.map_err(|e| settings.fault("file", format!("{name}: {}", e.message), e.help)).ok()
        }
        (false, true) => {
            let has_choice = ["grid", "channel", "axes"].into_iter().any(|key| settings.has(key));
            if has_choice {
                read_choice(settings)?;
            }
            read_random(&settings.table("random")?)
        }
        (both, _) => {
            let actual = if both { "both `file` and `random`" } else { "no samples are given" };
            let help = "give `file = \"x.vdb\"` or `random = { size = [nx, ny, nz], seed = n }`";
            settings.fault_at(settings.span.clone(), "", actual, help);
            None
        }
    }
}

/// Part of the file that is read; each setting applies to some formats only.
fn read_choice(settings: &Settings) -> Option<GridChoice> {
    let format = format(settings);
    let is_for = |key: &'static str, takes: fn(Format) -> bool, more: &str| {
        let is_right = !settings.has(key) || format.is_some_and(takes);
        if !is_right {
            let what = format.map_or("samples of this kind", Format::ending);
            let message = format!("`{key}` has no say in {what}");
            let of = Format::list(takes);
            settings.fault(key, message, format!("leave it out: it is for {of}{more}"));
        }
        is_right
    };
    let is_right = [
        is_for("axes", |format| format == Format::Npy, "; other formats say which axis is x"),
        is_for("channel", |format| format == Format::Vol, ""),
        is_for("grid", Format::has_names, ""),
    ];
    if is_right.contains(&false) {
        return None;
    }
    let grid = settings.optional("grid", |key| settings.text(key));
    let channel = settings.optional("channel", |key| settings.count(key, 0..=65_535));
    let axes = settings.word_or("axes", &Axes::NAMES, "zyx");
    let channel = channel.ok()?.and_then(|channel| usize::try_from(channel).ok());
    Some(GridChoice { grid: grid.ok()?, channel, axes: Axes::named(axes?)? })
}

/// Contents of the file as sentences: voxels along each axis and the box.
pub(super) fn contents(settings: &Settings, samples: &Samples, bounds: Aabb) -> Vec<String> {
    let Some(Value::Text(name)) = settings.entry("file").map(|entry| &entry.node.value) else {
        return Vec::new();
    };
    // A layer of background surrounds the voxels of such a file.
    let layer = if format(settings).is_some_and(Format::has_transform) { 2 } else { 0 };
    let [x, y, z] = samples.size.map(|n| n - layer);
    let corner = |point: Point| point.0.map(|x| short(x, 6)).join(", ");
    let (low, high) = (corner(bounds.low), corner(bounds.high));
    let about = if samples.turned.is_some() { "turned, in the box" } else { "box" };
    let mut contents =
        vec![format!("grid {name}: {x} × {y} × {z} voxels (x, y, z), {about} [{low}] to [{high}]")];
    if !samples.remark.is_empty() {
        contents.push(format!("grid {name}: {}", samples.remark));
    }
    contents
}

#[allow(clippy::cast_possible_truncation)] // read within 32 bits
fn read_random(settings: &Settings) -> Option<Samples> {
    let size = settings.counts("size", 1..=4096);
    let seed = settings.count_or("seed", 0..=u64::from(u32::MAX), 0);
    settings.close();
    let (size, seed) = (size?, seed? as u32);
    if size.iter().product::<usize>() as u64 > MAX_SAMPLES {
        let help = format!("a grid has at most {MAX_SAMPLES} samples");
        settings.fault("size", "the grid is too large", help);
        return None;
    }
    Some(random(size, seed))
}

/// Hashed samples in [0, 1).
#[allow(clippy::cast_possible_truncation)] // at most 4096 along each axis
pub(super) fn random(size: [usize; 3], seed: u32) -> Samples {
    let [nx, ny, nz] = size.map(|n| n as u32);
    let hash = |x, y, z| f64::from(lattice::hash3(x, y, z, seed)) / 4_294_967_296.0;
    let rows = (0..nz).flat_map(|z| (0..ny).map(move |y| (y, z)));
    let values = rows.flat_map(|(y, z)| (0..nx).map(move |x| hash(x, y, z))).collect();
    Samples { size, values, ..Samples::default() }
}

/// The placement in a file that has a transform of its own.
pub(super) fn no_placement(settings: &Settings, format: Format) -> Option<Placement> {
    let given = ["bounds", "samples", "border"].into_iter().filter(|key| settings.has(key));
    let faults = given.map(|key| {
        let ending = format.ending();
        let message =
            format!("a {ending} file says itself where its voxels stand, and `{key}` has no say");
        settings.fault(key, message, "leave it out, or move the grid by its transform");
    });
    (faults.count() == 0).then_some(Placement::Vertices)
}

pub(super) fn read_placement(settings: &Settings, format: Option<Format>) -> Option<Placement> {
    if settings.one_of("samples", &[("centres", false), ("vertices", true)])? {
        return Some(Placement::Vertices);
    }
    let mut borders = [("clamp", Placement::CentresClamped), ("zero", Placement::CentresZero)];
    if format == Some(Format::Pbrt) {
        borders.reverse();
    }
    settings.one_of("border", &borders)
}

pub(super) fn read_bounds(settings: &Settings) -> Option<Aabb> {
    let Bounds::Box(bounds) = body::read_bounds(settings)? else {
        settings.fault("bounds", "a grid has no sphere", "it takes `box = { low, high }`");
        return None;
    };
    Some(bounds)
}

/// The box in the file, if it is one.
pub(super) fn own_bounds(settings: &Settings, samples: &Samples) -> Option<Aabb> {
    let proper = |bounds: &Aabb| {
        (0..3).all(|j| {
            let edge = bounds.high.0[j] - bounds.low.0[j];
            edge > 0.0 && edge.is_finite()
        })
    };
    let own = samples.bounds.filter(proper);
    if own.is_none() {
        let (key, actual) = match samples.bounds {
            Some(_) => ("file", "the corners in the file do not make a box"),
            None => ("bounds", "the grid has no box"),
        };
        settings.fault(key, actual, "give `bounds.box = { low = [x, y, z], high = [x, y, z] }`");
    }
    own
}
