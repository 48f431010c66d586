//! A sum of plane waves about a mean.
//!
//! ```text
//! σ_t(x) = base + Σᵢ amplitudesᵢ · sin(frequenciesᵢ · x + phasesᵢ)   along a line, or layers
//! σ_t(p) = base + Σᵢ amplitudesᵢ · sin(vectorsᵢ · p + phasesᵢ)       waves of any directions
//! ```
//!
//! In 1-D `x` is the distance `t`; in 3-D, with `frequencies`, it is the height `p·axis`.
//!
//! | setting | meaning | unit | default |
//! |---|---|---|---|
//! | `base` | the mean, at least the sum of the absolute amplitudes | 1/length | required |
//! | `amplitudes` | one for each wave, of either sign | 1/length | required |
//! | `frequencies` | one for each wave | rad/length | required; in 3-D this or `vectors` |
//! | `vectors` | 3-D only: wave vectors `[[x, y, z], …]` | rad/length | this or `frequencies` |
//! | `phases` | one for each wave | rad | zeros |
//! | `axis` | 3-D with `frequencies` only: the direction of `x`; it is normalised | | `[0, 0, 1]` |
//! | `bounds` | 3-D only: `sphere = { centre, radius }` or `box = { low, high }` | length | all of space |
//!
//! Lookups use `1 ± sin x = 2 sin²(x/2 ± π/4)`, which rounding cannot make negative. Arguments stay below 1e9 rad.
//! The optical depth is a closed form about the middle of the interval,
//!
//! ```text
//! ∫ sin(φ + ωs) ds = L sin(φ_middle) · sinc(ωL/2)
//! ```
//!
//! with an error below L·(4 base + Σ|amplitudeᵢ φᵢ|)·2.2e-16, where |φ| is the sum of its terms' sizes; the free flight is a bracketed root.
//! Quadrature takes a panel for each half period of the fastest wave.
//!
//! ```toml
//! title = "An example of sines"
//!
//! [problem.transmittance]
//! medium.sines = { base = 0.5, amplitudes = [0.3, -0.2], frequencies = [2.1, 7.3], phases = [0.4, 1] }
//! span = [0, 3]
//! sampling = 1
//! estimators = ["ratio"]
//! ```
#![cfg_attr(not(doctest), doc = crate::draw_in_rust!())]

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};
use std::sync::Arc;

use super::layered::{Heights, Stratified};
use super::{Facts, Field, Profile, Reader, body};
use crate::catalogue::{Domain, Settings};
use numeric::geometry::{Aabb, Bounds, Point, Ray};
use numeric::{Known, Lane, Span};

/// A wave with a frequency along a line, or a wave vector in space: `amplitude · sin(frequency · x + phase)`.
#[derive(Clone)]
pub struct Wave<K = f64> {
    /// Amplitude, 1/length.
    pub amplitude: f64,
    /// Frequency or wave vector, radians/length.
    pub frequency: K,
    /// Phase, radians.
    pub phase: f64,
}

impl<K> Wave<K> {
    /// `|amplitude| + amplitude·sin(2 half_angle + phase) ≥ 0`.
    #[inline(always)]
    fn raised<L: Lane>(&self, half_angle: L) -> L {
        let quarter = FRAC_PI_4.copysign(self.amplitude);
        let sine = (half_angle + (0.5 * self.phase + quarter)).sin();
        sine * sine * (2.0 * self.amplitude.abs())
    }
}

/// Waves about a base.
#[derive(Clone)]
pub struct Waves<K = f64> {
    base: f64,
    /// `base − Σ|amplitude| ≥ 0`.
    trough: f64,
    parts: Vec<Wave<K>>,
    /// Sum over the waves of |amplitude| times the size of phases that cancelled at the origin of a ray.
    cancelled: f64,
}

impl<K> Waves<K> {
    /// Waves about a base of at least the sum of their absolute amplitudes, 1/length.
    pub fn new(base: f64, parts: Vec<Wave<K>>) -> Self {
        let trough = base - parts.iter().map(|wave| wave.amplitude.abs()).sum::<f64>();
        Self { base, trough, parts, cancelled: 0.0 }
    }

    /// The sum at a place, of which `along` returns half the product with a frequency.
    #[inline(always)]
    fn sum<L: Lane>(&self, zero: L, along: impl Fn(&K) -> L) -> L {
        // A loop and not a fold: a closure would be compiled for the least machine.
        let mut sum = zero.each(self.trough);
        for wave in &self.parts {
            sum = sum + wave.raised(along(&wave.frequency));
        }
        sum
    }

    /// An upper bound where the product of a frequency and the place has the range `reach`.
    fn bound(&self, reach: impl Fn(&K) -> Span) -> f64 {
        let highest = self.parts.iter().fold(self.base, |sum, wave| {
            let turn = if wave.amplitude < 0.0 { wave.phase + PI } else { wave.phase };
            let reach = reach(&wave.frequency);
            let crest = highest_sine(Span::new(reach.from + turn, reach.to + turn));
            sum + wave.amplitude.abs() * crest
        });
        // The arguments of the lookups are rounded, too.
        highest + 1e-12 * self.base
    }

    /// The waves along a ray, of which `seen` returns the phase at the origin and the frequency.
    fn on_ray(&self, seen: impl Fn(&K) -> [f64; 2]) -> Waves {
        let mut cancelled = 0.0;
        let parts = self.parts.iter().map(|wave| {
            let (amplitude, [shift, frequency]) = (wave.amplitude, seen(&wave.frequency));
            let phase = wave.phase + shift;
            cancelled += amplitude.abs() * (wave.phase.abs() + shift.abs() - phase.abs());
            Wave { amplitude, frequency, phase }
        });
        let waves = Waves::new(self.base, parts.collect());
        Waves { cancelled, ..waves }
    }

