//! A sum of plane waves about a mean.
//!
//! ```text
//! σ_t(x) = base + Σᵢ amplitudesᵢ · sin(frequenciesᵢ · x + phasesᵢ)   (1-D)
//! σ_t(p) = base + Σᵢ amplitudesᵢ · sin(vectorsᵢ · p + phasesᵢ)       (3-D)
//! ```
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `base` | the mean, at least the sum of the absolute amplitudes | 1/length | required |
//! | `amplitudes` | one for each wave, of either sign | 1/length | required |
//! | `frequencies` | 1-D only: one for each wave | rad/length | required |
//! | `vectors` | 3-D only: wave vectors `[[x, y, z], …]` | rad/length | required |
//! | `phases` | one for each wave | rad | zeros |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Lookups use `1 ± sin x = 2 sin²(x/2 ± π/4)`, which rounding cannot make negative. Arguments stay below 1e9 rad.
//! The optical depth is a closed form about the middle of the interval,
//!
//! ```text
//! ∫ sin(φ + ωs) ds = L sin(φ_middle) · sinc(ωL/2)
//! ```
//!
//! with an error below L·(4 base + Σ|amplitudeᵢ φᵢ|)·2.2e-16; the free flight is a bracketed root.
//! Quadrature takes a panel for each half period of the fastest wave.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};
use std::sync::Arc;

use super::{Extinction, Facts, Field, OpticalDepth, Profile, Reader, body};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span};

/// Plane waves as a volume.
pub struct Sines {
    base: f64,
    waves: Vec<(f64, Point, f64)>,
    bounds: Bounds,
}

impl Sines {
    /// Waves `amplitude · sin(vector·p + phase)` about a base of at least the sum of their absolute amplitudes.
    pub fn new(base: f64, waves: Vec<(f64, Point, f64)>, bounds: Bounds) -> Self {
        Self { base, waves, bounds }
    }
}

/// Waves along a ray.
pub struct Waves {
    base: f64,
    /// `base − Σ|amplitude| ≥ 0`.
    trough: f64,
    parts: Vec<Wave>,
}

/// `amplitude · sin(frequency · t + phase)`.
pub struct Wave {
    /// Amplitude, 1/length.
    pub amplitude: f64,
    /// Frequency, radians/length.
    pub frequency: f64,
    /// Phase, radians.
    pub phase: f64,
}

impl Wave {
    /// `|amplitude| + amplitude·sin(frequency·t + phase) ≥ 0`.
    #[inline(always)]
    fn raised<L: Lane>(&self, t: L) -> L {
        let quarter = FRAC_PI_4.copysign(self.amplitude);
        let sine = (t * (0.5 * self.frequency) + (0.5 * self.phase + quarter)).sin();
        sine * sine * (2.0 * self.amplitude.abs())
    }
}

impl Waves {
    /// Waves about a base of at least the sum of their absolute amplitudes, 1/length.
    pub fn new(base: f64, parts: Vec<Wave>) -> Self {
        let trough = base - parts.iter().map(|wave| wave.amplitude.abs()).sum::<f64>();
        Self { base, trough, parts }
    }

    /// Half periods of the fastest wave on a length.
    fn half_periods(&self, length: f64) -> f64 {
        self.parts.iter().fold(0.0f64, |f, wave| f.max(wave.frequency.abs())) * length / PI
    }
}

impl Extinction for Waves {
    #[inline(always)]
    fn extinction<L: Lane>(&self, t: L) -> L {
        // A loop and not a fold: a closure would be compiled for the least machine.
        let mut sum = t.each(self.trough);
        for wave in &self.parts {
            sum = sum + wave.raised(t);
        }
        sum
    }

    fn facts(&self) -> Facts<'_> {
        // Over half a period the square turns by 2π: 12 nodes have an error below 1e-16 of it.
        let pieces_per_length = self.half_periods(1.0);
        Facts { panel_nodes: Some(12), pieces_per_length, ..Facts::default() }
    }
}

/// `sin x / x`.
pub fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { x.sin() / x }
}

/// The largest `sin` of any angle between the two.
pub fn highest_sine(angles: Span) -> f64 {
    let crest = FRAC_PI_2 + TAU * ((angles.from - FRAC_PI_2) / TAU).ceil();
    if crest <= angles.to { 1.0 } else { angles.from.sin().max(angles.to.sin()) }
}

impl OpticalDepth for Waves {
    fn optical_depth(&self, span: Span) -> Known {
        let (length, middle) = (span.length(), span.middle());
        let (mut mean, mut error) = (self.base, 4.0 * self.base);
        for Wave { amplitude, frequency, phase } in &self.parts {
            let swing = sinc(0.5 * frequency * length);
            mean += amplitude * (frequency * middle + phase).sin() * swing;
            error += amplitude.abs() * (2.0 * (frequency * middle).abs() + phase.abs());
        }
        Known::new(length * mean, length * error * f64::EPSILON)
    }

    fn breaks(&self, span: Span) -> Vec<f64> {
        span.even_cuts(self.half_periods(span.length()).ceil())
    }
}

/// Reads the page.
pub fn reader() -> Reader {
    Reader::new(&["base", "amplitudes"]).line(read_line).volume(read_volume)
}

