//! Scene of a renderer, before it is written in the renderer's format.

use super::Target;
use super::fields::Sampled;
use media::phase::Phase;
use numeric::geometry::{Aabb, Bounds, Point};

/// Medium, lights and one ray; all numbers are of single precision.
#[derive(Debug, Clone)]
pub struct ExportedScene {
    /// The name of the case.
    pub case: String,
    /// Name of its problem, of one channel.
    pub problem: &'static str,
    /// The renderer.
    pub target: Target,
    /// Box or ball that the medium fills.
    pub shape: Bounds,
    /// Medium of each channel, 1 to 3; one if all channels are equal.
    pub channels: Vec<ChannelMedium>,
    /// True if a homogeneous medium is written as a heterogeneous one.
    pub is_heterogeneous: bool,
    /// The phase function.
    pub phase: Phase,
    /// Origin of the camera's only ray.
    pub eye: Point,
    /// Direction of the ray: a unit vector, but for the rounding of its coordinates.
    pub direction: Point,
    /// True if the ray begins within the medium.
    pub is_inside: bool,
    /// True if mirrors stand at half of the box's width, along z: they turn the medium between them into an infinite
    /// slab.
    pub has_mirrors: bool,
    /// Largest number of scatterings; `None` for no limit.
    pub scatterings: Option<u32>,
    /// Pictures of the scene.
    pub views: Vec<ExportedView>,
    /// Sentences about parts of the case that are not in the scene.
    pub notes: Vec<String>,
}

/// The medium of a channel.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelMedium {
    /// σ_t, 1/length.
    pub field: ExportedField,
    /// a, everywhere the same.
    pub albedo: f64,
}

/// σ_t, 1/length, of all channels in the same form.
#[derive(Debug, Clone, PartialEq)]
pub enum ExportedField {
    /// Homogeneous.
    Even(f64),
    /// Samples in a box.
    Grid(Sampled),
}

impl ExportedField {
    /// Returns the largest extinction, 1/length.
    pub fn peak(&self) -> f64 {
        match self {
            Self::Even(extinction) => *extinction,
            Self::Grid(grid) => grid.peak(),
        }
    }

    /// Returns the samples; `None` if the medium is homogeneous.
    pub fn grid(&self) -> Option<&Sampled> {
        match self {
            Self::Even(_) => None,
            Self::Grid(grid) => Some(grid),
        }
    }

    /// Returns whether every value can be an extinction in single precision.
    pub fn is_extinction(&self) -> bool {
        match self {
            Self::Even(extinction) => extinction.is_finite() && *extinction >= 0.0,
            Self::Grid(grid) => grid.is_extinction(),
        }
    }
}

/// A picture of the scene.
#[derive(Debug, Clone)]
pub struct ExportedView {
    /// Name of the quantity, and of the file.
    pub name: &'static str,
    /// Source of light of radiance 1.
    pub light: ExportedLight,
}

/// Source of light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ExportedLight {
    /// From all sides, radiance 1.
    Everywhere,
    /// From a plane above a slab, z < 0, radiance 1.
    Above,
    /// From a plane below it, radiance 1.
    Below,
    /// Point that emits its power evenly to all sides.
    Point {
        /// Position.
        position: Point,
        /// Φ.
        power: f64,
    },
    /// From a black sphere at the centre of a ball, radiance 1.
    Core {
        /// Its radius.
        radius: f64,
    },
}

impl ExportedScene {
    /// Returns the samples of the channels, one if all have the same; none if the medium is homogeneous.
    pub fn grids(&self) -> Vec<&Sampled> {
        let fields = self.channels.iter().map(|channel| &channel.field);
        let mut grids: Vec<&Sampled> = fields.filter_map(ExportedField::grid).collect();
        if grids.windows(2).all(|pair| pair[0] == pair[1]) {
            grids.truncate(1);
        }
        grids
    }

    /// Returns whether the scene's medium is written as a homogeneous one.
    pub fn is_homogeneous(&self) -> bool {
        self.grids().is_empty() && !self.is_heterogeneous
    }

    /// Returns the largest extinction of all channels, 1/length.
    pub fn peak(&self) -> f64 {
        self.channels.iter().map(|channel| channel.field.peak()).fold(0.0, f64::max)
    }

    /// Returns the channels' albedos.
    pub fn albedos(&self) -> Vec<f64> {
        self.channels.iter().map(|channel| channel.albedo).collect()
    }

    /// Returns the scene of one channel alone.
    #[must_use]
    pub fn of_channel(&self, index: usize) -> Self {
        Self { channels: vec![self.channels[index].clone()], ..self.clone() }
    }

    /// Returns whether channels differ, so that each has an answer of its own.
    pub fn is_coloured(&self) -> bool {
        self.channels.len() > 1
    }

    /// Returns the smallest box around the medium.
    pub fn bounds(&self) -> Aabb {
        self.shape.enclosing_box().unwrap_or(Aabb { low: self.eye, high: self.eye })
    }

    /// Returns the axes of a picture with rays along the direction: right, up, forward.
    pub fn axes(&self) -> [Point; 3] {
        let onward = self.direction;
        let [x, y, _] = onward.0.map(f64::abs);
        let aside = if x <= y { Point([1.0, 0.0, 0.0]) } else { Point([0.0, 1.0, 0.0]) };
        let right = aside.cross(onward).normalised().unwrap_or(aside);
        [right, onward.cross(right), onward]
    }

    /// Returns half the width of a picture, so small that all of its rays are equal.
    pub fn aperture(&self) -> f64 {
        let Aabb { low, high } = self.bounds();
        1e-7 * (high - low).norm()
    }
}
