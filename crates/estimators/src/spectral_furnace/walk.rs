//! The walk of a hero through a volume in several channels, until it is absorbed or leaves.
//!
//! ```text
//! the hero h flies −ln u/σ̂_h;  beyond the bounds the walk has left
//! at a tentative collision, r = σ_t/σ̂ of each channel, a null, an absorption or a scattering by the hero's chances:
//!   f_λ ← f_λ (1 − r_λ),   f_λ r_λ (1 − a_λ),   f_λ r_λ a_λ p_λ(cos θ)
//! ```
//!
//! The furnace shines wherever a walk ends, so that f is the density of the walk itself. f is kept relative to the hero's,
//! see [`Path`]. In spectral tracking all channels walk together through one σ̂ with one phase function: chances `P_e` decide,
//! and f is relative to them. A flight takes one random number, a collision one, a scattering one for θ and one for the azimuth, the
//! choice of the hero one.

use crate::chromatic::{By, Steps};
use crate::kernels::hero::Path;
use crate::setup::walker::Walker;
use crate::{Draw, Setup};
use media::body::MOST_CHANNELS;
use numeric::geometry::{Point, Ray, frame};
use numeric::rng::Stream;
use theory::particle::Event;
use theory::problems::ChannelValues as Values;
use theory::problems::SpectralFurnace;

/// What became of a walk.
struct Left {
    path: Path,
    lookups: u32,
}

/// Makes one draw.
#[inline(always)]
pub fn draw(
    steps: &impl Steps,
    by: By,
    setup: &Setup<SpectralFurnace>,
    rng: &mut Stream,
) -> Draw<Values> {
    let (By { walker, weighing, scores_all }, problem) = (by, &*setup.problem);
    let count = setup.channels.len();
    let hero = walker.choose(count, || rng.uniform());
    let Left { path, lookups } = walk(steps, setup, (walker, hero), rng);
    if let (Some(heroes), false) = (walker.heroes(), scores_all) {
        let mut scores = [0.0; MOST_CHANNELS];
        scores[hero] = 1.0 / heroes.probability(count, hero);
        return Draw::free(problem.scored(scores), lookups);
    }
    let Walker::Mis(heroes) = walker else {
        return Draw::free(problem.scored(path.relative(setup)), lookups);
    };
    let scores = path.score(setup, heroes, weighing);
    let weighted = scores[..count].iter().enumerate();
    let sum: f64 = weighted.map(|(channel, x)| heroes.probability(count, channel) * x).sum();
    Draw { value: problem.scored(scores), lookups, defect: (sum - 1.0).abs() }
}

/// Walks; the furnace shines wherever a walk ends.
#[inline(always)]
fn walk(
    steps: &impl Steps,
    setup: &Setup<SpectralFurnace>,
    (walker, hero): (&Walker, usize),
    rng: &mut Stream,
) -> Left {
    let (problem, count) = (&*setup.problem, setup.channels.len());
    let (own, majorant) = (&problem.channels[hero], setup.channels[hero].majorant);
    let mut path = Path::begin(hero);
    let (mut place, mut direction, mut lookups) = (problem.entry, problem.direction, 0);
    loop {
        let flight = -rng.ln_uniform() / majorant;
        let ray = Ray { origin: place, direction, length: f64::INFINITY };
        let end = problem.bounds.clip(&ray).to;
        if flight >= end {
            path.go_on(end.max(0.0));
            return Left { path, lookups };
        }
        path.go_on(flight);
        lookups += 1;
        place = ray.at(flight);
        let ratios = ratios(steps, setup, hero, place);
        let weights = &path.weights[..count];
        let chances = walker.chances(hero, &ratios[..count], &problem.albedos, weights);
        let event = chances.decide(rng.uniform());
        let mut cosine = 1.0;
        if event == Event::Scattered {
            cosine = own.phase.cosine(rng.uniform());
            direction = frame::turned(direction, cosine, rng.uniform());
        }
        let density = if event == Event::Scattered { own.phase.value(cosine) } else { 1.0 };
        let of_all = walker.together().map(|_| chances.of(event) * density);
        path.collide(count, of_all, |channel| {
            let phase =
                &problem.channels[if steps.has_heros_phase() { hero } else { channel }].phase;
            let albedo = problem.albedos[channel];
            steps.factor(event, ratios[channel], albedo, phase.value(cosine))
        });
        if event == Event::Absorbed {
            return Left { path, lookups };
        }
    }
}

/// `σ_t/σ̂` of each channel at a place.
#[inline(always)]
fn ratios(
    steps: &impl Steps,
    setup: &Setup<SpectralFurnace>,
    hero: usize,
    place: Point,
) -> [f64; MOST_CHANNELS] {
    let mut ratios = [0.0; MOST_CHANNELS];
    for (channel, medium) in setup.problem.channels.iter().enumerate() {
        let majorant =
            setup.channels[if steps.has_heros_majorant() { hero } else { channel }].majorant;
        ratios[channel] = medium.volume.points().extinction(place) / majorant;
    }
    ratios
}
