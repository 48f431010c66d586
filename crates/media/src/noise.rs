//! Octaves of gradient (Perlin) noise, raised so that they are never negative.
//!
//! ```text
//! σ_t(p) = extinction · (½ + fbm(p)/2B),   fbm(p) = Σₖ gainᵏ · noise(2ᵏ frequency p; seed + k)
//! B = bound · Σₖ gainᵏ ≥ |fbm|
//! ```
//!
//! 3-D only. Nothing is clamped: `bound` is the largest |noise| that any gradients allow,
//! 1.0363538112118027 with the quintic and 1.044905189609877 with the cubic fade. (The first does
//! not hold for the cubic fade.)
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `extinction` | the largest σ_t that is possible, > 0; the mean is half of it | 1/length | required |
//! | `frequency` | lattice cells of the first octave per unit length, > 0 | 1/length | 1 |
//! | `octaves` | 1 to 16; each doubles the frequency of the one before | | 12 |
//! | `gain` | amplitude of an octave over that of the one before, 0 to 1 | | 0.5 |
//! | `seed` | of the first octave; octave k has `seed + k` | | 0 |
//! | `fade` | `"quintic"` or `"cubic"` | | `"quintic"` |
//! | `bounds` | `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Within one cell of its lattice an octave is a polynomial of degree 16 (quintic) or 10 (cubic)
//! along a ray, and 9 Gauss nodes a cell integrate it exactly: the cell is found by its midpoint
//! and its polynomial evaluated up to its faces. Each octave is integrated on its own lattice, so
//! that the error is rounding alone. A ray that crosses n planes of the finest lattice prepares
//! 2n cells of 16 bytes each; 12 octaves on a length of 20 take some 70 000 planes and 50 ms.
//! The free flight is a bracketed root.
//!
//! Quadrature takes a panel for each cell of the finest lattice, with 17 nodes. Where `gain` is at most ½, it
//! has 16 less two for every three octaves, but 8 at least. On rays of length 20, σ_t and its square then agree
//! with 24 nodes to 2e-13. Along a diagonal of the lattice three planes are crossed at once, panels are
//! longest, and the agreement is 1e-12.
//!
//! Sources: K. Perlin, *Improving Noise*, SIGGRAPH 2002; the integral by cells is this crate's.
//!
//! ```toml
//! title = "An example of noise"
//!
//! [problem.transmittance]
//! volume.noise = { extinction = 0.9, frequency = 0.5, octaves = 4, seed = 3, bounds.box = { low = [-3, -3, 0], high = [3, 3, 6] } }
//! ray = { origin = [0.3, -0.2, -1], direction = [0.1, 0.05, 1], length = 8 }
//! sampling = 0.9
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::sync::{Arc, OnceLock};

use super::cells::Cells;
use super::lattice::{self, Cell, Fade, Track};
use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader, Smoothness, Volume, body};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Ray};
use numeric::{Known, Lane, Span, quadrature::GaussLegendre};

/// A volume of noise.
pub struct Noise {
    spectrum: NoiseOctaves,
    bounds: Bounds,
}

/// The octaves of a noise.
#[derive(Debug, Clone, Copy)]
struct NoiseOctaves {
    extinction: f64,
    frequency: f64,
    octaves: u32,
    gain: f64,
    seed: u32,
    fade: Fade,
    /// `extinction/2B`, with the bound of all octaves.
    unit: f64,
}

impl NoiseOctaves {
    /// Amplitude and seed of each octave.
    #[inline(always)]
    fn amplitudes(self) -> impl Iterator<Item = (f64, u32)> {
        let mut amplitude = 1.0;
        (0..self.octaves).map(move |k| {
            let this = amplitude;
            amplitude *= self.gain;
            (this, self.seed.wrapping_add(k))
        })
    }

