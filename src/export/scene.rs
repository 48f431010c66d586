//! What is rendered, in nobody's language.

use super::Target;
use super::sampled::Sampled;
use crate::geometry::{Aabb, Point};
use crate::phase::Phase;

/// A medium, lights and one ray, all of whose numbers are of single precision.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The name of the case.
    pub case: String,
    /// The name of its problem.
    pub problem: &'static str,
    /// Who renders it.
    pub target: Target,
    /// The medium.
    pub body: Body,
    /// a, everywhere the same.
    pub albedo: f64,
    /// How light is scattered.
    pub phase: Phase,
    /// Where the camera's only ray begins.
    pub eye: Point,
    /// Where it goes: a unit vector, but for the rounding of its coordinates.
    pub direction: Point,
    /// Whether the ray begins within the medium.
    pub is_inside: bool,
    /// Whether mirrors stand at half of the box's width, along z: what is between them is an infinite slab.
    pub has_mirrors: bool,
    /// The largest number of scatterings; `None` for any.
    pub scatterings: Option<u32>,
    /// One picture each.
    pub views: Vec<View>,
    /// What of the case is not in the scene, in sentences.
    pub notes: Vec<String>,
}

/// A medium.
#[derive(Debug, Clone)]
pub enum Body {
    /// Samples in a box.
    Grid(Sampled),
    /// A homogeneous ball.
    Ball {
        /// Its centre.
        centre: Point,
        /// Its radius.
        radius: f64,
        /// σ_t, 1/length.
        extinction: f64,
    },
}

/// A picture of the scene.
#[derive(Debug, Clone)]
pub struct View {
    /// What is sought, which names the file, too.
    pub name: &'static str,
    /// Where light of radiance 1 comes from.
    pub light: Light,
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// From all sides, radiance 1.
    Everywhere,
    /// From a plane above a slab, z < 0, radiance 1.
    Above,
    /// From a plane below it, radiance 1.
    Below,
    /// From a point, all of its power evenly to all sides.
    Point {
        /// Where it is.
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

impl Scene {
    /// The samples, where there are some.
    pub fn grid(&self) -> Option<&Sampled> {
        match &self.body {
            Body::Grid(grid) => Some(grid),
            Body::Ball { .. } => None,
        }
    }

    /// The largest extinction, 1/length.
    pub fn peak(&self) -> f64 {
        match &self.body {
            Body::Grid(grid) => grid.peak(),
            Body::Ball { extinction, .. } => *extinction,
        }
    }

    /// The smallest box about the medium.
    pub fn bounds(&self) -> Aabb {
        match &self.body {
            Body::Grid(grid) => grid.bounds,
            Body::Ball { centre, radius, .. } => {
                let half = Point([*radius; 3]);
                Aabb { low: *centre - half, high: *centre + half }
            }
        }
    }

    /// The axes of a picture whose rays go along the direction: right, up, onward.
    pub fn axes(&self) -> [Point; 3] {
        let onward = self.direction;
        let [x, y, _] = onward.0.map(f64::abs);
        let aside = if x <= y { Point([1.0, 0.0, 0.0]) } else { Point([0.0, 1.0, 0.0]) };
        let right = aside.cross(onward).normalised().unwrap_or(aside);
        [right, onward.cross(right), onward]
    }

    /// Half the width of a picture: so small that all of its rays are one.
    pub fn aperture(&self) -> f64 {
        let Aabb { low, high } = self.bounds();
        1e-7 * (high - low).norm()
    }
}
