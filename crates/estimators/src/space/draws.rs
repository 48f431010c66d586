//! Draws of walks in space: by packs, or one by one.

use fearless_simd::Level;

use super::particle::{ParticleSettings, Splitting};
use super::splitting;
use super::tally::Tally;
use super::walk::InSpace;
use crate::walks::{self, Walk, plain};
use crate::{Draw, Request};
use media::Majorants;
use numeric::ScalarLane;
use numeric::fused::compiled_once;
use numeric::rng::{Random, Stream};
use theory::problems::{Albedo, Channels, Scene};

/// Maximum number of cells of σ̂ for packs: with more, a walk spends its time on their planes, which packs cross no
/// faster.
const MAX_CELLS: usize = 100_000;

/// Makes one draw of a walk in space.
#[inline(never)]
pub fn draw<V: Channels>(walk: &impl Walk, random: &mut Stream) -> Draw<V> {
    compiled_once(
        #[inline(always)]
        || plain::in_space(walk, plain::in_doubles::<f64>(walk), random),
    )
}

/// Makes the draws of a request one after the other; it follows the particles that split off if it `SPLITS`.
pub fn in_turn<V: Channels + AsRef<[f64]>, T: Tally, const SPLITS: bool>(
    tally: &T,
    particle: &ParticleSettings,
    world: (&Scene, &Majorants),
    request: Request,
) {
    let walk = InSpace::new(tally, *particle, world, &[]);
    let Request { streams, count, buffer } = request;
    compiled_once(
        #[inline(always)]
        || {
            let mut waiting = Vec::new();
            buffer.make_room(count);
            for number in 0..count {
                let (random, look_up) = (streams.of_next_draw(), plain::in_doubles::<f64>(&walk));
                let draw: Draw<V> = if SPLITS {
                    splitting::follow(&walk, particle.splitting, look_up, random, &mut waiting)
                } else {
                    plain::in_space(&walk, look_up, random)
                };
                buffer.put(number, &draw);
            }
        },
    );
}

/// Makes one draw in any lane of one number, given the value of a field of the walk at a place.
#[inline(always)]
pub fn follow<L: ScalarLane, V: Channels, T: Tally, const SPLITS: bool>(
    walk: &InSpace<T>,
    splitting: Splitting,
    look_up: impl Fn(usize, [L; 3]) -> L,
    random: &mut impl Random<L>,
) -> Draw<V> {
    if SPLITS {
        splitting::follow(walk, splitting, look_up, random, &mut Vec::new())
    } else {
        plain::in_space(walk, look_up, random)
    }
}

/// Makes the draws of a request by packs. Returns the request where the hardware is too narrow, where the particle
/// splits, where σ̂ has many cells, and where draws have other channels.
pub fn packets<'a, T: Tally>(
    level: Level,
    tally: &T,
    particle: &ParticleSettings,
    (scene, majorants): (&Scene, &Majorants),
    request: Request<'a>,
) -> Option<Request<'a>> {
    let is_fit = particle.splitting == Splitting::None
        && majorants.cells().3.len() <= MAX_CELLS
        && request.buffer.values.len() == tally.channels();
    if !is_fit {
        return Some(request);
    }
    let mut fields = vec![scene.volume.batches(level, false)];
    if let Albedo::Field(field, _) = &scene.albedo {
        fields.push(field.batches(level, true));
    }
    let walk = InSpace::new(tally, *particle, (scene, majorants), &fields);
    walks::packets_in_space(level, &walk, request)
}