    #[inline(always)]
    fn fbm<L: Lane>(self, mut p: [L; 3], fade: Fade) -> L {
        let mut sum = p[0].each(0.0);
        for (amplitude, seed) in self.amplitudes() {
            sum = sum + lattice::noise(p, seed, fade) * amplitude;
            p = [p[0] * 2.0, p[1] * 2.0, p[2] * 2.0];
        }
        sum
    }

    /// Octaves with their unit.
    fn with_unit(self) -> Self {
        let total: f64 = self.amplitudes().map(|(amplitude, _)| amplitude).sum();
        Self { unit: 0.5 * self.extinction / (self.fade.bound() * total), ..self }
    }

    /// `σ_t` at a point in lattice coordinates of the first octave.
    #[inline(always)]
    fn value<L: Lane>(self, p: [L; 3]) -> L {
        // One branch outside the octaves instead of three within each.
        let fbm = match self.fade {
            Fade::Quintic => self.fbm(p, Fade::Quintic),
            Fade::Cubic => self.fbm(p, Fade::Cubic),
        };
        fbm * self.unit + 0.5 * self.extinction
    }
}

/// Noise along a ray.
pub struct NoiseRay {
    spectrum: NoiseOctaves,
    track: Track,
    octaves: Vec<Octave>,
    rule: GaussLegendre,
    inside: Span,
}

/// An octave along a ray. Its cells are computed when the first integral needs them: lookups of σ_t do without.
struct Octave {
    amplitude: f64,
    track: Track,
    seed: u32,
    fade: Fade,
    cells: OnceLock<Cells>,
}

impl Octave {
    fn cells(&self, rule: &GaussLegendre, inside: Span) -> &Cells {
        self.cells.get_or_init(|| {
            Cells::cross(self.track, inside).summed(|_, cell, part| self.part(rule, cell, part))
        })
    }

    /// The integral over part of a cell.
    fn part(&self, rule: &GaussLegendre, cell: Span, part: Span) -> f64 {
        let polynomial = Cell::around(self.track.at(cell.middle()), self.seed);
        rule.integrate(part.from, part.to, |t| polynomial.value(self.track.at(t), self.fade))
    }
}

impl Extinction for NoiseRay {
    fn facts(&self) -> Facts<'_> {
        // Seventeen nodes are exact for the square, of degree 32. Where the octaves fade, the finest one, with cells
        // equal to these panels, contributes little: see the law of the panels in `media_laws.rs`.
        let octaves = self.spectrum.octaves as usize;
        let nodes = if self.spectrum.gain > 0.5 { 17 } else { (16 - 2 * octaves / 3).max(8) };
        Facts { is_costly: true, panel_nodes: Some(nodes), ..Facts::default() }
    }

    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        self.spectrum.value(self.track.at(t))
    }
}

impl OpticalDepth for NoiseRay {
    fn optical_depth(&self, span: Span) -> Known {
        let length = span.length();
        let (mut fbm, mut error) = (0.0, 0.0);
        for octave in &self.octaves {
            let part = |_, cell, part| octave.part(&self.rule, cell, part);
            let integral = octave.cells(&self.rule, self.inside).integrate(span, part);
            fbm += octave.amplitude * integral.value;
            // |∂ noise/∂pⱼ| < 3, and the error of a coordinate is at most its rounding.
            let ends = [octave.track.start, octave.track.at(span.to)];
            let size: f64 = ends.as_flattened().iter().map(|x| x.abs()).sum();
            error += octave.amplitude * (integral.error + 3.0 * f64::EPSILON * size * length);
        }
        let NoiseOctaves { extinction, unit, .. } = self.spectrum;
        let mean = 0.5 * extinction * length;
        let rounding = 4.0 * f64::EPSILON * (mean + (unit * fbm).abs());
        Known::new(mean + unit * fbm, rounding + unit * error)
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        // Every plane of a coarser lattice is one of the finest, to the last bit.
        let cells = |finest: &Octave| finest.cells(&self.rule, self.inside).crossings(span);
        self.octaves.last().map(cells).unwrap_or_default()
    }
}

