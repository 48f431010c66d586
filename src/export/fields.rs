//! Fields of a case as a renderer reads them: homogeneous, or samples in a box, channel by channel.
//!
//! Samples are of single precision, in the middle of cells:
//!
//! ```text
//! sample (i, j, k) = σ_t at low + ((i, j, k) + ½) · (high − low)/n,   rounded to single precision
//! ```
//!
//! Files are `.vol` files, see `trueflight explain grid`. The truth is that of the page `grid`, read from the same
//! file.

use std::sync::Arc;

use fearless_simd::Level;

use super::scene::{ExportedField, ExportedScene};
use super::{ExportOptions, Target, single};
use media::phase::Phase;
use media::phase::henyey_greenstein::HenyeyGreenstein;
use media::{Body, Medium, Volume};
use numeric::geometry::{Aabb, Bounds, Point};

/// Number of cells along the longest side of a field in space, and along a line.
const CELLS: [usize; 2] = [32, 256];

/// Maximum number of channels of a picture: red, green and blue.
const MAX_CHANNELS: usize = 3;

/// Obstacle to an export, and a kind of case without it.
pub(super) type Unsuitable = (String, &'static str);

/// Size of a case's own grids, and whether lookups take the nearest sample.
pub(super) type OwnGrid = ([usize; 3], bool);

/// Options of one export.
pub(super) struct ExportReader<'a> {
    /// The name of the case.
    pub name: String,
    /// The renderer.
    pub target: Target,
    /// Form of the scene.
    pub wishes: &'a ExportOptions,
}

/// Place of a medium, and σ_t of each channel, all of them homogeneous or all of them sampled.
pub(super) struct MediumFields {
    /// Box or ball.
    pub shape: Bounds,
    /// Field of each channel.
    pub fields: Vec<ExportedField>,
}

impl MediumFields {
    /// Returns the length along z.
    pub fn length(&self) -> f64 {
        self.shape.enclosing_box().map_or(0.0, |bounds| bounds.high.0[2])
    }
}

