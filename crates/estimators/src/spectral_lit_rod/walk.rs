//! The walk of a hero from the camera to the emitter, with a shadow ray from every scattering.
//!
//! ```text
//! the hero h flies forward or backward through its σ̂;  at a tentative collision, r = σ_t/σ̂ of the hero:
//!   null, 1 − r       Π (1 − r_λ) of the segment goes on
//!   absorbed          the walk ends
//!   scattered, a r    weight_λ ← weight_λ p_λ(ω) Π (1 − r_λ) r_λ a_λ, relative to the hero's;
//!                     a shadow ray flies through the hero's σ̂ and scores what it finds
//! leaving forward     the path scores
//! ```
//!
//! The hero is one for the whole path, shadow rays too. A flight takes two random numbers, that of a shadow ray one, a
//! scattering one, the choice of the hero one.

use crate::kernels::hero::{Path, Weighing};
use crate::setup::heroes::Heroes;
use crate::{Draw, Setup};
use media::body::MOST_CHANNELS;
use media::{Cursor, Extinction, Lookups};
use numeric::rng::Stream;
use theory::ParticleRule;
use theory::particle::Event;
use theory::problems::SpectralLitRod;
use theory::problems::spectral_lit_rod::Values;

/// How a path was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// By a walk that was never scattered.
    Unscattered,
    /// By a walk, after a scattering.
    Hit,
    /// By a shadow ray.
    Connected,
}

/// The steps of a walk that a known bug may replace.
pub trait Steps {
    /// The law of the hero.
    fn heroes(&self) -> &Heroes;

    /// Whether shadow rays are cast.
    fn casts(&self) -> bool;

    /// How a path is weighted.
    #[inline(always)]
    fn weighing(&self, found: Found) -> Weighing {
        let has_next_event = self.casts() && found != Found::Unscattered;
        Weighing { has_next_event, ..Weighing::RIGHT }
    }

    /// The channel whose phase function counts in a channel.
    #[inline(always)]
    fn phase_of(&self, channel: usize, hero: usize) -> usize {
        let _ = hero;
        channel
    }

    /// The channel whose σ̂ the hero's collisions are decided by.
    #[inline(always)]
    fn decides(&self, hero: usize) -> usize {
        hero
    }

    /// The hero of a shadow ray.
    #[inline(always)]
    fn casts_by(&self, hero: usize, count: usize, rng: &mut Stream) -> usize {
        let _ = (count, rng);
        hero
    }

    /// Whether the densities of the next segment begin anew at a scattering.
    #[inline(always)]
    fn begins_anew(&self) -> bool {
        true
    }

    /// What f gains at a scattering that the densities do not.
    #[inline(always)]
    fn gains(&self, albedo: f64) -> f64 {
        let _ = albedo;
        1.0
    }
}

/// Makes one draw.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    setup: &Setup<SpectralLitRod>,
    medium: &Lookups,
    rng: &mut Stream,
) -> Draw<Values> {
    let (problem, support) = (&setup.problem, setup.mesh.support());
    let count = setup.channels.len();
    let hero = steps.heroes().choose(count, rng.uniform());
    let own = &setup.channels[hero];
    let mut cursor = own.sampling.begin();
    let mut path = Path::begin(hero);
    let (mut is_forward, mut found) = (true, Found::Unscattered);
    let (mut scores, mut lookups) = ([0.0; MOST_CHANNELS], 0);
    loop {
        let (depth, number, from) = (-rng.ln_uniform(), rng.uniform(), cursor.t);
        let flown = if is_forward {
            own.sampling.fly(&mut cursor, depth)
        } else {
            own.sampling.fly_back(&mut cursor, depth)
        };
        if flown.is_none() {
            if is_forward {
                path.go_on(support.to - from);
                add(&mut scores, path.score(setup, steps.heroes(), steps.weighing(found)));
            }
            break;
        }
        lookups += 1;
        path.go_on((cursor.t - from).abs());
        path.collisions += 1;
        let extinctions = looked_up(setup, medium, cursor.t);
        let real = extinctions[hero] / setup.channels[steps.decides(hero)].majorant;
        match ParticleRule::Analog.odds(real, problem.albedo(hero, cursor.t)).decide(number) {
            Event::Transmitted => pass(&mut path, setup, &extinctions),
            Event::Scattered => {
                let direction = rng.uniform();
                scatter(&mut path, steps, setup, (cursor.t, &extinctions));
                if steps.casts() {
                    let towards = |channel: usize| {
                        let forward = problem.forward[steps.phase_of(channel, hero)];
                        if is_forward { forward } else { 1.0 - forward }
                    };
                    let mut ray = path;
                    for channel in 0..count {
                        turn(&mut ray, steps, channel, towards(channel));
                    }
                    lookups += cast(steps, &mut ray, setup, medium, (cursor, rng));
                    let weighing = steps.weighing(Found::Connected);
                    add(&mut scores, ray.score(setup, steps.heroes(), weighing));
                }
                let keeps = direction < problem.forward[hero];
                for channel in 0..count {
                    let forward = problem.forward[steps.phase_of(channel, hero)];
                    turn(&mut path, steps, channel, if keeps { forward } else { 1.0 - forward });
                }
                is_forward ^= !keeps;
                found = Found::Hit;
            }
            Event::Absorbed => break,
        }
    }
    Draw::free(problem.values(scores), lookups)
}