/// Reads `base`, `amplitudes` and `phases`, and checks the number of waves.
fn read(settings: &Settings, waves: Option<usize>) -> Option<(f64, Vec<f64>, Vec<f64>)> {
    let base = settings.number("base", Domain::NonNegative);
    let amplitudes = settings.numbers("amplitudes", Domain::Finite, 1);
    let phases = settings.has("phases").then(|| settings.numbers("phases", Domain::Finite, 1));
    let (base, amplitudes, waves) = (base?, amplitudes?, waves?);
    let phases = phases.unwrap_or_else(|| Some(vec![0.0; waves]))?;
    if amplitudes.len() != waves || phases.len() != waves {
        let (a, p) = (amplitudes.len(), phases.len());
        let message = format!("there are {waves} waves, {a} amplitudes and {p} phases");
        settings.fault("amplitudes", message, "give one amplitude and one phase for each wave");
        return None;
    }
    let swing: f64 = amplitudes.iter().map(|a| a.abs()).sum();
    if base < swing {
        let message = format!("`base` is {base}, and the waves take away as much as {swing}");
        settings.fault("base", message, "it takes at least the sum of the absolute amplitudes");
        return None;
    }
    Some((base, amplitudes, phases))
}

fn read_line(settings: &Settings) -> Option<Waves> {
    let frequencies = settings.numbers("frequencies", Domain::Finite, 1);
    let (base, amplitudes, phases) = read(settings, frequencies.as_ref().map(Vec::len))?;
    let waves = amplitudes.into_iter().zip(frequencies?).zip(phases);
    let waves = waves.map(|((amplitude, frequency), phase)| Wave { amplitude, frequency, phase });
    Some(Waves::new(base, waves.collect()))
}

fn read_volume(settings: &Settings) -> Option<Sines> {
    let vectors = settings.triples("vectors");
    let read = read(settings, vectors.as_ref().map(Vec::len));
    let bounds = body::read_bounds(settings)?;
    let (base, amplitudes, phases) = read?;
    let waves = amplitudes.into_iter().zip(vectors?).zip(phases);
    let waves = waves.map(|((amplitude, vector), phase)| (amplitude, Point(vector), phase));
    Some(Sines { base, waves: waves.collect(), bounds })
}

impl Field for Sines {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn facts(&self) -> Facts<'_> {
        let fastest = self.waves.iter().map(|wave| wave.1.dot(wave.1).sqrt()).fold(0.0, f64::max);
        Facts { pieces_per_length: fastest / PI, ..Facts::default() }
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        let swing: f64 = self.waves.iter().map(|(amplitude, ..)| amplitude.abs()).sum();
        // A loop and not a fold: a closure would be compiled for the least machine.
        let mut sum = p[0].each(self.base - swing);
        for &(amplitude, vector, phase) in &self.waves {
            sum = sum + Wave { amplitude, frequency: 1.0, phase }.raised(vector.along(p));
        }
        sum
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        let highest = self.waves.iter().fold(self.base, |sum, &(amplitude, vector, phase)| {
            let turn = if amplitude < 0.0 { phase + PI } else { phase };
            let reach = within.reach(vector);
            sum + amplitude.abs() * highest_sine(Span::new(reach.from + turn, reach.to + turn))
        });
        // The arguments of the lookups are rounded, too.
        highest + 1e-12 * self.base
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let waves = self.waves.iter().map(|&(amplitude, vector, phase)| Wave {
            amplitude,
            frequency: vector.dot(ray.direction),
            phase: phase + vector.dot(ray.origin),
        });
        Arc::new(Waves::new(self.base, waves.collect()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(amplitude: f64, frequency: f64, phase: f64) -> Wave {
        Wave { amplitude, frequency, phase }
    }

    #[test]
    fn half_a_period_is_a_hand_value() {
        // ∫₀^π (2 + sin x) dx = 2π + 2
        let field = Waves::new(2.0, vec![wave(1.0, 1.0, 0.0)]);
        let depth = field.optical_depth(Span::new(0.0, PI)).value;
        assert!((depth - (2.0 * PI + 2.0)).abs() < 4e-15);
        assert!((field.extinction(0.5) - (2.0 + 0.5f64.sin())).abs() < 1e-15);
    }

    #[test]
    fn a_standing_wave_is_homogeneous() {
        let field = Waves::new(2.0, vec![wave(-1.0, 0.0, FRAC_PI_2)]);
        assert_eq!(field.optical_depth(Span::new(0.0, 3.0)).value, 3.0);
        assert!(field.breaks(Span::new(0.0, 3.0)).is_empty());
    }

    #[test]
    fn the_deepest_trough_is_never_negative() {
        let field = Waves::new(0.3, vec![wave(0.1, 3.0, 0.1), wave(-0.2, 9.0, -1.3)]);
        for i in 0..10_000 {
            assert!(field.extinction(0.01 * f64::from(i)) >= 0.0);
        }
    }

    #[test]
    fn the_highest_sine_is_a_crest_or_an_end() {
        assert_eq!(highest_sine(Span::new(1.0, 2.0)), 1.0);
        assert_eq!(highest_sine(Span::new(2.0, 3.0)), 2.0f64.sin());
        assert_eq!(highest_sine(Span::new(-20.0, -19.0)), (-19.0f64).sin().max((-20.0f64).sin()));
    }
}
