//! Fields of trials: along a line with their exact optical depth, and in space.

use std::sync::Arc;

use super::prelude::*;
use super::tails::normal_between;
use media::body::Body;
use media::constant::Constant;
use media::eq21::Eq21;
use media::exponential::Exponential;
use media::gaussian::{Blob, Gaussian};
use media::grid::Grid;
use media::noise::Noise;
use media::radial::Radial;
use media::sines::{Wave, Waves};
use media::voxels::{Interpolation, Placement};
use media::{Layered, Profile, Volume};
use numeric::geometry::{Aabb, Bounds, Point, Ray};

/// A field on a stretch of a line.
#[derive(Debug, Clone)]
pub(super) struct FieldLine {
    pub field: LineField,
    pub from: f64,
    pub to: f64,
}

/// A field along a line.
#[derive(Debug, Clone)]
pub(super) enum LineField {
    Constant {
        extinction: f64,
    },
    Steps {
        breaks: Vec<f64>,
        values: Vec<f64>,
    },
    Lines {
        knots: Vec<f64>,
        values: Vec<f64>,
    },
    Exponential {
        extinction: f64,
        rate: f64,
    },
    Gaussian {
        peak: f64,
        centre: f64,
        width: f64,
    },
    /// Amplitudes, frequencies and phases.
    Sines {
        base: f64,
        waves: Vec<[f64; 3]>,
    },
}

impl FieldLine {
    pub fn medium(&self) -> Medium {
        let profile: Arc<Profile> = match &self.field {
            &LineField::Constant { extinction } => Arc::new(Constant { extinction }),
            LineField::Steps { breaks, values } => Arc::new(Piecewise::steps(breaks, values)),
            LineField::Lines { knots, values } => Arc::new(Piecewise::lines(knots, values)),
            &LineField::Exponential { extinction, rate } => {
                Arc::new(Exponential::new(extinction, rate))
            }
            &LineField::Gaussian { peak, centre, width } => {
                Arc::new(Gaussian::new(peak, centre, width))
            }
            LineField::Sines { base, waves } => {
                let wave = |&[amplitude, frequency, phase]: &[f64; 3]| Wave {
                    amplitude,
                    frequency,
                    phase,
                };
                Arc::new(Waves::new(*base, waves.iter().map(wave).collect()))
            }
        };
        let span = Span::new(self.from, self.to);
        Medium::new(profile, span, span)
    }

    /// Optical depth in 32 digits.
    pub fn depth(&self) -> DoubleDouble {
        let [from, to] = [self.from, self.to].map(DoubleDouble::from);
        let length = to - from;
        let widths = |knots: &[f64]| -> Vec<DoubleDouble> {
            knots.windows(2).map(|pair| DoubleDouble::from(pair[1]) - pair[0]).collect()
        };
        match &self.field {
            &LineField::Constant { extinction } => length * extinction,
            LineField::Steps { breaks, values } => {
                widths(breaks).into_iter().zip(values).map(|(width, &value)| width * value).sum()
            }
            LineField::Lines { knots, values } => {
                let mean = |pair: &[f64]| (DoubleDouble::from(pair[0]) + pair[1]).scaled(-1);
                widths(knots).into_iter().zip(values.windows(2)).map(|(w, p)| w * mean(p)).sum()
            }
            &LineField::Exponential { extinction, rate } => {
                let slope = DoubleDouble::from(rate);
                -(-(slope * length)).exp_m1() / slope * ((-(slope * from)).exp() * extinction)
            }
            &LineField::Gaussian { peak, centre, width } => {
                let [a, b] = [from, to].map(|s| (s - centre) / width);
                normal_between(a, b) * DoubleDouble::PI.scaled(1).sqrt() * width * peak
            }
            LineField::Sines { base, waves } => {
                let wave = |&[amplitude, frequency, phase]: &[f64; 3]| {
                    let [a, b] = [self.from, self.to].map(|s| {
                        let [_, cosine] = (DoubleDouble::product(frequency, s) + phase).sin_cos();
                        cosine
                    });
                    (a - b) * amplitude / frequency
                };
                length * *base + waves.iter().map(wave).sum::<DoubleDouble>()
            }
        }
    }
}

/// A homogeneous medium from 0 on.
pub(super) fn homogeneous(extinction: f64, length: f64) -> Medium {
    FieldLine { field: LineField::Constant { extinction }, from: 0.0, to: length }.medium()
}

/// Layers, or straight lines between knots if there is a value more.
pub(super) fn pieces(knots: &[f64], values: &[f64]) -> Medium {
    let [from, to] = [knots[0], knots[knots.len() - 1]];
    let (knots, values) = (knots.to_vec(), values.to_vec());
    let is_steps = values.len() < knots.len();
    let steps = |breaks| LineField::Steps { breaks, values: values.clone() };
    let field = if is_steps { steps(knots) } else { LineField::Lines { knots, values } };
    FieldLine { field, from, to }.medium()
}

/// A field in space that rays cross.
#[derive(Debug, Clone, Copy)]
pub(super) enum Space {
    Constant(f64),
    Eq21,
    /// Largest extinction, frequency, octaves and radius of its ball.
    Noise(f64, f64, u32, Option<f64>),
    /// Samples along the axes, and how they are interpolated.
    Grid([usize; 3], Interpolation),
    /// Peak, width and radius of its ball.
    Gaussian(f64, f64, f64),
    /// Rate and radius of its ball.
    Exponential(f64, f64),
    Radial,
}

impl Space {
    pub fn volume(self) -> Arc<Volume> {
        let middle = Point([0.0, 0.0, 10.0]);
        let ball = |radius| Bounds::Sphere { centre: middle, radius };
        match self {
            Self::Constant(extinction) => {
                Arc::new(Constant::within(extinction, Bounds::Everywhere))
            }
            Self::Eq21 => Arc::new(Eq21),
            Self::Noise(extinction, frequency, octaves, radius) => {
                let bounds = radius.map_or(Bounds::Everywhere, ball);
                Arc::new(Noise::of_octaves(extinction, (frequency, octaves), 0, bounds))
            }
            Self::Grid(size, interpolation) => {
                let bounds = Aabb { low: Point([-8.0, -8.0, 0.0]), high: Point([8.0, 8.0, 20.0]) };
                let placement = Placement::CentresClamped;
                Arc::new(Grid::random(size, 0, bounds, interpolation, placement))
            }
            Self::Gaussian(peak, width, radius) => {
                let gaussian = Gaussian::new(peak, Point([1.0, 0.0, 9.0]), width);
                Arc::new(Blob { gaussian, bounds: ball(radius) })
            }
            Self::Exponential(rate, radius) => {
                let field = Exponential::new(1.0, rate);
                Arc::new(Layered::new(field, Point([0.0, 0.0, 1.0]), ball(radius)))
            }
            Self::Radial => Arc::new(Radial::new(middle, 8.0, [0.6, -0.6, 0.0, 0.0])),
        }
    }
}

/// The field of a volume along a ray.
pub(super) fn crossed(volume: Arc<Volume>, ray: Ray) -> Medium {
    Body::Volume { name: String::new(), volume, ray }.medium()
}