/// σ_t of all channels at a distance.
#[inline(always)]
fn looked_up(setup: &Setup<SpectralLitRod>, medium: &Lookups, t: f64) -> [f64; MOST_CHANNELS] {
    let mut found = [0.0; MOST_CHANNELS];
    for (channel, found) in found[..setup.channels.len()].iter_mut().enumerate() {
        *found = medium.channel(channel).extinction(t);
    }
    found
}

#[inline(always)]
fn add(scores: &mut [f64; MOST_CHANNELS], found: [f64; MOST_CHANNELS]) {
    for (score, found) in scores.iter_mut().zip(found) {
        *score += found;
    }
}

/// Passes a null collision.
#[inline(always)]
fn pass(path: &mut Path, setup: &Setup<SpectralLitRod>, extinctions: &[f64; MOST_CHANNELS]) {
    for (channel, own) in setup.channels.iter().enumerate() {
        path.nulls[channel] *= 1.0 - extinctions[channel] / own.majorant;
    }
}

/// Scatters: the segment joins the path.
#[inline(always)]
fn scatter(
    path: &mut Path,
    steps: &impl Steps,
    setup: &Setup<SpectralLitRod>,
    (t, extinctions): (f64, &[f64; MOST_CHANNELS]),
) {
    let mut weights = path.weights;
    for (channel, own) in setup.channels.iter().enumerate() {
        let albedo = setup.problem.albedo(channel, t);
        weights[channel] *= extinctions[channel] / own.majorant * albedo;
        path.excess[channel] *= steps.gains(albedo);
        if steps.begins_anew() {
            weights[channel] *= path.phases[channel] * path.nulls[channel];
        }
    }
    // Only where a bug lets it happen is the hero's 0.
    let hero = if weights[path.hero] > 0.0 { weights[path.hero] } else { 1.0 };
    for (own, weight) in path.weights.iter_mut().zip(weights) {
        *own = weight / hero;
    }
}

/// Begins a segment in a direction.
#[inline(always)]
fn turn(path: &mut Path, steps: &impl Steps, channel: usize, phase: f64) {
    if steps.begins_anew() {
        path.phases[channel] = phase;
        path.nulls[channel] = 1.0;
    } else {
        path.phases[channel] *= phase;
    }
}

/// Tracks a shadow ray to the emitter; answers its lookups.
#[inline(always)]
fn cast(
    steps: &impl Steps,
    path: &mut Path,
    setup: &Setup<SpectralLitRod>,
    medium: &Lookups,
    (mut cursor, rng): (Cursor, &mut Stream),
) -> u32 {
    let hero = steps.casts_by(path.hero, setup.channels.len(), rng);
    let sampling = &setup.channels[hero].sampling;
    let mut lookups = 0;
    loop {
        let from = cursor.t;
        if sampling.fly(&mut cursor, -rng.ln_uniform()).is_none() {
            path.go_on(setup.mesh.support().to - from);
            return lookups;
        }
        lookups += 1;
        path.go_on(cursor.t - from);
        path.collisions += 1;
        pass(path, setup, &looked_up(setup, medium, cursor.t));
    }
}
