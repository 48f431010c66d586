//! Walks of heroes to their scattering side by side, and their shadow rays: the packet kernel of [`super::walk`].
//!
//! Specification: draw j is, bit for bit, the draw that the page makes from stream j mod 16.
//!
//! ```text
//! fly       each walk flies −ln u/σ̂ of its hero: along the ray, or along its shadow ray
//! look up   one call a channel answers σ_t on the ray, another one on tracked shadow rays
//! collide   who is scattered casts a shadow ray, who has come to an end begins the next walk
//! score     when all have ended, eight draws at a time; shadow rays in closed form, too
//! ```

mod score;
mod shadow;
mod walk;

use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8};

use self::walk::Pack;
use super::Shadow;
use crate::Setup;
use crate::kernels::packet::Request;
use crate::kernels::packet::bank::{self, Slots};
use crate::kernels::packet::hero::{Law, Media};
use crate::kernels::packet::left::{Left, Made};
use crate::setup::walker::Walker;
use media::body::MOST_CHANNELS;
use media::{Batches, Lookups};
use numeric::pack::{self, Task};
use numeric::rng::LANES;
use numeric::twin::PAIR;
use numeric::{Span, Twin};
use theory::problems::SpectralSingleScattering;

/// What a walk leaves beside its weights and the transmittances of its shadow ray: its hero, its length, its lookups, and
/// where it was scattered.
const REST: usize = 4;
/// What stands in the place of the hero of a walk that was not scattered.
const LOST: f64 = -1.0;

/// The draws of a page on the hardware of a level, which score all channels or the hero's alone; a request is handed back where the
/// hardware is too narrow.
pub fn walks<'a, const ALL: bool>(
    level: Level,
    (walker, shadow): (&Walker, Shadow),
    setup: &Setup<SpectralSingleScattering>,
    medium: &Lookups,
    request: Request<'a>,
) -> Option<Request<'a>> {
    let (problem, media) =
        (&*setup.problem, Media::new(setup, &walker.probabilities(setup.channels.len())));
    let mut albedos = [0.0; MOST_CHANNELS];
    albedos[..media.count].copy_from_slice(&problem.albedos);
    let tracks = shadow == Shadow::Ratio;
    let channels = problem.channels.iter();
    let world = World::<ALL> {
        problem,
        medium,
        support: setup.mesh.support(),
        walker,
        law: walker.heroes().map(|heroes| Law::new(heroes, media.count)),
        media,
        albedos,
        tracks,
        in_space: channels.map(|channel| channel.volume().batches(level, false)).collect(),
    };
    pack::on_wide(level, Walks { world: &world, request }).err().map(|task| task.request)
}

/// What all walks share.
struct World<'a, const ALL: bool> {
    problem: &'a SpectralSingleScattering,
    medium: &'a Lookups<'a>,
    support: Span,
    walker: &'a Walker,
    /// The law of the hero, if one is chosen.
    law: Option<Law>,
    media: Media,
    albedos: [f64; MOST_CHANNELS],
    /// Whether shadow rays are tracked.
    tracks: bool,
    in_space: Vec<Batches<'a>>,
}

impl<const ALL: bool> World<'_, ALL> {
    /// How many numbers a walk leaves.
    fn left(&self) -> usize {
        let count = self.media.count;
        REST + if ALL { count } else { 0 } + if self.tracks { count } else { 0 }
    }
}

struct Walks<'a, 'r, const ALL: bool> {
    world: &'a World<'a, ALL>,
    request: Request<'r>,
}

impl<const ALL: bool> Task for Walks<'_, '_, ALL> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { world, request } = self;
        let Request { streams, count, buffer } = request;
        let mut left = Left::new(world.left(), count);
        let (turn, [first, second]) = (streams.turn, streams.packs());
        // Two names: what an index reaches lies in memory.
        let mut first = Pack::begin(simd, world, first.awake(simd), Slots::new(count, turn, 0));
        let mut second = Pack::begin(simd, world, second.awake(simd), Slots::new(count, turn, 1));
        let nothing = [[f64x8::splat(simd, 0.0); MOST_CHANNELS]; 2];
        let (mut on_ray, mut on_shadow) = (nothing, nothing);
        let mut points = [[0.0; PAIR]; 3];
        while first.slots.are_open() || second.slots.are_open() {
            let places = Twin(first.fly(world, &mut points, 0), second.fly(world, &mut points, 1));
            bank::of_channels(simd, world.medium, world.media.count, places, &mut on_ray);
            if world.tracks && (first.casts | second.casts).any_true() {
                for (channel, field) in world.in_space.iter().enumerate() {
                    let Twin(here, there) = field.pair(simd, &points);
                    (on_shadow[0][channel], on_shadow[1][channel]) = (here, there);
                }
            }
            let ended = first.collide(world, &on_ray[0], &on_shadow[0]);
            if ended.any_true() {
                let over = first.leave(world, ended, &mut left);
                bank::leave(streams, 0, over, first.numbers);
                first.begin_anew(world, ended);
            }
            let ended = second.collide(world, &on_ray[1], &on_shadow[1]);
            if ended.any_true() {
                let over = second.leave(world, ended, &mut left);
                bank::leave(streams, 1, over, second.numbers);
                second.begin_anew(world, ended);
            }
        }
        streams.turn = (streams.turn + count) % LANES;
        pack::outlined(
            simd,
            #[inline(always)]
            || score::all(simd, world, &left, Made::new(buffer, count)),
        );
    }
}