    /// Half periods of the fastest wave on a length, given the size of a frequency.
    fn half_periods(&self, length: f64, size: impl Fn(&K) -> f64) -> f64 {
        self.parts.iter().fold(0.0f64, |f, wave| f.max(size(&wave.frequency))) * length / PI
    }

    /// Reads the settings beside the frequencies or the vectors, one for each wave.
    fn read_beside(settings: &Settings, frequencies: Option<Vec<K>>) -> Option<Self> {
        let base = settings.number("base", Domain::NonNegative);
        let amplitudes = settings.numbers("amplitudes", Domain::Finite, 1);
        let phases = settings.optional("phases", |key| settings.numbers(key, Domain::Finite, 1));
        let (base, amplitudes, frequencies) = (base?, amplitudes?, frequencies?);
        let waves = frequencies.len();
        let phases = phases.ok()?.unwrap_or_else(|| vec![0.0; waves]);
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
        let waves = amplitudes.into_iter().zip(frequencies).zip(phases);
        let wave = |((amplitude, frequency), phase)| Wave { amplitude, frequency, phase };
        Some(Self::new(base, waves.map(wave).collect()))
    }
}

impl Stratified for Waves {
    const EXTINCTIONS: &'static [&'static str] = &["base", "amplitudes"];

    fn read(settings: &Settings) -> Option<Self> {
        Self::read_beside(settings, settings.numbers("frequencies", Domain::Finite, 1))
    }

    #[inline(always)]
    fn value<L: Lane>(&self, x: L) -> L {
        self.sum(
            x,
            #[inline(always)]
            |frequency| x * (0.5 * frequency),
        )
    }

    fn integral(&self, x: Span) -> Known {
        let (length, middle) = (x.length(), x.middle());
        let (mut mean, mut error) = (self.base, 4.0 * self.base + self.cancelled);
        for Wave { amplitude, frequency, phase } in &self.parts {
            let swing = sinc(0.5 * frequency * length);
            mean += amplitude * (frequency * middle + phase).sin() * swing;
            error += amplitude.abs() * (2.0 * (frequency * middle).abs() + phase.abs());
        }
        Known::new(length * mean, length * error * f64::EPSILON)
    }

    fn highest(&self, x: Span) -> f64 {
        self.bound(|frequency| {
            let [from, to] = [x.from * frequency, x.to * frequency];
            Span::new(from.min(to), from.max(to))
        })
    }

    fn features(&self, x: Span) -> Vec<f64> {
        x.even_cuts(self.half_periods(x.length(), |frequency| frequency.abs()).ceil())
    }

    fn facts(&self) -> Facts<'_> {
        // Over half a period the square turns by 2π: 12 nodes have an error below 1e-16 of it.
        let pieces_per_length = self.half_periods(1.0, |frequency| frequency.abs());
        Facts { panel_nodes: Some(12), pieces_per_length, ..Facts::default() }
    }

    fn along(&self, &Heights { start, slope, .. }: &Heights, _: Span) -> Option<Self> {
        Some(self.on_ray(|frequency| [frequency * start, frequency * slope]))
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

/// Reads the page.
pub fn reader() -> Reader {
    // `vectors` are missing where nothing chooses layers.
    let is_in_space = |settings: &Settings| {
        settings.has("vectors") || !(settings.has("frequencies") || settings.has("axis"))
    };
    let help = "it is for layers: give `frequencies` in place of `vectors`, or leave `axis` out";
    Reader::layered::<Waves>().or_volume(is_in_space, Sines::read, help)
}

/// Plane waves as a volume.
pub struct Sines {
    waves: Waves<Point>,
    bounds: Bounds,
}

impl Sines {
    /// Plane waves within bounds.
    pub fn new(waves: Waves<Point>, bounds: Bounds) -> Self {
        Self { waves, bounds }
    }

    fn read(settings: &Settings) -> Option<Self> {
        let vectors = match (settings.has("vectors"), settings.has("frequencies")) {
            (true, false) => settings.triples("vectors"),
            (both, _) => {
                let actual = if both { "both" } else { "neither" };
                let message = format!("{actual} of `vectors` and `frequencies`");
                let help = "give `vectors` for waves in space, or `frequencies` for layers across an `axis`";
                settings.fault("vectors", message, help);
                None
            }
        };
        let vectors = vectors.map(|vectors| vectors.into_iter().map(Point).collect());
        let (waves, bounds) = (Waves::read_beside(settings, vectors), body::read_bounds(settings));
        Some(Self::new(waves?, bounds?))
    }
}

impl Field for Sines {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn facts(&self) -> Facts<'_> {
        let pieces_per_length = self.waves.half_periods(1.0, |vector| vector.norm());
        Facts { pieces_per_length, ..Facts::default() }
    }

    #[inline(always)]
    fn value<L: Lane>(&self, p: [L; 3]) -> L {
        self.waves.sum(
            p[0],
            #[inline(always)]
            |vector| vector.along(p) * 0.5,
        )
    }

    fn majorant(&self, within: &Aabb) -> f64 {
        self.waves.bound(|&vector| within.reach(vector))
    }

    fn along(&self, ray: &Ray, _: Span) -> Arc<Profile> {
        let seen = |vector: &Point| [ray.origin, ray.direction].map(|at| vector.dot(at));
        Arc::new(self.waves.on_ray(seen))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_sine_is_a_crest_or_an_end() {
        assert_eq!(highest_sine(Span::new(1.0, 2.0)), 1.0);
        assert_eq!(highest_sine(Span::new(2.0, 3.0)), 2.0f64.sin());
        assert_eq!(highest_sine(Span::new(-20.0, -19.0)), (-19.0f64).sin().max((-20.0f64).sin()));
    }
}