/// A ray on the lattice of a frequency.
fn track(ray: &Ray, frequency: f64) -> Track {
    Track { start: (ray.origin * frequency).0, slope: (ray.direction * frequency).0 }
}

impl Noise {
    /// Octaves that halve their amplitude, with quintic fades; the largest extinction is above 0, 1/length.
    pub fn of_octaves(
        extinction: f64,
        (frequency, octaves): (f64, u32),
        seed: u32,
        bounds: Bounds,
    ) -> Self {
        let (gain, fade, unit) = (0.5, Fade::Quintic, 0.0);
        let spectrum = NoiseOctaves { extinction, frequency, octaves, gain, seed, fade, unit };
        Self { spectrum: spectrum.with_unit(), bounds }
    }
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::new(&["extinction"]).volume(read_volume)
}

#[allow(clippy::cast_possible_truncation)] // both counts are read within their ranges
fn read_volume(settings: &Settings) -> Option<Noise> {
    let extinction = settings.number("extinction", Domain::Positive);
    let frequency = settings.number_or("frequency", Domain::Positive, 1.0);
    let octaves = settings.count_or("octaves", 1..=16, 12);
    let gain = settings.number_or("gain", Domain::Unit, 0.5);
    let seed = settings.count_or("seed", 0..=u64::from(u32::MAX), 0);
    let fade = settings.one_of("fade", &[("quintic", Fade::Quintic), ("cubic", Fade::Cubic)]);
    let bounds = body::read_bounds(settings);
    let spectrum = NoiseOctaves {
        extinction: extinction?,
        frequency: frequency?,
        octaves: octaves? as u32,
        gain: gain?,
        seed: seed? as u32,
        fade: fade?,
        unit: 0.0,
    };
    Some(Noise { spectrum: spectrum.with_unit(), bounds: bounds? })
}

impl Field for Noise {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn facts(&self) -> Facts<'_> {
        let NoiseOctaves { frequency, octaves, .. } = self.spectrum;
        // Planes in three directions, √3 of them per cell's length; the finest octave has half of all.
        let pieces_per_length = 3f64.sqrt() * frequency * f64::from(1u32 << octaves);
        Facts { smoothness: Smoothness::SmoothCells, pieces_per_length, ..Facts::default() }
    }

    fn max_lattice_coordinate(&self, ray: &Ray, inside: Span) -> f64 {
        let finest = self.spectrum.frequency * f64::from(1u32 << (self.spectrum.octaves - 1));
        track(ray, finest).max_coordinate(inside)
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        let [x, y, z] = p;
        let frequency = self.spectrum.frequency;
        self.spectrum.value([x * frequency, y * frequency, z * frequency])
    }

    fn majorant(&self, _: &Aabb) -> f64 {
        self.spectrum.extinction
    }

    fn along(&self, ray: &Ray, inside: Span) -> Arc<Profile> {
        let NoiseOctaves { frequency, fade, .. } = self.spectrum;
        let track = track(ray, frequency);
        let tracks = std::iter::successors(Some(track), |track| Some(track.doubled()));
        let amplitudes = self.spectrum.amplitudes().zip(tracks);
        let octave = |((amplitude, seed), track)| Octave {
            amplitude,
            track,
            seed,
            fade,
            cells: OnceLock::new(),
        };
        let (octaves, rule) = (amplitudes.map(octave).collect(), GaussLegendre::new(9));
        Arc::new(NoiseRay { spectrum: self.spectrum, track, octaves, rule, inside })
    }

    /// The first octaves without rescaling: the unit stays that of all.
    fn coarsened(&self, octaves: usize) -> Option<Arc<Volume>> {
        let octaves = self.spectrum.octaves.min(u32::try_from(octaves).ok()?);
        let spectrum = NoiseOctaves { octaves, ..self.spectrum };
        Some(Arc::new(Self { spectrum, bounds: self.bounds }))
    }
}
