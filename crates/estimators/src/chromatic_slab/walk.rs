//! The walk of a hero through a slab in several channels, until it is absorbed or leaves.
//!
//! ```text
//! the hero h flies a length −ln u/σ̂_h along a direction of cosine μ, |μ| of it deep
//! at a tentative collision, r = σ_t/σ̂ of each channel, a null, an absorption or a scattering by the hero's chances:
//!   f_λ ← f_λ (1 − r_λ),   f_λ r_λ (1 − a_λ),   f_λ r_λ a_λ p_λ(cos θ)
//! ```
//!
//! f is the density of the walk in the channel λ and is kept relative to the hero's, see [`Path`]. In spectral tracking all
//! channels walk together through one σ̂ with one phase function: chances `P_e` decide, and f is relative to them. The choice of the hero
//! takes one random number, diffuse light one, a flight one, a collision one, a scattering one for θ and one for the azimuth.

use crate::Setup;
use crate::chromatic::{Left, Steps};
use crate::kernels::hero::Path;
use crate::setup::walker::Walker;
use crate::slab::walk::turned;
use media::body::MOST_CHANNELS;
use media::{Extinction, Lookups};
use numeric::Lane;
use numeric::rng::Stream;
use theory::particle::Event;
use theory::problems::ChromaticSlab;
use theory::problems::slab::Light;
use theory::problems::spectral_rod::End;

/// Walks.
#[inline(always)]
pub fn walk(
    steps: &impl Steps,
    setup: &Setup<ChromaticSlab>,
    (walker, hero): (&Walker, usize),
    medium: &Lookups,
    rng: &mut Stream,
) -> Left<End> {
    let (problem, support) = (&*setup.problem, setup.mesh.support());
    let (own, phase) = (&setup.channels[hero], &problem.incidences[hero].phase);
    let (albedos, count) = (&problem.colours.albedos, setup.channels.len());
    let mut cosine = match problem.incidences[hero].light {
        Light::Collimated(cosine) => cosine,
        Light::Diffuse => (1.0 - rng.uniform()).sqrt(),
    };
    let mut cursor = own.sampling.begin();
    let (mut path, mut lookups) = (Path::begin(hero), 0);
    loop {
        let (depth, from, is_down) = (-rng.ln_uniform(), cursor.t, cosine > 0.0);
        let flown = if is_down {
            own.sampling.fly(&mut cursor, depth * cosine)
        } else {
            own.sampling.fly_back(&mut cursor, depth * -cosine)
        };
        if flown.is_none() {
            let (end, at) = if is_down {
                (End::Transmitted, support.to)
            } else {
                (End::Reflected, support.from)
            };
            path.go_on(steps.flown(at - from, cosine));
            return Left { end: Some(end), path, lookups };
        }
        path.go_on(steps.flown(depth * cosine / own.majorant, cosine));
        lookups += 1;
        let mut ratios = [0.0; MOST_CHANNELS];
        for (channel, ratio) in ratios[..count].iter_mut().enumerate() {
            let majorant = setup.channels[steps.majorant_of(channel, hero)].majorant;
            *ratio = medium.channel(channel).extinction(cursor.t) / majorant;
        }
        let chances = walker.chances(hero, &ratios[..count], albedos, &path.weights[..count]);
        let event = chances.decide(rng.uniform());
        let mut deflection = 1.0;
        if event == Event::Scattered {
            deflection = phase.cosine(rng.uniform());
            let azimuth = Lane::cos(std::f64::consts::TAU * rng.uniform());
            cosine = turned(cosine, deflection, azimuth);
        }
        let density = if event == Event::Scattered { phase.value(deflection) } else { 1.0 };
        let of_all = walker.together().map(|_| chances.of(event) * density);
        path.collide(count, of_all, |channel| {
            let phase = &problem.incidences[steps.phase_of(channel, hero)].phase;
            steps.factor(event, ratios[channel], albedos[channel], phase.value(deflection))
        });
        if event == Event::Absorbed {
            return Left { end: None, path, lookups };
        }
    }
}