impl ExportReader<'_> {
    /// Returns the exported ones among all channels of a case.
    pub fn chosen<T>(&self, all: Vec<T>) -> Result<Vec<T>, Unsuitable> {
        const CURE: &str = "choose up to three of them, as in `--channels 1,2,3`, and export the others to another folder";
        let count = all.len();
        let Some(numbers) = &self.wishes.channels else {
            if count > MAX_CHANNELS {
                return Err((format!("it has {count} channels, and a picture has 3"), CURE));
            }
            return Ok(all);
        };
        if let Some(number) = numbers.iter().find(|number| !(1..=count).contains(*number)) {
            let channels = if count == 1 { "channel" } else { "channels" };
            return Err((format!("it has {count} {channels}, and none is number {number}"), CURE));
        }
        if numbers.is_empty() || numbers.len() > MAX_CHANNELS {
            return Err((format!("a picture has 3 channels, not {}", numbers.len()), CURE));
        }
        if (1..numbers.len()).any(|place| numbers[..place].contains(&numbers[place])) {
            return Err(("a channel is chosen twice".into(), CURE));
        }
        let mut all: Vec<Option<T>> = all.into_iter().map(Some).collect();
        Ok(numbers.iter().filter_map(|number| all[number - 1].take()).collect())
    }

    /// Returns notes on a scene's channels and its medium.
    pub fn remarks(&self, scene: &ExportedScene) -> Vec<String> {
        let mut remarks = Vec::new();
        if let Some(numbers) = &self.wishes.channels {
            let list: Vec<String> = numbers.iter().map(usize::to_string).collect();
            remarks.push(format!("of the channels of the case: {}", list.join(", ")));
        }
        if scene.channels.len() == 2 && self.target == Target::Mitsuba {
            remarks.push("blue is as green: the case has two channels".into());
        }
        if scene.is_coloured() && self.target == Target::Pbrt {
            remarks.push("each channel is a scene of its own: pbrt has wavelengths".into());
        }
        if self.wishes.cells.is_some() && scene.grids().is_empty() {
            remarks.push("the medium is homogeneous: there is nothing to cut into --cells".into());
        }
        if self.wishes.heterogeneous && !scene.is_heterogeneous {
            remarks.push("the medium is heterogeneous as it is".into());
        }
        remarks
    }

    /// Returns volumes in a box, or a homogeneous box or ball; with the size of their own grid, if they have one.
    pub fn in_space(
        &self,
        volumes: &[Arc<Volume>],
        own: Option<OwnGrid>,
    ) -> Result<MediumFields, Unsuitable> {
        let bounds = volumes[0].bounds();
        let Some(around) = bounds.enclosing_box() else {
            let cure = "give it `bounds.box = { low, high }`";
            return Err(("its medium fills all of space".into(), cure));
        };
        let values: Option<Vec<f64>> =
            volumes.iter().map(|volume| volume.facts().single_value).collect();
        if let Some(values) = values {
            let fields =
                values.into_iter().map(|value| ExportedField::Even(single(value))).collect();
            let shape = match bounds {
                Bounds::Sphere { centre, radius } => {
                    Bounds::Sphere { centre: Point(centre.0.map(single)), radius: single(radius) }
                }
                Bounds::Box(_) | Bounds::Everywhere => Bounds::Box(rounded(around)),
            };
            return Ok(MediumFields { shape, fields });
        }
        let maximum = self.wishes.cells.unwrap_or(CELLS[0]);
        let size = own.map_or_else(|| cells(around, maximum), |own| own.0);
        let nearest = own.is_some_and(|own| own.1) && self.target == Target::Mitsuba;
        let sample =
            |volume: &Arc<Volume>| Sampled::of_volume(&**volume, rounded(around), size, nearest);
        let fields = volumes.iter().map(|volume| ExportedField::Grid(sample(volume))).collect();
        Ok(MediumFields { shape: Bounds::Box(rounded(around)), fields })
    }

    /// Returns media along one line, as layers along z that begin at 0, in a box that is twice as wide as long.
    pub fn along(&self, media: &[Medium]) -> MediumFields {
        let length = single(media[0].support().length());
        let shape =
            Bounds::Box(Aabb { low: Point([-length, -length, 0.0]), high: Point([length; 3]) });
        let value = |medium: &Medium| medium.lookups(Level::new()).single_value();
        let values: Option<Vec<f64>> = media.iter().map(value).collect();
        let fields = if let Some(values) = values {
            values.into_iter().map(|value| ExportedField::Even(single(value))).collect()
        } else {
            let cells = self.wishes.cells.unwrap_or(CELLS[1]);
            media
                .iter()
                .map(|medium| ExportedField::Grid(Sampled::of_line(medium, cells)))
                .collect()
        };
        MediumFields { shape, fields }
    }

    /// Returns the size of the grids of samples, at the centres of cells, that all exported channels have, and whether
    /// lookups take the nearest sample. `None` if a channel has another grid, or none.
    pub fn own_grids(&self, body: &Body) -> Result<Option<OwnGrid>, Unsuitable> {
        let grid = |body: &Body| match body {
            Body::Volume { volume, .. } => volume.facts().cells,
            Body::Line { .. } | Body::Spectral { .. } => None,
        };
        let grids = self.chosen(body.channels().iter().map(grid).collect())?;
        let first = grids.first().copied().flatten();
        Ok(first.filter(|_| grids.iter().all(|grid| *grid == first)))
    }
}

/// Returns the error of a case that cannot be read; mistakes in case files are reported earlier.
pub(super) fn unread() -> Unsuitable {
    ("it cannot be read".into(), "run `trueflight plan` on it")
}

/// Rounds the parameter of a phase function to single precision.
pub(super) fn lobe(phase: Phase) -> Phase {
    match phase {
        Phase::HenyeyGreenstein(lobe) => {
            HenyeyGreenstein::new(single(lobe.g())).map_or(phase, Phase::HenyeyGreenstein)
        }
        other => other,
    }
}

/// Returns the phase function of all channels.
pub(super) fn one_phase(phases: &[Phase]) -> Result<Phase, Unsuitable> {
    if phases.windows(2).any(|pair| pair[0] != pair[1]) {
        let why = "its channels have different phase functions, and that of a renderer is grey";
        return Err((
            why.into(),
            "export channels that have the same, as in `--channels 1`, each to a folder of its own",
        ));
    }
    Ok(lobe(phases[0]))
}

/// Rounds the corners of a box to single precision.
fn rounded(Aabb { low, high }: Aabb) -> Aabb {
    Aabb { low: Point(low.0.map(single)), high: Point(high.0.map(single)) }
}

