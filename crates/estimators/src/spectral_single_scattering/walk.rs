//! The walk of a hero to its first scattering, and the shadow ray from there, in several channels.
//!
//! ```text
//! the hero h flies through its σ̂;  at a tentative collision, r = σ_t/σ̂ of each channel:
//!   null, 1 − r_h       q_λ ← q_λ (1 − r_λ)
//!   absorbed            X = 0
//!   scattered, a_h r_h  q_λ ← q_λ r_λ a_λ, and
//! X_λ = q_λ/q p_λ(cos θ) Φ/(4π r²) T̂_λ,   q = q_h, or Σ_h w_h q_h by multiple importance sampling
//! ```
//!
//! In spectral tracking all channels walk together through one σ̂: chances `P_e` decide, and q is their product.
//! T̂ is exact, or `Π (1 − r_λ)` over the collisions of a shadow ray through the hero's σ̂, whose rates and transmittances
//! through σ̂ then are factors of q, too. q is kept relative to the hero's, see [`Path`]. The first flight and decision take
//! two random numbers each time, a flight of a shadow ray one, the choice of the hero one.

use std::ops::Range;

use super::Shadow;
use crate::kernels::hero::Path;
use crate::setup::walker::Walker;
use crate::{Draw, Setup};
use media::body::MOST_CHANNELS;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::pack::in_fused_code;
use numeric::rng::Stream;
use theory::particle::Event;
use theory::problems::ChannelValues as Values;
use theory::problems::SpectralSingleScattering;

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// What a null collision on the way to the scattering makes of q.
    #[inline(always)]
    fn passed(&self, ratio: f64) -> f64 {
        1.0 - ratio
    }

    /// What a scattering makes of q.
    #[inline(always)]
    fn scattered(&self, ratio: f64, albedo: f64) -> f64 {
        ratio * albedo
    }

    /// The channel whose σ̂ and σ_t count in a channel on the shadow ray.
    #[inline(always)]
    fn shadow_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// Whether the shadow ray's collisions and transmittances through σ̂ are factors of the densities.
    #[inline(always)]
    fn has_shadow_density(&self) -> bool {
        true
    }

    /// How many of the last channels are missing among the heroes.
    #[inline(always)]
    fn missing(&self) -> usize {
        0
    }
}

/// The right steps.
struct Right;

impl Steps for Right {}

/// Makes one draw that scores all channels: compiled once for all walkers.
#[inline(never)]
pub fn draw_all(
    walker: (&Walker, Shadow),
    setup: &Setup<SpectralSingleScattering>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    in_fused_code(
        #[inline(always)]
        || draw(&Right, walker, setup, medium, rng),
    )
}

/// Makes one draw that scores all channels, by the steps of a walk.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    (walker, shadow): (&Walker, Shadow),
    setup: &Setup<SpectralSingleScattering>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let (problem, count) = (&setup.problem, setup.channels.len());
    let hero = walker.choose(count, || rng.uniform());
    let (s, mut path, walked) = scattering(steps, setup, (walker, hero), medium, rng);
    let Some(s) = s else { return Draw::free(problem.values([0.0; MOST_CHANNELS]), walked) };
    let (through, cast) = cast(steps, shadow, (setup, 0..count), &mut path, s, rng);
    let length = path.length;
    let (mut scores, mut density) = ([0.0; MOST_CHANNELS], 0.0);
    for (channel, lit) in problem.channels.iter().enumerate() {
        let common = path.common(setup, channel, length);
        if let Walker::Mis(heroes) = walker
            && channel + steps.missing() < count
        {
            density += heroes.probability(count, channel) * common;
        }
        scores[channel] = common * through[channel] * lit.source(s) / lit.albedo();
    }
    if matches!(walker, Walker::Mis(_)) {
        for score in &mut scores[..count] {
            *score /= density;
        }
    }
    Draw::free(problem.values(scores), walked + cast)
}

/// Where the hero scatters, if it does, with the densities up to there, and the lookups.
#[inline(always)]
pub fn scattering(
    steps: &impl Steps,
    setup: &Setup<SpectralSingleScattering>,
    (walker, hero): (&Walker, usize),
    medium: &Lookups,
    rng: &mut Stream,
) -> (Option<f64>, Path, u32) {
    let (own, channels) = (&setup.channels[hero], &setup.problem.channels);
    let (albedos, count) = (&setup.problem.albedos, channels.len());
    let mut cursor = own.sampling.begin();
    let (mut path, mut lookups) = (Path::begin(hero), 0);
    loop {
        let (depth, number, from) = (-rng.ln_uniform(), rng.uniform(), cursor.t);
        if own.sampling.fly(&mut cursor, depth).is_none() {
            return (None, path, lookups);
        }
        lookups += 1;
        path.go_on(cursor.t - from);
        path.collisions += 1;
        let mut ratios = [0.0; MOST_CHANNELS];
        for (channel, ratio) in ratios[..channels.len()].iter_mut().enumerate() {
            let majorant = setup.channels[channel].majorant;
            *ratio = medium.channel(channel).extinction(cursor.t) / majorant;
        }
        let chances = walker.chances(hero, &ratios[..count], albedos, &path.weights[..count]);
        let event = chances.decide(number);
        for (channel, albedo) in albedos.iter().enumerate() {
            path.weights[channel] *= match event {
                Event::Transmitted => steps.passed(ratios[channel]),
                _ => steps.scattered(ratios[channel], *albedo),
            };
        }
        let scale = walker.together().map_or(path.weights[hero], |_| chances.of(event));
        path.weights.iter_mut().for_each(|weight| *weight /= scale);
        match event {
            Event::Transmitted => {}
            Event::Scattered => return (Some(cursor.t), path, lookups),
            Event::Absorbed => return (None, path, lookups),
        }
    }
}

/// The transmittances of the shadow ray in some channels, and its lookups.
#[inline(always)]
pub fn cast(
    steps: &impl Steps,
    shadow: Shadow,
    (setup, asked): (&Setup<SpectralSingleScattering>, Range<usize>),
    path: &mut Path,
    s: f64,
    rng: &mut Stream,
) -> ([f64; MOST_CHANNELS], u32) {
    match shadow {
        Shadow::Exact => (exact(steps, (&setup.problem, asked), path.hero, s), 0),
        Shadow::Ratio => tracked(steps, (setup, asked), path, s, rng),
    }
}

/// The exact transmittances of the shadow ray.
fn exact(
    steps: &impl Steps,
    (problem, asked): (&SpectralSingleScattering, Range<usize>),
    hero: usize,
    s: f64,
) -> [f64; MOST_CHANNELS] {
    let mut through = [1.0; MOST_CHANNELS];
    for channel in asked {
        let lit = &problem.channels[steps.shadow_of(channel, hero)];
        if let Some((ray, inside)) = lit.shadow(s) {
            let profile = lit.volume().along(&ray, inside);
            through[channel] = Lane::exp(-profile.optical_depth(inside).value);
        }
    }
    through
}

/// `Π (1 − r_λ)` over the collisions of the shadow ray through the hero's σ̂, and its lookups.
#[inline(always)]
fn tracked(
    steps: &impl Steps,
    (setup, asked): (&Setup<SpectralSingleScattering>, Range<usize>),
    path: &mut Path,
    s: f64,
    rng: &mut Stream,
) -> ([f64; MOST_CHANNELS], u32) {
    let (channels, hero) = (&setup.problem.channels, path.hero);
    let (mut through, mut lookups) = ([1.0; MOST_CHANNELS], 0);
    let Some((ray, inside)) = channels[0].shadow(s) else { return (through, 0) };
    let mean_free_path = 1.0 / setup.channels[hero].majorant;
    let mut t = inside.from;
    loop {
        t -= rng.ln_uniform() * mean_free_path;
        if t >= inside.to {
            break;
        }
        lookups += 1;
        for channel in asked.clone() {
            let of = steps.shadow_of(channel, hero);
            let extinction = channels[of].volume().points().extinction(ray.at(t));
            through[channel] *= 1.0 - extinction / setup.channels[of].majorant;
        }
    }
    if steps.has_shadow_density() {
        path.go_on(inside.length());
        path.collisions += lookups;
    }
    (through, lookups)
}