/// Returns the numbers of cubic cells of a box along each axis, `maximum` of them along the longest.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // from 1 to `maximum`
fn cells(bounds: Aabb, maximum: usize) -> [usize; 3] {
    let edges: [f64; 3] = std::array::from_fn(|axis| bounds.high.0[axis] - bounds.low.0[axis]);
    let longest = edges.iter().copied().fold(0.0, f64::max);
    edges.map(|edge| ((edge / longest * maximum as f64).round() as usize).max(1))
}

/// Name of the file.
pub const FILE: &str = "density.vol";

/// Returns the name of the file of one channel of several, counted from 0.
pub fn file_of(channel: usize) -> String {
    format!("density-{}.vol", channel + 1)
}

/// Samples in a box.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled {
    /// Numbers of samples along x, y and z.
    pub size: [usize; 3],
    /// `values[(z·ny + y)·nx + x]`, 1/length.
    pub values: Vec<f32>,
    /// Box, with corners in single precision.
    pub bounds: Aabb,
    /// True if a lookup takes the nearest sample; otherwise it is trilinear.
    pub nearest: bool,
}

impl Sampled {
    /// Samples a field in space.
    pub fn of_volume(volume: &Volume, bounds: Aabb, size: [usize; 3], nearest: bool) -> Self {
        let bounds = rounded(bounds);
        let place = |axis: usize, index: usize| {
            let edge = bounds.high.0[axis] - bounds.low.0[axis];
            bounds.low.0[axis] + (index as f64 + 0.5) * edge / size[axis] as f64
        };
        let mut values = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let at = Point([place(0, x), place(1, y), place(2, z)]);
                    values.push(sample(volume.extinction_at(at)));
                }
            }
        }
        Self { size, values, bounds, nearest }
    }

    /// Samples a field along a line, as layers along z that begin at 0, in a box that is twice as wide as long.
    ///
    /// There are two samples in x and y: where samples beyond the box are zero, a single one would not be constant over
    /// the whole width.
    pub fn of_line(medium: &Medium, cells: usize) -> Self {
        let support = medium.support();
        let length = single(support.length());
        let step = support.length() / cells as f64;
        let layer = |z: usize| sample(medium.extinction(support.from + (z as f64 + 0.5) * step));
        let values = (0..cells).flat_map(|z| [layer(z); 4]).collect();
        let bounds = Aabb { low: Point([-length, -length, 0.0]), high: Point([length; 3]) };
        Self { size: [2, 2, cells], values, bounds, nearest: false }
    }

    /// Returns the largest sample, which is the majorant of renderers.
    pub fn peak(&self) -> f64 {
        self.values.iter().fold(0.0, |peak, &value| peak.max(f64::from(value)))
    }

    /// Returns whether every sample can be an extinction.
    pub fn is_extinction(&self) -> bool {
        self.values.iter().all(|value| value.is_finite() && *value >= 0.0)
    }
}

/// Returns the bytes of a `.vol` file of one channel, or of three: with two, the second is repeated as the third.
pub fn vol(channels: &[&Sampled]) -> Vec<u8> {
    let Some(first) = channels.first() else { return Vec::new() };
    let count = if channels.len() > 1 { 3 } else { 1 };
    let mut bytes = b"VOL\x03".to_vec();
    let size = first.size.map(|n| i32::try_from(n).unwrap_or(i32::MAX));
    for integer in [1, size[0], size[1], size[2], count] {
        bytes.extend(integer.to_le_bytes());
    }
    let Aabb { low, high } = first.bounds;
    for corner in [low, high] {
        corner.0.iter().for_each(|&x| bytes.extend(sample(x).to_le_bytes()));
    }
    let of_channel = |channel: i32| {
        usize::try_from(channel).ok().and_then(|n| channels.get(n)).or(channels.last())
    };
    let channels: Vec<&Sampled> = (0..count).filter_map(of_channel).copied().collect();
    for index in 0..first.values.len() {
        for grid in &channels {
            bytes.extend(grid.values[index].to_le_bytes());
        }
    }
    bytes
}

#[allow(clippy::cast_possible_truncation)] // samples are of single precision
fn sample(x: f64) -> f32 {
    x as f32
}
